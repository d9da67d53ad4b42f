//! People who need lifts: their journeys over the levels of a building.

use std::collections::{BTreeMap, VecDeque};

use serde_json::{Value, json};

use crate::error::Problem;
use crate::error::quote::shown;
use crate::keys::levels::{Join, Level};

/// The lists of people.
const PEOPLE: [&str; 5] = ["agents", "grids", "crowds", "sources", "entrances"];
/// The key of people who may or may not use stairs.
pub const USES_STAIRS: &str = "uses_stairs";

/// The parts of a building: levels between which people walk have the same number.
type Parts<'a> = BTreeMap<&'a str, usize>;

/// A ride: the names of the lifts, and that of the level.
type Ride = (Vec<String>, String);

/// A stop of a lift: the names of the lift and of the level.
type Stop = (String, String);

/// Gives journeys over lifts to people without goal and journey who cannot walk to an exit, or may not use the stairs
/// there. Takes the key `uses_stairs` out of the document, where people still have a `level`.
///
/// # Errors
/// People who may not use stairs have no way, or a journey of their own.
pub fn plan(document: &mut Value, (levels, joins): (&[Level], &[Join])) -> Result<(), Problem> {
    let stops = stops(document);
    for list in PEOPLE {
        for k in 0..document[list].as_array().map_or(0, Vec::len) {
            let people = &mut document[list][k];
            let place = format!("{list}[{k}]");
            let Some(keys) = people.as_object_mut() else {
                continue;
            };
            let uses_stairs = keys.remove(USES_STAIRS).and_then(|given| given.as_bool());
            let climbs = uses_stairs.unwrap_or(true);
            let is_own = ["goal", "journey", "goal_offset"]
                .iter()
                .any(|key| keys.get(*key).is_some_and(|given| !given.is_null()));
            if is_own && !climbs {
                let reason =
                    "people with a `goal` or a `journey` walk there: leave one of the two out";
                return Err(Problem::new(format!("{place}.{USES_STAIRS}"), reason));
            }
            let Some(level) = keys.get("level").and_then(Value::as_str).map(str::to_owned) else {
                continue;
            };
            if is_own || (climbs && stops.is_empty()) {
                continue;
            }
            let parts = parts((levels, joins), climbs);
            let leads_out = |part: usize| exits_in(document, &parts, part).next().is_some();
            let Some(&start) = parts.get(level.as_str()) else {
                continue;
            };
            if climbs && leads_out(start) {
                continue;
            }
            match rides((&parts, &stops), start, leads_out) {
                Some(rides) => {
                    let name = journey(document, (&parts, start), (&level, climbs), &rides);
                    document[list][k]["journey"] = json!(name);
                }
                None if climbs => {}
                None => {
                    let reason = format!(
                        "no way without stairs leads from `{}` to an exit: add a lift or a ramp",
                        shown(&level)
                    );
                    return Err(Problem::new(format!("{place}.{USES_STAIRS}"), reason));
                }
            }
        }
    }
    Ok(())
}

/// The problem of people with `uses_stairs` in a document without levels.
pub fn without_levels(document: &Value) -> Option<Problem> {
    let refused = |place: String| {
        let reason = "is a key of buildings, and there are no `levels`";
        Problem::new(format!("{place}.{USES_STAIRS}"), reason)
    };
    let from = Some("from".to_owned()).filter(|from| !document[from][USES_STAIRS].is_null());
    let of_lists = PEOPLE.iter().find_map(|list| {
        let mut all = document[*list].as_array()?.iter();
        let k = all.position(|people| !people[USES_STAIRS].is_null())?;
        Some(format!("{list}[{k}]"))
    });
    from.or(of_lists).map(refused)
}

/// The parts of a building between which people walk, over stairs or without.
fn parts<'a>((levels, joins): (&'a [Level], &[Join]), climbs: bool) -> Parts<'a> {
    let walked = levels
        .iter()
        .filter(|level| climbs || !level.kind.has_steps());
    let mut parts: Parts = walked.map(|level| level.name.as_str()).zip(0..).collect();
    for join in joins {
        let ends = join
            .levels
            .each_ref()
            .map(|name| parts.get(name.as_str()).copied());
        if let [Some(one), Some(other)] = ends {
            for part in parts.values_mut().filter(|part| **part == other) {
                *part = one;
            }
        }
    }
    parts
}

