//! The largest stable time step: the automatic step, and what happens beyond it.

use crate::common::program;
use nalgebra::{Matrix3, Vector3};
use sandbox::engine::clock::PAPER_COARSE_STEP;
use sandbox::engine::forces::rates::Rates;
use sandbox::engine::scene::{Integrator, Scene};
use sandbox::engine::stability::{Constants, FITTED, Scheme, time_step};
use sandbox::lab::stress::{Cell, Condition, Detail, Law, Limit, Rest, fit};
use sandbox::scenario::Scenario;
use sandbox::scenario::catalog::WalkingLawKind;

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
fn a_crowd_with_drag_walks_steadily_until_the_step_is_too_long() {
    let crowd = Rest {
        law: Law {
            walking_law: Some(WalkingLawKind::Drag),
            drag_per_density: Some(10.0),
            ..Law::default()
        },
        ..Rest::default()
    };
    let condition = Condition::PAPER;
    let step = crowd.mode().time_step(condition.scheme);
    assert!(crowd.is_stable(step, (condition, 0)).unwrap());
    assert!(!crowd.is_stable(4.0 * step, (condition, 0)).unwrap());
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
            r#"{{"time_step_secs": "auto", "coarse_every": 5, "integrator": "{integrator}",
                "goal": [9, 0], "agents": [{{"position": [0, 0]}}],
                "parameters": {{"viscosity": 100}}}}"#
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
fn the_automatic_step_is_the_longest_fraction_of_the_coarse_step_that_is_stable() {
    let clock = |more: &str| {
        let text = format!(
            r#"{{"time_step_secs": "auto", "goal": [9, 0], "agents": [{{"position": [0, 0]}}]{more}}}"#
        );
        Scenario::parse(&text, "f.json", &[]).unwrap().scene.clock
    };
    let unlimited = |more: &str| clock(&format!("{more}, \"longest_step_secs\": 0.1"));
    for stiffness in [20, 50, 100, 200, 1000, 5000, 12_800] {
        let parameters = format!(r#", "parameters": {{"gas_constant": {stiffness}}}"#);
        let whole = unlimited(&parameters);
        let frames = f64::from(whole.coarse_every());
        assert!((whole.coarse_step() - PAPER_COARSE_STEP).abs() < 1e-12);
        // With frames of its own choice per coarse step, a scene takes the longest stable step itself.
        let stable = unlimited(&format!("{parameters}, \"coarse_every\": 5")).time_step();
        assert!(whole.time_step() <= stable, "{stiffness}");
        let longer = PAPER_COARSE_STEP / (frames - 1.0);
        assert!(
            longer > stable || frames == 1.0,
            "{stiffness}: {longer} {stable}"
        );
        // A limit counts like the stable step.
        let limited = clock(&format!("{parameters}, \"longest_step_secs\": 0.03")).time_step();
        assert!(limited <= 0.03 && limited <= whole.time_step());
    }
    // Decimal limits are not missed by rounding.
    for (limit, frames) in [(0.05, 2), (0.025, 4), (0.02, 5), (0.01, 10)] {
        let clock = clock(&format!(", \"longest_step_secs\": {limit}"));
        assert_eq!((clock.time_step(), clock.coarse_every()), (limit, frames));
    }
}

#[test]
fn the_automatic_integrator_depends_on_what_agents_do() {
    let choice = |more: &str| {
        let text = format!(
            r#"{{"integrator": "auto", "goal": [9, 0], "grids": [{{"min": [0, 0], "max": [1, 1],
                "columns": 2, "rows": 2{more}}}]}}"#
        );
        let scenario = Scenario::parse(&text, "f.json", &[]).unwrap();
        let named = scenario.settings()["integrator"].clone();
        assert_eq!(
            named,
            serde_json::to_value(scenario.scene.integrator).unwrap()
        );
        scenario.scene.integrator
    };
    assert_eq!(choice(""), Integrator::VelocityVerlet);
    for leaves_or_avoids in [
        r#", "remove_within": 1"#,
        r#", "profile": "sf->sph""#,
        r#", "profile": "rvo""#,
    ] {
        assert_eq!(choice(leaves_or_avoids), Integrator::SemiImplicit);
    }
}

