//! Places, zones and goals in pictures and recordings: colors, outlines and names.

use std::collections::{BTreeMap, BTreeSet};

use analysis::round;
use engine::agents::Agents;
use engine::geometry::Ring;
use engine::journeys::{Journeys, Kind, Place, Queue, Status, Trip, Zone};
use engine::math::{Vector, bounds, direction, perpendicular};
use engine::scene::{Goal, Group, Scene};
use engine::simulation::Simulation;
use figures::colors::Rgb;
use scenario::floor_plan::Label;

/// The color of zones.
pub const ZONE: Rgb = [213, 94, 0];
/// The color of agents that walk.
pub const WALKING: Rgb = [70, 76, 92];
/// The color of agents without a journey, and of those that have ended it.
pub const NO_STAGE: Rgb = [150, 150, 156];
/// The colors of the stages of a journey, in words and as RGB; they repeat after the last one.
pub const STAGES: [(&str, Rgb); 6] = [
    ("blue", [70, 140, 240]),
    ("orange", [230, 159, 0]),
    ("green", [40, 190, 130]),
    ("pink", [224, 121, 177]),
    ("yellow", [240, 228, 66]),
    ("red", [230, 90, 50]),
];
/// The most spots of a queue that are shown.
const MOST_SPOTS: usize = 500;
/// The corners of a circle.
const CIRCLE: u32 = 48;
/// The most goals that are shown.
const GOALS: usize = 200;

/// The color of a place of this kind.
pub fn color(kind: &Kind) -> Rgb {
    match kind {
        Kind::Exit(_) => [0, 158, 115],
        Kind::Line(_) | Kind::Disk { .. } => [0, 114, 178],
        Kind::Waiting(_) => [230, 159, 0],
        Kind::Queue(_) => [204, 121, 167],
        Kind::Door(_) => [150, 90, 50],
    }
}

/// The color of an agent by its stage.
pub fn stage_color(trip: Option<&Trip>) -> Rgb {
    match trip {
        Some(trip) if trip.status != Status::Finished => {
            STAGES[usize::from(trip.stage) % STAGES.len()].1
        }
        _ => NO_STAGE,
    }
}

/// Whether some journey has more than one stage, so that stages can differ.
pub fn has_stages(scene: &Scene) -> bool {
    let mut journeys = scene.journeys.journeys.iter();
    journeys.any(|journey| journey.stages.len() > 1)
}

/// The lines of a place: its line, its outline (closed), or the path of a queue.
pub fn lines(place: &Place) -> Vec<Vector> {
    match &place.kind {
        Kind::Exit(exit) => exit.line.to_vec(),
        Kind::Line(line) => line.to_vec(),
        Kind::Door(door) => door.line.to_vec(),
        Kind::Disk { at, within } => (0..=CIRCLE)
            .map(|k| std::f64::consts::TAU * f64::from(k) / f64::from(CIRCLE))
            .map(|turn| at + Vector::new(turn.cos(), turn.sin()) * *within)
            .collect(),
        Kind::Waiting(waiting) => closed(waiting.area.points()),
        Kind::Queue(queue) => queue.path.clone(),
    }
}

/// The corners of a ring, the first one again at the end.
pub fn closed(corners: &[Vector]) -> Vec<Vector> {
    corners.iter().chain(corners.first()).copied().collect()
}

/// The number of places of the same kind as `place`.
pub fn alike(scene: &Scene, place: &Place) -> usize {
    let kinds = scene.journeys.places.iter().map(|other| other.kind.name());
    kinds.filter(|&kind| kind == place.kind.name()).count()
}

/// The spots on the path of a queue.
pub fn spots(queue: &Queue) -> Vec<Vector> {
    let sides = queue.path.windows(2).map(|pair| (pair[1] - pair[0]).norm());
    let count = (sides.sum::<f64>() / queue.spacing + 1e-9) as usize + 1;
    (0..count.min(MOST_SPOTS))
        .map(|ahead| queue.spot(ahead))
        .collect()
}

