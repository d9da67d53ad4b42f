//! The loop (§4.1).

mod digest;
mod evaluate;
mod integrate;
mod schedule;
mod stages;
mod state;

pub use schedule::{Event, EventKind};
pub use stages::{Stage, StageTimes};
pub use state::{State, StateError};

use serde::{Deserialize, Serialize};

use crate::engine::agents::Agents;
use crate::engine::clock::Clock;
use crate::engine::forces::social::SocialForce;
use crate::engine::frame::{Fields, Frame};
use crate::engine::math::{Vector, pairs_of};
use crate::engine::neighbors::Neighbors;
use crate::engine::pairs::{Packed, Precision};
use crate::engine::profile::{Blend, Override};
use crate::engine::scene::{Needs, Scene};

/// A crowd in a scene, one frame after the other.
///
/// Each frame is [`evaluate`](Self::evaluate), then [`integrate`](Self::integrate); in between the
/// frame is frozen, and positions agree with everything computed from them. The bits do not depend on
/// the number of threads: every agent reads the frozen frame and writes its own slot.
#[derive(Clone)]
pub struct Simulation {
    scene: Scene,
    needs: Needs,
    /// The different ones of the scene.
    social_forces: Vec<SocialForce>,
    density_until: u64,
    clock: Clock,
    agents: Agents,
    fields: Fields,
    neighbors: Neighbors,
    packed: Packed,
    schedule: schedule::Schedule,
    outcome: Outcome,
    stages: StageTimes,
    evaluated: bool,
    /// Is every number of the evaluated frame finite?
    finite: bool,
    crowd_changed: bool,
}

/// What has happened so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Who reached the goal and left, in order.
    pub arrivals: Vec<Arrival>,
    /// How many moves ended at a wall that they would have crossed.
    pub contained_moves: u64,
    /// How often a speed was cut to the highest allowed.
    pub clamped_speeds: u64,
    /// Agents that were put out of an obstacle when they entered: id and obstacle.
    pub displaced: Vec<(u32, usize)>,
}

/// Somebody who reached the goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Arrival {
    /// The agent's id.
    pub id: u32,
    /// When, seconds: after the move that led there.
    pub time: f64,
    /// Where that move ended, meters.
    #[serde(with = "pairs_of::one")]
    pub position: Vector,
    /// Does it count as evacuated?
    pub counted: bool,
}

/// The simulation cannot go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A number that is not one.
    #[error(
        "frame {frame} (t = {time:.2} s): the {quantity} of agent {agent} at ({:.3}, {:.3}) is not finite; \
         a smaller time_step_secs, gas_constant or stiffness may help",
        position.x, position.y
    )]
    NotFinite {
        /// The frame.
        frame: u64,
        /// The time of the frame, seconds.
        time: f64,
        /// The agent's id.
        agent: u32,
        /// Where it stands, meters.
        position: Vector,
        /// Which number.
        quantity: &'static str,
    },
    /// Nowhere to put somebody.
    #[error("agent {agent} enters inside obstacle {obstacle}, and no free point is near")]
    NoFreePoint {
        /// The agent's id.
        agent: u32,
        /// The obstacle's index.
        obstacle: usize,
    },
}

impl Simulation {
    /// Lets the first agents in.
    ///
    /// # Errors
    /// Somebody stands inside an obstacle that has no way out.
    pub fn new(scene: Scene) -> Result<Self, Fault> {
        let mut simulation = Self {
            needs: scene.needs(),
            social_forces: scene.social_forces(),
            density_until: 0,
            clock: scene.clock,
            agents: Agents::default(),
            fields: Fields::default(),
            neighbors: Neighbors::default(),
            packed: Packed::new(scene.precision),
            schedule: schedule::Schedule::default(),
            outcome: Outcome::default(),
            stages: StageTimes::default(),
            evaluated: false,
            finite: true,
            crowd_changed: true,
            scene,
        };
        for agent in std::mem::take(&mut simulation.scene.agents) {
            simulation.enter(agent)?;
        }
        Ok(simulation)
    }

    /// One frame.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate) and [`integrate`](Self::integrate).
    pub fn step(&mut self) -> Result<(), Fault> {
        self.evaluate()?;
        self.integrate()
    }

