//! The state of the crowd: one array per quantity, sorted by cell of the neighbor grid.

mod columns;
mod states;

pub use columns::Spare;
pub use states::States;

use rand::Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use columns::Column;

use crate::journeys::Trip;
use crate::levels::Levels;
use crate::math::Vector;
use crate::period::Period;
use crate::random::{self, Purpose};
use crate::routes::{Destination, Plan, Route, Routes, Walker};

/// D_i ∈ U[0.215, 0.265] m (§5.6).
pub const RADIUS_RANGE: [f64; 2] = [0.215, 0.265];
/// The radius of an agent of mass 1, meters (§5.6).
pub const REFERENCE_RADIUS: f64 = 0.24;

/// An agent about to enter. Values that are `None` are drawn or derived.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NewAgent {
    /// Position, meters.
    pub position: Vector,
    /// Velocity, m/s.
    pub velocity: Vector,
    /// Goal, meters.
    pub goal: Vector,
    /// Radius D_i in meters; drawn from [`RADIUS_RANGE`] if `None`.
    pub radius: Option<f64>,
    /// Mass, 1 = an average person; (D_i / 0.24)² if `None`.
    pub mass: Option<f64>,
    /// ρ̂ of the previous frame, P/m²; if `None`, the density from agents alone in its first frame.
    pub mean_density: Option<f64>,
    /// s_pref, m/s; the scene's if `None`.
    pub preferred_speed: Option<f64>,
    /// Time until it walks, seconds; 0 if `None`.
    pub premovement: Option<f64>,
    /// Its [`Group`](crate::scene::Group).
    pub group: u16,
}

impl NewAgent {
    /// An agent at rest at `position`, on the way to `goal`.
    pub fn at(position: Vector, goal: Vector, group: u16) -> Self {
        Self {
            position,
            velocity: Vector::zeros(),
            goal,
            radius: None,
            mass: None,
            mean_density: None,
            preferred_speed: None,
            premovement: None,
            group,
        }
    }
}

/// The state of all agents. All arrays up to `push` have the same length. An index is valid until agents are
/// next sorted or removed; an `id` never changes.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Agents {
    /// Unique number, in the order of entry from 0.
    pub id: Vec<u32>,
    /// r_i, meters.
    pub position: Vec<Vector>,
    /// v_i, m/s.
    pub velocity: Vec<Vector>,
    /// g_i, meters; not used by agents that walk in a direction.
    pub goal: Vec<Vector>,
    /// D_i, meters.
    pub radius: Vec<f64>,
    /// m_i, 1 = an average person.
    pub mass: Vec<f64>,
    /// ρ̂_i of the previous frame, P/m², unclamped (§4.2).
    pub mean_density: Vec<f64>,
    /// Whether ρ̂_i is still unset. The next frame with a density sets it.
    pub newcomer: Vec<bool>,
    /// Index of the agent's group in the scene.
    pub group: Vec<u16>,
    /// Index in the scene of the push that the agent currently takes part in.
    pub push: Vec<Option<u16>>,
    /// The RVO acceleration held until the next coarse frame, m/s²; `None` where RVO does not act. Empty if no
    /// profile uses RVO.
    pub avoidance: Vec<Option<Vector>>,
    /// The speed that the walking law allows, held until the next coarse frame, m/s, infinite without a law or agents
    /// in view; `None` for agents that entered since. Empty if no profile has a law that looks ahead.
    pub allowed_speed: Vec<Option<f64>>,
    /// The heading that the agent follows by the choice of headings, held until the next coarse frame: its number,
    /// counted from the one along the way, positive to its left. Empty if no profile has this law.
    pub heading: Vec<i8>,
    /// What a [`Model`](crate::forces::model::Model) of one's own gave, m/s² or m/s, held until it is asked again;
    /// `None` for agents that entered since. Empty without such a model.
    pub own: Vec<Option<Vector>>,
    /// The acceleration of the previous frame, m/s²; `None` for agents that entered since. Used by velocity Verlet
    /// only, otherwise empty.
    pub acceleration_before: Vec<Option<Vector>>,
    /// The states that forces keep, force by force.
    pub states: Vec<States>,
    /// The way that the agent follows, held until the next coarse frame; `None` for agents that entered since. Empty
    /// in scenes without path maps.
    pub route: Vec<Option<Route>>,
    /// Whether some agents have no route yet.
    pub lacks_routes: bool,
    /// The point that the agent walks to on its route, meters. As long as `route`.
    pub aim: Vec<Vector>,
    /// The opening that the agent walks to, if it chooses quickest routes or through doors; `None` for agents that have
    /// no goal on the floor or entered since the last coarse frame. Empty in scenes without rooms.
    pub plan: Vec<Option<Plan>>,
    /// How far the agent has come on its journey; `None` for agents without a journey, and for those that entered
    /// since the last coarse frame. Empty in scenes without journeys.
    pub trip: Vec<Option<Trip>>,
    /// The factor of the zone where the agent is on its preferred speed; `None` for agents that entered since the last
    /// coarse frame. Empty in scenes without zones.
    pub zone: Vec<Option<f64>>,
    /// s_pref, m/s. Empty while all agents have the scene's.
    pub preferred_speed: Vec<f64>,
    /// s_max, m/s. Empty while all agents have the scene's.
    pub max_speed: Vec<f64>,
    /// The time from which the agent walks, seconds. Empty while no agent had to wait.
    pub walks_from: Vec<f64>,
    /// The number of laps: the periods from the agent's position to the position that it would have without the period.
    /// Empty in scenes without period; agents that entered since the last sort have no entry yet.
    pub laps: Vec<i32>,
    next_id: u32,
}

