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
//! people take longer to react. [`Drag`] is a friction. Agents without preferred velocity do not look ahead.

mod density_ahead;
mod drag;
mod headway;

pub use density_ahead::DensityAhead;
pub use drag::Drag;
pub use headway::Headway;

use crate::engine::forces::rates::{Extremes, Rates};
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

/// The rectangle ahead of an agent in which it looks for others.
#[derive(Debug, Clone, Copy, Default)]
struct View {
    /// Its length for an agent that stands, meters.
    length: f64,
    /// The additional length per preferred speed, seconds.
    time: f64,
    /// Its width to each side, meters.
    aside: f64,
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
    /// Whether the law lowers preferred speeds by the agents ahead.
    pub fn looks_ahead(&self) -> bool {
        match self {
            Self::Headway(_) | Self::DensityAhead(_) => true,
            Self::Drag(_) => false,
        }
    }

    /// The farthest distance of agents that can slow an agent with this preferred speed, m/s, meters; `support` is
    /// the largest support radius.
    pub fn reach(&self, speed: f64, support: f64) -> f64 {
        let view = self.view(support);
        (view.length + view.time * speed).hypot(view.aside)
    }

    fn view(&self, support: f64) -> View {
        match self {
            Self::Headway(law) => law.view(),
            Self::DensityAhead(_) => View {
                length: support,
                time: 0.0,
                aside: support,
            },
            Self::Drag(_) => View::default(),
        }
    }

    /// The rates at which the lowered speed changes with the place of an agent and with the velocity of the one ahead,
    /// or the friction.
    pub fn rates(&self, of: &Extremes) -> Rates {
        match self {
            Self::Headway(law) => law.rates(),
            Self::DensityAhead(law) => law.rates(of),
            Self::Drag(law) => law.rates(of),
        }
    }

    /// Whether the law reads the density of the agent's place (Eq. 9) in every frame.
    pub fn needs_density(&self) -> bool {
        match self {
            Self::Headway(_) | Self::DensityAhead(_) => false,
            Self::Drag(_) => true,
        }
    }

    /// Sets the speeds at which the due agents of block `b` may walk, m/s; infinite without agents in view.
    pub fn decide(
        &self,
        frame: &Frame,
        b: usize,
        is_due: &[bool; BLOCK],
        allowed: &mut [Option<f64>],
    ) {
        each!(frame.packed, columns => dispatch!(Level::new(), simd => {
            self.decide_with(simd, &columns.bodies, (frame, b), is_due, allowed);
        }));
    }

    #[inline(always)]
    fn decide_with<R: Real, S: Simd>(
        &self,
        simd: S,
        bodies: &Bodies<R>,
        (frame, b): (&Frame, usize),
        is_due: &[bool; BLOCK],
        allowed: &mut [Option<f64>],
    ) {
        let mut runs = Vec::new();
        let view = self.view(frame.neighbors.support());
        let positions = &frame.agents.position;
        for (agents, _) in frame.neighbors.near().block(b).clusters() {
            let own = agents.start % BLOCK..agents.start % BLOCK + agents.len();
            if !is_due[own.clone()].contains(&true) {
                continue;
            }
            let wishes = &frame.fields.preferred_velocity[agents.clone()];
            let walkers = Walkers::<R, S>::new(simd, agents.start, wishes);
            let way = walkers.area(simd, bodies, &view);
            let area = way.map(|way| positions[agents.start] + way);
            frame.neighbors.inside(area, positions, &mut runs);
            let lost = match self {
                Self::Headway(law) => law.lost_speeds(simd, bodies, &walkers, &runs),
                Self::DensityAhead(law) => law.lost_speeds(simd, bodies, &walkers, &runs),
                Self::Drag(_) => continue,
            };
            let lost = store::<R, S>(lost);
            for (k, i) in own.enumerate().filter(|&(_, i)| is_due[i]) {
                let is_free = lost[k] <= 0.0;
                let lowered = || (wishes[k].norm() - lost[k]).max(0.0);
                allowed[i] = Some(if is_free { f64::INFINITY } else { lowered() });
            }
        }
    }
}

/// The change of the preferred velocity of agent `i` that limits it to the allowed speed, m/s.
pub fn lost_velocity(frame: &Frame, i: usize) -> Vector {
    let wish = frame.fields.preferred_velocity[i];
    let speed = wish.norm();
    match frame.agents.allowed_speed.get(i) {
        Some(&Some(allowed)) if allowed < speed => wish * (allowed / speed - 1.0),
        _ => Vector::zeros(),
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
        let front = backwards * self.speed.mul_add(time, length);
        let side = across.abs() * splat::<R, S>(simd, view.aside);
        let walks = self.speed.simd_gt(zero);
        let low = walks.select(at + front.min(zero) - side, zero);
        let high = walks.select(at + front.max(zero) + side, zero);
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
