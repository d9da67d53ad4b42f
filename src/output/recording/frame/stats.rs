//! Time series of the crowd, of entrances and of places.

use rerun::{EntityPath, RecordingStream, Scalars, entity_path};

use super::Snapshot;
use crate::analysis::statistics::MeanStd;
use crate::engine::journeys::{Kind, Place, Status};
use crate::engine::scene::Scene;
use crate::engine::simulation::Simulation;
use crate::output::colors::Rgb;
use crate::output::recording::draw::log_series;
use crate::output::recording::error::Cause;
use crate::output::scenery;

/// The time series of places: agents in queues and waiting areas, and agents that have passed exits.
pub const PRESENT: &str = "present";
pub const PASSED: &str = "passed";

/// The time series of the crowd: entity, name in the plot, and color.
const SERIES: [(&str, &str, Rgb); 7] = [
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

/// Logs the names and colors of the time series of the crowd.
pub fn log_style(stream: &RecordingStream) -> Result<(), Cause> {
    let mut series = SERIES.into_iter();
    series.try_for_each(|(entity, name, color)| {
        log_series(stream, format!("stats/{entity}"), name, Some(color))
    })
}

/// Logs the names of the time series of agents that wait at entrances, and the names and colors of those of places.
pub fn log_places(stream: &RecordingStream, scene: &Scene) -> Result<(), Cause> {
    let names = scene.entrances.iter().map(|one| one.name.as_str());
    for (k, name) in names.chain(scene.latecomers_name()).enumerate() {
        log_series(stream, waiting(k), &format!("waiting at {name}"), None)?;
    }
    let palette = scenery::STAGES.iter().cycle();
    for (place, (_, other)) in scene.journeys.places.iter().zip(palette) {
        let Some(what) = series_of(&place.kind) else {
            continue;
        };
        // The color of the place, or different colors for several places of a kind.
        let color = match scenery::alike(scene, place) {
            1 => scenery::color(&place.kind),
            _ => *other,
        };
        let name = format!("{} {}", place.kind.name(), place.name);
        log_series(stream, of_place(what, &place.name), &name, Some(color))?;
    }
    Ok(())
}

/// The entity of the time series of agents that wait at entrance `k`.
fn waiting(k: usize) -> String {
    format!("stats/crowd/waiting/{k}")
}

/// The entity of a time series of a place.
fn of_place(what: &str, name: &str) -> EntityPath {
    entity_path!["stats", "places", what, name]
}

fn series_of(kind: &Kind) -> Option<&'static str> {
    match kind {
        Kind::Exit(_) => Some(PASSED),
        Kind::Queue(_) | Kind::Waiting(_) => Some(PRESENT),
        Kind::Line(_) | Kind::Disk { .. } => None,
    }
}

/// Whether there are places with time series of the agents that are present.
pub fn has_waiting(scene: &Scene) -> bool {
    let mut places = scene.journeys.places.iter();
    places.any(|place| series_of(&place.kind) == Some(PRESENT))
}

/// The current values of the time series of places.
pub fn of_places(simulation: &Simulation) -> Vec<(EntityPath, f64)> {
    let places = &simulation.scene().journeys.places;
    let mut present = vec![0_u32; places.len()];
    for trip in simulation.frame().agents.trip.iter().flatten() {
        if matches!(trip.status, Status::Waiting { .. } | Status::Queued { .. }) {
            present[usize::from(trip.place)] += 1;
        }
    }
    let states = &simulation.progress().places;
    let value = |(k, place): (usize, &Place)| {
        let what = series_of(&place.kind)?;
        let count = match what {
            PASSED => states.get(k).map_or(0, |state| state.passed),
            _ => present[k],
        };
        Some((of_place(what, &place.name), f64::from(count)))
    };
    places.iter().enumerate().filter_map(value).collect()
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
    let densities = snapshot.densities.iter().copied().map(f64::from);
    let densities: Vec<f64> = densities.collect();
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
    for ((entity, ..), value) in SERIES.into_iter().zip(values) {
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