impl Agents {
    /// The current number of agents.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Whether there are no agents.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// The number of agents that have entered so far.
    pub fn entered(&self) -> u32 {
        self.next_id
    }

    /// The arrays with an entry for every agent.
    fn always(&mut self) -> [&mut dyn Column; 10] {
        self.parts().0
    }

    /// The arrays that may be empty, or lack agents that entered since.
    fn sometimes(&mut self) -> impl Iterator<Item = &mut dyn Column> {
        let (_, sometimes, states) = self.parts();
        sometimes.into_iter().chain(columns::of(states))
    }

    /// The arrays that are not empty.
    fn columns(&mut self) -> impl Iterator<Item = &mut dyn Column> {
        let (always, sometimes, states) = self.parts();
        let all = always
            .into_iter()
            .chain(sometimes)
            .chain(columns::of(states));
        all.filter(|column| column.count() > 0)
    }

    /// The arrays with an entry for every agent, the others, and the states that forces keep.
    fn parts(&mut self) -> ([&mut dyn Column; 10], [&mut dyn Column; 14], &mut [States]) {
        (
            [
                &mut self.id,
                &mut self.position,
                &mut self.velocity,
                &mut self.goal,
                &mut self.radius,
                &mut self.mass,
                &mut self.mean_density,
                &mut self.newcomer,
                &mut self.group,
                &mut self.push,
            ],
            [
                &mut self.avoidance,
                &mut self.allowed_speed,
                &mut self.heading,
                &mut self.own,
                &mut self.acceleration_before,
                &mut self.route,
                &mut self.aim,
                &mut self.plan,
                &mut self.trip,
                &mut self.zone,
                &mut self.laps,
                &mut self.preferred_speed,
                &mut self.max_speed,
                &mut self.walks_from,
            ],
            &mut self.states,
        )
    }

    /// Whether the lengths of all arrays fit together.
    pub fn is_whole(&mut self) -> bool {
        let count = self.len();
        let all_or_none = [&self.preferred_speed, &self.max_speed, &self.walks_from];
        all_or_none
            .map(Vec::len)
            .iter()
            .all(|&len| len == count || len == 0)
            && self.aim.len() == self.route.len()
            && self.always().iter().all(|column| column.count() == count)
            && self.sometimes().all(|column| column.count() <= count)
    }

    /// The current index of agent `id`; `None` if it has left.
    pub fn index_of(&self, id: u32) -> Option<usize> {
        let index = self.id.iter().position(|&other| other == id);
        index.filter(|&i| self.is_present(i))
    }

