//! The levels of a building: their floors, heights and joins.

use crate::error::quote::{shown, to_centimeters};
use crate::error::{Problem, Under, suggestion};
use crate::floor_plan::{FloorPlan, Rings, free, rings};
use crate::keys::levels::{Join, Level, LevelKind, Runs, Speeds};
use crate::keys::shapes::{Outline, Ring};
use engine::agents::Agents;
use engine::geometry::Area;
use engine::levels::{FARTHEST, Level as Sheet, Levels};
use engine::math::{Vector, direction, perpendicular, sides};
use engine::scene::Scene;
use serde_json::{Value, json};

/// Levels have the same height at a join within this, meters.
const SAME_HEIGHT: f64 = 0.05;
/// The floor must reach a join at these parts of it.
const AT_JOIN: [f64; 9] = [0.02, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.98];
const AT_ENDS: [f64; 2] = [0.02, 0.98];
/// Stairs and ramps that rise more than this, meters per meter, are noted.
const STEEP: [(LevelKind, f64); 3] = [
    (LevelKind::Stairs, 1.0),
    (LevelKind::Ramp, 0.15),
    (LevelKind::Escalator, 0.8),
];
/// The usual speed of escalators along the slope, m/s (EN 115: at most 0.5 where they rise by more than 30°).
const BELT_SPEED: f64 = 0.5;
/// The least speed factor on stairs and ramps.
const SLOWEST_FACTOR: f64 = 0.01;
const OF_ESCALATORS: &str = "`runs` and `belt_speed` are for levels of the kind `escalator`";
/// The one-way door of an escalator lies this far behind its entrance, meters.
const DOOR_BEHIND: f64 = 0.3;
/// Beside a join is what lies this far from it, meters.
const BESIDE: f64 = 1e-3;
/// The preferred speeds on a floor, up and down stairs, seen from above, m/s (Weidmann 1993).
const WEIDMANN: [f64; 3] = [1.34, 0.610, 0.694];

/// Refuses people of a building who look so far that they would see those on the next level of the engine's plane.
pub fn check_reach(scene: &Scene) -> Result<(), Problem> {
    let ranges = scene.ranges(&scene.needs(), &Agents::default());
    let radii = [ranges.avoidance, ranges.wide, Some(ranges.support)];
    let farthest = radii.into_iter().flatten().fold(0.0, f64::max);
    if scene.levels.is_none() || farthest <= FARTHEST {
        return Ok(());
    }
    let reason = format!(
        "people look {} m far, and in buildings at most {FARTHEST} m: lower `avoidance_radius`, `support_radius` or \
         preferred speeds",
        to_centimeters(farthest)
    );
    Err(Problem::new("levels", reason))
}

/// Notes on stairs and ramps that are steeper than real ones.
pub fn steep(keys: &[Level], levels: Option<&Levels>) -> Vec<String> {
    let sheets = levels.map_or(&[][..], Levels::all).iter();
    let numbered = keys.iter().zip(sheets).enumerate();
    let note = |(k, (level, sheet)): (usize, (&Level, &Sheet))| {
        let (_, most) = STEEP.iter().find(|(kind, _)| *kind == level.kind)?;
        let rise = sheet.rise.norm();
        (rise > most + 1e-9).then(|| {
            format!(
                "levels[{k}]: `{}` rises {} m per meter: check elevations, and that the unit is meters",
                shown(&level.name),
                to_centimeters(rise)
            )
        })
    };
    numbered.filter_map(note).collect()
}

/// The line of a join in the building, meters, and the numbers of its levels, the first of which lies on its left.
pub type Joined = ([Vector; 2], [usize; 2]);

/// The levels of a building with what people can walk on.
pub struct Building {
    /// The levels, side by side in the plane of the engine.
    pub levels: Levels,
    /// The joins in the building.
    pub joins: Vec<Joined>,
}

impl Building {
    /// The building of a file.
    ///
    /// # Errors
    /// The first problem, with its place in the file.
    pub fn new(levels: &[Level], joins: &[Join]) -> Result<Self, Problem> {
        let mut floors = Vec::with_capacity(levels.len());
        for (k, level) in levels.iter().enumerate() {
            floors.push(floor(level).under(&format!("levels[{k}]"))?);
            if levels[..k].iter().any(|other| other.name == level.name) {
                let reason = format!("there are two levels named `{}`", shown(&level.name));
                return Err(Problem::new(format!("levels[{k}].name"), reason));
            }
        }
        let mut found = Vec::with_capacity(joins.len());
        for (k, join) in joins.iter().enumerate() {
            let read = oriented(join, levels, &floors);
            found.push(read.under(&format!("joins[{k}]"))?);
        }
        let mut sheets = Vec::with_capacity(levels.len());
        for (k, level) in levels.iter().enumerate() {
            let floor = floors[k].clone();
            sheets.push(sheet(k, (levels, &found), floor).map_err(|reason| {
                let of = format!("`{}`: {reason}", shown(&level.name));
                Problem::new(format!("levels[{k}]"), of)
            })?);
        }
        for (k, (line, between)) in found.iter().enumerate() {
            check_heights(*line, between.map(|number| &sheets[number]))
                .under(&format!("joins[{k}].line"))?;
        }
        let mut side_by_side = Levels::new(sheets);
        for &(line, between) in &found {
            side_by_side.join(line, between);
        }
        Ok(Self {
            levels: side_by_side,
            joins: found,
        })
    }

