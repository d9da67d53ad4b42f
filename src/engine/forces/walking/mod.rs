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
//!
//! With [`Headings`], agents also choose a heading ĥ_i beside ê_i, and the acceleration is
//! K^goal/(τ m_i) (s_i^law ĥ_i − s_i ê_i). They hold the angle between both until the next coarse frame.

mod density_ahead;
mod drag;
pub mod headings;
mod headway;

pub use density_ahead::DensityAhead;
pub use drag::Drag;
pub use headings::Headings;
pub use headway::Headway;

use std::f64::consts::FRAC_1_SQRT_2;

use headings::{COUNT, STRAIGHT};

use crate::engine::forces::rates::{Extremes, Rates};
use crate::engine::frame::Frame;
use crate::engine::math::{Vector, direction};
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
    /// Agents choose a heading by the room that it has, and keep a time gap along it.
    Headings(Headings),
}

/// Width of the fading edge of a lane and length of its fading beginning, in units of its half-width.
const FADE: f64 = 0.5;

/// The rectangle ahead of an agent in which it looks for others.
#[derive(Debug, Clone, Copy, Default)]
struct View {
    /// Its length for an agent that stands, meters.
    length: f64,
    /// The additional length per preferred speed, seconds.
    time: f64,
    /// Its width to each side, meters.
    aside: f64,
    /// The additional width to each side per length.
    spread: f64,
}

/// The agents of a block that decide now.
pub struct Due {
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
    /// The headings that they follow, as [`Agents::heading`](crate::engine::agents::Agents::heading); empty if no agent
    /// chooses one.
    pub heading: &'a mut [i8],
}

/// Eight agents that look ahead.
struct Walkers<R: Real, S: Simd> {
    /// The first of them.
    start: usize,
    /// −ê_i, zero without preferred velocity.
    backwards: [Lanes<R, S>; 2],
    /// s_i: their preferred speeds, m/s.
    speed: Lanes<R, S>,
    /// The factors of their time gaps.
    gap: Lanes<R, S>,
}

impl WalkingLaw {
    /// Whether the law lowers preferred speeds by the agents ahead.
    pub fn looks_ahead(&self) -> bool {
        match self {
            Self::Headway(_) | Self::DensityAhead(_) | Self::Headings(_) => true,
            Self::Drag(_) => false,
        }
    }

    /// The farthest distance of agents that can slow an agent with this preferred speed, m/s, meters; `support` is
    /// the largest support radius.
    pub fn reach(&self, speed: f64, support: f64) -> f64 {
        let view = self.view(support);
        let length = view.length + view.time * speed;
        length.hypot(view.aside + view.spread * length)
    }

    /// The farthest distance of walls that an agent with this preferred speed, m/s, avoids, meters; `None` for laws
    /// that do not see walls.
    pub fn sees_walls(&self, speed: f64) -> Option<f64> {
        self.headings()
            .map(|law| law.sight(speed, law.gap.longest()))
    }

    /// The law of headings, if it is this one.
    pub fn headings(&self) -> Option<&Headings> {
        match self {
            Self::Headings(law) => Some(law),
            Self::Headway(_) | Self::DensityAhead(_) | Self::Drag(_) => None,
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
            Self::Drag(_) => View::default(),
            Self::Headings(law) => law.view(),
        }
    }

    /// The rates at which the lowered speed changes with the place of an agent and with the velocity of the one ahead,
    /// or the friction.
    pub fn rates(&self, of: &Extremes) -> Rates {
        match self {
            Self::Headway(law) => law.rates(),
            Self::DensityAhead(law) => law.rates(of),
            Self::Drag(law) => law.rates(of),
            Self::Headings(law) => law.rates(),
        }
    }

    /// Whether the law reads the density of the agent's place (Eq. 9) in every frame.
    pub fn needs_density(&self) -> bool {
        match self {
            Self::Headway(_) | Self::DensityAhead(_) => false,
            Self::Drag(_) => true,
            Self::Headings(law) => law.gap.press_share != 0.0,
        }
    }

    /// Sets what the due agents of block `b` decide.
    pub fn decide(&self, frame: &Frame, b: usize, due: &Due, mut decided: Decided) {
        each!(frame.packed, columns => dispatch!(Level::new(), simd => {
            self.decide_with(simd, &columns.bodies, (frame, b), due, &mut decided);
        }));
    }

