//! Labels that do not cover each other, in pictures and in views of recordings.

use crate::scenery::{self, GoalOf, brief};
use engine::geometry::Walls;
use engine::journeys::{Kind, Place};
use engine::math::{Vector, bounds, direction, perpendicular};
use engine::scene::Scene;
use figures::colors::Rgb;
use scenario::floor_plan::Label;

/// Labels keep this distance from their points, points.
pub const GAP: f64 = 4.0;
/// A label is beside what is at most this far from it, points.
const BESIDE: f64 = 1.5 * GAP;
/// A label belongs clearly to the area beside it if no other one has more than this part of what it covers there.
const CLEARLY: f64 = 0.8;
/// If no place beside its point is free, a label is at most this many times its height away, with a line to its point.
const FARTHEST: u32 = 7;
/// More goals than this have no labels. More other things than this have labels only where these cover nothing, at most
/// this many times their height away.
const FEW: usize = 8;
const NEAR: u32 = 2;
/// The names of exits narrower than this lie beside them, points.
const NARROW: f64 = 50.0;
/// An area is tall if it is that many times as high as wide.
const TALL: f64 = 1.5;
/// The room that people need behind an exit: the exit may lie this far from walls, meters.
const BEHIND: f64 = 3.5;

/// All eight sides of a point and its center, the best first.
pub const AROUND: [[i8; 2]; 9] = [
    [0, 1],
    [0, -1],
    [1, 0],
    [-1, 0],
    [1, 1],
    [-1, 1],
    [1, -1],
    [-1, -1],
    [0, 0],
];

/// A point, and the side of it on which a label may be.
pub type Spot = (Vector, [i8; 2]);

/// The area in which labels are shown.
#[derive(Debug, Clone, Copy)]
pub struct Screen {
    /// The part of the plane in which they must be, meters.
    pub inside: [Vector; 2],
    /// Points per meter.
    pub scale: f64,
    /// The height of a label, points.
    pub height: f64,
    /// The width of a text, points.
    pub width: fn(&str) -> f64,
}

impl Screen {
    /// A length in points, in meters.
    pub fn meters(&self, points: f64) -> f64 {
        points / self.scale
    }
}

/// A label with its place.
#[derive(Debug, Clone)]
pub struct Placed {
    /// Its text.
    pub text: String,
    /// The color of what it belongs to.
    pub color: Rgb,
    /// The corners of the box around it, meters.
    pub around: [Vector; 2],
    /// Its side: −1, 0 or 1 for left of the point, centered, right of it; and for below, centered, above.
    pub side: [i8; 2],
    /// Its point that is nearest to the point that it belongs to.
    pub at: Vector,
    /// The point that it belongs to, if a line must lead there.
    pub leader: Option<Vector>,
}

/// The labels of a panel or view.
pub struct Labels {
    screen: Screen,
    placed: Vec<Placed>,
    /// Points that labels cover only if they find no other place nearby, by x.
    avoided: Vec<Vector>,
    /// The corners of areas, meters: the label of one is beside another rather than its own only if it finds no other
    /// place.
    areas: Vec<[Vector; 2]>,
}

/// A possible place of a label.
#[derive(Clone, Copy)]
struct Candidate {
    around: [Vector; 2],
    spot: Spot,
    at: Vector,
    /// The distance from its point, points.
    distance: f64,
}

impl Candidate {
    /// Whether it lies on a box with these corners.
    fn covers(&self, corners: [Vector; 2]) -> bool {
        self.overlap(corners, 0.0) > 0.0
    }

    /// The area of what lies on a box with these corners or at most `reach` beside it, m².
    fn overlap(&self, [l, h]: [Vector; 2], reach: f64) -> f64 {
        let [low, high] = self.around;
        let reach = Vector::repeat(reach);
        let size = (high + reach).inf(&h) - (low - reach).sup(&l);
        size.x.max(0.0) * size.y.max(0.0)
    }
}

impl Labels {
    /// No labels yet. They cover the points `avoided` only if they find no other place.
    pub fn new(screen: Screen, mut avoided: Vec<Vector>) -> Self {
        avoided.sort_by(|a, b| a.x.total_cmp(&b.x));
        Self {
            screen,
            placed: Vec::new(),
            avoided,
            areas: Vec::new(),
        }
    }

    /// The same among the waiting areas, disks and zones of a scene: the label of one lies on another, or more beside
    /// another than beside its own, only if it finds no other place, and then with a line to its own.
    pub fn among_areas(mut self, scene: &Scene) -> Self {
        let places = scene.journeys.places.iter();
        let is_area = |place: &&Place| matches!(place.kind, Kind::Waiting(_) | Kind::Disk { .. });
        let areas = places.filter(is_area).map(scenery::lines);
        let zones = scene.journeys.zones.iter();
        let rings = areas.chain(zones.map(|zone| zone.area.points().to_vec()));
        self.areas = rings.filter_map(bounds).collect();
        self
    }

    /// Adds a label at the first of `spots` where it fits inside and covers no other label, or farther away with a line
    /// to its point; if possible, at one where it covers none of the avoided points. If nothing is free there is no
    /// label. Returns whether there is one.
    pub fn add(&mut self, text: &str, color: Rgb, spots: &[Spot]) -> bool {
        self.add_of(1, text, (color, spots))
    }

