//! The loop (§4.1).

mod behavior;
mod bound;
mod choice;
mod closed;
mod control;
mod digest;
mod doors;
mod entrances;
mod evaluate;
mod expected;
mod goals;
mod integrate;
mod interventions;
mod lifts;
mod limited;
mod loads;
mod passing;
mod plans;
mod progress;
mod queues;
mod refused;
mod schedule;
mod schemes;
mod situation;
mod stages;
mod state;
mod states;
mod stream;
mod times;
mod trips;

pub use choice::{Decision, Prospect, Reason};
pub use closed::Closed;
pub use control::Added;
pub use entrances::Backlog;
pub use expected::Expected;
pub use lifts::{LiftPhase, LiftState};
pub use limited::{Limited, SPOT_RADIUS};
pub use passing::{BEFORE_WALLS, WALKS_ON};
pub use plans::RouteDecision;
pub use progress::{PlaceState, Progress};
#[doc(hidden)]
pub use refused::refused_change;
pub use refused::{Absent, ActionError};
pub use schedule::{Event, EventKind};
pub use stages::{Stage, StageTimes};
pub use state::{State, StateError};
pub use stream::Stream;
pub use times::RouteProspect;

use std::sync::{Arc, LazyLock};

use serde::{Deserialize, Serialize};

use crate::agents::Agents;
use crate::clock::Clock;
use crate::forces::own::Force;
use crate::forces::social::SocialForce;
use crate::forces::walking::WalkingLaw;
use crate::frame::{Fields, Frame};
use crate::math::Vector;
use crate::neighbors::Neighbors;
use crate::pairs::{Packed, Precision};
use crate::profile::{Blend, Override};
use crate::routes::Narrowings;
use crate::scene::{Needs, Scene};

/// A crowd in a scene, simulated frame by frame.
///
/// Each frame consists of [`evaluate`](Self::evaluate) and [`integrate`](Self::integrate). In between, the frame is
/// frozen: everything computed matches the positions. Results are identical to the last bit for any number of
/// threads, because every agent reads the frozen frame and writes only its own slot.
#[derive(Clone)]
pub struct Simulation {
    /// Shared by its [forks](Self::fork) until one of them changes.
    fixed: Arc<Fixed>,
    crowd: Crowd,
    derived: Derived,
    buffers: Buffers,
    stages: StageTimes,
    /// The density is requested for all frames before this one.
    density_until: u64,
}

/// Parameters: fixed before the first frame.
#[derive(Clone)]
struct Fixed {
    scene: Scene,
    needs: Needs,
    /// The distinct social forces of the scene.
    social_forces: Vec<SocialForce>,
    /// The distinct walking laws of the scene that look ahead.
    walking_laws: Vec<WalkingLaw>,
    /// The narrowings that walking laws of the scene heed.
    narrowings: Narrowings,
}

/// State: with the parameters, it determines all later frames.
#[derive(Clone)]
struct Crowd {
    clock: Clock,
    agents: Agents,
    schedule: schedule::Schedule,
    progress: Progress,
    outcome: Outcome,
    interventions: interventions::Interventions,
    /// Whether agents have entered or left since they were last sorted.
    changed: bool,
    /// Whether entries, choices and all other changes of the state in a coarse frame have been made in this frame. They
    /// are made once, however often the frame is evaluated.
    decided: bool,
}

/// Fields: computed from parameters and state in every frame.
#[derive(Clone)]
struct Derived {
    neighbors: Neighbors,
    packed: Packed,
    fields: Fields,
    /// Whether the fields match the crowd.
    evaluated: bool,
    /// Whether all numbers of the evaluated frame are finite.
    finite: bool,
}

/// Results of a step that still reads the frame's previous ones; swapped with them when complete.
#[derive(Clone, Default)]
struct Buffers {
    avoidance: Vec<Option<Vector>>,
    allowed_speed: Vec<Option<f64>>,
    heading: Vec<i8>,
    acceleration: Vec<Vector>,
    /// The positions before the move, in scenes with journeys.
    before: Vec<Vector>,
}

/// Arrivals, stopped moves, clamped speeds and displaced agents so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Agents that reached their goal and left, in order.
    pub arrivals: Vec<Arrival>,
    /// Number of moves so far: one per agent and frame.
    pub moves: u64,
    /// Moves stopped at a wall that they would have crossed.
    pub contained: Limited,
    /// Moves after which the speed was clamped to s_max.
    pub clamped: Limited,
    /// Agents that entered inside an obstacle and were moved out of it: id and obstacle.
    pub displaced: Vec<(u32, usize)>,
    /// Agents that an [`Action`](crate::scene::Action) took out, in order.
    pub removed: Vec<Removal>,
}

