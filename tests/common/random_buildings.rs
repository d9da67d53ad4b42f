//! Random buildings: storeys of several shapes above each other, joined by straight, folded, stacked, scissor and
//! crossing stairs, with mezzanines and columns.
//!
//! Another kind of way between two storeys is another variant of [`Link`] and an arm in [`Draft::link`]. Lifts have
//! random buildings of their own (`building_lifts.rs`).

use nalgebra::Rotation2;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;
use serde_json::{Value, json};

use super::plans::{Ring, contains, edges, margin};
use super::random_stairs::{Frame, Link, Place, Stairs, rectangle};
use super::vector;

/// The least distance of stairs and columns on a floor from each other and from walls, meters.
const APART: f64 = 1.3;
/// The least distance of people at the start from walls and from each other, meters.
const FREE: f64 = 0.5;
const BETWEEN: f64 = 0.8;
/// How often a place is looked for.
const TRIES: usize = 60;

/// A floor, a landing or a flight of stairs.
#[derive(Debug, Clone)]
pub struct Level {
    pub name: String,
    /// The outline, then the holes, at their places in the building, meters.
    pub rings: Vec<Ring>,
    /// A point, its height, and by how much the level rises per meter along x and y.
    pub at: Vector,
    pub elevation: f64,
    pub rise: Vector,
}

/// A building.
#[derive(Debug, Clone, Default)]
pub struct Building {
    pub levels: Vec<Level>,
    /// The lines of joins and the numbers of their levels.
    pub joins: Vec<([Vector; 2], [usize; 2])>,
    /// The lines of exits and the numbers of their levels.
    pub exits: Vec<([Vector; 2], usize)>,
    /// The people at the start.
    pub people: Vec<(usize, Vector)>,
    pub profile: &'static str,
}

impl Level {
    /// The height at a place, meters.
    pub fn height(&self, p: Vector) -> f64 {
        self.elevation + self.rise.dot(&(p - self.at))
    }

    fn is_flat(&self) -> bool {
        self.rise == Vector::zeros()
    }

    /// Whether `p` lies on it, at least `gap` meters from its edges.
    pub fn is_free(&self, p: Vector, gap: f64) -> bool {
        let is_in = |ring: &Ring| contains(ring, p);
        let holes = &self.rings[1..];
        is_in(&self.rings[0]) && !holes.iter().any(is_in) && margin(&self.rings, p) >= gap
    }
}

impl Building {
    /// A valid building of two to five storeys.
    pub fn random(rng: &mut ChaCha8Rng) -> Self {
        std::iter::repeat_with(|| Draft::random(rng))
            .find_map(|draft| draft)
            .unwrap()
    }

    /// Its scenario.
    pub fn document(&self) -> Value {
        let levels = self.levels.iter().map(|level| {
            let area = json!([level.rings]);
            match level.is_flat() {
                true => {
                    json!({"name": level.name, "elevation": level.elevation, "walkable_area": area})
                }
                false => json!({"name": level.name, "kind": "stairs", "walkable_area": area}),
            }
        });
        let name = |level: usize| &self.levels[level].name;
        let points = |line: &[Vector; 2]| line.map(<[f64; 2]>::from);
        let joins = self.joins.iter().map(
            |(line, [from, to])| json!({"levels": [name(*from), name(*to)], "line": points(line)}),
        );
        let exits = self.exits.iter().enumerate().map(|(k, (line, level))| {
            json!({"name": format!("exit {k}"), "level": name(*level), "line": points(line)})
        });
        let people = self
            .people
            .iter()
            .map(|(level, p)| json!({"level": name(*level), "position": [p.x, p.y]}));
        json!({
            "profile": self.profile,
            "duration_secs": 400,
            "levels": levels.collect::<Vec<_>>(),
            "joins": joins.collect::<Vec<_>>(),
            "exits": exits.collect::<Vec<_>>(),
            "agents": people.collect::<Vec<_>>(),
            "stop": {"when_empty": true},
        })
    }

    /// The number of joins between level `from` and each level; `usize::MAX` where no way leads.
    pub fn joins_from(&self, from: usize) -> Vec<usize> {
        let mut counts = vec![usize::MAX; self.levels.len()];
        counts[from] = 0;
        for _ in 0..self.levels.len() {
            for &(_, [a, b]) in &self.joins {
                for (a, b) in [(a, b), (b, a)] {
                    counts[b] = counts[b].min(counts[a].saturating_add(1));
                }
            }
        }
        counts
    }

