//! What agents see of the places of their stage: found for all that are due before the first of them chooses.

use rayon::prelude::*;

use super::Crowd;
use super::choice::Chooser;
use crate::journeys::{Choice, Status, Trip};
use crate::neighbors::BLOCK;
use crate::scene::Scene;
use crate::ways::Leaving;

/// What an agent that is due to choose sees, whatever others choose before.
pub(super) struct Seen {
    /// The number of the stage in its journey.
    pub(super) stage: u16,
    /// The lengths of the ways to its places, meters.
    pub(super) lengths: Vec<f64>,
    /// The ways out of its room that lead to its place, if it compares times.
    pub(super) leaving: Option<Leaving>,
}

impl Crowd {
    /// What agents see that are due to choose.
    pub(super) fn seen_by(&self, scene: &Scene, due: &[usize]) -> Vec<Option<Seen>> {
        let seen = due.par_iter().with_min_len(BLOCK).map(|&agent| {
            let trip = self.agents.trip[agent].as_ref();
            let chooses = |trip: &&Trip| trip.chooses_at <= self.clock.frame();
            let trip = trip
                .filter(|trip| trip.status == Status::Walking)
                .filter(chooses)?;
            let chooser = Chooser {
                scene,
                crowd: self,
                agent,
                is_asked: false,
                seen: None,
            };
            let stage = chooser.stage(trip);
            let lengths = chooser.lengths(self.agents.position[agent], &stage.places);
            let compares = matches!(stage.choice, Choice::Quickest);
            let mut known = stage.places.iter().zip(&lengths).filter(|_| compares);
            let known = known.find(|(place, length)| **place == trip.place && length.is_finite());
            let leaving = known
                .and_then(|(&place, &length)| self.leaving_to(scene, (agent, place, length), None));
            Some(Seen {
                stage: trip.stage,
                lengths,
                leaving,
            })
        });
        seen.collect()
    }
}