    /// Whether agent `i` is present: it has not left by an exit, behind which only its body walks on. Forces act
    /// between all bodies; measurements, trajectories and pictures show the agents that are present.
    #[inline]
    pub fn is_present(&self, i: usize) -> bool {
        let trip = self.trip.get(i).and_then(Option::as_ref);
        trip.is_none_or(|trip| !trip.is_outside())
    }

    /// The indices of the agents that are present.
    pub fn present(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        (0..self.len()).filter(|&i| self.is_present(i))
    }

    /// The number of agents that are present.
    pub fn count_present(&self) -> usize {
        match self.trip.is_empty() {
            true => self.len(),
            false => self.present().count(),
        }
    }

    /// ρ̂_i of the previous frame, P/m²; `None` for a newcomer.
    pub fn kept_mean_density(&self, i: usize) -> Option<f64> {
        (!self.newcomer[i]).then_some(self.mean_density[i])
    }

    /// Adds an agent and returns its id.
    pub fn enter(&mut self, new: NewAgent, seed: u64) -> u32 {
        let id = self.next_id;
        self.next_id += 1;
        let radius = new.radius.unwrap_or_else(|| radius_of(seed, id));
        self.id.push(id);
        self.position.push(new.position);
        self.velocity.push(new.velocity);
        self.goal.push(new.goal);
        self.radius.push(radius);
        self.mass
            .push(new.mass.unwrap_or((radius / REFERENCE_RADIUS).powi(2)));
        self.mean_density.push(new.mean_density.unwrap_or(0.0));
        self.newcomer.push(new.mean_density.is_none());
        self.group.push(new.group);
        self.push.push(None);
        id
    }

    /// Sets s_pref and s_max of the agent that entered last, m/s; `scene` has those of agents without their own.
    pub fn set_speeds(&mut self, own: Option<[f64; 2]>, scene: [f64; 2]) {
        let [preferred, max] = own.unwrap_or(scene);
        set_last(
            &mut self.preferred_speed,
            self.id.len(),
            preferred,
            scene[0],
        );
        set_last(&mut self.max_speed, self.id.len(), max, scene[1]);
    }

    /// Changes s_pref and s_max of agent `i`, m/s; `scene` has those of agents without their own.
    pub fn change_speeds(&mut self, i: usize, own: [f64; 2], scene: [f64; 2]) {
        let count = self.id.len();
        let columns = [&mut self.preferred_speed, &mut self.max_speed];
        for (column, (value, usual)) in columns.into_iter().zip(own.into_iter().zip(scene)) {
            if column.is_empty() && value != usual {
                column.resize(count, usual);
            }
            if let Some(slot) = column.get_mut(i) {
                *slot = value;
            }
        }
    }

    /// Sets the time in seconds from which the agent that entered last walks; `None`: from its entry.
    pub fn set_start(&mut self, walks_from: Option<f64>) {
        set_last(
            &mut self.walks_from,
            self.id.len(),
            walks_from.unwrap_or(0.0),
            0.0,
        );
    }

    /// Moves agents that have left the period to their image in it, and counts their laps.
    pub fn wrap(&mut self, period: &Period) {
        self.laps.resize(self.len(), 0);
        for (i, position) in self.position.iter_mut().enumerate() {
            let (image, passed) = period.wrapped(*position);
            for states in &mut self.states {
                states.shift(i, image - *position);
            }
            *position = image;
            self.laps[i] = self.laps[i].wrapping_add(passed);
        }
    }

    /// Moves agents that have walked across a join to the level beyond, where they look for their way again.
    pub fn change_levels(&mut self, levels: &Levels) {
        for i in 0..self.len() {
            if let Some(way) = levels.passed(self.position[i]) {
                self.shift(i, way);
            }
        }
    }

    /// Moves agent `i` by a way that others do not see, to another level, where it looks for its way again.
    pub fn shift(&mut self, i: usize, way: Vector) {
        for states in &mut self.states {
            states.shift(i, way);
        }
        self.position[i] += way;
        self.forget_route(i);
    }

