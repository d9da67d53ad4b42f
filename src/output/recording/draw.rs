//! Colors, lines, texts, images and time series as rerun's types.

use rerun::components::{ImageFormat, Text};
use rerun::{
    AnnotationContext, AsComponents, ChannelDatatype, Color, ColorModel, EntityPath, LineStrips2D,
    Points2D, Radius, RecordingStream, Rgba32, SegmentationImage, SeriesLines, Transform3D,
};

use super::error::Cause;
use analysis::way_field::Grid;
use engine::levels::Level;
use engine::math::Vector;
use figures::colors::Rgb;

/// A place, meters.
pub type Point = [f32; 2];

/// The look of lines: their color, half their width in pixels, and their drawing order.
pub type Look = (Rgb, f32, f32);

/// A class of pixels: its number, its name, and its color.
pub type Class = (u8, String, Rgba32);

pub fn xy(v: Vector) -> Point {
    [v.x as f32, v.y as f32]
}

/// A place in a building, meters.
pub type Place = [f32; 3];

/// A place on a level of a building.
pub fn xyz(level: &Level, p: Vector) -> Place {
    [p.x, p.y, level.height(p)].map(|x| x as f32)
}

pub fn color([r, g, b]: Rgb) -> Color {
    Color::from_rgb(r, g, b)
}

/// Half a width, pixels.
pub fn px(half: f32) -> [Radius; 1] {
    [Radius::new_ui_points(half)]
}

/// Turns y up: the viewer's 2D views have y down.
pub fn y_up() -> Transform3D {
    Transform3D::from_scale([1.0, -1.0, 1.0])
}

/// Logs lines below `world/geometry`, if there are any.
pub fn log_lines(
    stream: &RecordingStream,
    entity: &str,
    (rgb, half_width, order): Look,
    lines: impl IntoIterator<Item = Vec<Vector>>,
) -> Result<(), Cause> {
    let outlines = lines.into_iter();
    let placed = outlines.map(|line| line.into_iter().map(xy).collect::<Vec<_>>());
    let strips: Vec<_> = placed.collect();
    if strips.is_empty() {
        return Ok(());
    }
    let lines = LineStrips2D::new(strips)
        .with_radii(px(half_width))
        .with_colors([color(rgb)])
        .with_draw_order(order);
    Ok(stream.log_static(format!("world/geometry/{entity}"), &lines)?)
}

/// Texts, which the viewer writes below their points.
pub fn texts(
    points: impl IntoIterator<Item = Point>,
    texts: impl IntoIterator<Item = impl Into<Text>>,
) -> Points2D {
    Points2D::new(points)
        .with_labels(texts)
        .with_radii(px(0.0))
        .with_show_labels(true)
}

/// Logs the classes of the cells of a grid as an image.
pub fn log_classes(
    stream: &RecordingStream,
    entity: impl Into<EntityPath>,
    (grid, pixels): (&Grid, Vec<u8>),
    classes: &[Class],
    order: f32,
) -> Result<(), Cause> {
    let all = classes.iter();
    let classes = all.map(|(id, name, color)| (u16::from(*id), name.as_str(), *color));
    let size = [grid.columns as u32, grid.rows as u32];
    let format = ImageFormat::from_color_model(size, ColorModel::L, ChannelDatatype::U8);
    let image = SegmentationImage::new(pixels, format)
        .with_opacity(1.0)
        .with_draw_order(order);
    let ([x, y], side) = (xy(grid.min), grid.cell as f32);
    let place = Transform3D::from_translation_scale([x, y, 0.0], [side; 3]);
    let parts: [&dyn AsComponents; 3] = [&place, &AnnotationContext::new(classes), &image];
    Ok(stream.log_static(entity, &parts)?)
}

/// Logs the name and the color of a time series; without a color, the viewer chooses one.
pub fn log_series(
    stream: &RecordingStream,
    entity: impl Into<EntityPath>,
    name: &str,
    rgb: Option<Rgb>,
) -> Result<(), Cause> {
    let mut style = SeriesLines::new().with_names([name]).with_widths([1.5]);
    if let Some(rgb) = rgb {
        style = style.with_colors([color(rgb)]);
    }
    Ok(stream.log_static(entity, &style)?)
}
