//! The trajectories of all persons, frame by frame.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::ops::Range;
use std::path::Path;

use rayon::prelude::*;

use super::error::ReadError;
use super::{ReadOptions, Unit};
use engine::math::Vector;

/// If the median speed is above this, m/s, the unit is probably wrong.
pub const TOO_FAST: f64 = 10.0;

/// Frame numbers up to this magnitude are exact in double precision.
const LAST_FRAME: i64 = 1 << 53;
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
        let entries = &mut self.entries;
        for entry in &*entries {
            let checked = entry.check(entry.position * meters);
            checked.map_err(|problem| refused(entry.line, problem))?;
        }
        entries.par_sort_unstable_by_key(|entry| (entry.frame, entry.id, entry.line));
        let same = |pair: &&[Entry]| (pair[0].frame, pair[0].id) == (pair[1].frame, pair[1].id);
        if let Some(pair) = entries.windows(2).find(same) {
            let problem = format!(
                "person {} is in frame {} already, by {place} {}; each may be there once: remove one",
                pair[1].id, pair[1].frame, pair[0].line
            );
            return Err(refused(pair[1].line, problem));
        }
        Ok(())
    }
}

/// Trajectories: one row per person and frame, sorted by frame, then by id.
#[derive(Debug, Clone)]
pub struct Tracks {
    /// Frame numbers per second.
    pub fps: f64,
    /// Difference between the numbers of consecutive recorded frames, usually 1.
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
        let mut notes = Vec::new();
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
        let mut tracks = Self::of_sorted(contents, fps);
        let steps = tracks.steps();
        tracks.step = tracks.most_common_step(&steps);
        tracks.notes = notes;
        tracks.note_steps(steps);
        Ok(tracks)
    }

    /// The tracks of checked and sorted content, as if each frame were recorded.
    fn of_sorted(contents: Contents, fps: f64) -> Self {
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
            walkable: contents.walkable,
            notes: Vec::new(),
            starts,
            by_person,
            ids,
        }
    }

    /// Adds notes on steps between frames, on gaps, and on speeds that no person has.
    fn note_steps(&mut self, steps: BTreeMap<i64, u64>) {
        if self.step != 1 {
            let note = format!("frames are numbered in steps of {}", self.step);
            self.notes.push(note);
        }
        let longer = steps.into_iter().filter(|&(step, _)| step != self.step);
        let (longest, gaps): (Vec<i64>, Vec<u64>) = longer.unzip();
        if let Some(&longest) = longest.last() {
            self.notes.push(format!(
                "{} gap(s) in which a person is missing, the longest {:.2} s; no motion is measured across",
                gaps.iter().sum::<u64>(),
                self.time(longest)
            ));
        }
        let empty = self.span() - self.frames.len() as u64;
        if empty > 0 {
            let note = format!("{empty} frame(s) contain no persons; they count as empty");
            self.notes.push(note);
        }
        if self.unit.is_none() && self.median_speed() > TOO_FAST {
            self.notes.push(format!(
                "half of all steps are faster than {TOO_FAST} m/s; are these centimeters? then give --unit cm"
            ));
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

    /// The number of frames from the first to the last, including empty frames.
    pub fn span(&self) -> u64 {
        match (self.frames.first(), self.frames.last()) {
            (Some(first), Some(last)) => ((last - first) / self.step) as u64 + 1,
            _ => 0,
        }
    }

    /// Counts the differences between consecutive frames of the same person.
    fn steps(&self) -> BTreeMap<i64, u64> {
        let frames = self.frames.iter().enumerate();
        let of_rows = frames.flat_map(|(k, &frame)| self.rows(k).map(move |_| frame));
        let frame_of: Vec<i64> = of_rows.collect();
        let mut steps = BTreeMap::new();
        for pair in self.by_person.iter().flat_map(|rows| rows.windows(2)) {
            let step = frame_of[pair[1] as usize] - frame_of[pair[0] as usize];
            *steps.entry(step).or_insert(0) += 1;
        }
        steps
    }

    /// The most common step, if it divides all differences between frames. Otherwise 1: a camera missed frames.
    fn most_common_step(&self, steps: &BTreeMap<i64, u64>) -> i64 {
        let most = steps.iter().max_by_key(|&(step, count)| (count, -step));
        let common = most.map_or(1, |(&step, _)| step);
        let first = self.frames[0];
        let mut frames = self.frames.iter();
        let fits = frames.all(|frame| (frame - first) % common == 0);
        if fits { common } else { 1 }
    }

    /// The median speed over all steps from a frame to the next, m/s; 0 without steps.
    pub fn median_speed(&self) -> f64 {
        let steps = self.by_person.iter().flat_map(|rows| rows.windows(2));
        let speed = |pair: &[u32]| {
            let [from, to] = [pair[0], pair[1]].map(|row| self.position[row as usize]);
            (to - from).norm() / self.interval()
        };
        let mut speeds: Vec<f64> = steps.map(speed).collect();
        if speeds.is_empty() {
            return 0.0;
        }
        let middle = speeds.len() / 2;
        *speeds.select_nth_unstable_by(middle, f64::total_cmp).1
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
