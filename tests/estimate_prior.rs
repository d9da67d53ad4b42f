//! What is known about a result before its first run: it saves runs, and wrong knowledge does no harm.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::lab::estimate::{
    Goal, Known, Means, Offer, Prior, Series, Tolerance, first_round, further, range,
};
use sandbox::lab::model::Quantity;

/// Finished rows of a study with this spread, and these errors of the paper's step.
fn rows(spread: f64, errors: &[f64]) -> Vec<Known> {
    let row = |&error: &f64| Known {
        scene: "room".into(),
        profile: "sph".into(),
        result: "flow_per_s".into(),
        quantity: Quantity::Flow,
        spread,
        degrees: 20.0,
        error,
        error_std: Some(0.3),
    };
    errors.iter().map(row).collect()
}

fn prior(spread: f64, errors: &[f64]) -> Prior {
    of_flows(&rows(spread, errors), None)
}

fn of_flows(rows: &[Known], but: Option<&str>) -> Prior {
    Prior::of(["sph", "flow_per_s"], Some(Quantity::Flow), rows, but)
}

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (rng.random(), rng.random());
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

const STEPS: [f64; 6] = [0.0015625, 0.003125, 0.00625, 0.0125, 0.025, 0.05];

/// These numbers of runs at each step, whose values are around 100, with an error of the paper's step.
fn drawn(counts: &[usize], spread: f64, error: f64, rng: &mut ChaCha8Rng) -> Series {
    let values = STEPS.iter().zip(counts).map(|(step, &count)| {
        let value = |rng: &mut ChaCha8Rng| 100.0 + error * step / 0.02 + spread * normal(rng);
        (0..count).map(|_| Some(value(rng))).collect()
    });
    Series {
        steps: STEPS.to_vec(),
        values: values.collect(),
    }
}

fn offers(counts: &[usize]) -> Vec<Offer> {
    let offer = |(&step, &runs): (&f64, &usize)| Offer {
        step,
        secs: 0.1 / step,
        runs,
    };
    STEPS.iter().zip(counts).map(offer).collect()
}

#[test]
fn the_shares_of_sizes_follow_the_errors_of_similar_results() {
    let small = prior(0.01, &[0.05, -0.1, 0.0, 0.1, -0.05, 0.1]).shares;
    let large = prior(0.01, &[3.0, -4.0, 2.5, 3.5, -3.0, 4.0]).shares;
    for shares in [small, large, Prior::NONE.shares] {
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!(shares.iter().all(|share| *share > 0.0), "{shares:?}");
    }
    let size = |shares: [f64; 5], of: std::ops::Range<usize>| shares[of].iter().sum::<f64>();
    assert!(size(small, 0..2) > size(large, 0..2));
    assert!(size(large, 3..5) > 2.0 * size(small, 3..5));
}

#[test]
fn the_scene_itself_can_be_left_out() {
    let all = of_flows(&[], None);
    let without = of_flows(&[], Some("gap"));
    assert!(0 < without.similar && without.similar < all.similar);
    let unknown = Prior::of(["sph", "agents_through_walls"], None, &[], None);
    assert_eq!(unknown, Prior::NONE);
}

#[test]
fn a_known_spread_narrows_intervals_and_a_contradicted_one_does_not() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let series = drawn(&[0, 0, 0, 0, 4, 0], 1.0, 0.0, &mut rng);
    let alone = series.means(&Prior::NONE).unwrap();
    let errors = [0.1, -0.1, 0.0];
    let right = series.means(&prior(0.01, &errors)).unwrap();
    assert!(right.width(0.95) < 0.9 * alone.width(0.95));
    let wrong = series.means(&prior(1e-4, &errors)).unwrap();
    assert!((wrong.variance / alone.variance - 1.0).abs() < 0.35);
    assert!(wrong.width(0.95) > 0.8 * alone.width(0.95));
}

