//! Notes on a run: what a reader of its results should know.

use crate::drive::{End, Run};
use engine::clock::SHORTEST_TIME_STEP;
use engine::forces::rates::Rates;
use engine::geometry::Walls;
use engine::journeys::{Change, ChangeKind, Kind};
use engine::scene::Scene;
use engine::simulation::{EventKind, Limited, SPOT_RADIUS};
use engine::stability::{FITTED, Scheme, three_digits};
use scenario::measurements::LongestQueue;
use scenario::quote::shown;
use scenario::{automatic_step, doubtful_radius, in_building, tidy};

/// Notes on displaced agents, stopped moves, clamped speeds, agents that waited for room, queues that were too long for
/// their line or too dense, and pushes without agents.
pub fn of(run: &Run) -> Vec<String> {
    let queues = run.metrics.longest_queues(&run.simulation);
    let packed = queues.iter().filter_map(LongestQueue::packed);
    let first = moved(run).into_iter().chain(waited(run));
    let all = first
        .chain(packed)
        .chain(idle_pushes(run))
        .chain(early(run))
        .chain(unseen(run));
    let levels = run.simulation.scene().levels.as_deref();
    all.map(|note| in_building(levels, &tidy(&note))).collect()
}

/// Notes on agents that were moved, and on stopped moves and clamped speeds if they are 1 % of all moves or more.
fn moved(run: &Run) -> Vec<String> {
    let (scene, outcome) = (run.simulation.scene(), run.simulation.outcome());
    let mut notes = Vec::new();
    if let Some((first, _)) = outcome.displaced.first() {
        let count = outcome.displaced.len();
        let first = displaced(&run.scenario.scene, *first);
        notes.push(format!(
            "{count} agent(s) entered inside an obstacle or outside of the walkable area and were moved to the nearest \
             free point (the first: {first})"
        ));
    }
    let is_noted = |limited: &Limited| 100 * limited.count >= outcome.moves.max(1);
    if is_noted(&outcome.contained) {
        let moves = limited(&outcome.contained, outcome.moves, &scene.walls);
        notes.push(format!(
            "walls stopped {moves}, which would have crossed them"
        ));
    }
    if is_noted(&outcome.clamped) {
        let mut groups = scene.groups.iter();
        let differ = groups.any(|group| group.traits.preferred_speed.is_some());
        let most = match differ {
            true => "the agents' own max_speed".to_owned(),
            false => format!("max_speed, {} m/s", scene.max_speed),
        };
        let moves = limited(&outcome.clamped, outcome.moves, &scene.walls);
        notes.push(format!("{most}, limited {moves}"));
    }
    notes
}

/// Notes on agents that waited for room to enter, and on queues that were longer than their line.
fn waited(run: &Run) -> Vec<String> {
    let simulation = &run.simulation;
    let with_waits = simulation.backlogs().filter(|one| one.largest > 0);
    let backlogs = with_waits.map(|backlog| {
        let time = simulation.frame().clock.time_at(backlog.largest_frame);
        let rest = match backlog.waiting {
            0 => String::new(),
            waiting => format!("; {waiting} still wait"),
        };
        format!(
            "up to {} agent(s) waited for room at \"{}\", the most at {time:.1} s{rest}",
            backlog.largest,
            shown(backlog.name)
        )
    });
    let all = simulation.scene().journeys.places.iter();
    let places = all.zip(&simulation.progress().places);
    let queues = places.filter_map(|(place, state)| {
        let Kind::Queue(queue) = &place.kind else {
            return None;
        };
        (state.longest > queue.room()).then(|| {
            format!(
                "up to {} agents stood in the queue \"{}\", whose line of {:.1} m has room for {}: the others gathered \
                 at its end",
                state.longest,
                shown(&place.name),
                queue.length,
                queue.room()
            )
        })
    });
    backlogs.chain(queues).collect()
}

/// Notes on pushes without agents.
fn idle_pushes(run: &Run) -> Vec<String> {
    let events = run.simulation.events().iter();
    let idle = events.filter(|event| event.kind == EventKind::PushBegan(0));
    let note = |name: &str| {
        format!(
            "no agents were in the region of \"{}\" when it began",
            shown(name)
        )
    };
    idle.map(|event| note(&event.name)).collect()
}

