//! Walking laws: what makes an agent walk slower because of the crowd.
//!
//! Nothing in the paper's forces slows a crowd that moves as one. A walking law does, and is not part of the paper:
//! none of its profiles has one. [`Headway`] and [`DensityAhead`] lower the preferred speed s_i = |v_i^pref| by the
//! agents ahead, that is, in the direction ê_i of v_i^pref. Next to Eq. 17 this is an acceleration of its own,
//!
//! a_i = K^goal/(τ m_i) (s_i^law − s_i) ê_i,
//!
//! so that both together are the goal force with the lowered speed. RVO has no goal force; the lowered speed is in
//! its cost (Eq. 20). [`Drag`] is a friction. Agents without preferred velocity do not look ahead.

mod density_ahead;
mod drag;
mod headway;

pub use density_ahead::DensityAhead;
pub use drag::Drag;
pub use headway::Headway;

use std::ops::Range;

use crate::engine::frame::Frame;
use crate::engine::math::Vector;
use crate::engine::neighbors::BLOCK;
use crate::engine::pairs::prelude::*;
use crate::engine::pairs::{
    Bodies, LANES, Lanes, Level, Real, Simd, dispatch, each, lanes_from, splat, store,
};

/// The walking law of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WalkingLaw {
    /// Agents keep a time gap to the nearest agent ahead.
    Headway(Headway),
    /// Agents walk slower the denser the crowd ahead.
    DensityAhead(DensityAhead),
    /// A friction that grows with the density.
    Drag(Drag),
}

/// Eight agents that look ahead.
struct Walkers<R: Real, S: Simd> {
    /// The first of them.
    start: usize,
    /// −ê_i, zero without preferred velocity.
    backwards: [Lanes<R, S>; 2],
    /// s_i: their preferred speeds, m/s.
    speed: Lanes<R, S>,
}

impl WalkingLaw {
    /// Does the law lower preferred speeds by the agents ahead?
    pub fn looks_ahead(&self) -> bool {
        !matches!(self, Self::Drag(_))
    }

    /// The farthest distance of agents that can slow an agent with this preferred speed, m/s, meters; `support` is
    /// the largest support radius.
    pub fn reach(&self, speed: f64, support: f64) -> f64 {
        let [ahead, aside] = self.view(speed, support);
        ahead.hypot(aside)
    }

    /// How far ahead and to each side an agent with this preferred speed looks, meters.
    #[inline(always)]
    fn view(&self, speed: f64, support: f64) -> [f64; 2] {
        match self {
            Self::Headway(law) => law.view(speed),
            Self::DensityAhead(_) => [support; 2],
            Self::Drag(_) => [0.0; 2],
        }
    }

    /// The largest rate at which the lowered speed changes with the place of an agent, 1/s. `speed` is the preferred
    /// speed, m/s.
    pub fn steepness(&self, speed: f64, support: f64) -> f64 {
        match self {
            Self::Headway(law) => law.steepness(),
            Self::DensityAhead(law) => law.steepness(speed, support),
            Self::Drag(_) => 0.0,
        }
    }

    /// The preferred velocity of agent `i` with the lowered speed, m/s.
    pub fn preferred_velocity(&self, frame: &Frame, i: usize) -> Vector {
        frame.fields.preferred_velocity[i] + self.acceleration(frame, i, 1.0)
    }

    /// What the law takes from the preferred velocity of agent `i`, times `rate`, 1/s: an acceleration, m/s².
    pub fn acceleration(&self, frame: &Frame, i: usize, rate: f64) -> Vector {
        let mut rates = [0.0; BLOCK];
        rates[i % BLOCK] = rate;
        let mut out = [Vector::zeros(); BLOCK];
        self.add_accelerations(frame, i / BLOCK, &rates, &mut out);
        out[i % BLOCK]
    }

