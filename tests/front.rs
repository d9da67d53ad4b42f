//! The speed of fronts with known start times.

use sandbox::analysis::front::Front;
use sandbox::scenario::measurements::FrontData;
use serde_json::{Value, json};

use crate::common::simulated::{measured, scenario};

/// 100 places, 0.3 m apart, that a front at `speed` m/s reaches, in another order than that of the places.
fn reached(speed: f64) -> Vec<[f64; 2]> {
    let places = (0..100).map(|k| 0.3 * f64::from((37 * k) % 100));
    places.map(|place| [place, 2.0 + place / speed]).collect()
}

#[test]
fn known_start_times_give_the_speed() {
    for speed in [0.3, -1.2, 8.0] {
        let front = Front::through(&reached(speed), 0.0).unwrap();
        let found = front.speed.unwrap();
        assert!((found.value / speed - 1.0).abs() < 1e-9, "{found:?}");
        assert!(found.error < 1e-9 && (front.starts - 2.0).abs() < 1e-9);
    }
}

#[test]
fn a_fifth_of_wrong_times_hardly_matters_and_the_error_covers_scatter() {
    let mut points = reached(1.2);
    for (k, point) in points.iter_mut().enumerate() {
        point[1] += 0.2 * (1.7 * k as f64).sin();
        if k < 20 {
            point[1] += 50.0;
        }
    }
    let found = Front::through(&points, 0.02).unwrap().speed.unwrap();
    assert!(found.error > 1e-4 && found.error < 0.1, "{found:?}");
    assert!((found.value - 1.2).abs() < 0.03, "{found:?}");
}

#[test]
fn who_starts_at_once_is_no_front() {
    let mut at_once = reached(1.0);
    for (k, point) in at_once.iter_mut().enumerate() {
        point[1] = 5.0 + 0.02 * f64::from((k * 7 % 5) as u8);
    }
    let front = Front::through(&at_once, 0.02).unwrap();
    assert_eq!(front.speed, None);
    assert!(front.slowness.value.abs() < 0.01);
    assert_eq!(Front::through(&at_once[..3], 0.02), None);
    assert_eq!(Front::through(&[[1.0, 2.0]; 20], 0.02), None);
}

#[test]
fn a_difference_of_two_time_steps_is_no_front() {
    // Thirty people, 1 m apart; those of the second half start some time steps earlier, all at once.
    let time_step = 0.02;
    let halves = |steps: f64| -> Vec<[f64; 2]> {
        let starts = |k: i32| 5.0 - f64::from(k / 15) * steps * time_step;
        (0..30).map(|k| [f64::from(k), starts(k)]).collect()
    };
    for steps in [1.0, 2.0] {
        let front = Front::through(&halves(steps), time_step).unwrap();
        assert!(front.slowness.error < 0.5 * front.slowness.value.abs());
        assert!((front.slowness.value + steps * time_step / 15.0).abs() < 1e-12);
        assert_eq!(front.speed, None);
        let finer = Front::through(&halves(steps), 0.1 * time_step).unwrap();
        assert!(finer.speed.unwrap().value < 0.0);
    }
    assert!(
        Front::through(&halves(3.0), time_step)
            .unwrap()
            .speed
            .is_some()
    );
}

/// Twenty people 3 m apart along x who start at `secs(k)`, far apart from each other.
fn people(secs: impl Fn(f64) -> f64) -> Vec<Value> {
    let person = |k: u8| {
        json!({"position": [-3.0 * f64::from(k), 0], "goal": [-3.0 * f64::from(k), 100],
               "premovement_secs": secs(f64::from(k))})
    };
    (0..20).map(person).collect()
}

#[test]
fn a_front_of_premovement_times_has_their_speed() {
    let summary = measured(json!({
        "duration_secs": 60, "profile": "sph", "agents": people(|k| 2.0 + 3.0 * k / 1.2),
        "measurements": [{"front": {"direction": [-2, 0], "from_secs": 1}},
                         {"front": {"name": "near", "direction": [-1, 0], "region": [[-30, -1], [1, 1]]}},
                         {"front": {"name": "early", "direction": [-1, 0], "until_secs": 2}}],
    }));
    let metric = |name: &str| summary.metric(name).unwrap();
    for name in [
        "front_speed_m_per_s",
        "near_speed_m_per_s",
        "front_speed_in_space_m_per_s",
    ] {
        let speed = metric(name);
        assert!((speed - 1.2).abs() < 0.01, "{name}: {speed}");
    }
    assert_eq!(
        (metric("front_agents"), metric("near_agents")),
        (20.0, 11.0)
    );
    assert_eq!(
        (metric("front_reach_m"), metric("near_reach_m")),
        (57.0, 30.0)
    );
    assert_eq!(metric("early_agents"), 0.0);
    assert_eq!(summary.metric("early_speed_m_per_s"), None);
    let data: FrontData = summary.data("front").unwrap();
    // A quarter of the preferred speed, with the relaxation time of 0.5 s: 0.14 s after the start.
    for of in &data.people {
        let off = of.secs.unwrap() - (2.0 + of.place / 1.2);
        assert!((0.1..0.25).contains(&off), "{of:?}");
    }
}

#[test]
fn wrong_keys_are_refused() {
    for (keys, said) in [
        (
            json!({"direction": [0, 0]}),
            "f.json: measurements[0].front.direction: must not be [0, 0]",
        ),
        (
            json!({"from_secs": 5, "until_secs": 5}),
            "f.json: measurements[0].front.until_secs: must be above `from_secs`, 5, not 5",
        ),
    ] {
        let document = json!({"measurements": [{"front": keys}]});
        assert_eq!(scenario(&document, &[]).unwrap_err(), said);
    }
}
