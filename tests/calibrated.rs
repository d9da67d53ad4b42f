//! Calibrated profiles: their parameters, and how people walk with them.

use std::path::Path;

use crate::common::ring::parsed;
use crate::common::run;
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::built_in;
use sandbox::scenario::calibrated;
use sandbox::scenario::catalog::{self, NAMES, Parameters};
use serde_json::{Value, json};

#[test]
fn calibrated_profiles_have_the_fitted_parameters_of_their_study_within_its_bounds() {
    assert!(!calibrated::all().is_empty());
    for profile in calibrated::all() {
        let path = format!("calibration/{}.json", profile.study);
        let study: Value = serde_json::from_str(built_in(Path::new(&path)).unwrap()).unwrap();
        let given = json!(profile.parameters);
        let mut fitted = 0;
        for parameter in study["parameters"].as_array().unwrap() {
            let name = parameter["name"].as_str().unwrap();
            let value = given[name].as_f64().unwrap();
            let [low, high] = [0, 1].map(|k| parameter["bounds"][k].as_f64().unwrap());
            assert!((low..=high).contains(&value), "{name}: {value}");
            if parameter["frozen"] == true {
                assert_eq!(parameter["start"].as_f64(), Some(value), "{name}");
            }
            fitted += 1;
        }
        let all = given.as_object().unwrap().values();
        let all = all.filter(|value| !value.is_null());
        // The law itself, and what bodies decide, are settings of the study.
        let mut settings = study["settings"].as_object().unwrap().clone();
        assert_eq!(settings.remove("profile").unwrap(), profile.base);
        assert_eq!(all.count(), fitted + settings.len());
        for (name, value) in settings {
            let is_same = given[&name] == value || given[&name].as_f64() == value.as_f64();
            assert!(is_same, "{name}");
        }
        assert!(NAMES.contains(&profile.base) && !NAMES.contains(&profile.name));
    }
}

#[test]
fn settings_override_the_parameters_of_a_calibrated_profile() {
    for profile in calibrated::all() {
        let whole = catalog::named(profile.name, &Parameters::default()).unwrap();
        let base = catalog::named(profile.base, &profile.parameters);
        assert_eq!(whole.sph, base.unwrap().sph);
        let changed = Parameters::of([("rest_density_max", 4.5)]).unwrap();
        let changed = catalog::named(profile.name, &changed).unwrap();
        assert_eq!(changed.sph.rest_density_max, 4.5);
        assert_eq!(changed.steps(), whole.steps());
    }
}

#[test]
fn a_profile_based_on_a_calibrated_one_has_its_parameters() {
    for profile in calibrated::all() {
        let blend = |profile: Value| {
            let document =
                json!({"profile": profile, "goal": [9, 9], "agents": [{"position": [1, 1]}]});
            parsed(&document).scene.groups[0].blend.clone()
        };
        let whole = blend(json!(profile.name));
        assert_eq!(blend(json!({"base": profile.name})), whole);
        let changed = blend(json!({"base": profile.name, "parameters": {"rest_density_max": 4.5}}));
        assert_eq!(changed.sph.rest_density_max, 4.5);
        assert_eq!(changed.steps(), whole.steps());
    }
}

#[test]
fn a_blend_takes_the_rest_density_of_the_calibrated_profile_in_it() {
    // All profiles of a blend have the same legs: those with legs fit no profile of the paper.
    let without_legs = calibrated::all().iter();
    for profile in without_legs.filter(|profile| profile.parameters.get("legs").is_none()) {
        let blend = json!({"blend": [
            {"at_density": 1, "profile": {"base": "sf",
                "parameters": {"contact_scale": profile.parameters.get("contact_scale")}}},
            {"at_density": 2, "profile": profile.name}]});
        let scenario = parsed(&json!({"duration_secs": 1, "profile": blend,
            "agents": [{"position": [0, 0], "goal": [9, 0]}]}));
        let blend = &scenario.scene.groups[0].blend;
        let own = profile.parameters.get("rest_density_max").unwrap();
        assert_eq!(blend.sph.rest_density_max, *own);
    }
}

/// The mean speed of people of 1.34 m/s in an endless corridor of 20 m × 3 m, in their last ten seconds, m/s.
fn mean_speed(profile: &str, columns: u32, rows: u32) -> f64 {
    let scenario = parsed(&json!({
        "duration_secs": 40, "profile": profile, "preferred_speed": 1.34,
        "periodic": {"axis": "x", "length": 20},
        "walkable_area": [[[[0, 0], [20, 0], [20, 3], [0, 3]]]],
        "grids": [{"min": [0, 0.3], "max": [20, 2.7], "columns": columns, "rows": rows, "jitter": 0.2}],
    }));
    let mut simulation = Simulation::new(scenario.scene).unwrap();
    run(&mut simulation, 1500);
    let (mut sum, mut count) = (Vector::zeros(), 0.0);
    for _ in 0..100 {
        run(&mut simulation, 5);
        let velocities = &simulation.frame().agents.velocity;
        sum += velocities.iter().sum::<Vector>();
        count += velocities.len() as f64;
    }
    sum.x / count
}

#[test]
fn people_walk_freely_where_it_is_loose_and_slowly_where_it_is_dense() {
    let with_law = calibrated::all().iter();
    for profile in with_law.filter(|profile| profile.parameters.get("walking_law").is_some()) {
        let [loose, middle, dense] = [(14, 2), (30, 4), (48, 5)]
            .map(|(columns, rows)| mean_speed(profile.name, columns, rows));
        assert!(loose > 0.95 * 1.34 && loose < 1.05 * 1.34, "{loose}");
        assert!(
            middle < 0.8 * loose && dense < 0.7 * middle,
            "{middle} {dense}"
        );
        assert!(dense > 0.1, "{dense}");
    }
}
