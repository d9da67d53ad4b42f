//! What sees what on a floor, and the lengths of shortest routes, by brute force: every straight line is tested against
//! every wall.

use std::f64::consts::{PI, TAU};

use sandbox::engine::geometry::Area;
use sandbox::engine::math::Vector;
use sandbox::engine::routes::nearest_on;

use super::plans::{Ring, contains, edges};

/// Points this near to each other are the same, meters.
const TINY: f64 = 1e-9;
/// Walls that end this near to a straight line cut it, too, as a part of their length: the ends of walls that were
/// computed as crossings are rounded.
const NEARLY: f64 = 1e-3;
/// The distance from a corner of a point that shows whether there is floor, meters.
const BESIDE: f64 = 1e-5;

/// Floor around a point where walls end, between two of its walls.
#[derive(Debug, Clone, Copy)]
pub struct Sector {
    /// The point, meters.
    pub place: Vector,
    /// The direction of the first wall, counterclockwise from which there is floor, radians.
    pub from: f64,
    /// The angle between the walls, radians.
    pub angle: f64,
}

impl Sector {
    /// The angle from the first wall to a direction, at most `TAU` less `slack`, at least −`slack`.
    pub fn angle_to(&self, way: Vector, slack: f64) -> f64 {
        let angle = (way.y.atan2(way.x) - self.from).rem_euclid(TAU);
        if angle > TAU - slack {
            angle - TAU
        } else {
            angle
        }
    }

    /// Whether there is floor in this direction; `slack` is in radians.
    fn holds(&self, way: Vector, slack: f64) -> bool {
        self.angle_to(way, slack) <= self.angle + slack
    }
}

/// A floor with all sectors at all of its corners.
pub struct Sights {
    rings: Vec<Ring>,
    walls: Vec<[Vector; 2]>,
    /// The corners, with their sectors.
    corners: Vec<(Vector, Vec<Sector>)>,
    /// The sectors of 180° and more: shortest routes bend there and nowhere else.
    pub bends: Vec<Sector>,
}

impl Sights {
    pub fn new(areas: &[Area]) -> Self {
        let rings = areas.iter().flat_map(Area::rings);
        let rings: Vec<Ring> = rings
            .map(|ring| ring.points().iter().map(|&p| p.into()).collect())
            .collect();
        let walls = rings.iter().flat_map(edges).collect();
        let mut sights = Self {
            rings,
            walls,
            corners: Vec::new(),
            bends: Vec::new(),
        };
        let mut places: Vec<Vector> = Vec::new();
        for &p in sights.rings.iter().flatten() {
            let p = Vector::from(p);
            if places.iter().all(|q| (p - q).norm() > TINY) {
                places.push(p);
            }
        }
        sights.corners = places.iter().map(|&p| (p, sights.sectors(p))).collect();
        let sectors = sights.corners.iter().flat_map(|(_, sectors)| sectors);
        sights.bends = sectors
            .filter(|sector| sector.angle > PI - 1e-6)
            .copied()
            .collect();
        sights
    }

    /// The passages narrower than `least` meters: straight lines between two points of walls that are the diameter of a
    /// circle into which no wall reaches. Tries all corners with all points of walls nearest to them.
    pub fn passages(&self, least: f64) -> Vec<[Vector; 2]> {
        let corners = || self.walls.iter().map(|wall| wall[0]);
        let ends = |p: Vector| {
            let feet = self.walls.iter().map(move |&[a, b]| nearest_on(p, a, b));
            feet.chain(corners()).map(move |end| [p, end])
        };
        let is_passage = |&[a, b]: &[Vector; 2]| {
            let (middle, radius) = (0.5 * (a + b), 0.5 * (b - a).norm());
            let is_out = |wall: &[Vector; 2]| {
                (nearest_on(middle, wall[0], wall[1]) - middle).norm() >= radius - TINY
            };
            2.0 * radius > TINY
                && 2.0 * radius < least
                && self.walls.iter().all(is_out)
                && self.is_floor(middle)
        };
        corners().flat_map(ends).filter(is_passage).collect()
    }

    /// Whether `p` is floor, by the parity of the number of walls above it.
    fn is_floor(&self, p: Vector) -> bool {
        self.rings.iter().filter(|ring| contains(ring, p)).count() % 2 == 1
    }