    /// Steps 1–4 of §4.1: computes the current frame and returns it, frozen and complete. Moves no agent; an
    /// evaluated frame is returned as it is.
    ///
    /// # Errors
    /// An agent enters inside an obstacle that has no way out.
    pub fn evaluate(&mut self) -> Result<Frame<'_>, Fault> {
        if !self.evaluated {
            self.follow_schedule()?; // entries and pushes, coarse
            self.update_neighbors(); // 1
            self.pack();
            self.update_density_and_pressure(self.clock.time_step()); // 1B
            self.update_preferred_velocity(); // 2
            self.update_rvo(); // 3, coarse
            self.update_acceleration(); // 3, 3B, 4
            self.evaluated = true;
        }
        Ok(self.frame())
    }

    fn density_is_due(&self) -> bool {
        self.needs.density || self.clock.frame() < self.density_until
    }

    /// Requests the density in every frame before `frame`, though no force reads it: for a metric, a
    /// color, a breakdown, a checkpoint. A request from the first frame on gives all observers the same
    /// densities; after a gap the mean density ρ̂ starts anew. It never changes the motion or the digest.
    pub fn request_density_until(&mut self, frame: u64) {
        self.density_until = self.density_until.max(frame);
    }

    /// Evaluates the frame once more, with the density in it, for a breakdown of what is wrong there.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    pub fn evaluate_with_density(&mut self) -> Result<Frame<'_>, Fault> {
        self.request_density_until(self.clock.frame() + 1);
        self.evaluated = false;
        self.evaluate()
    }

    /// Takes the sums over pairs of all later evaluations in another precision than the scene's.
    pub fn set_precision(&mut self, precision: Precision) {
        self.packed = Packed::new(precision);
    }

    /// Computes from the next frame on also what `more` asks for, though nothing reads it: to measure
    /// what is saved by not computing it. The crowd is sorted anew, and else moves as before, bit by bit.
    pub fn pay_for(&mut self, more: &Needs) {
        self.needs = self.needs.with(more);
        self.crowd_changed = true; // lists as far as is now asked for
    }

    /// The current frame. Its fields are those of [`evaluate`](Self::evaluate); after
    /// [`integrate`](Self::integrate), which moves the agents, they are empty until the next evaluation.
    pub fn frame(&self) -> Frame<'_> {
        let frame = self.frozen();
        if self.evaluated {
            frame
        } else {
            Frame {
                fields: &NO_FIELDS,
                ..frame
            }
        }
    }

    /// The frame while it is being evaluated, with the fields computed so far.
    fn frozen(&self) -> Frame<'_> {
        Frame {
            clock: &self.clock,
            walls: &self.scene.walls,
            agents: &self.agents,
            fields: &self.fields,
            neighbors: &self.neighbors,
            packed: &self.packed,
            wanted: self.needs.pairs,
            seed: self.scene.behaviour_seed.unwrap_or(self.scene.seed),
        }
    }

    /// What the simulation was made from, but for its first agents, who have entered.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Which parts of the model this scene pays for.
    pub fn needs(&self) -> &Needs {
        &self.needs
    }

    /// How agent `i` behaves.
    pub fn blend(&self, i: usize) -> &Blend {
        blend_of(&self.scene, &self.agents, i)
    }

    /// What a push changes for agent `i` now.
    pub fn change(&self, i: usize) -> Option<&Override> {
        change_of(&self.scene, &self.agents, i)
    }

    /// What has happened so far.
    pub fn outcome(&self) -> &Outcome {
        &self.outcome
    }

    /// Will anybody enter later?
    pub fn expects_agents(&self) -> bool {
        self.schedule.expects_agents(&self.scene)
    }

    /// Entries and pushes so far.
    pub fn events(&self) -> &[Event] {
        self.schedule.events()
    }

    /// Time spent per stage.
    pub fn stages(&self) -> &StageTimes {
        &self.stages
    }

    /// Starts measuring anew.
    pub fn reset_stages(&mut self) {
        self.stages = StageTimes::default();
    }
}

/// The fields of a frame that has not been evaluated.
static NO_FIELDS: Fields = Fields::NONE;

fn blend_of<'a>(scene: &'a Scene, agents: &Agents, i: usize) -> &'a Blend {
    &scene.groups[usize::from(agents.group[i])].blend
}

fn change_of<'a>(scene: &'a Scene, agents: &Agents, i: usize) -> Option<&'a Override> {
    agents.push[i].map(|push| &scene.pushes[usize::from(push)].change)
}
