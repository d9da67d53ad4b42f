//! Everything that a simulation keeps from one frame to the next, for saving and resuming.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::integrate::shift;
use super::interventions::Interventions;
use super::schedule::Schedule;
use super::trips;
use super::{Outcome, Progress, Simulation};
use crate::agents::Agents;
use crate::math::Vector;
use crate::scene::Scene;

/// The state: together with the scene, it determines the rest of a run. Densities, pressures, forces and other fields
/// are computed from it. If no force reads the density, only observers use the mean density ρ̂
/// ([`Simulation::request_density_until`]). The state contains it as long as they request it, so that a resumed run
/// observes the same densities.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct State {
    frame: u64,
    agents: Agents,
    /// Positions of all agents when they were last sorted, meters.
    sorted_at: Vec<Vector>,
    /// Whether agents have entered or left since.
    crowd_changed: bool,
    /// Whether the state includes the decisions of this frame, if it is a coarse one.
    decided: bool,
    schedule: Schedule,
    progress: Progress,
    outcome: Outcome,
    interventions: Interventions,
    /// Goals from outside that have path maps, in the order of these maps; `None` if agents do not find their routes.
    mapped_goals: Option<Vec<Vector>>,
    /// Whether the density was computed in this frame.
    has_density: bool,
}

/// The state does not fit the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the state does not belong to this scenario")]
pub struct StateError;

impl Simulation {
    /// The state of the current frame. A resumed run evaluates the frame again if it was evaluated, and makes no
    /// decision twice.
    pub fn state(&self) -> State {
        let crowd = &self.crowd;
        State {
            frame: crowd.clock.frame(),
            agents: crowd.agents.clone(),
            sorted_at: self.derived.neighbors.sorted_at().to_vec(),
            crowd_changed: crowd.changed,
            decided: crowd.decided,
            schedule: crowd.schedule.clone(),
            progress: crowd.progress.clone(),
            outcome: crowd.outcome.clone(),
            interventions: crowd.interventions.clone(),
            mapped_goals: self
                .fixed
                .scene
                .routes
                .as_ref()
                .map(|routes| routes.added_goals().to_vec()),
            has_density: !self.derived.fields.density.is_empty(),
        }
    }

    /// Resumes a run of `scene` from `state`. The result is identical to an uninterrupted run, to the last bit.
    ///
    /// # Errors
    /// The state does not fit the scene.
    pub fn resumed(scene: Scene, mut state: State) -> Result<Self, StateError> {
        let mut empty = Scene {
            agents: Vec::new(),
            ..scene
        };
        if !state.interventions.fit(&empty) {
            return Err(StateError);
        }
        let clock = empty.clock;
        state.interventions.edit_again(&mut empty, &clock);
        let mut simulation = Self::new(empty).map_err(|_| StateError)?;
        if state.mapped_goals.is_some() {
            simulation.take_later_routes();
        }
        let scene = &mut Arc::make_mut(&mut simulation.fixed).scene;
        for &goal in state.mapped_goals.iter().flatten() {
            let routes = scene.routes.as_mut().map(Arc::make_mut);
            let added = routes.map(|routes| routes.add_goal(goal, |_| true));
            added.ok_or(StateError)?.map_err(|_| StateError)?;
        }
        state.check(&simulation.fixed.scene)?;
        let crowd = &mut simulation.crowd;
        let states = state.agents.states.iter().zip(&crowd.agents.states);
        let like = states.filter(|(saved, new)| saved.is_like(new)).count();
        if like != state.agents.states.len().max(crowd.agents.states.len()) {
            return Err(StateError);
        }
        crowd.clock.go_to(state.frame);
        crowd.agents = state.agents;
        crowd.schedule = state.schedule;
        crowd.progress = state.progress;
        crowd.outcome = state.outcome;
        crowd.interventions = state.interventions;
        crowd.changed = state.crowd_changed;
        crowd.decided = state.decided;
        if !state.crowd_changed {
            simulation.list_again(state.sorted_at)?;
        }
        if state.has_density {
            let count = simulation.crowd.agents.len();
            simulation.derived.fields.resize_sph(count);
        }
        Ok(simulation)
    }

    /// Rebuilds the neighbor lists as they were when the agents were at `sorted_at`.
    fn list_again(&mut self, sorted_at: Vec<Vector>) -> Result<(), StateError> {
        let agents = &mut self.crowd.agents;
        let (ids, positions) = (agents.id.clone(), agents.position.clone());
        agents.position = sorted_at;
        self.sort_agents();
        let (agents, neighbors) = (&mut self.crowd.agents, &mut self.derived.neighbors);
        if agents.id != ids {
            return Err(StateError); // the saved agents were not in the order of their cells
        }
        agents.position = positions;
        let moves = agents.position.iter().zip(neighbors.sorted_at());
        let squares = moves.map(|(now, then)| (now - then).norm_squared());
        let farthest = squares.fold(0.0, f64::max);
        let mut strips = neighbors.take_strips();
        shift(&agents.position, neighbors.sorted_at(), &mut strips);
        neighbors.moved(farthest.sqrt(), strips);
        Ok(())
    }
}

impl State {
    /// The same state, whose lists of neighbors are made anew.
    #[doc(hidden)]
    pub fn without_lists(self) -> Self {
        Self {
            crowd_changed: true,
            ..self
        }
    }

    /// Whether agents find their routes: the scene needs path maps, also if it has none at the start.
    pub fn has_routes(&self) -> bool {
        self.mapped_goals.is_some()
    }

    /// Whether this state fits `scene`.
    fn check(&mut self, scene: &Scene) -> Result<(), StateError> {
        let is_whole = self.agents.is_whole();
        let agents = &self.agents;
        let mut groups = agents.group.iter().map(|&group| usize::from(group));
        let mut pushes = agents.push.iter().flatten().map(|&push| usize::from(push));
        let known = groups.all(|group| group < scene.groups.len())
            && pushes.all(|push| push < scene.pushes.len())
            && self.schedule.fits(scene)
            && self.progress.fits(scene)
            && agents.route.iter().flatten().all(|route| {
                let routes = scene.routes.as_ref();
                routes.is_none_or(|routes| routes.knows(route))
            })
            && agents.plan.iter().flatten().all(|plan| {
                let routes = scene.routes.as_ref();
                routes.is_none_or(|routes| plan.fits(routes))
            })
            && agents
                .trip
                .iter()
                .flatten()
                .all(|trip| !self.progress.places.is_empty() && trips::fits(trip, scene));
        let listed = self.crowd_changed || self.sorted_at.len() == agents.len();
        (is_whole && known && listed)
            .then_some(())
            .ok_or(StateError)
    }
}
