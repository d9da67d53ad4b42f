//! Walkable areas and obstacles, given in a scenario or in files that it names.

use crate::error::{Problem, Under};
use crate::file::File;
use crate::floor_plan;
use crate::floor_plan::{FloorPlan, Kind, Shape, encloses_nothing};
use crate::keys::shapes::{Outline, Point, Ring as GivenRing};
use crate::scene::openings::{BEHIND, Door, OVERLAP, Opening, WIDE_AT, openings};
use crate::scene::periodic;
use engine::geometry::{Area, Polygon};
use engine::math::Vector;
use engine::period::Period;

pub const WALKABLE_AREA: &str = "walkable_area";
pub const OBSTACLES: &str = "obstacles";

/// Most corners of one ring: the search for crossing edges compares all nearby pairs.
const MOST_CORNERS: usize = 20_000;
/// Most walls of a scenario.
const MOST_WALLS: u64 = 1_000_000;

/// The most sides of the body of a wall that is a line, for each of its points.
const SIDES: u64 = 4;

/// The number of walls of a scene: one per corner, in a periodic scene of three periods; more for obstacles that are
/// lines.
pub fn walls(file: &File) -> u64 {
    let bodies = file.obstacles.iter().flat_map(Outline::rings);
    let of_body = |ring: &GivenRing| {
        let points: Vec<[f64; 2]> = ring.0.iter().map(|&Point(point)| point).collect();
        let sides = if encloses_nothing(&points) { SIDES } else { 1 };
        sides * ring.0.len() as u64
    };
    let floor = file.walkable_area.iter().flatten().flatten();
    let corners: u64 = floor.map(|ring| ring.0.len() as u64).sum();
    let all = corners + bodies.map(of_body).sum::<u64>();
    all * if file.periodic.is_some() { 3 } else { 1 }
}

/// Notes on obstacles off the floor, and on floors inside other floors. None in a periodic scene, where a polygon
/// counts with all its copies.
pub fn without_effect(file: &File) -> Result<Vec<String>, Problem> {
    if file.periodic.is_some() {
        return Ok(Vec::new());
    }
    let mut shapes = Vec::new();
    for (k, given) in file.walkable_area.iter().flatten().enumerate() {
        let place = format!("{WALKABLE_AREA}[{k}]");
        shapes.push(Shape::new(place, rings(given)?, Kind::Floor));
    }
    for (k, given) in file.obstacles.iter().enumerate() {
        let place = format!("{OBSTACLES}[{k}]");
        let rings = rings(given.rings())?;
        let is_wall = rings.iter().any(|ring| encloses_nothing(ring));
        if !is_wall {
            shapes.push(Shape::new(place, rings, Kind::Obstacle));
        }
    }
    Ok(floor_plan::without_effect(&shapes)?)
}

/// What surrounds people.
pub struct Surroundings {
    /// The obstacles in order, then the solid around the walkable area.
    pub solids: Vec<Polygon>,
    /// The outlines of the floors behind exits and entrances, counterclockwise.
    pub behind: Vec<Vec<Vector>>,
}

impl Surroundings {
    /// The obstacles and the walkable area of a file.
    pub fn of(file: &File) -> Result<Self, Problem> {
        let walls = walls(file);
        if walls > MOST_WALLS {
            let reason = format!(
                "{walls} corners in total; at most {MOST_WALLS} are allowed: leave out unimportant corners"
            );
            return Err(Problem::new(OBSTACLES, reason));
        }
        let period = file.periodic.map(Period::from);
        let mut solids = Vec::with_capacity(file.obstacles.len() + 1);
        let mut copies = Vec::new();
        for (k, given) in file.obstacles.iter().enumerate() {
            let bodies = obstacle(given, period.as_ref()).under(&format!("{OBSTACLES}[{k}]"))?;
            let mut bodies = bodies.into_iter();
            solids.extend(bodies.next());
            copies.extend(bodies);
        }
        solids.extend(copies);
        let Some(polygons) = &file.walkable_area else {
            return Ok(Self {
                solids,
                behind: Vec::new(),
            });
        };
        let door = |line: [Point; 2], reach: f64| (line.map(Vector::from), reach);
        let exits = file.exits.iter().map(|exit| door(exit.line, BEHIND));
        let entrances = file.entrances.iter().map(|one| door(one.line.0, WIDE_AT));
        let doors: Vec<Door> = exits.chain(entrances).collect();
        let around = walls_round(polygons, &doors, period.as_ref()).under(WALKABLE_AREA)?;
        if let Some(period) = &period {
            periodic::check_ends(&around.solids, period).under(WALKABLE_AREA)?;
        }
        solids.extend(around.solids);
        Ok(Self { solids, ..around })
    }
}

/// The solid around `polygons` and their copies, open behind the lines of exits and entrances. Those of a floor plan
/// file are united already, but for 9 % of the plans of the tests, a second union has other corners, or begins a ring
/// at another one: without it, a run would differ from that of the same scenario with its plan written out.
fn walls_round(
    polygons: &[Vec<GivenRing>],
    doors: &[Door],
    period: Option<&Period>,
) -> Result<Surroundings, Problem> {
    let mut given = Vec::with_capacity(polygons.len());
    for (k, polygon) in polygons.iter().enumerate() {
        let copies = rings(polygon).and_then(|rings| periodic::copies(&rings, period));
        given.extend(copies.under(&format!("[{k}]"))?);
    }
    let mut floor = FloorPlan::walkable(&given)?.walkable;
    let openings = openings(&floor, doors);
    if !openings.is_empty() {
        given.extend(openings.iter().map(|opening| vec![opening.ring(-OVERLAP)]));
        floor = FloorPlan::walkable(&given)?.walkable;
    }
    Ok(Surroundings {
        solids: vec![Polygon::enclosing(floor)?],
        behind: openings.iter().map(Opening::outline).collect(),
    })
}

/// An area from its outline and holes.
pub fn area(given: &[GivenRing]) -> Result<Area, Problem> {
    Ok(FloorPlan::obstacle(&rings(given)?)?)
}

/// A body, with its copies in a periodic scene; or the bodies of a wall without thickness, one for each straight part.
fn obstacle(given: &Outline, period: Option<&Period>) -> Result<Vec<Polygon>, Problem> {
    if let Some(period) = period {
        return periodic::bodies(&rings(given.rings())?, period);
    }
    if let Outline::Ring(ring) = given
        && let Some(bodies) = FloorPlan::wall(&points(ring)?)?
    {
        let solid = bodies.into_iter().map(Polygon::filling);
        return Ok(solid.collect::<Result<_, _>>()?);
    }
    let polygon = match given {
        Outline::Ring(ring) => Polygon::new(points(ring)?.into_iter().map(Into::into).collect()),
        Outline::Rings(given) => Polygon::filling(area(given)?),
    };
    Ok(vec![polygon?])
}

fn rings(given: &[GivenRing]) -> Result<Vec<Vec<[f64; 2]>>, Problem> {
    let ring = |(r, ring)| points(ring).under(&format!("[{r}]"));
    given.iter().enumerate().map(ring).collect()
}

/// The corners of a ring, if there are not too many.
fn points(GivenRing(ring): &GivenRing) -> Result<Vec<[f64; 2]>, Problem> {
    let count = ring.len();
    if count > MOST_CORNERS {
        let reason =
            format!("{count} corners; at most {MOST_CORNERS} are allowed: split it into several");
        return Err(Problem::new("", reason));
    }
    Ok(ring.iter().map(|&Point(point)| point).collect())
}
