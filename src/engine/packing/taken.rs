//! Places that are taken.

use super::{Body, ROUNDING};
use crate::math::Vector;
use crate::period::Period;

/// The most cells per body.
const CELLS_PER_BODY: usize = 4;
/// The limit on cells for few bodies.
const FEWEST_CELLS: usize = 4096;
/// No body.
const NONE: u32 = u32::MAX;

/// Bodies in a grid of square cells.
pub struct Taken {
    /// Bodies also take the place of their images in the neighboring periods.
    period: Option<Period>,
    /// The first are those of others.
    bodies: Vec<Body>,
    /// The number of bodies of others, which keep no distance.
    others: usize,
    /// The least distance between the centers of bodies, meters.
    spacing: f64,
    /// The radius of the widest body, meters.
    widest: f64,
    corner: Vector,
    side: f64,
    columns: usize,
    rows: usize,
    /// The last body in each cell, row by row.
    last: Vec<u32>,
    /// The body before each body in its cell.
    before: Vec<u32>,
    /// The most bodies there will be.
    expected: usize,
}

impl Taken {
    /// The bodies of `others`, with space for bodies of these `radii` with centers in a box.
    pub fn new(
        [low, high]: [Vector; 2],
        period: Option<Period>,
        others: &[Body],
        radii: &[f64],
    ) -> Self {
        let others = others.iter();
        let widest = others.clone().map(|body| body.radius);
        let widest = widest.chain(radii.iter().copied()).fold(0.0, f64::max);
        let margin = Vector::repeat(2.0 * widest);
        let (low, high) = (low - margin, high + margin);
        let is_near = |p: Vector| low.x <= p.x && low.y <= p.y && p.x <= high.x && p.y <= high.y;
        let others = others.flat_map(|&body| images(body, period));
        let others: Vec<Body> = others.filter(|body| is_near(body.place)).collect();
        let mut taken = Self {
            period,
            others: others.len(),
            spacing: 0.0,
            widest,
            corner: low,
            side: 0.0,
            columns: 0,
            rows: 0,
            last: Vec::new(),
            before: Vec::new(),
            expected: others.len() + radii.len(),
            bodies: others,
        };
        taken.lay_out(high - low);
        taken
    }

    /// Divides the box into cells as wide as bodies reach, or wider.
    fn lay_out(&mut self, extent: Vector) {
        let most = (self.expected * CELLS_PER_BODY).max(FEWEST_CELLS) as f64;
        self.side = self.spacing.max(2.0 * self.widest);
        let cells = |length: f64, side: f64| (length / side).floor() + 1.0;
        while cells(extent.x, self.side) * cells(extent.y, self.side) > most {
            self.side *= 1.5;
        }
        self.columns = cells(extent.x, self.side) as usize;
        self.rows = cells(extent.y, self.side) as usize;
        self.last = vec![NONE; self.columns * self.rows];
        self.before.clear();
        for k in 0..self.bodies.len() {
            self.enlist(self.bodies[k].place);
        }
    }

    /// Sets the least distance between the centers of bodies that are not those of others, meters.
    pub fn set_spacing(&mut self, spacing: f64) {
        let extent = Vector::new(self.columns as f64, self.rows as f64) * self.side;
        self.spacing = spacing;
        self.lay_out(extent);
    }

    pub fn add(&mut self, body: Body) {
        for image in images(body, self.period) {
            self.bodies.push(image);
            self.enlist(image.place);
        }
    }

    fn enlist(&mut self, place: Vector) {
        let [column, row] = self.cell(place);
        let last = &mut self.last[row * self.columns + column];
        self.before.push(*last);
        *last = (self.before.len() - 1) as u32;
    }

    fn cell(&self, p: Vector) -> [usize; 2] {
        let offset = (p - self.corner) / self.side;
        let column = (offset.x as usize).min(self.columns - 1);
        [column, (offset.y as usize).min(self.rows - 1)]
    }

    /// The bodies in cells within `reach` meters of `p`.
    fn around(&self, p: Vector, reach: f64) -> impl Iterator<Item = usize> + '_ {
        let half = Vector::repeat(reach);
        let ([left, low], [right, high]) = (self.cell(p - half), self.cell(p + half));
        let cells = (low..=high)
            .flat_map(move |row| (left..=right).map(move |column| row * self.columns + column));
        cells.flat_map(move |cell| {
            let known = |&k: &u32| k != NONE;
            let first = Some(self.last[cell]).filter(known);
            let next = move |&k: &u32| Some(self.before[k as usize]).filter(known);
            std::iter::successors(first, next).map(|k| k as usize)
        })
    }

    /// The least distance of a body of `radius` meters from body `k`, meters.
    fn distance(&self, k: usize, radius: f64) -> f64 {
        let touching = radius + self.bodies[k].radius + ROUNDING;
        match k < self.others {
            true => touching,
            false => touching.max(self.spacing),
        }
    }

    /// Whether there is room for a body of this radius.
    pub fn has_room(&self, p: Vector, radius: f64) -> bool {
        let reach = self.spacing.max(radius + self.widest + ROUNDING);
        let mut around = self.around(p, reach);
        !around.any(|k| {
            let distance = self.distance(k, radius);
            (self.bodies[k].place - p).norm_squared() < distance * distance
        })
    }

    /// Whether a single body leaves no room for a body of this radius within `half` meters of `p`.
    pub fn covers(&self, p: Vector, half: f64, radius: f64) -> bool {
        let reach = self.spacing.max(radius + self.widest + ROUNDING);
        let mut around = self.around(p, reach);
        around.any(|k| (self.bodies[k].place - p).norm() + half < self.distance(k, radius))
    }
}

/// A body, and its images in the neighboring periods.
fn images(body: Body, period: Option<Period>) -> impl Iterator<Item = Body> {
    let moved = move |laps| Body {
        place: period.map_or(body.place, |period| body.place + period.way(laps)),
        ..body
    };
    let laps: &[i32] = if period.is_some() { &[0, -1, 1] } else { &[0] };
    laps.iter().map(move |&laps| moved(laps))
}
