//! Time series of the crowd, of entrances and of places.

use rerun::{EntityPath, RecordingStream, Scalars, entity_path};

use super::Snapshot;
use crate::recording::draw::log_series;
use crate::recording::error::Cause;
use crate::series::{self, CROWD, Count};
use analysis::statistics::MeanStd;
use engine::journeys::Place;
use engine::scene::Scene;
use engine::simulation::Simulation;

/// The time series of places: agents in queues and waiting areas, and agents that have passed exits.
pub const PRESENT: &str = "present";
pub const PASSED: &str = "passed";

/// Logs the names and colors of the time series of the crowd.
pub fn log_style(stream: &RecordingStream) -> Result<(), Cause> {
    let mut series = CROWD.into_iter();
    series.try_for_each(|(entity, name, color)| {
        log_series(stream, format!("stats/{entity}"), name, Some(color))
    })
}

/// Logs the names of the time series of agents that wait at entrances, and the names and colors of those of places.
pub fn log_places(stream: &RecordingStream, scene: &Scene) -> Result<(), Cause> {
    for (k, name) in series::waiting(scene).enumerate() {
        log_series(stream, waiting(k), &name, None)?;
    }
    for (number, place, count) in series::of_places(scene) {
        let (name, color) = series::look(scene, number);
        log_series(stream, of_place(place, count), &name, Some(color))?;
    }
    Ok(())
}

/// The entity of the time series of agents that wait at entrance `k`.
fn waiting(k: usize) -> String {
    format!("stats/crowd/waiting/{k}")
}

/// The entity of a time series of a place.
fn of_place(place: &Place, count: Count) -> EntityPath {
    let what = match count {
        Count::Present => PRESENT,
        Count::Passed => PASSED,
    };
    entity_path!["stats", "places", what, place.name.as_str()]
}

/// Whether there are places with time series of the agents that are present.
pub fn has_waiting(scene: &Scene) -> bool {
    series::of_places(scene).any(|(.., count)| count == Count::Present)
}

/// The current values of the time series of places.
pub fn of_places(simulation: &Simulation) -> Vec<(EntityPath, f64)> {
    let places = series::of_places(simulation.scene());
    let entities = places.map(|(_, place, count)| of_place(place, count));
    entities.zip(series::counts(simulation)).collect()
}

/// Logs the values of one frame.
pub fn log(stream: &RecordingStream, snapshot: &Snapshot) -> Result<(), Cause> {
    let squares = || {
        let velocities = snapshot.velocities.iter();
        velocities.map(|&[x, y]| f64::from(x).powi(2) + f64::from(y).powi(2))
    };
    let energies = squares().zip(&snapshot.masses);
    let known = squares().filter(|square| square.is_finite());
    let speeds: Vec<f64> = known.map(f64::sqrt).collect();
    let densities: Vec<f64> = snapshot.densities.iter().copied().map(f64::from).collect();
    let energy = || energies.map(|(v2, &m)| 0.5 * f64::from(m) * v2).sum();
    let values = [
        Some(snapshot.ids.len() as f64),
        snapshot.evacuated.map(|count| count as f64),
        MeanStd::of(&densities).map(|of| of.mean),
        densities.into_iter().reduce(f64::max),
        MeanStd::of(&speeds).map(|of| of.mean),
        snapshot.ms_per_frame.map(|_| energy()),
        snapshot.ms_per_frame,
    ];
    let log = |entity: EntityPath, value| stream.log(entity, &Scalars::single(value));
    for ((entity, ..), value) in CROWD.into_iter().zip(values) {
        if let Some(value) = value {
            log(format!("stats/{entity}").into(), value)?;
        }
    }
    for (k, &count) in snapshot.waiting.iter().enumerate() {
        log(waiting(k).into(), f64::from(count))?;
    }
    for (entity, value) in &snapshot.places {
        log(entity.clone(), *value)?;
    }
    Ok(())
}
