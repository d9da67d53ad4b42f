//! The longest queues before passages, from positions and speeds over time and the plan alone, as
//! docs/reference/measurements.md defines them. It shares no code with the program: no mesh, no path maps, no index.

use std::collections::{BTreeMap, BTreeSet};

pub type Point = [f64; 2];

/// Rounding, meters.
const TINY: f64 = 1e-7;
const WIDEST: f64 = 6.0;
const GAP: f64 = 3.0;
/// Lines of places are shortened by this at both ends.
const MARGIN: f64 = 0.01;

/// A plan: the outline of the floor and its obstacles, and lines with names.
pub struct Plan {
    pub floor: Vec<Point>,
    pub obstacles: Vec<Vec<Point>>,
    pub doors: Vec<(String, [Point; 2])>,
}

/// A person at one time: where, whether it is slow, and the line that it walks to.
pub struct Person {
    pub at: Point,
    pub is_slow: bool,
    pub to: (String, [Point; 2]),
}

/// An opening: its name, whether it is a declared door, its ends.
pub type Opening = (String, bool, [Point; 2]);

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn far(a: Point, b: Point) -> f64 {
    minus(a, b)[0].hypot(minus(a, b)[1])
}

fn middle([a, b]: [Point; 2]) -> Point {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}

fn nearest(p: Point, [a, b]: [Point; 2]) -> Point {
    let along = minus(b, a);
    let part = (dot(minus(p, a), along) / dot(along, along)).clamp(0.0, 1.0);
    [a[0] + part * along[0], a[1] + part * along[1]]
}

impl Plan {
    fn walls(&self) -> Vec<[Point; 2]> {
        let rings = self.obstacles.iter().chain([&self.floor]);
        let sides = |ring: &Vec<Point>| {
            let next = ring.iter().cycle().skip(1);
            ring.iter()
                .zip(next)
                .map(|(&a, &b)| [a, b])
                .collect::<Vec<_>>()
        };
        rings.flat_map(sides).collect()
    }

    fn is_inside(ring: &[Point], p: Point) -> bool {
        let mut odd = false;
        for k in 0..ring.len() {
            let (a, b) = (ring[k], ring[(k + 1) % ring.len()]);
            if (a[1] > p[1]) != (b[1] > p[1]) {
                let x = a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                odd ^= p[0] < x;
            }
        }
        odd
    }

    /// Whether a point is on the floor or on its edge.
    fn has(&self, p: Point) -> bool {
        let on_edge = self
            .walls()
            .iter()
            .any(|&wall| far(p, nearest(p, wall)) < TINY);
        let mut obstacles = self.obstacles.iter();
        on_edge
            || Self::is_inside(&self.floor, p) && !obstacles.any(|ring| Self::is_inside(ring, p))
    }

    /// Whether a straight way leads from `a` to `b`.
    fn sees(&self, a: Point, b: Point) -> bool {
        let way = minus(b, a);
        let length = far(a, b);
        if length < TINY {
            return true;
        }
        // Where walls cut the way; between two cuts it is inside or outside.
        let mut cuts = vec![0.0, 1.0];
        for [c, d] in self.walls() {
            let wall = minus(d, c);
            let across = cross(way, wall);
            if across.abs() < 1e-12 * length * far(c, d) {
                continue;
            }
            let part = cross(minus(c, a), wall) / across;
            let place = cross(minus(c, a), way) / across;
            let slack = TINY / far(c, d);
            if (0.0..=1.0).contains(&part) && (-slack..=1.0 + slack).contains(&place) {
                cuts.push(part);
            }
        }
        cuts.sort_by(f64::total_cmp);
        cuts.windows(2).all(|pair| {
            let part = 0.5 * (pair[0] + pair[1]);
            (pair[1] - pair[0]) * length < 10.0 * TINY
                || self.has([a[0] + part * way[0], a[1] + part * way[1]])
        })
    }

