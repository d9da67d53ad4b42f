//! The trait of forces in addition to those of the paper, in this crate or outside of it.

use std::any::Any;
use std::fmt::Debug;
use std::ops::Range;

use crate::agents::{Agents, States};
use crate::clock::Integrator;
use crate::forces::rates::{Extremes, Rates};
use crate::frame::Frame;
use crate::geometry::Walls;
use crate::math::Vector;
use crate::period::Axis;

/// A force on agents, in addition to those of the paper: a slope, a moving walkway, a wind, legs under bodies.
///
/// As a part of [`Profile::forces`](crate::profile::Profile::forces) it acts on the agents of the profile, in a blend
/// with the profile's weight. In [`Scene::own_forces`](crate::scene::Scene::own_forces) it acts on all agents, whatever
/// their profile or push; `examples/own_force.rs` shows one. `forces/legs.rs` is one with a state.
///
/// A force may keep a state for each agent: the numbers that [`kept`](Self::kept) names. The engine sorts, saves and
/// resumes them with the agents; they are part of the digest, of trajectories and of breakdowns. Checkpoints do not
/// contain the force itself: a run resumes with a scene that has it.
pub trait Force: Any + Debug + Send + Sync {
    /// The name in breakdowns and of its state. Forces of one scene that keep a state of the same name share it.
    fn name(&self) -> &str;

    /// The distance up to which the force needs other agents ([`Frame::near`]) and walls, meters.
    fn reach(&self) -> f64 {
        0.0
    }

    /// Whether the force reads densities or pressures. If so, they are computed in every frame.
    fn needs_density(&self) -> bool {
        false
    }

    /// How the force limits the time step, so that automatic steps are short enough for it. A spring on single agents
    /// with K N/m has [`Rates::everywhere`] K/m, one between agents twice that; a friction −γ v has [`Rates::friction`]
    /// γ. All rates of a force that depends neither on the place nor on the velocity are 0.
    fn rates(&self, of: &Extremes) -> Rates;

    /// The acceleration of agent `i` of a frozen frame, m/s²: a finite number that depends only on the frame, so
    /// that the results do not depend on the number of threads. Accelerations of the frame are not computed yet.
    fn acceleration(&self, frame: &Frame, i: usize) -> Vector;

    /// Adds the accelerations of `agents`, all of one block of [`BLOCK`](crate::neighbors::BLOCK), times `weight` to
    /// `out`, which begins with the first of them. The default takes them one by one; a force between agents can sum
    /// for several at once.
    fn add_accelerations(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        weight: f64,
        out: &mut [Vector],
    ) {
        for (i, out) in agents.zip(out) {
            *out += self.acceleration(frame, i) * weight;
        }
    }

    /// The names of the parts of the acceleration.
    fn term_names(&self) -> Vec<&str> {
        vec![self.name()]
    }

    /// These parts, in breakdowns and recordings, m/s². Their sum is the acceleration.
    fn terms(&self, frame: &Frame, i: usize) -> Vec<Vector> {
        vec![self.acceleration(frame, i)]
    }

    /// The numbers that the force keeps for each agent; none by default.
    fn kept(&self) -> &[Kept] {
        &[]
    }

    /// Sets the state of agent `i`, which has entered, at `time`, seconds. The first number must not be NaN.
    fn begin(&self, agents: &Agents, i: usize, time: f64, state: &mut [f64]) {
        let _ = (agents, i, time);
        state.fill(0.0);
    }

    /// The rates of change of the state of agent `i` of a frozen frame, per second: finite numbers that depend only on
    /// the frame.
    fn change(&self, frame: &Frame, i: usize, state: &[f64], rates: &mut [f64]) {
        let _ = (frame, i, state);
        rates.fill(0.0);
    }

    /// The rates of change of `agents`, all of one block, in `rates`, which begins with the first of them. The default
    /// takes them one by one by [`change`](Self::change).
    fn changes(&self, frame: &Frame, agents: Range<usize>, states: &States, rates: &mut [f64]) {
        for (i, rates) in agents.zip(rates.chunks_mut(states.width())) {
            if let Some(state) = states.of(i) {
                self.change(frame, i, state, rates);
            }
        }
    }

    /// Moves a state on by one step with the rates of the frozen frame. The default adds the rates times the step.
    fn advance(&self, step: &Step, rates: &[f64], state: &mut [f64]) {
        for (value, rate) in state.iter_mut().zip(rates) {
            *value += rate * step.time;
        }
    }

    /// Fits a state to the agent's body, after a step and when the agent was moved back before a closed line.
    fn fit(&self, body: &Body, state: &mut [f64]) {
        let _ = (body, state);
    }

    /// The columns that the force adds to trajectories and breakdowns: its state, by default.
    fn shown(&self) -> &[Kept] {
        self.kept()
    }

    /// The values of [`shown`](Self::shown) for an agent with the body and state given.
    fn values(&self, position: Vector, state: &[f64]) -> Vec<f64> {
        let _ = position;
        state.to_vec()
    }

    /// Further vectors that explain the force on agent `i`, with their names, for breakdowns: none by default.
    fn explained(&self, frame: &Frame, i: usize) -> Vec<(&str, Vector)> {
        let _ = (frame, i);
        Vec::new()
    }

    /// Whether this force is equal to another one. By default it equals itself only. All profiles of a blend must have
    /// equal forces if these keep a state.
    fn equals(&self, other: &dyn Force) -> bool {
        std::ptr::addr_eq(std::ptr::from_ref(self), std::ptr::from_ref(other))
    }
}

impl PartialEq for dyn Force {
    fn eq(&self, other: &Self) -> bool {
        self.equals(other)
    }
}

/// A number that a force keeps for each agent, or shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kept {
    /// Its name in trajectories and breakdowns.
    pub name: &'static str,
    /// Its meaning, with the unit.
    pub about: &'static str,
    /// If it is a coordinate, that along this axis: it changes by a period when its agent passes the end of a periodic
    /// scene.
    pub along: Option<Axis>,
}

/// A step of an agent's state.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    /// Its length, seconds.
    pub time: f64,
    /// The scheme of the scene. In the second half of [`Integrator::Midpoint`] the rates are those of the midpoint, and
    /// the state is that of the beginning.
    pub integrator: Integrator,
    /// s_max of the agent, m/s.
    pub max_speed: f64,
    /// Its body after the move.
    pub body: Body<'a>,
}

/// The body of an agent to which a force fits its state.
#[derive(Debug, Clone, Copy)]
pub struct Body<'a> {
    /// r_i, meters.
    pub position: Vector,
    /// v_i, m/s.
    pub velocity: Vector,
    /// All walls.
    pub walls: &'a Walls,
    /// The indices of the walls that may be near.
    pub near_walls: &'a [u32],
}
