//! The storeys and stairs of a file as levels of a building.

use libm::hypot;

use super::storeys::Room;
use super::{Door, OUTSIDE, Site, read, wrong};
use crate::error::quote::{shown, to_centimeters};
use crate::floor_plan::drawn_levels::{DrawnLevel, DrawnLevels, LevelForm, PlanJoin};
use crate::floor_plan::error::FloorPlanError;
use crate::floor_plan::reading::Reading;
use crate::floor_plan::shape::Shape;
use crate::floor_plan::units::Unit;
use engine::math::{Vector, direction};
use engine::routes::nearest_on;

/// Floors at heights this near to each other are one level, meters.
const SAME_HEIGHT: f64 = 0.01;
/// Joins end this far before walls between rooms, meters.
const BEFORE_WALLS: f64 = 0.02;
/// A slope that differs by more than this from that of its joins is noted, meters per meter.
const SAME_SLOPE: f64 = 0.02;

/// Rooms that are one level.
struct Storey {
    name: String,
    form: LevelForm,
    /// The numbers of its rooms.
    rooms: Vec<usize>,
}

/// The levels of `text`: the flat rooms of one height are a floor, and each stair is a level of its own. Crossings and
/// transitions between two levels join them.
pub fn levels(text: &str, reading: &Reading) -> Result<DrawnLevels, FloorPlanError> {
    if reading.storey.is_some() {
        let reason = "takes one storey, and `levels` takes all: remove it";
        return Err(wrong("plan.storey", reason.to_owned()));
    }
    read(text, |site| of_site(site, reading))
}

fn of_site(site: Site, reading: &Reading) -> Result<DrawnLevels, FloorPlanError> {
    let Site {
        mut drawn,
        rooms,
        doors,
        meters,
    } = site;
    let typed = reading.unit.as_deref().map(Unit::named).transpose()?;
    let meters = meters * typed.map_or(1.0, |unit| unit.length);
    let storeys = storeys(&rooms, meters);
    let sides: Vec<[[String; 2]; 2]> = doors
        .iter()
        .map(|door| door.sides.map(|side| side.map(str::to_owned)))
        .collect();
    let first_door = drawn.shapes.len();
    drawn.shapes.extend(doors.into_iter().map(Door::shape));
    drawn.place(reading)?;
    let mut found = DrawnLevels {
        notes: drawn.notes,
        ..DrawnLevels::default()
    };
    found.notes.extend(escalators(&rooms));
    for storey in &storeys {
        let own = storey.rooms.iter();
        let shapes = own.flat_map(|&room| drawn.shapes[rooms[room].shapes.clone()].iter());
        found.levels.push(DrawnLevel {
            name: storey.name.clone(),
            form: storey.form,
            shapes: shapes.cloned().collect(),
        });
    }
    join(
        &mut found,
        (&storeys, &rooms, &drawn.shapes),
        (&sides, first_door),
    )?;
    for (level, storey) in storeys.iter().enumerate() {
        let room = &rooms[storey.rooms[0]];
        if !matches!(storey.form, LevelForm::Floor(_)) {
            let note = check_slope(level, room, &found)?;
            found.notes.extend(note);
        }
    }
    Ok(found)
}

/// Adds crossings and transitions, whose shapes begin at the number `first_door`: as doors of the levels on their
/// sides, or as joins between two levels.
fn join(
    found: &mut DrawnLevels,
    (storeys, rooms, shapes): (&[Storey], &[Room], &[Shape]),
    (sides, first_door): (&[[[String; 2]; 2]], usize),
) -> Result<(), FloorPlanError> {
    let level_of = |side: &[String; 2]| {
        let room = rooms.iter().position(|room| room.side == *side)?;
        let is_of = |storey: &Storey| storey.rooms.contains(&room);
        storeys.iter().position(is_of)
    };
    for (sides, door) in sides.iter().zip(&shapes[first_door..]) {
        let of = [&sides[0], &sides[1]].map(level_of);
        let mut beside: Vec<usize> = of.into_iter().flatten().collect();
        beside.dedup();
        for level in beside {
            found.levels[level].shapes.push(door.clone());
        }
        match of {
            [Some(one), Some(other)] if one != other => {
                let meet = |end: [f64; 2]| {
                    let mut both = [one, other].into_iter();
                    both.any(|level| touching(&storeys[level], end, rooms, shapes) > 1)
                };
                found.joins.push(PlanJoin {
                    levels: [one, other],
                    line: between_walls(straight(door)?, meet),
                });
            }
            [Some(_), Some(_)] => {}
            _ if sides.iter().any(|[room, _]| room == OUTSIDE) => {}
            _ => {
                let note = "joins nothing: no room that is read lies on one of its sides";
                found.notes.push(format!("{}: {note}", shown(&door.place)));
            }
        }
    }
    Ok(())
}

