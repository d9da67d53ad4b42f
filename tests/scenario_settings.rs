//! The documentation of settings agrees with the program.

use sandbox::engine::boundary::WallMethod;
use sandbox::engine::density::SphParameters;
use sandbox::engine::scene::{Integrator, Scene};
use sandbox::runs::summary::Summary;
use sandbox::scenario::catalog::{self, NAMES, Parameters};
use sandbox::scenario::{
    Presence, Preset, Scenario, Setting, SettingError, nested_settings, schema, settings,
};
use serde_json::{Value, json};

/// The keys of parameters, as the message about an unknown key lists them.
fn parameter_keys() -> Vec<String> {
    known_keys("{\"parameters\": {\"?\": 0}}")
}

/// The keys that the error for an unknown key `?` lists.
fn known_keys(text: &str) -> Vec<String> {
    let error = Scenario::parse(text, "f", &[]).unwrap_err().to_string();
    let names = error.split('`').skip(3).step_by(2);
    let names: Vec<String> = names.map(str::to_owned).collect();
    assert!(names.len() > 5, "{error}");
    names
}

/// The default in the list of settings.
fn documented_default(key: &str) -> Option<String> {
    let settings = settings();
    let found = settings.iter().find(|doc| doc.key == key);
    found.unwrap().default.clone()
}

fn parse(settings: &[&str]) -> Scenario {
    let settings: Vec<Setting> = settings.iter().map(|s| s.parse().unwrap()).collect();
    Scenario::parse("{}", "nameless.json", &settings).unwrap()
}

#[test]
fn every_key_of_a_file_and_every_parameter_is_documented_once() {
    let known = [known_keys("{\"?\": 0}"), parameter_keys()].concat();
    let documented: Vec<&str> = settings().iter().map(|doc| doc.key).collect();
    assert_eq!(documented, known);
    for doc in settings() {
        assert!(doc.description.ends_with('.'), "{doc:?}");
        assert!(!doc.range.is_empty(), "{doc:?}");
    }
}

#[test]
fn the_keys_of_nested_objects_are_documented() {
    let nested = nested_settings();
    let nested: Vec<_> = nested
        .iter()
        .map(|one| (one.path.clone(), one.names()))
        .collect();
    for (list, required) in [
        ("agents", 1),
        ("grids", 4),
        ("crowds", 1),
        ("sources", 5),
        ("entrances", 1),
        ("events", 1),
    ] {
        let mut first = json!({"?": 0, "position": [0, 0], "min": [0, 0], "max": [0, 0], "columns": 1, "rows": 1,
            "every_secs": 1, "line": [[0, 0], [0, 9]], "area": [[0, 0], [9, 0], [9, 9]], "at_secs": 0, "for_secs": 0,
            "region": [[0, 0], [0, 0]]});
        if list == "entrances" {
            first["at_secs"] = json!([0]);
        }
        let documented = &nested.iter().find(|(name, _)| name == list).unwrap().1;
        let documented: Vec<&str> = documented.split(", ").collect();
        let optional = documented.iter().filter(|key| key.ends_with('?'));
        assert_eq!(optional.count(), documented.len() - required, "{list}");
        let mut known = known_keys(&json!({ list: [first] }).to_string());
        // Reading takes `level` away before the others are parsed.
        known.retain(|key| key != "level");
        known.push("level".to_owned());
        if list == "grids" {
            known.retain(|key| !["start_secs", "every_secs", "times"].contains(&key.as_str()));
        }
        known.sort();
        let mut documented: Vec<&str> = documented
            .iter()
            .map(|key| key.trim_end_matches('?'))
            .collect();
        documented.sort();
        assert_eq!(documented, known, "{list}");
    }
    for (path, keys) in [
        (
            "measurements",
            "one of density, flow_of_first, flow_until, egress, evacuated, uncounted, pauses, locked, snapshot, wave, \
             front, push, oscillation, contacts, jitter, closest, integrity, speed_by_density, walks, line_flow, \
             exposure, service_levels, crowd_pressure, unbalanced, body_forces, wall_forces or frame_time",
        ),
        ("measurements.density", "at_secs, level?, region?"),
        (
            "waiting_areas.for_secs",
            "one of uniform, normal, lognormal, weibull, gamma, exponential, values or weidmann_age",
        ),
        ("waiting_areas.for_secs.normal", "mean, std, max?, min?"),
        ("periodic", "axis, length, from?"),
        (
            "from",
            "at_secs?, counted?, fps?, goal?, journey?, level?, mass?, mean_density?, motivation?, name?, people?, \
             preferred_speed?, premovement_secs?, profile?, radius?, remove_within?, trajectory?, unit?, until_secs?, \
             uses_stairs?",
        ),
        ("stop", "idle_secs?, when_empty?"),
        (
            "view",
            "density_range?, opens_at_secs?, region?, speed_range?",
        ),
        (
            "profile",
            "one of base, navigation or blend, name?, parameters?, sph?",
        ),
        ("profile.blend", "at_density, profile"),
    ] {
        assert!(
            nested.contains(&(path.to_owned(), keys.to_owned())),
            "{path}"
        );
    }
}