    /// Adds what the law takes from the preferred velocities of block `b`, times `rates`, 1/s, to accelerations, m/s².
    pub fn add_accelerations(
        &self,
        frame: &Frame,
        b: usize,
        rates: &[f64; BLOCK],
        accelerations: &mut [Vector],
    ) {
        each!(frame.packed, columns => dispatch!(Level::new(), simd => {
            self.add_sums(simd, &columns.bodies, (frame, b), rates, accelerations);
        }));
    }

    #[inline(always)]
    fn add_sums<R: Real, S: Simd>(
        &self,
        simd: S,
        bodies: &Bodies<R>,
        (frame, b): (&Frame, usize),
        rates: &[f64; BLOCK],
        out: &mut [Vector],
    ) {
        let mut runs = Vec::new();
        for (agents, _) in frame.neighbors.near().block(b).clusters() {
            let own = agents.start % BLOCK..agents.start % BLOCK + agents.len();
            let rates = &rates[own.clone()];
            if rates.iter().all(|&rate| rate == 0.0) {
                continue;
            }
            let wishes = &frame.fields.preferred_velocity[agents.clone()];
            let walkers = Walkers::<R, S>::new(simd, agents.start, wishes);
            let area = self.area(frame, &walkers, agents);
            let positions = &frame.agents.position;
            frame.neighbors.inside(area, positions, &mut runs);
            let lost = match self {
                Self::Headway(law) => law.lost_speeds(simd, bodies, &walkers, &runs),
                Self::DensityAhead(law) => law.lost_speeds(simd, bodies, &walkers, &runs),
                Self::Drag(_) => continue,
            };
            let [x, y] = walkers.backwards;
            let (x, y) = (store::<R, S>(x * lost), store::<R, S>(y * lost));
            for (k, (out, rate)) in out[own].iter_mut().zip(rates).enumerate() {
                *out += Vector::new(x[k], y[k]) * *rate;
            }
        }
    }

    /// The lower left and the upper right corner of a rectangle with all places that the walkers look at.
    #[inline(always)]
    fn area<R: Real, S: Simd>(
        &self,
        frame: &Frame,
        walkers: &Walkers<R, S>,
        agents: Range<usize>,
    ) -> [Vector; 2] {
        let support = frame.neighbors.support();
        let [x, y] = walkers.backwards;
        let (x, y) = (store::<R, S>(x), store::<R, S>(y));
        let speed = store::<R, S>(walkers.speed);
        let mut low = frame.agents.position[agents.start];
        let mut high = low;
        for (k, place) in frame.agents.position[agents].iter().enumerate() {
            let [ahead, aside] = self.view(speed[k], support);
            let (front_x, front_y) = (-x[k] * ahead, -y[k] * ahead);
            let (side_x, side_y) = (y[k].abs() * aside, x[k].abs() * aside);
            low.x = low.x.min(place.x + front_x.min(0.0) - side_x);
            low.y = low.y.min(place.y + front_y.min(0.0) - side_y);
            high.x = high.x.max(place.x + front_x.max(0.0) + side_x);
            high.y = high.y.max(place.y + front_y.max(0.0) + side_y);
        }
        [low, high]
    }
}

impl<R: Real, S: Simd> Walkers<R, S> {
    #[inline(always)]
    fn new(simd: S, start: usize, wishes: &[Vector]) -> Self {
        let mut wish = [[0.0; LANES]; 2];
        for (k, of) in wishes.iter().enumerate() {
            wish[0][k] = of.x;
            wish[1][k] = of.y;
        }
        let zero = splat::<R, S>(simd, 0.0);
        let x = lanes_from::<R, S>(simd, &wish[0]);
        let y = lanes_from::<R, S>(simd, &wish[1]);
        let speed = y.mul_add(y, x * x).sqrt();
        let walks = speed.simd_gt(zero);
        let minus_inverse = walks.select(splat::<R, S>(simd, -1.0) / speed, zero);
        Self {
            start,
            backwards: [x * minus_inverse, y * minus_inverse],
            speed,
        }
    }
}
