//! Time series and the log of events.

use rerun::{Color, RecordingStream, Scalars, SeriesLines, TextLog, TextLogLevel};

use super::error::RecordingError;
use super::set_time;
use crate::simulation::{Event, EventKind, Simulation};

/// One time series: its entity, the name that the plot shows, and its colour.
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

/// Logs time series and events.
#[derive(Default)]
pub struct Stats {
    started: bool,
    events: usize,
    arrivals: usize,
    evacuated: usize,
}

pub fn log_style(stream: &RecordingStream) -> Result<(), RecordingError> {
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

impl Stats {
    /// Logs the values of the current frame.
    pub fn log(
        &mut self,
        stream: &RecordingStream,
        simulation: &Simulation,
        ms_per_frame: f64,
    ) -> Result<(), RecordingError> {
        let frame = simulation.frame();
        let (agents, density) = (frame.agents, &frame.fields.density);
        self.count_arrivals(simulation);
        let speeds = agents.velocity.iter().map(|v| v.norm());
        let energies = agents.velocity.iter().zip(&agents.mass);
        let kinetic: f64 = energies.map(|(v, m)| 0.5 * m * v.norm_squared()).sum();
        let values = [
            Some(agents.len() as f64),
            Some(self.evacuated as f64),
            mean(density.iter().copied()),
            density.iter().copied().reduce(f64::max),
            mean(speeds),
            Some(kinetic),
            Some(ms_per_frame),
        ];
        for (series, value) in SERIES.iter().zip(values) {
            if let Some(value) = value {
                stream.log(series.entity, &Scalars::single(value))?;
            }
        }
        Ok(())
    }

    /// Logs the events since the last recorded frame, each at its own time.
    pub fn log_events(
        &mut self,
        stream: &RecordingStream,
        simulation: &Simulation,
    ) -> Result<(), RecordingError> {
        let clock = simulation.frame().clock;
        let events = simulation.events();
        for event in &events[self.events..] {
            // What happened before a late start would only stretch the time line.
            if self.started || event.frame == clock.frame() {
                set_time(stream, event.frame, clock.time_at(event.frame));
                stream.log(
                    "log",
                    &TextLog::new(sentence(event)).with_level(level(event)),
                )?;
            }
        }
        self.events = events.len();
        self.started = true;
        Ok(())
    }

    fn count_arrivals(&mut self, simulation: &Simulation) {
        let arrivals = &simulation.outcome().arrivals;
        let new = arrivals[self.arrivals..].iter();
        self.evacuated += new.filter(|arrival| arrival.counted).count();
        self.arrivals = arrivals.len();
    }
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
