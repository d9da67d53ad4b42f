//! Buildings in the words of IMDF, the Indoor Mapping Data Format (OGC 20-094): GeoJSON whose features are levels,
//! units, openings and fixtures.
//!
//! | step | file |
//! |---|---|
//! | features, levels, coordinates | `features`, `categories`, `degrees` |
//! | corners that nearly meet | `snap` |
//! | which stairs lead where | `flights`, `edges` |
//!
//! The units of a level that people walk on are its floor; their edges are walls but for openings. Stairs and ramps are
//! levels of their own, which join the floors at the openings on their edges.

mod categories;
mod degrees;
mod edges;
mod features;
mod flights;
mod snap;

use serde_json::Value;

use super::drawn_levels::{DrawnLevel, DrawnLevels, LevelForm, PlanJoin};
use super::error::FloorPlanError;
use super::kind::Kind;
use super::reading::{Drawn, Reading};
use super::shape::Shape;
use super::unite::{free, rings, shared};
use crate::error::quote::shown;
use categories::Category;
use edges::is_on_edge;
use engine::geometry::Area;
use features::{Site, wrong};
use flights::{Flight, flights};

/// Units that overlap by less than this do not overlap, m².
const OVERLAP: f64 = 1e-3;
/// What is cut out of a floor is noted from this on, m².
const NOTED: f64 = 0.1;

/// Whether a text is GeoJSON with the features of IMDF.
pub fn is_imdf(text: &str) -> bool {
    const KEY: &str = "feature_type";
    if !text.trim_start().starts_with('{') || !text.contains(KEY) {
        return false;
    }
    let document: Value = serde_json::from_str(text).unwrap_or_default();
    let features = document["features"].as_array();
    let has_type = |feature: &Value| {
        let kinds = [&feature[KEY], &feature["properties"][KEY]];
        kinds.iter().any(|kind| kind.is_string())
    };
    features.is_some_and(|features| features.iter().any(has_type))
}

/// The levels of `files`, each with its name.
///
/// # Errors
/// The first problem, with its feature.
pub fn levels(
    files: &[(String, String)],
    reading: &Reading,
) -> Result<DrawnLevels, FloorPlanError> {
    if reading.storey.is_some() {
        let reason = "takes one storey, and `levels` takes all: remove it";
        return Err(wrong("plan.storey", reason));
    }
    read(files, reading)
}

/// The floor of the storey of `text` that `reading` names, or of the only one.
///
/// # Errors
/// Those of [`levels`]; it has several storeys, and none is named.
pub fn storey(text: &str, reading: &Reading) -> Result<Drawn, FloorPlanError> {
    let found = read(&[(String::new(), text.to_owned())], reading)?;
    let is_floor = |level: &DrawnLevel| matches!(level.form, LevelForm::Floor(_));
    let quoted: Vec<String> = found
        .levels
        .iter()
        .filter(|level| is_floor(level))
        .map(|level| format!("`{}`", shown(&level.name)))
        .collect();
    let names = quoted.join(", ");
    let mut floors = found.levels.into_iter().filter(is_floor);
    let taken = match &reading.storey {
        Some(name) => floors.find(|level| level.name == *name).ok_or_else(|| {
            let reason = format!("no level has the name `{}`; there are {names}", shown(name));
            wrong("plan.storey", reason)
        })?,
        None => match (floors.next(), floors.next()) {
            (Some(only), None) => only,
            _ => {
                let reason = format!(
                    "it has the levels {names}: take all with `\"levels\": \"FILE.geojson\"`, or one with \
                     `plan.storey`"
                );
                return Err(FloorPlanError::Levels(reason));
            }
        },
    };
    Ok(Drawn {
        shapes: taken.shapes,
        notes: found.notes,
        ..Drawn::default()
    })
}

fn read(files: &[(String, String)], reading: &Reading) -> Result<DrawnLevels, FloorPlanError> {
    let mut site = features::read(files, reading)?;
    close_gaps(&mut site, reading.gap());
    let flights = flights(&mut site)?;
    site.notes.extend(unused(&site));
    let mut found = DrawnLevels::default();
    // The number of the floor of each storey among all levels.
    let mut floors = Vec::with_capacity(site.storeys.len());
    for level in 0..site.storeys.len() {
        let cutters = cutters(&site, &flights, level);
        let shapes = floor(&mut site, level, &cutters)?;
        if shapes.is_empty() {
            let name = shown(&site.storeys[level].name);
            let note = "has no units that people walk on, and is left out";
            site.notes.push(format!("level `{name}` {note}"));
            floors.push(None);
            continue;
        }
        floors.push(Some(found.levels.len()));
        found.levels.push(DrawnLevel {
            name: site.storeys[level].name.clone(),
            form: LevelForm::Floor(site.storeys[level].elevation),
            shapes,
        });
    }
    let names = names(&site, &flights);
    for (flight, name) in flights.iter().zip(names) {
        let unit = &site.units[flight.unit];
        let form = match unit.category {
            Category::Ramp => LevelForm::Ramp,
            _ => LevelForm::Stairs,
        };
        found.levels.push(DrawnLevel {
            name,
            form,
            shapes: vec![unit.shape.clone()],
        });
    }
    open(&mut site, &flights, &floors, &mut found)?;
    furnish(&site, &flights, &floors, &mut found)?;
    found.notes = site.notes;
    Ok(found)
}