    /// The doors, and the narrow places that are openings.
    pub fn openings(&self) -> Vec<Opening> {
        let walls = self.walls();
        let corners: Vec<Point> = walls.iter().map(|wall| wall[0]).collect();
        let mut narrow: Vec<[Point; 2]> = Vec::new();
        for (k, &a) in corners.iter().enumerate() {
            let others = corners[k + 1..].iter().copied();
            let feet = walls.iter().map(|&wall| (nearest(a, wall), wall));
            let feet = feet.filter(|(foot, [c, d])| far(*foot, *c) > TINY && far(*foot, *d) > TINY);
            let ends: Vec<Point> = others.chain(feet.map(|(foot, _)| foot)).collect();
            for b in ends {
                let width = far(a, b);
                if !(TINY..=WIDEST - 1e-6).contains(&width) || !self.has(middle([a, b])) {
                    continue;
                }
                let is_free = walls.iter().all(|&wall| {
                    let touched = wall.into_iter().chain([nearest(a, wall), nearest(b, wall)]);
                    let ends = [a, b].map(|end| far(end, nearest(end, wall)) < TINY);
                    match ends {
                        [false, false] => {
                            far(middle([a, b]), nearest(middle([a, b]), wall)) > 0.5 * width
                        }
                        // A wall at an end leads away from the circle.
                        _ => touched.into_iter().all(|p| {
                            let [from, to] = if ends[0] { [a, b] } else { [b, a] };
                            dot(minus(p, from), minus(to, from)) <= TINY
                        }),
                    }
                });
                if is_free {
                    narrow.push([a, b]);
                }
            }
        }
        let order = |&ends: &[Point; 2]| {
            let at = middle(ends);
            [far(ends[0], ends[1]), at[0], at[1]].map(|x| (1e6 * x).round() as i64)
        };
        narrow.sort_by_key(order);
        let door = |(name, ends): &(String, [Point; 2])| (name.clone(), true, *ends);
        let mut kept: Vec<Opening> = self.doors.iter().map(door).collect();
        for &ends in &narrow {
            let width = far(ends[0], ends[1]);
            let is_near = |(_, _, other): &Opening| {
                far(middle(ends), middle(*other)) < width.min(far(other[0], other[1]))
            };
            // Only the narrowest one at a corner.
            let is_wider = narrow.iter().any(|other| {
                let meet = |a: Point| other.iter().any(|&b| far(a, b) < TINY);
                far(other[0], other[1]) < width - 1e-6 && ends.into_iter().any(meet)
            });
            if !is_wider && !kept.iter().any(is_near) {
                let [x, y] = middle(ends).map(|x| (100.0 * x).round() / 100.0);
                kept.push((format!("the opening at ({x}, {y})"), false, ends));
            }
        }
        kept
    }

