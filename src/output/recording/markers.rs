//! Where agents enter, push and are measured: outlines with names.

use rerun::{AsComponents, Color, LineStrips2D, Points2D, Radius, RecordingStream};

use super::RecordingOptions;
use super::error::Cause;
use super::geometry::xy;
use crate::engine::math::{Vector, bounds};
use crate::engine::scene::{Region, Scene};
use crate::output::colors::Rgb;

/// The colors of sources, pushes and measurements.
const SOURCE: Rgb = [0, 170, 200];
const PUSH: Rgb = [230, 110, 90];
const MEASURED: Rgb = [200, 196, 150];
/// The length of a dash and of the gap after it, as a part of the longest side of the visible region.
const DASH: f64 = 0.008;

/// Outlines with names.
type Named = Vec<(String, Vec<Vector>)>;

/// Logs the outlines of sources and pushes, and dashed those of measurements.
pub fn log(
    stream: &RecordingStream,
    scene: &Scene,
    options: &RecordingOptions,
) -> Result<(), Cause> {
    let sources = scene.sources.iter().map(|source| {
        let (min, max) = (source.grid.min, source.grid.max);
        (
            format!("source {}", source.name),
            closed(&Region { min, max }),
        )
    });
    let pushes = scene.pushes.iter();
    let pushes = pushes.map(|push| (named("push", &push.name), closed(&push.region)));
    let measured = options.measured.iter().map(|(name, outline)| {
        let name = format!("measured: {name}");
        (name, outline.clone())
    });
    let dash = DASH * (options.view.max - options.view.min).max();
    let whole = |outline: &[Vector]| vec![outline.to_vec()];
    log_outlines(stream, "sources", (&sources.collect(), SOURCE), whole)?;
    log_outlines(stream, "pushes", (&pushes.collect(), PUSH), whole)?;
    let dashed = |outline: &[Vector]| dashes(outline, dash);
    log_outlines(stream, "measured", (&measured.collect(), MEASURED), dashed)
}

/// The kind before a name that does not begin with it.
fn named(kind: &str, name: &str) -> String {
    match name.starts_with(kind) {
        true => name.to_owned(),
        false => format!("{kind} {name}"),
    }
}

fn closed(region: &Region) -> Vec<Vector> {
    let corners = region.corners();
    corners.into_iter().chain([corners[0]]).collect()
}

fn log_outlines(
    stream: &RecordingStream,
    entity: &str,
    (named, [r, g, b]): (&Named, Rgb),
    strips: impl Fn(&[Vector]) -> Vec<Vec<Vector>>,
) -> Result<(), Cause> {
    if named.is_empty() {
        return Ok(());
    }
    let color = Color::from_rgb(r, g, b);
    let lines = named.iter().flat_map(|(_, outline)| strips(outline));
    let lines = LineStrips2D::new(lines.map(|line| line.into_iter().map(xy).collect::<Vec<_>>()))
        .with_radii([Radius::new_ui_points(1.0)])
        .with_colors([color])
        .with_draw_order(3.0);
    let places = named.iter().map(|(_, outline)| {
        let [low, high] = bounds(outline.iter().copied()).unwrap_or_default();
        xy(Vector::new(0.5 * (low.x + high.x), low.y))
    });
    let names = Points2D::new(places)
        .with_labels(named.iter().map(|(name, _)| name.as_str()))
        .with_colors([color])
        .with_radii([Radius::new_ui_points(0.0)])
        .with_show_labels(true)
        .with_draw_order(7.0);
    let parts: [&dyn AsComponents; 2] = [&lines, &names];
    Ok(stream.log_static(format!("world/geometry/{entity}"), &parts)?)
}

/// Dashes of this length along a line, with gaps as long between them.
fn dashes(line: &[Vector], length: f64) -> Vec<Vec<Vector>> {
    let mut all = Vec::new();
    for ends in line.windows(2) {
        let way = ends[1] - ends[0];
        // An odd number of parts, so that every corner has a dash.
        let parts = ((way.norm() / length / 2.0).floor() as u32).min(500) * 2 + 1;
        let at = |part: u32| ends[0] + way * (f64::from(part) / f64::from(parts));
        all.extend(
            (0..parts)
                .step_by(2)
                .map(|part| vec![at(part), at(part + 1)]),
        );
    }
    all
}
