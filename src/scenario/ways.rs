//! Ways around walls: the floor of a scene, the path maps to its goals, and the check that agents can reach them.

use std::collections::BTreeSet;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::error::Problem;
use super::file::File;
use super::floor_plan::{Rings, free, outlines};
use crate::engine::math::{Vector, bounds};
use crate::engine::scene::{Goal, Scene};
use crate::engine::ways::{Floor, WayError, Ways};

/// How agents find their ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WayFinding {
    /// Around walls.
    #[default]
    Paths,
    /// Straight toward the goal, as in the paper.
    Straight,
}

/// Default width below which passages are closed, meters.
pub(super) const PASSABLE: f64 = 0.4;
/// The floor of a scene without walkable area reaches this far beyond everything in it, meters.
const MARGIN: f64 = 5.0;
/// The most goals with a path map.
const MOST_GOALS: usize = 1000;

/// Where an agent starts, where it wants to go, and what it is called in messages.
struct Trip {
    start: Vector,
    goal: Vector,
    name: String,
    /// Do several agents have this goal?
    shared: bool,
}

/// The path maps of a scene that is otherwise complete; `None` if agents walk straight.
pub(super) fn ways(keys: &File, scene: &Scene) -> Result<Option<Arc<Ways>>, Problem> {
    if keys.navigation == WayFinding::Straight || scene.walls.is_empty() {
        return Ok(None);
    }
    let trips = trips(scene);
    let is_blocked = |trip: &&Trip| {
        let (from, to) = (trip.start, trip.goal);
        let near = scene.walls.near_any(&[from, to], 0.0);
        scene.walls.first_crossing(from, to, &near).is_some()
    };
    let blocked: Vec<&Trip> = trips.iter().filter(is_blocked).collect();
    let shared = trips.iter().filter(|trip| trip.shared);
    let mut seen = BTreeSet::new();
    let bits = |p: &Vector| [p.x, p.y].map(f64::to_bits);
    let goals = shared.chain(blocked.iter().copied()).map(|trip| trip.goal);
    let goals: Vec<Vector> = goals.filter(|goal| seen.insert(bits(goal))).collect();
    if goals.len() > MOST_GOALS {
        let reason = format!(
            "walls stand between agents and more than {MOST_GOALS} different goals; give agents a common goal, or set \
             `navigation` to `straight`"
        );
        return Err(Problem::new("goal", reason));
    }
    let width = keys.min_passage_width.unwrap_or(PASSABLE);
    let prepare = |width: f64| -> Result<Ways, Problem> {
        let floor = Floor::new(&areas(scene, &trips)?, width).map_err(unusable)?;
        Ways::new(floor, goals.clone()).map_err(|error| match error {
            WayError::NotOnFloor(goal) => {
                let of = trips.iter().find(|trip| trip.goal == goal);
                let of = of.map_or("", |trip| trip.name.as_str());
                let reason = format!(
                    "({}, {}), the goal of {of}, lies in an obstacle or outside of the walkable area; move it onto the \
                     floor, or set `navigation` to `straight`",
                    goal.x, goal.y
                );
                Problem::new("goal", reason)
            }
            error => unusable(error),
        })
    };
    let ways = prepare(width)?;
    let mapped = |trip: &&Trip| seen.contains(&bits(&trip.goal));
    let stuck = trips
        .iter()
        .filter(mapped)
        .find(|trip| !ways.is_open(trip.start, trip.goal));
    if let Some(Trip {
        start, goal, name, ..
    }) = stuck
    {
        let open = prepare(0.0)?.is_open(*start, *goal);
        let reason = if open {
            format!(
                "every way there has a passage narrower than `min_passage_width`, {width} m; widen it, or lower that"
            )
        } else {
            "walls close it off; open them, or move the goal or the agent".to_owned()
        };
        let reason = format!(
            "no way leads from ({}, {}), where agents of {name} start, to their goal ({}, {}): {reason}; or set \
             `navigation` to `straight`",
            start.x, start.y, goal.x, goal.y
        );
        return Err(Problem::new("goal", reason));
    }
    Ok(Some(Arc::new(ways)))
}

fn unusable(error: WayError) -> Problem {
    let reason =
        format!("no ways can be found: {error}; mend the plan, or set `navigation` to `straight`");
    Problem::new("walkable_area", reason)
}

/// The trips of all agents that start or enter, with the places to which agents in obstacles are moved.
fn trips(scene: &Scene) -> Vec<Trip> {
    let place = |p: Vector| {
        let inside = scene.walls.obstacle_at(p).is_some();
        let free = inside.then(|| scene.walls.free_point_near(p)).flatten();
        free.unwrap_or(p)
    };
    let name = |group: u16| scene.groups[usize::from(group)].name.clone();
    let mut trips: Vec<Trip> = Vec::new();
    for agent in &scene.agents {
        let shared = trips.last().is_some_and(|last| last.goal == agent.goal);
        trips.push(Trip {
            start: place(agent.position),
            goal: agent.goal,
            name: name(agent.group),
            shared,
        });
    }
    for source in &scene.sources {
        let starts = source.grid.positions(scene.seed, 0);
        trips.extend(starts.map(|start| Trip {
            start: place(start),
            goal: match source.goal {
                Goal::Point(goal) => goal,
                Goal::Offset(offset) => start + offset,
            },
            name: source.name.clone(),
            shared: matches!(source.goal, Goal::Point(_)),
        }));
    }
    trips
}

/// The floor: the walkable area, or a rectangle around everything, without obstacles.
fn areas(scene: &Scene, trips: &[Trip]) -> Result<Vec<crate::engine::geometry::Area>, Problem> {
    let (floors, bodies) = outlines(scene.walls.obstacles());
    let corners = scene.walls.iter().map(|wall| wall.start);
    let ends = trips.iter().flat_map(|trip| [trip.start, trip.goal]);
    let [low, high] = bounds(corners.chain(ends)).unwrap_or_default();
    let margin = Vector::repeat(MARGIN);
    let (low, high) = (low - margin, high + margin);
    let rectangle = vec![
        low,
        Vector::new(high.x, low.y),
        high,
        Vector::new(low.x, high.y),
    ];
    let everything: [Rings; 1] = [vec![rectangle]];
    let floors = if floors.is_empty() {
        &everything[..]
    } else {
        &floors
    };
    free(floors, &bodies).map_err(|error| Problem::new("obstacles", error.to_string()))
}
