//! Interventions of a file → those of a scene, and back, for the scenario of a run that was controlled from outside.

use std::collections::BTreeSet;
use std::sync::Arc;

use serde_json::Value;

use crate::error::quote::shown;
use crate::error::{Problem, Under, suggestion};
use crate::keys::curve::{Curve, CurvePoint};
use crate::keys::interventions::{
    Add, Intervention as Keys, PushKeys, SetCapacity, SetGoal, SetJourney, SetRate, SetSpeed,
    SetZone,
};
use crate::keys::shapes::{Corners, Point, region};
use crate::scene::routes;
use engine::agents::NewAgent;
use engine::forces::push::PushForce;
use engine::journeys::ChangeKind;
use engine::math::{Vector, direction};
use engine::profile::Override;
use engine::scene::{Action, Intervention, Push, Scene};

/// Reads the interventions of a file for a scene that is otherwise complete, in the order of their frames.
///
/// # Errors
/// A name is unknown, a point is off the floor, or an intervention has no time or does not say what is done.
pub fn read(given: &[Keys], scene: &Scene) -> Result<Vec<Intervention>, Problem> {
    let mut all = Vec::new();
    for (k, keys) in given.iter().enumerate() {
        let read = || {
            Ok(Intervention {
                frame: frame(keys, scene)?,
                action: action(keys, scene)?,
            })
        };
        all.push(read().under(&format!("interventions[{k}]"))?);
    }
    all.sort_by_key(|one| one.frame);
    Ok(all)
}

/// Gives a scene without routes those that its interventions need; `width`: the least of passages, or `None` if people
/// walk straight.
///
/// # Errors
/// Walls cross, or a coordinate is too large.
pub fn add_routes(scene: &mut Scene, width: Option<f64>) -> Result<(), Problem> {
    let needs = |one: &Intervention| matches!(one.action, Action::Add(_) | Action::Goals(_));
    let is_needed = scene.routes.is_none() && scene.interventions.iter().any(needs);
    scene.later_routes = match width.filter(|_| is_needed && !scene.walls.is_empty()) {
        Some(width) => Some(Arc::new(routes::floor(scene, width)?)),
        None => None,
    };
    Ok(())
}

fn frame(keys: &Keys, scene: &Scene) -> Result<u64, Problem> {
    match (keys.frame, keys.at_secs) {
        (Some(frame), None) => Ok(frame),
        (None, Some(at)) => Ok(scene.clock.coarse_frame_at(at)),
        _ => Err(Problem::new("", "give `frame` or `at_secs`, and not both")),
    }
}

/// The action that the keys of an intervention name.
///
/// # Errors
/// A name is unknown, or there is not exactly one action.
pub fn action(keys: &Keys, scene: &Scene) -> Result<Action, Problem> {
    if keys.actions().len() != 1 {
        let given = match &keys.actions()[..] {
            [] => "nothing".to_owned(),
            some => format!("`{}`", some.join("` and `")),
        };
        let reason = format!(
            "give one of `add`, `remove`, `set_goal`, `set_journey`, `set_speed`, `push`, `open`, `close`, `release`, \
             `set_capacity`, `set_rate` and `set_zone`, not {given}"
        );
        return Err(Problem::new("", reason));
    }
    let names = Names(scene);
    if let Some(action) = of_people(keys, &names) {
        return action;
    }
    if let Some(push) = &keys.push {
        return pushed(push).under("push");
    }
    if let Some(SetCapacity { exit, most_per_sec }) = &keys.set_capacity {
        return Ok(Action::Capacity {
            exit: names.exit(exit).under("set_capacity.exit")?,
            most_per_sec: *most_per_sec,
        });
    }
    if let Some(SetRate { entrance, per_sec }) = &keys.set_rate {
        return Ok(Action::Rate {
            entrance: names.entrance(entrance).under("set_rate.entrance")?,
            per_sec: *per_sec,
        });
    }
    if let Some(SetZone { zone, speed_factor }) = &keys.set_zone {
        return Ok(Action::Zone {
            zone: names.zone(zone).under("set_zone.zone")?,
            speed_factor: *speed_factor,
        });
    }
    let changes = [
        ("open", &keys.open, ChangeKind::Open),
        ("close", &keys.close, ChangeKind::Close),
        ("release", &keys.release, ChangeKind::Release),
    ];
    let given = changes.into_iter().find(|(_, name, _)| name.is_some());
    match given {
        Some((key, Some(name), change)) => names.changed(name, change).under(key),
        _ => Err(Problem::new("", "says nothing")),
    }
}

