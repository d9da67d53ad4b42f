//! The parts of a page that do not move, as JSON for its script: floor, walls, places and their names; color bars.

use serde_json::{Value, json};

use analysis::round;
use engine::math::Vector;
use figures::colors::{ColorMap, Rgb};
use figures::plot::{Mark, Style};

/// The number of colors of a bar.
const COLORS: u16 = 256;
/// The most steps between the numbers at a bar.
const MOST_STEPS: i32 = 5;

/// `#rrggbb`.
pub fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A color bar: its text, its colors from the first value to the last, and the numbers beside it.
pub fn bar(text: &str, map: &ColorMap) -> Value {
    let [first, last] = map.range().map(f64::from);
    let colors = (0..COLORS).map(|k| {
        let part = f64::from(k) / f64::from(COLORS - 1);
        let [r, g, b] = map.color((first + part * (last - first)) as f32);
        format!("{r:02x}{g:02x}{b:02x}")
    });
    let ticks = round::ticks([first, last], MOST_STEPS);
    json!({
        "text": text,
        "range": [first, last],
        "colors": colors.collect::<String>(),
        "ticks": ticks.into_iter().map(|at| json!([at, round::text(at)])).collect::<Vec<_>>(),
    })
}

/// Marks, with coordinates in meters from an origin.
pub fn marks(marks: &[Mark], origin: Vector) -> Vec<Value> {
    let place = |[x, y]: [f64; 2]| [x - origin.x, y - origin.y].map(millimeters);
    let flat = |points: &[[f64; 2]]| -> Vec<f64> {
        points.iter().flat_map(|&point| place(point)).collect()
    };
    let look = |style: &Style| json!({"color": hex(style.color), "width": style.width, "broken": style.broken});
    let mark = |mark: &Mark| match mark {
        Mark::Area(corners, color) => Some(json!({"area": flat(corners), "color": hex(*color)})),
        Mark::Line(points, style) => Some(json!({"line": flat(points), "look": look(style)})),
        Mark::Points(points, style) => {
            let points: Vec<[f64; 2]> = points.iter().map(|point| [point.x, point.y]).collect();
            Some(json!({"dots": flat(&points), "look": look(style)}))
        }
        Mark::Label(label) => Some(json!({
            "text": label.text,
            "at": place(label.at),
            "side": label.side,
            "color": hex(label.color),
        })),
        _ => None,
    };
    marks.iter().filter_map(mark).collect()
}

/// Areas with their names.
pub fn areas(areas: &[(String, Vec<Vector>)], origin: Vector) -> Value {
    let area = |(name, corners): &(String, Vec<Vector>)| {
        let places = corners
            .iter()
            .flat_map(|corner| <[f64; 2]>::from(corner - origin).map(millimeters));
        json!({"name": name, "area": places.collect::<Vec<f64>>()})
    };
    areas.iter().map(area).collect()
}

/// The levels of a building, each with its name and two corners of its floor: `null` if there are not several.
pub fn levels(levels: &[(&str, [Vector; 2])], origin: Vector) -> Value {
    if levels.len() < 2 {
        return Value::Null;
    }
    let level = |(name, corners): &(&str, [Vector; 2])| {
        let corners = corners.map(|corner| <[f64; 2]>::from(corner - origin).map(millimeters));
        json!([name, corners])
    };
    levels.iter().map(level).collect()
}

/// Rounded to millimeters.
pub fn millimeters(length: f64) -> f64 {
    (length * 1e3).round() / 1e3
}
