//! Journeys: in coarse frames agents begin them, reach waypoints, wait, queue and go on.

use rand::Rng;
use rand::distr::Open01;
use rayon::prelude::*;

use super::choice::{Chooser, Seen};
use super::{Crowd, Simulation, Stage};
use crate::journeys::{Kind, Status, Trip, WaitingArea};
use crate::neighbors::{BLOCK, TASK};
use crate::random::{self, Purpose};
use crate::scene::Scene;

/// Whether this trip fits `scene`.
pub(super) fn fits(trip: &Trip, scene: &Scene) -> bool {
    let journeys = &scene.journeys;
    usize::from(trip.journey) < journeys.journeys.len()
        && usize::from(trip.place) < journeys.places.len()
}

impl Simulation {
    /// In coarse frames: agents begin journeys, choose places, reach them, wait, queue and go on.
    pub(super) fn follow_journeys(&mut self) {
        let (scene, crowd) = (&self.fixed.scene, &mut self.crowd);
        if !crowd.decides() {
            return;
        }
        if !scene.journeys.zones.is_empty() {
            let (agents, time) = (&mut crowd.agents, crowd.clock.time());
            let positions = agents.position.par_iter().with_min_len(TASK * BLOCK);
            let factors = positions.map(|&p| Some(scene.journeys.speed_factor(p, time)));
            factors.collect_into_vec(&mut agents.zone);
        }
        if scene.journeys.has_trips() {
            self.stages
                .time(Stage::Journeys, || crowd.follow_journeys(scene));
        }
    }
}

impl Crowd {
    fn follow_journeys(&mut self, scene: &Scene) {
        self.change_places(scene);
        self.agents.trip.resize(self.agents.len(), None);
        let has_to_begin = |crowd: &Self, i: usize| {
            crowd.agents.trip[i].is_none() && crowd.journey(scene, i).is_some()
        };
        for i in self.where_due(has_to_begin) {
            if let Some(journey) = self.journey(scene, i) {
                self.begin(scene, i, journey);
            }
        }
        self.serve_queues(scene);
        self.serve_lifts(scene);
        let due = self.where_due(|crowd, i| crowd.needs_attention(scene, i));
        let seen = self.seen_by(scene, &due);
        for (i, seen) in due.into_iter().zip(&seen) {
            self.attend(scene, i, seen.as_ref());
        }
    }

    /// The agents for which `is_due` holds, in order of their ids, so that their order in memory does not matter.
    fn where_due(&self, is_due: impl Fn(&Self, usize) -> bool + Sync) -> Vec<usize> {
        let all = (0..self.agents.len()).into_par_iter();
        let due = all.with_min_len(TASK * BLOCK).filter(|&i| is_due(self, i));
        let mut due: Vec<usize> = due.collect();
        due.sort_unstable_by_key(|&i| self.agents.id[i]);
        due
    }

    fn change_places(&mut self, scene: &Scene) {
        let frame = self.clock.frame();
        while let Some(change) = scene.journeys.changes.get(self.progress.changes) {
            if self.clock.coarse_frame_at(change.at) > frame {
                return;
            }
            self.progress.changes += 1;
            self.change_place(scene, change.place, change.kind);
        }
    }

    /// The journey of the group of agent `i`, if it has one.
    pub(super) fn journey(&self, scene: &Scene, i: usize) -> Option<u16> {
        scene.groups[usize::from(self.agents.group[i])].journey
    }

    /// Agent `i` begins a journey.
    pub(super) fn begin(&mut self, scene: &Scene, i: usize, journey: u16) {
        self.progress.begun[usize::from(journey)] += 1;
        self.agents.trip[i] = Some(Trip {
            journey,
            stage: 0,
            place: 0,
            status: Status::Finished,
            hold: None,
            chooses_at: u64::MAX,
            choices: 0,
            entered: self.clock.time(),
            waited: 0.0,
        });
        self.choose(scene, i, None);
    }

    /// Chooses a place of the current stage; `seen`: what the agent sees, if that is known.
    fn choose(&mut self, scene: &Scene, i: usize, seen: Option<&Seen>) {
        let Some(mut trip) = self.agents.trip[i] else {
            return;
        };
        let chooser = Chooser {
            seen: seen.filter(|seen| seen.stage == trip.stage),
            ..Chooser::of(scene, self, i)
        };
        let before = (trip.status == Status::Walking).then_some(trip.place);
        let (place, chooses_at) = chooser.choose(&trip, before);
        trip.chooses_at = chooses_at;
        trip.choices += 1;
        if before != Some(place) {
            // Agents that choose after this one see its choice.
            let has_quickest = scene.journeys.has_quickest();
            let length = |place| has_quickest.then(|| chooser.length(place));
            let left = before.map(|before| (before, length(before), false));
            let bound = (place, length(place), true);
            for (place, length, comes) in left.into_iter().chain([bound]) {
                self.progress.places[usize::from(place)].count(length, comes);
            }
            trip.place = place;
            trip.status = Status::Walking;
            trip.hold = None;
            self.agents.forget_route(i);
            let place = &scene.journeys.places[usize::from(place)];
            self.agents.goal[i] = place.nearest_point(self.agents.position[i]);
        }
        self.agents.trip[i] = Some(trip);
    }

