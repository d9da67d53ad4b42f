//! Places for bodies that do not overlap: at random or on a lattice, in an area, clear of walls and of other bodies.
//!
//! [`scattered`] throws darts, with a minimum distance between bodies that begins as large as their number allows and
//! shrinks when no place is left. Throws go only to cells that may still have room; after some throws, the cells are
//! quartered, and those without room are dropped (Ebeida et al. 2012, A simple algorithm for maximal Poisson-disk
//! sampling in high dimensions). This also finds the last free places. Everything is computed on one thread in a fixed
//! order from one stream of random numbers.

mod cells;
mod taken;

use rand::Rng;

use crate::geometry::{Area, AreaIndex, Polygon, Wall, Walls};
use crate::math::{Vector, bounds};
use crate::period::Period;
use cells::Cells;
use taken::Taken;

/// A disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Its center, meters.
    pub place: Vector,
    /// Its radius, meters.
    pub radius: f64,
}

/// The first distance between bodies, in units of the square root of the area per body. Throws at random cannot place
/// discs of this diameter more densely than at 0.83.
const FIRST_SPACING: f64 = 0.75;
/// The factor by which the distance shrinks when no place is left.
const SHRINKAGE: f64 = 0.85;
/// Throws per cell between two quarterings.
const THROWS: usize = 4;
/// The most quarterings at one distance.
const QUARTERINGS: usize = 6;
/// The factor by which the pitch of a lattice shrinks while it has too few sites.
const TIGHTER: f64 = 0.985;
/// The most pitches along the side of a cell in which sites are tried.
const MOST_PITCHES: f64 = 4.0;
/// Bodies keep this distance in addition, meters: far above the rounding of coordinates up to 10⁶ m.
const ROUNDING: f64 = 1e-9;
/// [`scattered`] reports this fraction of the bodies that it could place as fitting, because fewer bodies have other
/// radii.
const SURE: f64 = 0.98;

/// Where the centers of bodies may be: in some areas, clear of walls.
pub struct Space<'a> {
    areas: &'a [Area],
    index: AreaIndex<'a>,
    /// The borders of the areas.
    borders: Walls,
    walls: &'a Walls,
    period: Option<Period>,
}

impl<'a> Space<'a> {
    /// The space in `areas`, which lie outside of the obstacles of `walls` and in the `period`, if there is one.
    pub fn new(areas: &'a [Area], walls: &'a Walls, period: Option<Period>) -> Self {
        let around = Polygon::enclosing(areas.to_vec());
        Self {
            areas,
            index: AreaIndex::new(areas),
            borders: Walls::new(around.into_iter().collect()),
            walls,
            period,
        }
    }

    /// An upper bound on the bodies of this radius that fit: discs cover at most 0.907 of an area, and reach out of
    /// this space by their radius.
    pub fn capacity(&self, radius: f64) -> usize {
        let outlines = self.borders.iter().map(Wall::length).sum::<f64>();
        let disc = std::f64::consts::PI * radius * radius;
        let reached = self.size() + outlines * radius + disc * self.areas.len() as f64;
        (0.907 * reached / disc) as usize + 1
    }

    /// The corners of the box around it.
    fn bounds(&self) -> [Vector; 2] {
        let corners = self.areas.iter().flat_map(|area| area.exterior.points());
        bounds(corners.copied()).unwrap_or_default()
    }

    fn size(&self) -> f64 {
        self.areas.iter().map(Area::area).sum()
    }

    fn contains(&self, p: Vector) -> bool {
        !self.index.around(p).is_empty()
    }

    /// Whether there is room for a body of this radius. `near` is a buffer.
    fn has_room(&self, p: Vector, radius: f64, near: &mut Vec<u32>) -> bool {
        near.clear();
        self.walls.near(p, radius + ROUNDING, near);
        near.is_empty() && self.contains(p)
    }
}

/// Random places for bodies of these `radii`, in their order, evenly spread and clear of the bodies `others`.
///
/// # Errors
/// They do not fit; the error is the number that fits, about.
pub fn scattered(
    space: &Space,
    others: &[Body],
    radii: &[f64],
    random: &mut impl Rng,
) -> Result<Vec<Vector>, usize> {
    if radii.is_empty() {
        return Ok(Vec::new());
    }
    // Large bodies first: small ones find places between them.
    let mut order: Vec<usize> = (0..radii.len()).collect();
    order.sort_by(|&a, &b| radii[b].total_cmp(&radii[a]));
    let sorted: Vec<f64> = order.iter().map(|&k| radii[k]).collect();
    let smallest = sorted.last().copied().unwrap_or_default();
    let mut spacing = FIRST_SPACING * (space.size() / sorted.len().max(1) as f64).sqrt();
    let mut throwing = Throwing::new(space, others, &sorted);
    while spacing > 2.0 * smallest && throwing.is_incomplete() {
        throwing.fill(spacing, random);
        spacing *= SHRINKAGE;
    }
    if throwing.is_incomplete() {
        throwing.fill(0.0, random);
    }
    if throwing.is_incomplete() {
        // Bodies that are far apart waste room: start again.
        throwing = Throwing::new(space, others, &sorted);
        throwing.fill(0.0, random);
    }
    if throwing.is_incomplete() {
        return Err((throwing.places.len() as f64 * SURE) as usize);
    }
    let mut places = vec![Vector::zeros(); radii.len()];
    for (&k, place) in order.iter().zip(throwing.places) {
        places[k] = place;
    }
    Ok(places)
}

