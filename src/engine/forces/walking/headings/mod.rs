//! The choice of headings: agents choose a direction near that of their way, by the room that each direction offers.
//!
//! M. Moussaïd, D. Helbing, G. Theraulaz, How simple rules determine pedestrian behavior and crowd disasters, PNAS 108
//! (2011): people choose the direction that brings them nearest to their goal, given how far they can walk in each
//! direction, and a speed that keeps a time gap to what is ahead. In this law, an agent compares [`COUNT`] headings at
//! equal angles φ_k around the direction ê_i of its way. Heading k has the utility
//!
//! U_k = S_k cos φ_k − p |φ_k − φ_i|,
//!
//! in m/s, with φ_i the angle of the heading that the agent follows and p [`heading_persistence`]. S_k = max(0, (d_k −
//! ℓ)/T) is the speed for which there is room: d_k is the distance to the nearest agent in a lane along the heading, or
//! to the nearest wall, at most R + [`look_ahead`], with R = ℓ + T s_i. The agent takes the heading with the greatest
//! utility, every [`CHOICE_TIME`], and walks along it at the speed of the [`Headway`] law, whose lane is narrower: it
//! looks for room beside others, and passes them closely.
//!
//! [`heading_persistence`]: Headings::heading_persistence
//! [`look_ahead`]: Headings::look_ahead

mod fan;
mod gap;
mod room;

pub use fan::{End, Fan, Heading, rotated};
pub use gap::{Gap, OPPOSED_WITHIN, Situation};
pub use room::before_wall;

use libm::sin;
use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{FADE, Headway, View};
use crate::clock::Clock;
use crate::forces::rates::Rates;
use crate::frame::Frame;
use crate::limits::FARTHEST;
use crate::math::{Vector, unit_vector};

/// The number of headings.
pub const COUNT: usize = 7;

/// The time between two choices, seconds, to the nearest number of coarse steps.
pub const CHOICE_TIME: f64 = 0.2;

/// The heading straight along the way.
pub const STRAIGHT: usize = COUNT / 2;

/// Parameters of the choice of headings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Headings {
    /// The speed along a heading.
    #[serde(skip)]
    pub headway: Headway,
    /// How T depends on motivation, density and narrowings.
    #[serde(skip)]
    pub gap: Gap,
    /// The largest angle between a heading and the way (`headings`), degrees.
    #[schemars(range(min = 0, max = 90))]
    pub heading_angle: f64,
    /// w_c (`headings`), meters: the half-width of the lane in which agents look for room along a heading; its edges
    /// fade over another half of it. Wider: agents keep more distance to the side of others.
    #[schemars(range(min = 0.01, max = FARTHEST))]
    pub heading_half_width: f64,
    /// `headings`, meters: agents compare headings up to this far beyond the distance that they need to walk at their
    /// preferred speed. Without it, slower agents ahead are not overtaken.
    #[schemars(range(min = 0, max = FARTHEST))]
    pub look_ahead: f64,
    /// p (`headings`), m/s per radian: the utility that a turn costs. Higher: agents keep to their headings.
    #[schemars(range(min = 0, max = 10))]
    pub heading_persistence: f64,
    /// b (`headings`), meters: agents expect those that come toward them this much farther to their left, and evade to
    /// the right; negative: to the left.
    #[schemars(range(min = -2, max = 2))]
    pub side_preference: f64,
    /// `headings`, seconds: the time after which agents look at the distance to agents that come toward them. Longer:
    /// they evade earlier.
    #[schemars(range(min = 0, max = 10))]
    pub evasion_time: f64,
}

impl Default for Headings {
    fn default() -> Self {
        Self {
            headway: Headway::default(),
            gap: Gap::default(),
            heading_angle: 60.0,
            heading_half_width: 0.4,
            look_ahead: 0.2,
            heading_persistence: 0.05,
            side_preference: 0.0,
            evasion_time: 0.5,
        }
    }
}

/// What an agent sees of another one, or of a place, along a heading: distances in meters, velocities in m/s.
#[derive(Debug, Clone, Copy)]
pub struct Seen {
    /// The distance along the heading.
    pub along: f64,
    /// The distance to its left.
    pub across: f64,
    /// The relative velocity (v_j − v_i) along the heading.
    pub away: f64,
    /// ê_i·ê_j.
    pub alike: f64,
}

impl Headings {
    /// φ_k, radians: negative to the right of the way.
    pub fn angle(&self, k: usize) -> f64 {
        let steps = k as f64 - STRAIGHT as f64;
        steps * (self.heading_angle.to_radians() / STRAIGHT as f64)
    }

    /// The unit vector at φ_k from the x axis.
    pub fn turned(&self, k: usize) -> Vector {
        let steps = k as i32 - STRAIGHT as i32;
        let step = self.heading_angle.to_radians() / TAU / STRAIGHT as f64 * 2f64.powi(32);
        unit_vector((step as i32).wrapping_mul(steps) as u32)
    }

