//! The places where agents enter, push and are measured: outlines with names.

use rerun::{Color, LineStrips2D, Radius, RecordingStream};

use super::RecordingOptions;
use super::error::Cause;
use super::geometry::xy;
use super::names::Names;
use crate::engine::math::Vector;
use crate::engine::scene::{Region, Scene};
use crate::output::colors::Rgb;
use crate::output::labels;
use crate::output::scenery::{self, named};

/// The colors of sources, pushes and measurements.
const SOURCE: Rgb = [0, 170, 200];
const PUSH: Rgb = [230, 110, 90];
const MEASURED: Rgb = [200, 196, 150];
/// The color of texts.
const TEXT: Rgb = [200, 200, 200];
/// The length of a dash and of the gap after it, as a fraction of the longest side of the visible region.
const DASH: f64 = 0.008;

/// Lines through points.
type Strips = Vec<Vec<Vector>>;
/// The style of an outline.
type Draw<'a> = &'a dyn Fn(&[Vector]) -> Strips;
/// Outlines with names, which may be empty.
type Named = Vec<(String, Vec<Vector>)>;

/// Logs the outlines of sources and pushes, and dashed those of measurements; adds their names, and the texts of the
/// options.
pub fn log(
    stream: &RecordingStream,
    scene: &Scene,
    options: &RecordingOptions,
    names: &mut Names,
) -> Result<(), Cause> {
    let sources = scene.sources.iter().map(|source| {
        let (min, max) = (source.grid.min, source.grid.max);
        (named("source", &source.name), closed(&Region { min, max }))
    });
    let pushes = scene.pushes.iter();
    let pushes = pushes.map(|push| (named("push", &push.name), closed(&push.region)));
    let measured = scenery::observed_once(scene, &options.measured).into_iter();
    let measured = measured.map(|(name, outline)| match name.is_empty() {
        true => (name, outline),
        false => (format!("measured: {name}"), outline),
    });
    let dash = DASH * (options.view.max - options.view.min).max();
    let whole = |outline: &[Vector]| vec![outline.to_vec()];
    let dashed = |outline: &[Vector]| dashes(outline, dash);
    let mut log = |entity: &str, named: (Named, Rgb), strips: Draw| {
        log_outlines((stream, &mut *names), entity, named, strips)
    };
    log("sources", (sources.collect(), SOURCE), &whole)?;
    log("pushes", (pushes.collect(), PUSH), &whole)?;
    // Texts lie in their rooms; names of measurements find other places.
    let observed = options.measured.iter().map(|(name, _)| name.as_str());
    for text in scenery::own_texts(scene, observed, &options.labels) {
        names.add_within("names", text, TEXT);
    }
    let measured = (measured.collect(), MEASURED);
    log_outlines((stream, names), "measured", measured, &dashed)
}

fn closed(region: &Region) -> Vec<Vector> {
    let corners = region.corners();
    corners.into_iter().chain([corners[0]]).collect()
}

/// Logs outlines, and adds their names.
fn log_outlines(
    (stream, names): (&RecordingStream, &mut Names),
    entity: &str,
    (named, color): (Named, Rgb),
    strips: Draw,
) -> Result<(), Cause> {
    if named.is_empty() {
        return Ok(());
    }
    for (name, outline) in &named {
        let spots = labels::around(outline, false);
        let entity = format!("{entity}/names");
        names.add(&entity, named.len(), name, (color, &spots));
    }
    let [r, g, b] = color;
    let lines = named.iter().flat_map(|(_, outline)| strips(outline));
    let lines = LineStrips2D::new(lines.map(|line| line.into_iter().map(xy).collect::<Vec<_>>()))
        .with_radii([Radius::new_ui_points(1.0)])
        .with_colors([Color::from_rgb(r, g, b)])
        .with_draw_order(3.0);
    Ok(stream.log_static(format!("world/geometry/{entity}"), &lines)?)
}

/// Dashes of this length along a line, with gaps as long between them.
fn dashes(line: &[Vector], length: f64) -> Strips {
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
