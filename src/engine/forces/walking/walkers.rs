//! Agents that look ahead, eight at a time.

use std::ops::Range;

use crate::frame::Frame;
use crate::math::Vector;
use crate::neighbors::Run;
use crate::pairs::prelude::*;
use crate::pairs::{Bodies, LANES, Lanes, Real, Simd, lanes_from, splat, spread, store};

/// More than the rounding error of d² in single precision, relative to it.
pub(super) const ROUNDING: f64 = 1.0 + 1e-5;

/// The rectangle ahead of an agent in which it looks for others.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct View {
    /// Its length for an agent that stands, meters.
    pub length: f64,
    /// The additional length per preferred speed and factor of the time gap, seconds.
    pub time: f64,
    /// The additional length per preferred speed, seconds.
    pub more_time: f64,
    /// How far it reaches behind the agent, meters.
    pub behind: f64,
    /// Its width to each side, meters.
    pub aside: f64,
    /// The additional width to each side per length.
    pub spread: f64,
}

/// How all agents move and want to walk.
#[derive(Clone, Copy)]
pub(super) struct Motions<'a, R: Real> {
    /// v_j, m/s.
    velocity: [&'a [R]; 2],
    /// ê_j.
    heading: [&'a [R]; 2],
}

impl<'a, R: Real> Motions<'a, R> {
    #[inline(always)]
    pub fn of(bodies: &'a Bodies<R>) -> Self {
        Self {
            velocity: [&bodies.velocity_x, &bodies.velocity_y],
            heading: [&bodies.heading_x, &bodies.heading_y],
        }
    }

    /// Those of a run of agents.
    #[inline(always)]
    pub fn run(&self, run: Range<usize>) -> Self {
        let [[v_x, v_y], [e_x, e_y]] = [self.velocity, self.heading];
        Self {
            velocity: [&v_x[run.clone()], &v_y[run.clone()]],
            heading: [&e_x[run.clone()], &e_y[run]],
        }
    }

    /// v_j of one agent, in all lanes.
    #[inline(always)]
    pub fn velocity<S: Simd>(&self, simd: S, j: usize) -> [Lanes<R, S>; 2] {
        let [x, y] = self.velocity;
        [spread(simd, x[j]), spread(simd, y[j])]
    }

    /// ê_j of one agent, in all lanes.
    #[inline(always)]
    pub fn heading<S: Simd>(&self, simd: S, j: usize) -> [Lanes<R, S>; 2] {
        let [x, y] = self.heading;
        [spread(simd, x[j]), spread(simd, y[j])]
    }
}

/// Eight agents that look ahead.
pub(super) struct Walkers<R: Real, S: Simd> {
    /// The first of them.
    pub start: usize,
    /// Their number, at most eight.
    count: usize,
    /// −ê_i, zero without preferred velocity.
    pub backwards: [Lanes<R, S>; 2],
    /// s_i: their preferred speeds, m/s.
    pub speed: Lanes<R, S>,
    /// The factors of their time gaps.
    pub gap: Lanes<R, S>,
}

impl<R: Real, S: Simd> Walkers<R, S> {
    #[inline(always)]
    pub fn new(simd: S, start: usize, wishes: &[Vector], gaps: &[f64]) -> Self {
        let mut wish = [[0.0; LANES]; 2];
        for (k, of) in wishes.iter().enumerate() {
            wish[0][k] = of.x;
            wish[1][k] = of.y;
        }
        let zero = splat::<R, S>(simd, 0.0);
        let x = lanes_from::<R, S>(simd, &wish[0]);
        let y = lanes_from::<R, S>(simd, &wish[1]);
        let speed = y.mul_add_precise(y, x * x).sqrt();
        let walks = speed.simd_gt(zero);
        let minus_inverse = walks.select(splat::<R, S>(simd, -1.0) / speed, zero);
        Self {
            start,
            count: wishes.len(),
            backwards: [x * minus_inverse, y * minus_inverse],
            speed,
            gap: lanes_from::<R, S>(simd, gaps),
        }
    }

    /// They look along other headings: turned by the angles of these unit vectors.
    #[inline(always)]
    pub fn turned(self, simd: S, by: &[Vector; LANES]) -> Self {
        let cosine = lanes_from::<R, S>(simd, &by.map(|by| by.x));
        let sine = lanes_from::<R, S>(simd, &by.map(|by| by.y));
        let [x, y] = self.backwards;
        Self {
            backwards: [x * cosine - y * sine, y * cosine + x * sine],
            ..self
        }
    }

    /// Sets `runs` to the agents in this view, and some out of it, nearest rows first: the nearer the first, the fewer
    /// of the others count.
    #[inline(always)]
    pub fn look(
        &self,
        simd: S,
        bodies: &Bodies<R>,
        view: &View,
        (frame, runs): (&Frame, &mut Vec<Run>),
    ) {
        let positions = &frame.agents.position;
        let way = self.area(simd, bodies, view);
        let area = way.map(|way| positions[self.start] + way);
        let agents = self.start..self.start + self.count;
        frame.neighbors.inside(agents, area, positions, runs);
        let own = self.start as u32;
        runs.sort_unstable_by_key(|run| {
            let before = own.saturating_sub(run.agents.end);
            before.max(run.agents.start.saturating_sub(own))
        });
    }

    /// The lower left and the upper right corner of a rectangle with all places that they look at, meters from the
    /// first of them.
    #[inline(always)]
    fn area(&self, simd: S, bodies: &Bodies<R>, view: &View) -> [Vector; 2] {
        let [back_x, back_y] = self.backwards;
        let [low_x, high_x] = self.span(simd, (&bodies.x, bodies.unit), view, [back_x, back_y]);
        let [low_y, high_y] = self.span(simd, (&bodies.y, bodies.unit), view, [back_y, back_x]);
        [Vector::new(low_x, low_y), Vector::new(high_x, high_y)]
    }

    /// The rectangle along one axis; the vectors backwards have these components along it and across.
    #[inline(always)]
    fn span(
        &self,
        simd: S,
        (places, unit): (&[R::Coordinate], f64),
        view: &View,
        [backwards, across]: [Lanes<R, S>; 2],
    ) -> [f64; 2] {
        let zero = splat::<R, S>(simd, 0.0);
        let at = R::places(simd, &places[self.start..]);
        let at = R::differences(simd, at, places[self.start]) * splat::<R, S>(simd, unit);
        let (time, length) = (
            splat::<R, S>(simd, -view.time),
            splat::<R, S>(simd, -view.length),
        );
        let time = self
            .gap
            .mul_add_precise(time, splat::<R, S>(simd, -view.more_time));
        let reach = self.speed.mul_add_precise(time, length);
        let front = backwards * reach;
        let back = backwards * splat::<R, S>(simd, view.behind);
        let (aside, spread) = (
            splat::<R, S>(simd, view.aside),
            splat::<R, S>(simd, -view.spread),
        );
        let side = across.abs() * reach.mul_add_precise(spread, aside);
        let walks = self.speed.simd_gt(zero);
        let low = walks.select(at + front.min(back) - side, zero);
        let high = walks.select(at + front.max(back) + side, zero);
        let (low, high) = (store::<R, S>(low), store::<R, S>(high));
        [fold(low, f64::min), fold(high, f64::max)]
    }
}

/// The least or the greatest of eight numbers.
#[inline(always)]
fn fold(numbers: [f64; LANES], of_two: impl Fn(f64, f64) -> f64) -> f64 {
    let four = [0, 1, 2, 3].map(|k| of_two(numbers[k], numbers[k + 4]));
    of_two(of_two(four[0], four[1]), of_two(four[2], four[3]))
}
