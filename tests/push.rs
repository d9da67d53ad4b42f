//! Forces of pushes, and pushes through rows of people.

use sandbox::analysis::push::{Pushed, THRESHOLDS};
use sandbox::engine::forces::push::PushForce;
use sandbox::engine::math::Vector;
use serde_json::{Value, json};

use crate::common::simulated::{after, measured, scenario};

#[test]
fn the_force_is_a_curve_of_straight_lines_and_zero_outside() {
    let force = PushForce {
        push: 0,
        at: 0.0,
        direction: Vector::x(),
        curve: vec![[0.5, 2.0], [1.0, -1.0], [3.0, 4.0]],
    };
    let cases = [
        (0.49, 0.0),
        (0.5, 2.0),
        (0.75, 0.5),
        (1.0, -1.0),
        (2.0, 1.5),
        (3.0, 4.0),
        (3.01, 0.0),
    ];
    for (secs, expected) in cases {
        assert!((force.strength(secs) - expected).abs() < 1e-12, "{secs}");
    }
}

/// Two people who stand 10 m apart; the one at `x` = 0 is pushed with a constant 1 m/s² against y from 1 s on for 2 s.
fn pushed(mass: f64) -> Value {
    let person = |x: f64| json!({"position": [x, 0], "goal": [x, 100], "premovement_secs": 1000, "mass": mass});
    json!({
        "duration_secs": 4, "profile": "sph", "agents": [person(0.0), person(10.0)],
        "events": [{"at_secs": 1, "for_secs": 2, "region": [[-1, -1], [1, 1]],
                    "acceleration": [[0, 1], [10, 1]], "direction": [0, -2]}],
    })
}

#[test]
fn a_pushed_person_follows_the_closed_form_whatever_its_mass() {
    for mass in [1.0, 2.5] {
        let simulation = after(&pushed(mass), &[], 4.0);
        let (agents, step) = (simulation.frame().agents, 0.02_f64);
        // v' = v + (1 − v/(τ m)) Δt for a hundred steps, then v' = v (1 − Δt/(τ m)) for fifty.
        let kept = 1.0 - step / (0.5 * mass);
        let speed = 0.5 * mass * (1.0 - kept.powi(100)) * kept.powi(50);
        assert!((agents.velocity[0] - Vector::new(0.0, -speed)).norm() < 1e-12);
        assert_eq!(agents.velocity[1], Vector::zeros());
        // What was given is 1 m/s² for 2 s; what friction does not take on the way is left. A frame moves with its new
        // speed and brakes by its old one.
        let braked = -agents.position[0].y - speed * step;
        assert!((2.0 - braked / (0.5 * mass) - speed).abs() < 1e-9);
    }
}

#[test]
fn keys_of_the_force_are_checked() {
    let refused = |key: &str, value: Value, said: &str| {
        let mut document = pushed(1.0);
        document["events"][0][key] = value;
        let error = scenario(&document, &[]).unwrap_err();
        assert!(error.contains(said), "{error}");
    };
    let late = "events[0].acceleration[1]: must be later than the point before, at 2 s";
    refused("acceleration", json!([[2, 1], [2, 3]]), late);
    let none = "events[0].acceleration: nowhere.txt cannot be read";
    refused("acceleration", json!("nowhere.txt"), none);
    let zero = "events[0].direction: must not be [0, 0]";
    refused("direction", json!([0, 0]), zero);
    let alone = "events[0].direction: is for `acceleration`, which is not given";
    refused("acceleration", Value::Null, alone);
    let kind = "events[0].acceleration: invalid type: integer `5`, expected a list of [seconds";
    refused("acceleration", json!(5), kind);
}

#[test]
fn a_file_of_the_force_is_read_with_and_without_a_header() {
    let folder = tempfile::tempdir().unwrap();
    for header in ["", "TimeS ForcePerMassNperM\n"] {
        let path = folder.path().join("force.txt");
        std::fs::write(&path, format!("{header}0 1\n\n10\t1.0\n")).unwrap();
        let mut document = pushed(1.0);
        document["events"][0]["acceleration"] = json!(path);
        let speed = |document: &Value| after(document, &[], 2.0).frame().agents.velocity[0].y;
        assert_eq!(speed(&document), speed(&pushed(1.0)));
        std::fs::write(&path, format!("{header}0 1\n10\n")).unwrap();
        let error = scenario(&document, &[]).unwrap_err();
        let said = "must be two numbers, seconds and m/s²";
        assert!(error.contains(said) && error.contains("line "), "{error}");
    }
}

