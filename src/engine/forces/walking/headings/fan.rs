//! The headings of one agent, and of eight at a time.

use std::ops::Range;

use super::room::{before_wall, nearest_wall};
use super::{COUNT, Headings, STRAIGHT, Seen};
use crate::forces::walking::{FADE, Motions, ROUNDING, Walkers, headway};
use crate::frame::Frame;
use crate::math::{Vector, direction, perpendicular};
use crate::neighbors::Run;
use crate::pairs::prelude::*;
use crate::pairs::{Bodies, Lanes, PairSum, Real, Simd, add_pairs, load, splat};

/// The headings between which an agent chooses.
#[derive(Debug, Clone, PartialEq)]
pub struct Fan {
    /// From the right of the way to its left.
    pub headings: [Heading; COUNT],
    /// The number of the one that the agent follows.
    pub followed: usize,
    /// The factor of T.
    pub gap: f64,
}

/// A heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heading {
    /// Its direction, of length 1.
    pub direction: Vector,
    /// Its angle from the way, radians.
    pub angle: f64,
    /// The speed for which it has room, S_k, m/s.
    pub room: f64,
    /// U_k, m/s.
    pub utility: f64,
    /// What ends the room.
    pub ends_at: Option<End>,
}

/// What ends the room along a heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The agent with this index.
    Agent(usize),
    /// The wall with this index.
    Wall(u32),
}

impl Headings {
    /// The headings of agent `i` of a frozen frame, for a factor `gap` of T; `None` without a preferred velocity.
    pub fn fan(&self, frame: &Frame, i: usize, gap: f64) -> Option<Fan> {
        let wish = frame.fields.preferred_velocity[i];
        let (speed, way) = (wish.norm(), direction(wish));
        if speed == 0.0 {
            return None;
        }
        let followed = self.followed(frame, i);
        let far = self.sight(speed, gap);
        let all = self.all_turned();
        let headings = std::array::from_fn(|k| {
            let turned = rotated(way, all[k]);
            let radius = frame.agents.radius[i];
            let (wall_room, wall) = nearest_wall(frame, i, radius, turned, far);
            let mut least = (far, None);
            for (j, r_ij) in frame.around(i, far + self.farther(speed)) {
                let relative = frame.agents.velocity[j] - frame.agents.velocity[i];
                let seen = Seen {
                    along: -r_ij.dot(&turned),
                    across: r_ij.perp(&turned),
                    away: relative.dot(&turned),
                    alike: direction(frame.fields.preferred_velocity[j]).dot(&way),
                };
                let distance = self.distance((far, speed), &seen);
                if distance < least.0 {
                    least = (distance, Some(End::Agent(j)));
                }
            }
            let time = self.headway.headway_time * gap;
            let room = ((least.0 - self.headway.headway_length) / time).max(0.0);
            let (room, ends_at) = match wall_room / time < room {
                true => (wall_room / time, wall.map(End::Wall)),
                false => (room, least.1),
            };
            Heading {
                direction: turned,
                angle: self.angle(k),
                room,
                utility: self.utility(room, &all, [k, followed]),
                ends_at,
            }
        });
        Some(Fan {
            headings,
            followed,
            gap,
        })
    }

    /// The heading that agent `i` follows.
    pub fn followed(&self, frame: &Frame, i: usize) -> usize {
        let held = frame.agents.heading.get(i);
        held.map_or(STRAIGHT, |&held| {
            (STRAIGHT as i32 + i32::from(held)) as usize
        })
    }

    /// Lowers the rooms along the headings of agent `i`, m/s, to those before walls.
    pub(super) fn limit_by_walls(
        &self,
        frame: &Frame,
        i: usize,
        (gap, turned): (f64, &[Vector; COUNT]),
        rooms: &mut [f64; COUNT],
    ) {
        let (p, radius) = (frame.agents.position[i], frame.agents.radius[i]);
        let near = frame.neighbors.seen_walls(frame.walls, p);
        if near.is_empty() {
            return;
        }
        let wish = frame.fields.preferred_velocity[i];
        let far = self.sight(wish.norm(), gap);
        let per_time = 1.0 / (self.headway.headway_time * gap);
        let way = direction(wish);
        let headings = turned.map(|by| rotated(way, by));
        for &k in near {
            let wall = frame.walls.wall(k);
            if wall.is_beyond(p, far + radius) || !wall.faces(p) {
                continue;
            }
            for (room, &heading) in rooms
                .iter_mut()
                .zip(&headings)
                .filter(|(room, _)| **room > 0.0)
            {
                *room = room.min(before_wall(wall, p, radius, heading) * per_time);
            }
        }
    }

