//! Color bars beside the crowd.

use rerun::{AsComponents, Image, LineStrips2D, RecordingStream, Transform3D};

use crate::recording::draw::{color, px, texts};
use crate::recording::error::Cause;
use crate::recording::frame::crowd::Maps;
use analysis::round;
use engine::math::Vector;
use engine::scene::Region;
use figures::colors::{ColorMap, Rgb};

/// The entities of the bars.
pub const DENSITY: &str = "world/legend/density";
pub const SPEED: &str = "world/legend/speed";
/// Distance from the visible region to the bar, width of the bar, and distance from its left side to the middle of the
/// numbers; as parts of the region's longest side.
const GAP: f64 = 0.02;
const WIDTH: f64 = 0.02;
const NUMBERS: f64 = 0.045;
/// The width of bar and numbers together, as a fraction of that side.
const ROOM: f64 = 0.1;
/// The height of a number's point above the number, which the viewer writes below it; as a fraction of that side.
const RAISED: f64 = 0.012;
/// The height of the bar as a fraction of the region's height.
const HEIGHT: f64 = 0.8;
/// The length of a tick, and the height of the unit above the bar, as parts of that side.
const TICK: f64 = 0.006;
const UNIT: f64 = 0.045;
/// Bands of color of a bar.
const BANDS: u16 = 64;
/// The most steps between numbers.
const MOST_STEPS: i32 = 5;
const TEXT: Rgb = [214, 214, 222];

/// The region with its bar.
pub fn with_bar(view: &Region) -> Region {
    let room = Vector::new(longest(view) * ROOM, 0.0);
    Region {
        min: view.min,
        max: view.max + room,
    }
}

fn longest(view: &Region) -> f64 {
    (view.max - view.min).max()
}

/// Logs the bars of densities and of speeds.
pub fn log(stream: &RecordingStream, view: &Region, maps: &Maps) -> Result<(), Cause> {
    log_bar(stream, DENSITY, (view, &maps.density, "P/m²"))?;
    log_bar(stream, SPEED, (view, &maps.speed, "m/s"))
}

fn log_bar(
    stream: &RecordingStream,
    entity: &str,
    (view, map, unit): (&Region, &ColorMap, &str),
) -> Result<(), Cause> {
    let side = longest(view);
    let [first, last] = map.range().map(f64::from);
    let height = HEIGHT * (view.max.y - view.min.y);
    let low = 0.5 * (view.min.y + view.max.y - height);
    let left = view.max.x + GAP * side;
    let right = left + WIDTH * side;
    let colors = (0..BANDS).flat_map(|k| {
        let part = (f64::from(k) + 0.5) / f64::from(BANDS);
        map.color((first + (last - first) * part) as f32)
    });
    let pixels = Image::from_rgb24(colors.collect::<Vec<u8>>(), [1, BANDS.into()]);
    let place = Transform3D::from_translation_scale(
        [left as f32, low as f32, 0.0],
        [
            (right - left) as f32,
            (height / f64::from(BANDS)) as f32,
            1.0,
        ],
    );
    let image = pixels.with_draw_order(30.0);
    let plane: [&dyn AsComponents; 2] = [&place, &image];
    stream.log_static(format!("{entity}/colors"), &plane)?;
    let steps = round::ticks([first, last], MOST_STEPS);
    let at = |value: f64| low + height * (value - first) / (last - first);
    let strokes = steps.iter().map(|&value| {
        let y = at(value) as f32;
        [[right as f32, y], [(right + TICK * side) as f32, y]]
    });
    let ticks = LineStrips2D::new(strokes)
        .with_colors([color(TEXT)])
        .with_radii(px(0.6))
        .with_draw_order(30.0);
    let middle = (left + NUMBERS * side) as f32;
    let top = (low + height + UNIT * side).min(view.max.y);
    let above = [0.5 * (left + right), top].map(|x| x as f32);
    let beside = |&value: &f64| [middle, (at(value) + RAISED * side) as f32];
    let places = steps.iter().map(beside).chain([above]);
    let numbers = steps.iter().map(|&value| round::text(value));
    let texts = texts(places, numbers.chain([unit.to_owned()]))
        .with_colors([color(TEXT)])
        .with_draw_order(31.0);
    let parts: [&dyn AsComponents; 2] = [&ticks, &texts];
    Ok(stream.log_static(entity, &parts)?)
}