/// Makes edges and openings that nearly meet meet.
fn close_gaps(site: &mut Site, gap: f64) {
    let units = site.units.iter_mut();
    let used = units.filter(|unit| unit.category == Category::Floor || unit.category.is_flight());
    let shapes = used.map(|unit| &mut unit.shape);
    let all = shapes.chain(site.openings.iter_mut().map(|opening| &mut opening.shape));
    let mut paths: Vec<&mut Vec<[f64; 2]>> = all.flat_map(|shape| &mut shape.rings).collect();
    if gap > 0.0 {
        snap::snap(&mut paths, gap);
    }
}

/// A note on the units that are not used, if there are any.
fn unused(site: &Site) -> Option<String> {
    let units = site.units.iter();
    let all: Vec<String> = units
        .filter(|unit| unit.category == Category::Unused)
        .map(|unit| format!("{} ({})", shown(&unit.shape.place), shown(&unit.word)))
        .collect();
    (!all.is_empty()).then(|| format!("units left out, no one walks on them: {}", all.join(", ")))
}

/// The units that are cut out of the floor of a level: those of it that are no floor, and the flights from other levels
/// that come up or down there.
fn cutters(site: &Site, flights: &[Flight], level: usize) -> Vec<usize> {
    let leads_here = |unit: usize| {
        let mut own = flights.iter().filter(|flight| flight.unit == unit);
        own.any(|flight| {
            let mut ends = flight.openings.iter();
            ends.any(|&opening| site.openings[opening].level == level)
        })
    };
    (0..site.units.len())
        .filter(|&k| match site.units[k].category {
            Category::Floor => false,
            _ => site.units[k].level == level || leads_here(k),
        })
        .collect()
}

/// The floor of a level: its units without the `cutters`, and their edges as walls.
fn floor(site: &mut Site, level: usize, cutters: &[usize]) -> Result<Vec<Shape>, FloorPlanError> {
    let mut floors: Vec<Shape> = Vec::new();
    let mut cut_from_others = 0.0;
    for unit in &site.units {
        if unit.level != level || unit.category != Category::Floor {
            continue;
        }
        let own = unit.shape.area()?;
        let mut cut = Vec::new();
        for &k in cutters {
            let other = site.units[k].shape.area()?;
            let both = shared(own, other)?;
            if both > OVERLAP {
                cut.push(other.clone());
                if site.units[k].level != level {
                    cut_from_others += both;
                }
            }
        }
        if cut.is_empty() {
            floors.push(unit.shape.clone());
            continue;
        }
        let mut left = free(&[rings([own])], &rings(&cut))?;
        left.sort_by(|a, b| b.area().total_cmp(&a.area()));
        let parts = left.iter().enumerate().map(|(k, area)| Shape {
            name: unit.shape.name.clone().filter(|_| k == 0),
            ..Shape::new(unit.shape.place.clone(), points(area), Kind::Floor)
        });
        floors.extend(parts);
    }
    if cut_from_others >= NOTED {
        let name = shown(&site.storeys[level].name);
        site.notes.push(format!(
            "level `{name}`: its floor has no hole where stairs come: {cut_from_others:.1} m² are cut out of it"
        ));
    }
    let walls: Vec<Shape> = floors
        .iter()
        .flat_map(|floor| floor.rings.iter().map(move |ring| (floor, ring)))
        .map(|(floor, ring)| {
            let closed = ring.iter().chain(ring.first()).copied().collect();
            Shape::line(format!("{}, edge", floor.place), closed, Kind::Wall)
        })
        .collect();
    floors.extend(walls);
    Ok(floors)
}

fn points(area: &Area) -> Vec<Vec<[f64; 2]>> {
    let ring = |ring: &engine::geometry::Ring| ring.points().iter().map(|&p| p.into()).collect();
    area.rings().map(ring).collect()
}

