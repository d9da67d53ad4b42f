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
    [
        "/sed",
        "1",
        "sed: unknown field `sed`, expected one of `name`, `description`, `seed`, `duration_secs`, `time_step_secs`, `coarse_every`, `integrator`, `wall_method`, `preferred_speed`, `max_speed`, `profile`, `parameters`, `obstacles`, `goal`, `agents`, `grids`, `sources`, `events`, `measurements`, `stop`, `view`, `debug_agents`; did you mean `seed`?",
    ],
    [
        "/seed",
        "-1",
        "seed: invalid value: integer `-1`, expected a whole number from 0 to 2^64 - 1",
    ],
    [
        "/seed",
        "1.5",
        "seed: invalid type: floating point `1.5`, expected a whole number from 0 to 2^64 - 1",
    ],
    ["/name", r#""""#, "name: must not be empty"],
    [
        "/agents/0/colour",
        r#""red""#,
        "agents[0].colour: unknown field `colour`, expected one of `position`, `velocity`, `radius`, `mass`, `goal`, `mean_density`, `profile`, `remove_within`, `counted`",
    ],
    [
        "/agents/0/position",
        "[1]",
        "agents[0].position: invalid length 1, expected an array of length 2",
    ],
    [
        "/agents/0/position",
        "[1, 2, 3]",
        "agents[0].position: invalid length 3, expected fewer elements in array",
    ],
    [
        "/agents/0/position/1",
        r#""2""#,
        r#"agents[0].position[1]: invalid type: string "2", expected a number"#,
    ],
    [
        "/integrator",
        r#""rk4""#,
        "integrator: unknown variant `rk4`, expected `semi-implicit` or `forward-euler`",
    ],
    [
        "/measurements/0",
        r#"{"speed": {}}"#,
        "measurements[0]: unknown variant `speed`, expected one of `density`, `flow_of_first`, `flow_until`, `evacuated`",
    ],
    [
        "/measurements/0/density/at",
        "5",
        "measurements[0].density.at: unknown field `at`, expected `at_secs` or `region`",
    ],
    [
        "/grids/0",
        r#"{"min": [0, 0]}"#,
        "grids[0]: missing field `max`",
    ],
    [
        "/agents/0",
        "[[2, 2]]",
        "agents[0]: invalid type: sequence, expected an object",
    ],
    [
        "/grids",
        "{}",
        "grids: invalid type: map, expected a sequence",
    ],
    [
        "/grids/0/columns",
        "2.5",
        "grids[0].columns: invalid type: floating point `2.5`, expected a whole number from 0 to 2^32 - 1",
    ],
    [
        "/stop",
        r#"{"when_emtpy": true}"#,
        "stop.when_emtpy: unknown field `when_emtpy`, expected `when_empty` or `idle_secs`; did you mean `when_empty`?",
    ],
    // ranges
    [
        "/time_step_secs",
        "0",
        "time_step_secs: must be at least 1e-6 and at most 1, not 0",
    ],
    [
        "/time_step_secs",
        "1.5",
        "time_step_secs: must be at least 1e-6 and at most 1, not 1.5",
    ],
    [
        "/duration_secs",
        "-1",
        "duration_secs: must be at least 0 and at most 1e7, not -1",
    ],
    [
        "/duration_secs",
        "1e8",
        "duration_secs: must be at least 0 and at most 1e7, not 1e8",
    ],
    [
        "/coarse_every",
        "0",
        "coarse_every: must be at least 1 and at most 1e6, not 0",
    ],
    [
        "/max_speed",
        "0",
        "max_speed: must be above 0 and at most 100, not 0",
    ],
    [
        "/preferred_speed",
        "-1",
        "preferred_speed: must be at least 0 and at most 100, not -1",
    ],
    [
        "/goal/0",
        "1e7",
        "goal[0]: must be at least -1e6 and at most 1e6, not 1e7",
    ],
    [
        "/agents/0/radius",
        "0",
        "agents[0].radius: must be at least 0.01 and at most 10, not 0",
    ],
    [
        "/agents/0/mass",
        "-1",
        "agents[0].mass: must be at least 1e-6 and at most 1e6, not -1",
    ],
    [
        "/agents/0/mean_density",
        "-1",
        "agents[0].mean_density: must be at least 0 and at most 1000, not -1",
    ],
    [
        "/agents/0/velocity",
        "[0, 1e300]",
        "agents[0].velocity[1]: must be at least -100 and at most 100, not 1e300",
    ],
    [
        "/agents/0/remove_within",
        "0",
        "agents[0].remove_within: must be above 0 and at most 1e6, not 0",
    ],
    [
        "/grids/0/columns",
        "0",
        "grids[0].columns: must be at least 1",
    ],
    [
        "/grids/0/jitter",
        "-0.1",
        "grids[0].jitter: must be at least 0 and at most 1e6, not -0.1",
    ],
    [
        "/grids/0/max",
        "[3, 5]",
        "grids[0].columns: 2 agents would stand on one point: `min` and `max` are 0 m apart",
    ],
    [
        "/grids/0/max",
        "[2, 5]",
        "grids[0].min: the lower left corner comes first: (3, 3) is not below and left of (2, 5)",
    ],
    [
        "/sources/0/every_secs",
        "0",
        "sources[0].every_secs: must be above 0 and at most 1e7, not 0",
    ],
    [
        "/sources/0/every_secs",
        "1e-7",
        "sources[0]: too many: with these, 2400000009 agents enter within 60 s; at most 10000000 may",
    ],
    [
        "/sources/0/name",
        r#""""#,
        "sources[0].name: must not be empty",
    ],
    [
        "/grids/0/rows",
        "4000000000",
        "grids[0]: too many: with these, 8000000001 agents enter within 60 s; at most 10000000 may",
    ],
    [
        "/events/0/for_secs",
        "-1",
        "events[0].for_secs: must be at least 0 and at most 1e7, not -1",
    ],
    [
        "/events/0/region",
        "[[5, 0], [0, 5]]",
        "events[0].region: the lower left corner comes first: (5, 0) is not below and left of (0, 5)",
    ],
    [
        "/events/0/goal_scale",
        "-1",
        "events[0].goal_scale: must be at least 0 and at most 1e9, not -1",
    ],
    [
        "/measurements/1",
        r#"{"density": {"at_secs": 5}}"#,
        "measurements[1]: `density_mean_5s` is measured already",
    ],
    [
        "/measurements/1",
        r#"{"flow_of_first": {"arrivals": 1}}"#,
        "measurements[1].flow_of_first.arrivals: a flow needs at least 2 arrivals, not 1",
    ],
    [
        "/measurements/1",
        r#"{"flow_until": {"until_secs": 0}}"#,
        "measurements[1].flow_until.until_secs: must be above 0 and at most 1e7, not 0",
    ],
    [
        "/stop",
        r#"{"idle_secs": 0}"#,
        "stop.idle_secs: must be above 0 and at most 1e7, not 0",
    ],
    [
        "/view/region",
        "[[0, 0], [0, 9]]",
        "view.region: encloses no area",
    ],
    [
        "/debug_agents",
        "[1, 2, 1]",
        "debug_agents[2]: agent 1 is named twice",
    ],
    // goals
    [
        "/goal",
        "null",
        "agents[0]: no goal: give `goal` here, or one for all at the top of the file",
    ],
    [
        "/grids/0",
        r#"{"min": [0, 0], "max": [1, 1], "columns": 1, "rows": 1, "goal": [0, 0], "goal_offset": [1, 0]}"#,
        "grids[0].goal_offset: either `goal` or `goal_offset`, not both",
    ],
    // obstacles
    [
        "/obstacles/0",
        "[[0, 0], [1, 0]]",
        "obstacles[0]: a polygon needs at least 3 points, this one has 2",
    ],
    [
        "/obstacles/0",
        "[[0, 0], [1, 1], [1, 0], [0, 1]]",
        "obstacles[0]: the polygon crosses or touches itself: the edge from point 0 meets the edge from point 2",
    ],
    [
        "/obstacles/0",
        "[[0, 0], [1, 0], [1, 1], [0, 0]]",
        "obstacles[0]: points 3 and 0 are the same; remove one",
    ],
    [
        "/obstacles/0",
        "[[0, 0], [1, 0], [2, 0]]",
        "obstacles[0]: the polygon crosses or touches itself: the edge from point 1 meets the edge from point 2",
    ],
    [
        "/obstacles/0/2",
        "[1, -2e6]",
        "obstacles[0][2][1]: must be at least -1e6 and at most 1e6, not -2e6",
    ],
    // profiles
    [
        "/profile",
        r#""shp""#,
        "profile: no profile is called `shp`; did you mean `sph`? (there are sf, rvo, sf+sph, rvo+sph, sph, sf->sph, rvo->sph)",
    ],
    [
        "/profile",
        "7",
        "profile: invalid type: integer `7`, expected the name of a profile, or an object with its parameters",
    ],
    [
        "/profile",
        "{}",
        "profile: a profile in full has exactly one of `base`, `navigation` and `blend`",
    ],
    [
        "/profile",
        r#"{"base": "sf", "navigation": "goal"}"#,
        "profile: a profile in full has exactly one of `base`, `navigation` and `blend`",
    ],
    [
        "/profile",
        r#"{"base": "sf", "sph": true}"#,
        "profile.sph: goes with `navigation` only",
    ],
    [
        "/profile",
        r#"{"base": "fs"}"#,
        "profile.base: no profile is called `fs`; did you mean `sf`? (there are sf, rvo, sf+sph, rvo+sph, sph, sf->sph, rvo->sph)",
    ],
    [
        "/profile",
        r#"{"base": "sf", "parameters": {"viscosty": 1}}"#,
        "profile.parameters.viscosty: unknown field `viscosty`, expected one of `goal_scale`, `relaxation_time`, `agent_strength`, `agent_range`, `anticipation_time`, `wall_strength`, `wall_range`, `avoidance_radius`, `collision_weight`, `candidates`, `viscosity`, `agent_stiffness`, `wall_stiffness`, `support_radius`, `gas_constant`, `rest_density_min`, `rest_density_max`, `averaging_time`; did you mean `viscosity`?",
    ],
    [
        "/profile",
        r#"{"base": "sf", "parameters": {"viscosity": -1}}"#,
        "profile.parameters.viscosity: must be at least 0 and at most 1e9, not -1",
    ],
    [
        "/profile",
        r#"{"navigation": "fly"}"#,
        "profile.navigation: unknown variant `fly`, expected one of `goal`, `social`, `rvo`",
    ],
    [
        "/profile",
        r#"{"blend": []}"#,
        "profile.blend: a blend needs at least one profile",
    ],
    [
        "/profile",
        r#"{"blend": [{"at_density": 4, "profile": "sf"}, {"at_density": 2, "profile": "sph"}]}"#,
        "profile.blend: densities must rise: 2 P/m² follows 4 P/m²",
    ],
    [
        "/profile",
        r#"{"blend": [{"at_density": 2, "profile": "sf->sph"}]}"#,
        "profile.blend[0].profile: a blend is made of plain profiles; `sf->sph` is a blend itself",
    ],
    [
        "/profile",
        r#"{"blend": [{"at_density": 2, "profile": {"blend": []}}]}"#,
        "profile.blend[0].profile.blend: a blend is made of plain profiles, not of blends",
    ],
    [
        "/profile",
        r#"{"blend": [{"at_density": 2, "profile": {"base": "sph", "parameters": {"gas_constant": 100}}}, {"at_density": 4, "profile": {"base": "sph", "parameters": {"gas_constant": 200}}}]}"#,
        "profile.blend[1].profile.parameters.gas_constant: all profiles of a blend share it: 200 here, 100 before",
    ],
    [
        "/profile",
        r#"{"blend": [{"at_density": 2, "profile": {"base": "rvo", "parameters": {"candidates": 100}}}, {"at_density": 4, "profile": "rvo"}]}"#,
        "profile.blend: profiles of one blend share one velocity of RVO: give them the same RVO parameters",
    ],
    [
        "/agents/0/profile",
        r#"{"base": "sph", "parameters": {"rest_density_min": 6}}"#,
        "agents[0].profile: rest_density_min 6 is above rest_density_max 5",
    ],
    [
        "/parameters",
        r#"{"support_radius": 0}"#,
        "parameters.support_radius: must be at least 0.01 and at most 100, not 0",
    ],
    [
        "/parameters",
        r#"{"candidates": 0}"#,
        "parameters.candidates: must be at least 1 and at most 1e6, not 0",
    ],
];

