//! Results with the errors asked for: the limit of fine steps against integrals, and intervals against drawn data.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::lab::estimate::{
    Goal, Level, Limit, Means, Offer, Prior, Series, Tolerance, Wanted, further, pilot, predicted,
};

/// Orders and sizes of errors with their weights in percent, as docs/reference/estimates.md gives them.
const ORDERS: [(f64, u32); 9] = [
    (0.4, 4),
    (0.5, 7),
    (0.63, 11),
    (0.79, 16),
    (1.0, 22),
    (1.26, 16),
    (1.58, 12),
    (2.0, 8),
    (2.5, 4),
];
const SIZES: [(f64, u32); 5] = [(0.1, 25), (0.3, 35), (1.0, 20), (3.0, 13), (10.0, 7)];

/// One of these, drawn by its weight.
fn drawn(of: &[(f64, u32)], rng: &mut ChaCha8Rng) -> f64 {
    let mut number = rng.random_range(0..100);
    for (value, weight) in of {
        if number < *weight {
            return *value;
        }
        number -= weight;
    }
    unreachable!("the weights add up to 100")
}

fn levels(of: &[(f64, usize, f64)]) -> Vec<Level> {
    let level = |&(step, runs, mean): &(f64, usize, f64)| Level { step, runs, mean };
    of.iter().map(level).collect()
}

/// Mean and variance of the limit by integration over the error β: given β, the limit is normal around the weighted
/// mean of the differences. `apart` adds the case that the last level is too long.
fn by_quadrature(levels: &[Level], sigma: f64, apart: bool) -> [f64; 2] {
    let mut sums = [0.0; 3];
    let mut add = |used: &[Level], factor: f64| {
        for (order, likely) in ORDERS {
            for (size, weight) in SIZES {
                let weight = f64::from(likely * weight);
                let (steps, size) = (4000, size * sigma);
                for k in 0..=steps {
                    let beta = size * 12.0 * (f64::from(k) / f64::from(steps) - 0.5) * 2.0;
                    let x = |level: &Level| (level.step / 0.02).powf(order);
                    let n: f64 = used.iter().map(|l| l.runs as f64).sum();
                    let mean = used
                        .iter()
                        .map(|l| l.runs as f64 * (l.mean - beta * x(l)))
                        .sum::<f64>()
                        / n;
                    let rest: f64 = used
                        .iter()
                        .map(|l| l.runs as f64 * (l.mean - beta * x(l) - mean).powi(2))
                        .sum();
                    // The integral over the limit, without factors that all cases share.
                    let spread = used
                        .iter()
                        .map(|l| (l.runs as f64 / (std::f64::consts::TAU * sigma * sigma)).sqrt())
                        .product::<f64>()
                        * (sigma * sigma / n).sqrt();
                    let likely = spread * (-0.5 * rest / (sigma * sigma)).exp();
                    let prior = (-0.5 * (beta / size).powi(2)).exp();
                    let w = factor * weight * likely * prior / f64::from(steps) * 24.0;
                    let variance = sigma * sigma / n;
                    sums[0] += w;
                    sums[1] += w * mean;
                    sums[2] += w * (variance + mean * mean);
                }
            }
        }
    };
    match apart {
        true => {
            add(levels, 0.9);
            add(&levels[..levels.len() - 1], 0.1 / (20.0 * sigma));
        }
        false => add(levels, 1.0),
    }
    let mean = sums[1] / sums[0];
    [mean, sums[2] / sums[0] - mean * mean]
}