    fn add(&mut self, level: Level) -> usize {
        self.levels.push(level);
        self.levels.len() - 1
    }

    fn flat(&mut self, name: String, ring: Ring, elevation: f64) -> usize {
        self.add(Level {
            name,
            rings: vec![ring],
            at: Vector::zeros(),
            elevation,
            rise: Vector::zeros(),
        })
    }

    /// Adds a flight from the level `from` up to the level `to` between two lines.
    fn flight(&mut self, [lower, upper]: [[Vector; 2]; 2], [from, to]: [usize; 2]) {
        let [a, b] = [lower, upper].map(|[a, b]| (a + b) / 2.0);
        let [low, high] = [from, to].map(|level| self.levels[level].elevation);
        let ring = [lower[0], upper[0], upper[1], lower[1]].map(<[f64; 2]>::from);
        let number = self.add(Level {
            name: format!("flight {}", self.levels.len()),
            rings: vec![ring.to_vec()],
            at: a,
            elevation: low,
            rise: (b - a) * ((high - low) / (b - a).norm_squared()),
        });
        self.joins.push((lower, [from, number]));
        self.joins.push((upper, [number, to]));
    }

    /// Turns and moves everything.
    fn moved(mut self, angle: f64, shift: Vector) -> Self {
        let turn = Rotation2::new(angle);
        let place = |p: &mut Vector| *p = turn * *p + shift;
        for level in &mut self.levels {
            for p in level.rings.iter_mut().flatten() {
                *p = (turn * Vector::from(*p) + shift).into();
            }
            place(&mut level.at);
            level.rise = turn * level.rise;
        }
        self.joins
            .iter_mut()
            .flat_map(|(line, _)| line)
            .for_each(place);
        self.exits
            .iter_mut()
            .flat_map(|(line, _)| line)
            .for_each(place);
        self.people.iter_mut().for_each(|(_, p)| place(p));
        self
    }
}

/// A building that is being drawn, along the axes.
struct Draft<'a> {
    rng: &'a mut ChaCha8Rng,
    building: Building,
    /// The number of the floor of each storey.
    floors: Vec<usize>,
}

