//! What the time gap of the choice of headings depends on.

use super::{Fixed, Simulation};
use crate::forces::walking::headings::{Fan, Headings, OPPOSED_WITHIN, Situation, before_wall};
use crate::frame::Frame;
use crate::math::{Vector, direction, perpendicular};

/// Agents see narrowings up to this far beyond the point that they walk to, meters.
const BEYOND: f64 = 1.0;
/// Places that are this many times narrower than the floor where the agent is count in full; those that are not
/// narrower do not count.
const MUCH_NARROWER: f64 = 1.5;
/// Agents come toward each other if the cosine between their ways is less than this number below 0, and fully from the
/// second one on: those who gather before a door from two sides do not.
const LEAST_OPPOSED: f64 = 0.7;
const FULLY_OPPOSED: f64 = 0.9;

impl Simulation {
    /// The headings between which agent `i` chooses; `None` if it follows no choice of headings or does not walk.
    pub fn fan(&self, i: usize) -> Option<Fan> {
        let frame = self.frame();
        let law = self.blend(i).walking_law()?;
        let law = law.headings()?;
        frame.fields.preferred_velocity.get(i)?;
        law.fan(&frame, i, self.fixed.gap(&frame, i, (law, true)))
    }
}

impl Fixed {
    /// The factor of T of agent `i`. Unless some agents may `meet`, none come toward each other.
    pub(super) fn gap(&self, frame: &Frame, i: usize, (law, meet): (&Headings, bool)) -> f64 {
        let agents = frame.agents;
        let motivation = self.scene.motivation(agents, i, frame.clock.time());
        let density = frame.fields.density.get(i).copied().unwrap_or(0.0);
        let narrowing = match law.gap.narrowing_share {
            0.0 => None,
            _ => self.narrowing(frame, i, law),
        };
        let opposed = match meet && law.gap.queues(motivation, density) {
            true => opposed(frame, i),
            false => 0.0,
        };
        law.gap.factor(&Situation {
            motivation,
            density,
            opposed,
            narrowing,
        })
    }

    /// The distance of agent `i` from the narrowing that it walks to, meters, and how much it counts, from 0 to 1.
    fn narrowing(&self, frame: &Frame, i: usize, law: &Headings) -> Option<[f64; 2]> {
        let p = frame.agents.position[i];
        let heading = direction(frame.fields.preferred_velocity[i]);
        let aim = frame.agents.aim.get(i)?;
        let far = (law.gap.reach()).min((aim - p).norm() + BEYOND);
        let next = self.narrowings.next(p, heading, far)?;
        let side = perpendicular(heading);
        let seen = frame.neighbors.seen_walls(frame.walls, p).iter();
        let walls = seen.map(|&k| frame.walls.wall(k));
        let walls = walls.filter(|wall| !wall.is_beyond(p, frame.neighbors.sight()));
        let free = |side: Vector| {
            let before = walls.clone().map(|wall| before_wall(wall, p, 0.0, side));
            before.fold(f64::INFINITY, f64::min)
        };
        let here = free(side) + free(-side);
        let counts = (here / next.width - 1.0) / (MUCH_NARROWER - 1.0);
        Some([next.distance, counts.clamp(0.0, 1.0)])
    }
}

/// How near agents that come toward agent `i` are, from 0 to 1. Those behind walls do not count.
fn opposed(frame: &Frame, i: usize) -> f64 {
    let p = frame.agents.position[i];
    let way = direction(frame.fields.preferred_velocity[i]);
    let walls = frame.neighbors.seen_walls(frame.walls, p).iter();
    let mut nearest: f64 = 0.0;
    for (j, r_ij) in frame.around(i, OPPOSED_WITHIN) {
        // Most are far away or walk along: no roots for these.
        let walks_along = frame.fields.preferred_velocity[j].dot(&way) >= 0.0;
        if walks_along || r_ij.norm_squared() >= OPPOSED_WITHIN * OPPOSED_WITHIN {
            continue;
        }
        let near = (2.0 * (1.0 - r_ij.norm() / OPPOSED_WITHIN)).min(1.0);
        let alike = direction(frame.fields.preferred_velocity[j]).dot(&way);
        let counts =
            near * ((-alike - LEAST_OPPOSED) / (FULLY_OPPOSED - LEAST_OPPOSED)).clamp(0.0, 1.0);
        let is_hidden = || {
            walls
                .clone()
                .any(|&k| frame.walls.wall(k).crossing(p, p - r_ij).is_some())
        };
        if counts > nearest && !is_hidden() {
            nearest = counts;
        }
    }
    nearest
}