#[test]
fn the_limit_agrees_with_integrals_over_errors_orders_and_sizes() {
    let two = levels(&[(0.01, 7, 0.3), (0.02, 5, 0.9)]);
    let three = levels(&[(0.005, 4, -0.2), (0.01, 9, 0.5), (0.025, 6, 1.1)]);
    let far = levels(&[(0.01, 8, 0.1), (0.02, 8, 0.4), (0.04, 6, 9.0)]);
    for (levels, apart) in [(two, false), (three, true), (far, true)] {
        let sigma = 0.8;
        let limit = Limit::of(&levels, sigma * sigma, &Prior::NONE.shares);
        let [mean, variance] = by_quadrature(&levels, sigma, apart);
        assert!((limit.value - mean).abs() < 1e-6, "{} {mean}", limit.value);
        let unmodeled = 0.125 * limit.error_at(levels[0].step);
        let expected = variance + unmodeled.powi(2);
        assert!(
            (limit.variance - expected).abs() < 1e-6,
            "{} {expected}",
            limit.variance
        );
    }
}

#[test]
fn the_limit_moves_and_scales_with_the_values() {
    let at = |factor: f64, off: f64| {
        let of = [(0.01, 7, 0.3), (0.02, 5, 0.9)].map(|(h, n, m)| (h, n, factor * m + off));
        Limit::of(&levels(&of), (factor * 0.5).powi(2), &Prior::NONE.shares)
    };
    let (one, other) = (at(1.0, 0.0), at(40.0, 7.0));
    assert!((other.value - (40.0 * one.value + 7.0)).abs() < 1e-9);
    for (one, other) in [
        (one.variance, other.variance),
        (one.from_seeds, other.from_seeds),
    ] {
        assert!((other / one - 1600.0).abs() < 1e-6);
    }
    assert!(0.0 < one.from_seeds && one.from_seeds < one.variance);
}

#[test]
fn many_exact_runs_give_the_limit_of_any_order() {
    for order in [0.5, 1.0, 2.0] {
        let of = [0.0025, 0.005, 0.01, 0.02]
            .map(|step: f64| (step, 1_000_000, 5.0 + 0.3 * (step / 0.02).powf(order)));
        let limit = Limit::of(&levels(&of), 0.01, &Prior::NONE.shares);
        let off = (limit.value - 5.0).abs();
        assert!(
            off < 2.0 * limit.variance.sqrt() && off < 0.02,
            "{order}: {}",
            limit.value
        );
    }
}

/// A value from the normal distribution, by Box and Muller.
fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (rng.random(), rng.random());
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

#[test]
fn intervals_hold_the_limit_of_drawn_data_as_often_as_they_say() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let (draws, mut held) = (4000, [0; 2]);
    for _ in 0..draws {
        let order = drawn(&ORDERS, &mut rng);
        let beta = drawn(&SIZES, &mut rng) * normal(&mut rng);
        let steps = vec![0.0125, 0.025, 0.05];
        let values = steps.iter().map(|step: &f64| {
            let mean = beta * (step / 0.02).powf(order);
            (0..8)
                .map(|_| Some(100.0 + mean + normal(&mut rng)))
                .collect()
        });
        let values = values.collect();
        let means = Series { steps, values }.means(&Prior::NONE).unwrap();
        for (held, confidence) in held.iter_mut().zip([0.8, 0.95]) {
            let reached = means.reached(confidence);
            *held += usize::from((reached.value - 100.0).abs() <= reached.error);
        }
    }
    // Four standard deviations of the counts on either side; the share of the error that no order explains widens, and
    // so does the skewness that 24 normal values seem to have.
    let [eighty, ninety_five] = held.map(|held| held as f64 / f64::from(draws));
    assert!((0.8..0.885).contains(&eighty), "{eighty}");
    assert!((0.945..0.985).contains(&ninety_five), "{ninety_five}");
}

fn means(values: &[(f64, &[f64])]) -> Means {
    let series = Series {
        steps: values.iter().map(|(step, _)| *step).collect(),
        values: values
            .iter()
            .map(|(_, v)| v.iter().copied().map(Some).collect())
            .collect(),
    };
    series.means(&Prior::NONE).unwrap()
}

fn offers(runs: [usize; 3]) -> Vec<Offer> {
    let offer = |(step, runs)| Offer {
        step,
        secs: 0.1 / step,
        runs,
    };
    [0.0125, 0.025, 0.05]
        .into_iter()
        .zip(runs)
        .map(offer)
        .collect()
}

