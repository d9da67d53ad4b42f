//! The cost of one evaluation.

use std::hint::black_box;
use std::time::Instant;

use super::{Case, Method, Prepared, SUPPORT_RADIUS};
use crate::analysis::statistics::Range;

/// The number of measurements.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Turns of all methods.
    pub turns: usize,
    /// Passes of a method along the path in each turn.
    pub passes: usize,
}

/// A prepared method, and the time of its preparation, milliseconds.
pub fn prepared(method: Method, case: &Case, effort: Effort) -> (Prepared<'_>, f64) {
    let turn = || {
        let start = Instant::now();
        black_box(method.prepare(case));
        1e3 * start.elapsed().as_secs_f64()
    };
    let times: Vec<f64> = (0..effort.turns).map(|_| turn()).collect();
    (method.prepare(case), Range::of(&times).median)
}

/// Nanoseconds per place for each method and turn; the methods take turns.
pub fn evaluations(methods: &mut [Prepared], case: &Case, effort: Effort) -> Vec<Vec<f64>> {
    let mut times = vec![Vec::with_capacity(effort.turns); methods.len()];
    for _ in 0..effort.turns {
        for (method, times) in methods.iter_mut().zip(&mut times) {
            times.push(ns_per_place(case, effort.passes, |place| {
                black_box(method.integrals(black_box(case.places[place].position)));
            }));
        }
    }
    times
}

/// Nanoseconds to find the walls within reach of a place, for each turn.
pub fn searches(case: &Case, effort: Effort) -> Vec<f64> {
    let mut near = Vec::new();
    let mut turn = || {
        ns_per_place(case, effort.passes, |place| {
            near.clear();
            let r_i = black_box(case.places[place].position);
            case.walls.near(r_i, SUPPORT_RADIUS, &mut near);
            black_box(&near);
        })
    };
    (0..effort.turns).map(|_| turn()).collect()
}

fn ns_per_place(case: &Case, passes: usize, mut visit: impl FnMut(usize)) -> f64 {
    let start = Instant::now();
    for _ in 0..passes {
        (0..case.places.len()).for_each(&mut visit);
    }
    1e9 * start.elapsed().as_secs_f64() / (passes * case.places.len()) as f64
}
