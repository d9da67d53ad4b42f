//! Any floor plan gives walls or an error, quickly and within bounded memory.
//!
//! 100,000 cases: half are structured plans on coarse grids with some extreme numbers, half are valid plans with
//! some characters changed. The memory limit is 1 MB plus 2 kB per byte of the text.

use crate::common::bounded::cases;
use crate::common::plan_reading;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use serde_json::{Value, json};

fn read(text: &str) -> u64 {
    plan_reading::read(text);
    (1 << 20) + 2_000 * text.len() as u64
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        20 => (-6..7_i32).prop_map(f64::from),
        8 => (-6..7_i32).prop_map(|x| f64::from(x) * 0.1),
        4 => (-6..7_i32, select(vec![1e-16, 1e-9, -1e-6, 1e-5]))
            .prop_map(|(x, off)| f64::from(x) + off),
        1 => select(vec![1e6, -1e6, 1e7, 1e308, 5e-324, -0.0, 1e-7]),
    ]
}

type Ring = Vec<[f64; 2]>;

/// Any corners, or a rectangle, or a triangle.
fn ring() -> impl Strategy<Value = Ring> {
    let point = || [coordinate(), coordinate()];
    prop_oneof![
        1 => prop::collection::vec(point(), 0..7),
        3 => (point(), point()).prop_map(|([x, y], [z, w])| vec![[x, y], [z, y], [z, w], [x, w]]),
        3 => (point(), point()).prop_map(|([x, y], [z, w])| vec![[x, y], [z, y], [x, w]]),
    ]
}

fn polygons() -> impl Strategy<Value = Vec<Vec<Ring>>> {
    prop::collection::vec(prop::collection::vec(ring(), 1..4), 1..5)
}

/// A plan in one of five formats.
fn written(polygons: &[Vec<Ring>], how: u8) -> String {
    let point = |[x, y]: &[f64; 2]| format!("{x} {y}");
    let join = |parts: Vec<String>| format!("({})", parts.join(","));
    let ring = |ring: &Ring| join(ring.iter().chain(ring.first()).map(point).collect());
    let polygon = |rings: &Vec<Ring>| join(rings.iter().map(ring).collect());
    let each: Vec<String> = polygons.iter().map(polygon).collect();
    let named: Vec<String> = each
        .iter()
        .map(|rings| format!("POLYGON {rings}"))
        .collect();
    let feature = |(k, rings): (usize, &Vec<Ring>)| {
        let kind = if k % 3 == 2 { "obstacle" } else { "floor" };
        json!({"type": "Feature", "properties": {"kind": kind, "name": k.to_string()},
               "geometry": {"type": "Polygon", "coordinates": rings}})
    };
    match how {
        0 => named.join("\n"),
        1 => format!("GEOMETRYCOLLECTION {}", join(named)),
        2 => format!("MULTIPOLYGON {}", join(each)),
        3 => json!({"type": "MultiPolygon", "coordinates": polygons}).to_string(),
        _ => {
            let features: Vec<Value> = polygons.iter().enumerate().map(feature).collect();
            json!({"type": "FeatureCollection", "features": features}).to_string()
        }
    }
}

#[test]
fn any_polygons_are_read_or_refused_at_a_place_in_the_text() {
    let input = || (polygons(), 0..5_u8);
    cases(50_000, input, |(polygons, how)| {
        read(&written(&polygons, how))
    });
}

/// A valid plan in all five formats.
fn valid() -> Vec<String> {
    let square = |x: f64, side: f64| vec![[x, 0.0], [x + side, 0.0], [x + side, side], [x, side]];
    let polygons = [
        vec![square(0.0, 4.0), square(1.0, 1.5)],
        vec![square(3.0, 2.5)],
        vec![square(5.0, 0.7)],
    ];
    (0..5).map(|how| written(&polygons, how)).collect()
}

#[test]
fn a_plan_with_changed_characters_is_read_or_refused() {
    let texts = valid();
    let parts = [
        "(",
        ")",
        ",",
        "[",
        "]",
        "{",
        "}",
        "\"",
        "-",
        "e9",
        ".",
        "0",
        " ",
        "\n",
        ";",
        "nan",
        "null",
        "[]",
        "[1]",
        "()",
        "EMPTY",
        "POLYGON",
        "GEOMETRYCOLLECTION(",
        "SRID=1;",
        "é",
        "\u{0}",
    ];
    let change = || (any::<[Index; 2]>(), 0..6_u8, select(parts.to_vec()));
    let input = || (0..texts.len(), prop::collection::vec(change(), 1..5));
    cases(50_000, input, |(which, changes)| {
        let mut text: Vec<char> = texts[which].chars().collect();
        for (places, how, part) in changes {
            if text.is_empty() {
                break;
            }
            let [from, to] = places.map(|place| place.index(text.len()));
            let (from, to) = (from.min(to), from.max(to));
            let inserted: Vec<char> = match how {
                0 => Vec::new(),
                1 => [&text[from..to], &text[from..to]].concat(),
                2 => text[from..to].iter().rev().copied().collect(),
                _ => part.chars().collect(),
            };
            let until = if how < 3 {
                to
            } else {
                (from + usize::from(how > 3)).min(text.len())
            };
            text.splice(from..until, inserted);
        }
        read(&text.into_iter().collect::<String>())
    });
}