#[test]
fn no_runs_are_added_once_the_error_is_small_enough() {
    let means = means(&[
        (0.025, &[9.0, 11.0, 10.0, 10.5, 9.5, 10.0]),
        (0.05, &[10.0, 9.2, 10.8, 10.1, 9.9, 10.0]),
    ]);
    let reached = means.reached(0.95);
    // The 30 % quantile of chi-squared with 10 degrees of freedom is 7.267.
    let caution = (10.0_f64 / 7.267).sqrt();
    for (factor, is_done) in [(1.01 * caution, true), (0.99 * caution, false)] {
        let tolerance = Tolerance::Absolute(factor * reached.error);
        let goal = Goal::new(tolerance, means.clone());
        let further = further(&[goal], &offers([6, 7, 7]), &[0, 5, 5], 0.95);
        assert_eq!(further.is_none(), is_done, "{further:?}");
    }
}

#[test]
fn an_estimate_ends_with_twenty_runs_some_of_them_at_a_finer_step_than_it_began_with() {
    let means = means(&[(0.025, &[9.0, 11.0, 10.0]), (0.05, &[10.0, 9.2, 10.8])]);
    let goal = Goal::new(Tolerance::Relative(0.9), means);
    let more = |runs: [usize; 3], first: [usize; 3]| {
        further(std::slice::from_ref(&goal), &offers(runs), &first, 0.95)
    };
    assert_eq!(more([0, 6, 5], [0, 5, 5]), Some(vec![6, 3, 0]));
    assert_eq!(more([0, 15, 15], [0, 5, 5]), Some(vec![6, 0, 0]));
    assert_eq!(more([2, 15, 15], [0, 5, 5]), Some(vec![4, 0, 0]));
    assert_eq!(more([6, 7, 7], [0, 5, 5]), None);
    // No finer step is on offer.
    assert_eq!(more([5, 15, 0], [5, 5, 0]), None);
    assert_eq!(more([5, 10, 0], [5, 5, 0]), Some(vec![0, 5, 0]));
}

#[test]
fn smaller_errors_are_expected_to_need_more_runs() {
    let means = means(&[
        (0.025, &[9.0, 11.0, 10.0, 10.5, 9.5]),
        (0.05, &[10.0, 9.2, 10.8, 10.1, 9.9]),
    ]);
    let runs = |part: f64| -> usize {
        let tolerance = Tolerance::Relative(part);
        let goal = Goal::new(tolerance, means.clone());
        let offers = offers([0, 0, 0]);
        let first = pilot(&offers, 1);
        predicted(&[goal], &offers, first, (0.95, 100_000))
            .0
            .iter()
            .sum()
    };
    let counts = [0.2, 0.1, 0.05, 0.02].map(runs);
    assert_eq!(counts[0], 20, "the fewest runs are enough");
    assert!(
        counts.is_sorted() && counts[3] > 4 * counts[1],
        "{counts:?}"
    );
}

#[test]
fn errors_are_read_as_parts_and_as_numbers() {
    let read = |text: &str| text.parse::<Wanted>();
    assert_eq!(read("flow=2%").unwrap().error, Tolerance::Relative(0.02));
    assert_eq!(
        read(" flow = 0.05").unwrap(),
        Wanted {
            name: "flow".into(),
            error: Tolerance::Absolute(0.05)
        }
    );
    for wrong in [
        "flow",
        "flow=",
        "flow=x%",
        "flow=0%",
        "flow=-1",
        "flow=inf",
        "flow=NaN%",
    ] {
        assert!(read(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn a_result_that_is_always_zero_is_exact() {
    let series = Series {
        steps: vec![0.01, 0.02],
        values: vec![vec![Some(0.0); 5], vec![Some(0.0); 5]],
    };
    let means = series.means(&Prior::NONE).unwrap();
    let reached = means.reached(0.95);
    assert_eq!(
        [reached.value, reached.error, reached.seeds, reached.step],
        [0.0; 4]
    );
    assert_eq!(means.excess(Tolerance::Relative(0.01), 0.95), 0.0);
}
