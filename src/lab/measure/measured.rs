//! A measurement, frame by frame.

use std::ops::Range;

use rayon::prelude::*;

use super::density::{History, Parts, parts};
use super::diagram::Diagram;
use super::fields::{Fields, cells_over};
use super::line::{self, Crossings};
use super::moment::Moment;
use super::options::{MeasureError, Options};
use super::person::Person;
use super::regions::{RegionState, Regions};
use super::safety::{Departures, Safety};
use super::speed;
use analysis::site::Site;
use analysis::statistics::MeanStd;
use analysis::surroundings::MOST_HIDDEN;
use analysis::way_field::Grid;
use engine::math::{Vector, bounds};
use scenario::trajectories::Tracks;

/// Rows measured at a time, unless a single frame has more.
const BATCH: usize = 1 << 16;

/// Summary of a measurement.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overview {
    /// Number of frames from the first to the last measured, including empty ones.
    pub frames: u64,
    /// Number of frames without people.
    pub empty_frames: u64,
    /// Number of rows: one per person and frame.
    pub rows: u64,
    /// Number of different people.
    pub people: u64,
    /// Times of the first and the last frame with people, seconds.
    pub times: [f64; 2],
    /// Over all rows, P/m².
    pub density: MeanStd,
    /// The same without the own weight, P/m².
    pub density_of_others: MeanStd,
    /// Over all rows with a Voronoi cell, P/m².
    pub voronoi: MeanStd,
    /// Over all rows with a known velocity, m/s.
    pub speed: MeanStd,
    /// The person with the highest density; the frame and its time, seconds.
    pub densest: Option<(Person, i64, f64)>,
    /// Number of rows inside an obstacle, and the greatest depth, meters.
    pub inside: (u64, f64),
    /// Number of rows with more than [`MOST_HIDDEN`] of the kernel hidden.
    pub crammed: u64,
}

/// All results except the rows, which [`measure`] passes on.
pub struct Measured {
    /// The summary.
    pub overview: Overview,
    /// The sums over all frames.
    pub fields: Fields,
    /// One per region.
    pub diagrams: Vec<Diagram>,
    /// One per line.
    pub crossings: Vec<Crossings>,
    /// Exposure, alarms, level of service, crowd pressure.
    pub safety: Safety,
    /// The times at which people had left.
    pub departures: Departures,
}

/// Measures everything, and passes the frames to `take` in batches. Frames have all people, whose rows may be in frames
/// of their own; crossings are those between rows.
///
/// # Errors
/// There is nothing to measure, or `take` fails.
pub fn measure<E: From<MeasureError>>(
    own: &Tracks,
    site: &Site,
    options: &Options,
    mut take: impl FnMut(&[Moment]) -> Result<(), E>,
) -> Result<Measured, E> {
    let tracks = &*own.together();
    let chosen = chosen(tracks, options)?;
    let mut fields = Fields::new(grid(tracks, options, chosen.clone())?, site, options.kernel);
    let rows = Rows {
        tracks,
        site,
        options,
        places: Regions::new(site, options)?,
        velocities: speed::velocities(tracks, options.speed_reach),
    };
    let mut diagrams = diagrams(options, &rows.places);
    let mut history = History::new(options, tracks.ids.len());
    let mut overview = overview(tracks, chosen.clone());
    let mut seen = vec![false; tracks.ids.len()];
    let mut safety = Safety::new(tracks, tracks.frames[chosen.start], options.sample_every);
    for batch in batches(tracks, chosen) {
        let frames = batch.clone().into_par_iter();
        let found: Vec<Incomplete> = frames.map(|k| rows.of_frame(k)).collect();
        let moment = |(k, found): (usize, Incomplete)| {
            overview.look_at(&found.parts);
            found.completed(&mut history, tracks, tracks.frames[k])
        };
        let moments: Vec<Moment> = batch.zip(found).map(moment).collect();
        for moment in &moments {
            overview.add(moment);
            for person in &moment.people {
                seen[person.number as usize] = true;
            }
            for (number, diagram) in diagrams.iter_mut().enumerate() {
                diagram.add(number + 1, moment);
            }
        }
        safety.add(&moments, site);
        let people: Vec<&Person> = moments.iter().flat_map(|moment| &moment.people).collect();
        fields.add(&people, site);
        take(&moments)?;
    }
    overview.people = seen.into_iter().filter(|&seen| seen).count() as u64;
    let lines = options.lines.par_iter().enumerate();
    let crossings = lines.map(|(k, &line)| Crossings::of(own, k + 1, line, options.times));
    Ok(Measured {
        overview,
        fields,
        diagrams,
        crossings: crossings.collect(),
        departures: safety.departures(tracks),
        safety,
    })
}

/// What each row is measured from.
struct Rows<'a> {
    tracks: &'a Tracks,
    site: &'a Site,
    options: &'a Options,
    places: Regions<'a>,
    /// By row.
    velocities: Vec<Option<Vector>>,
}