    /// The points of the shortest way from `p` to a line: Dijkstra's algorithm over all corners.
    fn way(&self, p: Point, [a, b]: [Point; 2]) -> Vec<Point> {
        let short = MARGIN / far(a, b);
        let at = |part: f64| [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])];
        let line = [at(short), at(1.0 - short)];
        let mut points = vec![p];
        points.extend(self.walls().iter().map(|wall| wall[0]));
        let end = |from: Point| {
            let ends = [nearest(from, line), line[0], line[1]];
            let seen = ends.into_iter().filter(|&end| self.sees(from, end));
            seen.min_by(|&x, &y| far(from, x).total_cmp(&far(from, y)))
        };
        let mut best: Vec<(f64, Option<usize>)> = vec![(f64::INFINITY, None); points.len()];
        best[0].0 = 0.0;
        let mut open: BTreeSet<usize> = (0..points.len()).collect();
        let mut found: Option<(f64, Vec<Point>)> = None;
        while let Some(&here) = open
            .iter()
            .min_by(|&&x, &&y| best[x].0.total_cmp(&best[y].0))
        {
            open.remove(&here);
            let so_far = best[here].0;
            if found.as_ref().is_some_and(|(least, _)| so_far >= *least) || so_far.is_infinite() {
                break;
            }
            if let Some(end) = end(points[here]) {
                let length = so_far + far(points[here], end);
                if found.as_ref().is_none_or(|(least, _)| length < *least) {
                    let mut way = vec![end];
                    let mut back = Some(here);
                    while let Some(k) = back {
                        way.push(points[k]);
                        back = best[k].1;
                    }
                    way.reverse();
                    found = Some((length, way));
                }
            }
            for &next in &open {
                let length = so_far + far(points[here], points[next]);
                if length < best[next].0 && self.sees(points[here], points[next]) {
                    best[next] = (length, Some(here));
                }
            }
        }
        found.unwrap().1
    }

    /// The queues at one time: the largest number of people by passage, without openings that are only on the way to
    /// another queue.
    pub fn queues(&self, openings: &[Opening], people: &[Person]) -> BTreeMap<String, u32> {
        // By passage: the distances of those who wait, with the person.
        let mut waiting: BTreeMap<String, Vec<(f64, usize)>> = BTreeMap::new();
        let mut ahead: Vec<Vec<(String, f64)>> = Vec::new();
        for (k, person) in people.iter().enumerate() {
            let mut passages = Vec::new();
            if person.is_slow {
                let way = self.way(person.at, person.to.1);
                for (name, _, ends) in openings {
                    passages.extend(crossing(&way, *ends).map(|distance| (name.clone(), distance)));
                }
                passages.sort_by(|a, b| a.1.total_cmp(&b.1)); // stable: doors and narrow ones first
                let length = way.windows(2).map(|pair| far(pair[0], pair[1])).sum();
                passages.push((person.to.0.clone(), length));
            }
            for (name, distance) in &passages {
                waiting
                    .entry(name.clone())
                    .or_default()
                    .push((*distance, k));
            }
            ahead.push(passages);
        }
        let queue = |all: &mut Vec<(f64, usize)>| {
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut before = 0.0;
            let last = all.iter().position(|&(distance, _)| {
                let is_gap = distance - before > GAP;
                before = distance;
                is_gap
            });
            all.truncate(last.unwrap_or(all.len()));
        };
        waiting.values_mut().for_each(queue);
        let is_listed = |name: &String, all: &[(f64, usize)]| {
            let opening = openings.iter().position(|(other, ..)| other == name);
            let Some(opening) = opening.filter(|&k| !openings[k].1) else {
                return true;
            };
            let mut further = ahead[all[0].1].iter().filter(|(other, _)| {
                let number = openings.iter().position(|(one, ..)| one == other);
                number.is_none_or(|number| number < opening)
            });
            !further.any(|(other, away)| {
                waiting[other]
                    .last()
                    .is_some_and(|(reach, _)| away <= reach)
            })
        };
        let listed = waiting
            .iter()
            .filter(|(name, all)| all.len() > 1 && is_listed(name, all));
        listed
            .map(|(name, all)| (name.clone(), all.len() as u32))
            .collect()
    }
}

/// How far along a way it crosses an opening.
fn crossing(way: &[Point], [c, d]: [Point; 2]) -> Option<f64> {
    let mut before = 0.0;
    for pair in way.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let (move_, line) = (minus(b, a), minus(d, c));
        let across = cross(move_, line);
        let part = cross(minus(c, a), line) / across;
        let place = cross(minus(c, a), move_) / across;
        let [at_way, at_line] = [1e-6 / far(a, b), 1e-6 / far(c, d)];
        if (-at_way..=1.0 + at_way).contains(&part) && (-at_line..=1.0 + at_line).contains(&place) {
            return Some(before + part.clamp(0.0, 1.0) * far(a, b));
        }
        before += far(a, b);
    }
    None
}