    /// The doors that let people onto escalators at their entrances only, as keys of a file: their lines lie across the
    /// level, from wall to wall.
    pub fn doors_of_escalators(&self) -> Vec<Value> {
        let numbered = self.levels.all().iter().enumerate();
        let moving = numbered.filter(|(_, level)| level.carries != Vector::zeros());
        let door = |(k, level): (usize, &Sheet)| {
            let of_level = self
                .joins
                .iter()
                .filter(|(_, between)| between.contains(&k));
            let middles = of_level.map(|([a, b], _)| (a + b) / 2.0);
            let along = |p: &Vector| level.carries.dot(p);
            let entrance = middles.min_by(|p, q| along(p).total_cmp(&along(q)))?;
            let ahead = direction(level.carries);
            let line = across(
                &level.floor,
                entrance + ahead * DOOR_BEHIND,
                perpendicular(ahead),
            )?;
            Some(json!({
                "name": format!("onto {}", level.name),
                "level": level.name,
                "line": line.map(|p| [p.x, p.y]),
                "one_way": [ahead.x, ahead.y],
            }))
        };
        moving.filter_map(door).collect()
    }

    /// The joins of the level of this name, each with the names of its two levels.
    pub fn joins_of<'a>(
        &'a self,
        level: Option<&'a str>,
    ) -> impl Iterator<Item = ([Vector; 2], [&'a str; 2])> {
        let named = self.joins.iter().map(|&(line, between)| {
            let names = between.map(|number| self.levels.all()[number].name.as_str());
            (line, names)
        });
        named.filter(move |(_, names)| names.iter().any(|name| Some(*name) == level))
    }

    /// The number of the level of this name.
    pub fn number(&self, name: &str) -> Result<usize, Problem> {
        let names = || self.levels.all().iter().map(|level| level.name.as_str());
        names().position(|other| other == name).ok_or_else(|| {
            let near = suggestion(name, names());
            let all: Vec<String> = names().map(|name| format!("`{}`", shown(name))).collect();
            let known = match near.is_empty() {
                true => format!("; there are {}", all.join(", ")),
                false => near,
            };
            Problem::new(
                "level",
                format!("there is no level named `{}`{known}", shown(name)),
            )
        })
    }
}

/// The line over a floor through `p` in a direction, from edge to edge.
fn across(floor: &[Area], p: Vector, along: Vector) -> Option<[Vector; 2]> {
    let rings = floor.iter().flat_map(Area::rings);
    let edges = rings.flat_map(|ring| sides(ring.points()).collect::<Vec<_>>());
    let crossed = edges.filter_map(|(a, b)| {
        let [left, right] = [a, b].map(|end| along.perp(&(end - p)));
        let crosses = (left > 0.0) != (right > 0.0);
        crosses.then(|| (a + (b - a) * (left / (left - right)) - p).dot(&along))
    });
    let meets: Vec<f64> = crossed.collect();
    let [before, after] = [
        meets
            .iter()
            .copied()
            .filter(|at| *at < 0.0)
            .reduce(f64::max),
        meets
            .iter()
            .copied()
            .filter(|at| *at >= 0.0)
            .reduce(f64::min),
    ];
    Some([before?, after?].map(|at| p + along * at))
}

/// The free floor of a level.
fn floor(level: &Level) -> Result<Vec<Area>, Problem> {
    let points = |Ring(ring): &Ring| ring.iter().map(|point| point.0).collect::<Vec<[f64; 2]>>();
    let polygons: Vec<Vec<Vec<[f64; 2]>>> = level
        .walkable_area
        .iter()
        .map(|polygon| polygon.iter().map(points).collect())
        .collect();
    let plan = FloorPlan::walkable(&polygons)
        .map_err(Problem::from)
        .under("walkable_area")?;
    let mut bodies = Rings::new();
    for (k, given) in level.obstacles.iter().enumerate() {
        let place = format!("obstacles[{k}]");
        let given: Vec<Vec<[f64; 2]>> = given.rings().iter().map(points).collect();
        let walls = match &level.obstacles[k] {
            Outline::Ring(_) => FloorPlan::wall(&given[0])
                .map_err(Problem::from)
                .under(&place)?,
            Outline::Rings(_) => None,
        };
        let areas = match walls {
            Some(walls) => walls,
            None => vec![
                FloorPlan::obstacle(&given)
                    .map_err(Problem::from)
                    .under(&place)?,
            ],
        };
        bodies.extend(rings(&areas));
    }
    let free = free(&[rings(&plan.walkable)], &bodies);
    free.map_err(Problem::from).under("walkable_area")
}

