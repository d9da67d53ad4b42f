//! Where agents enter, push and are measured: outlines with names.

use rerun::{AsComponents, Color, LineStrips2D, Points2D, Radius, RecordingStream};

use super::RecordingOptions;
use super::error::Cause;
use super::geometry::xy;
use crate::engine::math::{Vector, bounds};
use crate::engine::scene::{Region, Scene};
use crate::output::colors::Rgb;
use crate::output::scenery::named;

/// The colors of sources, pushes and measurements.
const SOURCE: Rgb = [0, 170, 200];
const PUSH: Rgb = [230, 110, 90];
const MEASURED: Rgb = [200, 196, 150];
/// The length of a dash and of the gap after it, as a part of the longest side of the visible region.
const DASH: f64 = 0.008;

/// The usual width of a view of the crowd, and of a letter in it, pixels: the room for texts before zooming in.
const PANEL: f64 = 700.0;
const LETTER: f64 = 8.0;
/// The height of a label below its point, pixels.
const LABEL: f64 = 25.0;

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
        (named("source", &source.name), closed(&Region { min, max }))
    });
    let pushes = scene.pushes.iter();
    let pushes = pushes.map(|push| (named("push", &push.name), closed(&push.region)));
    let measured = options.measured.iter().map(|(name, outline)| {
        let name = format!("measured: {name}");
        (name, outline.clone())
    });
    let dash = DASH * (options.view.max - options.view.min).max();
    let whole = |outline: &[Vector]| vec![outline.to_vec()];
    let log =
        |entity: &str, named: (&Named, Rgb), strips: &dyn Fn(&[Vector]) -> Vec<Vec<Vector>>| {
            log_outlines((stream, &options.view), entity, named, strips)
        };
    log("sources", (&sources.collect(), SOURCE), &whole)?;
    log("pushes", (&pushes.collect(), PUSH), &whole)?;
    let dashed = |outline: &[Vector]| dashes(outline, dash);
    log("measured", (&measured.collect(), MEASURED), &dashed)
}

/// The width of a text in a view, meters, before zooming in.
pub fn text_width(text: &str, view: &Region) -> f64 {
    LETTER * text.chars().count() as f64 * (view.max.x - view.min.x) / PANEL
}

/// The point of the label of something with these corners: below it, but so that the view does not cut the label.
pub fn label_place(
    text: &str,
    corners: impl IntoIterator<Item = Vector>,
    view: &Region,
) -> [f32; 2] {
    let [low, high] = bounds(corners).unwrap_or_default();
    let height = LABEL * (view.max.x - view.min.x) / PANEL;
    let margin = Vector::new(0.5 * text_width(text, view), height);
    let (least, most) = (view.min + margin, view.max - margin);
    let below = Vector::new(0.5 * (low.x + high.x), low.y);
    xy(below.sup(&least).inf(&most))
}

fn closed(region: &Region) -> Vec<Vector> {
    let corners = region.corners();
    corners.into_iter().chain([corners[0]]).collect()
}

fn log_outlines(
    (stream, view): (&RecordingStream, &Region),
    entity: &str,
    (named, [r, g, b]): (&Named, Rgb),
    strips: &dyn Fn(&[Vector]) -> Vec<Vec<Vector>>,
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
    let places = named.iter();
    let places = places.map(|(name, outline)| label_place(name, outline.iter().copied(), view));
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