    /// Adds the label of one of `count` similar things. If there are many, only near its point and where it covers
    /// nothing.
    pub fn add_of(&mut self, count: usize, text: &str, (color, spots): (Rgb, &[Spot])) -> bool {
        let text = brief(text);
        let width = (self.screen.width)(&text);
        let is_one_of_many = count > FEW;
        let count = if is_one_of_many { NEAR } else { FARTHEST };
        let rings = (0..count).map(|ring| GAP + f64::from(ring) * self.screen.height);
        let spread = rings.flat_map(|distance| {
            let all = spots.iter();
            let outward = all.filter(move |(_, side)| *side != [0, 0] || distance == GAP);
            outward.map(move |&spot| (spot, distance))
        });
        let candidates = spread.map(|(spot, distance)| self.candidate(width, spot, distance));
        let free: Vec<Candidate> = candidates.filter(|one| self.is_free(one)).collect();
        let (own, others) = self.areas_of(spots);
        let reach = self.screen.meters(BESIDE);
        let is_astray = |one: &Candidate| {
            let beside = CLEARLY * own.map_or(0.0, |own| one.overlap(own, reach));
            let of_other = others.iter().map(|area| one.overlap(*area, reach));
            one.spot.1 != [0, 0] && of_other.fold(0.0, f64::max) > beside
        };
        let best = |all: &[&Candidate]| -> Option<Candidate> {
            let empty = all.iter().find(|one| self.is_empty(one));
            let found = empty.or(all.first().filter(|_| !is_one_of_many));
            found.map(|found| **found)
        };
        let right: Vec<&Candidate> = free.iter().filter(|one| !is_astray(one)).collect();
        let Some(found) = best(&right).or_else(|| best(&free.iter().collect::<Vec<_>>())) else {
            return false;
        };
        let (point, side) = found.spot;
        let astray = is_astray(&found).then(|| {
            // Into its own area, so that the line is seen.
            let back = Vector::from(side.map(f64::from)) * self.screen.meters(2.0 * GAP);
            let inside = point - back;
            own.map_or(inside, |[low, high]| inside.sup(&low).inf(&high))
        });
        self.placed.push(Placed {
            text,
            color,
            around: found.around,
            side,
            at: found.at,
            leader: astray.or((found.distance > GAP).then_some(point)),
        });
        true
    }

    /// Adds a text in the middle of its room, or a line above or below, if it fits there.
    pub fn add_within(&mut self, label: &Label, color: Rgb) -> bool {
        let room = label
            .width
            .map_or(f64::INFINITY, |width| width * self.screen.scale);
        let line = Vector::new(0.0, self.screen.meters(self.screen.height));
        let spots = [0.0, 1.0, -1.0].map(|lines| (label.at + line * lines, [0, 0]));
        (self.screen.width)(&brief(&label.text)) <= room && self.add(&label.text, color, &spots)
    }

    /// The area whose label has these spots, and the other areas except those around it; nothing for other labels.
    fn areas_of(&self, spots: &[Spot]) -> (Option<[Vector; 2]>, Vec<[Vector; 2]>) {
        /// Corners are that near to their areas, meters.
        const SAME: f64 = 1e-6;
        let reach = Vector::repeat(SAME);
        let holds = |[l, h]: [Vector; 2], [low, high]: [Vector; 2]| {
            let (low, high) = (low + reach, high - reach);
            l == l.inf(&low) && h == h.sup(&high)
        };
        let own = bounds(spots.iter().map(|spot| spot.0)).filter(|own| {
            let mut areas = self.areas.iter();
            areas.any(|area| holds(*area, *own) && holds(*own, *area))
        });
        let areas = self.areas.iter().copied();
        let others = areas.filter(|area| own.is_some_and(|own| !holds(*area, own)));
        (own, others.collect())
    }

    /// A place beside a point; above and below it, a label that would reach beyond the screen is shifted along it.
    fn candidate(&self, width: f64, spot: Spot, distance: f64) -> Candidate {
        let screen = &self.screen;
        // Some room between two labels in a row.
        let size = [width + 0.5 * screen.height, screen.height].map(|side| screen.meters(side));
        let half = Vector::from(size) * 0.5;
        let side = Vector::from(spot.1.map(f64::from));
        let mut at = spot.0 + side * screen.meters(distance);
        if spot.1[0] == 0 && spot.1[1] != 0 {
            let [least, most] = screen.inside.map(|end| end.x);
            let half = half.x * (1.0 + 1e-9); // rounding does not put it beyond the screen
            let shifted = at.x.min(most - half).max(least + half);
            if (shifted - at.x).abs() < half {
                at.x = shifted;
            }
        }
        let center = at + side.component_mul(&half);
        Candidate {
            around: [center - half, center + half],
            spot,
            at,
            distance,
        }
    }

    /// Whether a label fits there inside, and covers no other label.
    fn is_free(&self, place: &Candidate) -> bool {
        let [low, high] = place.around;
        let [least, most] = self.screen.inside;
        let fits = low == low.sup(&least) && high == high.inf(&most);
        fits && !self.placed.iter().any(|placed| place.covers(placed.around))
    }

