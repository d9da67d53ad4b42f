//! Differences between two trajectory files.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use super::{Difference, Differences};
use crate::measure::speed;
use engine::math::Vector;
use scenario::trajectories::Tracks;

/// Two positions of a person at the same time differ if they are farther apart than this, meters.
const DIFFER: f64 = 1e-9;

/// What is not compared.
const ABOUT: &str =
    "Compared: who is where and when, by id. Other columns, such as densities and speeds, are not.";

/// The differences between two trajectory files: totals, and the positions of people with the same id at the same time.
pub fn of_tracks(a: &Tracks, b: &Tracks) -> Differences {
    let mut differences = Differences {
        about: ABOUT.to_owned(),
        ..Differences::default()
    };
    differences.add_results(&totals(a), &totals(b));
    differences.results.extend(positions(a, b));
    differences
}

fn totals(tracks: &Tracks) -> Map<String, Value> {
    let ends = [tracks.frames.first(), tracks.frames.last()];
    let [first, last] = ends.map(|frame| frame.map(|&frame| tracks.time(frame)));
    let velocities = speed::velocities(tracks, 1);
    let speeds: Vec<f64> = velocities.iter().flatten().map(Vector::norm).collect();
    let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
    let all = json!({
        "people": tracks.ids.len(),
        "rows": tracks.len(),
        "frames with people": tracks.frames.len(),
        "frames per second": tracks.fps,
        "first time [s]": first,
        "last time [s]": last,
        "mean speed [m/s]": mean,
        "walkable area": tracks.walkable.first(),
    });
    all.as_object().cloned().unwrap_or_default()
}

/// The rows of each file for whose id and time the other one has no row, and the distances between people with the same
/// id at the same times as the value in `b`.
fn positions(a: &Tracks, b: &Tracks) -> Vec<Difference> {
    let rows = |tracks: &Tracks| -> BTreeMap<(i64, i64), Vector> {
        let frames = (0..tracks.frames.len()).flat_map(|k| {
            let micros = (1e6 * tracks.time(tracks.frames[k])).round() as i64;
            tracks.rows(k).map(move |row| (micros, row))
        });
        let id = |row: usize| tracks.ids[tracks.person[row] as usize];
        let all = frames.map(|(micros, row)| ((micros, id(row)), tracks.position[row]));
        all.collect()
    };
    let (a, b) = (rows(a), rows(b));
    let both = a
        .iter()
        .filter_map(|(key, p)| Some((key, (b.get(key)? - p).norm())));
    let (mut count, mut squares, mut largest, mut since) = (0_u64, 0.0, 0.0_f64, None);
    for (&(micros, _), distance) in both {
        count += 1;
        squares += distance * distance;
        largest = largest.max(distance);
        if distance > DIFFER && since.is_none() {
            since = Some(micros as f64 * 1e-6); // in the order of time
        }
    }
    let difference = |name: &str, a: Value, b: Value| Difference {
        name: name.to_owned(),
        a,
        b,
    };
    let alone = [a.len(), b.len()].map(|rows| rows as u64 - count);
    let mut found = Vec::new();
    if alone != [0, 0] {
        let name = "rows with an id and time that the other file lacks";
        found.push(difference(name, json!(alone[0]), json!(alone[1])));
    }
    let Some(since) = since else {
        return found;
    };
    let value = |name: &str, value: Value| difference(name, Value::Null, value);
    found.extend([
        value("positions differ from time [s]", json!(since)),
        value("largest distance [m]", json!(largest)),
        value(
            "root mean square distance [m]",
            json!((squares / count as f64).sqrt()),
        ),
    ]);
    found
}
