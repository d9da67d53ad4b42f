//! Time series and the log of events.

use rerun::{Color, RecordingStream, Scalars, SeriesLines, TextLog, TextLogLevel};

use super::error::Cause;
use super::set_time;
use super::snapshot::Snapshot;
use crate::engine::simulation::{Event, EventKind};

/// A time series: its entity, its name in the plot, and its color.
struct Series {
    entity: &'static str,
    name: &'static str,
    color: [u8; 3],
}

const SERIES: [Series; 7] = [
    series("stats/crowd/agents", "agents", [86, 180, 233]),
    series("stats/crowd/evacuated", "evacuated", [95, 211, 120]),
    series("stats/density/mean", "mean density [P/m²]", [230, 159, 0]),
    series("stats/density/max", "maximum density [P/m²]", [213, 94, 0]),
    series("stats/speed/mean", "mean speed [m/s]", [204, 121, 167]),
    series(
        "stats/energy/kinetic",
        "kinetic energy ½ m v² [m²/s², m = 1 for an average person]",
        [240, 228, 66],
    ),
    series(
        "stats/time/per_frame",
        "time per frame [ms]",
        [150, 150, 160],
    ),
];

const fn series(entity: &'static str, name: &'static str, color: [u8; 3]) -> Series {
    Series {
        entity,
        name,
        color,
    }
}

pub fn log_style(stream: &RecordingStream) -> Result<(), Cause> {
    for Series {
        entity,
        name,
        color: [r, g, b],
    } in SERIES
    {
        let style = SeriesLines::new()
            .with_names([name])
            .with_colors([Color::from_rgb(r, g, b)])
            .with_widths([1.5]);
        stream.log_static(entity, &style)?;
    }
    Ok(())
}

/// Logs the values of one frame.
pub fn log(stream: &RecordingStream, snapshot: &Snapshot) -> Result<(), Cause> {
    let squares = || {
        let velocities = snapshot.velocities.iter();
        velocities.map(|&[x, y]| f64::from(x).powi(2) + f64::from(y).powi(2))
    };
    let energies = squares().zip(&snapshot.masses);
    let known: Vec<f64> = squares().filter(|square| square.is_finite()).collect();
    let densities = snapshot.densities.iter().map(|&density| f64::from(density));
    let values = [
        Some(snapshot.ids.len() as f64),
        snapshot.evacuated.map(|count| count as f64),
        mean(densities.clone()),
        densities.reduce(f64::max),
        mean(known.into_iter().map(f64::sqrt)),
        snapshot
            .ms_per_frame
            .map(|_| energies.map(|(v2, &m)| 0.5 * f64::from(m) * v2).sum()),
        snapshot.ms_per_frame,
    ];
    for (series, value) in SERIES.iter().zip(values) {
        if let Some(value) = value {
            stream.log(series.entity, &Scalars::single(value))?;
        }
    }
    Ok(())
}

/// Logs events, each at its own time.
pub fn log_events(stream: &RecordingStream, events: &[(f64, Event)]) -> Result<(), Cause> {
    for (time, event) in events {
        set_time(stream, event.frame.cast_signed(), *time);
        stream.log(
            "log",
            &TextLog::new(sentence(event)).with_level(level(event)),
        )?;
    }
    Ok(())
}

/// Marks the current time in the log of events; a click on the mark goes there.
pub fn log_bookmark(stream: &RecordingStream) -> Result<(), Cause> {
    let bookmark = TextLog::new("Look here first.").with_level(TextLogLevel::INFO);
    Ok(stream.log("log", &bookmark)?)
}

fn sentence(event: &Event) -> String {
    let name = &event.name;
    match event.kind {
        EventKind::Entered(count) => format!("{name}: {count} agents enter"),
        EventKind::PushBegan(count) => format!("{name}: {count} agents begin to push"),
        EventKind::PushEnded => format!("{name}: the push is over"),
    }
}

fn level(event: &Event) -> &'static str {
    match event.kind {
        EventKind::Entered(_) => TextLogLevel::INFO,
        EventKind::PushBegan(_) | EventKind::PushEnded => TextLogLevel::WARN,
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> Option<f64> {
    let count = values.len();
    (count > 0).then(|| values.sum::<f64>() / count as f64)
}
