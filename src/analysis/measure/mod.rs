//! The SPH density of §8 and what follows from it, measured in trajectories, real or simulated: density and
//! velocity of everybody, mean fields, fundamental diagrams, flow over lines.
//!
//! A person's density is Eq. 9, its own mass included. What walls hide of the kernel counts as a crowd that
//! is as dense as where the person stands, or as in the engine ([`Behind`]); fields are of the first kind.
//! Velocities are those of [`speed::velocities`], crossings those of [`Crossings`]. Time is frame over frame
//! rate.

mod density;
mod diagram;
mod fields;
mod line;
mod output;
pub mod pictures;
mod record;
mod report;
mod site;
pub mod speed;

pub use density::{Behind, MOST_HIDDEN, Parts, parts};
pub use diagram::{CLASS, Class, Diagram, FrameMean, Spread};
pub use fields::{Fields, Grid, MOST_CELLS, Mean};
pub use line::{Crossing, Crossings, Line};
pub use output::{OutputError, Results};
pub use record::MomentRecorder;
pub use report::Report;
pub use site::{Hidden, Kernel, Site};

use rayon::prelude::*;

use crate::engine::math::Vector;
use crate::engine::scene::Region;
use crate::output::trajectory::read::Tracks;
use density::History;

/// Rows that are measured at a time.
const BATCH: usize = 1 << 16;

/// What is measured, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The kernel.
    pub kernel: Kernel,
    /// How dense the crowd is behind walls.
    pub behind: Behind,
    /// Recorded frames that a velocity looks back and ahead, at least 1.
    pub speed_reach: i64,
    /// From when to when, seconds, both included.
    pub times: [f64; 2],
    /// Side of the cells of mean fields, metres.
    pub cell: f64,
    /// Where fundamental diagrams are taken; none: everywhere.
    pub regions: Vec<Region>,
    /// The lines over which flow is measured.
    pub lines: Vec<Line>,
}

/// Somebody in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Person {
    /// The person's place among all ids, from 0.
    pub number: u32,
    /// As in the file.
    pub id: i64,
    /// Metres.
    pub position: Vector,
    /// Where the person is seen, metres: at the face of an obstacle that the person leans over.
    pub eye: Vector,
    /// 1 = an average person.
    pub mass: f64,
    /// m/s; `None` where it is not known.
    pub velocity: Option<Vector>,
    /// ρ_i, P/m².
    pub density: f64,
    /// The walls' part of it, P/m².
    pub density_from_walls: f64,
}

/// A frame with somebody in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// The frame.
    pub frame: i64,
    /// Seconds.
    pub time: f64,
    /// Everybody there, by id.
    pub people: Vec<Person>,
}

/// Who was where it was densest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Densest {
    /// The person and the density.
    pub person: Person,
    /// The frame.
    pub frame: i64,
    /// When, seconds.
    pub time: f64,
}

/// What there was, in a few numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overview {
    /// Frames from the first to the last measured, those without anybody too.
    pub frames: u64,
    /// Those without anybody.
    pub empty_frames: u64,
    /// Rows: persons in frames.
    pub rows: u64,
    /// Different persons.
    pub people: u64,
    /// Times of the first and the last frame with somebody in it, seconds.
    pub times: [f64; 2],
    /// Over all rows, P/m².
    pub density: Spread,
    /// Over all rows whose velocity is known, m/s.
    pub speed: Spread,
    /// Where it was densest.
    pub densest: Option<Densest>,
    /// Rows of people inside an obstacle, and how far the deepest was, metres.
    pub inside: (u64, f64),
    /// Rows of which more than [`MOST_HIDDEN`] of the kernel was hidden.
    pub crammed: u64,
}

/// Everything that was measured, but for the rows, which were handed on.
pub struct Measured {
    /// In a few numbers.
    pub overview: Overview,
    /// The sums over all frames.
    pub fields: Fields,
    /// One for each region.
    pub diagrams: Vec<Diagram>,
    /// One for each line.
    pub crossings: Vec<Crossings>,
}

/// Nothing can be measured.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeasureError {
    /// No frame is in the time asked for.
    #[error("nobody is there from {0} s to {1} s; there is somebody from {2} s to {3} s")]
    Nobody(f64, f64, f64, f64),
    /// Too many cells.
    #[error("fields would have more than {MOST_CELLS} cells of {0} m; give a larger --cell")]
    Cells(f64),
}