/// The line of a join, turned so that the first of its levels lies on its left.
fn oriented(join: &Join, levels: &[Level], floors: &[Vec<Area>]) -> Result<Joined, Problem> {
    let number = |k: usize| {
        let name = &join.levels[k];
        let found = levels.iter().position(|level| level.name == *name);
        found.ok_or_else(|| {
            let near = suggestion(name, levels.iter().map(|level| level.name.as_str()));
            let reason = format!("there is no level named `{}`{near}", shown(name));
            Problem::new(format!("levels[{k}]"), reason)
        })
    };
    let between = [number(0)?, number(1)?];
    if between[0] == between[1] {
        return Err(Problem::new("levels", "a join needs two different levels"));
    }
    let [a, b] = join.line.map(Vector::from);
    if a == b {
        return Err(Problem::new("line", "has no length"));
    }
    let left = perpendicular(direction(b - a)) * BESIDE;
    let lies = |number: usize, way: Vector, parts: &[f64]| {
        let mut parts = parts.iter();
        parts.all(|part| {
            let p = a + (b - a) * *part + way;
            floors[number].iter().any(|area| area.contains(p))
        })
    };
    let sides_of = |parts: &[f64]| {
        between.map(|number| [lies(number, left, parts), lies(number, -left, parts)])
    };
    match sides_of(&AT_JOIN) {
        [[true, false], [false, true]] => Ok(([a, b], between)),
        [[false, true], [true, false]] => Ok(([b, a], between)),
        sides => {
            let names = between.map(|number| levels[number].name.as_str());
            Err(not_an_edge(names, [sides, sides_of(&AT_ENDS)]))
        }
    }
}

/// The problem of a join of two levels, from where the floor of each lies along all of it, and at its ends: on its left
/// and on its right.
fn not_an_edge(names: [&str; 2], [sides, ends]: [[[bool; 2]; 2]; 2]) -> Problem {
    let of_level = |k: usize| {
        let name = shown(names[k]);
        match (sides[k], ends[k]) {
            ([true, true], _) => Some(format!("`{name}` lies on both sides of it")),
            ([false, false], [false, false]) => {
                Some(format!("`{name}` lies on neither side of it"))
            }
            ([false, false], _) => Some(format!(
                "`{name}` has a wall or an obstacle at a part of it"
            )),
            _ => None,
        }
    };
    let same = || "both lie on the same side of it".to_owned();
    let wrong = of_level(0).or_else(|| of_level(1)).unwrap_or_else(same);
    let reason = format!("must be an edge of both levels, from end to end: {wrong}");
    Problem::new("line", reason)
}

/// The plane of a floor.
fn flat(level: &Level, floor: Vec<Area>) -> Result<Sheet, String> {
    let elevation = level.elevation.ok_or("a floor needs an `elevation`")?;
    if level.speeds.is_some() || level.speed_factors.is_some() {
        return Err("`speeds` and `speed_factors` are for stairs and ramps".to_owned());
    }
    if level.runs.is_some() || level.belt_speed.is_some() {
        return Err(OF_ESCALATORS.to_owned());
    }
    Ok(Sheet {
        name: level.name.clone(),
        at: Vector::zeros(),
        elevation,
        rise: Vector::zeros(),
        speed_factors: [1.0; 2],
        carries: Vector::zeros(),
        floor,
    })
}

