//! What a wrong value at its place in a scenario probably meant: the name of a place where a goal is expected, a line
//! with more than two points, a key of another program.

use serde_json::Value;

use crate::error::Problem;
use crate::error::numbers::brief;
use crate::error::quote::shown;
use crate::file::schema;

/// The lists of a scenario whose elements have names that people can walk to, with what one of them is.
const PLACES: [(&str, &str); 5] = [
    ("exits", "an exit"),
    ("waypoints", "a waypoint"),
    ("waiting_areas", "a waiting area"),
    ("queues", "a queue"),
    ("doors", "a door"),
];

/// The lists of a scenario whose elements have a `number` of people.
const GROUPS: [&str; 2] = ["crowds", "entrances"];
/// What other programs call it.
const NUMBERS: [&str; 6] = ["count", "n", "amount", "agents", "people", "size"];
/// Keys for arrivals per another time than a second, with its length in seconds.
const RATES: [(&str, &str, f64); 4] = [
    ("per_min", "minute", 60.0),
    ("per_minute", "minute", 60.0),
    ("per_hour", "hour", 3600.0),
    ("per_h", "hour", 3600.0),
];

/// A problem in `document`, with a clearer reason if the value at its path has one.
pub fn clearer(problem: Problem, document: &Value) -> Problem {
    let Some(value) = value_at(document, &problem.path) else {
        return problem;
    };
    let (parent, key) = problem.path.rsplit_once('.').unwrap_or(("", &problem.path));
    let list = parent.split('[').next().unwrap_or_default();
    let reason = match (key, value) {
        ("goal", Value::String(name)) => named(document, name),
        ("journey", Value::String(name)) => not_a_journey(document, name),
        ("journey", Value::Array(_) | Value::Object(_)) => Some(
            "a group names its journey; declare it at the top level: \"journeys\": [{\"name\": \"way\", \"stages\": \
             […]}], \"journey\": \"way\""
                .to_owned(),
        ),
        ("one_way", Value::Number(_) | Value::String(_)) => Some(
            "is the direction of passage as a vector [x, y]: [1, 0] along x, [0, 1] along y".to_owned(),
        ),
        ("stop", Value::Bool(_)) => {
            Some("give its conditions: {\"when_empty\": true} ends the run when all have left".to_owned())
        }
        (_, Value::Array(times)) if key.starts_with("closed_secs[") && times.len() != 2 => {
            Some("each closure has two times, its begin and its end, in seconds: [[0, 5], [10, 20]]".to_owned())
        }
        (_, Value::Number(_)) if GROUPS.contains(&list) && NUMBERS.contains(&key) => {
            Some(format!("unknown key `{key}`; the number of people is `number`"))
        }
        (_, Value::Number(rate)) if list == "entrances" => per_second(key, rate.as_f64()),
        _ if parent.ends_with("profile") && is_parameter(key) => Some(format!(
            "`{key}` belongs into `parameters`: {{\"parameters\": {{\"{key}\": {}}}}}",
            shown(&value.to_string())
        )),
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

/// The key for arrivals in place of one per another time than a second; `None` for other keys.
fn per_second(key: &str, rate: Option<f64>) -> Option<String> {
    let (_, time, secs) = RATES.into_iter().find(|(name, ..)| *name == key)?;
    let rate = rate?;
    Some(format!(
        "unknown key `{key}`; give `per_sec`: {} per {time} are {}",
        brief(rate),
        brief(rate / secs)
    ))
}

/// Whether `key` is a parameter of profiles.
fn is_parameter(key: &str) -> bool {
    !schema::root()["$defs"]["Parameters"]["properties"][key].is_null()
}

/// What to write in place of a name that no journey has.
fn not_a_journey(document: &Value, name: &str) -> Option<String> {
    let mut journeys = document["journeys"].as_array().into_iter().flatten();
    if journeys.any(|one| one["name"] == name) {
        return None;
    }
    let mut places = PLACES.into_iter();
    let (_, what) = places.find(|(list, _)| has(document, list, name))?;
    let name = shown(name);
    Some(format!(
        "`{name}` is {what}, not a journey: declare one that leads there, \"journeys\": [{{\"name\": \"way\", \
         \"stages\": [\"{name}\"]}}], and give `way` here"
    ))
}

/// Whether an element of a list of the scenario has this name.
fn has(document: &Value, list: &str, name: &str) -> bool {
    let elements = document[list].as_array().into_iter().flatten();
    elements.into_iter().any(|one| one["name"] == name)
}

/// The value at a path such as `crowds[0].goal`.
fn value_at<'a>(document: &'a Value, path: &str) -> Option<&'a Value> {
    let pointer = path.replace('[', "/").replace(']', "").replace('.', "/");
    document.pointer(&format!("/{pointer}"))
}

/// What to write in place of a name of the scenario as a goal.
fn named(document: &Value, name: &str) -> Option<String> {
    let has = |list: &str| has(document, list, name);
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