/// The stops of all lifts.
fn stops(document: &Value) -> Vec<Stop> {
    let list = |key: &str| document[key].as_array().cloned().unwrap_or_default();
    let areas = list("waiting_areas");
    let level_of = |stop: &Value| {
        let area = areas.iter().find(|area| area["name"] == *stop)?;
        area["level"].as_str().map(str::to_owned)
    };
    let mut all = Vec::new();
    for lift in list("lifts") {
        let name = lift["name"].as_str().unwrap_or_default();
        for stop in lift["stops"].as_array().into_iter().flatten() {
            all.extend(level_of(stop).map(|level| (name.to_owned(), level)));
        }
    }
    all
}

/// The names of the exits in a part.
fn exits_in<'a>(
    document: &'a Value,
    parts: &'a Parts,
    part: usize,
) -> impl Iterator<Item = &'a Value> {
    let exits = document["exits"].as_array().into_iter().flatten();
    let is_in = move |exit: &&Value| {
        let level = exit["level"].as_str();
        level.and_then(|level| parts.get(level)) == Some(&part)
    };
    exits.filter(is_in).map(|exit| &exit["name"])
}

/// The fewest rides from a part to one from which an exit leads out; `None` without a way.
fn rides(
    (parts, stops): (&Parts, &[Stop]),
    start: usize,
    leads_out: impl Fn(usize) -> bool,
) -> Option<Vec<Ride>> {
    let mut found: BTreeMap<usize, Vec<Ride>> = BTreeMap::from([(start, Vec::new())]);
    let mut waiting = VecDeque::from([start]);
    while let Some(part) = waiting.pop_front() {
        let before = found[&part].clone();
        if leads_out(part) {
            return Some(before);
        }
        for (_, to) in stops {
            let Some(&next) = parts
                .get(to.as_str())
                .filter(|next| !found.contains_key(next))
            else {
                continue;
            };
            let starts_here = |lift: &str| {
                let mut own = stops.iter().filter(|(name, _)| name == lift);
                own.any(|(_, level)| level != to && parts.get(level.as_str()) == Some(&part))
            };
            let there = stops
                .iter()
                .filter(|(lift, level)| level == to && starts_here(lift));
            let lifts: Vec<String> = there.map(|(lift, _)| lift.clone()).collect();
            if !lifts.is_empty() {
                let mut rides = before.clone();
                rides.push((lifts, to.clone()));
                found.insert(next, rides);
                waiting.push_back(next);
            }
        }
    }
    None
}

/// Adds the journey over some rides to an exit, if it is not there yet. Returns its name.
fn journey(
    document: &mut Value,
    (parts, start): (&Parts, usize),
    (level, climbs): (&str, bool),
    rides: &[Ride],
) -> String {
    let name = match climbs {
        true => format!("from {level} by lift"),
        false => format!("from {level} without stairs"),
    };
    let last = rides
        .last()
        .and_then(|(_, level)| parts.get(level.as_str()));
    let exits: Vec<&Value> = exits_in(document, parts, last.copied().unwrap_or(start)).collect();
    let choice = document["route_choice"].as_str();
    let key = choice
        .filter(|choice| *choice == "quickest")
        .unwrap_or("nearest");
    let ride = |(lifts, to): &Ride| json!({"lifts": lifts, "to": to});
    let stages = rides.iter().map(ride).chain([json!({ key: exits })]);
    let new = json!({"name": name, "stages": stages.collect::<Vec<Value>>()});
    if document["journeys"].is_null() {
        document["journeys"] = json!([]);
    }
    // Anything else is rejected later.
    if let Value::Array(journeys) = &mut document["journeys"]
        && !journeys
            .iter()
            .any(|journey| journey["name"] == new["name"])
    {
        journeys.push(new);
    }
    name
}
