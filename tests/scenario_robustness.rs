//! Any scenario file gives a scenario or an error, quickly and within bounded memory.
//!
//! 80,000 cases here, 20,000 in `geometry_robustness.rs`; more with `BAD_INPUT_TIMES=10 cargo test …`. Valid
//! scenarios run for a few frames. The memory limit of a case is 1 MB plus 150 bytes per byte of the text, 2 kB per
//! agent, and 8 bytes per pair of agents in a small crowd.

use crate::common::bounded::cases;
use crate::common::reading;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use sandbox::scenario::{SHIPPED, Setting};
use serde_json::{Value, json};

fn read(text: &str, settings: &[Setting]) -> u64 {
    let people = reading::read(text, settings);
    (1 << 20) + 150 * text.len() as u64 + 2_000 * people + 8 * people.min(500).pow(2)
}

/// Extreme numbers.
const EXTREMES: [f64; 14] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    5e-324,
    1e-308,
    1e-9,
    1e6,
    -1e6,
    1e7,
    4294967295.0,
    1e19,
    1e308,
    -1e308,
];

/// Values that are invalid in many places.
fn invalid_value() -> impl Strategy<Value = Value> {
    prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        any::<f64>().prop_map(Value::from),
        select(EXTREMES.to_vec()).prop_map(Value::from),
        (-3..30i64).prop_map(Value::from),
        "[a-z>-]{0,6}".prop_map(Value::from),
        select(vec![
            json!({}),
            json!([]),
            json!([[]]),
            json!([0, 0]),
            json!(u64::MAX),
            json!(u32::MAX),
            json!("auto"),
            json!("sf->sph"),
            json!({"base": "rvo"}),
            json!({"blend": [{"at_density": 1e308, "profile": {"navigation": "goal"}}]}),
        ]),
    ]
}

/// JSON of any shape.
fn any_json() -> impl Strategy<Value = Value> {
    let known = [
        "profile",
        "blend",
        "agents",
        "grids",
        "sources",
        "position",
        "parameters",
        "obstacles",
        "goal",
        "min",
        "max",
        "columns",
        "rows",
        "every_secs",
        "times",
        "duration_secs",
        "events",
        "region",
    ];
    let key = prop_oneof![
        "[a-z_]{0,5}",
        select(known.to_vec()).prop_map(str::to_owned),
    ];
    invalid_value().prop_recursive(5, 40, 6, move |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..6).prop_map(Value::from),
            prop::collection::btree_map(key.clone(), inner, 0..6)
                .prop_map(|entries| entries.into_iter().collect::<Value>()),
        ]
    })
}

/// The shipped scenarios with few people, and one with every key.
fn small_scenarios() -> Vec<Value> {
    let mut documents: Vec<Value> = SHIPPED
        .iter()
        .map(|shipped| serde_json::from_str(shipped.text).unwrap())
        .collect();
    for document in &mut documents {
        for kind in ["grids", "sources"] {
            for grid in document
                .get_mut(kind)
                .and_then(Value::as_array_mut)
                .into_iter()
                .flatten()
            {
                for cells in ["columns", "rows"] {
                    grid[cells] = json!(grid[cells].as_u64().unwrap().min(5));
                }
            }
        }
    }
    documents.push(serde_json::from_str(EVERYTHING).unwrap());
    documents
}

const EVERYTHING: &str = r#"{
  "name": "everything", "description": "a line", "seed": 1, "population_seed": 2, "behavior_seed": 3,
  "duration_secs": 1, "preset": "fast", "time_step_secs": "auto", "longest_step_secs": 0.04,
  "coarse_every": 5, "integrator": "velocity-verlet", "wall_method": "union", "precision": "double",
  "neighbor_lists": "coarse", "preferred_speed": 1.4, "max_speed": 1.8,
  "profile": {"blend": [{"at_density": 2, "profile": "rvo"}, {"at_density": 4, "profile": "sph"}]},
  "parameters": {"viscosity": 5, "candidates": 10, "walking_law": "density-ahead", "jam_density": 7}, "goal": [9, 5],
  "obstacles": [[[0, 0], [1, 0], [1, 1]], [[0.5, 0], [2, 0], [2, 1], [0.5, 0.5]]],
  "from": {"people": [[4, 0, 8, 8, 1, 0], [5, 0.3, 2, 8, 0, 0]], "radius": 0.2, "goal": [9, 5]},
  "agents": [{"position": [2, 2], "velocity": [1, 0], "radius": 0.3, "mass": 1, "goal": [3, 3],
              "mean_density": 2, "profile": "sf", "remove_within": 0.5, "counted": false}],
  "grids": [{"name": "g", "min": [3, 3], "max": [5, 5], "columns": 3, "rows": 2, "jitter": 0.1,
             "goal_offset": [1, 0], "profile": {"navigation": "social", "sph": true}}],
  "crowds": [{"area": [[6, 1], [8, 1], [8, 4], [6, 4]], "number": 5, "preferred_speed": "weidmann_age",
              "radius": {"values": [[0.2, 1], [0.25, 2]]}, "mass": {"uniform": [0.8, 1.2]}},
             {"area": [[[6, 6], [8, 6], [8, 8]], [[7.2, 6.2], [7.5, 6.2], [7.5, 6.4]]], "density": 1,
              "spacing": "grid", "premovement_secs": {"weibull": {"scale": 0.3, "shape": 1.2, "max": 5}}}],
  "sources": [{"min": [0, 5], "max": [0, 9], "columns": 1, "rows": 4, "every_secs": 0.5, "start_secs": 0,
               "times": 2}],
  "entrances": [{"line": [[3, 7], [5, 7]], "per_sec": 8, "arrivals": "poisson", "number": 5,
                 "preferred_speed": {"normal": {"mean": 1.3, "std": 0.3}}},
                {"line": [[3, 8], [5, 8]], "at_secs": [0.1, 0.4]}],
  "events": [{"name": "e", "at_secs": 0, "for_secs": 0.5, "region": [[0, 0], [5, 5]], "goal_scale": 3,
              "ignore_contact": true, "ignore_sph": true}],
  "measurements": [{"density": {"at_secs": 0, "region": [[0, 0], [5, 5]]}}, {"flow_of_first": {"arrivals": 2}},
                   {"flow_until": {"until_secs": 1}}, {"evacuated": {}}],
  "stop": {"when_empty": true, "idle_secs": 5},
  "view": {"region": [[0, 0], [9, 9]], "opens_at_secs": 0}, "debug_agents": [0, 1]
}"#;

