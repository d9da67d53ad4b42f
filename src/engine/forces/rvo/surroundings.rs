//! The moving discs around an agent.

use std::ops::Range;

use super::discs::{Discs, Eight};
use crate::agents::Agents;
use crate::frame::Frame;
use crate::math::{Vector, greatest};
use crate::pairs::prelude::*;
use crate::pairs::{LANES, Simd, coordinates, f64x8, first_lanes};

/// A moving disc, relative to agent i.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingDisc {
    /// r_j − r_i, meters.
    pub offset: Vector,
    /// v_j, m/s.
    pub velocity: Vector,
    /// D_i + D_j, meters.
    pub reach: f64,
}

/// Upper bounds for all discs around an agent.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limits {
    /// Of D_i + D_j, meters.
    pub longest_reach: f64,
    /// Of the speed, m/s.
    pub highest_speed: f64,
    /// Of the distance of the centers, meters.
    pub farthest: f64,
}

/// The discs around an agent, read from the nearest outward.
pub trait Surroundings {
    /// Bounds for all discs.
    fn limits(&self) -> Limits;

    /// Adds the discs whose centers are at a distance in `squared`, m².
    fn read<S: Simd>(&self, simd: S, squared: Range<f64>, discs: &mut Discs);

    /// The disc of a number.
    fn disc(&self, number: u32) -> MovingDisc;
}

/// The agents around agent i of a frozen frame that are not in contact with it.
pub struct Around<'a> {
    frame: &'a Frame<'a>,
    i: usize,
    /// Agents farther away are ignored, meters.
    radius: f64,
}

impl<'a> Around<'a> {
    /// The agents within `radius` meters of agent `i`.
    pub fn new(frame: &'a Frame<'a>, i: usize, radius: f64) -> Self {
        Self { frame, i, radius }
    }
}

impl Surroundings for Around<'_> {
    #[inline(always)]
    fn limits(&self) -> Limits {
        let Frame {
            agents, neighbors, ..
        } = self.frame;
        let (mut squared, mut widest) = (0.0_f64, 0.0_f64);
        neighbors
            .around(self.i, &agents.position, self.radius)
            .for_each(|run| {
                let fastest = greatest(&agents.velocity[run.indices()], |v| v.norm_squared());
                squared = squared.max(fastest);
                widest = widest.max(greatest(&agents.radius[run.indices()], |&radius| radius));
            });
        Limits {
            longest_reach: agents.radius[self.i] + widest,
            highest_speed: squared.sqrt(),
            farthest: self.radius,
        }
    }

    #[inline(always)]
    fn read<S: Simd>(&self, simd: S, wanted: Range<f64>, discs: &mut Discs) {
        let Frame {
            agents, neighbors, ..
        } = self.frame;
        let farthest = wanted.end.min(self.radius * self.radius);
        let (nearest, end) = (
            f64x8::splat(simd, wanted.start),
            f64x8::splat(simd, farthest),
        );
        let radius = f64x8::splat(simd, agents.radius[self.i]);
        let few = Few::of(agents);
        let (positions, velocities, radii) = match &few {
            Some(few) => (&few.position[..], &few.velocity[..], &few.radius[..]),
            None => (
                &agents.position[..],
                &agents.velocity[..],
                &agents.radius[..],
            ),
        };
        let position = agents.position[self.i];
        discs.begin(neighbors.around(self.i, &agents.position, farthest.sqrt()));
        // Closures do not inherit `#[target_feature]`: these loops are closure-free.
        while let Some(run) = discs.next_run() {
            let place = neighbors.seen_from(position, run.laps);
            let (x, y) = (f64x8::splat(simd, place.x), f64x8::splat(simd, place.y));
            let run = run.indices();
            let mut start = run.start;
            while start < run.end {
                // The last agents are read with some before them.
                let first = start.min(positions.len() - LANES);
                let own = first_lanes(run.end - first) & !first_lanes(start - first);
                let some = first..first + LANES;
                let [their_x, their_y] = coordinates(simd, &positions[some.clone()]);
                let offset = [their_x - x, their_y - y];
                let squared = offset[0] * offset[0] + offset[1] * offset[1];
                let reach = radius + f64x8::from_slice(simd, &radii[some.clone()]);
                let contact = reach * reach;
                // Ignores agents in contact, and with them agent i itself.
                let is_wanted =
                    squared.simd_ge(nearest) & squared.simd_lt(end) & squared.simd_gt(contact);
                let is_wanted = is_wanted.to_bitmask() & own;
                if is_wanted != 0 {
                    let eight = Eight {
                        offset,
                        velocity: coordinates(simd, &velocities[some]),
                        gap: squared - contact,
                    };
                    discs.add(simd, &eight, is_wanted, first as u32);
                }
                start += LANES;
            }
        }
    }

    #[inline]
    fn disc(&self, number: u32) -> MovingDisc {
        let Frame {
            agents, neighbors, ..
        } = self.frame;
        let (i, j) = (self.i, number as usize);
        let [own, other] = [i, j].map(|agent| agents.position[agent]);
        // A period, and the spacing of levels, is at least twice the avoidance radius: only the nearest image can be in
        // reach.
        let laps = neighbors.nearest_laps(own - other);
        MovingDisc {
            offset: other - neighbors.seen_from(own, laps),
            velocity: agents.velocity[j],
            reach: agents.radius[i] + agents.radius[j],
        }
    }
}

/// A crowd that is too small for a vector, padded.
struct Few {
    position: [Vector; LANES],
    velocity: [Vector; LANES],
    radius: [f64; LANES],
}

impl Few {
    #[inline(always)]
    fn of(agents: &Agents) -> Option<Self> {
        (agents.len() < LANES).then(|| Self {
            position: padded(&agents.position),
            velocity: padded(&agents.velocity),
            radius: padded(&agents.radius),
        })
    }
}

fn padded<T: Copy + Default>(values: &[T]) -> [T; LANES] {
    let mut padded = [T::default(); LANES];
    padded[..values.len()].copy_from_slice(values);
    padded
}
