//! The schema of scenarios accepts what the program accepts, and has every key, word and range.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::common::documents::{count, invalid_value, replace};
use crate::common::json_schema::refusal;
use proptest::prelude::*;
use sandbox::scenario::{SHIPPED, Scenario, schema};
use serde_json::{Value, json};

/// A scenario with every key.
fn whole() -> Value {
    json!({
        "$schema": "scenario.schema.json", "name": "whole", "description": "", "seed": 1,
        "population_seed": 2, "behavior_seed": 3, "duration_secs": 5.5, "preset": "fast",
        "time_step_secs": "auto", "longest_step_secs": 0.05, "coarse_every": 3,
        "integrator": "velocity-verlet", "wall_method": "union", "precision": "double",
        "neighbor_lists": "coarse", "navigation": "straight", "min_passage_width": 0.3, "preferred_speed": 1.4, "max_speed": 2, "goal": [5, 5],
        "profile": {"name": "own", "blend": [
            {"at_density": 2, "profile": "sf"},
            {"at_density": 4, "profile": {"base": "sph", "parameters": {"viscosity": 1}}}
        ]},
        "parameters": {"goal_scale": 2, "candidates": 30, "walking_law": "headway", "lane_half_width": 0.4},
        "walkable_area": [[[[0, 0], [9, 0], [9, 9]], [[5, 2], [6, 2], [6, 3]]]],
        "obstacles": [[[0, 0], [1, 0], [1, 1]], [[[3, 1], [5, 1], [5, 3]], [[4, 1.5], [4.5, 1.5], [4.5, 2]]]],
        "from": {"name": "f", "people": [[17, 0, 7, 0.5, 1, 0], [18.0, 0.2, 8, 8, 0, 0]], "goal": [8, 8], "profile": "sph",
                 "remove_within": 0.5, "counted": true, "preferred_speed": 1.2, "radius": 0.2, "mass": 1},
        "agents": [
            {"position": [2, 1], "velocity": [1, 0], "radius": 0.2, "mass": 1, "goal": [8, 1],
             "mean_density": 2, "preferred_speed": 1.3, "premovement_secs": 2, "profile": {"navigation": "rvo", "sph": false}, "remove_within": 1,
             "counted": false},
            {"position": [3, 1], "profile": null}
        ],
        "grids": [{"name": "g", "min": [7, 3], "max": [8, 4], "columns": 2, "rows": 2, "jitter": 0.1,
                   "goal_offset": [1, 0], "preferred_speed": "weidmann_age", "radius": {"values": [[0.2, 1]]}, "mass": 1,
                   "premovement_secs": {"exponential": {"mean": 2, "min": 1, "max": 9}}, "profile": "rvo->sph", "remove_within": 0.5, "counted": true}],
        "crowds": [{"name": "c", "area": [[[6.5, 1], [8.5, 1], [8.5, 3], [6.5, 3]], [[7, 2], [8, 2], [8, 2.5]]],
                    "number": 4, "spacing": "grid", "goal": [8, 8], "profile": "sph", "remove_within": 0.5,
                    "counted": true, "preferred_speed": {"normal": {"mean": 1.34, "std": 0.2, "min": 1, "max": 2}},
                    "radius": {"uniform": [0.2, 0.22]}, "mass": {"uniform": [0.9, 1.1]},
                    "premovement_secs": {"lognormal": {"mean": 2, "std": 1, "min": 1, "max": 9}}}],
        "sources": [{"name": "s", "min": [7, 2], "max": [8, 2], "columns": 2, "rows": 1, "goal": [1, 0],
                     "start_secs": 1, "every_secs": 1, "times": 3}],
        "entrances": [{"name": "i", "line": [[6.5, 0.5], [8.5, 0.5]], "per_sec": 2, "arrivals": "poisson",
                       "from_secs": 1, "until_secs": 4, "number": 5, "goal": [8, 8], "profile": "sph",
                       "remove_within": 0.5, "counted": true, "preferred_speed": 1.2, "radius": 0.2, "mass": 1,
                       "premovement_secs": {"gamma": {"shape": 2, "scale": 1, "max": 5}}},
                      {"line": [[6.5, 0.5], [8.5, 0.5]], "at_secs": [1, 2.5]}],
        "events": [{"name": "e", "at_secs": 1, "for_secs": 1, "region": [[0, 0], [5, 5]], "goal_scale": 3,
                    "ignore_contact": true, "ignore_sph": false}],
        "measurements": [{"density": {"at_secs": 5, "region": [[0, 0], [5, 5]]}}, {"evacuated": {}},
                         {"flow_of_first": {"arrivals": 2}}, {"flow_until": {"until_secs": 5}},
                         {"walks": {"name": "w", "region": [[0, 0], [5, 5]], "from_secs": 1, "until_secs": 5}},
                         {"line_flow": {"name": "l", "line": [[0, 0], [5, 0]], "region": [[0, 0], [5, 5]], "part": [0.2, 0.8]}}],
        "stop": {"when_empty": true, "idle_secs": 5},
        "view": {"region": [[0, 0], [9, 9]], "opens_at_secs": 1, "density_range": [0, 8], "speed_range": [0.1, 2]},
        "debug_agents": [0, 1]
    })
}

