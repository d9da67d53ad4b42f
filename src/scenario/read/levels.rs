//! A building's document → one in which its levels lie side by side in the plane of the engine.

use std::sync::Arc;

use serde_json::{Value, json};

use crate::error::Problem;
use crate::error::quote::shown;
use crate::floor_plan::{Rings, free, rings};
use crate::keys::levels::{Join, Level, ON_LEVELS};
use crate::read::parsed::parsed;
use crate::read::rides;
use crate::scene::levels::Building;
use crate::scene::surroundings::{OBSTACLES, WALKABLE_AREA};
use engine::geometry::Area;
use engine::levels::Levels;
use engine::math::{Vector, direction, perpendicular, sides};
use engine::routes::nearest_on;

/// The keys of a building.
const LEVELS: &str = "levels";
const JOINS: &str = "joins";
/// The key that says on which level something lies.
const LEVEL: &str = "level";
/// The keys that have a geometry, at any depth.
const GEOMETRY: [&str; 10] = [
    "line", "area", "path", "at", "facing", "position", "goal", "min", "max", "region",
];
/// The keys that a building has not, and why.
const REFUSED: [(&str, &str); 6] = [
    (WALKABLE_AREA, "the levels have their own"),
    (OBSTACLES, "the levels have their own"),
    ("periodic", "a building does not repeat itself"),
    (
        "goal",
        "give people a `goal` on their level, or let them walk to `exits`",
    ),
    ("from", "trajectories on several levels cannot be the start"),
    (
        "interventions",
        "interventions in buildings are not known yet",
    ),
];

/// The floor of the next level goes on this far behind a join, meters.
const REACH: f64 = 10.0;
/// The floor of the next level must go on at least this far behind a join, meters.
const LEAST_REACH: f64 = 0.6;
/// The thickness of the walls between a level and what is seen of the next one beside it, meters.
const THICKNESS: f64 = 0.01;
/// Edges this near to each other are the same, meters.
const SAME: f64 = 1e-6;
/// A door this near to a join lies on it, and an exit is at it, meters.
const ON_JOIN: f64 = 0.05;
const AT_JOIN: f64 = 0.015;

/// A building, side by side.
#[derive(Debug, Clone)]
pub struct SideBySide {
    /// The document of the plane.
    pub document: Value,
    /// The levels.
    pub levels: Arc<Levels>,
    /// The outlines of what is seen of other levels, in the plane: nobody starts there.
    pub seen: Rings,
}

/// The building of a document, side by side; `None` if it has no levels.
///
/// # Errors
/// The first problem, with its place in the document.
pub fn side_by_side(document: &Value) -> Result<Option<SideBySide>, Problem> {
    let given = |key: &str| document.get(key).filter(|value| !is_empty(value));
    let (Some(levels), joins) = (given(LEVELS), given(JOINS)) else {
        let problem = joins_without_levels(document)
            .or_else(|| level_without_levels(document))
            .or_else(|| rides::without_levels(document));
        return problem.map_or(Ok(None), Err);
    };
    for (key, reason) in REFUSED {
        if given(key).is_some() {
            return Err(Problem::new(
                key,
                format!("cannot be with `levels`: {reason}"),
            ));
        }
    }
    let under = |key: &'static str| move |problem: Problem| problem.under(key);
    let levels: Vec<Level> = parsed(levels).map_err(under(LEVELS))?;
    let given_joins: Option<Vec<Join>> = joins.map(parsed).transpose().map_err(under(JOINS))?;
    let joins = given_joins.unwrap_or_default();
    let building = Building::new(&levels, &joins)?;
    check_lines(document, &building)?;
    let mut plane = document.clone();
    let doors = building.doors_of_escalators();
    if !doors.is_empty() {
        if plane["doors"].is_null() {
            plane["doors"] = json!([]);
        }
        // Anything else is rejected later.
        if let Value::Array(all) = &mut plane["doors"] {
            all.extend(doors);
        }
    }
    rides::plan(&mut plane, (&levels, &joins))?;
    place(&mut plane, &building)?;
    let mut found = Laid::default();
    for number in 0..building.levels.all().len() {
        found.lay(&building, number)?;
    }
    plane[WALKABLE_AREA] = found.floors.into();
    plane[OBSTACLES] = found.walls.into();
    Ok(Some(SideBySide {
        document: plane,
        levels: Arc::new(building.levels),
        seen: found.seen,
    }))
}