/// The levels: floors from the lowest up, then stairs.
fn storeys(rooms: &[Room], meters: f64) -> Vec<Storey> {
    let numbered = || rooms.iter().enumerate();
    let mut flat: Vec<(usize, f64)> = numbered()
        .filter_map(|(k, room)| Some((k, room.height? * meters)))
        .collect();
    flat.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut storeys: Vec<Storey> = Vec::new();
    for (k, height) in flat {
        match storeys.last_mut() {
            Some(Storey {
                form: LevelForm::Floor(own),
                rooms,
                ..
            }) if height - *own < SAME_HEIGHT => rooms.push(k),
            _ => storeys.push(Storey {
                name: String::new(),
                form: LevelForm::Floor(height),
                rooms: vec![k],
            }),
        }
    }
    for storey in &mut storeys {
        storey.rooms.sort_unstable();
    }
    let sloped = numbered().filter(|(_, room)| room.height.is_none() && !is_escalator(room));
    storeys.extend(sloped.map(|(k, room)| Storey {
        name: String::new(),
        form: match room.class.contains("stair") {
            true => LevelForm::Stairs,
            false => LevelForm::Ramp,
        },
        rooms: vec![k],
    }));
    name(&mut storeys, rooms);
    storeys
}

/// Names levels by the captions of their rooms where these tell them apart, else floors by their heights, and stairs by
/// the numbers of their rooms.
fn name(storeys: &mut [Storey], rooms: &[Room]) {
    let captions = |storey: &Storey| -> [Option<String>; 2] {
        let first = &rooms[storey.rooms[0]];
        let common = |of: fn(&Room) -> &Option<String>| {
            let same = storey.rooms.iter().all(|&k| of(&rooms[k]) == of(first));
            of(first).clone().filter(|_| same)
        };
        let own = common(|room| &room.caption);
        match storey.form {
            LevelForm::Floor(_) => [common(|room| &room.storey), own],
            _ => [own, common(|room| &room.storey)],
        }
    };
    let all: Vec<[Option<String>; 2]> = storeys.iter().map(captions).collect();
    let is_own = |k: usize, name: &String| {
        let mut others = all.iter().enumerate().filter(|(other, _)| *other != k);
        !others.any(|(_, names)| names.iter().flatten().any(|other| other == name))
    };
    let names: Vec<Option<String>> = (0..all.len())
        .map(|k| {
            all[k]
                .iter()
                .flatten()
                .find(|name| is_own(k, name))
                .cloned()
        })
        .collect();
    for (storey, own) in storeys.iter_mut().zip(names) {
        storey.name = own.unwrap_or_else(|| match storey.form {
            LevelForm::Floor(height) => format!("{} m", to_centimeters(height)),
            _ => {
                let [room, subroom] = &rooms[storey.rooms[0]].side;
                format!("room {room}, subroom {subroom}")
            }
        });
    }
}

fn is_escalator(room: &Room) -> bool {
    room.class.contains("escalator")
}

/// A note on escalators, if there are any.
fn escalators(rooms: &[Room]) -> Option<String> {
    let all: Vec<String> = rooms
        .iter()
        .filter(|room| is_escalator(room))
        .map(|room| shown(&room.name))
        .collect();
    (!all.is_empty()).then(|| format!("escalators are left out: {}", all.join("; ")))
}