fn parsed(document: &Value) -> Result<Scenario, String> {
    Scenario::parse(&document.to_string(), "f.json", &[]).map_err(|error| error.to_string())
}

fn refused(schema: &Value, document: &Value) -> Option<String> {
    refusal(schema, schema, document)
}

#[test]
fn program_and_schema_refuse_journeys_and_queues_without_stages_places_or_points() {
    let stages = |stages: Value| json!([{"name": "j", "stages": stages}]);
    let queue = |path: Value| json!([{"name": "q", "path": path, "service_secs": 1}]);
    let cases = [
        (
            "journeys",
            stages(json!([])),
            "journeys[0].stages: must not be empty",
        ),
        (
            "journeys",
            stages(json!([{"nearest": []}])),
            "journeys[0].stages[0].nearest: must not be empty",
        ),
        (
            "journeys",
            stages(json!([{"quickest": []}])),
            "journeys[0].stages[0].quickest: must not be empty",
        ),
        (
            "journeys",
            stages(json!([{"fewest": []}])),
            "journeys[0].stages[0].fewest: must not be empty",
        ),
        (
            "queues",
            queue(json!([])),
            "queues[0].path: needs at least 2 points",
        ),
        (
            "queues",
            queue(json!([[1, 1]])),
            "queues[0].path: needs at least 2 points",
        ),
    ];
    let walkers = [json!({"goal": [9, 9]}), json!({"journey": "j"})];
    for (key, list, message) in cases {
        for mut walker in walkers.clone() {
            walker["position"] = json!([2, 2]);
            let document = json!({"agents": [walker], key: list});
            let error = Scenario::parse(&document.to_string(), "f.json", &[]).unwrap_err();
            assert!(error.to_string().contains(message), "{error}");
            assert!(refused(&schema(), &document).is_some(), "{document}");
        }
    }
}

#[test]
fn all_scenario_files_and_one_with_every_key_are_valid() {
    let schema = schema();
    let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios");
    let mut seen = 0;
    for folder in ["", "stress", "accuracy", "verification"].map(|folder| scenarios.join(folder)) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path
                .extension()
                .is_some_and(|extension| extension == "json")
            {
                let document = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
                assert_eq!(refused(&schema, &document), None, "{}", path.display());
                let scenario = Scenario::load(&path, &[]).unwrap();
                assert_eq!(refused(&schema, &scenario.document), None);
                seen += 1;
            }
        }
    }
    assert!(seen > 20, "{seen}");
    assert_eq!(refused(&schema, &whole()), None);
    let scenario = parsed(&whole()).unwrap();
    assert_eq!(scenario.document.get("$schema"), None);
    assert!(
        parsed(&json!({"$schema": 5}))
            .unwrap_err()
            .contains("$schema")
    );
}