/// Refuses ids that are given twice.
fn once(ids: &[u32]) -> Result<(), Problem> {
    let mut seen = BTreeSet::new();
    match ids.iter().position(|id| !seen.insert(id)) {
        None => Ok(()),
        Some(k) => {
            let reason = format!("agent {} is given twice; remove one", ids[k]);
            Err(Problem::new(format!("[{k}]"), reason))
        }
    }
}

/// The action with people that the keys name, if they do.
fn of_people(keys: &Keys, names: &Names) -> Option<Result<Action, Problem>> {
    if let Some(add) = &keys.add {
        return Some(added(add, names).under("add"));
    }
    if let Some(ids) = &keys.remove {
        return Some(
            once(ids)
                .under("remove")
                .map(|()| Action::Remove(ids.clone())),
        );
    }
    if let Some(set) = &keys.set_goal {
        let read = || {
            once(&set.agents).under("agents")?;
            on_floor("goals", &set.goals, names.0)?;
            each(&set.agents, &set.goals).under("goals")
        };
        return Some(read().map(Action::Goals).under("set_goal"));
    }
    if let Some(SetJourney { agents, journey }) = &keys.set_journey {
        let read = once(agents).under("agents");
        let number = read.and_then(|()| names.journey(journey).under("journey"));
        return Some(number.under("set_journey").map(|journey| Action::Journey {
            agents: agents.clone(),
            journey,
        }));
    }
    let set = keys.set_speed.as_ref()?;
    let read = once(&set.agents).under("agents");
    let speeds =
        read.and_then(|()| each(&set.agents, &set.preferred_speeds).under("preferred_speeds"));
    Some(speeds.map(Action::Speeds).under("set_speed"))
}

fn added(keys: &Add, names: &Names) -> Result<Action, Problem> {
    let group = names.group(&keys.group).under("group")?;
    let of = &names.0.groups[usize::from(group)];
    let count = keys.positions.len();
    let has_goal = of.journey.is_none() && of.direction.is_none();
    for (key, given) in [
        ("goals", keys.goals.len()),
        ("velocities", keys.velocities.len()),
    ] {
        if given != count && !(given == 0 && !(key == "goals" && has_goal)) {
            let reason = match given {
                0 => format!(
                    "`{}` has no journey; give the goal of each of the {count} people",
                    shown(&of.name)
                ),
                _ => format!("{given} for {count} positions; give one for each"),
            };
            return Err(Problem::new(key, reason));
        }
    }
    on_floor("positions", &keys.positions, names.0)?;
    if has_goal {
        on_floor("goals", &keys.goals, names.0)?;
    }
    let new = keys.positions.iter().enumerate().map(|(k, &position)| {
        let goal = keys.goals.get(k).copied().unwrap_or(position);
        NewAgent {
            velocity: keys
                .velocities
                .get(k)
                .map_or_else(Vector::zeros, |&v| v.into()),
            ..NewAgent::at(position.into(), goal.into(), group)
        }
    });
    Ok(Action::Add(new.collect()))
}

/// Refuses points off the floor.
fn on_floor(key: &str, points: &[Point], scene: &Scene) -> Result<(), Problem> {
    for (k, &Point([x, y])) in points.iter().enumerate() {
        if scene.walls.obstacle_at(Vector::new(x, y)).is_some() {
            let reason = format!(
                "({x}, {y}) lies in an obstacle or outside of the walkable area; move it onto the floor"
            );
            return Err(Problem::new(format!("{key}[{k}]"), reason));
        }
    }
    Ok(())
}

/// The values of agents: one for all, or one for each.
fn each<T: Copy, U: From<T>>(agents: &[u32], values: &[T]) -> Result<Vec<(u32, U)>, Problem> {
    if values.len() != agents.len() && values.len() != 1 {
        let reason = format!(
            "{} for {} agents; give one for all, or one for each",
            values.len(),
            agents.len()
        );
        return Err(Problem::new("", reason));
    }
    let all = values.iter().cycle().map(|&value| value.into());
    Ok(agents.iter().copied().zip(all).collect())
}

