//! Notes on a run that has ended: what a reader of its results should know.

use super::arguments::RecordOptions;
use super::terminal::talk;
use super::values::ids;
use crate::engine::journeys::Kind;
use crate::engine::scene::Scene;
use crate::engine::simulation::{EventKind, Limited, SPOT_RADIUS, Simulation};
use crate::runs::drive::Run;
use crate::scenario::measurements::LongestQueue;
use crate::scenario::quote::shown;

/// Prints notes on displaced agents, stopped moves, clamped speeds, agents that waited for room, queues that were too
/// long for their line or too dense, and pushes without agents.
pub fn print(run: &Run) {
    let simulation = &run.simulation;
    let outcome = simulation.outcome();
    if !outcome.displaced.is_empty() {
        let count = outcome.displaced.len();
        let first = displaced(&run.scenario.scene, outcome.displaced[0].0);
        talk(&format!(
            "note: {count} agent(s) entered inside an obstacle or outside of the walkable area and were moved \
             to the nearest free point (the first: {first})"
        ));
    }
    if outcome.contained.count > 0 {
        let moves = limited(&outcome.contained, outcome.moves);
        talk(&format!(
            "note: walls stopped {moves}, which would have crossed them"
        ));
    }
    if outcome.clamped.count > 0 {
        let scene = simulation.scene();
        let mut groups = scene.groups.iter();
        let differ = groups.any(|group| group.traits.preferred_speed.is_some());
        let most = match differ {
            true => "the agents' own max_speed".to_owned(),
            false => format!("max_speed, {} m/s", scene.max_speed),
        };
        let moves = limited(&outcome.clamped, outcome.moves);
        talk(&format!("note: {most}, limited {moves}"));
    }
    for backlog in simulation.backlogs().filter(|one| one.largest > 0) {
        let time = simulation.frame().clock.time_at(backlog.largest_frame);
        let (name, largest) = (shown(backlog.name), backlog.largest);
        let rest = match backlog.waiting {
            0 => String::new(),
            waiting => format!("; {waiting} still wait"),
        };
        talk(&format!(
            "note: up to {largest} agent(s) waited for room at \"{name}\" (first at {time:.1} s){rest}"
        ));
    }
    let places = &simulation.scene().journeys.places;
    for (place, state) in places.iter().zip(&simulation.progress().places) {
        if let Kind::Queue(queue) = &place.kind
            && state.longest > queue.room()
        {
            talk(&format!(
                "note: up to {} agents stood in the queue \"{}\", whose line of {:.1} m has room for {}: the others \
                 gathered at its end",
                state.longest,
                shown(&place.name),
                queue.length,
                queue.room()
            ));
        }
    }
    for packed in run
        .metrics
        .longest_queues(simulation)
        .iter()
        .filter_map(LongestQueue::packed)
    {
        talk(&format!("note: {packed}"));
    }
    for event in simulation.events() {
        if event.kind == EventKind::PushBegan(0) {
            let name = shown(&event.name);
            talk(&format!(
                "note: no agents were in the region of \"{name}\" when it began"
            ));
        }
    }
}

/// Prints which agents of `--debug-agents` never entered.
pub fn print_absent(record: &RecordOptions, simulation: &Simulation) {
    let entered = simulation.frame().agents.entered();
    let asked = record.debug_agents.as_deref().map(ids);
    let asked = asked.and_then(Result::ok).unwrap_or_default();
    let absent: Vec<String> = asked
        .iter()
        .filter(|&&id| id >= entered)
        .map(u32::to_string)
        .collect();
    if !absent.is_empty() {
        talk(&format!(
            "note: --debug-agents: {} never entered: only {entered} agents entered, with ids from 0",
            absent.join(", ")
        ));
    }
}

/// An agent that was moved to a free point; from where and how far, if it stood there at the start.
fn displaced(scene: &Scene, agent: u32) -> String {
    let start = scene.agents.get(agent as usize).map(|new| new.position);
    let free = start.and_then(|start| scene.walls.free_point_near(start));
    let from = start.zip(free).map(|(start, free)| {
        let distance = (free - start).norm();
        format!(", from ({}, {}) by {distance:.2} m", start.x, start.y)
    });
    format!("agent {agent}{}", from.unwrap_or_default())
}

/// The number of limited moves among all `moves`, and the place where most of them began.
fn limited(limited: &Limited, moves: u64) -> String {
    let count = limited.count;
    let percent = 100.0 * count as f64 / moves.max(1) as f64;
    let share = match percent {
        0.095.. => format!("{percent:.1} % of all moves"),
        _ => format!("{count} of {moves} moves"),
    };
    let place = limited.spot().map(|(at, there)| {
        let part = match there {
            there if there == count => "all of them".to_owned(),
            there if 2 * there > count => "most of them".to_owned(),
            there => format!("{:.0} % of them", 100.0 * there as f64 / count as f64),
        };
        format!(", {part} within {SPOT_RADIUS} m of ({}, {})", at.x, at.y)
    });
    share + &place.unwrap_or_default()
}
