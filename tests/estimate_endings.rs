//! When estimates end: after enough runs, also where results are skewed, rare or always the same.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::lab::estimate::{Goal, Offer, Prior, Series, Tolerance, further};

const CONFIDENCE: f64 = 0.95;

/// What an estimate says, and whether its interval holds the mean.
struct Said {
    runs: usize,
    holds: bool,
}

/// The steps on offer, seconds.
const STEPS: [f64; 4] = [0.0025, 0.005, 0.01, 0.02];
/// No estimate here takes more runs.
const MOST: usize = 3000;

/// An estimate of values that have no error of the step.
fn estimated(
    draw: &dyn Fn(&mut ChaCha8Rng) -> f64,
    (mean, error): (f64, f64),
    rng: &mut ChaCha8Rng,
) -> Said {
    let mut values = vec![Vec::new(); STEPS.len()];
    let first = [0, 0, 0, 4];
    let mut more = first.to_vec();
    loop {
        for (values, more) in values.iter_mut().zip(more) {
            values.extend((0..more).map(|_| Some(draw(rng))));
        }
        let series = Series {
            steps: STEPS.to_vec(),
            values: values.clone(),
        };
        let goal = Goal::new(
            Tolerance::Absolute(error),
            series.means(&Prior::NONE).unwrap(),
        );
        let offers = STEPS.iter().zip(&values).map(|(&step, values)| Offer {
            step,
            secs: 0.1 / step,
            runs: values.len(),
        });
        let offers: Vec<Offer> = offers.collect();
        let runs = offers.iter().map(|offer| offer.runs).sum();
        assert!(runs < MOST, "{error}");
        let Some(next) = further(std::slice::from_ref(&goal), &offers, &first, CONFIDENCE) else {
            let reached = goal.reached(CONFIDENCE);
            return Said {
                runs,
                holds: (reached.value - mean).abs() <= reached.error,
            };
        };
        more = next;
    }
}

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (rng.random(), rng.random());
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

fn exponential(rng: &mut ChaCha8Rng) -> f64 {
    -(1.0 - rng.random::<f64>()).ln()
}

/// One of two values: a door that jams or does not.
fn either(rng: &mut ChaCha8Rng) -> f64 {
    f64::from(rng.random::<f64>() < 0.3)
}

/// Zero in half of the runs.
fn half_zero(rng: &mut ChaCha8Rng) -> f64 {
    exponential(rng) * f64::from(rng.random::<bool>())
}

#[test]
fn intervals_of_estimates_that_end_early_hold_as_often_as_others() {
    type Draw = fn(&mut ChaCha8Rng) -> f64;
    let kinds: [(Draw, f64, f64); 4] = [
        (normal, 0.0, 1.0),
        (exponential, 1.0, 1.0),
        (either, 0.3, 0.21_f64.sqrt()),
        (half_zero, 0.5, 0.75_f64.sqrt()),
    ];
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let (repeats, parts) = (100, [1.0, 0.6]);
    let (mut few, mut all) = ([0, 0], [0, 0]);
    for (k, (draw, mean, spread)) in kinds.into_iter().enumerate() {
        let offset = 10.0; // the error of a step is a part of the value
        let drawn = |rng: &mut ChaCha8Rng| offset + draw(rng);
        let mut held = 0;
        for part in parts {
            for _ in 0..repeats {
                let said = estimated(&drawn, (offset + mean, part * spread), &mut rng);
                assert!(said.runs >= 20);
                let holds = usize::from(said.holds);
                held += holds;
                all = [all[0] + holds, all[1] + 1];
                if said.runs < 30 {
                    few = [few[0] + holds, few[1] + 1];
                }
            }
        }
        // Three standard deviations of the count below 92 %; few runs do not know long tails.
        let share = held as f64 / (repeats * parts.len()) as f64;
        assert!(share > 0.862, "kind {k}: {share}");
    }
    let share = |[held, of]: [usize; 2]| held as f64 / of as f64;
    // Steps may have errors, which these do not have: intervals are longer than chance alone asks for.
    assert!(share(all) > 0.94, "{all:?}");
    assert!(few[1] > 50 && share(few) > 0.92, "{few:?}");
}

#[test]
fn a_result_that_is_always_the_same_is_known_after_twenty_runs() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let said = estimated(&|_| 60.0, (60.0, 0.1), &mut rng);
    assert!(said.holds);
    assert_eq!(said.runs, 20);
}

#[test]
fn skewed_results_have_longer_intervals_than_others_with_the_same_spread() {
    let reached = |values: &[f64]| {
        let series = Series {
            steps: vec![0.0025],
            values: vec![values.iter().copied().map(Some).collect()],
        };
        series.means(&Prior::NONE).unwrap().reached(CONFIDENCE)
    };
    // Both have the mean 10 and the variance 1.2.
    let even = [9.0, 11.0, 9.0, 11.0, 9.0, 11.0];
    let skewed: Vec<f64> = [-1.0, -1.0, -1.0, -1.0, -1.0, 5.0]
        .map(|x: f64| 10.0 + x / 5.0_f64.sqrt())
        .into();
    let (even, skewed) = (reached(&even), reached(&skewed));
    assert!((even.value - skewed.value).abs() < 1e-9);
    // G₁ of one value far above five others is √6.
    let ratio = skewed.seeds / even.seeds;
    let expected = 1.0 + 0.7 * 6.0_f64.sqrt() / 6.0_f64.sqrt();
    assert!(
        (ratio / expected - 1.0).abs() < 0.02,
        "{ratio} instead of {expected}"
    );
}
