//! Work and precision: scenes and choices are valid, errors decrease with the time step, and the command writes its
//! tables and pictures.

use std::collections::{BTreeMap, BTreeSet};

use crate::common::{pictures, program};
use sandbox::engine::boundary::WallMethod;
use sandbox::lab::accuracy::{
    Kind, Lyapunov, Measured, Motion, SAMPLES, SCENES, Scene, Trial, better, cheapest, choices,
    limit, trials,
};
use sandbox::scenario::{Scenario, Setting};
use serde_json::{Value, json};

/// The scenario of a scene, and what is tried in it.
fn tried(scene: &Scene) -> (Scenario, Vec<Trial>) {
    let study = scene.study(Some(1)).unwrap();
    let scenario = study.cells[0].case.scenario().unwrap();
    let trials = trials(&study, &scenario.document).unwrap();
    (scenario, trials)
}

#[test]
fn knobs_are_tried_in_all_scenes_where_they_change_something() {
    for scene in &SCENES {
        let (scenario, trials) = tried(scene);
        let needs = scenario.scene.needs();
        let acts = |choice: &&str| match *choice {
            "coarse" | "candidates" => needs.rvo,
            "tolerance" => needs.social,
            "walls" => needs.pairs.pressure && !scenario.scene.walls.is_empty(),
            _ => true,
        };
        let expected: BTreeSet<&str> = choices().into_iter().filter(acts).collect();
        let found: BTreeSet<&str> = trials.iter().map(|trial| trial.choice.as_str()).collect();
        assert_eq!(found, expected, "{}", scene.name);
    }
}

#[test]
fn a_knob_has_the_same_values_in_all_scenes_but_statistics_skip_the_finest_step() {
    let mut values: BTreeMap<String, Vec<Vec<String>>> = BTreeMap::new();
    for scene in &SCENES {
        let is_skipped = |settings: &Vec<String>| {
            scene.kind == Kind::Statistics && settings[0] == "time_step_secs=0.0025"
        };
        let mut own: BTreeMap<String, Vec<Vec<String>>> = BTreeMap::new();
        for trial in tried(scene).1 {
            let settings = trial.settings.iter().map(Setting::to_string).collect();
            own.entry(trial.choice).or_default().push(settings);
        }
        for (choice, own) in own {
            let mut all = values.entry(choice).or_insert(own.clone()).clone();
            all.retain(|settings| !is_skipped(settings));
            assert_eq!(own, all, "{}", scene.name);
        }
    }
}

#[test]
fn every_curve_has_the_default_but_those_of_other_integrators() {
    for scene in &SCENES {
        let (scenario, trials) = tried(scene);
        for curve in trials.chunk_by(|a, b| a.curve == b.curve) {
            let Trial {
                choice,
                curve: label,
                best,
                ..
            } = &curve[0];
            let defaults = curve.iter().filter(|trial| trial.is_default).count();
            let expected = match choice.as_str() {
                "integrator" => 0,
                "preset" if scenario.scene.needs().rvo => 2, // `fast` is the default with RVO
                _ => 1,
            };
            assert_eq!(defaults, expected, "{} {label}", scene.name);
            let has_best = !["time-step", "integrator", "preset"].contains(&choice.as_str());
            assert_eq!(best.is_some(), has_best, "{choice}");
        }
    }
}