/// Refuses doors on joins, which would not hold up people from the other level, and exits and entrances at joins, which
/// people could go around over the floor behind.
fn check_lines(document: &Value, building: &Building) -> Result<(), Problem> {
    for (list, ends, fix) in [
        (
            "doors",
            false,
            "lies on the join of {}: draw it 10 cm or more beside that, on one of them",
        ),
        (
            "exits",
            true,
            "touches the join of {}: end it 2 cm or more before that",
        ),
        (
            "entrances",
            true,
            "touches the join of {}: end it 2 cm or more before that",
        ),
    ] {
        let items = document.get(list).and_then(Value::as_array);
        for (k, item) in items.into_iter().flatten().enumerate() {
            let Ok(line) = serde_json::from_value::<[[f64; 2]; 2]>(item["line"].clone()) else {
                continue;
            };
            let line = line.map(Vector::from);
            let mut joins = building.joins_of(item[LEVEL].as_str());
            let at = joins.find(|(join, _)| match ends {
                true => touch(line, *join),
                false => lies_on(line, *join),
            });
            if let Some((_, names)) = at {
                let names = names.map(|name| format!("`{}`", shown(name))).join(" and ");
                return Err(Problem::new(
                    format!("{list}[{k}].line"),
                    fix.replace("{}", &names),
                ));
            }
        }
    }
    Ok(())
}

/// Whether a line lies on a join.
fn lies_on([a, b]: [Vector; 2], [c, d]: [Vector; 2]) -> bool {
    let mut parts = [0.0, 0.5, 1.0].iter().map(|part| a + (b - a) * *part);
    parts.all(|p| (nearest_on(p, c, d) - p).norm() < ON_JOIN)
}

/// Whether a line begins at a join, or a join at a line.
fn touch(line: [Vector; 2], join: [Vector; 2]) -> bool {
    let near = |p: Vector, [a, b]: [Vector; 2]| (nearest_on(p, a, b) - p).norm() < AT_JOIN;
    line.iter().any(|&p| near(p, join)) || join.iter().any(|&p| near(p, line))
}

/// What a document without levels says of joins.
fn joins_without_levels(document: &Value) -> Option<Problem> {
    let joins = document.get(JOINS).filter(|value| !is_empty(value));
    joins.map(|_| Problem::new(JOINS, "there are no `levels` to join"))
}

/// What lies on a level in a document without levels.
fn level_without_levels(document: &Value) -> Option<Problem> {
    ON_LEVELS.iter().find_map(|list| {
        let elements = document.get(list)?.as_array()?;
        let k = elements.iter().position(|element| {
            let kinds = element.as_object().filter(|_| *list == "measurements");
            let mut inner = kinds.into_iter().flatten();
            element.get(LEVEL).is_some() || inner.any(|(_, keys)| keys.get(LEVEL).is_some())
        })?;
        let reason = "is a key of buildings, and there are no `levels`";
        Some(Problem::new(format!("{list}[{k}].level"), reason))
    })
}

fn is_empty(value: &Value) -> bool {
    value.is_null() || value.as_array().is_some_and(Vec::is_empty)
}

/// Moves everything that lies on a level there.
fn place(plane: &mut Value, building: &Building) -> Result<(), Problem> {
    for list in ON_LEVELS {
        for (at, keys) in on_levels(plane, list) {
            let is_idle = list == "measurements" && !keys[LEVEL].is_null() && !is_somewhere(keys);
            if is_idle {
                let reason =
                    "is that of a `region` or `line`, and there is none: give one, or leave it out";
                return Err(Problem::new(format!("{at}.{LEVEL}"), reason));
            }
            place_one(keys, building).map_err(|problem| problem.under(&at))?;
        }
    }
    Ok(())
}

