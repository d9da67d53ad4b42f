//! Moving discs in single precision, packed in columns.

use crate::neighbors::Run;
use crate::pairs::prelude::*;
use crate::pairs::{LANES, Simd, f32x8, f64x8, mask32x8, u32x8};

/// Eight discs in double precision.
pub struct Eight<S: Simd> {
    /// r_j − r_i along x and along y, meters.
    pub offset: [f64x8<S>; 2],
    /// v_j along x and along y, m/s.
    pub velocity: [f64x8<S>; 2],
    /// |r_j − r_i|² − (D_i + D_j)², m².
    pub gap: f64x8<S>,
}

/// The discs of a ring while it is read, one array per quantity.
#[derive(Debug, Default)]
pub struct Discs {
    len: usize,
    /// See [`Eight`].
    x: Vec<f32>,
    y: Vec<f32>,
    velocity_x: Vec<f32>,
    velocity_y: Vec<f32>,
    gap: Vec<f32>,
    number: Vec<u32>,
    /// The runs of agents that are still to be read.
    runs: Vec<Run>,
}

/// Eight discs in single precision. See [`Eight`].
#[derive(Debug, Clone, Copy)]
pub struct Packed {
    pub x: [f32; LANES],
    pub y: [f32; LANES],
    pub velocity_x: [f32; LANES],
    pub velocity_y: [f32; LANES],
    pub gap: [f32; LANES],
    pub number: [u32; LANES],
}

/// Writes the wanted values side by side to a column.
#[inline(always)]
fn put<S: Simd>(column: &mut [f32], values: f64x8<S>, is_wanted: mask32x8<S>) {
    let (low, high) = values.split();
    let values: f32x8<S> = low.narrow(high);
    values.compress(is_wanted).store_slice(column);
}

impl Discs {
    /// Begins to read the agents of these runs.
    pub fn begin(&mut self, runs: impl Iterator<Item = Run>) {
        self.runs.clear();
        runs.for_each(|run| self.runs.push(run));
    }

    /// The next run of agents to be read.
    pub fn next_run(&mut self) -> Option<Run> {
        self.runs.pop()
    }

    /// Adds the discs of a vector whose bits are set in `wanted`. They are numbered from `first` on.
    #[inline(always)]
    pub fn add<S: Simd>(&mut self, simd: S, eight: &Eight<S>, wanted: u64, first: u32) {
        let places = self.make_room();
        let is_wanted = mask32x8::from_bitmask(simd, wanted);
        put(&mut self.x[places.clone()], eight.offset[0], is_wanted);
        put(&mut self.y[places.clone()], eight.offset[1], is_wanted);
        put(
            &mut self.velocity_x[places.clone()],
            eight.velocity[0],
            is_wanted,
        );
        put(
            &mut self.velocity_y[places.clone()],
            eight.velocity[1],
            is_wanted,
        );
        put(&mut self.gap[places.clone()], eight.gap, is_wanted);
        let lanes = u32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
        let numbers = (lanes + u32x8::splat(simd, first)).compress(is_wanted);
        numbers.store_slice(&mut self.number[places]);
        self.len += wanted.count_ones() as usize;
    }

    /// Moves all discs to `packed`. The last vector is filled up with discs that no test finds certainly met; if one
    /// finds them possibly met, the last disc is checked once more.
    #[inline(always)]
    pub fn pack(&mut self, packed: &mut Vec<Packed>) {
        let rest = self.len..self.len.next_multiple_of(LANES);
        if !rest.is_empty() {
            self.make_room();
            self.x[rest.clone()].fill(0.0);
            self.y[rest.clone()].fill(0.0);
            self.velocity_x[rest.clone()].fill(0.0);
            self.velocity_y[rest.clone()].fill(0.0);
            self.gap[rest.clone()].fill(1.0);
            let last = self.number[rest.start - 1];
            self.number[rest.clone()].fill(last);
        }
        let positions = self.x.as_chunks().0.iter().zip(self.y.as_chunks().0);
        let velocities = self.velocity_x.as_chunks().0.iter();
        let velocities = velocities.zip(self.velocity_y.as_chunks().0);
        let others = self.gap.as_chunks().0.iter().zip(self.number.as_chunks().0);
        let all = positions.zip(velocities).zip(others);
        for (((x, y), (velocity_x, velocity_y)), (gap, number)) in all.take(rest.end / LANES) {
            packed.push(Packed {
                x: *x,
                y: *y,
                velocity_x: *velocity_x,
                velocity_y: *velocity_y,
                gap: *gap,
                number: *number,
            });
        }
        self.len = 0;
    }

    /// Extends the columns for one more vector, and returns its places.
    #[inline(always)]
    fn make_room(&mut self) -> std::ops::Range<usize> {
        let places = self.len..self.len + LANES;
        if self.x.len() < places.end {
            self.grow(2 * places.end);
        }
        places
    }

    #[cold]
    fn grow(&mut self, len: usize) {
        for column in [
            &mut self.x,
            &mut self.y,
            &mut self.velocity_x,
            &mut self.velocity_y,
            &mut self.gap,
        ] {
            column.resize(len, 0.0);
        }
        self.number.resize(len, 0);
    }
}
