//! The agents that act on a cluster, side by side.

use std::ops::Range;

use super::SocialForce;
use super::around::Around;
use super::cutoff::Cutoff;
use super::sum::{Feeling, Pairs};
use crate::neighbors::Run;
use crate::pairs::prelude::*;
use crate::pairs::{
    Bodies, LANES, Lanes, Real, Simd, first_lanes, load, seen_from, splat, spread, store,
};

/// The agents j that may act on agents of one cluster, in their order, padded by [`LANES`] entries. Copying an agent
/// takes far less time than one pair.
#[derive(Default)]
pub struct Near<R: Real> {
    pub(super) x: Vec<R::Coordinate>,
    pub(super) y: Vec<R::Coordinate>,
    pub(super) velocity_x: Vec<R>,
    pub(super) velocity_y: Vec<R>,
    /// Agents seen across the same number of periods.
    pub(super) parts: Vec<Part>,
}

/// Agents up to `end` from the end of the previous part, seen across a number of periods.
pub struct Part {
    pub end: usize,
    pub laps: i32,
}

impl<R: Real> Near<R> {
    /// Replaces the agents by those among `runs` that may act on `agents`, which are one cluster.
    #[inline(always)]
    pub fn take<S: Simd>(
        &mut self,
        simd: S,
        (radius, cutoff): (f64, Option<&Cutoff<R, S>>),
        bodies: &Bodies<R>,
        (agents, runs): (Range<usize>, &[Run]),
    ) {
        let most = runs.iter().map(|run| run.agents.len()).sum::<usize>() + LANES;
        grow(&mut self.x, most);
        grow(&mut self.y, most);
        grow(&mut self.velocity_x, most);
        grow(&mut self.velocity_y, most);
        self.parts.clear();
        let around = Around::new(simd, radius, cutoff, bodies, agents);
        let mut end = 0;
        for run in runs {
            end = self.take_run(simd, bodies, (run, &around), end);
            match self.parts.last_mut() {
                Some(part) if part.laps == run.laps => part.end = end,
                _ => self.parts.push(Part {
                    end,
                    laps: run.laps,
                }),
            }
        }
    }

    /// Appends agents of a run to the first `count` agents, and returns their new number.
    #[inline(always)]
    fn take_run<S: Simd>(
        &mut self,
        simd: S,
        bodies: &Bodies<R>,
        (run, around): (&Run, &Around<R, S>),
        mut count: usize,
    ) -> usize {
        let len = run.agents.len();
        let padded = run.indices().start..run.indices().start + len + LANES;
        let (x, y) = (&bodies.x[padded.clone()], &bodies.y[padded.clone()]);
        let velocity_x = &bodies.velocity_x[padded.clone()];
        let velocity_y = &bodies.velocity_y[padded];
        let room = count + len + LANES;
        let (x_out, y_out) = (&mut self.x[..room], &mut self.y[..room]);
        let velocity_x_out = &mut self.velocity_x[..room];
        let velocity_y_out = &mut self.velocity_y[..room];
        let origin = seen_from(simd, bodies, around.origin, run.laps);
        for j in (0..len).step_by(LANES) {
            let (x, y) = (R::places(simd, &x[j..]), R::places(simd, &y[j..]));
            let (vx, vy) = (load(simd, velocity_x, j), load(simd, velocity_y, j));
            let from = [R::between(x, origin[0]), R::between(y, origin[1])];
            let counts = around.counts(simd, from, [vx, vy]);
            let bits = counts.to_bitmask() & first_lanes(len - j);
            if bits == 0 {
                continue;
            }
            let here = count..count + LANES;
            R::store_kept(x, counts, &mut x_out[here.clone()]);
            R::store_kept(y, counts, &mut y_out[here.clone()]);
            vx.compress(counts)
                .store_slice(&mut velocity_x_out[here.clone()]);
            vy.compress(counts).store_slice(&mut velocity_y_out[here]);
            count += bits.count_ones() as usize;
        }
        count
    }

    /// The sums of Eq. 18 over these agents, for the agents of the cluster that begins with `start`.
    #[inline(always)]
    pub fn sums<S: Simd>(
        &self,
        simd: S,
        social: &SocialForce,
        bodies: &Bodies<R>,
        start: usize,
    ) -> [[f64; LANES]; 2] {
        let vx = load(simd, &bodies.velocity_x, start);
        let vy = load(simd, &bodies.velocity_y, start);
        let feeling = Feeling::new(simd, social, bodies.unit, [vx, vy]);
        let x = R::places(simd, &bodies.x[start..]);
        let y = R::places(simd, &bodies.y[start..]);
        let mut sum = [splat::<R, S>(simd, 0.0); 2];
        let mut from = 0;
        for part in &self.parts {
            let others = from..part.end;
            let pairs = EachWithAll {
                at: seen_from(simd, bodies, [x, y], part.laps),
                x: &self.x[others.clone()],
                y: &self.y[others.clone()],
                velocity_x: &self.velocity_x[others.clone()],
                velocity_y: &self.velocity_y[others],
            };
            feeling.add(simd, &pairs, &mut sum);
            from = part.end;
        }
        [store::<R, S>(sum[0]), store::<R, S>(sum[1])]
    }
}

/// Pairs of one agent j with eight agents i at a time.
struct EachWithAll<'a, R: Real, S: Simd> {
    at: [R::Places<S>; 2],
    x: &'a [R::Coordinate],
    y: &'a [R::Coordinate],
    velocity_x: &'a [R],
    velocity_y: &'a [R],
}

impl<R: Real, S: Simd> Pairs<R, S> for EachWithAll<'_, R, S> {
    #[inline(always)]
    fn steps(&self) -> usize {
        self.x.len()
    }

    #[inline(always)]
    fn pairs(&self, simd: S, j: usize) -> [[Lanes<R, S>; 2]; 2] {
        let dx = R::differences(simd, self.at[0], self.x[j]);
        let dy = R::differences(simd, self.at[1], self.y[j]);
        let vx = spread(simd, self.velocity_x[j]);
        let vy = spread(simd, self.velocity_y[j]);
        [[dx, dy], [vx, vy]]
    }
}

/// Makes room for `count` entries.
pub fn grow<T: Copy + Default>(column: &mut Vec<T>, count: usize) {
    if column.len() < count {
        column.resize(count, T::default());
    }
}