/// The objects of a list that have a level, each with its place: those of measurements lie under their kind.
fn on_levels<'a>(document: &'a mut Value, list: &str) -> Vec<(String, &'a mut Value)> {
    let elements = document.get_mut(list).and_then(Value::as_array_mut);
    let elements = elements.into_iter().flatten().enumerate();
    let mut found = Vec::new();
    for (k, element) in elements {
        let at = format!("{list}[{k}]");
        if list != "measurements" {
            found.push((at, element));
        } else if let Some(kinds) = element.as_object_mut() {
            let inner = kinds.iter_mut().filter(|(_, keys)| keys.is_object());
            found.extend(inner.map(|(kind, keys)| (format!("{at}.{kind}"), keys)));
        }
    }
    found
}

/// The document without the key `level` of what lies on levels.
pub fn without_level(mut document: Value) -> Value {
    for list in ON_LEVELS {
        for (_, keys) in on_levels(&mut document, list) {
            if let Some(keys) = keys.as_object_mut() {
                keys.remove(LEVEL);
            }
        }
    }
    document
}

/// Whether an object has a geometry.
fn is_somewhere(keys: &Value) -> bool {
    let mut all = GEOMETRY.iter();
    all.any(|key| keys[*key].is_array())
}

fn place_one(element: &mut Value, building: &Building) -> Result<(), Problem> {
    let is_somewhere = is_somewhere(element);
    let Some(keys) = element.as_object_mut() else {
        return Ok(());
    };
    let level = keys.remove(LEVEL).filter(|level| !level.is_null());
    match level {
        Some(Value::String(name)) => {
            let way = building.levels.way(building.number(&name)? as i32);
            shift(element, way.x, false);
            Ok(())
        }
        Some(_) => Err(Problem::new(LEVEL, "must be the name of a level")),
        None if is_somewhere => {
            let names = building.levels.all().iter();
            let names: Vec<String> = names
                .map(|level| format!("`{}`", shown(&level.name)))
                .collect();
            let reason = format!("missing key `level`: one of {}", names.join(", "));
            Err(Problem::new("", reason))
        }
        None => Ok(()),
    }
}

/// Moves the points under the keys of geometries by `x` along x; `is_geometry`: `value` lies under such a key.
fn shift(value: &mut Value, x: f64, is_geometry: bool) {
    match value {
        Value::Object(keys) => {
            for (key, value) in keys {
                shift(value, x, GEOMETRY.contains(&key.as_str()));
            }
        }
        Value::Array(list) if is_geometry => match &mut list[..] {
            [first, second] if first.is_number() && second.is_number() => {
                *first = json!(first.as_f64().unwrap_or_default() + x);
            }
            list => list.iter_mut().for_each(|value| shift(value, x, true)),
        },
        _ => {}
    }
}

/// Levels in the plane.
#[derive(Default)]
struct Laid {
    /// Polygons to walk on, each with its rings.
    floors: Vec<Value>,
    walls: Vec<Value>,
    seen: Rings,
}

impl Laid {
    /// Lays a level with what is seen of those beyond its joins.
    fn lay(&mut self, building: &Building, number: usize) -> Result<(), Problem> {
        let levels = building.levels.all();
        let own = &levels[number].floor;
        let way = building.levels.way(number as i32);
        self.floors
            .extend(own.iter().map(|area| polygon(area, way)));
        let mut before: Vec<Area> = Vec::new();
        for (k, &(line, between)) in building.joins.iter().enumerate() {
            let (line, other) = match between {
                [one, other] if one == number => (line, other),
                [other, one] if one == number => ([line[1], line[0]], other),
                _ => continue,
            };
            let found = seen_beyond(line, own, &levels[other].floor);
            let seen = found.map_err(|problem| problem.under(&format!("joins[{k}].line")))?;
            for area in &seen {
                self.floors.push(polygon(area, way));
                let outline = area.exterior.points().iter();
                self.seen.push(outline.map(|&p| p + way).collect());
            }
            let beside = walls_between(own, &seen, Some(line));
            let walls = beside.chain(walls_between(&before, &seen, None));
            self.walls.extend(walls.map(|wall| ring(&wall, way)));
            before.extend(seen);
        }
        Ok(())
    }
}