/// The valid keys at `pointer` in `whole`, from the error message for an additional key `?`.
fn known(pointer: &str) -> Vec<String> {
    let mut document = whole();
    let object = document.pointer_mut(pointer).unwrap();
    object
        .as_object_mut()
        .unwrap()
        .insert("?".to_owned(), json!(0));
    let error = parsed(&document).unwrap_err();
    let (_, names) = error
        .split_once("`?`, ")
        .unwrap_or_else(|| panic!("{error}"));
    names
        .split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

#[test]
fn every_object_has_the_keys_that_the_parser_knows() {
    let schema = schema();
    for (pointer, place) in [
        ("", ""),
        ("/parameters", "/$defs/Parameters"),
        ("/profile", "/$defs/CustomProfile"),
        ("/profile/blend/0", "/$defs/Step"),
        ("/agents/0", "/$defs/Agent"),
        ("/grids/0", "/properties/grids/items"),
        ("/crowds/0", "/$defs/Crowd"),
        ("/crowds/0/preferred_speed/normal", "/$defs/Normal"),
        ("/crowds/0/premovement_secs/lognormal", "/$defs/Lognormal"),
        ("/sources/0", "/properties/sources/items"),
        ("/entrances/0", "/$defs/Entrance"),
        ("/from", "/$defs/FromData"),
        ("/events/0", "/$defs/Event"),
        ("/measurements/0/density", "/$defs/Density"),
        ("/measurements/2/flow_of_first", "/$defs/FlowOfFirst"),
        ("/measurements/3/flow_until", "/$defs/FlowUntil"),
        ("/measurements/4/walks", "/$defs/Walks"),
        ("/stop", "/$defs/Stop"),
        ("/view", "/$defs/View"),
    ] {
        let object = schema.pointer(place).unwrap();
        let properties = object["properties"].as_object().unwrap();
        let mut keys: Vec<&str> = properties.keys().map(String::as_str).collect();
        keys.retain(|key| !["$schema", "behaviour_seed"].contains(key));
        let mut expected = known(pointer);
        expected.sort();
        assert_eq!(keys, expected, "{place}");
        // The parser refuses an object without a key if and only if the key is required.
        let required = object
            .get("required")
            .map_or(vec![], |keys| keys.as_array().unwrap().clone());
        for key in keys {
            let mut document = whole();
            let there = document
                .pointer_mut(pointer)
                .unwrap()
                .as_object_mut()
                .unwrap();
            if there.remove(key).is_some() {
                let missing = parsed(&document).is_err_and(|error| error.contains("missing key"));
                assert_eq!(required.contains(&json!(key)), missing, "{place} {key}");
            }
        }
        for (key, property) in properties {
            assert!(
                property["description"]
                    .as_str()
                    .is_some_and(|d| !d.is_empty()),
                "{key}"
            );
        }
    }
}

#[test]
fn every_enum_has_the_words_that_the_parser_knows() {
    let schema = schema();
    for key in [
        "preset",
        "integrator",
        "wall_method",
        "precision",
        "neighbor_lists",
    ] {
        let property = &schema["properties"][key];
        let presets = schema["$defs"]["Preset"]["oneOf"].as_array().unwrap();
        let mut words: Vec<&str> = match property["enum"].as_array() {
            Some(words) => words.iter().filter_map(Value::as_str).collect(),
            None => presets
                .iter()
                .filter_map(|preset| preset["const"].as_str())
                .collect(),
        };
        let error = parsed(&json!({ key: "?" })).unwrap_err();
        let mut known: Vec<&str> = error.split('`').skip(3).step_by(2).collect();
        assert!(
            words.contains(&property["default"].as_str().unwrap()),
            "{key}"
        );
        known.sort();
        words.sort();
        assert_eq!(words, known, "{key}");
    }
}

/// Messages about rules that no schema can express: relations between values, and geometry.
const RELATIONS: &[&str] = &[
    "lower left corner comes first",
    "too many",
    "is already measured",
    "there is no journey named",
    "would stand at one point",
    "encloses no area",
    "must be less than the second",
    "is listed twice",
    "give one of ",
    "no goal",
    "either `goal` or `goal_offset`",
    "remove one",
    "crosses or touches itself",
    "is allowed only with `navigation`",
    "densities must rise",
    "a blend must consist of plain profiles",
    "must be the same in all profiles of a blend",
    "share one velocity of RVO",
    "is above rest_density_max",
    "is above max_speed",
    "key `seed` is given twice",
    "agents in the square meter",
    "floating point `1.8446744073709552e+19`", // an integer for a schema
    "profiles in one blend",
    "no free point is near",
    "needs either `",
    ", and not both",
    "is for `per_sec`",
    "is for `trajectory`",
    "either `trajectory` or `people`",
    "enters at -1 s",
    "is in an obstacle or outside",
    "m from the origin",
    "cannot be read: ",
    "is not after from_secs",
    "the same point",
    "can stand on it",
    "do not fit",
    "lies in obstacles",
    "two rings cross",
    "the smaller number comes first",
    "is not between",
    "one in a million",
    "is not below max",
    "needs at least one value",
    "a weight must",
    "is for `preferred_speed` only",
];

#[test]
fn the_schema_refuses_what_the_parser_refuses() {
    let schema = schema();
    let table = include_str!("data/broken_scenarios.json");
    let cases: BTreeMap<String, Vec<Value>> = serde_json::from_str(table).unwrap();
    let mut seen = 0;
    for case in cases.into_values().flatten() {
        let mut document = whole();
        document["profile"] = json!("sph");
        let (parent, key) = case["at"].as_str().unwrap().rsplit_once('/').unwrap();
        match document.pointer_mut(parent).unwrap() {
            Value::Object(object) => drop(object.insert(key.to_owned(), case["put"].clone())),
            Value::Array(list) => list[key.parse::<usize>().unwrap()] = case["put"].clone(),
            _ => panic!("nothing can be put into {parent}"),
        }
        if RELATIONS
            .iter()
            .any(|said| case["message"].as_str().unwrap().contains(said))
        {
            continue;
        }
        assert!(parsed(&document).is_err(), "{case}");
        assert!(refused(&schema, &document).is_some(), "{case}");
        seen += 1;
    }
    assert!(seen > 40, "{seen}");
    for document in [
        json!([]),
        json!({"obstacles": [[[0, 0], [1, 0]]]}),
        json!({"obstacles": [[[0, 0], [1, 0], [1, "x"]]]}),
        json!({"obstacles": [[[0, 0], [1, 0], [[1, 0], [2, 0], [2, 2]]]]}),
        json!({"obstacles": null}),
        json!({"walkable_area": [[[0, 0], [1, 0], [1, 1]]]}),
        json!({"walkable_area": []}),
        json!({"walkable_area": 5}),
        json!({"walkable_area": {"type": "Polygon"}}),
        json!({"measurements": ["evacuated"]}),
        json!({"measurements": [{"evacuated": []}]}),
        json!({"measurements": [{"density": [5]}]}),
        json!({"measurements": [{"evacuated": {}, "density": {"at_secs": 1}}]}),
        json!({"profile": {"base": "sf", "navigation": "goal"}}),
        json!({"profile": {"parameters": {}}}),
        json!({"debug_agents": [-1]}),
    ] {
        assert!(parsed(&document).is_err(), "{document}");
        assert!(refused(&schema, &document).is_some(), "{document}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(4000) })]

    #[test]
    fn every_document_that_the_parser_accepts_is_valid(
        which in 0..=2 * SHIPPED.len(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), invalid_value()), 1..3),
    ) {
        let mut document: Value = match SHIPPED.get(which) {
            Some(shipped) => serde_json::from_str(shipped.text).unwrap(),
            None => whole(),
        };
        for (index, value) in changes {
            let mut k = index.index(count(&document));
            replace(&mut document, &mut k, &value);
        }
        if parsed(&document).is_ok() {
            prop_assert_eq!(refused(&schema(), &document), None);
        }
    }
}