    /// S_k, m/s, before agents, for eight agents i. `runs` contain all agents in view, and some out of view.
    #[inline(always)]
    pub(in crate::forces::walking) fn rooms<R: Real, S: Simd, const MEETS: bool>(
        &self,
        simd: S,
        bodies: &Bodies<R>,
        (walkers, turned): (&Walkers<R, S>, &[Vector; COUNT]),
        runs: &[Run],
    ) -> [Lanes<R, S>; COUNT] {
        let zero = splat::<R, S>(simd, 0.0);
        let time = splat::<R, S>(simd, self.headway.headway_time) * walkers.gap;
        let length = splat::<R, S>(simd, self.headway.headway_length);
        let look_ahead = splat::<R, S>(simd, self.look_ahead);
        let far = walkers.speed.mul_add_precise(time, length) + look_ahead;
        let [x, y] = walkers.backwards;
        let velocity_x = load(simd, &bodies.velocity_x, walkers.start);
        let velocity_y = load(simd, &bodies.velocity_y, walkers.start);
        let fade = FADE * self.heading_half_width;
        let mut sum = Rooms::<R, S, MEETS> {
            motions: Motions::of(bodies),
            backwards: walkers.backwards,
            unit: splat::<R, S>(simd, bodies.unit),
            own: [
                velocity_y.mul_add_precise(y, velocity_x * x),
                velocity_x * y - velocity_y * x,
            ],
            turned: turned.map(|of| [splat::<R, S>(simd, of.x), splat::<R, S>(simd, of.y)]),
            time: splat::<R, S>(simd, self.headway.headway_anticipation),
            evasion: splat::<R, S>(simd, self.evasion_time),
            leftward: splat::<R, S>(simd, self.side_preference),
            fastest: walkers.speed * splat::<R, S>(simd, -2.0),
            per_fade: splat::<R, S>(simd, 1.0 / fade),
            edge: splat::<R, S>(simd, -self.heading_half_width / fade),
            far_squared: far * far,
            farther: walkers.speed * splat::<R, S>(simd, 2.0 * self.evasion_time)
                + splat::<R, S>(simd, self.side_preference.abs()),
            far,
            widest: far * far,
            squared: [far * far; COUNT],
        };
        add_pairs(simd, bodies, (walkers.start, runs), &mut sum);
        let mut rooms = sum.squared;
        for room in &mut rooms {
            *room = ((room.sqrt() - length) / time).max(zero);
        }
        rooms
    }
}

/// `v` turned by the angle of a unit vector.
pub fn rotated(v: Vector, by: Vector) -> Vector {
    v * by.x + perpendicular(v) * by.y
}

/// The least d² along each heading, for eight agents i.
struct Rooms<'a, R: Real, S: Simd, const MEETS: bool> {
    motions: Motions<'a, R>,
    /// −ê_i.
    backwards: [Lanes<R, S>; 2],
    /// Meters per coordinate unit.
    unit: Lanes<R, S>,
    /// −v_i along the way, and v_i to its left, m/s.
    own: [Lanes<R, S>; 2],
    /// The cosine and the sine of each φ_k.
    turned: [[Lanes<R, S>; 2]; COUNT],
    /// t, seconds.
    time: Lanes<R, S>,
    /// t_e, seconds.
    evasion: Lanes<R, S>,
    /// b, meters.
    leftward: Lanes<R, S>,
    /// −2 s_i: agents come closer at this velocity at most, m/s.
    fastest: Lanes<R, S>,
    /// 1/f, 1/m.
    per_fade: Lanes<R, S>,
    /// −w_c/f.
    edge: Lanes<R, S>,
    /// The square of the distance to which agents look, m².
    far_squared: Lanes<R, S>,
    /// How much farther away agents that come toward an agent i count, meters.
    farther: Lanes<R, S>,
    /// The distance to which agents look, meters.
    far: Lanes<R, S>,
    /// The greatest of the least d² so far, and a little more, m².
    widest: Lanes<R, S>,
    /// The least d² so far, m².
    squared: [Lanes<R, S>; COUNT],
}