/// The number of values in `document`, including `document` itself.
fn count(document: &Value) -> usize {
    let inside = match document {
        Value::Array(list) => list.iter().map(count).sum(),
        Value::Object(object) => object.values().map(count).sum(),
        _ => 0,
    };
    1 + inside
}

/// Applies `by` to value number `k`, counted from 0 in depth-first order.
fn change(document: &mut Value, k: &mut usize, by: &mut dyn FnMut(&mut Value)) {
    if *k == 0 {
        by(document);
    }
    *k = k.wrapping_sub(1);
    match document {
        Value::Array(list) => list.iter_mut().for_each(|value| change(value, k, by)),
        Value::Object(object) => object.values_mut().for_each(|value| change(value, k, by)),
        _ => {}
    }
}

/// Changes a value in one of several ways.
fn edit(value: &mut Value, how: u8, by: &Value) {
    match (how, value) {
        (0, Value::Array(list)) => list.extend(list.clone()),
        (1, Value::Array(list)) => list.truncate(list.len() / 2),
        (2, Value::Object(object)) => {
            object.retain(|key, _| key.len() % 2 == 0);
        }
        (3, value) => *value = json!([value]),
        (4, value) if value.is_number() => *value = json!(-value.as_f64().unwrap_or(1.0)),
        (5, value) if value.is_number() => *value = json!(value.as_f64().unwrap_or(1.0) * 1e3),
        (6, value) if value.is_number() => *value = json!(value.as_f64().unwrap_or(1.0) * 1e-3),
        (_, value) => *value = by.clone(),
    }
}

#[test]
fn any_text_is_read_or_refused() {
    cases(10_000, any::<String>, |text| read(&text, &[]));
}

#[test]
fn any_json_is_read_or_refused() {
    cases(20_000, any_json, |document| {
        read(&document.to_string(), &[])
    });
}

#[test]
fn a_scenario_with_changed_values_is_read_or_refused() {
    let documents = small_scenarios();
    let changes = || prop::collection::vec((any::<Index>(), 0..12_u8, invalid_value()), 1..4);
    cases(
        26_000,
        || (0..documents.len(), changes()),
        |(which, changes)| {
            let mut document = documents[which].clone();
            for (index, how, value) in changes {
                let mut k = index.index(count(&document));
                change(&mut document, &mut k, &mut |found| edit(found, how, &value));
            }
            read(&document.to_string(), &[])
        },
    );
}

#[test]
fn a_text_that_is_cut_doubled_or_nested_is_read_or_refused() {
    let texts: Vec<String> = small_scenarios().iter().map(Value::to_string).collect();
    let input = || (0..texts.len(), any::<[Index; 3]>(), 0..5_u8, 1..5_000_usize);
    cases(12_000, input, |(which, places, how, depth)| {
        let text = &texts[which];
        let [from, to, at] = places.map(|place| place.index(text.len()));
        let (from, to) = (from.min(to), from.max(to));
        let (head, rest) = text.split_at(at); // all of it is ASCII
        let piece = &text[from..to];
        let changed = match how {
            0 => head.to_owned(),
            1 => format!("{}{}", &text[..from], &text[to..]),
            2 => format!("{head}{piece}{rest}"),
            3 => format!("{head}{}{rest}", "[".repeat(depth)),
            _ => format!("{}{text}{}", "{\"goal\":".repeat(depth), "}".repeat(depth)),
        };
        read(&changed, &[])
    });
}

#[test]
fn any_setting_is_accepted_or_refused() {
    let known = [
        "profile",
        "sources.0.rows",
        "events.0.region",
        "seed",
        "stop",
        "grids.0.min.1",
    ];
    let key = || {
        prop_oneof![
            "[a-z_.0-9]{0,12}",
            select(known.to_vec()).prop_map(str::to_owned),
        ]
    };
    let text = small_scenarios().pop().unwrap().to_string();
    cases(
        12_000,
        || (key(), invalid_value()),
        |(key, value)| {
            let setting = format!("{key}={value}").parse::<Setting>();
            setting.map_or(1 << 20, |setting| read(&text, &[setting]))
        },
    );
}