/// Bodies that are being placed, one after another.
struct Throwing<'a> {
    space: &'a Space<'a>,
    radii: &'a [f64],
    taken: Taken,
    /// The places of the first bodies.
    places: Vec<Vector>,
}

impl<'a> Throwing<'a> {
    fn new(space: &'a Space<'a>, others: &[Body], radii: &'a [f64]) -> Self {
        Self {
            space,
            radii,
            taken: Taken::new(space.bounds(), space.period, others, radii),
            places: Vec::with_capacity(radii.len()),
        }
    }

    fn is_incomplete(&self) -> bool {
        self.places.len() < self.radii.len()
    }

    /// Places bodies at least `spacing` meters from each other until all are placed or no place is left.
    fn fill(&mut self, spacing: f64, random: &mut impl Rng) {
        let smallest = self.radii.last().copied().unwrap_or_default();
        let side = spacing.max(2.0 * smallest) * std::f64::consts::FRAC_1_SQRT_2;
        self.taken.set_spacing(spacing);
        let bodies = (self.radii.len(), smallest);
        let mut cells = Cells::covering(self.space, &self.taken, bodies, side);
        let mut near = Vec::new();
        for _ in 0..QUARTERINGS {
            for _ in 0..THROWS * cells.len() {
                let Some(&radius) = self.radii.get(self.places.len()) else {
                    return;
                };
                if cells.len() == 0 {
                    return;
                }
                let k = random.random_range(0..cells.len());
                let place = cells.point_in(k, random);
                let fits = self.taken.has_room(place, radius)
                    && self.space.has_room(place, radius, &mut near);
                if fits {
                    self.taken.add(Body { place, radius });
                    self.places.push(place);
                    cells.remove(k);
                }
            }
            if !cells.quarter(self.space, &self.taken, smallest) {
                return;
            }
        }
    }
}

/// Places on a triangular lattice, as wide as possible, clear of the bodies `others`.
///
/// # Errors
/// They do not fit; the error is the number that fits.
pub fn lattice(space: &Space, others: &[Body], radii: &[f64]) -> Result<Vec<Vector>, usize> {
    if radii.is_empty() {
        return Ok(Vec::new());
    }
    let widest = radii.iter().copied().fold(0.0, f64::max);
    let taken = Taken::new(space.bounds(), space.period, others, radii);
    let closest = 2.0 * (widest + ROUNDING);
    let per_body = space.size() / radii.len().max(1) as f64;
    let mut pitch = (per_body * 2.0 / 3_f64.sqrt()).sqrt().max(closest);
    let sites = loop {
        let sites = sites(space, &taken, (radii.len(), widest), pitch);
        if sites.len() >= radii.len() {
            break sites;
        }
        if pitch <= closest {
            return Err(sites.len());
        }
        pitch = (pitch * TIGHTER).max(closest);
    };
    // Leaves out sites at even distances.
    let chosen = (0..radii.len()).map(|k| sites[k * sites.len() / radii.len()]);
    Ok(chosen.collect())
}

/// The sites of a triangular lattice, row by row, that have room for bodies of this radius.
fn sites(space: &Space, taken: &Taken, bodies: (usize, f64), pitch: f64) -> Vec<Vector> {
    let cells = Cells::covering(space, taken, bodies, pitch);
    if cells.side() > MOST_PITCHES * pitch {
        return Vec::new(); // more sites than could be tried, and hardly any with room
    }
    let ([low, _], rise) = (space.bounds(), pitch * 0.75_f64.sqrt());
    let half = Vector::repeat(0.5 * cells.side());
    let mut sites: Vec<[i64; 2]> = Vec::new();
    for center in cells.centers() {
        let (from, to) = (center - half - low, center + half - low);
        for row in (from.y / rise - 0.5).ceil() as i64..(to.y / rise + 0.5).ceil() as i64 {
            let columns = [from.x, to.x].map(|x| (x / pitch - shift(row)).ceil() as i64);
            sites.extend((columns[0]..columns[1]).map(|column| [row, column]));
        }
    }
    sites.sort_unstable();
    sites.dedup();
    let place = |[row, column]: [i64; 2]| {
        let (x, y) = (column as f64 + shift(row), row as f64 + 0.5);
        low + Vector::new(pitch * x, rise * y)
    };
    let mut near = Vec::new();
    let has_room =
        |&p: &Vector| taken.has_room(p, bodies.1) && space.has_room(p, bodies.1, &mut near);
    let places: Vec<Vector> = sites.into_iter().map(place).filter(has_room).collect();
    match space.period {
        Some(_) => apart(space, bodies.1, places),
        None => places,
    }
}

/// The `places` at which bodies of this radius do not touch across the ends of the period.
fn apart(space: &Space, radius: f64, mut places: Vec<Vector>) -> Vec<Vector> {
    let radii = vec![radius; places.len()];
    let mut taken = Taken::new(space.bounds(), space.period, &[], &radii);
    taken.set_spacing(0.0);
    places.retain(|&place| {
        let has_room = taken.has_room(place, radius);
        if has_room {
            taken.add(Body { place, radius });
        }
        has_room
    });
    places
}

/// The first site of a row, in pitches from the left.
fn shift(row: i64) -> f64 {
    0.25 + 0.5 * (row.rem_euclid(2) as f64)
}