/// The time between two samples, seconds.
const EVERY: f64 = 0.04;

/// A row of five people, 0.4 m apart, who stand until a front at 2.5 m/s reaches them, then walk at 0.8 m/s for 1 s.
fn row() -> Vec<Vec<f64>> {
    let place = |person: u32, sample: u32| {
        let start = 0.4 * f64::from(person);
        let walked = f64::from(sample) * EVERY - 1.0 - start / 2.5;
        start + 0.8 * walked.clamp(0.0, 1.0)
    };
    let person = |person| (0..100).map(|sample| place(person, sample)).collect();
    (0..5).map(person).collect()
}

#[test]
fn a_front_of_known_speed_is_found() {
    let people = row();
    let found = people.iter().map(|places| Pushed::of(places, EVERY));
    let found: Vec<Pushed> = found.collect::<Option<_>>().unwrap();
    assert!((Pushed::front(&found).unwrap() - 2.5).abs() < 1e-9);
    // Breaks are found to a tenth of a sample, and depend a little on how long a person stands before.
    assert!((Pushed::front_of_starts(&found).unwrap() - 2.5).abs() < 0.05);
    // All of them walk for a while.
    assert!((Pushed::passed_on(&found).unwrap() - 4.0 * 0.8).abs() < 1e-9);
    for (k, one) in found.iter().enumerate() {
        assert!((one.top_speed - 0.8).abs() < 1e-9 && (one.reach - 0.8).abs() < 1e-9);
        let starts = 1.0 + 0.16 * k as f64;
        assert!((one.starts.unwrap() - starts).abs() < 2.0 * EVERY);
        // A mean over five samples begins to rise two samples before, and a central difference one earlier.
        for (reached, threshold) in one.reached.iter().zip(THRESHOLDS) {
            let early = starts - reached.unwrap();
            assert!(
                (-EVERY..=3.0 * EVERY).contains(&early),
                "{threshold}: {early}"
            );
        }
    }
}

#[test]
fn who_stands_is_not_reached() {
    let mut people = row();
    people[3] = vec![1.2; 100];
    people[4] = vec![1.6; 100];
    let found: Vec<Pushed> = people
        .iter()
        .map(|places| Pushed::of(places, EVERY).unwrap())
        .collect();
    assert_eq!(Pushed::front(&found), None); // three people make no front
    assert_eq!((found[3].reached, found[3].reach), ([None; 6], 0.0));
    assert_eq!(Pushed::of(&[1.0], EVERY), None);
}

#[test]
fn a_run_is_measured_like_its_own_trajectory() {
    let person = |k: u32| {
        let x = 0.35 * f64::from(k);
        json!({"position": [x, 0], "goal": [100, 0], "premovement_secs": 100, "radius": 0.15, "mass": 1})
    };
    let people: Vec<Value> = (0..6).map(person).collect();
    let document = json!({
        "duration_secs": 3, "profile": "sph", "agents": people,
        "events": [{"at_secs": 0, "for_secs": 1, "region": [[-0.1, -1], [0.1, 1]], "acceleration": [[0, 9], [0.5, 9]]}],
        "measurements": [{"push": {"people": 6}}],
    });
    let summary = measured(document.clone());
    let places = |k: usize| -> Vec<f64> {
        let at = |sample: u32| {
            let secs = f64::from(sample) * EVERY;
            after(&document, &[], secs).frame().agents.position[k].x
        };
        (0..=75).map(at).collect()
    };
    let row: Vec<Pushed> = (0..6)
        .map(|k| Pushed::of(&places(k), EVERY).unwrap())
        .collect();
    let is = |name: &str, value: f64| {
        let found = summary.metric(name).unwrap();
        assert!((found - value).abs() < 1e-12, "{name}: {found}, {value}");
    };
    is("push_front_m_per_s", Pushed::front(&row).unwrap());
    is("push_passed_on_m_per_s", Pushed::passed_on(&row).unwrap());
    for (k, one) in row.iter().enumerate() {
        is(&format!("push_top_speed_{}_m_per_s", k + 1), one.top_speed);
        is(&format!("push_reach_{}_m", k + 1), one.reach);
    }
    assert!(row[0].top_speed > row[5].top_speed && row[5].top_speed > 0.0);
}
