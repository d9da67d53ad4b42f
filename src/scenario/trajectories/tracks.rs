//! The trajectories of all persons, frame by frame.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::ops::Range;
use std::path::Path;

use rayon::prelude::*;

use super::error::ReadError;
use super::{ReadOptions, Unit};
use engine::math::Vector;

/// If the median speed is above this, m/s, the unit, the frame rate or the order of the columns is wrong: a crowd may
/// run, but not half of it so fast.
pub const TOO_FAST: f64 = 5.0;

/// Frame numbers up to this magnitude are exact in double precision.
pub const LAST_FRAME: i64 = 1 << 53;
/// Largest magnitude of x and y, meters. It covers projected Earth coordinates, and squares keep enough digits.
const FARTHEST: f64 = 1e9;
/// Largest mass.
const HEAVIEST: f64 = 1e6;

/// One person in one frame, as read.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    pub frame: i64,
    pub id: i64,
    /// In the file's unit.
    pub position: Vector,
    pub mass: f64,
    /// Line or row in the file, from 1.
    pub line: u64,
}

impl Entry {
    /// Checks that all values are in range; `at` is the position in meters.
    fn check(&self, at: Vector) -> Result<(), String> {
        if !(-LAST_FRAME..=LAST_FRAME).contains(&self.frame) {
            return Err(format!(
                "the frame {} is out of range: at most 2^53 = {LAST_FRAME} before or after 0",
                self.frame
            ));
        }
        if at.amax() > FARTHEST {
            return Err(format!(
                "({:e}, {:e}) m is out of range: x and y must be at least -{FARTHEST:e} and at most {FARTHEST:e} m",
                at.x, at.y
            ));
        }
        match self.mass {
            mass if mass < 0.0 => Err(format!("the mass {mass:e} is below 0")),
            mass if mass > HEAVIEST => Err(format!("the mass {mass:e} is above {HEAVIEST:e}")),
            _ => Ok(()),
        }
    }
}

/// The content of a file.
#[derive(Debug, Default)]
pub struct Contents {
    pub entries: Vec<Entry>,
    pub has_mass: bool,
    pub fps: Option<f64>,
    pub unit: Option<Unit>,
    pub walkable: Vec<String>,
    /// The word for an entry's position in the file: line or row.
    pub place: &'static str,
    /// Whether the file does not name its columns.
    pub is_unnamed: bool,
    /// Notes on how the file is read.
    pub notes: Vec<String>,
}

impl Contents {
    /// The file's unit, meters.
    fn meters(&self) -> f64 {
        self.unit.unwrap_or(Unit::Meter).meters()
    }

    /// Checks all entries, and sorts them by frame, then by id.
    fn sort(&mut self, path: &Path) -> Result<(), ReadError> {
        let (place, meters) = (self.place, self.meters());
        let refused = |line: u64, problem: String| match place {
            "line" => ReadError::line(path, line, problem),
            _ => ReadError::file(path, format!("{place} {line}: {problem}")),
        };
        for entry in &self.entries {
            let checked = entry.check(entry.position * meters);
            checked.map_err(|problem| refused(entry.line, problem))?;
        }
        self.order();
        let same = |pair: &&[Entry]| (pair[0].frame, pair[0].id) == (pair[1].frame, pair[1].id);
        if let Some(pair) = self.entries.windows(2).find(same) {
            let problem = format!(
                "person {} is in frame {} already, by {place} {}; each may be there once: remove one",
                pair[1].id, pair[1].frame, pair[0].line
            );
            return Err(refused(pair[1].line, problem));
        }
        Ok(())
    }

    /// Sorts all entries by frame, then by id.
    pub(super) fn order(&mut self) {
        let entries = &mut self.entries;
        entries.par_sort_unstable_by_key(|entry| (entry.frame, entry.id, entry.line));
    }
}

/// Trajectories: one row per person and frame, sorted by frame, then by id.
#[derive(Debug, Clone)]
pub struct Tracks {
    /// Frame numbers per second.
    pub fps: f64,
    /// The most common difference between the frame numbers of a person's consecutive rows, usually 1.
    pub step: i64,
    /// The unit of the file's coordinates, which are converted to meters; `None`: not known, and meters are taken.
    pub unit: Option<Unit>,
    /// The ids of all persons, ascending. A person's index here is its number.
    pub ids: Vec<i64>,
    /// The frames with at least one person, ascending.
    pub frames: Vec<i64>,
    /// The person of each row, by number.
    pub person: Vec<u32>,
    /// The position of each row, meters.
    pub position: Vec<Vector>,
    /// The mass of each row, 1 = an average person; empty if the file has no masses, which means 1.
    pub mass: Vec<f64>,
    /// The walkable area as well-known text, if the file has it; several if it changes with time.
    pub walkable: Vec<String>,
    /// Warnings about the file for readers of the results.
    pub notes: Vec<String>,
    /// The first row of each frame, then the number of rows.
    starts: Vec<usize>,
    /// The rows of each person, by frame.
    by_person: Vec<Vec<u32>>,
    /// The line or row in the file of each row, from 1.
    pub(super) lines: Vec<u64>,
    /// The ids in the file of people who have others here.
    pub(super) own_ids: BTreeMap<i64, i64>,
    /// The steps of people who have another one than [`step`](Self::step).
    pub(super) steps: BTreeMap<u32, i64>,
}