#[test]
fn every_broken_value_is_reported_with_its_place_and_reason() {
    assert_eq!(message(WHOLE, &[]), "no error");
    for [pointer, value, expected] in BROKEN {
        let said = message(&with(pointer, value), &[]);
        let expected = format!("f.json: {expected}");
        assert_eq!(said, expected, "{value} at {pointer}");
    }
}

/// A whole text, and the message.
const BROKEN_TEXTS: &[[&str; 2]] = &[
    ["", "f.json: line 1, column 0: EOF while parsing a value"],
    [
        "{\"seed\": 1,}",
        "f.json: line 1, column 12: trailing comma",
    ],
    [
        "{\n  \"duration_secs\": 1e999\n}",
        "f.json: line 2, column 24: number out of range",
    ],
    [
        "{\"seed\": NaN}",
        "f.json: line 1, column 10: expected value",
    ],
    [
        "{\"seed\": 1, \"seed\": 2}",
        "f.json: line 1, column 18: key `seed` is given twice",
    ],
    ["[]", "f.json: invalid type: sequence, expected an object"],
    ["null", "f.json: invalid type: null, expected an object"],
    ["{} {}", "f.json: line 1, column 4: trailing characters"],
];

#[test]
fn broken_texts_are_reported_with_line_and_column() {
    for [text, expected] in BROKEN_TEXTS {
        assert_eq!(message(text, &[]), *expected, "{text}");
    }
}