#[test]
fn fast_steps_depend_on_avoidance_and_exits() {
    let step = |profile: &str, more: &str| {
        let text = format!(
            r#"{{"preset": "fast", "profile": "{profile}", "goal": [9, 0],
                "parameters": {{"gas_constant": 20, "agent_stiffness": 50, "wall_stiffness": 50}},
                "grids": [{{"min": [0, 0], "max": [2, 2], "columns": 2, "rows": 2{more}}}]}}"#
        );
        Scenario::parse(&text, "f.json", &[])
            .unwrap()
            .scene
            .clock
            .time_step()
    };
    assert_eq!(step("sph", ""), 0.05);
    let leaves = r#", "remove_within": 1"#;
    assert_eq!(step("sph", leaves), 0.025);
    assert_eq!(step("walk+sph", leaves), 0.025);
    assert_eq!(step("sf->sph", leaves), 0.025);
    assert_eq!(step("sf+sph", leaves), 0.02);
    assert_eq!(step("rvo+sph", ""), 0.02);
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
    for (quick, points, others) in [(false, 73, 41), (true, 15, 6)] {
        let detail = Detail::read(quick).unwrap();
        assert_eq!(
            (detail.crowds().len(), detail.held_out.len()),
            (points, others)
        );
    }
}

/// The linear map of one frame, acting on x, the velocity that forces see and the previous acceleration.
fn frame(scheme: Scheme, omega_squared: f64, gamma: f64, dt: f64) -> Matrix3<f64> {
    let moved = |x: f64, seen: f64, before: f64| {
        let a = -omega_squared * x - gamma * seen;
        let (way, velocity) = match scheme {
            Scheme::SemiImplicit => (seen + a * dt, seen + a * dt),
            Scheme::VelocityVerlet => {
                let v = seen + 0.5 * dt * (a - before);
                (v + 0.5 * dt * a, v + dt * a)
            }
        };
        Vector3::new(x + way * dt, velocity, a)
    };
    let columns = [
        moved(1.0, 0.0, 0.0),
        moved(0.0, 1.0, 0.0),
        moved(0.0, 0.0, 1.0),
    ];
    Matrix3::from_columns(&columns)
}

/// The spectral radius of the map of one frame, from the growth over 2⁴⁰ frames.
fn growth(mut frames: Matrix3<f64>) -> f64 {
    let (mut logarithm, mut count) = (0.0, 1.0);
    for _ in 0..40 {
        let norm = frames.norm();
        logarithm += norm.ln() / count;
        frames = (frames / norm).pow(2);
        count *= 2.0;
    }
    logarithm.exp()
}

/// Rates of which only those of a corner are not zero: its spring and the friction in front of it.
fn corner(omega_squared: f64, gamma: f64) -> Rates {
    Rates {
        corner: omega_squared,
        correction: gamma,
        ..Rates::default()
    }
}

#[test]
fn the_step_is_where_an_oscillator_begins_to_grow() {
    for scheme in [Scheme::SemiImplicit, Scheme::VelocityVerlet] {
        // All steps are shorter than the longest one allowed.
        for (omega_squared, gamma) in [
            (1e4, 0.0),
            (1e4, 100.0),
            (700.0, 2.0),
            (700.0, 30.0),
            (3.0, 90.0),
            (0.0, 50.0),
        ] {
            let step = corner(omega_squared, gamma).largest_step(scheme, &FITTED);
            let growth = |part: f64| growth(frame(scheme, omega_squared, gamma, part * step));
            for part in 1..1000 {
                let part = f64::from(part) / 1000.0;
                assert!(
                    growth(part) < 1.0 + 1e-9,
                    "{scheme:?} {omega_squared} {gamma}"
                );
            }
            assert!(
                growth(1.001) > 1.0 + 1e-6,
                "{scheme:?} {omega_squared} {gamma}"
            );
        }
    }
}

#[test]
fn only_integrators_with_a_formula_have_an_automatic_step() {
    for integrator in Integrator::ALL {
        let scene = Scene {
            integrator,
            ..Scene::default()
        };
        let scheme = Scheme::of(integrator);
        let has_formula = !matches!(integrator, Integrator::ForwardEuler | Integrator::Midpoint);
        assert_eq!(scheme.is_some(), has_formula);
        assert_eq!(time_step(&scene).is_some(), has_formula);
        assert!(scheme.is_none_or(|scheme| scheme.integrator() == integrator));
    }
}

#[test]
fn steps_are_rounded_down_to_three_digits() {
    for (scheme, margin, longest) in [
        (Scheme::SemiImplicit, FITTED.margin, 0.085),
        (Scheme::VelocityVerlet, FITTED.verlet_margin, 0.088),
    ] {
        assert_eq!(Rates::default().time_step(scheme), longest);
        for k in 0..500 {
            let mode = corner(1e3 * 1.03_f64.powi(k), f64::from(k));
            let (step, exact) = (mode.time_step(scheme), mode.largest_step(scheme, &FITTED));
            assert_eq!(format!("{step:.2e}").parse(), Ok(step));
            let ratio = step / (margin * exact);
            assert!(0.99 < ratio && ratio < 1.0 + 1e-9, "{step}: {ratio}");
        }
    }
}