impl<R: Real, S: Simd, const MEETS: bool> Rooms<'_, R, S, MEETS> {
    /// d², m², of an agent that is `along` a heading and `across` it, meters, and moves `away`, m/s.
    #[inline(always)]
    fn distance_squared(
        &self,
        simd: S,
        [along, across, away]: [Lanes<R, S>; 3],
        [evasion, shift]: [Lanes<R, S>; 2],
    ) -> Lanes<R, S> {
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let across = if MEETS { across + shift } else { across };
        let expected = away.max(zero).mul_add_precise(self.time, along);
        let expected = match MEETS {
            true => {
                let closing = away.min(zero).max(self.fastest);
                closing.mul_add_precise(evasion, expected).max(zero)
            }
            false => expected,
        };
        let aside = across.abs().mul_add_precise(self.per_fade, self.edge);
        let behind = (one - along * self.per_fade).max(zero);
        let inside = across.mul_add_precise(across, expected * expected);
        self.far_squared
            .mul_add_precise(aside.max(zero) + behind, inside)
    }
}

impl<'a, R: Real, S: Simd, const MEETS: bool> PairSum<R, S> for Rooms<'a, R, S, MEETS> {
    type Run = Motions<'a, R>;

    #[inline(always)]
    fn run(&self, run: Range<usize>) -> Motions<'a, R> {
        self.motions.run(run)
    }

    #[inline(always)]
    fn add(&mut self, simd: S, [dx, dy]: [Lanes<R, S>; 2], motions: Motions<'a, R>, j: usize) {
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let [x, y] = self.backwards;
        let (dx, dy) = (dx * self.unit, dy * self.unit);
        // d² is at least the squared distance, unless agents come toward each other: most agents of a run are farther
        // away from all eight than the rooms that these have left.
        let (mut oncoming, mut sight) = (zero, self.widest);
        if MEETS {
            let [e_x, e_y] = motions.heading(simd, j);
            let against = e_y.mul_add_precise(y, e_x * x).max(zero);
            oncoming = (against * splat::<R, S>(simd, headway::AGAINST)).min(one);
            let farther = oncoming.mul_add_precise(self.farther, self.far);
            sight = oncoming.simd_gt(zero).select(farther * farther, sight);
        }
        let squared = dy.mul_add_precise(dy, dx * dx);
        if squared.simd_lt(sight).all_false() {
            return;
        }
        // Where agent j is, and how it moves, along the way and to its left.
        let ahead = dy.mul_add_precise(y, dx * x);
        let left = dy * x - dx * y;
        let [v_x, v_y] = motions.velocity(simd, j);
        let faster = self.own[0] - v_y.mul_add_precise(y, v_x * x);
        let leftward = v_x * y - v_y * x - self.own[1];
        let evasion = self.evasion * oncoming;
        let shift = self.leftward * oncoming;
        let straight = self.distance_squared(simd, [ahead, left, faster], [evasion, shift]);
        self.squared[STRAIGHT] = self.squared[STRAIGHT].min(straight);
        let mut widest = self.squared[STRAIGHT];
        // Headings at the same angle to the left and to the right share products.
        for aside in 1..=STRAIGHT {
            let [cosine, sine] = self.turned[STRAIGHT + aside];
            let [along, across] = [ahead * cosine, left * cosine];
            let [behind, away] = [ahead * sine, faster * cosine];
            let to_left = [
                left.mul_add_precise(sine, along),
                across - behind,
                leftward.mul_add_precise(sine, away),
            ];
            let to_right = [
                left.mul_add_precise(-sine, along),
                across + behind,
                leftward.mul_add_precise(-sine, away),
            ];
            for (k, seen) in [(STRAIGHT + aside, to_left), (STRAIGHT - aside, to_right)] {
                let squared = self.distance_squared(simd, seen, [evasion, shift]);
                self.squared[k] = self.squared[k].min(squared);
                widest = widest.max(self.squared[k]);
            }
        }
        self.widest = widest * splat::<R, S>(simd, ROUNDING);
    }
}
