//! Walking laws: agents walk slower because of the crowd.
//!
//! None of the paper's forces slows a crowd whose agents all move at the same velocity. Walking laws do. They are not
//! part of the paper, and none of its profiles has one. [`Headway`] and [`DensityAhead`] lower the preferred speed s_i
//! = |v_i^pref| by the agents ahead, that is, in the direction ê_i of v_i^pref. Next to Eq. 17 this is an acceleration
//! of its own,
//!
//! a_i = K^goal/(τ m_i) (s_i^law − s_i) ê_i,
//!
//! so that both together are the goal force with the lowered speed. RVO has no goal force; the lowered speed is in
//! its cost (Eq. 20). Agents decide on s_i^law in coarse frames, like RVO on its velocities, and hold it in between:
//! people take longer to react. Agents without preferred velocity do not look ahead.
//!
//! With [`Headings`], agents also choose a heading ĥ_i beside ê_i, and the acceleration is
//! K^goal/(τ m_i) (s_i^law ĥ_i − s_i ê_i). They hold the angle between both until the next coarse frame.

mod density_ahead;
pub mod headings;
mod headway;
mod walkers;

pub use density_ahead::DensityAhead;
pub use headings::Headings;
pub use headway::Headway;

use libm::hypot;
use std::ops::Range;

use headings::{COUNT, STRAIGHT};
use walkers::{Motions, ROUNDING, View, Walkers};

use crate::forces::rates::{Extremes, Rates};
use crate::frame::Frame;
use crate::math::{Vector, direction};
use crate::neighbors::BLOCK;
use crate::pairs::{Bodies, LANES, Real, Simd, dispatch, each, level, store};

/// The walking law of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WalkingLaw {
    /// Agents keep a time gap to the nearest agent ahead.
    Headway(Headway),
    /// Agents walk slower the denser the crowd ahead.
    DensityAhead(DensityAhead),
    /// Agents choose a heading by the room that it has, and keep a time gap along it.
    Headings(Headings),
}

/// Width of the fading edge of a lane and length of its fading beginning, in units of its half-width.
const FADE: f64 = 0.5;

/// The agents of a block that decide now.
pub struct Deciders {
    /// Whether each of them does.
    pub is_due: [bool; BLOCK],
    /// The factors of their time gaps ([`headings::Gap`]); 1 with other laws.
    pub gap: [f64; BLOCK],
    /// Whether some agents may want to walk against others.
    pub meets: bool,
}

/// What the agents of a block decide.
pub struct Decided<'a> {
    /// The speeds at which they may walk, m/s; infinite without agents in view.
    pub allowed: &'a mut [Option<f64>],
    /// The headings that they follow, as [`Agents::heading`](crate::agents::Agents::heading); empty if no agent
    /// chooses one.
    pub heading: &'a mut [i8],
}

impl WalkingLaw {
    /// The farthest distance of agents that can slow an agent with this preferred speed, m/s, meters; `support` is
    /// the largest support radius.
    pub fn reach(&self, speed: f64, support: f64) -> f64 {
        let view = self.view(support);
        let longest = self.headings().map_or(1.0, |law| law.gap.longest());
        let length = view.length + (view.time * longest + view.more_time) * speed;
        let seen = hypot(length, view.aside + view.spread * length);
        self.headings()
            .map_or(seen, |law| seen.max(law.gap.sight()))
    }

    /// The farthest distance of walls that an agent with this preferred speed, m/s, avoids, meters; `None` for laws
    /// that do not see walls.
    pub fn sees_walls(&self, speed: f64) -> Option<f64> {
        self.headings()
            .map(|law| law.sight(speed, law.gap.longest()))
    }

    /// The choice of headings, if it is this one.
    pub fn headings(&self) -> Option<&Headings> {
        match self {
            Self::Headings(law) => Some(law),
            Self::Headway(_) | Self::DensityAhead(_) => None,
        }
    }

    fn view(&self, support: f64) -> View {
        match self {
            Self::Headway(law) => law.view(),
            Self::DensityAhead(_) => View {
                length: support,
                aside: support,
                ..View::default()
            },
            Self::Headings(law) => law.view(),
        }
    }

    /// The rates at which the lowered speed changes with the place of an agent and with the velocity of the one ahead.
    pub fn rates(&self, of: &Extremes) -> Rates {
        match self {
            Self::Headway(law) => law.rates(),
            Self::DensityAhead(law) => law.rates(of),
            Self::Headings(law) => law.rates(),
        }
    }

    /// Whether the law reads the density of the agent's place (Eq. 9) in every frame.
    pub fn needs_density(&self) -> bool {
        match self {
            Self::Headway(_) | Self::DensityAhead(_) => false,
            Self::Headings(law) => law.gap.press_share != 0.0 || law.gap.queue_share != 0.0,
        }
    }

    /// Sets what the due agents of block `b` decide.
    pub fn decide(&self, frame: &Frame, b: usize, due: &Deciders, mut decided: Decided) {
        each!(frame.packed, columns => dispatch!(level(), simd => {
            self.decide_with(simd, &columns.bodies, (frame, b), due, &mut decided);
        }));
    }