/// Adds the openings: doors between units, exits, and the joins with flights.
fn open(
    site: &mut Site,
    flights: &[Flight],
    floors: &[Option<usize>],
    found: &mut DrawnLevels,
) -> Result<(), FloorPlanError> {
    let first_flight = floors.iter().flatten().count();
    let mut idle = Vec::new();
    for (k, opening) in site.openings.iter().enumerate() {
        let storey = &site.storeys[opening.level];
        let is_at = |shape: &Shape| is_on_edge(&opening.shape, &shape.rings);
        let at_flights: Vec<usize> = (0..flights.len())
            .filter(|&flight| flights[flight].openings.contains(&k))
            .collect();
        let at_others = site.units.iter().any(|unit| {
            unit.level == opening.level && unit.category != Category::Floor && is_at(&unit.shape)
        });
        let level = floors[opening.level];
        let beside = level.map_or(0, |level| {
            let shapes = found.levels[level].shapes.iter();
            let floors = shapes.filter(|shape| shape.kind == Kind::Floor);
            floors.filter(|floor| is_at(floor)).count()
        });
        let place = shown(&opening.shape.place);
        let kind = match (beside, at_flights.len()) {
            (0, 0) if at_others => {
                idle.push(place);
                continue;
            }
            (0, count) => return Err(on_no_floor(&opening.shape, &storey.name, count > 0)),
            (1, 0) if at_others => {
                idle.push(place);
                continue;
            }
            (1, 0) => Kind::Exit,
            _ => Kind::Door,
        };
        let Some(level) = level else { continue };
        found.levels[level].shapes.push(Shape {
            kind,
            ..opening.shape.clone()
        });
        for flight in at_flights {
            found.joins.push(PlanJoin {
                levels: [first_flight + flight, level],
                line: ends(&opening.shape)?,
            });
        }
    }
    if !idle.is_empty() {
        let note = "openings that join nothing are walls";
        site.notes.push(format!("{note}: {}", idle.join(", ")));
    }
    Ok(())
}

/// The problem of an opening that lies on the edge of no floor of its level.
fn on_no_floor(opening: &Shape, level: &str, is_at_stairs: bool) -> FloorPlanError {
    let level = shown(level);
    let reason = match is_at_stairs {
        true => format!(
            "lies on the edge of stairs, and of no floor of `{level}`: a unit of it must begin there"
        ),
        false => format!(
            "lies on no edge of a unit of `{level}`, from end to end: draw it along the edge that two units share, or \
             along an outer edge"
        ),
    };
    wrong(&opening.place, reason)
}

/// The ends of an opening at a flight.
fn ends(opening: &Shape) -> Result<[[f64; 2]; 2], FloorPlanError> {
    let points = opening.rings.iter().flatten();
    let (Some(&first), Some(&last)) = (points.clone().next(), points.clone().next_back()) else {
        return Err(FloorPlanError::EmptyGeometry(opening.place.clone()));
    };
    let straight = Shape::line(String::new(), vec![first, last], Kind::Door);
    let edge: Vec<[f64; 2]> = points.copied().collect();
    match is_on_edge(
        &Shape::line(String::new(), edge, Kind::Door),
        &straight.rings,
    ) {
        true => Ok([first, last]),
        false => Err(wrong(
            &opening.place,
            "has a bend: at stairs it must be one straight line",
        )),
    }
}

/// Adds the fixtures to the flight or to the floor on which they stand.
fn furnish(
    site: &Site,
    flights: &[Flight],
    floors: &[Option<usize>],
    found: &mut DrawnLevels,
) -> Result<(), FloorPlanError> {
    let first_flight = floors.iter().flatten().count();
    for (level, fixture) in &site.fixtures {
        let (middle, _) = Shape::middle(fixture.area()?);
        let mut on = floors[*level];
        for (k, flight) in flights.iter().enumerate() {
            let unit = &site.units[flight.unit];
            if unit.level == *level && unit.shape.area()?.contains(middle) {
                on = Some(first_flight + k);
            }
        }
        if let Some(level) = on {
            found.levels[level].shapes.push(fixture.clone());
        }
    }
    Ok(())
}

/// The names of the flights: those of their units if no other level has them, else with the name of their level.
fn names(site: &Site, flights: &[Flight]) -> Vec<String> {
    let unit = |flight: &Flight| &site.units[flight.unit];
    let own = |flight: &Flight| {
        let name = unit(flight).shape.name.clone();
        name.unwrap_or_else(|| unit(flight).word.clone())
    };
    let mut names: Vec<String> = site
        .storeys
        .iter()
        .map(|storey| storey.name.clone())
        .collect();
    let first = names.len();
    for flight in flights {
        let plain = own(flight);
        let same = |other: &&Flight| own(other) == plain;
        let is_only = flights.iter().filter(same).count() == 1;
        let storey = &site.storeys[unit(flight).level].name;
        let with_level = format!("{plain} ({storey})");
        let numbered = (2..).map(|number| format!("{with_level} {number}"));
        let alone = Some(plain).filter(|_| is_only).into_iter();
        let mut all = alone.chain([with_level.clone()]).chain(numbered);
        let free = all.find(|name| !names.contains(name));
        names.extend(free);
    }
    names.split_off(first)
}