fn ring(points: &[Vector], way: Vector) -> Value {
    points.iter().map(|p| json!([p.x + way.x, p.y])).collect()
}

fn polygon(area: &Area, way: Vector) -> Value {
    area.rings()
        .map(|given| ring(given.points(), way))
        .collect()
}

/// The floor of the next level as far as it is seen over a join, whose level lies on the left of the way from its first
/// to its second end: as far as it does not lie above or below the `own` floor.
fn seen_beyond([a, b]: [Vector; 2], own: &[Area], other: &[Area]) -> Result<Vec<Area>, Problem> {
    let along = direction(b - a);
    let beyond = -perpendicular(along);
    let middle = (a + b) / 2.0 + beyond * (0.1 * LEAST_REACH);
    let mut reach = REACH;
    while reach >= LEAST_REACH {
        let side = along * reach;
        let depth = beyond * reach;
        let frame = vec![a - side, a - side + depth, b + side + depth, b + side];
        let all = free(&[rings(other), vec![frame]], &Rings::new()).map_err(Problem::from)?;
        let near: Vec<Area> = all
            .into_iter()
            .filter(|area| area.contains(middle))
            .collect();
        let both = free(&[rings(&near), rings(own)], &Rings::new()).map_err(Problem::from)?;
        if both.is_empty() {
            return Ok(near);
        }
        reach *= 0.8;
    }
    let reason = format!(
        "the two levels overlap right behind it: the floor of each must go on beyond the edge for {LEAST_REACH} m \
         without lying above the other"
    );
    Err(Problem::new("", reason))
}

/// Thin walls on the `own` floor along the edges that it shares with what is `seen` of the next level, but for the
/// join.
fn walls_between(
    own: &[Area],
    seen: &[Area],
    join: Option<[Vector; 2]>,
) -> impl Iterator<Item = Vec<Vector>> {
    let edges = |areas: &[Area]| -> Vec<[Vector; 2]> {
        let rings = areas.iter().flat_map(Area::rings);
        rings
            .flat_map(|ring| {
                sides(ring.points())
                    .map(|(a, b)| [a, b])
                    .collect::<Vec<_>>()
            })
            .collect()
    };
    let mut walls = Vec::new();
    for [a, b] in edges(own) {
        let along = direction(b - a);
        let length = (b - a).norm();
        let part = |p: Vector| (p - a).dot(&along);
        let lies_on =
            |[c, d]: [Vector; 2]| [c, d].iter().all(|p| along.perp(&(p - a)).abs() < SAME);
        for [c, d] in edges(seen).into_iter().filter(|&edge| lies_on(edge)) {
            let [from, to] = [
                part(c).min(part(d)).max(0.0),
                part(c).max(part(d)).min(length),
            ];
            let of_join = join
                .filter(|&join| lies_on(join))
                .map(|join| join.map(part));
            // Walls between what is seen beyond two joins taper to a point: their ends would narrow these joins.
            let taper = if join.is_none() { 2.0 * THICKNESS } else { 0.0 };
            let free = of_join.map_or([f64::INFINITY; 2], |[c, d]| [c.min(d), c.max(d)]);
            for [from, to] in [[from, to.min(free[0])], [from.max(free[1]), to]] {
                if to - from > SAME.max(2.0 * taper) {
                    let inward =
                        own_side(own, a + along * ((from + to) / 2.0), perpendicular(along));
                    let [p, q] = [from, to].map(|at| a + along * at);
                    let (deep, short) = (inward * THICKNESS, along * taper);
                    walls.push(vec![p, q, q + deep - short, p + deep + short]);
                }
            }
        }
    }
    walls.into_iter()
}

/// The one of two opposite directions in which the `own` floor lies at `p` on its edge.
fn own_side(own: &[Area], p: Vector, normal: Vector) -> Vector {
    let inside = own
        .iter()
        .any(|area| area.contains(p + normal * (0.5 * THICKNESS)));
    if inside { normal } else { -normal }
}
