//! Floors behind the lines of exits and entrances on the edge of the walkable area.

use engine::geometry::Area;
use engine::math::{Vector, direction, perpendicular};
use engine::simulation::{BEFORE_WALLS, WALKS_ON};

/// People need this much room behind the line of an exit to cross it, meters.
const ROOM_BEHIND: f64 = 0.5;
/// The line of an exit or entrance, and the length of the floor behind it, meters.
pub type Door = ([Vector; 2], f64);

/// The floor behind the line of an exit on the edge of the walkable area is this long, meters: the bodies of those who
/// have left walk on there. The floor behind an entrance ends at [`WIDE_AT`].
pub const BEHIND: f64 = WALKS_ON + BEFORE_WALLS;
/// A floor that lies this near at its side, meters, is right beside it.
const BESIDE: f64 = 0.01;
/// Another room that is this near behind a line, meters, is next door: the line lies in a door between both. Walls of
/// buildings are not thicker.
const NEXT_DOOR: f64 = 0.6;
/// Where another room lies farther behind, the floor ends this far before it, meters: no way leads through the wall
/// between.
const BEFORE_ROOMS: f64 = 0.5;
/// The same before rooms nearer than [`WIDE_AT`].
const BEFORE_NEAR_ROOMS: f64 = 0.1;
/// Rooms nearer than [`WIDE_AT`] are looked for at these parts of the line, and not at its ends, beside which the floor
/// of its own room may go on.
const PARTS: [f64; 3] = [0.1, 0.5, 0.9];
/// That floor begins this far before the line, meters, so that rounding leaves no gap between.
pub const OVERLAP: f64 = 0.01;

/// That floor widens by this on both sides, meters, or less where something else is near: RVO stops in front of a dead
/// end as wide as a door.
const WIDENS: [f64; 3] = [3.0, 2.0, 1.0];
/// It has widened this far behind the line, meters.
pub const WIDE_AT: f64 = 3.0;
/// Where another floor lies right beside it, it narrows by the first of these on both sides, meters, that leaves a wall
/// between.
const NARROWS: [f64; 3] = [0.1, 0.3, 0.6];
/// It is not narrower than this, meters.
const NARROWEST: f64 = 0.4;
/// It has narrowed this far behind the line, meters.
const NARROW_AT: f64 = 0.5;

/// The floor behind the line of an exit or entrance on the edge of the walkable area.
pub struct Opening {
    /// The ends of the line, meters.
    ends: [Vector; 2],
    /// The direction from the first end to the second, and out of the area.
    directions: [Vector; 2],
    /// The room that the line has before the edge of the area, meters.
    before: f64,
    /// Meters.
    depth: f64,
    /// It is wider by this on both sides from [`WIDE_AT`] on, meters.
    widens: f64,
}

/// The floors behind the lines of exits and entrances that lie on the edge of the walkable area. They end before other
/// rooms, unless these are next door; the floors of two lines do not touch unless their lines are that near.
pub fn openings(walkable: &[Area], doors: &[Door]) -> Vec<Opening> {
    let is_floor = |p: Vector| walkable.iter().any(|area| area.contains(p));
    let opening = |&door: &Door| Opening::of(&is_floor, door);
    let openings: Vec<Opening> = doors.iter().filter_map(opening).collect();
    let widest = |opening: &Opening| {
        let is_taken = |p: Vector, widens: f64| {
            let mut others = openings.iter().filter(|other| !other.is_at(opening.ends));
            is_floor(p) || others.any(|other| other.widened(widens).contains(p))
        };
        let wide = WIDENS.into_iter().map(|widens| opening.widened(widens));
        let ends_at_floor = |wide: &Opening| !wide.is_next_door() && wide.across(1.0).any(is_floor);
        let mut free = wide.filter(|wide| {
            !wide.places().any(|p| is_taken(p, wide.widens)) && !ends_at_floor(wide)
        });
        free.next().unwrap_or_else(|| opening.apart(&is_floor))
    };
    openings.iter().map(widest).collect()
}

impl Opening {
    /// `None` if there is room to cross the line, or none on both sides.
    fn of(is_floor: &impl Fn(Vector) -> bool, ([a, b], reach): Door) -> Option<Self> {
        const STEPS: u32 = 300;
        let room_at = |part: f64, way: Vector, length: f64| {
            let start = a + (b - a) * part;
            let steps = (1..=STEPS).map(|k| length * f64::from(k) / f64::from(STEPS));
            let mut places = steps.map(|step| (step, is_floor(start + way * step)));
            places.find(|(_, is_floor)| !is_floor).map(|(step, _)| step)
        };
        let room = |way: Vector, length: f64| room_at(0.5, way, length);
        let along = direction(b - a);
        let normal = perpendicular(along);
        let out = [normal, -normal]
            .into_iter()
            .find(|way| room(*way, ROOM_BEHIND).is_some())?;
        if room(-out, ROOM_BEHIND).is_some() {
            return None; // walls on both sides: the line is not at a floor, which is refused later
        }
        let wall = room(out, ROOM_BEHIND)?;
        let steps = (1..=STEPS).map(|k| wall + (reach - wall) * f64::from(k) / f64::from(STEPS));
        let is_room = |step: &f64| {
            let ends = [0.0, 1.0].into_iter().filter(|_| *step > WIDE_AT);
            let mut parts = ends.chain(PARTS);
            parts.any(|part| is_floor(a + (b - a) * part + out * *step))
        };
        let room = steps.into_iter().find(is_room);
        let depth = room.map_or(reach, |step| match step {
            _ if step <= NEXT_DOOR => step,
            _ if step <= WIDE_AT => step - BEFORE_NEAR_ROOMS,
            _ => step - BEFORE_ROOMS,
        });
        let free = PARTS.map(|part| room_at(part, out, wall).unwrap_or(wall));
        let before = free.into_iter().fold(wall, f64::min) - ROOM_BEHIND / f64::from(STEPS);
        Some(Self {
            ends: [a, b],
            directions: [along, out],
            before: before.max(0.0),
            depth,
            widens: 0.0,
        })
    }

