//! Random floors with two to four exits of unequal widths.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;
use serde_json::{Value, json};

use super::floors::Plan;
use super::plans::Ring;

/// The families of floors.
pub const FAMILIES: [&str; 4] = ["rooms", "halls", "corridors", "drawn"];

/// A floor of a family with its exits and its crowd.
pub fn floor(rng: &mut ChaCha8Rng, family: &str) -> Value {
    let (rings, ends) = match family {
        "rooms" => rooms(rng),
        "halls" => hall(rng),
        "corridors" => corridor(rng),
        _ => (Plan::drawn(rng).rings, Vec::new()),
    };
    let lines = match ends.is_empty() {
        true => on_sides(rng, &rings[0]),
        false => ends,
    };
    let exits = lines.iter().enumerate();
    let exits: Vec<Value> = exits
        .map(|(k, line)| json!({"name": format!("exit {k}"), "line": line}))
        .collect();
    let area = match family {
        "halls" => part(rng, &rings[0]),
        _ => rings[0].clone(),
    };
    let number = match family {
        "halls" => rng.random_range(40..120),
        "corridors" | "rooms" => 60,
        _ => 40,
    };
    json!({
        "duration_secs": 240, "profile": "walk+sph",
        "walkable_area": [[rings[0]]], "obstacles": rings[1..],
        "exits": exits, "crowds": [{"area": area, "number": number}],
        "stop": {"when_empty": true},
    })
}

fn rectangle(low: [f64; 2], high: [f64; 2]) -> Ring {
    vec![low, [high[0], low[1]], high, [low[0], high[1]]]
}

/// Two to four exits on different parts of the outline, 0.8 m to 2 m wide.
fn on_sides(rng: &mut ChaCha8Rng, outline: &Ring) -> Vec<[[f64; 2]; 2]> {
    let corners: Vec<Vector> = outline.iter().map(|&p| p.into()).collect();
    let count = rng.random_range(2..5);
    let mut lines: Vec<[Vector; 2]> = Vec::new();
    while lines.len() < count {
        let k = rng.random_range(0..corners.len());
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        let (long, width) = ((b - a).norm(), rng.random_range(0.8..2.0));
        if long < width + 1.0 {
            continue;
        }
        let from = rng.random_range(0.5..long - width - 0.5 + 1e-9);
        let along = (b - a) / long;
        let line = [a + from * along, a + (from + width) * along];
        let middle = |line: &[Vector; 2]| 0.5 * (line[0] + line[1]);
        let is_apart = |other: &[Vector; 2]| (middle(other) - middle(&line)).norm() > 3.0;
        if lines.iter().all(is_apart) {
            lines.push(line);
        }
    }
    lines.into_iter().map(|line| line.map(Into::into)).collect()
}

/// A part of a rectangle.
fn part(rng: &mut ChaCha8Rng, outline: &Ring) -> Ring {
    let [w, h] = outline[2];
    let [across, up] = [
        rng.random_range(0.4..1.0) * w,
        rng.random_range(0.5..1.0) * h,
    ];
    let [x, y] = [
        rng.random_range(0.0..1.0) * (w - across),
        rng.random_range(0.0..1.0) * (h - up),
    ];
    rectangle([x, y], [x + across, y + up])
}

/// A wall of this thickness from `a` to `b` along x (`turned`: along y), with a door of some width.
fn wall(rng: &mut ChaCha8Rng, at: f64, [a, b]: [f64; 2], turned: bool) -> Vec<Ring> {
    let width = rng.random_range(0.8..1.7);
    let from = rng.random_range(a + 0.4..b - width - 0.4);
    let pieces = [[a - 0.01, from], [from + width, b + 0.01]];
    let rings = pieces.map(|[low, high]| match turned {
        false => rectangle([low, at], [high, at + 0.2]),
        true => rectangle([at, low], [at + 0.2, high]),
    });
    rings.to_vec()
}

/// Six rooms, with a door between each two neighbors.
fn rooms(rng: &mut ChaCha8Rng) -> (Vec<Ring>, Vec<[[f64; 2]; 2]>) {
    let mut rings = vec![rectangle([0.0, 0.0], [18.0, 10.0])];
    for x in [6.0, 12.0] {
        rings.extend(wall(rng, x, [0.0, 5.0], true));
        rings.extend(wall(rng, x, [5.2, 10.0], true));
    }
    for x in [0.0, 6.2, 12.2] {
        rings.extend(wall(rng, 5.0, [x, x + 5.8], false));
    }
    (rings, Vec::new())
}

/// A hall, in which most have a few pillars.
fn hall(rng: &mut ChaCha8Rng) -> (Vec<Ring>, Vec<[[f64; 2]; 2]>) {
    let [w, h] = [rng.random_range(12.0..24.0), rng.random_range(8.0..16.0)];
    let mut rings = vec![rectangle([0.0, 0.0], [w, h])];
    for k in 0..rng.random_range(0..4) {
        let x = w * (0.2 + 0.2 * f64::from(k));
        let y = rng.random_range(0.3..0.6) * h;
        rings.push(rectangle([x, y], [x + 0.5, y + 0.5]));
    }
    (rings, Vec::new())
}

/// A corridor with rooms at both sides, and exits at its ends and in some rooms.
fn corridor(rng: &mut ChaCha8Rng) -> (Vec<Ring>, Vec<[[f64; 2]; 2]>) {
    let (long, deep, wide) = (24.0, 4.0, rng.random_range(1.6..3.0));
    let top = 2.0 * deep + wide;
    let mut rings = vec![rectangle([0.0, 0.0], [long, top])];
    for y in [deep - 0.2, deep + wide] {
        for x in [0.0, 6.0, 12.0, 18.0] {
            rings.extend(wall(rng, y, [x, x + 5.8], false));
            rings.push(rectangle([x + 5.79, y], [x + 6.01, y + 0.2]));
        }
    }
    for x in [5.8, 11.8, 17.8] {
        for [a, b] in [[-0.01, deep - 0.1], [deep + wide + 0.1, top + 0.01]] {
            rings.push(rectangle([x, a], [x + 0.2, b]));
        }
    }
    let end = |rng: &mut ChaCha8Rng, x: f64| {
        let width = rng.random_range(0.8..1.5);
        let low = deep + rng.random_range(0.0..1.0) * (wide - width);
        [[x, low], [x, low + width]]
    };
    let side = |rng: &mut ChaCha8Rng, y: f64| {
        let width = rng.random_range(0.8..1.8);
        let low = 6.0 * f64::from(rng.random_range(0..4)) + rng.random_range(0.5..5.3 - width);
        [[low, y], [low + width, y]]
    };
    let mut ends = vec![end(rng, 0.0), end(rng, long)];
    let more = rng.random_range(0..3);
    ends.extend((0..more).map(|k| side(rng, if k == 0 { 0.0 } else { top })));
    (rings, ends)
}