#[test]
fn every_key_of_a_nested_object_has_a_meaning_and_a_range() {
    for object in nested_settings() {
        for doc in &object.keys {
            assert!(doc.description.ends_with('.'), "{}: {doc:?}", object.path);
            assert!(!doc.range.is_empty(), "{}: {doc:?}", object.path);
            let may_be_missing = doc.presence == Presence::Optional;
            assert!(
                may_be_missing || doc.default.is_none(),
                "{}: {doc:?}",
                object.path
            );
        }
    }
}

#[test]
fn a_nested_key_is_described_as_in_its_struct() {
    let nested = nested_settings();
    let find = |path: &str, key: &str| {
        let object = nested.iter().find(|object| object.path == path).unwrap();
        object.keys.iter().find(|doc| doc.key == key).unwrap()
    };
    let servers = find("queues", "servers");
    assert_eq!(servers.description, "How many people are served at a time.");
    assert_eq!(servers.default.as_deref(), Some("1"));
    assert_eq!(
        servers.range,
        "a whole number, at least 1 and at most 2^32 - 1"
    );
    assert_eq!(servers.presence, Presence::Optional);
    let service = find("queues", "service_secs");
    assert_eq!(service.presence, Presence::Required);
    assert_eq!(
        service.range,
        "at least 0 and at most 1e7, or a distribution, an object with one key"
    );
    // The meaning of a kind is that of the variant, not that of its keys.
    let evacuated = find("measurements", "evacuated");
    assert_eq!(evacuated.description, "Number of counted arrivals.");
    assert_eq!(evacuated.presence, Presence::OneOf);
}