    /// Whether all agents always walk at the scene's preferred speed.
    pub fn walk_alike(&self) -> bool {
        self.preferred_speed.is_empty() && self.walks_from.is_empty()
    }

    /// Finds the routes of all agents in coarse frames, and of those that entered since in every frame. `seed` is that
    /// of the population.
    pub fn follow(&mut self, routes: &Routes, coarse: bool, seed: u64) {
        if !coarse && !self.lacks_routes && self.route.len() == self.len() {
            return;
        }
        self.lacks_routes = false;
        self.route.resize(self.len(), None);
        self.aim.resize(self.len(), Vector::zeros());
        let (ids, positions, goals, radii) = (&self.id, &self.position, &self.goal, &self.radius);
        let (trips, plans) = (&self.trip, &self.plan);
        let own = self.route.par_iter_mut().zip(&mut self.aim);
        let each = own.zip(positions).enumerate().with_min_len(FEW);
        each.for_each(|(i, ((route, aim), &position))| {
            let still_holds = |route: &Route| !coarse || route.holds(position);
            if route.as_ref().is_some_and(still_holds) {
                return;
            }
            let trip = trips.get(i).and_then(Option::as_ref);
            let to = destination(trip, goals[i]);
            let plan = plans.get(i).and_then(Option::as_ref);
            let walker = Walker {
                id: ids[i],
                position,
                to,
                radius: radii[i],
                detour: plan.and_then(|plan| plan.detour(routes, to)),
            };
            *aim = routes.aim(&walker, route, seed);
        });
    }

    /// Where agent `i` wants to go.
    pub fn destination(&self, i: usize) -> Destination {
        destination(self.trip.get(i).and_then(Option::as_ref), self.goal[i])
    }

    /// The states that the force of this name keeps; `None` if no such force keeps any.
    #[inline]
    pub fn states_of(&self, force: &str) -> Option<&States> {
        self.states.iter().find(|states| states.force == force)
    }

    /// The state that the force of this name keeps for agent `i`; `None` if it does not act on it.
    #[inline]
    pub fn state(&self, force: &str, i: usize) -> Option<&[f64]> {
        self.states_of(force)?.of(i)
    }

    /// Agent `i` finds its way again.
    pub fn forget_route(&mut self, i: usize) {
        if let Some(route) = self.route.get_mut(i) {
            *route = None;
            self.lacks_routes = true;
        }
    }

    /// Moves agent `order[k]` to index k. Agents that are not in `order` are removed.
    pub fn arrange(&mut self, order: &[u32]) {
        self.arrange_with(order, &mut Spare::default());
    }

    /// As [`arrange`](Self::arrange), with memory that is used again.
    pub fn arrange_with(&mut self, order: &[u32], spare: &mut Spare) {
        let count = self.len();
        self.lacks_routes |= !self.route.is_empty() && self.route.len() < count;
        for column in self.sometimes() {
            if column.count() > 0 {
                column.extend_to(count);
            }
        }
        columns::arrange(self.columns(), order, spare);
    }
}

/// Where an agent on this trip, or with this goal, wants to go.
fn destination(trip: Option<&Trip>, goal: Vector) -> Destination {
    let place = trip.and_then(Trip::place_ahead);
    place.map_or(Destination::Goal(goal), Destination::Place)
}

/// D_i of agent `id`, if neither it nor its group has another, meters. `seed` is that of the population.
pub fn radius_of(seed: u64, id: u32) -> f64 {
    let [low, high] = RADIUS_RANGE;
    random::stream(seed, Purpose::Body, id, 0).random_range(low..=high)
}

/// Appends the value of agent `count - 1` to an array that is empty while all agents have the value `usual`.
fn set_last(values: &mut Vec<f64>, count: usize, value: f64, usual: f64) {
    if value != usual || !values.is_empty() {
        values.resize(count - 1, usual);
        values.push(value);
    }
}

/// Least number of agents that look for their routes per parallel task.
const FEW: usize = 1024;