impl Tracks {
    /// Checks and sorts the content of a file.
    pub(super) fn new(
        path: &Path,
        mut contents: Contents,
        options: &ReadOptions,
    ) -> Result<Self, ReadError> {
        if contents.entries.is_empty() {
            return Err(ReadError::file(path, "it contains no persons"));
        }
        if u32::try_from(contents.entries.len()).is_err() {
            let problem = "more than 4,294,967,295 rows; split it";
            return Err(ReadError::file(path, problem));
        }
        let mut notes = std::mem::take(&mut contents.notes);
        let fps = taken("fps", options.fps, contents.fps, &mut notes).ok_or_else(|| {
            let problem = "it has no frame rate (a line like `# framerate: 25`); give --fps";
            ReadError::file(path, problem)
        })?;
        let unit = taken("unit", options.unit, contents.unit, &mut notes);
        if unit.is_none() {
            let note = "no unit is given in the file (x/m or x/cm) or by --unit: meters are taken";
            notes.push(note.to_owned());
        }
        contents.unit = unit;
        contents.sort(path)?;
        let mut tracks = Self::of_sorted(&contents, fps);
        if contents.is_unnamed
            && let Some(other) = tracks.frame_first(&mut contents)
        {
            tracks = other;
        }
        notes.append(&mut contents.notes);
        let speed = tracks.median_speed();
        notes.extend(tracks.note_speed(speed));
        if speed <= TOO_FAST
            && let Some((parts, note)) = tracks.parted(&mut contents)
        {
            notes.push(note);
            tracks = parts.unwrap_or(tracks);
        }
        tracks.find_steps();
        tracks.walkable = contents.walkable;
        tracks.notes = notes;
        tracks.note_steps();
        Ok(tracks)
    }

    /// The tracks of checked and sorted content, as if each frame were recorded.
    pub(super) fn of_sorted(contents: &Contents, fps: f64) -> Self {
        let (entries, meters) = (&contents.entries, contents.meters());
        let mut ids: Vec<i64> = entries.iter().map(|entry| entry.id).collect();
        ids.par_sort_unstable();
        ids.dedup();
        let number = |id: i64| ids.partition_point(|&other| other < id) as u32;
        let person: Vec<u32> = entries.par_iter().map(|entry| number(entry.id)).collect();
        let mut by_person = vec![Vec::new(); ids.len()];
        for (row, &p) in person.iter().enumerate() {
            by_person[p as usize].push(row as u32);
        }
        let (mut frames, mut starts) = (Vec::new(), Vec::new());
        for (row, entry) in entries.iter().enumerate() {
            if frames.last() != Some(&entry.frame) {
                frames.push(entry.frame);
                starts.push(row);
            }
        }
        starts.push(entries.len());
        let places = entries.iter().map(|entry| entry.position * meters);
        let masses = entries.iter().filter(|_| contents.has_mass);
        Self {
            fps,
            step: 1,
            unit: contents.unit,
            frames,
            person,
            position: places.collect(),
            mass: masses.map(|entry| entry.mass).collect(),
            walkable: Vec::new(),
            notes: Vec::new(),
            starts,
            by_person,
            ids,
            lines: entries.iter().map(|entry| entry.line).collect(),
            own_ids: BTreeMap::new(),
            steps: BTreeMap::new(),
        }
    }

    /// The number of rows.
    pub fn len(&self) -> usize {
        self.person.len()
    }

    /// Whether there are no rows; never true for a file that could be read.
    pub fn is_empty(&self) -> bool {
        self.person.is_empty()
    }

    /// The rows of the `k`-th of [`frames`](Self::frames), by id.
    pub fn rows(&self, k: usize) -> Range<usize> {
        self.starts[k]..self.starts[k + 1]
    }

    /// The rows of person `p`, by frame.
    pub fn rows_of(&self, p: usize) -> &[u32] {
        &self.by_person[p]
    }

    /// The id in the file of the person of a row.
    pub(super) fn own_id(&self, row: usize) -> i64 {
        let id = self.ids[self.person[row] as usize];
        self.own_ids.get(&id).copied().unwrap_or(id)
    }

    /// The frame of a row.
    pub fn frame_of(&self, row: usize) -> i64 {
        self.frames[self.starts.partition_point(|&start| start <= row) - 1]
    }

    /// The time of a frame, seconds.
    pub fn time(&self, frame: i64) -> f64 {
        frame as f64 / self.fps
    }

    /// Time between consecutive frames, seconds.
    pub fn interval(&self) -> f64 {
        self.step as f64 / self.fps
    }

    /// The mass of the person of a row.
    pub fn mass_of(&self, row: usize) -> f64 {
        self.mass.get(row).copied().unwrap_or(1.0)
    }
}

/// The given value, which takes precedence over the file's own.
fn taken<T: PartialEq + Copy + Display>(
    option: &str,
    given: Option<T>,
    own: Option<T>,
    notes: &mut Vec<String>,
) -> Option<T> {
    if let (Some(given), Some(own)) = (given, own)
        && given != own
    {
        notes.push(format!(
            "--{option} {given} is taken, not the file's own {own}"
        ));
    }
    given.or(own)
}