    /// As wide as the line, or narrower where another floor lies right beside it.
    fn apart(&self, is_floor: &impl Fn(Vector) -> bool) -> Self {
        let straight = self.widened(0.0);
        if !straight.touches(is_floor) {
            return straight;
        }
        let width = (self.ends[1] - self.ends[0]).norm();
        let wide = |narrows: &f64| width - 2.0 * narrows >= NARROWEST;
        let mut narrow = NARROWS
            .into_iter()
            .filter(wide)
            .map(|narrows| self.widened(-narrows));
        let apart = narrow.find(|narrow| !narrow.touches(is_floor));
        apart.unwrap_or(straight)
    }

    /// Whether another floor lies at its sides, where it is as wide as it gets.
    fn touches(&self, is_floor: &impl Fn(Vector) -> bool) -> bool {
        const STEPS: u32 = 100;
        let [along, _] = self.directions;
        let first = NARROW_AT.max(self.before);
        let steps =
            (0..STEPS).map(|k| first + (self.depth - first) * f64::from(k) / f64::from(STEPS));
        !self.is_next_door()
            && steps.into_iter().any(|step| {
                let sides = [(0.0, -along), (1.0, along)];
                let beside = |(across, away): (f64, Vector)| {
                    is_floor(self.place(step, across) + away * BESIDE)
                };
                sides.into_iter().any(beside)
            })
    }

    fn widened(&self, widens: f64) -> Self {
        Self { widens, ..*self }
    }

    /// Whether it is behind this line.
    fn is_at(&self, [a, b]: [Vector; 2]) -> bool {
        self.ends == [a, b] || self.ends == [b, a]
    }

    /// How much wider it is on each side `step` meters behind the line, meters.
    fn aside(&self, step: f64) -> f64 {
        self.widens * (step / self.bends_at()).clamp(0.0, 1.0)
    }

    /// It gets no wider or narrower from this far behind the line on, meters.
    fn bends_at(&self) -> f64 {
        match self.widens < 0.0 {
            true => NARROW_AT,
            false => WIDE_AT,
        }
    }

    /// The place `step` meters behind the line; `across` is 0 on one side and 1 on the other.
    fn place(&self, step: f64, across: f64) -> Vector {
        let ([a, b], [along, out]) = (self.ends, self.directions);
        let aside = along * self.aside(step);
        let (a, b) = (a - aside, b + aside);
        a + (b - a) * across + out * step
    }

    /// Places all over it before its end, some decimeters apart.
    fn places(&self) -> impl Iterator<Item = Vector> {
        const STEPS: u32 = 24;
        let parts = (1..STEPS).map(|k| f64::from(k) / f64::from(STEPS));
        parts.flat_map(|part| self.across(part))
    }

    /// Places on the line across it at a part of its depth.
    fn across(&self, part: f64) -> impl Iterator<Item = Vector> {
        const STEPS: u32 = 24;
        let step = self.depth * part;
        (0..=STEPS).map(move |k| self.place(step, f64::from(k) / f64::from(STEPS)))
    }

    /// Whether it leads to the room behind a wall.
    fn is_next_door(&self) -> bool {
        self.depth <= NEXT_DOOR
    }

    fn contains(&self, p: Vector) -> bool {
        let (way, [along, out]) = (p - self.ends[0], self.directions);
        let (step, across) = (way.dot(&out), way.dot(&along));
        let aside = self.aside(step);
        let width = (self.ends[1] - self.ends[0]).norm();
        (0.0..=self.depth).contains(&step) && (-aside..=width + aside).contains(&across)
    }

    /// The floor behind the edge of the area, counterclockwise.
    pub fn outline(&self) -> Vec<Vector> {
        let ring = self.ring(self.before);
        let mut outline: Vec<Vector> = ring.into_iter().map(Vector::from).collect();
        let [along, out] = self.directions;
        // The floor begins to widen where it begins, before the edge.
        let end = self.depth.min(self.bends_at());
        let part = (self.before + OVERLAP) / (end + OVERLAP);
        let aside = self.aside(end) * part - self.aside(self.before);
        if let [first, .., last] = &mut outline[..] {
            (*first, *last) = (*first + along * aside, *last - along * aside);
        }
        if along.perp(&out) < 0.0 {
            outline.reverse();
        }
        outline
    }

    /// The corners, from `first` meters behind the line.
    pub fn ring(&self, first: f64) -> Vec<[f64; 2]> {
        let bend = self.bends_at();
        let ends = [
            Some(first),
            (self.depth > bend).then_some(bend),
            Some(self.depth),
        ];
        let steps = ends.into_iter().flatten();
        let there = steps.clone().map(|step| self.place(step, 1.0));
        let back = steps.rev().map(|step| self.place(step, 0.0));
        there.chain(back).map(Into::into).collect()
    }
}
