//! Everything that a simulation keeps from one frame to the next, for saving and resuming.

use serde::{Deserialize, Serialize};

use super::schedule::Schedule;
use super::{Outcome, Simulation};
use crate::engine::agents::Agents;
use crate::engine::math::{Vector, pairs_of};
use crate::engine::scene::Scene;

/// The state: together with the scene, it determines the rest of a run. Densities, pressures, forces and other
/// fields are computed from it. If no force reads the density, the mean density ρ̂ serves observers only
/// ([`Simulation::request_density_until`]). The state then still contains it while it is requested, so that a
/// resumed run observes the same densities.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct State {
    frame: u64,
    agents: Agents,
    /// Positions of all agents when they were last sorted, meters.
    #[serde(with = "pairs_of::many")]
    sorted_at: Vec<Vector>,
    /// Have agents entered or left since?
    crowd_changed: bool,
    schedule: Schedule,
    outcome: Outcome,
    /// Was the density computed in this frame?
    has_density: bool,
}

/// The state does not fit the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the state does not belong to this scenario")]
pub struct StateError;

impl Simulation {
    /// The state of an evaluated frame.
    pub fn state(&self) -> State {
        State {
            frame: self.clock.frame(),
            agents: self.agents.clone(),
            sorted_at: self.neighbors.sorted_at().to_vec(),
            crowd_changed: self.crowd_changed,
            schedule: self.schedule.clone(),
            outcome: self.outcome.clone(),
            has_density: !self.fields.density.is_empty(),
        }
    }

    /// Resumes a run of `scene` from `state`. The result is identical to an uninterrupted run, to the last bit.
    ///
    /// # Errors
    /// The state does not fit the scene.
    pub fn resumed(scene: Scene, state: State) -> Result<Self, StateError> {
        let empty = Scene {
            agents: Vec::new(),
            ..scene
        };
        let mut simulation = Self::new(empty).map_err(|_| StateError)?;
        simulation.check_state(&state)?;
        let State {
            frame,
            agents,
            sorted_at,
            crowd_changed,
            schedule,
            outcome,
            has_density,
        } = state;
        simulation.clock.go_to(frame);
        simulation.agents = agents;
        simulation.schedule = schedule;
        simulation.outcome = outcome;
        simulation.crowd_changed = crowd_changed;
        if !crowd_changed {
            simulation.list_again(sorted_at)?;
        }
        if has_density {
            simulation.fields.resize(simulation.agents.len(), true);
        }
        Ok(simulation)
    }

    fn check_state(&self, state: &State) -> Result<(), StateError> {
        let agents = &state.agents;
        let groups = self.scene.groups.len();
        let pushes = self.scene.pushes.len();
        let known = agents
            .group
            .iter()
            .all(|&group| usize::from(group) < groups)
            && agents
                .push
                .iter()
                .flatten()
                .all(|&push| usize::from(push) < pushes)
            && state.schedule.fits(&self.scene);
        let listed = state.crowd_changed || state.sorted_at.len() == agents.len();
        (agents.is_whole() && known && listed)
            .then_some(())
            .ok_or(StateError)
    }

    /// Rebuilds the neighbor lists as they were when the agents were at `sorted_at`.
    fn list_again(&mut self, sorted_at: Vec<Vector>) -> Result<(), StateError> {
        let positions = std::mem::replace(&mut self.agents.position, sorted_at);
        let ids = self.agents.id.clone();
        self.sort_agents();
        self.list_walls();
        if self.agents.id != ids {
            return Err(StateError); // the saved agents were not in the order of their cells
        }
        let ways = positions.iter().zip(self.neighbors.sorted_at());
        let squares = ways.map(|(now, then)| (now - then).norm_squared());
        let farthest = squares.fold(0.0, f64::max);
        self.neighbors.travelled(farthest.sqrt());
        self.agents.position = positions;
        Ok(())
    }
}
