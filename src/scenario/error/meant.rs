//! What a wrong value at its place in a scenario probably meant: the name of a place where a goal is expected, a line
//! with more than two points.

use serde_json::Value;

use crate::scenario::error::Problem;
use crate::scenario::error::quote::shown;

/// The lists of a scenario whose elements have names that people can walk to, with what one of them is.
const PLACES: [(&str, &str); 5] = [
    ("exits", "an exit"),
    ("waypoints", "a waypoint"),
    ("waiting_areas", "a waiting area"),
    ("queues", "a queue"),
    ("doors", "a door"),
];

/// A problem in `document`, with a clearer reason if the value at its path has one.
pub fn clearer(problem: Problem, document: &Value) -> Problem {
    let Some(value) = value_at(document, &problem.path) else {
        return problem;
    };
    let (parent, key) = problem.path.rsplit_once('.').unwrap_or(("", &problem.path));
    let reason = match (key, value) {
        ("goal", Value::String(name)) => named(document, name),
        ("line", Value::Array(points)) if points.iter().all(Value::is_array) => {
            not_two(parent, points.len())
        }
        _ => None,
    };
    match reason {
        Some(reason) => Problem::new(problem.path, reason),
        None => problem,
    }
}

/// The value at a path such as `crowds[0].goal`.
fn value_at<'a>(document: &'a Value, path: &str) -> Option<&'a Value> {
    let pointer = path.replace('[', "/").replace(']', "").replace('.', "/");
    document.pointer(&format!("/{pointer}"))
}

/// What to write in place of a name of the scenario as a goal.
fn named(document: &Value, name: &str) -> Option<String> {
    let has = |list: &str| {
        let elements = document[list].as_array().into_iter().flatten();
        elements.into_iter().any(|one| one["name"] == name)
    };
    let quoted = format!("`{}`", shown(name));
    if has("journeys") {
        return Some(format!(
            "{quoted} is a journey: give it as `journey`, not as `goal`"
        ));
    }
    let (list, what) = PLACES.into_iter().find(|(list, _)| has(list))?;
    Some(match list {
        "exits" => format!(
            "{quoted} is {what}: leave `goal` out, and people walk to the nearest exit; or give a `journey` to this one"
        ),
        "doors" => {
            format!("{quoted} is {what}, which people pass on their way: a goal is a point [x, y]")
        }
        _ => format!("{quoted} is {what}: give a `journey` with it in place of `goal`"),
    })
}

/// What is wrong with the number of points of a line; `parent` is the path of its object.
fn not_two(parent: &str, points: usize) -> Option<String> {
    let list = parent.split('[').next().unwrap_or_default();
    let split = match points {
        0..=2 => String::new(),
        _ if ["exits", "entrances", "doors"].contains(&list) => format!("; split it into {list}"),
        _ => "; give its first and its last point".to_owned(),
    };
    let given = match points {
        2 => return None,
        1 => "one point".to_owned(),
        count => format!("{count} points"),
    };
    Some(format!("a line has two ends, not {given}{split}"))
}
