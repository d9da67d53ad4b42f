//! Places and velocities between frames.

use super::Tracks;
use engine::math::Vector;

impl Tracks {
    /// Times this near to each other are the same, seconds: decimal times are rarely exact multiples of a frame's.
    pub fn rounding(&self) -> f64 {
        1e-6 / self.fps
    }

    /// The times of the first and the last frame of person `p`, seconds.
    pub fn times_of(&self, p: usize) -> [f64; 2] {
        let rows = self.rows_of(p);
        let ends = [rows.first(), rows.last()];
        ends.map(|row| row.map_or(f64::NAN, |&row| self.time(self.frame_of(row as usize))))
    }

    /// The place of person `p` at a time, meters: linear between its frames, also across gaps. Before its first frame
    /// it is the first place, after its last frame the last one.
    pub fn place_at(&self, p: usize, time: f64) -> Vector {
        let rows = self.rows_of(p);
        let frame = time * self.fps;
        let frame_of = |k: usize| self.frame_of(rows[k] as usize) as f64;
        let place = |k: usize| self.position[rows[k] as usize];
        let after = rows.partition_point(|&row| self.frame_of(row as usize) as f64 <= frame);
        if after == 0 || after == rows.len() {
            return place(after.saturating_sub(1));
        }
        let (from, to) = (frame_of(after - 1), frame_of(after));
        let [start, end] = [after - 1, after].map(place);
        start + (end - start) * ((frame - from) / (to - from))
    }

    /// The mean velocity of person `p` from `reach` seconds before a time until `reach` after, m/s, or in the part of
    /// this time in which the person is there. Zero for a person in a single frame.
    pub fn velocity_at(&self, p: usize, time: f64, reach: f64) -> Vector {
        let [first, last] = self.times_of(p);
        let [from, to] = [time - reach, time + reach].map(|time| time.max(first).min(last));
        match from < to {
            true => (self.place_at(p, to) - self.place_at(p, from)) / (to - from),
            false => Vector::zeros(),
        }
    }
}