#[test]
fn every_documented_key_is_accepted() {
    let text = |key: &str| match key {
        "name" | "description" => "word",
        "coarse_every" | "population_seed" | "behavior_seed" => "3",
        "parameters" | "stop" | "plan" => "{}",
        "goal" => "[1, 2]",
        "from" => "{\"people\": [[1, 0, 2, 2, 0, 0]], \"goal\": [5, 5]}",
        "periodic" => "{\"axis\": \"x\", \"length\": 20}",
        "walkable_area" => "[[[[0, 0], [9, 0], [9, 9]]]]",
        "view" => "{\"region\": [[0, 0], [1, 1]]}",
        "agent_stiffness" | "wall_stiffness" | "min_passage_width" => "10",
        _ => "[]",
    };
    for doc in settings() {
        let value = doc.default.unwrap_or_else(|| text(doc.key).to_owned());
        let setting = format!("{}={value}", doc.key);
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
    for doc in settings()
        .into_iter()
        .filter(|doc| parameter_keys().contains(&doc.key.to_owned()))
    {
        let key = doc.key;
        for name in NAMES {
            let Ok(expected) = catalog::plain(name, &Parameters::default()) else {
                continue;
            };
            // The description says a default that depends on the profile.
            let said = doc
                .description
                .split_once("Default: ")
                .map(|(_, said)| said.trim_end_matches('.'));
            let said = said.map(|said| said.split_once("; with SPH ").unwrap());
            let value = match (&doc.default, said) {
                (Some(value), None) => value,
                (None, Some((_, with))) if name.contains("sph") => with,
                (None, Some((without, _))) => without,
                both => panic!("{key}: {both:?}"),
            };
            let word = || Value::from(value);
            let value: Value = serde_json::from_str(value).unwrap_or_else(|_| word());
            let given: Parameters = serde_json::from_value(json!({ key: value })).unwrap();
            assert_eq!(
                catalog::plain(name, &given),
                Ok(expected),
                "{key} in {name}"
            );
            assert_eq!(
                given.part::<SphParameters>(),
                SphParameters::default(),
                "{key}"
            );
        }
    }
}

#[test]
fn one_seed_sets_both_seeds_and_each_can_be_set_alone() {
    let seeds = |settings: &[&str]| {
        let scenario = parse(settings);
        (
            scenario.seed,
            scenario.scene.seed,
            scenario.scene.behavior_seed,
        )
    };
    assert_eq!(seeds(&[]), (1, 1, Some(1)));
    assert_eq!(seeds(&["seed=7"]), (7, 7, Some(7)));
    assert_eq!(seeds(&["seed=7", "population_seed=8"]), (7, 8, Some(7)));
    assert_eq!(seeds(&["behavior_seed=9", "seed=7"]), (7, 7, Some(9)));
}

#[test]
fn the_old_name_of_a_key_still_works() {
    let old = r#"{"behaviour_seed": 5}"#;
    let scenario = Scenario::parse(old, "f", &[]).unwrap();
    assert_eq!(scenario.scene.behavior_seed, Some(5));
    assert_eq!(scenario.document, json!({"behavior_seed": 5}));
    let set = "behaviour_seed=6".parse().unwrap();
    let scenario = Scenario::parse(old, "f", &[set]).unwrap();
    assert_eq!(scenario.scene.behavior_seed, Some(6));
    let both = r#"{"behaviour_seed": 5, "behavior_seed": 5}"#;
    assert_eq!(
        Scenario::parse(both, "f", &[]).unwrap_err().to_string(),
        "f: behaviour_seed: the old name of `behavior_seed`, which is given too; remove one"
    );
    assert_eq!(schema()["properties"]["behaviour_seed"]["deprecated"], true);
    let jitter = |keys: Value| json!({"measurements": [{"jitter": keys}]}).to_string();
    let present = jitter(json!({"from_secs": 1, "until_secs": 2}));
    let present = Scenario::parse(&present, "f", &[]).unwrap().document;
    let old = jitter(json!({"from_secs": 1, "to_secs": 2}));
    assert_eq!(Scenario::parse(&old, "f", &[]).unwrap().document, present);
    let set = ["measurements.0.jitter.to_secs=2".parse().unwrap()];
    let changed = jitter(json!({"from_secs": 1, "until_secs": 9}));
    let changed = Scenario::parse(&changed, "f", &set).unwrap();
    assert_eq!(changed.document, present);
    let both = jitter(json!({"from_secs": 1, "to_secs": 2, "until_secs": 2}));
    let error = Scenario::parse(&both, "f", &[]).unwrap_err();
    let expected = "f: measurements[0].jitter.to_secs: the old name of `until_secs`, which is given too; remove one";
    assert_eq!(error.to_string(), expected);
    let result = json!({"scenario": "f", "profile": "sph", "seed": 1, "behaviour_seed": 5, "state_sha256": "",
        "frames": 1, "time_secs": 1, "agents": 1, "metrics": {}, "contained_moves": 0, "clamped_speeds": 0,
        "displaced_agents": 0});
    let result: Summary = serde_json::from_value(result).unwrap();
    assert_eq!(result.behavior_seed, 5);
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
    let written = scalars.map(|key| format!("{key}={}", documented_default(key).unwrap()));
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

    for name in Preset::names() {
        let preset: Preset = serde_json::from_value(json!(name)).unwrap();
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

/// The document of a scenario with a setting; a message if the setting is refused.
fn applied(text: &str, document: Value) -> Result<Value, String> {
    let setting: Setting = text.parse().map_err(|e: SettingError| e.to_string())?;
    let scenario = Scenario::parse(&document.to_string(), "f.json", &[setting]);
    let document = scenario.map(|scenario| scenario.document);
    document.map_err(|error| error.to_string())
}

#[test]
fn parameters_go_where_the_file_keeps_them() {
    let expected = json!({"parameters": {"viscosity": 5}});
    assert_eq!(applied("viscosity=5", json!({})), Ok(expected.clone()));
    assert_eq!(applied("parameters.viscosity=5", json!({})), Ok(expected));
}

#[test]
fn values_are_json_and_otherwise_text() {
    for (text, expected) in [
        ("profile=sf->sph", json!({"profile": "sf->sph"})),
        (
            "profile={\"base\": \"sf\"}",
            json!({"profile": {"base": "sf"}}),
        ),
        ("name=5", json!({"name": "5"})),
        (
            "stop.when_empty=true",
            json!({"stop": {"when_empty": true}}),
        ),
    ] {
        assert_eq!(applied(text, json!({})), Ok(expected), "{text}");
    }
}

#[test]
fn dots_lead_into_what_is_there() {
    let source = json!({"min": [0, 5], "max": [0, 9], "columns": 1, "rows": 1, "every_secs": 1});
    let document = || json!({"goal": [9, 9], "sources": [source], "profile": "sf"});
    let changed = applied("sources.0.rows=50", document()).unwrap();
    assert_eq!(changed["sources"][0]["rows"], 50);
    for (text, reason) in [
        (
            "sources.1.rows=5",
            "sources has no element `1`: there are 1, counted from 0",
        ),
        ("grids.0.rows=5", "the file has no `grids`"),
        ("profile.base=sf", "profile is neither an object nor a list"),
    ] {
        let said = format!("--set {text}: {reason}");
        assert_eq!(applied(text, document()), Err(said));
    }
}

#[test]
fn the_ends_belong_to_a_range_unless_it_is_open() {
    for text in ["duration_secs=0", "duration_secs=1e7", "max_speed=100"] {
        assert!(applied(text, json!({})).is_ok(), "{text}");
    }
    for text in [
        "duration_secs=-1e-9",
        "duration_secs=10000001",
        "max_speed=0",
        "max_speed=101",
    ] {
        let said = applied(text, json!({})).unwrap_err();
        assert!(said.contains(": must be "), "{said}");
    }
}

#[test]
fn documents_read_as_json_does() {
    let text = r#"{"view": {"region": [[-1, 0.5], [2, 1e3]], "opens_at_secs": 0}, "goal": null, "seed": 1,
        "name": "x", "stop": {"when_empty": true}, "measurements": []}"#;
    let scenario = Scenario::parse(text, "f", &[]).unwrap();
    let expected: Value = serde_json::from_str(text).unwrap();
    assert_eq!(scenario.document, expected);
}