    /// The distance in meters at which an agent counts along a heading, for an agent that looks `far` meters ahead:
    /// beyond `far` outside of the lane.
    ///
    /// d² = max(0, a + t max(0, u) + t_e o max(−2 s_i, min(0, u)))² + c²
    ///      + far² (max(0, (|c| − w_c)/f) + max(0, 1 − a/f)), with f = w_c/2,
    ///
    /// c the distance to the left of the heading plus b o, and o = min(1, 4 max(0, −ê_i·ê_j)): between 0 and 1, the
    /// more the agents want to walk against each other. `speed` is the preferred speed s_i, m/s.
    pub fn distance(&self, (far, speed): (f64, f64), seen: &Seen) -> f64 {
        let fade = FADE * self.heading_half_width;
        let oncoming = (super::headway::AGAINST * (-seen.alike).max(0.0)).min(1.0);
        let across = seen.across + self.side_preference * oncoming;
        let outside = ((across.abs() - self.heading_half_width) / fade).max(0.0)
            + (1.0 - seen.along / fade).max(0.0);
        let expected = seen.along
            + self.headway.headway_anticipation * seen.away.max(0.0)
            + self.evasion_time * oncoming * seen.away.clamp(-2.0 * speed, 0.0);
        let expected = expected.max(0.0);
        (expected * expected + across * across + far * far * outside).sqrt()
    }

    /// How far an agent with this preferred speed, m/s, looks along its headings, meters; `gap` is the factor of T.
    pub fn sight(&self, speed: f64, gap: f64) -> f64 {
        self.headway.headway_length + self.headway.headway_time * gap * speed + self.look_ahead
    }

    /// How much farther away agents that come toward an agent with this preferred speed, m/s, count, meters.
    fn farther(&self, speed: f64) -> f64 {
        2.0 * self.evasion_time * speed + self.side_preference.abs()
    }

    /// The unit vectors at all φ_k from the x axis.
    pub fn all_turned(&self) -> [Vector; COUNT] {
        std::array::from_fn(|k| self.turned(k))
    }

    /// The heading that agent `i` chooses with these rooms before agents, m/s; `gap` is the factor of T, and `turned`
    /// are the unit vectors at all φ_k.
    pub(super) fn chosen(
        &self,
        frame: &Frame,
        i: usize,
        (gap, turned): (f64, &[Vector; COUNT]),
        mut rooms: [f64; COUNT],
    ) -> usize {
        self.limit_by_walls(frame, i, (gap, turned), &mut rooms);
        self.best(&rooms, turned, self.followed(frame, i))
    }

    /// The heading with the greatest utility for an agent that follows heading `now`, with `room` for these speeds,
    /// m/s. Of equal ones it is the one nearest to the way.
    fn best(&self, room: &[f64; COUNT], turned: &[Vector; COUNT], now: usize) -> usize {
        let utility = |k: usize| self.utility(room[k], turned, [k, now]);
        let mut best = (STRAIGHT, utility(STRAIGHT));
        for aside in 1..=STRAIGHT {
            for k in [STRAIGHT - aside, STRAIGHT + aside] {
                let utility = utility(k);
                if utility > best.1 {
                    best = (k, utility);
                }
            }
        }
        best.0
    }

    /// U_k, m/s, of heading `k` for an agent that follows heading `now`.
    fn utility(&self, room: f64, turned: &[Vector; COUNT], [k, now]: [usize; 2]) -> f64 {
        let turn = (self.angle(k) - self.angle(now)).abs();
        room * turned[k].x - self.heading_persistence * turn
    }

    /// Whether agents choose headings in the current frame: about every [`CHOICE_TIME`].
    pub(super) fn chooses(clock: &Clock) -> bool {
        let every = (CHOICE_TIME / clock.coarse_step()).round().max(1.0);
        clock.is_coarse() && clock.coarse_frame().is_multiple_of(every as u64)
    }

    /// The rectangle around an agent in which others count.
    pub(super) fn view(&self) -> View {
        let one_way = self.view_of_one_way();
        let aside = one_way.aside + self.side_preference.abs();
        View {
            more_time: 2.0 * self.evasion_time,
            aside,
            behind: aside * one_way.spread,
            ..one_way
        }
    }

    /// The rectangle around an agent in which others count if no agent wants to walk against another one.
    pub(super) fn view_of_one_way(&self) -> View {
        let lane = self.headway.view();
        let aside = (1.0 + FADE) * self.heading_half_width;
        // The edge of the lane along the outermost heading begins behind the agent.
        let spread = sin(self.heading_angle.to_radians());
        View {
            length: lane.length + self.look_ahead,
            aside,
            behind: aside * spread,
            spread,
            ..lane
        }
    }

    pub(super) fn rates(&self) -> Rates {
        let rates = self.headway.rates();
        let shortest = self.gap.shortest();
        Rates {
            steepness: rates.steepness / shortest,
            damping: rates.damping / shortest,
            ..rates
        }
    }
}