/// The other way round: the ids, and one value for all if all are the same, else one for each.
fn together<T: Copy + PartialEq>(each: &[(u32, T)]) -> (Vec<u32>, Vec<T>) {
    let (agents, mut values): (Vec<u32>, Vec<T>) = each.iter().copied().unzip();
    if values.iter().all(|value| *value == values[0]) {
        values.truncate(1);
    }
    (agents, values)
}

fn pushed(keys: &PushKeys) -> Result<Action, Problem> {
    let force = match (&keys.acceleration[..], keys.direction) {
        ([], None) => None,
        ([], Some(_)) => {
            let reason = "is for `acceleration`, which is not given; add it, or remove this";
            return Err(Problem::new("direction", reason));
        }
        (points, way) => {
            let way = way.map_or(Vector::x(), Vector::from);
            if way == Vector::zeros() {
                return Err(Problem::new("direction", "must not be [0, 0]"));
            }
            Some(PushForce {
                push: 0,
                at: 0.0,
                direction: direction(way),
                curve: Curve::Points(points.to_vec())
                    .points()
                    .under("acceleration")?,
            })
        }
    };
    let push = Push {
        name: keys.name.clone(),
        at: 0.0,
        lasting: keys.for_secs,
        region: region("region", Corners(keys.region))?,
        change: Override {
            goal_scale: keys.goal_scale,
            ignore_contact: keys.ignore_contact,
            ignore_sph: keys.ignore_sph,
        },
    };
    Ok(Action::Push(push, force))
}

/// What the names of a scene stand for.
struct Names<'a>(&'a Scene);

impl Names<'_> {
    fn place(&self, kind: &str, name: &str) -> Result<u16, Problem> {
        number(
            kind,
            name,
            self.0.journeys.places.iter().map(|one| &one.name),
        )
    }

    fn exit(&self, name: &str) -> Result<u16, Problem> {
        let exits = self.0.journeys.places.iter().filter(|one| one.is_exit());
        number("exit", name, exits.map(|one| &one.name))?;
        self.place("exit", name)
    }

    fn journey(&self, name: &str) -> Result<u16, Problem> {
        number(
            "journey",
            name,
            self.0.journeys.journeys.iter().map(|one| &one.name),
        )
    }

    fn entrance(&self, name: &str) -> Result<u16, Problem> {
        number(
            "entrance",
            name,
            self.0.entrances.iter().map(|one| &one.name),
        )
    }

    fn zone(&self, name: &str) -> Result<u16, Problem> {
        number(
            "zone",
            name,
            self.0.journeys.zones.iter().map(|one| &one.name),
        )
    }

    fn group(&self, name: &str) -> Result<u16, Problem> {
        number("group", name, self.0.groups.iter().map(|one| &one.name))
    }

    /// The change of the exit, door, entrance or waiting area of this name.
    fn changed(&self, name: &str, change: ChangeKind) -> Result<Action, Problem> {
        if change != ChangeKind::Release
            && let Ok(entrance) = self.entrance(name)
        {
            let open = change == ChangeKind::Open;
            return Ok(Action::Entrance { entrance, open });
        }
        let place = self.place("exit, door, entrance or waiting area", name)?;
        let action = Action::Place { place, change };
        let refused = engine::simulation::refused_change(&self.0.journeys.places, place, change);
        match refused {
            Some(error) => Err(Problem::new("", error.to_string())),
            None => Ok(action),
        }
    }
}

/// The number of what has this name.
fn number<'a>(
    kind: &str,
    name: &str,
    known: impl Iterator<Item = &'a String> + Clone,
) -> Result<u16, Problem> {
    let found = known.clone().position(|one| one == name);
    found.map(|number| number as u16).ok_or_else(|| {
        let known: Vec<&str> = known.map(String::as_str).collect();
        let others = match suggestion(name, known.iter().copied()) {
            meant if !meant.is_empty() => meant,
            _ if known.is_empty() => "; the scenario has none".to_owned(),
            _ => format!("; there are {}", known.join(", ")),
        };
        Problem::new("", format!("no {kind} is named `{}`{others}", shown(name)))
    })
}

