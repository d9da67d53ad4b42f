//! State, counts and flows of the exits, doors and entrances of a run.

use std::collections::VecDeque;

use engine::journeys::Kind;
use engine::scene::Action;
use engine::simulation::Simulation;
use runs::drive::Run;
use serde_json::{Value, json};

/// Flows are means over this time, seconds.
const OVER: f64 = 10.0;
/// The time between two counts, seconds.
const EVERY: f64 = 0.5;

/// How many people had passed each place at earlier times.
#[derive(Debug, Clone, Default)]
pub struct Doors {
    /// The time, seconds, and the numbers by place.
    counts: VecDeque<(f64, Vec<u32>)>,
}

impl Doors {
    /// Counts, if it is time.
    pub fn observe(&mut self, simulation: &Simulation) {
        let now = simulation.frame().clock.time();
        if self
            .counts
            .back()
            .is_some_and(|(time, _)| now < time + EVERY)
        {
            return;
        }
        let passed = simulation
            .progress()
            .places
            .iter()
            .map(|state| state.passed);
        self.counts.push_back((now, passed.collect()));
        while self.counts.len() > 1 && self.counts[1].0 <= now - OVER {
            self.counts.pop_front();
        }
    }

    /// What is known of each now, in a run whose queues have been observed from a time on, once per second.
    pub fn now(&self, run: &Run, observed_from: f64) -> Value {
        let (simulation, queues) = (&run.simulation, run.metrics.queues());
        let scene = simulation.scene();
        let states = &simulation.progress().places;
        let now = simulation.frame().clock.time();
        let people = simulation.frame().agents.count_present() as u32;
        let places = scene.journeys.places.iter().enumerate();
        let of_places = places.filter_map(|(k, place)| {
            let kind = match &place.kind {
                Kind::Exit(_) => "exit",
                Kind::Door(_) => "door",
                _ => return None,
            };
            let state = states.get(k);
            let passed = state.map_or(0, |state| state.passed);
            let flow = self.counts.front().and_then(|(time, before)| {
                let before = before.get(k)?;
                (now > time + EVERY).then(|| f64::from(passed - passed.min(*before)) / (now - time))
            });
            let number = u16::try_from(k).ok()?;
            let people_waiting = queues.get(&number).copied().unwrap_or_default();
            let queue = (now >= observed_from + 1.0).then_some(people_waiting.min(people));
            Some(json!({
                "name": place.name, "kind": kind, "open": state.is_none_or(|state| state.open), "passed": passed,
                "queue": queue, "flow_per_s": flow,
            }))
        });
        let entrances = scene.entrances.iter().enumerate().map(|(k, entrance)| {
            let waiting = simulation.backlogs().nth(k).map(|one| one.waiting);
            json!({
                "name": entrance.name, "kind": "entrance", "open": is_open(simulation, k), "passed": null,
                "queue": waiting, "flow_per_s": null,
            })
        });
        of_places.chain(entrances).collect()
    }
}

/// Whether an entrance is open: what the last of the interventions says.
fn is_open(simulation: &Simulation, k: usize) -> bool {
    let frame = simulation.frame().clock.frame();
    let planned = simulation.scene().interventions.iter();
    let all = planned.chain(simulation.interventions());
    let done = all.filter(|one| one.frame <= frame);
    let changes = done.filter_map(|one| match one.action {
        Action::Entrance { entrance, open } if usize::from(entrance) == k => {
            Some((one.frame, open))
        }
        _ => None,
    });
    changes
        .max_by_key(|&(frame, _)| frame)
        .is_none_or(|(_, open)| open)
}
