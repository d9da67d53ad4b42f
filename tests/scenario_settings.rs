//! The documentation of settings agrees with the program.

use sandbox::engine::boundary::WallMethod;
use sandbox::engine::scene::{Integrator, Scene};
use sandbox::scenario::catalog::{self, NAMES, Parameters};
use sandbox::scenario::{NESTED, Preset, Scenario, Setting, settings};
use serde_json::{Value, json};

fn parameter_keys() -> Vec<String> {
    let parameters = serde_json::to_value(Parameters::default()).unwrap();
    parameters.as_object().unwrap().keys().cloned().collect()
}

fn documented_default(key: &str) -> &'static str {
    let settings = settings();
    settings.iter().find(|doc| doc.key == key).unwrap().default
}

fn parse(settings: &[&str]) -> Scenario {
    let settings: Vec<Setting> = settings.iter().map(|s| s.parse().unwrap()).collect();
    Scenario::parse("{}", "nameless.json", &settings).unwrap()
}

#[test]
fn every_key_of_a_file_and_every_parameter_is_documented_once() {
    let error = Scenario::parse("{\"?\": 0}", "f", &[])
        .unwrap_err()
        .to_string();
    let mut known: Vec<String> = error
        .split('`')
        .skip(3)
        .step_by(2)
        .map(str::to_owned)
        .collect();
    assert!(known.len() > 20, "{error}");
    known.extend(parameter_keys());
    known.sort();
    let mut documented: Vec<&str> = settings().iter().map(|doc| doc.key).collect();
    documented.sort();
    assert_eq!(documented, known);
}

#[test]
fn the_keys_of_nested_objects_are_documented() {
    let nested = |list: &str| NESTED.iter().find(|(name, _)| *name == list).unwrap().1;
    for list in ["agents", "grids", "sources", "events"] {
        let text = format!("{{\"{list}\": [{{\"?\": 0}}]}}");
        let error = Scenario::parse(&text, "f", &[]).unwrap_err().to_string();
        let known: Vec<&str> = error.split('`').skip(3).step_by(2).collect();
        assert!(known.len() > 5, "{error}");
        let documented = match list {
            "sources" => format!("{}, {}", nested("grids"), nested(list)),
            _ => nested(list).to_owned(),
        };
        let words: Vec<&str> = documented.split([' ', ',', '?']).collect();
        for key in known {
            assert!(words.contains(&key), "{list}: {key}");
        }
    }
}

#[test]
fn every_documented_key_is_accepted() {
    let text = |key: &str| match key {
        "name" | "description" => "word".to_owned(),
        "coarse_every" | "population_seed" | "behaviour_seed" => "3".to_owned(),
        "parameters" | "stop" => "{}".to_owned(),
        "goal" => "[1, 2]".to_owned(),
        "walkable_area" => "[[[[0, 0], [9, 0], [9, 9]]]]".to_owned(),
        "view" => "{\"region\": [[0, 0], [1, 1]]}".to_owned(),
        "agent_stiffness" | "wall_stiffness" => "10".to_owned(),
        _ if documented_default(key) == "none" => "[]".to_owned(),
        _ => documented_default(key).to_owned(),
    };
    for doc in settings() {
        let setting = format!("{}={}", doc.key, text(doc.key));
        let scenario = parse(&[&setting]);
        let place = if parameter_keys().iter().any(|key| key == doc.key) {
            &scenario.document["parameters"][doc.key]
        } else {
            &scenario.document[doc.key]
        };
        assert_ne!(*place, Value::Null, "{setting}");
    }
}

#[test]
fn the_documented_defaults_of_parameters_are_those_of_the_engine() {
    for key in parameter_keys() {
        let default = documented_default(&key);
        for name in NAMES {
            let Some(expected) = catalog::plain(name, &Parameters::default()) else {
                continue;
            };
            let value = match default.split_once("; with SPH ") {
                Some((_, with)) if name.contains("sph") => with,
                Some((without, _)) => without,
                None => default,
            };
            let value: Value = serde_json::from_str(value).unwrap();
            let given: Parameters = serde_json::from_value(json!({ key.as_str(): value })).unwrap();
            assert_eq!(
                catalog::plain(name, &given),
                Some(expected),
                "{key} in {name}"
            );
            assert_eq!(given.sph(), Parameters::default().sph(), "{key}");
        }
    }
}

