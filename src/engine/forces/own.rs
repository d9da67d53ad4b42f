//! Forces from outside this crate.

use std::fmt::Debug;

use crate::frame::Frame;
use crate::math::Vector;

/// A force on single agents, in addition to those of their profiles: a slope, a moving walkway, a wind. Add it to
/// [`Scene::own_forces`](crate::scene::Scene::own_forces); `examples/own_force.rs` shows one.
///
/// The force acts on all agents in every frame, whatever their profile or push. Checkpoints do not contain it: add it
/// again to the scene with which a run resumes.
pub trait Force: Debug + Send + Sync {
    /// The name in breakdowns.
    fn name(&self) -> &str;

    /// Whether [`acceleration`](Self::acceleration) reads densities or pressures. If so, they are computed in every
    /// frame.
    fn needs_density(&self) -> bool {
        false
    }

    /// The largest rate at which the acceleration pulls an agent back that moves away, 1/s²: K/m of a spring, twice
    /// that of a spring between agents, 0 of a force that does not depend on the place. Automatic time steps are short
    /// enough for it.
    fn stiffness(&self) -> f64;

    /// The largest rate at which the acceleration brakes an agent, 1/s: γ of −γ v, 0 of a force that does not depend on
    /// the velocity. Automatic time steps are short enough for it.
    fn friction(&self) -> f64;

    /// The acceleration of agent `i` of a frozen frame, m/s²: a finite number that depends only on the frame, so
    /// that the results do not depend on the number of threads. [`Frame::near`] lists neighbors within the radii
    /// that the scene's profiles search. Accelerations of the frame are not computed yet.
    fn acceleration(&self, frame: &Frame, i: usize) -> Vector;
}
