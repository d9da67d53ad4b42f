//! Interventions: changes of a crowd or its scene at the beginning of a frame, planned or from outside.

use serde::{Deserialize, Serialize};

use super::{Push, Scene};
use crate::agents::NewAgent;
use crate::forces::push::PushForce;
use crate::journeys::{ChangeKind, Kind};
use crate::math::Vector;
use std::sync::Arc;

/// A change at the beginning of a frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Intervention {
    /// The frame.
    pub frame: u64,
    /// What is done.
    pub action: Action,
}

/// What an intervention does. Agents are given by id; those that have left are skipped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Action {
    /// Agents enter, in this order; those without room between bodies and walls do not.
    Add(Vec<NewAgent>),
    /// Agents are taken out. They do not count as arrived.
    Remove(Vec<u32>),
    /// Agents walk to new goals, meters. They abandon their journeys.
    Goals(Vec<(u32, Vector)>),
    /// Agents begin a journey, from its first stage on.
    Journey {
        /// Their ids.
        agents: Vec<u32>,
        /// The number of the journey.
        journey: u16,
    },
    /// Agents get a preferred speed, m/s, and the s_max that belongs to it.
    Speeds(Vec<(u32, f64)>),
    /// A push begins, with a force if there is one. The times of both, and the index in the force, are set when it
    /// begins.
    Push(Push, Option<PushForce>),
    /// An exit or a door opens or closes, or a waiting area is released.
    Place {
        /// The number of the place.
        place: u16,
        /// The change.
        change: ChangeKind,
    },
    /// An entrance opens, or closes: people who arrive wait before it.
    Entrance {
        /// The number of the entrance.
        entrance: u16,
        /// Whether it is open from now on.
        open: bool,
    },
    /// From now on, people arrive at an entrance at this rate: at equal intervals if they did before, else at random.
    Rate {
        /// The number of the entrance.
        entrance: u16,
        /// People per second, from 0 on.
        per_sec: f64,
    },
    /// The limit of an exit changes.
    Capacity {
        /// The number of the exit among the places.
        exit: u16,
        /// The most agents that pass it per second; `None`: no limit.
        most_per_sec: Option<f64>,
    },
    /// The speed in a zone changes.
    Zone {
        /// The number of the zone.
        zone: u16,
        /// Preferred speeds are multiplied by this.
        speed_factor: f64,
    },
}

impl Scene {
    /// Makes the change of an action to the scene, at `time` seconds, if it is one: the limit of an exit, the speed in
    /// a zone, or another push.
    pub(crate) fn edit(&mut self, action: &Action, time: f64) {
        match action {
            Action::Capacity { exit, most_per_sec } => {
                let place = &mut self.journeys.places[usize::from(*exit)];
                if let Kind::Exit(exit) = &mut place.kind {
                    exit.most_per_sec = *most_per_sec;
                }
            }
            Action::Zone { zone, speed_factor } => {
                self.journeys.zones[usize::from(*zone)].speed_factor = *speed_factor;
            }
            Action::Push(push, force) => {
                let index = self.pushes.len() as u16; // `Simulation::intervene` checks it
                self.pushes.push(Push {
                    at: time,
                    ..push.clone()
                });
                if let Some(force) = force {
                    self.own_forces.push(Arc::new(PushForce {
                        push: index,
                        at: time,
                        ..force.clone()
                    }));
                }
            }
            _ => {}
        }
    }

    /// Whether [`edit`](Self::edit) changes anything.
    pub(crate) fn is_edited_by(action: &Action) -> bool {
        matches!(
            action,
            Action::Capacity { .. } | Action::Zone { .. } | Action::Push(..)
        )
    }
}
