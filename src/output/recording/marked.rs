//! The regions and lines at which a crowd was measured, logged once.

use rerun::{Color, LineStrips2D, Radius, RecordingStream};

use super::error::Cause;
use super::geometry::xy;
use crate::analysis::crossing::Line;
use crate::engine::math::Vector;
use crate::engine::scene::Region;
use crate::output::colors::Rgb;

const REGION: Rgb = [255, 200, 60];
const LINE: Rgb = [255, 110, 200];

/// Regions and lines, which count from 1 in their order.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Marked<'a> {
    /// Rectangles, meters.
    pub regions: &'a [Region],
    /// Lines, meters.
    pub lines: &'a [Line],
}

/// Logs regions and lines with their names.
pub(super) fn log(stream: &RecordingStream, marked: &Marked) -> Result<(), Cause> {
    let regions = marked.regions.iter().map(|region| {
        let corners = region.corners();
        let outline = corners.iter().chain(&corners[..1]);
        outline.copied().collect()
    });
    let lines = marked.lines.iter().map(|line| vec![line.start, line.end]);
    log_paths(stream, "region", regions.collect(), REGION)?;
    log_paths(stream, "line", lines.collect(), LINE)
}

fn log_paths(
    stream: &RecordingStream,
    name: &str,
    paths: Vec<Vec<Vector>>,
    [r, g, b]: Rgb,
) -> Result<(), Cause> {
    if paths.is_empty() {
        return Ok(());
    }
    let names = (1..=paths.len()).map(|number| format!("{name} {number}"));
    let paths = paths.into_iter();
    let strips = paths.map(|path| path.into_iter().map(xy).collect::<Vec<_>>());
    let strips = LineStrips2D::new(strips)
        .with_radii([Radius::new_ui_points(1.25)])
        .with_colors([Color::from_rgb(r, g, b)])
        .with_labels(names)
        .with_draw_order(7.0);
    Ok(stream.log_static(format!("world/geometry/measured_{name}s"), &strips)?)
}