    /// Ends the current stage of agent `i`, which has passed its place, and begins the next one.
    pub(super) fn go_on(&mut self, scene: &Scene, i: usize) {
        let Some(trip) = &mut self.agents.trip[i] else {
            return;
        };
        let state = &mut self.progress.places[usize::from(trip.place)];
        state.pass(self.agents.id[i]);
        let stages = &scene.journeys.journeys[usize::from(trip.journey)].stages;
        trip.status = Status::Finished;
        trip.chooses_at = u64::MAX;
        if usize::from(trip.stage) + 1 < stages.len() {
            trip.stage += 1;
            self.choose(scene, i, None);
        } else {
            trip.hold = trip.hold.or(Some(self.agents.position[i]));
        }
    }

    fn needs_attention(&self, scene: &Scene, i: usize) -> bool {
        let Some(trip) = &self.agents.trip[i] else {
            return false;
        };
        let frame = self.clock.frame();
        let position = self.agents.position[i];
        let is_open = self.progress.places[usize::from(trip.place)].open;
        match trip.status {
            Status::Walking => {
                trip.chooses_at <= frame
                    || match &scene.journeys.places[usize::from(trip.place)].kind {
                        Kind::Exit(_) | Kind::Line(_) | Kind::Door(_) => false,
                        Kind::Disk { at, within } => (position - at).norm() <= *within,
                        Kind::Waiting(waiting) => waiting.area.contains(position),
                        Kind::Queue(_) => true,
                    }
            }
            Status::Waiting { until, .. } => until <= frame || !is_open,
            Status::Queued { .. } | Status::Finished | Status::Outside { .. } => false,
        }
    }

    fn attend(&mut self, scene: &Scene, i: usize, seen: Option<&Seen>) {
        let Some(trip) = self.agents.trip[i] else {
            return;
        };
        let position = self.agents.position[i];
        match (
            &scene.journeys.places[usize::from(trip.place)].kind,
            trip.status,
        ) {
            (_, Status::Waiting { spot, since, .. }) => {
                self.progress.places[usize::from(trip.place)].leave_spot(spot);
                self.count_wait(i, since);
                self.go_on(scene, i);
            }
            (Kind::Disk { at, within }, _) if (position - at).norm() <= *within => {
                self.go_on(scene, i);
            }
            (Kind::Waiting(waiting), _) if waiting.area.contains(position) => {
                self.begin_wait(scene, i, waiting);
            }
            (Kind::Queue(queue), _) => self.approach(scene, i, queue),
            _ => {}
        }
        let frame = self.clock.frame();
        let trip = self.agents.trip[i].as_ref();
        if trip.is_some_and(|trip| trip.status == Status::Walking && trip.chooses_at <= frame) {
            self.choose(scene, i, seen);
        }
    }

    fn begin_wait(&mut self, scene: &Scene, i: usize, waiting: &WaitingArea) {
        let Some(trip) = &mut self.agents.trip[i] else {
            return;
        };
        let state = &mut self.progress.places[usize::from(trip.place)];
        let now = self.clock.time();
        let lasting = waiting
            .lasting
            .as_ref()
            .map(|lasting| now + lasting.quantile(stage_share(scene, self.agents.id[i], trip)));
        let until = [waiting.until, lasting]
            .into_iter()
            .flatten()
            .reduce(f64::min);
        if !state.open || until.is_some_and(|until| until <= now) {
            self.go_on(scene, i);
            return;
        }
        let position = self.agents.position[i];
        let starts_here = trip.entered >= now;
        let spot = state.free_spot(&waiting.spots, starts_here.then_some(position));
        // Agents that start here, and those for which there is no spot, stay where they are.
        let given = waiting.spots.get(spot).filter(|_| !starts_here);
        let hold = given.copied().unwrap_or(position);
        trip.hold = Some(hold);
        self.agents.goal[i] = hold;
        trip.status = Status::Waiting {
            spot: spot as u32,
            since: self.clock.frame(),
            until: until.map_or(u64::MAX, |until| self.clock.coarse_frame_at(until)),
        };
    }

    pub(super) fn count_wait(&mut self, i: usize, since: u64) {
        if let Some(trip) = &mut self.agents.trip[i] {
            let waited = self.clock.time() - self.clock.time_at(since);
            trip.waited += waited;
            self.progress.places[usize::from(trip.place)].waited += waited;
        }
    }
}

/// A random number between 0 and 1 for one stage of one agent.
pub(super) fn stage_share(scene: &Scene, id: u32, trip: &Trip) -> f64 {
    let stage = u64::from(trip.stage);
    random::stream(scene.seed, Purpose::Waiting, id, stage).sample(Open01)
}
