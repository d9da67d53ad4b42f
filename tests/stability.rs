//! The largest stable time step: the automatic step, and what happens beyond it.

use crate::common::program;
use sandbox::analysis::stability::{Constants, FITTED};
use sandbox::lab::stress::{Cell, Condition, Detail, Limit, Rest, fit};
use sandbox::scenario::Scenario;

#[test]
fn the_automatic_step_is_stable_and_at_least_70_percent_of_the_largest() {
    let paper = Rest::default();
    for crowd in [
        paper,
        Rest {
            agent_stiffness: 1000.0,
            ..paper
        },
        Rest {
            viscosity: 100.0,
            ..paper
        },
        Rest {
            gas_constant: 3200.0,
            ..paper
        },
    ] {
        let cell = Cell::find(crowd, 3, 0).unwrap();
        assert!(cell.auto_is_stable(), "{cell:?}");
        let limits = cell.limits.iter();
        let mut ratios = limits.map(Limit::ratio);
        assert!(ratios.all(|r| (0.7..=1.0).contains(&r)), "{cell:?}");
    }
}

#[test]
fn a_crowd_at_rest_oscillates_with_twice_the_automatic_step() {
    let crowd = Rest {
        agent_stiffness: 1000.0,
        ..Rest::default()
    };
    for condition in Condition::ALL {
        let step = crowd.mode().time_step(condition.scheme);
        let [full, loose] = crowd.rooms(step, (condition, 0)).unwrap();
        assert!(full.speed < Some(0.1) && loose.speed < Some(0.01));
        let [full, _] = crowd.rooms(2.0 * step, (condition, 0)).unwrap();
        assert!(full.speed > Some(0.5) && full.persistence < 0.0, "{full:?}");
        assert!(!full.are_stable());
    }
}

#[test]
fn sustained_motion_is_persistent_unless_the_step_is_too_long() {
    let crowd = Rest {
        gas_constant: 3200.0,
        ..Rest::default()
    };
    for condition in [Condition::PAPER, Condition::VERLET] {
        let step = crowd.mode().time_step(condition.scheme);
        let run = |step| crowd.run(5.5, step, (condition, 0)).unwrap();
        let (fine, auto, long) = (run(0.2 * step), run(step), run(1.5 * step));
        assert!(fine.speed > Some(0.5) && fine.persistence > 0.9, "{fine:?}");
        assert!(auto.are_stable() && auto.persistence > 0.1, "{auto:?}");
        assert!(long.persistence < -0.3, "{long:?}");
    }
}

#[test]
fn a_scenario_uses_the_automatic_step_and_refuses_it_where_it_is_unknown() {
    let parse = |text: &str| Scenario::parse(text, "f.json", &[]);
    let step = |text: &str| parse(text).unwrap().scene.clock.time_step();
    let soft =
        step(r#"{"time_step_secs": "auto", "goal": [9, 0], "agents": [{"position": [0, 0]}]}"#);
    let stiff = step(
        r#"{"time_step_secs": "auto", "goal": [9, 0], "agents": [{"position": [0, 0]}],
            "parameters": {"gas_constant": 12800}}"#,
    );
    assert!(soft > 0.03 && stiff < 0.012, "{soft} {stiff}");
    assert_eq!(step(r#"{"time_step_secs": 0.01}"#), 0.01);
    assert_eq!(step(r#"{"time_step_secs": 1}"#), 1.0);
    let thick = |integrator: &str| {
        step(&format!(
            r#"{{"time_step_secs": "auto", "integrator": "{integrator}", "goal": [9, 0],
                "agents": [{{"position": [0, 0]}}], "parameters": {{"viscosity": 100}}}}"#
        ))
    };
    let ratio = thick("semi-implicit") / thick("velocity-verlet");
    // Half as long for velocity Verlet, apart from the margins.
    assert!((1.9..=2.0).contains(&ratio), "{ratio}");
    let refused = |text: &str| parse(text).unwrap_err().to_string();
    for integrator in ["forward-euler", "midpoint"] {
        let text = format!(r#"{{"time_step_secs": "auto", "integrator": "{integrator}"}}"#);
        let refusal = refused(&text);
        assert!(refusal.contains("time_step_secs: `auto`"), "{refusal}");
        for known in ["`semi-implicit`", "`velocity-verlet`"] {
            assert!(refusal.contains(known), "{refusal}");
        }
    }
    let word = refused(r#"{"time_step_secs": "fast"}"#);
    assert!(
        word.contains("time_step_secs") && word.contains("auto"),
        "{word}"
    );
}

#[test]
fn a_time_step_that_is_too_long_gives_a_warning() {
    let stderr = |step: &str, settings: &[&str]| {
        let mut arguments = vec!["evacuation", "--until", "1", "--time-step", step];
        arguments.extend(settings.iter().flat_map(|setting| ["--set", setting]));
        let output = program::run(&arguments);
        assert_eq!(output.status.code(), Some(0));
        program::stderr(&output)
    };
    assert!(stderr("0.25", &[]).contains("warning: time_step_secs 0.25 is "));
    assert!(!stderr("auto", &[]).contains("warning"));
    assert!(!stderr("0.02", &[]).contains("warning"));
    // Velocity Verlet tolerates only half as much viscosity.
    let (verlet, thick) = ("integrator=velocity-verlet", "viscosity=30");
    assert!(!stderr("0.02", &[thick]).contains("warning"));
    assert!(stderr("0.02", &[thick, verlet]).contains("warning: time_step_secs 0.02 is "));
    assert!(!stderr("auto", &[thick, verlet]).contains("warning"));
}

#[test]
fn constants_are_found_again_from_steps_that_they_have_made() {
    let made = Constants {
        pressure: 3.1,
        contact: 4.4,
        drag: 1.3,
        ..FITTED
    };
    let cell = |crowd: Rest| Cell {
        crowd,
        limits: Condition::ALL.map(|condition| Limit {
            largest: crowd.mode().largest_step(condition.scheme, &made),
            auto: 0.01,
            auto_is_stable: true,
            fine_speed: 0.0,
            auto_speed: 0.0,
        }),
    };
    let crowds = Detail::read(true).unwrap().crowds().into_iter();
    let found = fit(&crowds.map(cell).collect::<Vec<_>>());
    for (found, made, most) in [
        (found.pressure, made.pressure, 0.01),
        (found.contact, made.contact, 0.02),
        (found.drag, made.drag, 0.02),
        // The largest ratio of steps that the fit allows.
        (found.margin, 0.97, 0.02),
        (found.verlet_margin, 0.97, 0.02),
    ] {
        assert!((found / made - 1.0).abs() < most, "{found} for {made}");
    }
}

#[test]
fn the_maps_have_every_crowd_once() {
    for (quick, points, others) in [(false, 73, 27), (true, 15, 4)] {
        let detail = Detail::read(quick).unwrap();
        assert_eq!(
            (detail.crowds().len(), detail.held_out.len()),
            (points, others)
        );
    }
}