/// An agent that was taken out of the simulation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Removal {
    /// The agent's id.
    pub id: u32,
    /// The time of the frame, seconds.
    pub time: f64,
    /// Its position, meters.
    pub position: Vector,
}

/// An agent that reached its goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Arrival {
    /// The agent's id.
    pub id: u32,
    /// Time at the end of the move that reached the goal, seconds.
    pub time: f64,
    /// Position at the end of that move, meters.
    pub position: Vector,
    /// Whether it counts as evacuated.
    pub counted: bool,
    /// The journey that ended here; `None` for agents that walked to a goal of their own.
    pub trip: Option<TripEnd>,
}

/// The end of a journey at an exit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TripEnd {
    /// The number of the journey.
    pub journey: u16,
    /// The number of the exit among the places.
    pub exit: u16,
    /// When the agent entered, seconds.
    pub entered: f64,
    /// How long it waited in waiting areas and queues, seconds.
    pub waited: f64,
}

/// Why a simulation cannot continue.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A quantity is infinite or NaN.
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
        /// Its position, meters.
        position: Vector,
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// An agent enters inside an obstacle, and no free point is near.
    #[error("agent {agent} enters inside obstacle {obstacle}, and no free point is near")]
    NoFreePoint {
        /// The agent's id.
        agent: u32,
        /// The obstacle's index.
        obstacle: usize,
    },
    /// A model of one's own gave no vectors.
    #[error("the model {name}: {message}")]
    Model {
        /// Its name.
        name: String,
        /// Why.
        message: String,
    },
    /// Two forces of the same name keep different numbers for agents.
    #[error(
        "two forces are named {force}, and they keep different numbers for agents; give one another name"
    )]
    DifferentStates {
        /// The name of both.
        force: String,
    },
}

impl Simulation {
    /// Builds a simulation and lets the initial agents in.
    ///
    /// # Errors
    /// An agent is inside an obstacle, and no free point is near; or two forces of one name keep different numbers.
    pub fn new(scene: Scene) -> Result<Self, Fault> {
        let fixed = Fixed {
            needs: scene.needs(),
            social_forces: scene.social_forces(),
            walking_laws: scene.walking_laws(),
            narrowings: scene.narrowings(),
            scene: Scene {
                agents: Vec::new(),
                ..scene
            },
        };
        let mut crowd = Crowd {
            clock: fixed.scene.clock,
            agents: Agents::default(),
            schedule: schedule::Schedule::default(),
            progress: Progress::default(),
            outcome: Outcome::default(),
            interventions: interventions::Interventions::default(),
            changed: true,
            decided: false,
        };
        crowd.agents.states = fixed.no_states()?;
        for agent in scene.agents {
            crowd.enter(&fixed.scene, agent)?;
        }
        Ok(Self {
            derived: Derived {
                neighbors: Neighbors::on_levels(fixed.scene.levels.clone()),
                packed: Packed::new(fixed.scene.precision),
                fields: Fields::default(),
                evaluated: false,
                finite: true,
            },
            fixed: Arc::new(fixed),
            crowd,
            buffers: Buffers::default(),
            stages: StageTimes::default(),
            density_until: 0,
        })
    }

    /// An independent copy in the same frame. Both go on to the same bits if the same is done to them, on any number of
    /// threads. What cannot change, such as walls and path maps, is shared.
    #[must_use]
    pub fn fork(&self) -> Self {
        self.clone()
    }

    /// Simulates one frame.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate) and [`integrate`](Self::integrate).
    pub fn step(&mut self) -> Result<(), Fault> {
        self.on_pool(|simulation| {
            simulation.evaluate()?;
            simulation.integrate()
        })
    }

