//! What one evaluation costs.

use std::hint::black_box;
use std::time::Instant;

use super::{Case, Method, Prepared, SUPPORT_RADIUS};
use crate::lab::bench::Spread;

/// How often is measured.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Turns that all methods take.
    pub turns: usize,
    /// How often a method goes along the path in a turn.
    pub passes: usize,
}

/// A method made ready, and how long that takes, milliseconds.
pub fn prepared(method: Method, case: &Case, effort: Effort) -> (Prepared<'_>, f64) {
    let turn = || {
        let start = Instant::now();
        black_box(method.prepare(case));
        1e3 * start.elapsed().as_secs_f64()
    };
    let times: Vec<f64> = (0..effort.turns).map(|_| turn()).collect();
    (method.prepare(case), Spread::of(&times).median)
}

/// For each method, nanoseconds per place turn by turn; the methods take turns.
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

/// Nanoseconds to find the walls within reach of a place, turn by turn.
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