/// What is set, and the message.
const BROKEN_SETTINGS: &[[&str; 2]] = &[
    [
        "viscosity=-1",
        "--set viscosity=-1: must be at least 0 and at most 1e9, not -1",
    ],
    [
        "viscosity=much",
        r#"--set viscosity=much: invalid type: string "much", expected a number"#,
    ],
    [
        "viscosity=1e999",
        r#"--set viscosity=1e999: invalid type: string "1e999", expected a number"#,
    ],
    [
        "viscocity=1",
        "unknown setting `viscocity`; did you mean `viscosity`? (`sandbox list --settings` shows them all)",
    ],
    ["viscosity", "a setting is written key=value"],
    [
        "seed=x",
        r#"--set seed=x: invalid type: string "x", expected a whole number from 0 to 2^64 - 1"#,
    ],
    [
        "profile=fs",
        "--set profile=fs: no profile is called `fs`; did you mean `sf`? (there are sf, rvo, sf+sph, rvo+sph, sph, sf->sph, rvo->sph)",
    ],
    [
        "profile={\"base\": \"sf\", \"parameters\": {\"candidates\": 0}}",
        r#"--set profile={"base": "sf", "parameters": {"candidates": 0}}: parameters.candidates: must be at least 1 and at most 1e6, not 0"#,
    ],
    [
        "rest_density_min=6",
        "f.json with --set rest_density_min=6: profile: rest_density_min 6 is above rest_density_max 5",
    ],
    [
        "sources.0.rows=0",
        "--set sources.0.rows=0: must be at least 1",
    ],
    [
        "sources.1.rows=0",
        "--set sources.1.rows=0: sources has no element `1`: there are 1, counted from 0",
    ],
    [
        "sources.0.rwos=5",
        "--set sources.0.rwos=5: unknown field `rwos`, expected one of `name`, `min`, `max`, `columns`, `rows`, `jitter`, `goal`, `goal_offset`, `profile`, `remove_within`, `counted`, `start_secs`, `every_secs`, `times`; did you mean `rows`?",
    ],
    [
        "profile.base=sf",
        "--set profile.base=sf: profile is neither an object nor a list",
    ],
    [
        "goal=[1]",
        "--set goal=[1]: invalid length 1, expected an array of length 2",
    ],
    ["name=", "--set name=: must not be empty"],
];

#[test]
fn a_setting_at_fault_is_named() {
    for [setting, expected] in BROKEN_SETTINGS {
        assert_eq!(message(WHOLE, &[setting]), *expected, "{setting}");
    }
}

#[test]
fn a_fault_of_the_file_is_not_put_on_the_settings() {
    assert_eq!(
        message(&with("/max_speed", "0"), &["seed=7", "viscosity=5"]),
        "f.json: max_speed: must be above 0 and at most 100, not 0"
    );
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = Scenario::load("no/such.json".as_ref(), &[]).unwrap_err();
    assert!(error.to_string().starts_with("no/such.json: No such file"));
    let error = Scenario::shipped("concerto", &[]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "no scenario is called `concerto`; there are evacuation, crossing, concert"
    );
}
