//! The schema of scenarios accepts what the program accepts, and has every key, word and range.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::common::documents::{count, invalid_value, replace};
use crate::common::json_schema::refusal;
use crate::common::whole::{Walk, all_keys, documents, whole};
use proptest::prelude::*;
use sandbox::scenario::{SHIPPED, Scenario, schema};
use serde_json::{Value, json};

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
fn all_scenario_files_and_those_with_every_key_are_valid() {
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
    for document in documents() {
        assert_eq!(refused(&schema, &document), None);
        let scenario = parsed(&document).unwrap();
        assert_eq!(scenario.document.get("$schema"), None);
    }
    assert!(
        parsed(&json!({"$schema": 5}))
            .unwrap_err()
            .contains("$schema")
    );
}

/// The valid keys at `pointer` in a document, from the error message for an additional key `?`.
fn known(document: &Value, pointer: &str) -> Vec<String> {
    let mut document = document.clone();
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
fn the_whole_documents_have_every_key_except_those_of_trajectory_files() {
    let (schema, documents) = (schema(), documents());
    let mut walk = Walk::default();
    for document in &documents {
        walk.add(&schema, document);
    }
    let missing: Vec<String> = all_keys(&schema).difference(&walk.keys).cloned().collect();
    let expected = [
        ".behaviour_seed", // former names
        "FromData.at_secs",
        "FromData.fps",
        "FromData.level",
        "FromData.trajectory",
        "FromData.unit",
        "FromData.until_secs",
        "FromData.uses_stairs", // a key of buildings, which `from` does not start
        "Jitter.to_secs",
        "SpeedByDensity.to_secs",
        "Wave.to_secs",
    ];
    assert_eq!(missing, expected);
}

#[test]
fn every_object_has_the_keys_that_the_parser_knows() {
    let schema = schema();
    for document in documents() {
        let mut walk = Walk::default();
        walk.add(&schema, &document);
        for object in walk.objects {
            check_keys(&document, &object.pointer, object.schema);
        }
    }
}

/// Checks that the parser and a schema know the same keys of the object at `pointer`, and require the same.
fn check_keys(document: &Value, pointer: &str, schema: &Value) {
    let properties = schema["properties"].as_object().unwrap();
    let mut keys: Vec<&str> = properties.keys().map(String::as_str).collect();
    // Reading takes the key `level` away before the others are parsed.
    let is_parsed = |key: &str| key != "$schema" && key != "level";
    keys.retain(|key| properties[*key]["deprecated"] != true && is_parsed(key));
    let mut expected = known(document, pointer);
    expected.retain(|key| is_parsed(key));
    expected.sort();
    assert_eq!(keys, expected, "{pointer}");
    // The parser refuses an object without a key if and only if the key is required.
    // A key with a former name is in `anyOf`.
    let required = [&schema["required"], &schema["anyOf"][0]["required"]];
    let required = required.map(|keys| keys.as_array().cloned().unwrap_or_default());
    let required = required.concat();
    for key in keys {
        let mut document = document.clone();
        let object = document.pointer_mut(pointer).unwrap();
        if object.as_object_mut().unwrap().remove(key).is_some() {
            let missing = parsed(&document).is_err_and(|error| error.contains("missing key"));
            assert_eq!(required.contains(&json!(key)), missing, "{pointer} {key}");
        }
    }
    for (key, property) in properties {
        // `Parameters` has links to the fields of the engine, which have the descriptions.
        let description = property["description"].as_str().unwrap_or_default();
        assert!(
            !description.is_empty() && !description.starts_with('['),
            "{key}"
        );
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
        json!({"obstacles": [[[0, 0]]]}),
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
            None => documents()[which % 3].clone(),
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
