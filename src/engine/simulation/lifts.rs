//! Lifts: they call agents from waiting areas into their cabins, and take them to other levels.

use serde::{Deserialize, Serialize};

use super::Crowd;
use crate::journeys::{Kind, Lift, Status};
use crate::levels::Levels;
use crate::math::Vector;
use crate::scene::Scene;

/// A lift waits this long for those whom it has called in, and for a cabin that others stand in, seconds.
const LONGEST_STOP: f64 = 20.0;

/// The state of a lift.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct LiftState {
    /// The number of its stop; during a ride, of the one that it has left.
    pub stop: u16,
    /// What it does.
    pub phase: LiftPhase,
    /// The ids of the agents in it, or called in.
    pub riders: Vec<u32>,
    /// The number of its rides with agents so far.
    pub rides: u32,
}

/// What a lift does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum LiftPhase {
    /// It stands with open doors.
    #[default]
    Idle,
    /// Agents walk in.
    Boarding {
        /// The frame in which it leaves without those outside.
        until: u64,
    },
    /// It moves, or its doors open or close.
    Moving {
        /// The number of the stop.
        to: u16,
        /// The frame in which its doors are open there.
        until: u64,
    },
}

/// A scene, its levels and one of its lifts.
type Of<'a> = (&'a Scene, &'a Levels, &'a Lift);

/// An agent that waits for a lift or rides in it.
#[derive(Clone, Copy)]
struct Passenger {
    /// Its index.
    agent: usize,
    id: u32,
    /// The frame since when it waits.
    since: u64,
    /// The numbers of the stops where it waits and where it wants to go.
    from: usize,
    to: usize,
}

impl Crowd {
    /// Lifts fetch agents that wait for them, and take them to their levels.
    pub(super) fn serve_lifts(&mut self, scene: &Scene) {
        let lifts = &scene.journeys.lifts;
        let Some(levels) = scene.levels.as_deref().filter(|_| !lifts.is_empty()) else {
            return;
        };
        for (k, lift) in lifts.iter().enumerate() {
            let mut state = std::mem::take(&mut self.progress.lifts[k]);
            let waiting = self.passengers(scene, lift);
            self.serve_lift((scene, levels, lift), &mut state, &waiting);
            self.progress.lifts[k] = state;
        }
    }

    /// The agents that wait for a lift or ride in it, those first that wait longest.
    fn passengers(&self, scene: &Scene, lift: &Lift) -> Vec<Passenger> {
        let trips = self.agents.trip.iter().enumerate();
        let found = trips.filter_map(|(agent, trip)| {
            let trip = trip.as_ref()?;
            let Status::Waiting { since, .. } = trip.status else {
                return None;
            };
            let stage = scene.journeys.journeys[usize::from(trip.journey)].stage(trip.stage);
            Some(Passenger {
                agent,
                id: self.agents.id[agent],
                since,
                from: lift.stop_at(trip.place)?,
                to: lift.stop_on(stage.to_level?)?,
            })
        });
        let mut waiting: Vec<Passenger> = found.collect();
        waiting.sort_unstable_by_key(|one| (one.since, one.id));
        waiting
    }

    fn serve_lift(&mut self, of: Of, state: &mut LiftState, waiting: &[Passenger]) {
        let (riding, calling): (Vec<Passenger>, Vec<Passenger>) = waiting
            .iter()
            .partition(|one| state.riders.contains(&one.id));
        state.riders = riding.iter().map(|one| one.id).collect();
        match state.phase {
            LiftPhase::Idle => self.call(of, state, &calling),
            LiftPhase::Boarding { until } => self.board(of, state, (&riding, until)),
            LiftPhase::Moving { to, until } if until <= self.clock.frame() => {
                self.arrive(of, state, (&riding, usize::from(to)), until);
            }
            LiftPhase::Moving { .. } => {}
        }
    }

    /// A lift that stands calls in those who wait at its stop, or moves to whoever waits longest.
    fn call(&mut self, of: Of, state: &mut LiftState, calling: &[Passenger]) {
        let (_, levels, lift) = of;
        let here = usize::from(state.stop);
        let Some(first) = calling.first() else {
            return;
        };
        if first.from != here {
            state.phase = self.ride(lift, [here, first.from]);
        } else if !self.is_cabin_taken((levels, lift), here, &[]) {
            let there = calling.iter().filter(|one| one.from == here);
            let called: Vec<Passenger> = there.copied().take(lift.spots.len()).collect();
            state.riders = called.iter().map(|one| one.id).collect();
            let until = self.clock.time() + LONGEST_STOP;
            state.phase = LiftPhase::Boarding {
                until: self.clock.coarse_frame_at(until),
            };
            self.walk_in(of, &called);
        }
    }

    /// A lift leaves when all that it has called are inside, or without the others.
    fn board(&mut self, of: Of, state: &mut LiftState, (riding, until): (&[Passenger], u64)) {
        let (scene, levels, lift) = of;
        let here = usize::from(state.stop);
        let (inside, outside) = self.sorted_by_place((levels, lift), here, riding);
        if !outside.is_empty() && self.clock.frame() < until {
            self.walk_in(of, riding);
            return;
        }
        for one in outside {
            self.step_back(scene, one);
        }
        state.riders = inside.iter().map(|one| one.id).collect();
        state.phase = self.next_ride(lift, here, &inside);
        state.rides += u32::from(!inside.is_empty());
    }