/// The plane of level `k`.
fn sheet(
    k: usize,
    (levels, joins): (&[Level], &[Joined]),
    floor: Vec<Area>,
) -> Result<Sheet, String> {
    let level = &levels[k];
    if level.kind == LevelKind::Floor {
        return flat(level, floor);
    }
    if level.elevation.is_some() {
        return Err("stairs and ramps have the heights of the floors that they join".to_owned());
    }
    let ends = joins.iter().filter_map(|&(line, between)| {
        let other = match between {
            [one, other] if one == k => other,
            [other, one] if one == k => other,
            _ => return None,
        };
        Some((line, levels[other].elevation?))
    });
    let lowest = ends.clone().min_by(|a, b| a.1.total_cmp(&b.1));
    let highest = ends.max_by(|a, b| a.1.total_cmp(&b.1));
    let (Some(([a, b], low)), Some((upper, high))) = (lowest, highest) else {
        return Err("join it to floors at its lower and at its upper end".to_owned());
    };
    let along = direction(b - a);
    let normal = perpendicular(along);
    let far = ((upper[0] + upper[1]) / 2.0 - a).dot(&normal);
    if high - low < SAME_HEIGHT || far.abs() < SAME_HEIGHT {
        return Err(format!(
            "it needs joins with floors of two heights, one at its lower and one at its upper end; all are at {} m",
            to_centimeters(low)
        ));
    }
    let rise = normal * ((high - low) / far);
    Ok(Sheet {
        name: level.name.clone(),
        at: a,
        elevation: low,
        rise,
        speed_factors: speed_factors(level, rise)?,
        carries: carries(level, rise)?,
        floor,
    })
}

/// The velocity at which an escalator carries people, seen from above, m/s.
fn carries(level: &Level, rise: Vector) -> Result<Vector, String> {
    let is_escalator = level.kind == LevelKind::Escalator;
    match (level.runs, level.belt_speed) {
        (None, None) if !is_escalator => Ok(Vector::zeros()),
        (Some(runs), speed) if is_escalator => {
            let along = speed.unwrap_or(BELT_SPEED) / (1.0 + rise.norm_squared()).sqrt();
            Ok(match runs {
                Runs::Up => direction(rise) * along,
                Runs::Down => direction(-rise) * along,
            })
        }
        (None, _) if is_escalator => {
            Err("an escalator `runs` `up` or `down`: say which".to_owned())
        }
        _ => Err(OF_ESCALATORS.to_owned()),
    }
}

/// The speeds along a slope, up and down, over that on a floor.
fn speed_factors(level: &Level, rise: Vector) -> Result<[f64; 2], String> {
    let least = level
        .speed_factors
        .map(|factors| factors[0].min(factors[1]));
    if level.kind != LevelKind::Escalator && least.is_some_and(|least| least < SLOWEST_FACTOR) {
        return Err(format!("`speed_factors` must be at least {SLOWEST_FACTOR}"));
    }
    Ok(match (level.speed_factors, level.speeds, level.kind) {
        (Some(_), Some(_), _) => return Err("give `speeds` or `speed_factors`".to_owned()),
        (None, None, LevelKind::Escalator) => [0.0; 2],
        (_, Some(_), LevelKind::Escalator) => {
            return Err(
                "an escalator has `belt_speed`; `speed_factors` are those of people who walk on it"
                    .to_owned(),
            );
        }
        (Some(factors), None, _) => factors,
        (None, Some(Speeds::Same), _) | (None, None, LevelKind::Ramp) => [1.0; 2],
        _ => {
            let [flat, up, down] = WEIDMANN;
            [up, down].map(|speed| speed / flat * (1.0 + rise.norm_squared()).sqrt())
        }
    })
}

/// Checks that two levels have the same height along a join.
fn check_heights(line: [Vector; 2], sheets: [&Sheet; 2]) -> Result<(), Problem> {
    for p in line {
        let [one, other] = sheets.map(|sheet| sheet.height(p));
        if (one - other).abs() > SAME_HEIGHT {
            let reason = format!(
                "at ({}, {}) `{}` is at {} m and `{}` at {} m",
                p.x,
                p.y,
                shown(&sheets[0].name),
                to_centimeters(one),
                shown(&sheets[1].name),
                to_centimeters(other),
            );
            return Err(Problem::new("", reason));
        }
    }
    Ok(())
}

/// A text for people, in which places of the plane become those of a building, if it is one: `(x, y) on `level``.
pub fn in_building(levels: Option<&Levels>, text: &str) -> String {
    let Some(levels) = levels else {
        return text.to_owned();
    };
    let mut said = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(open) = rest.find('(') {
        let (before, after) = rest.split_at(open);
        said.push_str(before);
        let point = after[1..].split_once(')').and_then(|(inside, behind)| {
            let (x, y) = inside.split_once(", ")?;
            let place = Vector::new(x.parse().ok()?, y.parse().ok()?);
            Some((place, behind))
        });
        match point {
            Some((place, behind)) => {
                let level = &levels.all()[levels.level(place)];
                let own = levels.in_building(place).map(to_centimeters);
                let name = shown(&level.name);
                said.push_str(&format!("({}, {}) on `{name}`", own.x, own.y));
                rest = behind;
            }
            None => {
                said.push('(');
                rest = &after[1..];
            }
        }
    }
    said + rest
}
