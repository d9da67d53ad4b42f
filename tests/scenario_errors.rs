//! Broken scenarios and what is said about them, word by word.

use sandbox::scenario::{Scenario, Setting};
use serde_json::Value;

/// A small scenario with one of everything; tests break it.
const WHOLE: &str = r#"{
  "seed": 1, "goal": [9, 5], "profile": "sph",
  "obstacles": [[[0, 0], [1, 0], [1, 1]]],
  "agents": [{"position": [2, 2]}],
  "grids": [{"min": [3, 3], "max": [5, 5], "columns": 2, "rows": 2}],
  "sources": [{"min": [0, 5], "max": [0, 9], "columns": 1, "rows": 4, "every_secs": 1}],
  "events": [{"at_secs": 1, "for_secs": 1, "region": [[0, 0], [5, 5]]}],
  "measurements": [{"density": {"at_secs": 5}}, {"evacuated": {}}],
  "view": {"region": [[0, 0], [9, 9]]}
}"#;

/// `WHOLE` with the value at a JSON pointer replaced, or put in.
fn with(pointer: &str, value: &str) -> String {
    let mut document: Value = serde_json::from_str(WHOLE).unwrap();
    let value: Value = serde_json::from_str(value).unwrap();
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    match document.pointer_mut(parent).unwrap() {
        Value::Object(object) => object.insert(key.to_owned(), value),
        Value::Array(list) => Some(std::mem::replace(
            &mut list[key.parse::<usize>().unwrap()],
            value,
        )),
        _ => panic!("nothing can be put into {parent}"),
    };
    document.to_string()
}

fn message(text: &str, settings: &[&str]) -> String {
    let settings: Result<Vec<Setting>, _> = settings.iter().map(|s| s.parse()).collect();
    match settings.map(|settings| Scenario::parse(text, "f.json", &settings)) {
        Ok(Ok(_)) => "no error".to_owned(),
        Ok(Err(error)) => error.to_string(),
        Err(error) => error.to_string(),
    }
}