#[test]
fn the_documented_defaults_of_scenarios_are_those_of_the_engine() {
    let bare = parse(&[]);
    let engine = Scene::default();
    assert_eq!(bare.scene.seed, engine.seed);
    assert_eq!(bare.scene.clock, engine.clock);
    assert_eq!(bare.scene.integrator, engine.integrator);
    assert_eq!(bare.scene.wall_method, engine.wall_method);
    assert_eq!(bare.scene.precision, engine.precision);
    assert_eq!(bare.scene.neighbor_lists, engine.neighbor_lists);
    assert_eq!(bare.scene.preferred_speed, engine.preferred_speed);
    assert_eq!(bare.scene.max_speed, engine.max_speed);
    assert_eq!(bare.name, "nameless");

    let scalars = [
        "seed",
        "duration_secs",
        "time_step_secs",
        "integrator",
        "wall_method",
        "precision",
        "neighbor_lists",
        "preferred_speed",
        "max_speed",
        "profile",
    ];
    let written = scalars.map(|key| format!("{key}={}", documented_default(key)));
    let given = parse(&written.each_ref().map(String::as_str));
    assert_eq!(given.scene.seed, bare.scene.seed);
    assert_eq!(given.duration_secs, bare.duration_secs);
    assert_eq!(given.scene.clock, bare.scene.clock);
    assert_eq!(given.scene.integrator, bare.scene.integrator);
    assert_eq!(given.scene.wall_method, bare.scene.wall_method);
    assert_eq!(given.scene.precision, bare.scene.precision);
    assert_eq!(given.scene.neighbor_lists, bare.scene.neighbor_lists);
    assert_eq!(given.scene.preferred_speed, bare.scene.preferred_speed);
    assert_eq!(given.scene.max_speed, bare.scene.max_speed);
    assert_eq!(given.profile_name, bare.profile_name);
}

#[test]
fn a_smaller_time_step_keeps_the_coarse_step_unless_it_is_set() {
    assert_eq!(
        parse(&["time_step_secs=0.01"]).scene.clock.coarse_every(),
        10
    );
    let both = parse(&["time_step_secs=0.01", "coarse_every=3"]);
    assert_eq!(both.scene.clock.coarse_every(), 3);
}

#[test]
fn a_scenario_without_debug_agents_gets_twelve_from_first_to_last() {
    let sources = r#"sources=[{"min": [0, 0], "max": [0, 9], "columns": 1, "rows": 10,
        "every_secs": 1, "times": 12}]"#;
    let chosen = parse(&["goal=[9, 5]", sources]).debug_agents;
    assert_eq!(chosen, [5, 15, 25, 35, 45, 55, 65, 75, 85, 95, 105, 115]);
    let few = parse(&["goal=[9, 5]", r#"agents=[{"position": [0, 0]}]"#]);
    assert_eq!(few.debug_agents, [0]);
    assert!(
        parse(&["debug_agents=[]", "goal=[9, 5]", sources])
            .debug_agents
            .is_empty()
    );
}

#[test]
fn a_preset_fills_in_values_that_are_not_given() {
    let paper = parse(&["preset=paper"]).scene;
    let bare = parse(&[]).scene;
    assert_eq!(
        (paper.clock, paper.integrator),
        (bare.clock, bare.integrator)
    );
    assert_eq!(
        (paper.wall_method, paper.precision),
        (bare.wall_method, bare.precision)
    );

    for (name, preset) in Preset::ALL {
        let scenario = parse(&[&format!("preset={name}")]);
        let filled = &scenario.document;
        for (key, value) in preset.document().as_object().unwrap() {
            assert_eq!(filled[key], *value, "{name}: {key}");
        }
    }
    let accurate = parse(&["preset=accurate", "wall_method=exact"]).scene;
    assert_eq!(accurate.integrator, Integrator::VelocityVerlet);
    assert_eq!(accurate.wall_method, WallMethod::Exact);
}
