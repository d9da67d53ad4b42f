//! Work and precision: scenes and knobs are valid, errors decrease with the time step, and the command writes its
//! tables and pictures.

use crate::common::program;
use sandbox::engine::boundary::WallMethod;
use sandbox::lab::accuracy::{Detail, KNOBS, Kind, Knob, Lyapunov, Motion, SCENES, Scene, sample};
use sandbox::scenario::{Scenario, Setting};
use serde_json::{Value, json};

fn scene(name: &str) -> &'static Scene {
    SCENES.iter().find(|scene| scene.name == name).unwrap()
}

fn parse(document: &Value, settings: &[String]) -> Scenario {
    let settings: Vec<Setting> = settings.iter().map(|s| s.parse().unwrap()).collect();
    Scenario::parse(&document.to_string(), "f.json", &settings).unwrap()
}

#[test]
fn every_value_of_every_knob_is_a_setting() {
    for (name, knob) in KNOBS {
        assert_eq!(knob.name(), name);
        for curve in knob.curves(Detail::All) {
            for settings in &curve.points {
                parse(&small("sph"), settings);
            }
        }
    }
}

#[test]
fn knobs_act_only_in_scenes_where_they_change_something() {
    let turned = |name: &str| -> Vec<&str> {
        let scenario = parse(&scene(name).document().unwrap(), &[]);
        let (needs, has_walls) = (scenario.scene.needs(), !scenario.scene.walls.is_empty());
        let acts = KNOBS
            .iter()
            .filter(|(_, knob)| knob.acts(&needs, has_walls));
        acts.map(|(name, _)| *name).collect()
    };
    let always = ["time-step", "integrator", "lists", "precision", "preset"];
    for (name, more) in [
        ("relaxed", &["walls"][..]),
        ("social", &["tolerance"]),
        ("rvo", &["coarse", "candidates"]),
        ("evacuation-social", &["walls", "tolerance"]),
    ] {
        let found = turned(name);
        assert_eq!(found.len(), always.len() + more.len(), "{name}: {found:?}");
        assert!(always.iter().chain(more).all(|knob| found.contains(knob)));
    }
}

/// Nine people who press against each other.
fn small(profile: &str) -> Value {
    json!({
        "profile": profile,
        "grids": [{ "min": [0, 0], "max": [1.2, 1.2], "columns": 3, "rows": 3, "goal": [9, 3] }],
    })
}

#[test]
fn errors_are_symmetric_and_decrease_with_the_time_step() {
    let document = small("sph");
    let motion = |settings: &[&str]| {
        let settings: Vec<String> = settings.iter().map(|s| (*s).to_owned()).collect();
        Motion::of(&document, &settings).unwrap()
    };
    let default = motion(&[]);
    let zero = default.errors(&motion(&["time_step_secs=0.02"]));
    assert_eq!([zero.position, zero.velocity, zero.density], [[0.0; 3]; 3]);

    let (reference, own) = Motion::reference(&document, WallMethod::default(), false).unwrap();
    let errors = ["0.04", "0.02", "0.01"].map(|step| {
        let motion = motion(&[&format!("time_step_secs={step}")]);
        assert_eq!(motion.errors(&reference), reference.errors(&motion));
        motion.errors(&reference).position
    });
    for k in 0..3 {
        assert!(
            errors[0][k] > errors[1][k] && errors[1][k] > errors[2][k],
            "{errors:?}"
        );
        assert!(own.position[k] < 0.1 * errors[2][k], "{own:?} {errors:?}");
    }
}

#[test]
fn a_time_step_that_misses_a_sample_time_is_refused() {
    let refused = Motion::of(&small("sph"), &["time_step_secs=0.025".to_owned()]);
    assert!(refused.unwrap_err().to_string().contains("0.025"));
}

#[test]
fn perturbations_grow_in_a_crowd_but_not_among_lone_walkers() {
    let alone: Vec<Value> = (0..20)
        .map(|k| json!({ "position": [5 * k, 0], "goal": [5 * k, 1000] }))
        .collect();
    let alone = Lyapunov::of(&json!({ "agents": alone })).unwrap();
    // Paths to a goal 1 km away converge by a thousandth of the distance walked.
    assert!(
        alone.rate().abs() < 0.01 && (alone.growth - 1.0).abs() < 0.01,
        "{alone:?}"
    );
    let social = Lyapunov::of(&small("sf")).unwrap();
    assert!(social.growth > 3.0 && social.time().is_some(), "{social:?}");
}

#[test]
fn a_sample_depends_only_on_its_seed() {
    let wave = scene("wave");
    assert_eq!(wave.kind, Kind::Wave);
    let document = wave.document().unwrap();
    let speed = |seed| sample(wave.kind, &document, &[], seed).unwrap().values[0].unwrap();
    let (one, again, other) = (speed(1), speed(1), speed(2));
    assert_eq!(one, again);
    assert_ne!(one, other);
    // In theory √(k/2) = 10 m/s.
    assert!((one / 10.0 - 1.0).abs() < 0.05, "{one}");
}

#[test]
fn best_values_are_among_those_tried() {
    for (_, knob) in KNOBS {
        let Some(best) = knob.best() else {
            assert!(matches!(
                knob,
                Knob::TimeStep | Knob::Integrator | Knob::Preset
            ));
            continue;
        };
        assert!(knob.curves(Detail::All)[0].points.contains(&best));
    }
}

#[test]
fn the_command_writes_tables_and_pictures_and_keeps_finished_cases() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = |arguments: &[&str]| {
        let out = ["--out", program::text(&out)];
        program::run(&[&["accuracy"], arguments, &out].concat())
    };
    let arguments = ["wall", "--knob", "precision", "--quick", "--json"];
    let first = run(&arguments);
    assert_eq!(first.status.code(), Some(0));
    let report = program::json(&first);
    let points = report["scenes"][0]["points"].as_array().unwrap();
    assert_eq!(points.len(), 2);
    for point in points {
        assert!(point["ms_per_s"]["median"].as_f64().unwrap() > 0.0);
        assert!(point["errors"][1]["error"].as_f64().unwrap() > 0.0);
    }
    for file in ["accuracy.md", "accuracy.csv", "accuracy.json"] {
        assert!(out.join(file).metadata().unwrap().len() > 0, "{file}");
    }
    assert!(out.join("accuracy-wall.png").exists());
    let again = program::stderr(&run(&arguments));
    assert!(again.contains("0 case(s) to run, 1 kept"), "{again}");

    let unknown = run(&["wall", "--knob", "taste"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(program::stderr(&unknown).contains("time-step"));
}
