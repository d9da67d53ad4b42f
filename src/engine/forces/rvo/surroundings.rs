//! The moving discs around an agent.

use std::ops::Range;

use crate::engine::frame::Frame;
use crate::engine::math::{Vector, greatest};

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

    /// Appends the discs whose centers are at a distance in `squared`, m².
    fn read(&self, squared: Range<f64>, discs: &mut Vec<MovingDisc>);
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
        for run in neighbors.around(agents.position[self.i], self.radius) {
            let fastest = greatest(&agents.velocity[run.indices()], |v| v.norm_squared());
            squared = squared.max(fastest);
            widest = widest.max(greatest(&agents.radius[run.indices()], |&radius| radius));
        }
        Limits {
            longest_reach: agents.radius[self.i] + widest,
            highest_speed: squared.sqrt(),
            farthest: self.radius,
        }
    }

    fn read(&self, wanted: Range<f64>, discs: &mut Vec<MovingDisc>) {
        let Frame {
            agents, neighbors, ..
        } = self.frame;
        let position = agents.position[self.i];
        let radius = self.radius * self.radius;
        let farthest = wanted.end.min(radius);
        for run in neighbors.around(position, farthest.sqrt()) {
            let place = neighbors.seen_from(position, run.laps);
            for j in run.indices() {
                let offset = agents.position[j] - place;
                let squared = offset.norm_squared();
                if !(wanted.start <= squared && squared < farthest) {
                    continue;
                }
                let reach = agents.radius[self.i] + agents.radius[j];
                // Ignores agents in contact, and with them agent i itself.
                if squared > reach * reach {
                    discs.push(MovingDisc {
                        offset,
                        velocity: agents.velocity[j],
                        reach,
                    });
                }
            }
        }
    }
}
