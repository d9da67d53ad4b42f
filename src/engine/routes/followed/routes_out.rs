//! The routes out of a room.

use super::routes::Routes;
use crate::math::Vector;
use crate::routes::paths::points;
use crate::routes::rooms::Side;

/// The shortest way from a position to a goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shortest {
    /// The side of the opening by which it leaves the room; `None`: it stays there.
    pub side: Option<Side>,
    /// Its length, meters.
    pub length: f64,
}

/// The routes out of a room that lead to a goal.
#[derive(Debug, Clone, PartialEq)]
pub struct RoutesOut {
    /// The triangle of the rooms from which they lead.
    pub triangle: u32,
    /// The number of the path map to the goal.
    pub goal: u16,
    /// The length of the way to the goal inside of the room, meters.
    pub direct: Option<f64>,
    /// The sides of openings by which routes leave, each with the length of the way to there and the distance from its
    /// end to the middle of the opening, meters.
    pub through: Vec<(Side, [f64; 2])>,
    /// The shortest of all routes to the goal, also through one-way doors against their direction.
    pub shortest: Option<Shortest>,
}

impl RoutesOut {
    /// The lengths for a side, meters, if a way leaves there.
    pub fn through(&self, side: Side) -> Option<[f64; 2]> {
        let mut through = self.through.iter();
        through.find(|way| way.0 == side).map(|way| way.1)
    }
}

impl Routes {
    /// The routes to the goal of path map `map` from `p`, in triangle `t` of the rooms; `None` without rooms. If they
    /// are known, `others` are the routes from `p` to another goal, and `length` is that of the shortest way, meters.
    pub fn routes_out(
        &self,
        (p, t): (Vector, u32),
        map: u16,
        others: Option<&RoutesOut>,
        length: Option<f64>,
    ) -> Option<RoutesOut> {
        let (rooms, goal) = (self.rooms.as_ref()?, usize::from(map));
        let at = rooms.floor.in_building(p);
        let sides = rooms.sides_in(rooms.room(t)).iter();
        let sides = sides.filter(|&&side| rooms.length_from(side, goal).is_finite());
        let through = sides.filter_map(|&side| {
            let known = others.and_then(|others| others.through(side));
            Some((side, known.or_else(|| rooms.lengths_to(at, t, side))?))
        });
        let through: Vec<_> = through.collect();
        let direct = rooms.length_to_goal(at, t, goal);
        let only = match through[..] {
            [(only, _)] if direct.is_none() && !rooms.has_one_way() => Some(only),
            _ => None,
        };
        let shortest = match length.filter(|_| only.is_some()) {
            Some(length) => Some(Shortest { side: only, length }),
            None => self.shortest_out((p, t), goal, only),
        };
        Some(RoutesOut {
            triangle: t,
            goal: map,
            direct,
            through,
            shortest,
        })
    }

    /// The shortest way from `p`, in triangle `t` of the rooms; all routes leave the room by the side `only`, if that
    /// is known.
    fn shortest_out(
        &self,
        (p, t): (Vector, u32),
        goal: usize,
        only: Option<Side>,
    ) -> Option<Shortest> {
        let here = self.floor.locate_or_nearest(self.beneath[t as usize], p)?;
        let map = &self.maps[goal];
        let at = self.floor.in_building(p);
        let way = map.way(&self.floor, at, here, None)?;
        let first = || {
            let points = points(&self.floor, map, way.next);
            self.rooms.as_ref()?.first_crossing(at, t, points)
        };
        Some(Shortest {
            side: only.or_else(|| first().map(|first| first.side)),
            length: way.length,
        })
    }
}