    fn sectors(&self, place: Vector) -> Vec<Sector> {
        let touching = self
            .walls
            .iter()
            .filter(|[a, b]| (nearest_on(place, *a, *b) - place).norm() <= TINY);
        let routes = touching
            .flatten()
            .map(|end| end - place)
            .filter(|way| way.norm() > TINY);
        let mut angles: Vec<f64> = routes.map(|way| way.y.atan2(way.x)).collect();
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|a, b| (*a - *b).abs() < TINY);
        let ends = angles
            .iter()
            .skip(1)
            .copied()
            .chain(angles.first().map(|first| first + TAU));
        let sectors = angles.iter().zip(ends).map(|(&from, to)| Sector {
            place,
            from,
            angle: to - from,
        });
        let is_floor = |sector: &Sector| {
            let (sine, cosine) = (sector.from + 0.5 * sector.angle).sin_cos();
            self.is_floor(place + Vector::new(cosine, sine) * BESIDE)
        };
        sectors.filter(is_floor).collect()
    }

    /// Whether the segment stays on the floor, walls included, without passing between two walls that touch. Tests the
    /// middles of the parts into which walls cut it.
    pub fn sees(&self, a: Vector, b: Vector) -> bool {
        let along = b - a;
        let passes = |(corner, sectors): &(Vector, Vec<Sector>)| {
            let off = along.perp(&(corner - a)).abs() / along.norm();
            let part = (corner - a).dot(&along) / along.norm();
            let is_between = part > TINY && part < along.norm() - TINY;
            let has_room =
                |sector: &Sector| sector.holds(along, 1e-6) && sector.holds(-along, 1e-6);
            off > TINY || !is_between || sectors.iter().any(has_room)
        };
        self.is_clear(a, b) && self.corners.iter().all(passes)
    }

    fn is_clear(&self, a: Vector, b: Vector) -> bool {
        let along = b - a;
        let mut cuts = vec![0.0, 1.0];
        for &[c, d] in &self.walls {
            let wall = d - c;
            let turn = along.perp(&wall);
            if turn.abs() > 1e-12 {
                let there = (c - a).perp(&along) / turn;
                if (-NEARLY..=1.0 + NEARLY).contains(&there) {
                    cuts.push((c - a).perp(&wall) / turn);
                }
            } else {
                let is_on_line = |p: &Vector| along.perp(&(p - a)).abs() < TINY * along.norm();
                let on_line = [c, d].into_iter().filter(is_on_line);
                cuts.extend(on_line.map(|p| (p - a).dot(&along) / along.norm_squared()));
            }
        }
        cuts.retain(|cut| (0.0..=1.0).contains(cut));
        cuts.sort_by(f64::total_cmp);
        let parts = cuts.windows(2).filter(|pair| pair[1] - pair[0] > TINY);
        let mut middles = parts.map(|pair| a + along * (0.5 * (pair[0] + pair[1])));
        let is_off = |p: Vector, &[c, d]: &[Vector; 2]| (nearest_on(p, c, d) - p).norm() > TINY;
        middles.all(|p| !self.walls.iter().all(|wall| is_off(p, wall)) || self.is_floor(p))
    }

    /// Whether a shortest way goes straight from `p` to a bend.
    pub fn sees_bend(&self, p: Vector, bend: &Sector) -> bool {
        bend.holds(p - bend.place, 1e-6) && self.sees(bend.place, p)
    }

    /// Whether a corner is so near to the segment that rounding decides whether it hides something.
    pub fn is_close_call(&self, a: Vector, b: Vector) -> bool {
        let near = |&(p, _): &(Vector, Vec<Sector>)| {
            let is_end = (p - a).norm() < TINY || (p - b).norm() < TINY;
            !is_end && (nearest_on(p, a, b) - p).norm() < 1e-6
        };
        self.corners.iter().any(near)
    }

    /// The length of the shortest way from each of `starts` to the segment from `a` to `b`, which is seen from end to
    /// end. By Dijkstra's algorithm over all straight routes between bends; infinite without a way.
    pub fn lengths(&self, [a, b]: [Vector; 2], starts: &[Vector]) -> Vec<f64> {
        let ends = |p: Vector| [nearest_on(p, a, b), a, b];
        let to_goal = |p: Vector, sees: &dyn Fn(Vector) -> bool| {
            let seen = ends(p).into_iter().filter(|&end| sees(end));
            seen.map(|end| (end - p).norm())
                .fold(f64::INFINITY, f64::min)
        };
        let bends = &self.bends;
        let sees = |bend: &Sector, p: Vector| self.sees_bend(p, bend);
        let mut left: Vec<usize> = (0..bends.len()).collect();
        let from_bend = |bend: &Sector| to_goal(bend.place, &|end| sees(bend, end));
        let mut lengths: Vec<f64> = bends.iter().map(from_bend).collect();
        while let Some(k) =
            (0..left.len()).min_by(|&i, &j| lengths[left[i]].total_cmp(&lengths[left[j]]))
        {
            let here = left.swap_remove(k);
            if lengths[here].is_infinite() {
                break;
            }
            for &other in &left {
                let [p, q] = [&bends[here], &bends[other]];
                let length = lengths[here] + (p.place - q.place).norm();
                if length < lengths[other] && p.holds(q.place - p.place, 1e-6) && sees(q, p.place) {
                    lengths[other] = length;
                }
            }
        }
        let from = |&p: &Vector| {
            let direct = to_goal(p, &|end| self.sees(p, end));
            let routes = bends
                .iter()
                .zip(&lengths)
                .map(|(bend, rest)| (bend, rest + (bend.place - p).norm()));
            let fold = |best: f64, (bend, length): (&Sector, f64)| {
                if length < best && sees(bend, p) {
                    length
                } else {
                    best
                }
            };
            routes.fold(direct, fold)
        };
        starts.iter().map(from).collect()
    }
}