/// Where in `WHOLE`, what is put there, and the message.
const BROKEN: &[[&str; 3]] = &[
    // names and types
    ["/sed", "1", ""],
    ["/seed", "-1", ""],
    ["/seed", "1.5", ""],
    ["/name", "\"\"", ""],
    ["/agents/0/colour", "\"red\"", ""],
    ["/agents/0/position", "[1]", ""],
    ["/agents/0/position", "[1, 2, 3]", ""],
    ["/agents/0/position/1", "\"2\"", ""],
    ["/integrator", "\"rk4\"", ""],
    ["/measurements/0", "{\"speed\": {}}", ""],
    ["/measurements/0/density/at", "5", ""],
    ["/grids/0", "{\"min\": [0, 0]}", ""],
    ["/grids", "{}", ""],
    ["/grids/0/columns", "2.5", ""],
    ["/stop", "{\"when_emtpy\": true}", ""],
    // ranges
    ["/time_step_secs", "0", ""],
    ["/time_step_secs", "1.5", ""],
    ["/duration_secs", "-1", ""],
    ["/duration_secs", "1e8", ""],
    ["/coarse_every", "0", ""],
    ["/max_speed", "0", ""],
    ["/preferred_speed", "-1", ""],
    ["/goal/0", "1e7", ""],
    ["/agents/0/radius", "0", ""],
    ["/agents/0/mass", "-1", ""],
    ["/agents/0/mean_density", "-1", ""],
    ["/agents/0/velocity", "[0, 1e300]", ""],
    ["/agents/0/remove_within", "0", ""],
    ["/grids/0/columns", "0", ""],
    ["/grids/0/jitter", "-0.1", ""],
    ["/grids/0/max", "[3, 5]", ""],
    ["/grids/0/max", "[2, 5]", ""],
    ["/grids/0/goal_offset", "[1, 0]", "no error"],
    ["/sources/0/every_secs", "0", ""],
    ["/sources/0/every_secs", "1e-7", ""],
    ["/sources/0/name", "\"\"", ""],
    ["/grids/0/rows", "4000000000", ""],
    ["/events/0/for_secs", "-1", ""],
    ["/events/0/region", "[[5, 0], [0, 5]]", ""],
    ["/events/0/goal_scale", "-1", ""],
    ["/measurements/1", "{\"density\": {\"at_secs\": 5}}", ""],
    [
        "/measurements/1",
        "{\"flow_of_first\": {\"arrivals\": 1}}",
        "",
    ],
    [
        "/measurements/1",
        "{\"flow_until\": {\"until_secs\": 0}}",
        "",
    ],
    ["/stop", "{\"idle_secs\": 0}", ""],
    ["/view/region", "[[0, 0], [0, 9]]", ""],
    ["/debug_agents", "[1, 2, 1]", ""],
    // goals
    ["/goal", "null", ""],
    [
        "/grids/0",
        r#"{"min": [0, 0], "max": [1, 1], "columns": 1, "rows": 1, "goal": [0, 0], "goal_offset": [1, 0]}"#,
        "",
    ],
    // obstacles
    ["/obstacles/0", "[[0, 0], [1, 0]]", ""],
    ["/obstacles/0", "[[0, 0], [1, 1], [1, 0], [0, 1]]", ""],
    ["/obstacles/0", "[[0, 0], [1, 0], [1, 1], [0, 0]]", ""],
    ["/obstacles/0", "[[0, 0], [1, 0], [2, 0]]", ""],
    ["/obstacles/0/2", "[1, -2e6]", ""],
    // profiles
    ["/profile", "\"shp\"", ""],
    ["/profile", "7", ""],
    ["/profile", "{}", ""],
    ["/profile", r#"{"base": "sf", "navigation": "goal"}"#, ""],
    ["/profile", r#"{"base": "sf", "sph": true}"#, ""],
    ["/profile", r#"{"base": "fs"}"#, ""],
    [
        "/profile",
        r#"{"base": "sf", "parameters": {"viscosty": 1}}"#,
        "",
    ],
    [
        "/profile",
        r#"{"base": "sf", "parameters": {"viscosity": -1}}"#,
        "",
    ],
    ["/profile", r#"{"navigation": "fly"}"#, ""],
    ["/profile", r#"{"blend": []}"#, ""],
    [
        "/profile",
        r#"{"blend": [{"at_density": 4, "profile": "sf"}, {"at_density": 2, "profile": "sph"}]}"#,
        "",
    ],
    [
        "/profile",
        r#"{"blend": [{"at_density": 2, "profile": "sf->sph"}]}"#,
        "",
    ],
    [
        "/profile",
        r#"{"blend": [{"at_density": 2, "profile": {"blend": []}}]}"#,
        "",
    ],
    [
        "/profile",
        r#"{"blend": [{"at_density": 2, "profile": {"base": "sph", "parameters": {"gas_constant": 100}}}, {"at_density": 4, "profile": {"base": "sph", "parameters": {"gas_constant": 200}}}]}"#,
        "",
    ],
    [
        "/profile",
        r#"{"blend": [{"at_density": 2, "profile": {"base": "rvo", "parameters": {"candidates": 100}}}, {"at_density": 4, "profile": "rvo"}]}"#,
        "",
    ],
    [
        "/agents/0/profile",
        r#"{"base": "sph", "parameters": {"rest_density_min": 6}}"#,
        "",
    ],
    ["/parameters", r#"{"support_radius": 0}"#, ""],
    ["/parameters", r#"{"candidates": 0}"#, ""],
];

#[test]
fn every_broken_value_is_reported_with_its_place_and_reason() {
    assert_eq!(message(WHOLE, &[]), "no error");
    for [pointer, value, expected] in BROKEN {
        let said = message(&with(pointer, value), &[]);
        println!("@@{pointer} {value}\n   {said}");
        let _ = expected;
    }
}

/// A whole text, and the message.
const BROKEN_TEXTS: &[[&str; 2]] = &[
    ["", ""],
    ["{\"seed\": 1,}", ""],
    ["{\n  \"duration_secs\": 1e999\n}", ""],
    ["{\"seed\": NaN}", ""],
    ["{\"seed\": 1, \"seed\": 2}", ""],
    ["[]", ""],
    ["null", ""],
    ["{} {}", ""],
];

#[test]
fn broken_texts_are_reported_with_line_and_column() {
    for [text, expected] in BROKEN_TEXTS {
        println!("@@{text}\n   {}", message(text, &[]));
        let _ = expected;
    }
}

/// What is set, and the message.
const BROKEN_SETTINGS: &[[&str; 2]] = &[
    ["viscosity=-1", ""],
    ["viscosity=much", ""],
    ["viscosity=1e999", ""],
    ["viscocity=1", ""],
    ["viscosity", ""],
    ["seed=x", ""],
    ["profile=fs", ""],
    [
        "profile={\"base\": \"sf\", \"parameters\": {\"candidates\": 0}}",
        "",
    ],
    ["rest_density_min=6", ""],
    ["sources.0.rows=0", ""],
    ["sources.1.rows=0", ""],
    ["sources.0.rwos=5", ""],
    ["profile.base=sf", ""],
    ["grids=[]", "no error"],
    ["goal=[1]", ""],
    ["name=", ""],
];

#[test]
fn a_setting_at_fault_is_named() {
    for [setting, expected] in BROKEN_SETTINGS {
        println!("@@{setting}\n   {}", message(WHOLE, &[setting]));
        let _ = expected;
    }
}
