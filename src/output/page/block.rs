//! Blocks of frames: whole numbers in columns, as differences.
//!
//! `docs/reference/page-format.md` has the format.

use std::collections::HashMap;

/// What stays constant while a person is in a block: numbers of a meaning that the scene of the page gives.
pub type Body = [u32; 2];

/// A person in consecutive frames of a block.
struct Track {
    id: i64,
    body: Body,
    /// The first frame, from 0.
    first: u32,
    /// The values of all columns, frame by frame.
    values: Vec<i32>,
}

/// Frames that are compressed together.
pub struct Block {
    columns: usize,
    frames: u32,
    tracks: Vec<Track>,
    /// The track of each person in the last frame.
    open: HashMap<i64, usize>,
    rows: usize,
}

impl Block {
    /// An empty block with this number of columns.
    pub fn new(columns: usize) -> Self {
        Self {
            columns,
            frames: 0,
            tracks: Vec::new(),
            open: HashMap::new(),
            rows: 0,
        }
    }

    /// An empty block with the same columns.
    pub fn next(&self) -> Self {
        Self::new(self.columns)
    }

    /// The number of frames.
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// The number of persons, summed over the frames.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Begins the next frame.
    pub fn begin_frame(&mut self) {
        self.frames += 1;
    }

    /// Adds a person to the last frame, with one value per column.
    pub fn add(&mut self, id: i64, body: Body, values: impl IntoIterator<Item = i32>) {
        let frame = self.frames.saturating_sub(1);
        let known = self.open.get(&id).copied();
        let continues = |&k: &usize| {
            let track = &self.tracks[k];
            let length = (track.values.len() / self.columns.max(1)) as u32;
            track.body == body && track.first + length == frame
        };
        let k = known.filter(continues).unwrap_or_else(|| {
            self.tracks.push(Track {
                id,
                body,
                first: frame,
                values: Vec::new(),
            });
            self.open.insert(id, self.tracks.len() - 1);
            self.tracks.len() - 1
        });
        self.tracks[k].values.extend(values);
        self.rows += 1;
    }

    /// The block as bytes.
    pub fn bytes(mut self) -> Vec<u8> {
        self.tracks.sort_by_key(|track| (track.id, track.first));
        let mut bytes = Vec::new();
        put(&mut bytes, self.frames.into());
        put(&mut bytes, self.tracks.len() as u64);
        let mut before = 0;
        for track in &self.tracks {
            let step = track.id.wrapping_sub(before);
            put(&mut bytes, ((step << 1) ^ (step >> 63)).cast_unsigned());
            put(&mut bytes, track.first.into());
            put(
                &mut bytes,
                (track.values.len() / self.columns.max(1)) as u64,
            );
            track
                .body
                .iter()
                .for_each(|&value| put(&mut bytes, value.into()));
            before = track.id;
        }
        for column in 0..self.columns {
            let cost = |order| -> u64 {
                let bits = |rest: i32| u64::from(u32::BITS - zigzag(rest).leading_zeros());
                self.differences(column, order).map(bits).sum()
            };
            let order = if cost(2) < cost(1) { 2 } else { 1 };
            bytes.push(order);
            for rest in self.differences(column, order) {
                put(&mut bytes, zigzag(rest).into());
            }
        }
        bytes
    }

    /// The differences of a column, track by track: of each first value from the first value of the track before, and
    /// of each other one from the value before (`order` 1) or from the line through the two values before (2).
    fn differences(&self, column: usize, order: u8) -> impl Iterator<Item = i32> {
        let mut start = 0;
        self.tracks.iter().flat_map(move |track| {
            let values = track.values.iter().skip(column).step_by(self.columns);
            let first = values.clone().next().copied().unwrap_or(start);
            let mut last = std::mem::replace(&mut start, first);
            let mut slope = 0_i32;
            values.enumerate().map(move |(k, &value)| {
                let step = value.wrapping_sub(last);
                let rest = step.wrapping_sub(slope);
                if order == 2 && k > 0 {
                    slope = step;
                }
                last = value;
                rest
            })
        })
    }
}

/// Small numbers for small values of either sign: 0, −1, 1, −2, … become 0, 1, 2, 3, …
fn zigzag(value: i32) -> u32 {
    ((value << 1) ^ (value >> 31)).cast_unsigned()
}

/// Seven bits per byte, the lowest first; the highest bit says that more follow.
fn put(bytes: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}