impl Draft<'_> {
    /// `None` if there is no room for stairs.
    fn random(rng: &mut ChaCha8Rng) -> Option<Building> {
        let mut draft = Draft {
            rng,
            building: Building::default(),
            floors: Vec::new(),
        };
        draft.storeys();
        let mut last = None;
        for k in 1..draft.floors.len() {
            last = draft.stairs(k, last)?;
        }
        draft.mezzanines();
        draft.columns();
        draft.exits();
        draft.people();
        let rng = draft.rng;
        let profiles = ["sph", "sf->sph", "steer+sph", "rvo->sph"];
        draft.building.profile = profiles[rng.random_range(0..profiles.len())];
        let angle = [0.0, rng.random_range(0.0..6.3)][rng.random_range(0..2)];
        let shift = vector(rng.random_range(-50.0..50.0), rng.random_range(-50.0..50.0));
        Some(draft.building.moved(angle, shift))
    }

    /// Floors above each other, some of them L-shaped.
    fn storeys(&mut self) {
        let rng = &mut *self.rng;
        let mut elevation = rng.random_range(-6.0..3.0);
        for k in 0..rng.random_range(2..=5) {
            let mut side = |most: f64| rng.random_range(0.0..most);
            let (x0, y0) = (side(4.0), side(4.0));
            let (x1, y1) = (20.0 + side(6.0), 15.0 + side(5.0));
            let (x, y) = (
                x0 + (x1 - x0) * (0.5 + side(0.3)),
                y0 + (y1 - y0) * (0.5 + side(0.3)),
            );
            let ring = match side(3.0) as u32 {
                0 => vec![[x0, y0], [x1, y0], [x1, y], [x, y], [x, y1], [x0, y1]],
                _ => rectangle([[x0, x1], [y0, y1]]),
            };
            let floor = self.building.flat(format!("floor {k}"), ring, elevation);
            self.floors.push(floor);
            elevation += rng.random_range(2.6..3.8);
        }
    }

    /// Joins the storeys `k − 1` and `k`; `last` is the place of folded stairs up to the first of them, on which
    /// others may be stacked. Returns the place of folded stairs.
    fn stairs(&mut self, k: usize, last: Option<Place>) -> Option<Option<Place>> {
        let between = [k - 1, k].map(|k| self.floors[k]);
        let stacked = last.filter(|_| self.rng.random_bool(0.6));
        let stacked = stacked.and_then(|place| self.stack(place, between));
        let mut folded = stacked;
        if stacked.is_none() {
            let (link, place) = self.place(between)?;
            folded = Some(place).filter(|_| matches!(link, Link::Folded));
        }
        if self.rng.random_bool(0.35) {
            self.place(between);
        }
        Some(folded)
    }

    /// Folded stairs above others, from the hole in the lower floor.
    fn stack(&mut self, place: Place, [lower, upper]: [usize; 2]) -> Option<Place> {
        let ring = place.ring(Link::Folded);
        let has_room = self.has_room(upper, &ring);
        has_room.then(|| {
            self.building.levels[upper].rings.push(ring);
            self.link(Link::Folded, place, [lower, upper]);
            place
        })
    }

    fn place(&mut self, [lower, upper]: [usize; 2]) -> Option<(Link, Place)> {
        let [low, high] = [lower, upper].map(|level| self.building.levels[level].elevation);
        let links = [
            Link::Straight,
            Link::Folded,
            Link::Folded,
            Link::Scissor,
            Link::Crossing,
        ];
        for _ in 0..TRIES {
            let link = links[self.rng.random_range(0..links.len())];
            let place = Place::random(self.rng, high - low);
            let ring = place.ring(link);
            if [lower, upper]
                .iter()
                .all(|&level| self.has_room(level, &ring))
            {
                for level in [lower, upper] {
                    self.building.levels[level].rings.push(ring.clone());
                }
                self.link(link, place, [lower, upper]);
                return Some((link, place));
            }
        }
        None
    }

    /// Whether there is room for a hole in a level.
    fn has_room(&self, level: usize, ring: &Ring) -> bool {
        let level = &self.building.levels[level];
        let apart = |hole: &Ring| {
            let own = std::slice::from_ref(hole);
            let corners = ring
                .iter()
                .all(|&p| margin(own, p.into()) >= APART && !contains(hole, p.into()));
            let others = std::slice::from_ref(ring);
            corners
                && hole
                    .iter()
                    .all(|&p| margin(others, p.into()) >= APART && !contains(ring, p.into()))
        };
        let crosses = |hole: &Ring| {
            edges(hole).any(|[a, b]| {
                edges(ring).any(|[c, d]| {
                    let side = |a: Vector, b: Vector, p: Vector| (b - a).perp(&(p - a));
                    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
                })
            })
        };
        let is_inside = ring.iter().all(|&p| level.is_free(p.into(), APART));
        let outline = &level.rings[0];
        let is_near = outline
            .iter()
            .any(|&p| margin(std::slice::from_ref(ring), p.into()) < APART);
        is_inside
            && !is_near
            && !crosses(outline)
            && level.rings[1..]
                .iter()
                .all(|hole| apart(hole) && !crosses(hole))
    }

    /// Adds the flights of stairs in a shaft.
    fn link(&mut self, link: Link, Place { frame, stairs }: Place, [lower, upper]: [usize; 2]) {
        let building = &mut self.building;
        let (w, far, length) = (stairs.width, stairs.width + stairs.well, stairs.length);
        match link {
            Link::Straight => {
                let ends = [0.0, length].map(|u| frame.line(u, [0.0, w]));
                building.flight(ends, [lower, upper]);
            }
            Link::Scissor => {
                let ends = [0.0, length].map(|u| frame.line(u, [0.0, w]));
                let beside = [length, 0.0].map(|u| frame.line(u, [w, 2.0 * w]));
                building.flight(ends, [lower, upper]);
                building.flight(beside, [lower, upper]);
            }
            Link::Crossing => {
                let [from, to] = [0.5 * (length - w), 0.5 * (length + w)];
                let along = [0.0, length].map(|u| frame.line(u, [from, to]));
                let across = [0.0, length].map(|v| [frame.at(from, v), frame.at(to, v)]);
                building.flight(along, [lower, upper]);
                building.flight(across, [lower, upper]);
            }
            Link::Folded => {
                let length = 0.5 * length;
                let middle = [lower, upper].map(|level| 0.5 * building.levels[level].elevation);
                let ring = frame.ring([[length, length + stairs.landing], [0.0, far + w]]);
                let name = format!("landing {}", building.levels.len());
                let landing = building.flat(name, ring, middle.iter().sum());
                let up = [0.0, length].map(|u| frame.line(u, [0.0, w]));
                let back = [length, 0.0].map(|u| frame.line(u, [far, far + w]));
                building.flight(up, [lower, landing]);
                building.flight(back, [landing, upper]);
            }
        }
    }

    /// Small floors at about half height inside of halls, each with a flight of its own.
    fn mezzanines(&mut self) {
        for k in 0..self.floors.len() {
            if !self.rng.random_bool(0.3) {
                continue;
            }
            let lower = self.floors[k];
            let height = self.rng.random_range(1.1..1.9);
            let found = (0..TRIES).find_map(|_| {
                let place = Place::random(self.rng, height);
                let ring = place.ring(Link::Straight);
                self.has_room(lower, &ring).then_some((place, ring))
            });
            let Some((place, ring)) = found else {
                continue;
            };
            self.building.levels[lower].rings.push(ring);
            let Stairs { width, length, .. } = place.stairs;
            let mut more = |least: f64| self.rng.random_range(least..least + 3.0);
            let [depth, left, right] = [more(2.5), more(0.0), more(0.0)];
            let floor = place
                .frame
                .ring([[length, length + depth], [-left, width + right]]);
            let elevation = self.building.levels[lower].elevation + height;
            let upper = self
                .building
                .flat(format!("mezzanine {k}"), floor, elevation);
            self.link(Link::Straight, place, [lower, upper]);
        }
    }

    fn columns(&mut self) {
        for &floor in &self.floors.clone() {
            for _ in 0..self.rng.random_range(0..5) {
                let frame = Frame::random(self.rng);
                let size = self.rng.random_range(0.3..1.0);
                let ring = frame.ring([[0.0, size], [0.0, 0.6]]);
                if self.has_room(floor, &ring) {
                    self.building.levels[floor].rings.push(ring);
                }
            }
        }
    }

    /// An exit or two on the lowest floor, and rarely one more above.
    fn exits(&mut self) {
        let mut floors = vec![self.floors[0]];
        if self.rng.random_bool(0.4) {
            floors.push(self.floors[0]);
        }
        if self.rng.random_bool(0.2) {
            floors.push(self.floors[1]);
        }
        let mut used = Vec::new();
        for floor in floors {
            let sides: Vec<[Vector; 2]> = edges(&self.building.levels[floor].rings[0]).collect();
            // The floor behind an exit must not lie on the other wing of an L.
            let is_notch = |k: usize| sides.len() > 4 && [2, 3].contains(&k);
            let free = (0..sides.len()).filter(|&k| !is_notch(k) && !used.contains(&(floor, k)));
            let free: Vec<usize> = free.collect();
            let side = free[self.rng.random_range(0..free.len())];
            used.push((floor, side));
            let [a, b] = sides[side];
            let length = (b - a).norm();
            let width = self.rng.random_range(1.0..2.4);
            let from = self.rng.random_range(0.6..length - width - 0.6);
            let line = [from, from + width].map(|at| a + (b - a) * (at / length));
            self.building.exits.push((line, floor));
        }
    }

    /// Some people on every level, and more on floors.
    fn people(&mut self) {
        let building = &mut self.building;
        for level in 0..building.levels.len() {
            let count = match self.floors.contains(&level) {
                true => 2,
                false => usize::from(self.rng.random_bool(0.4)),
            };
            let corners = building.levels[level].rings[0].iter();
            let (low, high) = corners.fold(
                (
                    Vector::repeat(f64::INFINITY),
                    Vector::repeat(f64::NEG_INFINITY),
                ),
                |(low, high), &p| (low.inf(&p.into()), high.sup(&p.into())),
            );
            let mut here: Vec<Vector> = Vec::new();
            for _ in 0..TRIES {
                let p = vector(
                    self.rng.random_range(low.x..high.x),
                    self.rng.random_range(low.y..high.y),
                );
                let is_apart = here.iter().all(|other| (other - p).norm() >= BETWEEN);
                if here.len() < count && is_apart && building.levels[level].is_free(p, FREE) {
                    here.push(p);
                }
            }
            building.people.extend(here.into_iter().map(|p| (level, p)));
        }
    }
}
