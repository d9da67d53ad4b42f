//! The time series of a run: of its crowd, and of its entrances and places.

use crate::scenery;
use engine::journeys::{Kind, Place, Status};
use engine::scene::Scene;
use engine::simulation::Simulation;
use figures::colors::Rgb;

/// The time series of the crowd: key, name and color.
pub const CROWD: [(&str, &str, Rgb); 7] = [
    ("crowd/agents", "agents", [86, 180, 233]),
    ("crowd/evacuated", "evacuated", [95, 211, 120]),
    ("density/mean", "mean density [P/m²]", [230, 159, 0]),
    ("density/max", "maximum density [P/m²]", [213, 94, 0]),
    ("speed/mean", "mean speed [m/s]", [204, 121, 167]),
    (
        "energy/kinetic",
        "kinetic energy ½ m v² [m²/s², m = 1 for an average person]",
        [240, 228, 66],
    ),
    ("time/per_frame", "time per frame [ms]", [150, 150, 160]),
];

/// What a time series of a place counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Count {
    /// Agents in a queue or waiting area.
    Present,
    /// Agents that have passed an exit.
    Passed,
}

fn count_of(place: &Place) -> Option<Count> {
    match &place.kind {
        Kind::Exit(_) | Kind::Door(_) => Some(Count::Passed),
        Kind::Queue(_) | Kind::Waiting(_) => Some(Count::Present),
        Kind::Line(_) | Kind::Disk { .. } => None,
    }
}

/// The places that have a time series: each with its number and with what the series counts.
pub fn of_places(scene: &Scene) -> impl Iterator<Item = (usize, &Place, Count)> {
    let places = scene.journeys.places.iter().enumerate();
    places.filter_map(|(number, place)| Some((number, place, count_of(place)?)))
}

/// The name and the color of the time series of place `number`.
pub fn look(scene: &Scene, number: usize) -> (String, Rgb) {
    let place = &scene.journeys.places[number];
    // The color of the place, or different colors for several places of a kind.
    let color = match scenery::alike(scene, place) {
        1 => scenery::color(&place.kind),
        _ => scenery::STAGES[number % scenery::STAGES.len()].1,
    };
    (format!("{} {}", place.kind.name(), place.name), color)
}

/// The current values of the time series of places, in their order.
pub fn counts(simulation: &Simulation) -> Vec<f64> {
    let mut present = vec![0_u32; simulation.scene().journeys.places.len()];
    for trip in simulation.frame().agents.trip.iter().flatten() {
        if matches!(trip.status, Status::Waiting { .. } | Status::Queued { .. }) {
            present[usize::from(trip.place)] += 1;
        }
    }
    let states = &simulation.progress().places;
    let value = |(k, _, count): (usize, &Place, Count)| match count {
        Count::Passed => states.get(k).map_or(0, |state| state.passed),
        Count::Present => present[k],
    };
    let values = of_places(simulation.scene()).map(value);
    values.map(f64::from).collect()
}

/// The names of the entrances, and of the group of scheduled agents, where agents may wait for room.
pub fn waiting(scene: &Scene) -> impl Iterator<Item = String> {
    let doors = scene.entrances.iter().map(|one| one.name.as_str());
    let names = doors.chain(scene.latecomers_name());
    names.map(|name| format!("waiting at {name}"))
}
