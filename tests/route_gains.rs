//! How much faster crowds leave random floors by the quickest ways than by the shortest.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use serde_json::{Value, json};

use crate::common::bounded::config;
use crate::common::floors::Plan;
use crate::common::simulated::{go_on, scenario};

/// A random plan of rooms with doors, an exit of 1.6 m at one end, and a crowd at the other.
fn random_floor(rng: &mut ChaCha8Rng) -> Value {
    let plan = Plan::drawn(rng);
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| Vector::from(plan.rings[0][k]));
    let [middle, half] = [0.5 * (b + c), 0.8 * (c - b).normalize()];
    let exit = [middle - half, middle + half].map(<[f64; 2]>::from);
    let area = [a, a + 0.3 * (b - a), d + 0.3 * (c - d), d].map(<[f64; 2]>::from);
    json!({
        "duration_secs": 240, "profile": "walk+sph", "walkable_area": [plan.rings],
        "exits": [{"name": "end", "line": exit}], "crowds": [{"area": area, "number": 40}],
        "stop": {"when_empty": true},
    })
}

/// The mean time over five seeds by which 95 % have left, and its variance; `None` if the floor is refused or some do
/// not leave.
fn mean_time(document: &Value) -> Option<[f64; 2]> {
    let times = (1..6).map(|seed| {
        let mut simulation =
            Simulation::new(scenario(document, &[&format!("seed={seed}")]).ok()?.scene).ok()?;
        let left = |simulation: &Simulation| simulation.outcome().arrivals.len();
        while left(&simulation) < 38 && simulation.frame().clock.time() < 240.0 {
            let until = simulation.frame().clock.time() + 1.0;
            go_on(&mut simulation, until);
        }
        let arrivals = &simulation.outcome().arrivals;
        arrivals.get(37).map(|arrival| arrival.time)
    });
    let times: Option<Vec<f64>> = times.collect();
    let times = times?;
    let mean = times.iter().sum::<f64>() / 5.0;
    let squares = times.iter().map(|time| (time - mean).powi(2));
    Some([mean, squares.sum::<f64>() / 4.0 / 5.0])
}

/// 501 floors and their gains: `BAD_INPUT_TIMES=167 cargo test --release --test engine -- --nocapture random_floors`.
#[test]
fn on_random_floors_the_quickest_ways_are_not_slower() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut gains: Vec<f64> = Vec::new();
    let floors = config(3).cases as usize;
    // Floors that are more than 3 % slower, beyond three standard errors.
    let mut slower = 0;
    while gains.len() < floors {
        let mut document = random_floor(&mut rng);
        let shortest = mean_time(&document);
        document["route_choice"] = json!("quickest");
        let (Some([shortest, a]), Some([quickest, b])) = (shortest, mean_time(&document)) else {
            continue;
        };
        let gain = 1.0 - quickest / shortest;
        let error = (a + b).sqrt() / shortest;
        println!(
            "floor {}: {shortest:.2} s, {quickest:.2} s, gain {:.1} ± {:.1} %",
            gains.len(),
            100.0 * gain,
            100.0 * error
        );
        slower += usize::from(gain + 3.0 * error < -0.03);
        gains.push(gain);
    }
    gains.sort_by(f64::total_cmp);
    let at = |part: f64| 100.0 * gains[(part * (gains.len() - 1) as f64).round() as usize];
    let spread = [0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0].map(at);
    println!("gains: {spread:?} %");
    assert!(slower <= floors / 100, "{slower} floors are slower");
    assert!(gains.iter().sum::<f64>() > 0.0);
}