/// Interventions of a scene as elements of the list `interventions` of a file.
pub fn written(all: &[Intervention], scene: &Scene) -> Vec<Value> {
    let one = |one: &Intervention| Keys {
        frame: Some(one.frame),
        ..keys(&one.action, scene)
    };
    all.iter()
        .map(|intervention| one(intervention).document())
        .collect()
}

fn point(p: Vector) -> Point {
    Point(p.into())
}

/// The keys of an action, without its time.
fn keys(action: &Action, scene: &Scene) -> Keys {
    let journeys = &scene.journeys;
    let place = |number: u16| journeys.places[usize::from(number)].name.clone();
    let entrance = |number: u16| scene.entrances[usize::from(number)].name.clone();
    let mut keys = Keys::default();
    match action {
        Action::Add(new) => keys.add = Some(add_of(new, scene)),
        Action::Remove(ids) => keys.remove = Some(ids.clone()),
        Action::Goals(goals) => {
            let (agents, goals) = together(goals);
            let goals = goals.into_iter().map(point).collect();
            keys.set_goal = Some(SetGoal { agents, goals });
        }
        Action::Journey { agents, journey } => {
            keys.set_journey = Some(SetJourney {
                agents: agents.clone(),
                journey: journeys.journeys[usize::from(*journey)].name.clone(),
            });
        }
        Action::Speeds(speeds) => {
            let (agents, preferred_speeds) = together(speeds);
            keys.set_speed = Some(SetSpeed {
                agents,
                preferred_speeds,
            });
        }
        Action::Push(push, force) => {
            let curve = force.iter().flat_map(|force| &force.curve);
            keys.push = Some(PushKeys {
                name: push.name.clone(),
                region: [point(push.region.min), point(push.region.max)],
                for_secs: push.lasting,
                goal_scale: push.change.goal_scale,
                ignore_contact: push.change.ignore_contact,
                ignore_sph: push.change.ignore_sph,
                acceleration: curve.map(|&at| CurvePoint(at)).collect(),
                direction: force.as_ref().map(|force| point(force.direction)),
            });
        }
        Action::Place {
            place: number,
            change,
        } => match change {
            ChangeKind::Open => keys.open = Some(place(*number)),
            ChangeKind::Close => keys.close = Some(place(*number)),
            ChangeKind::Release => keys.release = Some(place(*number)),
        },
        Action::Entrance {
            entrance: number,
            open: true,
        } => keys.open = Some(entrance(*number)),
        Action::Entrance {
            entrance: number,
            open: false,
        } => keys.close = Some(entrance(*number)),
        Action::Rate {
            entrance: number,
            per_sec,
        } => {
            keys.set_rate = Some(SetRate {
                entrance: entrance(*number),
                per_sec: *per_sec,
            });
        }
        Action::Capacity { exit, most_per_sec } => {
            keys.set_capacity = Some(SetCapacity {
                exit: place(*exit),
                most_per_sec: *most_per_sec,
            });
        }
        Action::Zone { zone, speed_factor } => {
            keys.set_zone = Some(SetZone {
                zone: journeys.zones[usize::from(*zone)].name.clone(),
                speed_factor: *speed_factor,
            });
        }
    }
    keys
}

/// The keys of people who enter.
fn add_of(new: &[NewAgent], scene: &Scene) -> Add {
    let is_still = new.iter().all(|one| one.velocity == Vector::zeros());
    let is_aimless = new.iter().all(|one| one.goal == one.position);
    let group = new.first().map_or(0, |one| usize::from(one.group));
    Add {
        group: scene
            .groups
            .get(group)
            .map_or(String::new(), |one| one.name.clone()),
        positions: new.iter().map(|one| point(one.position)).collect(),
        goals: match is_aimless {
            true => Vec::new(),
            false => new.iter().map(|one| point(one.goal)).collect(),
        },
        velocities: match is_still {
            true => Vec::new(),
            false => new.iter().map(|one| one.velocity.into()).collect(),
        },
    }
}