/// Measures everything, and hands on frame after frame, some at a time, with the number of rows until then.
///
/// # Errors
/// There is nothing to measure, or what `take` says.
pub fn measure<E: From<MeasureError>>(
    tracks: &Tracks,
    site: &Site,
    options: &Options,
    mut take: impl FnMut(&[Moment]) -> Result<(), E>,
) -> Result<Measured, E> {
    let chosen = chosen(tracks, options)?;
    let velocities = speed::velocities(tracks, options.speed_reach);
    let mut fields = Fields::new(grid(tracks, options, chosen.clone())?, site, options.kernel);
    let regions: Vec<Option<Region>> = match options.regions.as_slice() {
        [] => vec![None],
        regions => regions.iter().copied().map(Some).collect(),
    };
    let mut diagrams: Vec<Diagram> = regions.into_iter().map(Diagram::new).collect();
    let mut history = History::new(options.behind, tracks.ids.len());
    let mut overview = overview(tracks, chosen.clone());
    let mut seen = vec![false; tracks.ids.len()];
    let mut next = chosen.start;
    while next < chosen.end {
        let begin = next;
        let first = tracks.rows(begin).start;
        while next < chosen.end && (next == begin || tracks.rows(next).end - first < BATCH) {
            next += 1;
        }
        let frames = (begin..next).into_par_iter();
        let parts: Vec<Vec<Parts>> = frames
            .map(|k| {
                let rows = tracks.rows(k);
                let masses = tracks.mass.get(rows.clone()).unwrap_or(&[]);
                let how = (&options.kernel, options.behind);
                parts(site, &tracks.position[rows], masses, how)
            })
            .collect();
        let frames = (begin..next).zip(parts);
        let moments: Vec<Moment> = frames
            .map(|(k, parts)| {
                overview.look_at(&parts);
                moment(tracks, k, &parts, &velocities, &mut history)
            })
            .collect();
        for moment in &moments {
            overview.add(moment);
            moment
                .people
                .iter()
                .for_each(|person| seen[person.number as usize] = true);
            for (number, diagram) in diagrams.iter_mut().enumerate() {
                diagram.add(number + 1, moment);
            }
        }
        let people: Vec<&Person> = moments.iter().flat_map(|moment| &moment.people).collect();
        fields.add(&people, site);
        take(&moments)?;
    }
    overview.people = seen.into_iter().filter(|&seen| seen).count() as u64;
    let lines = options.lines.par_iter().enumerate();
    let crossings = lines.map(|(k, &line)| Crossings::of(tracks, k + 1, line, options.times));
    Ok(Measured {
        overview,
        fields,
        diagrams,
        crossings: crossings.collect(),
    })
}

/// Is there something to measure?
///
/// # Errors
/// Nobody is there in the time asked for, or there are too many cells.
pub fn check(tracks: &Tracks, options: &Options) -> Result<(), MeasureError> {
    let chosen = chosen(tracks, options)?;
    grid(tracks, options, chosen).map(|_| ())
}

/// The frames in the time asked for.
fn chosen(tracks: &Tracks, options: &Options) -> Result<std::ops::Range<usize>, MeasureError> {
    let [from, until] = options.times;
    let begin = tracks
        .frames
        .partition_point(|&frame| tracks.time(frame) < from);
    let end = tracks
        .frames
        .partition_point(|&frame| tracks.time(frame) <= until);
    if begin >= end {
        let [first, last] = [tracks.frames.first(), tracks.frames.last()]
            .map(|frame| frame.map_or(0.0, |&frame| tracks.time(frame)));
        return Err(MeasureError::Nobody(from, until, first, last));
    }
    Ok(begin..end)
}

/// Cells over everybody's kernels.
fn grid(
    tracks: &Tracks,
    options: &Options,
    chosen: std::ops::Range<usize>,
) -> Result<Grid, MeasureError> {
    let rows = tracks.rows(chosen.start).start..tracks.rows(chosen.end - 1).end;
    let positions = &tracks.position[rows];
    let first = [positions[0]; 2];
    let [low, high] = positions
        .iter()
        .fold(first, |[low, high], p| [low.inf(p), high.sup(p)]);
    let margin = Vector::repeat(options.kernel.support_radius);
    Grid::over(low - margin, high + margin, options.cell).ok_or(MeasureError::Cells(options.cell))
}

fn overview(tracks: &Tracks, chosen: std::ops::Range<usize>) -> Overview {
    let [first, last] = [chosen.start, chosen.end - 1].map(|k| tracks.frames[k]);
    let frames = ((last - first) / tracks.step) as u64 + 1;
    Overview {
        frames,
        empty_frames: frames.saturating_sub(chosen.len() as u64),
        times: [first, last].map(|frame| tracks.time(frame)),
        ..Overview::default()
    }
}

fn moment(
    tracks: &Tracks,
    k: usize,
    parts: &[Parts],
    velocities: &[Option<Vector>],
    history: &mut History,
) -> Moment {
    let frame = tracks.frames[k];
    let pace = (tracks.step, tracks.interval());
    let people = tracks.rows(k).zip(parts).map(|(row, parts)| {
        let number = tracks.person[row];
        let from_walls = history.walls_part((number as usize, frame), parts, pace);
        Person {
            number,
            id: tracks.ids[number as usize],
            position: tracks.position[row],
            eye: parts.hidden.eye,
            mass: tracks.mass_of(row),
            velocity: velocities[row],
            density: parts.from_people + from_walls,
            density_from_walls: from_walls,
        }
    });
    Moment {
        frame,
        time: tracks.time(frame),
        people: people.collect(),
    }
}

impl Overview {
    fn look_at(&mut self, parts: &[Parts]) {
        for part in parts {
            self.crammed += u64::from(part.hidden.share > MOST_HIDDEN);
            if let Some(depth) = part.hidden.inside {
                self.inside = (self.inside.0 + 1, self.inside.1.max(depth));
            }
        }
    }

    fn add(&mut self, moment: &Moment) {
        for person in &moment.people {
            self.rows += 1;
            self.density.add(person.density);
            if let Some(velocity) = person.velocity {
                self.speed.add(velocity.norm());
            }
            let before = self.densest.map_or(0.0, |densest| densest.person.density);
            if person.density > before {
                self.densest = Some(Densest {
                    person: *person,
                    frame: moment.frame,
                    time: moment.time,
                });
            }
        }
    }
}