/// The ends of a door between two levels, which is one straight line.
fn straight(door: &Shape) -> Result<[[f64; 2]; 2], FloorPlanError> {
    let points = &door.rings[0];
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return Err(FloorPlanError::EmptyGeometry(door.place.clone()));
    };
    let [a, b] = [first, last].map(Vector::from);
    let off = |p: &[f64; 2]| {
        let way = (b - a).normalize();
        way.perp(&(Vector::from(*p) - a)).abs()
    };
    match a != b && points.iter().all(|p| off(p) < SAME_HEIGHT) {
        true => Ok([first, last]),
        false => {
            let reason = "joins two levels and must be one straight line: two vertices".to_owned();
            Err(wrong(&door.place, reason))
        }
    }
}

/// The number of rooms of a level whose edges pass through a point.
fn touching(storey: &Storey, p: [f64; 2], rooms: &[Room], shapes: &[Shape]) -> usize {
    let p = Vector::from(p);
    let touches = |shape: &Shape| {
        let rings = shape.rings.iter();
        let edges = rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
        let mut ends = edges.map(|(&a, &b)| [a, b].map(Vector::from));
        ends.any(|[a, b]| (nearest_on(p, a, b) - p).norm() < SAME_HEIGHT)
    };
    let touching = storey.rooms.iter();
    touching
        .filter(|&&room| shapes[rooms[room].shapes.clone()].iter().any(touches))
        .count()
}

/// A line that ends [`BEFORE_WALLS`] earlier where rooms `meet`: the wall between them may end there.
fn between_walls([a, b]: [[f64; 2]; 2], meet: impl Fn([f64; 2]) -> bool) -> [[f64; 2]; 2] {
    [(a, b), (b, a)].map(|(end, other)| {
        let inward = direction(Vector::from(other) - Vector::from(end)) * BEFORE_WALLS;
        match meet(end) {
            true => (Vector::from(end) + inward).into(),
            false => end,
        }
    })
}

/// Refuses a stair that does not lead from one height to another; a note if it rises by another slope than the file
/// says.
fn check_slope(
    level: usize,
    room: &Room,
    found: &DrawnLevels,
) -> Result<Option<String>, FloorPlanError> {
    let mut ends: Vec<(f64, Vector, &str)> = Vec::new();
    for join in found
        .joins
        .iter()
        .filter(|join| join.levels.contains(&level))
    {
        let other = &found.levels[join.levels[usize::from(join.levels[0] == level)]];
        if let LevelForm::Floor(height) = other.form {
            let [a, b] = join.line.map(Vector::from);
            ends.push((height, (a + b) / 2.0, &other.name));
        }
    }
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let name = || shown(&found.levels[level].name);
    let (Some(low), Some(high)) = (ends.first(), ends.last()) else {
        let reason = "it leads to no floor; write a <crossing> or <transition> at each of its ends";
        return Err(wrong(&room.name, format!("`{}`: {reason}", name())));
    };
    if high.0 - low.0 < SAME_HEIGHT {
        let reason = format!(
            "`{}`: it joins only `{}`, at {} m; a stair needs crossings or transitions to floors of two heights, and \
             between two flights a flat subroom",
            name(),
            shown(low.2),
            to_centimeters(low.0)
        );
        return Err(wrong(&room.name, reason));
    }
    let [along, across] = room.rise;
    let given = hypot(along, across);
    // The ends of a stair need not lie opposite each other: only its height tells.
    let rise = Vector::new(along, across).dot(&(high.1 - low.1));
    let length = (high.1 - low.1).norm();
    let is_other = given > 0.0 && (rise - (high.0 - low.0)).abs() > SAME_SLOPE * length;
    Ok(is_other.then(|| {
        format!(
            "{}: its plane (A_x, B_y) rises {} m between its ends, the floors there {} m, which count",
            shown(&room.name),
            to_centimeters(rise),
            to_centimeters(high.0 - low.0)
        )
    }))
}
