//! Time series.

use rerun::{Color, RecordingStream, Scalars, SeriesLines};

use super::error::Cause;
use super::snapshot::Snapshot;
use crate::analysis::statistics::MeanStd;
use crate::engine::scene::Scene;

/// The time series: entity, name in the plot, and color.
const SERIES: [(&str, &str, [u8; 3]); 7] = [
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

pub fn log_style(stream: &RecordingStream) -> Result<(), Cause> {
    for (entity, name, [r, g, b]) in SERIES {
        let style = SeriesLines::new()
            .with_names([name])
            .with_colors([Color::from_rgb(r, g, b)])
            .with_widths([1.5]);
        stream.log_static(format!("stats/{entity}"), &style)?;
    }
    Ok(())
}

/// Logs the names of the time series of agents that wait at entrances.
pub fn log_entrances(stream: &RecordingStream, scene: &Scene) -> Result<(), Cause> {
    let names = scene.entrances.iter();
    let names = names
        .map(|entrance| entrance.name.as_str())
        .chain(scene.latecomers_name());
    for (k, name) in names.enumerate() {
        let name = format!("waiting at {name}");
        let style = SeriesLines::new().with_names([name]).with_widths([1.5]);
        stream.log_static(waiting(k), &style)?;
    }
    Ok(())
}

/// The entity of the time series of agents that wait at entrance `k`.
fn waiting(k: usize) -> String {
    format!("stats/crowd/waiting/{k}")
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
    let values = [
        Some(snapshot.ids.len() as f64),
        snapshot.evacuated.map(|count| count as f64),
        MeanStd::of(&densities).map(|of| of.mean),
        densities.into_iter().reduce(f64::max),
        MeanStd::of(&speeds).map(|of| of.mean),
        snapshot
            .ms_per_frame
            .map(|_| energies.map(|(v2, &m)| 0.5 * f64::from(m) * v2).sum()),
        snapshot.ms_per_frame,
    ];
    for ((entity, ..), value) in SERIES.into_iter().zip(values) {
        if let Some(value) = value {
            stream.log(format!("stats/{entity}"), &Scalars::single(value))?;
        }
    }
    for (k, &count) in snapshot.waiting.iter().enumerate() {
        stream.log(waiting(k), &Scalars::single(f64::from(count)))?;
    }
    for (entity, value) in &snapshot.places {
        stream.log(entity.clone(), &Scalars::single(*value))?;
    }
    Ok(())
}