#[test]
fn every_step_of_scenes_of_motion_meets_every_sample() {
    for scene in SCENES.iter().filter(|scene| scene.kind == Kind::Motion) {
        for cell in scene.study(None).unwrap().cells {
            let step = cell.case.scenario().unwrap().scene.clock.time_step();
            for time in SAMPLES {
                let frames = time / step;
                assert!(
                    (frames - frames.round()).abs() < 1e-9,
                    "{cell}: {step} s, {time} s"
                );
            }
        }
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
        let settings: Vec<Setting> = settings.iter().map(|s| s.parse().unwrap()).collect();
        Motion::of(&document, &settings).unwrap()
    };
    let default = motion(&[]);
    let zero = default.errors(&motion(&["time_step_secs=0.02"]));
    assert_eq!([zero.position, zero.velocity, zero.density], [[0.0; 3]; 3]);

    let [reference, coarser] = [1.0, 2.0].map(|coarser| {
        let settings = limit(WallMethod::default(), false, coarser).unwrap();
        Motion::of(&document, &settings).unwrap()
    });
    let own = coarser.errors(&reference);
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
    let refused = Motion::of(&small("sph"), &["time_step_secs=0.03".parse().unwrap()]);
    assert!(refused.unwrap_err().to_string().contains("0.03"));
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
fn statistics_are_means_over_seeds_compared_with_the_first_point() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out = program::text(&out);
    let run = program::run(&[
        "accuracy", "wave", "--choice", "lists", "--quick", "--json", "--out", out,
    ]);
    let report = program::json(&run);
    let scene = &report["scenes"][0];
    assert_eq!(scene["quantities"][0]["name"], "wave speed");
    let points = scene["points"].as_array().unwrap();
    assert_eq!(points.len(), 2);
    assert_eq!(
        [&points[0]["default"], &points[1]["default"]],
        [true, false]
    );
    assert_eq!(points[0]["errors"][0]["error"], 0.0);
    for point in points {
        let mean = &point["errors"][0]["mean"];
        // In theory √(k/2) = 10 m/s.
        assert!(
            (mean[0].as_f64().unwrap() / 10.0 - 1.0).abs() < 0.05,
            "{point}"
        );
        assert!(
            mean[1].as_f64().unwrap() > 0.0,
            "both seeds are the same: {point}"
        );
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
    let arguments = ["wall", "--choice", "precision", "--quick", "--json"];
    let first = run(&arguments);
    assert_eq!(first.status.code(), Some(0));
    let report = program::json(&first);
    let points = report["scenes"][0]["points"].as_array().unwrap();
    assert_eq!(points.len(), 2);
    for point in points {
        assert!(point["ms_per_s"]["median"].as_f64().unwrap() > 0.0);
        assert!(point["errors"][1]["error"].as_f64().unwrap() > 0.0);
    }
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    let kept: serde_json::Value = serde_json::from_str(&read("accuracy.json")).unwrap();
    assert_eq!(kept["scenes"], report["scenes"]);
    let (table, rows) = (read("accuracy.md"), read("accuracy.csv"));
    for point in points {
        let error = point["errors"][1]["error"].as_f64().unwrap();
        assert!(rows.contains(&error.to_string()), "no {error} in {rows}");
    }
    assert!(table.contains("precision"), "{table}");
    let texts = [
        "position at 0.4 s",
        "velocity at 0.8 s",
        "error [m]",
        "precision",
        "default",
    ];
    pictures::assert_has(&out.join("accuracy-wall"), &texts);
    let again = program::stderr(&run(&arguments));
    assert!(again.contains("0 case(s) to run, 1 kept"), "{again}");

    let unknown = run(&["wall", "--choice", "taste"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(program::stderr(&unknown).contains("time-step"));
}

#[test]
fn a_point_on_the_front_is_beaten_by_no_other_point() {
    let points = [(1.0, 1.0), (2.0, 0.5), (4.0, 0.6), (2.1, 0.1)];
    assert_eq!(better(&points, 0), [None, None]);
    assert_eq!(better(&points, 2), [Some(3), Some(1)]);
    // Its cost counts as equal: it is within a tenth.
    assert_eq!(better(&points, 1), [Some(3), None]);
    assert_eq!(cheapest(&points, 0.5), Some(1));
    assert_eq!(cheapest(&points, 0.01), None);
}

#[test]
fn what_seeds_cannot_tell_apart_is_not_significant() {
    let reference = [10.0, 10.2, 9.8, 10.1, 9.9];
    let same = Measured::between(&[10.1, 9.9, 10.2, 9.9, 10.0], &reference).unwrap();
    let other = Measured::between(&[11.1, 10.9, 11.2, 10.9, 11.0], &reference).unwrap();
    assert!(!same.is_significant() && other.is_significant());
    assert!((other.error - 1.02).abs() < 1e-12);
    // Five values of variance 0.025: t = 2.776, standard error 0.0707.
    let (mean, interval) = Measured::between(&reference, &[0.0]).unwrap().mean.unwrap();
    assert!((mean - 10.0).abs() < 1e-12);
    assert!((interval - 2.776_445 * (0.025_f64 / 5.0).sqrt()).abs() < 1e-6);
}