    /// Steps 1–4 of §4.1: computes the current frame and returns it, frozen and complete. Moves no agent. A frame
    /// that is already evaluated is returned unchanged.
    ///
    /// # Errors
    /// An agent enters inside an obstacle, and no free point is near.
    pub fn evaluate(&mut self) -> Result<Frame<'_>, Fault> {
        if !self.derived.evaluated {
            self.on_pool(Self::compute)?;
        }
        Ok(self.frame())
    }

    fn compute(&mut self) -> Result<(), Fault> {
        self.make_interventions()?;
        self.follow_schedule()?; // entries and pushes, coarse
        self.count_streams(); // once per second
        self.follow_journeys(); // coarse
        self.follow_plans(); // coarse
        self.update_neighbors(); // 1
        self.pack();
        self.update_density_and_pressure(self.crowd.clock.time_step()); // 1B
        self.follow_routes(self.crowd.decides()); // coarse
        self.update_preferred_velocity(); // 2
        self.follow_model()?; // 2, a model of one's own
        self.update_walking_laws(); // 3, coarse
        self.update_rvo(); // 3, coarse
        self.update_acceleration(); // 3, 3B, 4
        self.crowd.decided = true;
        self.derived.evaluated = true;
        Ok(())
    }

    fn density_is_due(&self) -> bool {
        self.fixed.needs.density || self.crowd.clock.frame() < self.density_until
    }

    /// Requests the density in every frame before `frame`, even if no force reads it: for a metric, a color, a
    /// breakdown or a checkpoint. If it is requested from the first frame on, all observers see the same densities;
    /// after a gap the mean density ρ̂ restarts. A request never changes the motion or the digest.
    pub fn request_density_until(&mut self, frame: u64) {
        self.density_until = self.density_until.max(frame);
    }

    /// Evaluates the current frame again, with the density, for a breakdown of a faulty frame. The state stays the
    /// same.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    pub fn evaluate_with_density(&mut self) -> Result<Frame<'_>, Fault> {
        self.request_density_until(self.crowd.clock.frame() + 1);
        self.derived.evaluated = false;
        self.evaluate()
    }

    /// Sets the precision of sums over pairs for all later evaluations, in place of the scene's.
    pub fn set_precision(&mut self, precision: Precision) {
        self.derived.packed = Packed::new(precision);
    }

    /// From the next evaluation on, also computes the quantities in `more`, although nothing reads them: this measures
    /// the time that is saved by not computing them. Agents are sorted again; their motion stays identical to the last
    /// bit.
    pub fn pay_for(&mut self, more: &Needs) {
        let fixed = Arc::make_mut(&mut self.fixed);
        fixed.needs = fixed.needs.with(more);
        self.crowd.changed = true; // rebuild neighbor lists with the new ranges
    }

    /// The current frame. Its fields are those computed by [`evaluate`](Self::evaluate). After
    /// [`integrate`](Self::integrate), which moves the agents, they are empty until the next evaluation.
    pub fn frame(&self) -> Frame<'_> {
        let frame = self.derived.frame(&self.fixed, &self.crowd);
        if self.derived.evaluated {
            frame
        } else {
            Frame {
                fields: &NO_FIELDS,
                ..frame
            }
        }
    }

    /// The scene of this simulation, without the initial agents, which have already entered.
    pub fn scene(&self) -> &Scene {
        &self.fixed.scene
    }

    /// The quantities that are computed.
    pub fn needs(&self) -> &Needs {
        &self.fixed.needs
    }

    /// The blend of agent `i`.
    pub fn blend(&self, i: usize) -> &Blend {
        self.fixed.blend(&self.crowd.agents, i)
    }

    /// The forces on agent `i` in addition to those of the paper.
    pub fn forces(&self, i: usize) -> impl Iterator<Item = &dyn Force> {
        self.fixed.forces(&self.crowd.agents, i)
    }

    /// The change by a current push for agent `i`, if any.
    pub fn change(&self, i: usize) -> Option<&Override> {
        self.fixed.change(&self.crowd.agents, i)
    }

    /// Arrivals, stopped moves, clamped speeds and displaced agents so far.
    pub fn outcome(&self) -> &Outcome {
        &self.crowd.outcome
    }

    /// Whether more agents will enter.
    pub fn expects_agents(&self) -> bool {
        self.crowd.schedule.expects_agents(&self.fixed.scene)
    }

    /// Entries, and beginnings and ends of pushes, so far.
    pub fn events(&self) -> &[Event] {
        self.crowd.schedule.events()
    }

    /// How many agents have begun each journey and passed each place.
    pub fn progress(&self) -> &Progress {
        &self.crowd.progress
    }

    /// The agents that wait for room, entrance by entrance.
    pub fn backlogs(&self) -> impl Iterator<Item = Backlog<'_>> {
        self.crowd.schedule.backlogs(&self.fixed.scene)
    }
}

/// The fields of a frame that has not been evaluated.
static NO_FIELDS: LazyLock<Fields> = LazyLock::new(Fields::default);

impl Derived {
    /// The frame; during its evaluation, with the fields computed so far.
    fn frame<'a>(&'a self, fixed: &'a Fixed, crowd: &'a Crowd) -> Frame<'a> {
        Frame {
            clock: &crowd.clock,
            walls: &fixed.scene.walls,
            agents: &crowd.agents,
            fields: &self.fields,
            neighbors: &self.neighbors,
            packed: &self.packed,
            seed: fixed.scene.behavior_seed.unwrap_or(fixed.scene.seed),
        }
    }
}