/// Longer texts are cut.
const MOST_LETTERS: usize = 48;

/// A text, cut if it is long.
pub fn brief(text: &str) -> String {
    match text.char_indices().nth(MOST_LETTERS) {
        Some(_) => text.chars().take(MOST_LETTERS - 1).chain(['…']).collect(),
        None => text.to_owned(),
    }
}

/// The kind before a name that does not begin with this word or its plural, as `sources[0]` does.
pub fn named(kind: &str, name: &str) -> String {
    let continues = |rest: &str| rest.starts_with(|c: char| c.is_alphanumeric() && c != 's');
    match name.strip_prefix(kind) {
        Some(rest) if !continues(rest) => name.to_owned(),
        _ => format!("{kind} {name}"),
    }
}

/// A text as names are compared: a measurement of the exit `West_door` may be named `exit west door`.
fn plain(text: &str) -> String {
    text.replace('_', " ").to_lowercase()
}

/// The names of places, zones, entrances and sources, with and without their kinds, as names are compared.
fn names(scene: &Scene) -> BTreeSet<String> {
    let journeys = &scene.journeys;
    let all = journeys.places.iter();
    let places = all.map(|place| (place.kind.name(), &place.name));
    let zones = journeys.zones.iter().map(|one| ("zone", &one.name));
    let entrances = scene.entrances.iter().map(|one| ("entrance", &one.name));
    let sources = scene.sources.iter().map(|one| ("source", &one.name));
    let all = places.chain(zones).chain(entrances).chain(sources);
    all.flat_map(|(kind, name)| [plain(name), plain(&named(kind, name))])
        .collect()
}

/// Each place that measurements observe, once, with its names; without those that something else in the scene has.
pub fn observed_once<P: PartialEq + Clone>(
    scene: &Scene,
    observed: &[(String, P)],
) -> Vec<(String, P)> {
    let known = names(scene);
    let mut all: Vec<(String, P)> = Vec::new();
    for (k, (_, place)) in observed.iter().enumerate() {
        if observed[..k].iter().any(|(_, other)| other == place) {
            continue;
        }
        let own = observed[k..].iter().filter(|(_, other)| other == place);
        let mut names: Vec<&str> = Vec::new();
        for (name, _) in own {
            if !name.is_empty() && !known.contains(&plain(name)) && !names.contains(&name.as_str())
            {
                names.push(name);
            }
        }
        all.push((names.join(", "), place.clone()));
    }
    all
}

/// The texts that are not the name of something in the scene or of what is `observed`: that has a label of its own.
pub fn own_texts<'a>(
    scene: &Scene,
    observed: impl Iterator<Item = &'a str>,
    texts: &'a [Label],
) -> impl Iterator<Item = &'a Label> {
    let mut known = names(scene);
    known.extend(observed.map(plain));
    let texts = texts.iter();
    texts.filter(move |label| !known.contains(&plain(&label.text)))
}

/// The kind and the name of a zone with what it changes, or of a lift whose cabin is drawn as one.
pub fn zone_name(journeys: &Journeys, zone: &Zone) -> String {
    if journeys.lifts.iter().any(|lift| lift.name == zone.name) {
        return named("lift", &zone.name);
    }
    named("zone", &changes(zone))
}

fn changes(zone: &Zone) -> String {
    let brief = round::brief;
    let speed = format!("speed × {}", brief(zone.speed_factor));
    let motivation = format!("motivation {}", brief(zone.motivation));
    match (zone.speed_factor == 1.0, zone.motivation == 0.0) {
        (_, true) => format!("{}: {speed}", zone.name),
        (true, false) => format!("{}: {motivation}", zone.name),
        (false, false) => format!("{}: {speed}, {motivation}", zone.name),
    }
}

/// The direction from one line of hatched zones to the next.
pub fn across_zones() -> Vector {
    direction(Vector::new(1.0, -1.0))
}

