//! The regions and lines at which a crowd was measured, logged once.

use rerun::{Color, LineStrips2D, Radius, RecordingStream};

use super::error::Cause;
use super::geometry::xy;
use super::names::Names;
use crate::analysis::crossing::Line;
use crate::engine::math::Vector;
use crate::engine::scene::Region;
use crate::output::colors::Rgb;
use crate::output::labels;

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

/// Logs regions and lines, and adds their names.
pub(super) fn log(
    stream: &RecordingStream,
    marked: &Marked,
    names: &mut Names,
) -> Result<(), Cause> {
    let regions = marked.regions.iter().map(|region| {
        let corners = region.corners();
        let outline = corners.iter().chain(&corners[..1]);
        outline.copied().collect()
    });
    let lines = marked.lines.iter().map(|line| vec![line.start, line.end]);
    log_paths((stream, names), "region", regions.collect(), REGION)?;
    log_paths((stream, names), "line", lines.collect(), LINE)
}

fn log_paths(
    (stream, names): (&RecordingStream, &mut Names),
    name: &str,
    paths: Vec<Vec<Vector>>,
    color: Rgb,
) -> Result<(), Cause> {
    if paths.is_empty() {
        return Ok(());
    }
    for (path, number) in paths.iter().zip(1..) {
        let (entity, text) = (
            format!("measured_{name}s/names"),
            format!("{name} {number}"),
        );
        let spots = labels::around(path, false);
        names.add(&entity, paths.len(), &text, (color, &spots));
    }
    let [r, g, b] = color;
    let paths = paths.into_iter();
    let strips = paths.map(|path| path.into_iter().map(xy).collect::<Vec<_>>());
    let strips = LineStrips2D::new(strips)
        .with_radii([Radius::new_ui_points(1.25)])
        .with_colors([Color::from_rgb(r, g, b)])
        .with_draw_order(7.0);
    Ok(stream.log_static(format!("world/geometry/measured_{name}s"), &strips)?)
}