    #[inline(always)]
    fn decide_with<R: Real, S: Simd>(
        &self,
        simd: S,
        bodies: &Bodies<R>,
        (frame, b): (&Frame, usize),
        due: &Deciders,
        decided: &mut Decided,
    ) {
        let mut runs = Vec::new();
        let (wide, narrow) = match self {
            Self::Headings(law) if due.meets => (law.view(), law.headway.view()),
            Self::Headings(law) => (law.view_of_one_way(), law.headway.view()),
            Self::Headway(_) | Self::DensityAhead(_) => {
                (View::default(), self.view(frame.neighbors.support()))
            }
        };
        let chooses = self.headings().is_some() && Headings::chooses(frame.clock);
        let all = (self.headings()).map_or([Vector::zeros(); COUNT], Headings::all_turned);
        for (agents, _) in frame.neighbors.near().block(b).clusters() {
            let own = agents.start % BLOCK..agents.start % BLOCK + agents.len();
            if !due.is_due[own.clone()].contains(&true) {
                continue;
            }
            let wishes = &frame.fields.preferred_velocity[agents.clone()];
            let mut walkers =
                Walkers::<R, S>::new(simd, agents.start, wishes, &due.gap[own.clone()]);
            if let Self::Headings(law) = self {
                let heading = &mut decided.heading[own.clone()];
                if chooses {
                    walkers.look(simd, bodies, &wide, (frame, &mut runs));
                    let rooms = match due.meets {
                        true => law.rooms::<R, S, true>(simd, bodies, (&walkers, &all), &runs),
                        false => law.rooms::<R, S, false>(simd, bodies, (&walkers, &all), &runs),
                    };
                    let rooms = rooms.map(
                        #[inline(always)]
                        |room| store::<R, S>(room),
                    );
                    for (k, place) in own.clone().enumerate().filter(|&(_, i)| due.is_due[i]) {
                        let (i, rooms) = (agents.start + k, rooms.map(|room| room[k]));
                        let chosen = law.chosen(frame, i, (due.gap[place], &all), rooms);
                        heading[k] = (chosen as i32 - STRAIGHT as i32) as i8;
                    }
                }
                let mut turned = [Vector::new(1.0, 0.0); LANES];
                for (turned, &held) in turned.iter_mut().zip(&*heading) {
                    *turned = all[(STRAIGHT as i32 + i32::from(held)) as usize];
                }
                walkers = walkers.turned(simd, &turned);
            }
            walkers.look(simd, bodies, &narrow, (frame, &mut runs));
            let lost = match self {
                Self::Headway(law) | Self::Headings(Headings { headway: law, .. }) => {
                    law.lost_speeds(simd, bodies, &walkers, &runs)
                }
                Self::DensityAhead(law) => law.lost_speeds(simd, bodies, &walkers, &runs),
            };
            let lost = store::<R, S>(lost);
            for (k, i) in own.enumerate().filter(|&(_, i)| due.is_due[i]) {
                let is_free = lost[k] <= 0.0;
                let lowered = || (wishes[k].norm() - lost[k]).max(0.0);
                decided.allowed[i] = Some(if is_free { f64::INFINITY } else { lowered() });
            }
        }
    }

    /// The change of the preferred velocity of agent `i` that gives it the allowed speed along the heading that it
    /// follows, m/s.
    pub fn lost_velocity(&self, frame: &Frame, i: usize) -> Vector {
        let mut lost = [Vector::zeros()];
        self.lost_velocities(frame, i..i + 1, &mut lost);
        lost[0]
    }

    /// Those of several agents of one block.
    pub fn lost_velocities(&self, frame: &Frame, agents: Range<usize>, lost: &mut [Vector]) {
        let wishes = &frame.fields.preferred_velocity[agents.clone()];
        let allowed = frame.agents.allowed_speed.get(agents.clone());
        let allowed = allowed.unwrap_or_default();
        let mut shares = [1.0; BLOCK];
        dispatch!(level(), _simd => allowed_shares(wishes, allowed, &mut shares));
        let shares = wishes.iter().zip(shares);
        let Some(law) = self.headings() else {
            for (lost, (wish, share)) in lost.iter_mut().zip(shares) {
                *lost = wish * (share - 1.0);
            }
            return;
        };
        let all = law.all_turned();
        for ((lost, (wish, share)), i) in lost.iter_mut().zip(shares).zip(agents) {
            let heading = headings::rotated(*wish, all[law.followed(frame, i)]);
            *lost = heading * share - wish;
        }
    }
}

/// The part of their preferred speeds at which agents may walk, of those that have decided on a speed.
#[inline(always)]
fn allowed_shares(wishes: &[Vector], allowed: &[Option<f64>], shares: &mut [f64]) {
    for ((share, wish), allowed) in shares.iter_mut().zip(wishes).zip(allowed) {
        let speed = wish.norm();
        // Without branches: what agents decide is hard to predict.
        let allowed = allowed.unwrap_or(f64::INFINITY).min(speed);
        *share = allowed / speed.max(f64::MIN_POSITIVE);
    }
}

/// Whether some agents with these preferred velocities may want to walk against others: the directions of all are not
/// within an eighth of a turn from that of their sum.
pub fn some_meet(wishes: &[Vector]) -> bool {
    let mean = direction(wishes.iter().sum());
    // Without roots: there are many wishes.
    let strays = |wish: &Vector| {
        let along = wish.dot(&mean);
        along < 0.0 || along * along < 0.5 * wish.norm_squared()
    };
    wishes.iter().any(strays)
}