/// Parallel lines that fill a ring, this far apart in a direction of length 1, meters.
pub fn hatching(ring: &Ring, across: Vector, apart: f64) -> Vec<[Vector; 2]> {
    let along = perpendicular(across);
    let corners = ring.points();
    let places = corners
        .iter()
        .map(|p| Vector::new(p.dot(&across), p.dot(&along)));
    let [low, high] = bounds(places).unwrap_or_default();
    let mut lines = Vec::new();
    let mut at = (low.x / apart).ceil() * apart;
    while at < high.x {
        let ends = corners.iter().cycle().skip(1);
        let crossing = corners.iter().zip(ends).filter_map(|(a, b)| {
            let [from, to] = [a, b].map(|p| p.dot(&across) - at);
            let crosses = (from > 0.0) != (to > 0.0);
            crosses.then(|| (a + (b - a) * (from / (from - to))).dot(&along))
        });
        let mut crossings: Vec<f64> = crossing.collect();
        crossings.sort_by(f64::total_cmp);
        let inside = crossings.chunks_exact(2);
        lines.extend(inside.map(|ends| [ends[0], ends[1]].map(|end| across * at + along * end)));
        at += apart;
    }
    lines
}

/// A goal, and the groups whose agents want to go there.
pub type GoalOf = (Vector, BTreeSet<u16>);

/// Whether place `k` is an exit or a door that is closed now.
pub fn is_closed(simulation: &Simulation, k: usize) -> bool {
    let kind = &simulation.scene().journeys.places[k].kind;
    let state = simulation.progress().places.get(k);
    matches!(kind, Kind::Exit(_) | Kind::Door(_)) && state.is_some_and(|state| !state.open)
}

/// The distinct goals of agents and sources without journeys, each with its groups. A source with a goal per agent
/// contributes the goals of its first entry.
pub fn goals(scene: &Scene, agents: &Agents) -> Vec<GoalOf> {
    let goals = agents.goal.iter().zip(&agents.group);
    let own = goals.map(|(&goal, &group)| (goal, group));
    let by_sources = scene.sources.iter().flat_map(|source| {
        let goals: Vec<Vector> = match source.goal {
            Goal::Point(goal) => vec![goal],
            Goal::Offset(offset) => {
                let starts = source.grid.positions(scene.seed, 0).take(GOALS);
                starts.map(|start| start + offset).collect()
            }
        };
        goals.into_iter().map(|goal| (goal, source.group))
    });
    let doors = scene.entrances.iter();
    let through = doors.map(|entrance| (entrance.goal, entrance.group));
    let arrivals = scene.scheduled.iter();
    let late = arrivals.map(|late| (late.agent.goal, late.agent.group));
    let entering = by_sources.chain(through).chain(late);
    let millimeters = |x: f64| (x * 1000.0).round() as i64;
    let mut different = BTreeMap::new();
    for (goal, group) in own.chain(entering) {
        let of = scene.groups.get(usize::from(group));
        let walks_on = |group: &Group| group.journey.is_some() || group.direction.is_some();
        if of.is_some_and(walks_on) {
            continue;
        }
        let place = (millimeters(goal.x), millimeters(goal.y));
        let (_, groups) = different.entry(place).or_insert((goal, BTreeSet::new()));
        groups.insert(group);
    }
    different.into_values().take(GOALS).collect()
}

/// One label for all goals of the same groups, at the first of these goals.
pub fn goal_labels(scene: &Scene, goals: &[GoalOf]) -> Vec<String> {
    let mut named = BTreeSet::new();
    let label = |(_, groups): &GoalOf| match named.insert(groups.clone()) {
        true => goal_label(scene, groups),
        false => String::new(),
    };
    goals.iter().map(label).collect()
}

/// The label of a goal.
fn goal_label(scene: &Scene, of: &BTreeSet<u16>) -> String {
    if of.len() == scene.groups.len() {
        return "goal".to_owned();
    }
    let groups = of
        .iter()
        .filter_map(|&group| scene.groups.get(usize::from(group)));
    let names: BTreeSet<&str> = groups.map(|group| group.name.as_str()).collect();
    format!("goal of {}", Vec::from_iter(names).join(", "))
}