/// A note if the run ended, because all had left, before an exit or a door opened or closed.
fn unseen(run: &Run) -> Option<String> {
    let simulation = &run.simulation;
    let now = simulation.frame().clock.time();
    let journeys = &simulation.scene().journeys;
    let is_late = |change: &&Change| {
        change.at > now
            && change.at < run.scenario.duration_secs
            && change.kind != ChangeKind::Release
    };
    let mut late = journeys.changes.iter().filter(is_late);
    let first = late.next().filter(|_| run.end == Some(End::Empty))?;
    let name = shown(&journeys.places[usize::from(first.place)].name);
    let verb = match first.kind {
        ChangeKind::Close => "closes",
        _ => "opens",
    };
    let more = match late.count() {
        0 => String::new(),
        more => format!(", and {more} later change(s) of exits and doors do not happen either"),
    };
    Some(format!(
        "all have left at {now:.1} s, before `{name}` {verb} at {} s{more}",
        first.at
    ))
}

/// A note if the run ended for want of arrivals before the last agents entered or the last place opened.
fn early(run: &Run) -> Option<String> {
    let simulation = &run.simulation;
    let idle = run
        .scenario
        .stop
        .idle_secs
        .filter(|_| run.end == Some(End::Idle))?;
    let now = simulation.frame().clock.time();
    let journeys = &simulation.scene().journeys;
    let opens = journeys
        .changes
        .iter()
        .find(|change| change.at > now && change.kind != ChangeKind::Close)
        .filter(|_| simulation.frame().agents.count_present() > 0)
        .map(|change| {
            let name = shown(&journeys.places[usize::from(change.place)].name);
            match change.kind {
                ChangeKind::Release => format!("`{name}` is released at {} s", change.at),
                _ => format!("`{name}` opens at {} s", change.at),
            }
        });
    let enter = simulation
        .expects_agents()
        .then(|| "more agents enter later".to_owned());
    let missed: Vec<String> = opens.into_iter().chain(enter).collect();
    (!missed.is_empty()).then(|| {
        format!(
            "stop.idle_secs, {idle} s, ended the run, but {}: give a longer time",
            missed.join(", and ")
        )
    })
}

/// A warning if the time step is longer than the stability limit of a crowd at rest, where the integrator's is known.
pub fn of_step(scene: &Scene) -> Option<String> {
    let scheme = Scheme::of(scene.integrator)?;
    let step = scene.clock.time_step();
    let largest = Rates::of(scene).largest_step(scheme, &FITTED);
    if step <= largest {
        return None;
    }
    let automatic = automatic_step(scene).filter(|&step| step >= SHORTEST_TIME_STEP);
    let by_step = match automatic {
        Some(automatic) => format!("--time-step auto uses {}", three_digits(automatic)),
        None => {
            "no allowed step is short enough: lower the stiffness or raise the masses".to_owned()
        }
    };
    let advice = match doubtful_radius(scene) {
        Some(radius) => format!(
            "such agents, with a radius of {} m, are lighter than people: check `radius`",
            three_digits(radius)
        ),
        None => by_step,
    };
    Some(tidy(&format!(
        "time_step_secs {step} is {} times {}, the largest step at which a crowd comes to rest; {advice}",
        three_digits(step / largest),
        three_digits(largest),
    )))
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

/// The share of limited moves among all `moves`, and the place where most of them began.
fn limited(limited: &Limited, moves: u64, walls: &Walls) -> String {
    let count = limited.count;
    let percent = 100.0 * count as f64 / moves.max(1) as f64;
    let place = limited.spot().map(|(at, there)| {
        // The middle of a cell may lie off the floor.
        let solid = walls.obstacle_at(at);
        let at = solid.and_then(|_| walls.free_point_near(at)).unwrap_or(at);
        let part = match there {
            there if there == count => "all of them".to_owned(),
            there if 2 * there > count => "most of them".to_owned(),
            there => format!("{:.0} % of them", 100.0 * there as f64 / count as f64),
        };
        format!(
            ", {part} within {SPOT_RADIUS} m of ({:.1}, {:.1})",
            at.x, at.y
        )
    });
    format!("{percent:.1} % of all moves{}", place.unwrap_or_default())
}