impl Rows<'_> {
    fn of_frame(&self, k: usize) -> Incomplete {
        let Self {
            tracks, options, ..
        } = self;
        let rows = tracks.rows(k);
        let masses = tracks.mass.get(rows.clone()).unwrap_or(&[]);
        let how = (&options.kernel, options.behind);
        let parts = parts(self.site, &tracks.position[rows.clone()], masses, how);
        let person = |(row, parts)| person(tracks, row, parts, self.velocities[row]);
        let mut people: Vec<Person> = rows.zip(&parts).map(person).collect();
        let regions = self.places.measure(&mut people);
        Incomplete {
            parts,
            people,
            regions,
        }
    }
}

/// A frame before the densities of its people are known.
struct Incomplete {
    parts: Vec<Parts>,
    people: Vec<Person>,
    regions: Vec<RegionState>,
}

impl Incomplete {
    /// The frame with the number `frame`, with all densities.
    fn completed(mut self, history: &mut History, tracks: &Tracks, frame: i64) -> Moment {
        for (person, parts) in self.people.iter_mut().zip(&self.parts) {
            history.complete(person, parts, (frame, tracks.step, tracks.interval()));
        }
        Moment {
            frame,
            time: tracks.time(frame),
            people: self.people,
            regions: self.regions,
        }
    }
}

/// Diagrams without frames: one per region, or one for everywhere.
fn diagrams(options: &Options, places: &Regions) -> Vec<Diagram> {
    if options.regions.is_empty() {
        return vec![Diagram::default()];
    }
    let regions = options.regions.iter().zip(places.walkable());
    let diagrams = regions.map(|(&region, walkable)| Diagram {
        region: Some(region),
        walkable: Some(walkable),
        ..Diagram::default()
    });
    diagrams.collect()
}

/// Frames that are measured at a time, in order.
fn batches(tracks: &Tracks, chosen: Range<usize>) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut next = chosen.start;
    std::iter::from_fn(move || {
        let begin = Some(next).filter(|&next| next < chosen.end)?;
        let first = tracks.rows(begin).start;
        while next < chosen.end && (next == begin || tracks.rows(next).end - first < BATCH) {
            next += 1;
        }
        Some(begin..next)
    })
}

/// Checks that there is something to measure.
///
/// # Errors
/// There are no people in the requested time, there are too many cells, a line is off the floor, or those of
/// [`Regions::new`].
pub fn check(tracks: &Tracks, site: &Site, options: &Options) -> Result<(), MeasureError> {
    let chosen = chosen(tracks, options)?;
    Regions::new(site, options)?;
    line::check(tracks, site, options)?;
    grid(tracks, options, chosen).map(|_| ())
}

/// The frames in the requested time.
fn chosen(tracks: &Tracks, options: &Options) -> Result<Range<usize>, MeasureError> {
    let [from, until] = options.times;
    let frames = &tracks.frames;
    let begin = frames.partition_point(|&frame| tracks.time(frame) < from);
    let end = frames.partition_point(|&frame| tracks.time(frame) <= until);
    if begin >= end {
        let ends = [frames.first(), frames.last()];
        let [first, last] = ends.map(|frame| frame.map_or(0.0, |&frame| tracks.time(frame)));
        return Err(MeasureError::Nobody(from, until, first, last));
    }
    Ok(begin..end)
}

/// A grid that covers the kernels of all people.
fn grid(tracks: &Tracks, options: &Options, chosen: Range<usize>) -> Result<Grid, MeasureError> {
    let rows = tracks.rows(chosen.start).start..tracks.rows(chosen.end - 1).end;
    let [low, high] = bounds(tracks.position[rows].iter().copied()).unwrap_or_default();
    let margin = Vector::repeat(options.kernel.support_radius);
    cells_over(low - margin, high + margin, options.cell).ok_or(MeasureError::Cells(options.cell))
}

fn overview(tracks: &Tracks, chosen: Range<usize>) -> Overview {
    let [first, last] = [chosen.start, chosen.end - 1].map(|k| tracks.frames[k]);
    let frames = ((last - first) / tracks.step) as u64 + 1;
    Overview {
        frames,
        empty_frames: frames.saturating_sub(chosen.len() as u64),
        times: [first, last].map(|frame| tracks.time(frame)),
        ..Overview::default()
    }
}

/// The person in a row, whose densities are yet to be found.
fn person(tracks: &Tracks, row: usize, parts: &Parts, velocity: Option<Vector>) -> Person {
    let number = tracks.person[row];
    Person {
        number,
        id: tracks.ids[number as usize],
        position: tracks.position[row],
        eye: parts.hidden.eye,
        mass: tracks.mass_of(row),
        velocity,
        density: 0.0,
        density_of_others: 0.0,
        voronoi: None,
        density_from_walls: 0.0,
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
            self.density_of_others.add(person.density_of_others);
            person
                .voronoi
                .into_iter()
                .for_each(|density| self.voronoi.add(density));
            if let Some(velocity) = person.velocity {
                self.speed.add(velocity.norm());
            }
            if person.density > self.densest.map_or(0.0, |(densest, ..)| densest.density) {
                self.densest = Some((*person, moment.frame, moment.time));
            }
        }
    }
}