    /// A lift opens its doors at a stop, as soon as nobody stands where its cabin is.
    fn arrive(
        &mut self,
        of: Of,
        state: &mut LiftState,
        (riding, stop): (&[Passenger], usize),
        until: u64,
    ) {
        let (scene, levels, lift) = of;
        let here = usize::from(state.stop);
        let is_late = self.clock.frame() >= until + self.clock.coarse_frame_at(LONGEST_STOP);
        if self.is_cabin_taken((levels, lift), stop, riding) && !is_late {
            return;
        }
        // Those whom the crowd in the cabin has pushed out stay.
        let (inside, outside) = self.sorted_by_place((levels, lift), here, riding);
        for one in outside {
            self.step_back(scene, one);
        }
        let [from, to] = [here, stop].map(|stop| i32::from(lift.stops[stop].level));
        for one in &inside {
            self.carry(one.agent, levels.way(to - from));
        }
        let (out, on): (Vec<Passenger>, Vec<Passenger>) =
            inside.iter().partition(|one| one.to == stop);
        for one in out {
            self.get_out(scene, one);
        }
        state.stop = stop as u16;
        state.riders = on.iter().map(|one| one.id).collect();
        state.phase = self.next_ride(lift, stop, &on);
    }

    /// The passengers inside of the cabin at a stop, and those outside.
    fn sorted_by_place(
        &self,
        lift: (&Levels, &Lift),
        stop: usize,
        riding: &[Passenger],
    ) -> (Vec<Passenger>, Vec<Passenger>) {
        riding
            .iter()
            .partition(|one| self.is_inside(lift, stop, one.agent))
    }

    /// The ride to the nearest stop of those who are in a lift.
    fn next_ride(&self, lift: &Lift, here: usize, riding: &[Passenger]) -> LiftPhase {
        let climb = |stop: usize| (lift.stops[stop].height - lift.stops[here].height).abs();
        let stops = riding.iter().map(|one| one.to);
        let nearest = stops.min_by(|&a, &b| climb(a).total_cmp(&climb(b)));
        nearest.map_or(LiftPhase::Idle, |to| self.ride(lift, [here, to]))
    }

    fn ride(&self, lift: &Lift, stops: [usize; 2]) -> LiftPhase {
        let until = self.clock.time() + lift.travel_secs(stops);
        LiftPhase::Moving {
            to: stops[1] as u16,
            until: self.clock.coarse_frame_at(until),
        }
    }

    fn is_inside(&self, (levels, lift): (&Levels, &Lift), stop: usize, agent: usize) -> bool {
        let p = self.agents.position[agent];
        let is_there = levels.level(p) == usize::from(lift.stops[stop].level);
        is_there && lift.cabin.contains(levels.in_building(p))
    }

    /// Whether agents other than the `riding` stand where the cabin is at a stop.
    fn is_cabin_taken(
        &self,
        (levels, lift): (&Levels, &Lift),
        stop: usize,
        riding: &[Passenger],
    ) -> bool {
        let mut all = 0..self.agents.len();
        all.any(|i| {
            self.is_inside((levels, lift), stop, i) && !riding.iter().any(|one| one.agent == i)
        })
    }

    /// Agents that are called in walk to their spots in the cabin, around the walls beside its doors.
    fn walk_in(&mut self, of: Of, called: &[Passenger]) {
        let (scene, levels, lift) = of;
        for (one, &spot) in called.iter().zip(&lift.spots) {
            let stop = &lift.stops[one.from];
            let way = levels.way(i32::from(stop.level));
            let (spot, entry) = (spot + way, stop.entry + way);
            let position = self.agents.position[one.agent];
            let sees = |p: Vector| {
                let near = scene.walls.near_any(&[position, p], 0.0);
                scene.walls.first_crossing(position, p, &near).is_none()
            };
            let hold = if sees(spot) { spot } else { entry };
            self.stand(one.agent, hold);
        }
    }

    /// An agent that is not in the cabin in time goes back to where it waited. Others that wait come before it.
    fn step_back(&mut self, scene: &Scene, one: Passenger) {
        self.count_wait(one.agent, one.since);
        let (now, position) = (self.clock.frame(), self.agents.position[one.agent]);
        let Some(trip) = &mut self.agents.trip[one.agent] else {
            return;
        };
        if let (Kind::Waiting(waiting), Status::Waiting { spot, since, .. }) = (
            &scene.journeys.places[usize::from(trip.place)].kind,
            &mut trip.status,
        ) {
            *since = now;
            let spot = waiting.spots.get(*spot as usize).copied();
            self.stand(one.agent, spot.unwrap_or(position));
        }
    }

    fn stand(&mut self, agent: usize, hold: Vector) {
        if let Some(trip) = &mut self.agents.trip[agent] {
            trip.hold = Some(hold);
        }
        self.agents.goal[agent] = hold;
    }

    /// Moves an agent to another level, where its place in the building is the same.
    fn carry(&mut self, agent: usize, way: Vector) {
        self.agents.shift(agent, way);
        let hold = self.agents.trip[agent].and_then(|trip| trip.hold);
        if let Some(hold) = hold {
            self.stand(agent, hold + way);
        }
        self.changed = true;
    }

    /// An agent has come to its level and goes on.
    fn get_out(&mut self, scene: &Scene, one: Passenger) {
        let trip = self.agents.trip[one.agent];
        if let Some((place, Status::Waiting { spot, .. })) =
            trip.map(|trip| (trip.place, trip.status))
        {
            self.progress.places[usize::from(place)].leave_spot(spot);
            self.count_wait(one.agent, one.since);
            self.go_on(scene, one.agent);
        }
    }
}