#[test]
fn a_plan_for_a_scene_that_nobody_has_run_allows_five_times_the_runs() {
    let rows = prior(0.02, &[0.1, -0.1, 0.0]);
    let goal = Goal::expected(WANTED, &rows).unwrap();
    let offers = offers(&[0; 6]);
    let first = first_round(std::slice::from_ref(&goal), &offers, 0.95).unwrap();
    let asked = |most| range(std::slice::from_ref(&goal), &offers, &first, (0.95, most));
    let [low, high] = asked(100_000);
    assert!(
        (20..=high / 5).contains(&low) && high % 5 == 0,
        "{low} {high}"
    );
    assert_eq!(asked(50), [low, 50]);
    // Runs of the scene say what its step does.
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let series = drawn(&[0, 0, 10, 0, 10, 0], 2.0, 0.0, &mut rng);
    let seen = Goal::new(WANTED, series.means(&rows).unwrap());
    let [_, known] = range(&[seen], &offers, &first, (0.95, 100_000));
    assert!(known < high, "{known} {high}");
}

/// The number of runs at each step.
const RUNS: usize = 200;
/// The error asked for.
const WANTED: Tolerance = Tolerance::Relative(0.015);

/// An estimate that begins with some runs of `all`, until its error is as small as asked for, or the runs at a step are
/// used up.
fn estimated(prior: &Prior, all: &Series, first: &[usize]) -> (Means, usize) {
    let mut counts = first.to_vec();
    loop {
        let values = all.values.iter().zip(&counts);
        let series = Series {
            steps: STEPS.to_vec(),
            values: values.map(|(v, &count)| v[..count].to_vec()).collect(),
        };
        let means = series.means(prior).unwrap();
        let goal = Goal::new(WANTED, means.clone());
        let more = further(&[goal], &offers(&counts), first, 0.95);
        let asked = counts.iter().zip(more.iter().flatten());
        let asked: Vec<usize> = asked.map(|(all, more)| all + more).collect();
        if asked.is_empty() || asked.iter().any(|&count| count > RUNS) {
            return (means, counts.iter().sum());
        }
        counts = asked;
    }
}

/// Rows with a spread of 2 % and small errors are known; the truth has these values.
fn covered([spread, error]: [f64; 2], prior: &Prior) -> [f64; 2] {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let goal = Goal::expected(WANTED, prior).unwrap();
    let first = first_round(&[goal], &offers(&[0; 6]), 0.95).unwrap();
    let draws = 200;
    let (mut held, mut runs) = (0, 0);
    for _ in 0..draws {
        let all = drawn(&[RUNS; 6], spread, error, &mut rng);
        let (means, count) = estimated(prior, &all, &first);
        let reached = means.reached(0.95);
        held += usize::from((reached.value - 100.0).abs() <= reached.error);
        runs += count;
    }
    [held, runs].map(|sum| sum as f64 / f64::from(draws))
}

#[test]
fn intervals_hold_with_right_and_with_wrong_knowledge() {
    let known = prior(0.02, &[0.1, -0.2, 0.0, 0.1, -0.1, 0.2]);
    // As known; a spread twice and half as large; an error of one and a half spreads.
    for truth in [[2.0, 0.2], [4.0, 0.2], [1.0, 0.1], [2.0, 3.0]] {
        let [held, runs] = covered(truth, &known);
        // Three standard deviations of the count below 0.93.
        assert!(held > 0.875, "{truth:?}: {held}, {runs} runs");
    }
}

#[test]
fn knowledge_saves_runs() {
    let known = prior(0.02, &[0.1, -0.2, 0.0, 0.1, -0.1, 0.2]);
    let [_, with] = covered([2.0, 0.0], &known);
    let [_, without] = covered([2.0, 0.0], &of_flows(&[], None));
    assert!(with < without, "{with} {without}");
}

#[test]
fn the_first_round_is_at_one_step_if_spreads_are_known() {
    let known = prior(0.02, &[0.1, -0.1]);
    let goal = Goal::expected(Tolerance::Relative(0.02), &known).unwrap();
    let round = first_round(&[goal], &offers(&[0; 6]), 0.95).unwrap();
    assert_eq!(round.iter().filter(|runs| **runs > 0).count(), 1);
    for (prior, tolerance) in [
        (&known, Tolerance::Absolute(0.02)),
        (&Prior::NONE, Tolerance::Relative(0.02)),
    ] {
        assert!(Goal::expected(tolerance, prior).is_none());
    }
}
