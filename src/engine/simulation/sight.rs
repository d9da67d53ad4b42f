//! What agents see of the places of their stage: found for all that are due before the first of them chooses.

use rayon::prelude::*;

use super::Crowd;
use super::choice::Chooser;
use crate::engine::journeys::{Status, Trip};
use crate::engine::neighbors::BLOCK;
use crate::engine::scene::Scene;
use crate::engine::ways::Leaving;

/// What an agent that is due to choose sees, whatever others choose before.
pub(super) struct Sight {
    /// The number of the stage in its journey.
    pub(super) stage: u16,
    /// The lengths of the ways to its places, meters.
    pub(super) lengths: Vec<f64>,
    /// The triangle of the agent, and the ways out of its room.
    pub(super) leaving: Option<(u32, Leaving)>,
}

impl Crowd {
    /// What agents see that are due to choose.
    pub(super) fn sights(&self, scene: &Scene, due: &[usize]) -> Vec<Option<Sight>> {
        let sights = due.par_iter().with_min_len(BLOCK).map(|&agent| {
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
                sight: None,
            };
            let places = &chooser.stage(trip).places;
            let lengths = chooser.lengths(self.agents.position[agent], places);
            let known = places.iter().zip(&lengths);
            let mut known =
                known.filter(|(place, length)| **place == trip.place && length.is_finite());
            let leaving = known
                .next()
                .and_then(|(&place, &length)| self.leaving_to(scene, (agent, place, length), None));
            Some(Sight {
                stage: trip.stage,
                lengths,
                leaving,
            })
        });
        sights.collect()
    }
}