    /// Whether a label there covers none of the points to avoid.
    fn is_empty(&self, place: &Candidate) -> bool {
        let [low, high] = place.around;
        let first = self.avoided.partition_point(|p| p.x < low.x);
        let column = self.avoided[first..].iter().take_while(|p| p.x <= high.x);
        !column.into_iter().any(|p| (low.y..=high.y).contains(&p.y))
    }

    /// All labels, in the order in which they were added.
    pub fn into_placed(self) -> Vec<Placed> {
        self.placed
    }
}

/// Points along all walls, places and zones, at most `apart` meters from each other.
pub fn along_lines(scene: &Scene, apart: f64) -> Vec<Vector> {
    let journeys = &scene.journeys;
    let places = journeys.places.iter().map(scenery::lines);
    let zones = journeys.zones.iter();
    let lines = places.chain(zones.map(|zone| scenery::closed(zone.area.points())));
    let walls = along_walls(&scene.walls, apart);
    let along = |line: Vec<Vector>| {
        let sides = line.windows(2);
        let points = sides.flat_map(|side| along(side[0], side[1], apart));
        points.collect::<Vec<_>>()
    };
    walls.chain(lines.flat_map(along)).collect()
}

/// Points along all walls, at most `apart` meters from each other.
pub fn along_walls(walls: &Walls, apart: f64) -> impl Iterator<Item = Vector> {
    let walls = walls.iter();
    walls.flat_map(move |wall| along(wall.start, wall.end, apart))
}

fn along(start: Vector, end: Vector, apart: f64) -> impl Iterator<Item = Vector> {
    let count = ((end - start).norm() / apart).ceil().clamp(1.0, 1e4);
    (0..=count as u32).map(move |k| start + (end - start) * (f64::from(k) / count))
}

/// Spots for the label of an area: above, below, beside (first, if it is tall), and if `inside` first in the middle.
pub fn around(corners: &[Vector], inside: bool) -> Vec<Spot> {
    let [low, high] = bounds(corners.iter().copied()).unwrap_or_default();
    let middle = (low + high) * 0.5;
    let at = |[x, y]: [i8; 2]| {
        let half = (high - low) * 0.5;
        let side = Vector::new(f64::from(x), f64::from(y));
        (middle + half.component_mul(&side), [x, y])
    };
    let mut spots: Vec<_> = AROUND.into_iter().map(at).collect();
    if high.y - low.y > TALL * (high.x - low.x) {
        // Above it may be another one.
        spots[..4].rotate_left(2);
    }
    if inside {
        spots.rotate_right(1);
    }
    spots
}

/// The names of goals, each with its spots, if they are few.
pub fn of_goals(scene: &Scene, goals: &[GoalOf]) -> Vec<(String, Vec<Spot>)> {
    let few = goals.iter().filter(|_| goals.len() <= FEW);
    let named = few.zip(scenery::goal_labels(scene, goals));
    let around = |goal: Vector| AROUND[..8].iter().map(move |&side| (goal, side)).collect();
    let spots = named.map(|((goal, _), name)| (name, around(*goal)));
    spots.filter(|(name, _)| !name.is_empty()).collect()
}

/// Spots for the name of a place with these lines.
pub fn of_place(walls: &Walls, place: &Place, lines: &[Vector], screen: &Screen) -> Vec<Spot> {
    match &place.kind {
        Kind::Exit(_) | Kind::Line(_) | Kind::Door(_) => {
            let [a, b] = [lines[0], lines[1]];
            let (middle, aside) = ((a + b) * 0.5, perpendicular(direction(b - a)));
            let is_out = |way: &Vector| walls.obstacle_at(middle + way * BEHIND).is_some();
            let out = [aside, -aside].into_iter().find(is_out).unwrap_or(aside);
            let side = |way: Vector| {
                let part = |x: f64| (x * 1.4).round().clamp(-1.0, 1.0) as i8;
                (
                    middle + way * screen.meters(2.0),
                    [part(way.x), part(way.y)],
                )
            };
            // Beside the floor behind a narrow exit, where it covers no walls.
            let beside = |end: Vector| {
                let (_, side) = side(direction(end - middle) + out);
                (end + out * screen.meters(2.0), side)
            };
            let is_narrow = (b - a).norm() * screen.scale < NARROW && place.is_exit();
            let narrow = [b, a].map(beside).into_iter().filter(|_| is_narrow);
            narrow
                .chain([side(out), side(-out)])
                .chain(AROUND.map(|side| (middle, side)))
                .collect()
        }
        Kind::Disk { .. } | Kind::Waiting(_) => around(lines, false),
        Kind::Queue(queue) => {
            let front = queue.path[0];
            let back = queue.path.get(1).copied().unwrap_or(front);
            let away = direction(front - back);
            let first = [away.x, away.y].map(|x| (x * 1.4).round() as i8);
            let sides = std::iter::once(first).chain(AROUND);
            sides.map(|side| (front, side)).collect()
        }
    }
}
