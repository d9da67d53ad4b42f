//! Models of one's own for a whole crowd, in this crate or outside of it: accelerations or velocities of all agents at
//! once.

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use super::own::Force;
use super::rates::{Extremes, Rates};
use crate::frame::Frame;
use crate::math::Vector;

/// A model that gives a vector for every agent. In contrast to a [`Force`], it is asked once per frame, for all agents.
pub trait Model: Any + Debug + Send + Sync {
    /// The name in breakdowns and messages.
    fn name(&self) -> &str;

    /// The distance up to which the model needs other agents ([`Frame::near`]) and walls, meters.
    fn reach(&self) -> f64 {
        0.0
    }

    /// Whether it reads densities or pressures. If so, they are computed in every frame.
    fn needs_density(&self) -> bool {
        false
    }

    /// How its accelerations limit the time step, as for a [`Force`].
    fn rates(&self, of: &Extremes) -> Rates;

    /// The accelerations, m/s², or velocities, m/s, of all agents of a frozen frame, in their order: finite vectors
    /// that depend only on the frame. Accelerations of the frame are not computed yet.
    ///
    /// # Errors
    /// Why there are none, for [`Fault::Model`](crate::simulation::Fault::Model).
    fn vectors(&self, frame: &Frame) -> Result<Vec<Vector>, String>;
}

/// What the vectors of a [`Model`] are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gives {
    /// Accelerations in addition to those of the profiles.
    Accelerations,
    /// Accelerations in place of those of the profiles.
    AllAccelerations,
    /// The velocities that agents want, in place of those toward their goals.
    Velocities,
}

/// A model, what its vectors are, and when it is asked.
#[derive(Debug, Clone)]
pub struct OwnModel {
    /// The model.
    pub model: Arc<dyn Model>,
    /// What its vectors are.
    pub gives: Gives,
    /// Whether it is asked in coarse frames only, and for agents that enter between. The vectors are held until then.
    pub coarse: bool,
}

impl OwnModel {
    /// The force that a scene has for this model; `None` if it gives velocities.
    pub(crate) fn force(&self) -> Option<Arc<dyn Force>> {
        let model = Arc::clone(&self.model);
        (self.gives != Gives::Velocities).then(|| Arc::new(Held { model }) as Arc<dyn Force>)
    }

    /// Whether its accelerations take the place of those of the profiles.
    pub(crate) fn replaces(&self) -> bool {
        self.gives == Gives::AllAccelerations
    }
}

/// The accelerations of a model.
#[derive(Debug)]
struct Held {
    model: Arc<dyn Model>,
}

impl Force for Held {
    fn name(&self) -> &str {
        self.model.name()
    }

    fn reach(&self) -> f64 {
        self.model.reach()
    }

    fn rates(&self, of: &Extremes) -> Rates {
        self.model.rates(of)
    }

    fn acceleration(&self, frame: &Frame, i: usize) -> Vector {
        let own = frame.agents.own.get(i).copied().flatten();
        own.unwrap_or_default()
    }
}
