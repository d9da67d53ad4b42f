//! Records a measurement for the Rerun viewer.

use std::path::Path;

use super::{Behind, Moment, Options, Site};
use analysis::crossing::Line;
use engine::agents::REFERENCE_RADIUS;
use engine::geometry::Walls;
use engine::math::{Vector, bounds};
use engine::scene::Region;
use output::recording::{
    DebugAgents, Marked, MeasuredPerson, MeasuredRecorder, RecordingError, RecordingOptions,
};
use runs::identity::Identity;
use scenario::trajectories::Tracks;

/// With ids larger than this, the recording uses the people's numbers instead.
const LARGEST_ID: i64 = 1 << 22;

/// Farther from the origin than this, meters, the single precision of recordings is coarser than 1 mm: places are then
/// recorded from an origin of their own.
const FAR: f64 = 10_000.0;

/// The densities with the first and the last color, P/m².
const DENSITIES: [f64; 2] = [0.0, 8.0];
/// The speeds with the first and the last color, m/s.
const SPEEDS: [f64; 2] = [0.0, 1.8];

/// The name of the recording in the folder of results.
pub(super) const RECORDING: &str = "measured.rrd";

/// A recording of measured frames.
pub struct MomentRecorder<'a> {
    tracks: &'a Tracks,
    recorder: MeasuredRecorder,
    /// Whether the recording has the ids of the file. Otherwise it numbers people from 0 in the order of their ids.
    pub has_own_ids: bool,
    /// The origin of the recording, meters: places in it are those of the file less this.
    pub origin: Vector,
    /// Number of the next frame.
    next: Option<i64>,
}

impl<'a> MomentRecorder<'a> {
    /// Begins a recording in `folder`, replacing an existing file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(
        folder: &Path,
        (tracks, site): (&'a Tracks, &Site),
        measured: &Options,
    ) -> Result<Self, RecordingError> {
        let [low, high] = bounds(tracks.position.iter().copied()).unwrap_or_default();
        let margin = Vector::repeat(1.0);
        let frames = [tracks.frames.first(), tracks.frames.last()];
        let ends = frames.map(|frame| frame.map_or(0.0, |&frame| tracks.time(frame)));
        let origin = origin([low, high]);
        let title = folder.file_name().unwrap_or_default().to_string_lossy();
        let document = document(tracks, measured) + &on_origin(origin);
        let options = RecordingOptions {
            id: Identity::of("measurement", format!("{title} {document}")).to_string(),
            application: format!("sandbox measure {title}"),
            title: title.into_owned(),
            description: "A crowd that was measured, by its SPH density (§8).".to_owned(),
            document,
            view: Region {
                min: low - margin - origin,
                max: high + margin - origin,
            },
            density_range: DENSITIES,
            speed_range: SPEEDS,
            opens_at: Some(measured.times[0].max(ends[0])),
            begins_at: ends[0],
            ends_at: measured.times[1].min(ends[1]),
            debug: DebugAgents::None,
            body_mass: None,
            measured: Vec::new(),
            labels: Vec::new(),
            entering: 0,
        };
        let path = folder.join(RECORDING);
        let regions = measured.regions.iter().map(|&Region { min, max }| Region {
            min: min - origin,
            max: max - origin,
        });
        let lines = measured.lines.iter().map(|&Line { start, end }| Line {
            start: start - origin,
            end: end - origin,
        });
        let marked = Marked {
            regions: &regions.collect::<Vec<_>>(),
            lines: &lines.collect::<Vec<_>>(),
        };
        let obstacles = site.walls.obstacles().iter().cloned();
        let walls = Walls::new(obstacles.map(|one| one.moved(-origin)).collect());
        let drawn = (&walls, marked);
        Ok(Self {
            tracks,
            recorder: MeasuredRecorder::create(path.as_path(), drawn, REFERENCE_RADIUS, &options)?,
            origin,
            has_own_ids: tracks.ids.iter().all(|id| (0..=LARGEST_ID).contains(id)),
            next: None,
        })
    }

    /// Adds some frames. A gap before a frame is recorded as a single empty frame.
    ///
    /// # Errors
    /// An earlier frame could not be written.
    pub fn add(&mut self, moments: &[Moment]) -> Result<(), RecordingError> {
        for moment in moments {
            if let Some(empty) = self.next.filter(|&next| next < moment.frame) {
                let time = self.tracks.time(empty);
                self.recorder.log(empty, time, std::iter::empty())?;
            }
            let people = moment.people.iter().map(|person| MeasuredPerson {
                id: match self.has_own_ids {
                    true => person.id as u32,
                    false => person.number,
                },
                position: person.position - self.origin,
                velocity: person.velocity,
                density: person.density,
            });
            self.recorder.log(moment.frame, moment.time, people)?;
            self.next = Some(moment.frame + self.tracks.step);
        }
        Ok(())
    }

    /// Closes the file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(self) -> Result<(), RecordingError> {
        self.recorder.finish()
    }
}

/// The origin of a recording of places between these corners: their own if they are far away, to whole 100 m.
fn origin([low, high]: [Vector; 2]) -> Vector {
    match low.amax().max(high.amax()) > FAR {
        true => (low / 100.0).map(f64::floor) * 100.0,
        false => Vector::zeros(),
    }
}

/// What the recording's text says of its origin; nothing without one of its own.
fn on_origin(origin: Vector) -> String {
    match origin == Vector::zeros() {
        true => String::new(),
        false => format!(
            "* Places are those of the file less ({}, {}) m: so far from the origin single precision is too coarse\n",
            origin.x, origin.y
        ),
    }
}

/// A description of the measurement, in Markdown.
fn document(tracks: &Tracks, options: &Options) -> String {
    let behind = match options.behind {
        Behind::Same => "as dense as where the person stands".to_owned(),
        Behind::Rest(max) => format!("at the rest density, {max} P/m² at most"),
    };
    let reach = options.speed_reach as f64 * tracks.interval();
    format!(
        "## Measurement\n\
         * {} persons, {} rows, {} frames per second\n\
         * Colors and time series: SPH density with the own weight of each person (Eq. 9)\n\
         * Kernel radius h = {} m, walls by `{:?}`, the crowd behind them {behind}\n\
         * Velocities from {reach:.2} s before to {reach:.2} s after\n",
        tracks.ids.len(),
        tracks.len(),
        tracks.fps,
        options.kernel.support_radius,
        options.kernel.walls,
    )
}