    #[inline(always)]
    fn decide_with<R: Real, S: Simd>(
        &self,
        simd: S,
        bodies: &Bodies<R>,
        (frame, b): (&Frame, usize),
        due: &Due,
        decided: &mut Decided,
    ) {
        let mut runs = Vec::new();
        let view = match self {
            Self::Headings(law) if !due.meets => law.view_of_one_way(),
            _ => self.view(frame.neighbors.support()),
        };
        let positions = &frame.agents.position;
        let all = (self.headings()).map_or([Vector::zeros(); COUNT], Headings::all_turned);
        for (agents, _) in frame.neighbors.near().block(b).clusters() {
            let own = agents.start % BLOCK..agents.start % BLOCK + agents.len();
            if !due.is_due[own.clone()].contains(&true) {
                continue;
            }
            let wishes = &frame.fields.preferred_velocity[agents.clone()];
            let walkers = Walkers::<R, S>::new(simd, agents.start, wishes, &due.gap[own.clone()]);
            let way = walkers.area(simd, bodies, &view);
            let area = way.map(|way| positions[agents.start] + way);
            frame.neighbors.inside(area, positions, &mut runs);
            let lost = match self {
                Self::Headway(law) => law.lost_speeds(simd, bodies, &walkers, &runs),
                Self::DensityAhead(law) => law.lost_speeds(simd, bodies, &walkers, &runs),
                Self::Drag(_) => continue,
                Self::Headings(law) => {
                    let rooms = law.rooms(simd, bodies, (&walkers, &all), &runs);
                    let rooms = rooms.map(
                        #[inline(always)]
                        |room| store::<R, S>(room),
                    );
                    let mut turned = [Vector::new(1.0, 0.0); LANES];
                    for (k, i) in agents.clone().enumerate() {
                        let (rooms, place) = (rooms.map(|room| room[k]), own.start + k);
                        if due.is_due[place] {
                            let chosen = law.chosen(frame, i, (due.gap[place], &all), rooms);
                            turned[k] = all[chosen];
                            decided.heading[place] = (chosen as i32 - STRAIGHT as i32) as i8;
                        }
                    }
                    let walkers = walkers.turned(simd, &turned);
                    let way = walkers.area(simd, bodies, &law.lane());
                    let area = way.map(|way| positions[agents.start] + way);
                    frame.neighbors.inside(area, positions, &mut runs);
                    law.headway.lost_speeds(simd, bodies, &walkers, &runs)
                }
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
        let wish = frame.fields.preferred_velocity[i];
        let speed = wish.norm();
        let allowed = frame.agents.allowed_speed.get(i).copied().flatten();
        let allowed = allowed.filter(|&allowed| allowed < speed);
        let law = self.headings();
        match law.map(|law| (law, law.followed(frame, i))) {
            Some((law, followed)) if followed != STRAIGHT => {
                let share = allowed.map_or(1.0, |allowed| allowed / speed);
                headings::rotated(wish, law.turned(followed)) * share - wish
            }
            _ => allowed.map_or(Vector::zeros(), |allowed| wish * (allowed / speed - 1.0)),
        }
    }
}

/// Whether some agents with these preferred velocities may want to walk against others: the directions of all are not
/// within an eighth of a turn from their mean.
pub fn some_meet(wishes: &[Vector]) -> bool {
    let mean = direction(wishes.iter().map(|&wish| direction(wish)).sum());
    let strays = |wish: &Vector| wish.dot(&mean) < FRAC_1_SQRT_2 * wish.norm();
    wishes.iter().any(strays)
}

impl<R: Real, S: Simd> Walkers<R, S> {
    #[inline(always)]
    fn new(simd: S, start: usize, wishes: &[Vector], gaps: &[f64]) -> Self {
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
            gap: lanes_from::<R, S>(simd, gaps),
        }
    }

    /// They look along other headings: turned by the angles of these unit vectors.
    #[inline(always)]
    fn turned(self, simd: S, by: &[Vector; LANES]) -> Self {
        let cosine = lanes_from::<R, S>(simd, &by.map(|by| by.x));
        let sine = lanes_from::<R, S>(simd, &by.map(|by| by.y));
        let [x, y] = self.backwards;
        Self {
            backwards: [x * cosine - y * sine, y * cosine + x * sine],
            ..self
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
        let reach = self.speed.mul_add(time, length);
        let front = backwards * reach;
        let (aside, spread) = (
            splat::<R, S>(simd, view.aside),
            splat::<R, S>(simd, -view.spread),
        );
        let side = across.abs() * reach.mul_add(spread, aside);
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
