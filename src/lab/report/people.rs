//! The people of a run: how many, from where, with which speeds and times before they walk, as given.

use serde_json::Value;

use super::passages::Passages;
use engine::journeys::{Kind, Place};
use engine::scene::{Group, Scene};
use output::document::Block;
use output::table::Table;
use scenario::Scenario;
use scenario::quote::shown;

/// The keys whose items are groups with names, in the order of the groups.
const LISTS: [&str; 4] = ["grids", "crowds", "sources", "entrances"];
/// The parameters of distributions that come first, as readers expect them.
const FIRST: [&str; 5] = ["mean", "std", "shape", "scale", "min"];
/// The group that single agents share.
const AGENTS: &str = "agents";

struct Row<'a> {
    name: String,
    group: &'a Group,
    start: usize,
    entered: u32,
    speed: String,
    premovement: String,
    radius: Option<String>,
    mass: Option<String>,
    goal: String,
}

/// The people by group: a room, a crowd, an entrance. `passages` knows who entered.
pub fn table(scenario: &Scenario, passages: &Passages) -> Block {
    let scene = &scenario.scene;
    let items = items(&scenario.document);
    let mut next = items.iter();
    let groups = scene.groups.iter().enumerate();
    let found = groups.map(|(k, group)| {
        let own = match next.clone().position(|(name, _)| *name == group.name) {
            Some(skipped) => next.nth(skipped).map(|(_, item)| *item),
            None => None,
        };
        let start = scene
            .agents
            .iter()
            .filter(|one| usize::from(one.group) == k);
        Row {
            name: shown(&group.name),
            group,
            start: start.count(),
            entered: passages.entered.get(k).copied().unwrap_or_default(),
            speed: match own.and_then(|item| item.get("preferred_speed")) {
                Some(given) => words(given),
                None => own_values(scene, k, |one| one.preferred_speed, scene.preferred_speed),
            },
            premovement: match own.and_then(|item| item.get("premovement_secs")) {
                Some(given) => words(given),
                None => own_values(scene, k, |one| one.premovement, 0.0),
            },
            radius: own.and_then(|item| item.get("radius")).map(words),
            mass: own.and_then(|item| item.get("mass")).map(words),
            goal: goal(scene, group),
        }
    });
    let rows: Vec<Row> = found.collect();
    let mut begun = Table::of(&rows)
        .column("people", |row| row.name.as_str())
        .column("at the start", |row| row.start)
        .column("entered", |row| row.entered)
        .column("walking speed [m/s]", |row| row.speed.as_str())
        .column("premovement [s]", |row| row.premovement.as_str())
        .column("motivation", |row| row.group.motivation);
    if rows.iter().any(|row| row.radius.is_some()) {
        begun = begun.column("radius [m]", |row| row.radius.as_deref());
    }
    if rows.iter().any(|row| row.mass.is_some()) {
        begun = begun.column("mass [1]", |row| row.mass.as_deref());
    }
    let table = begun
        .column("journey or goal", |row| row.goal.as_str())
        .table();
    let caption = "Walking speeds and times before people walk (premovement) as the scenario gives them: a number, or \
                   the distribution from which each person's is drawn. Entered: all people of the run, with those at \
                   the start.";
    Block::Table(table, caption.to_owned())
}

/// The items of a scenario that are groups, with their names in reports.
fn items(document: &Value) -> Vec<(String, &Value)> {
    let of = |list: &&'static str| {
        let list = *list;
        let listed = document.get(list).and_then(Value::as_array);
        let items = listed.into_iter().flatten().enumerate();
        items.map(move |(k, item)| {
            let name = item.get("name").and_then(Value::as_str);
            let place = || format!("{list}[{k}]");
            (name.map_or_else(place, str::to_owned), item)
        })
    };
    LISTS.iter().flat_map(of).collect()
}

/// The values that agents of group `k` have of their own: one, or the least and the largest; else the default.
fn own_values(
    scene: &Scene,
    k: usize,
    value: impl Fn(&engine::agents::NewAgent) -> Option<f64>,
    default: f64,
) -> String {
    let agents = scene
        .agents
        .iter()
        .filter(|one| usize::from(one.group) == k);
    let own: Vec<f64> = agents.map(|one| value(one).unwrap_or(default)).collect();
    let least = own.iter().copied().fold(f64::INFINITY, f64::min);
    let most = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    match least < most {
        true => format!("{least} to {most}"),
        false if own.is_empty() => default.to_string(),
        false => least.to_string(),
    }
}

/// How long people stay at a waiting area or a queue, as the scenario gives it, and for how many there is room.
pub fn held(scenario: &Scenario, place: &Place) -> String {
    let given = |list: &str, key: &str| {
        let listed = scenario.document.get(list).and_then(Value::as_array);
        let mut items = listed.into_iter().flatten();
        let own = items.find(|item| item["name"] == place.name.as_str());
        own.and_then(|item| item.get(key)).map(words)
    };
    match &place.kind {
        Kind::Queue(line) => {
            let secs = given("queues", "service_secs").unwrap_or_default();
            format!(
                "served by {} at a time, {secs} s each; room for {}",
                line.servers,
                line.room()
            )
        }
        Kind::Waiting(waiting) => {
            let until = waiting.until.map(|until| format!("until {until} s"));
            let lasting = given("waiting_areas", "for_secs").map(|secs| format!("for {secs} s"));
            let all: Vec<String> = until.into_iter().chain(lasting).collect();
            match all.is_empty() {
                true if is_stop(&scenario.scene, place) => "until a lift takes them".to_owned(),
                true => "to the end".to_owned(),
                false => all.join(" and "),
            }
        }
        _ => String::new(),
    }
}

/// Whether people wait for a lift at a place.
fn is_stop(scene: &Scene, place: &Place) -> bool {
    let mut stops = scene.journeys.lifts.iter().flat_map(|lift| &lift.stops);
    stops.any(|stop| scene.journeys.places[usize::from(stop.place)].name == place.name)
}

/// Where the people of a group walk.
fn goal(scene: &Scene, group: &Group) -> String {
    let journeys = &scene.journeys.journeys;
    let journey = group.journey.and_then(|k| journeys.get(usize::from(k)));
    match (journey, group.direction) {
        (Some(journey), _) => shown(&journey.name),
        (None, Some(direction)) => format!("direction ({:.2}, {:.2})", direction.x, direction.y),
        (None, None) if group.name == AGENTS => "their goals".to_owned(),
        (None, None) => "goal".to_owned(),
    }
}

/// A number or a distribution in words: `normal: mean 1.34, std 0.26`.
fn words(given: &Value) -> String {
    match given {
        Value::String(text) => shown(text),
        Value::Object(entries) => {
            let parts = entries.iter().map(|(key, value)| match value {
                Value::Object(inner) => {
                    let rank = |key: &str| FIRST.iter().position(|first| *first == key);
                    let mut sorted: Vec<(&String, &Value)> = inner.iter().collect();
                    sorted.sort_by_key(|(key, _)| rank(key).unwrap_or(FIRST.len()));
                    let pairs = sorted.iter();
                    let inner = pairs.map(|(key, value)| format!("{key} {}", words(value)));
                    format!("{key}: {}", inner.collect::<Vec<_>>().join(", "))
                }
                value => format!("{key} {}", words(value)),
            });
            parts.collect::<Vec<_>>().join(", ")
        }
        Value::Array(values) => {
            let values = values.iter().map(words).collect::<Vec<_>>();
            format!("({})", values.join(", "))
        }
        value => value.to_string(),
    }
}
