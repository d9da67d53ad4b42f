//! All people in the same frames.

use std::borrow::Cow;
use std::collections::HashMap;

use super::tracks::{Contents, Entry, Tracks};
use super::unit::Unit;

impl Tracks {
    /// All people in the same frames, which are [`step`](Self::step) apart: places between two rows of a person are
    /// linear in time, except across gaps. A person whose rows are all between two frames is in the nearest one. The
    /// tracks themselves if all rows are in such frames.
    pub fn together(&self) -> Cow<'_, Self> {
        match self.off_frames() == 0 && self.steps.is_empty() {
            true => Cow::Borrowed(self),
            false => Cow::Owned(self.at_frames()),
        }
    }

    /// The number of rows that are not in a common frame.
    pub(super) fn off_frames(&self) -> usize {
        let phase = self.phase();
        let off = |k: &usize| self.frames[*k].rem_euclid(self.step) != phase;
        let frames = (0..self.frames.len()).filter(off);
        frames.map(|k| self.rows(k).len()).sum()
    }

    /// The remainder of the numbers of common frames: that of most rows.
    fn phase(&self) -> i64 {
        let mut rows = HashMap::new();
        for (k, frame) in self.frames.iter().enumerate() {
            *rows.entry(frame.rem_euclid(self.step)).or_insert(0) += self.rows(k).len();
        }
        let most = rows
            .into_iter()
            .max_by_key(|&(phase, count)| (count, -phase));
        most.map_or(0, |(phase, _)| phase)
    }

    fn at_frames(&self) -> Self {
        let phase = self.phase();
        let mut entries = Vec::new();
        for p in 0..self.ids.len() {
            let mut stretch = Vec::new();
            let mut last = i64::MIN;
            for &row in self.rows_of(p) {
                let frame = self.frame_of(row as usize);
                if !stretch.is_empty() && self.is_gap(p, frame - last) {
                    self.add_stretch(p, &stretch, phase, &mut entries);
                    stretch.clear();
                }
                stretch.push((frame, row as usize));
                last = frame;
            }
            self.add_stretch(p, &stretch, phase, &mut entries);
        }
        let mut contents = Contents {
            entries,
            has_mass: !self.mass.is_empty(),
            unit: Some(Unit::Meter),
            ..Contents::default()
        };
        contents.order();
        let mut tracks = Self::of_sorted(&contents, self.fps);
        tracks.step = self.step;
        tracks.unit = self.unit;
        tracks.walkable.clone_from(&self.walkable);
        tracks.notes.clone_from(&self.notes);
        tracks.own_ids.clone_from(&self.own_ids);
        tracks
    }

    /// Adds the places of a person in common frames from the first to the last of some rows without a gap. The line of
    /// an entry is the number of the nearest row.
    fn add_stretch(&self, p: usize, rows: &[(i64, usize)], phase: i64, entries: &mut Vec<Entry>) {
        let (Some(&(first, row)), Some(&(last, _))) = (rows.first(), rows.last()) else {
            return;
        };
        let id = self.ids[p];
        let entry = |frame: i64, row: usize, position| Entry {
            frame,
            id,
            position,
            mass: self.mass_of(row),
            line: row as u64,
        };
        let mut frame = first + (phase - first).rem_euclid(self.step);
        if frame > last {
            let before = frame - self.step;
            let nearest = if first - before < frame - last {
                before
            } else {
                frame
            };
            let is_there = |entry: &Entry| (entry.id, entry.frame) == (id, nearest);
            if !entries.last().is_some_and(is_there) {
                entries.push(entry(nearest, row, self.position[row]));
            }
            return;
        }
        let mut k = 0;
        while frame <= last {
            while rows[k].0 < frame {
                k += 1;
            }
            let (after, to) = rows[k];
            let (before, from) = rows[k.saturating_sub(1)];
            let (start, end) = (self.position[from], self.position[to]);
            if after == frame {
                entries.push(entry(frame, to, end));
            } else {
                let part = (frame - before) as f64 / (after - before) as f64;
                let nearest = if part < 0.5 { from } else { to };
                entries.push(entry(frame, nearest, start + (end - start) * part));
            }
            frame += self.step;
        }
    }

    /// Of tracks that [`together`](Self::together) made of others: the row of these that is nearest to a row.
    pub fn source(&self, row: usize) -> usize {
        self.lines[row] as usize
    }
}
