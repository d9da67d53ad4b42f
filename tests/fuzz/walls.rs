//! The properties of walls hold for any obstacles at any points.

#![no_main]

use libfuzzer_sys::fuzz_target;
use sandbox::engine::geometry::Walls;
use sandbox::engine::math::Vector;

#[path = "../common/wall_checks.rs"]
mod wall_checks;

/// The largest number of points; more would find nothing new.
const MOST_POINTS: usize = 200;

/// Decodes numbers from bytes: the first byte of a number selects its format.
struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (&first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(first)
    }

    /// A valid coordinate: on a coarse grid, where edges touch and are collinear, or any number.
    fn coordinate(&mut self) -> Option<f64> {
        let kind = self.byte()?;
        if kind < 200 {
            return Some(f64::from(kind % 20) - 10.0 + f64::from(kind / 20) / 16.0);
        }
        let (bytes, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        let value = f64::from_le_bytes(*bytes);
        Some(if value.is_finite() { value % 1e6 } else { 0.0 })
    }

    fn point(&mut self) -> Option<Vector> {
        Some(Vector::new(self.coordinate()?, self.coordinate()?))
    }
}

fuzz_target!(|bytes: &[u8]| {
    let mut numbers = Numbers(bytes);
    let mut lists = vec![Vec::new()];
    let mut asked = Vec::new();
    for _ in 0..MOST_POINTS {
        let Some(kind) = numbers.byte() else { break };
        let Some(point) = numbers.point() else { break };
        match kind % 8 {
            0 => lists.push(vec![point]),
            1 | 2 => asked.push(point),
            _ => lists.last_mut().expect("one at least").push(point),
        }
    }
    let walls = Walls::new(wall_checks::obstacles(lists));
    for (k, &p) in asked.iter().enumerate() {
        let goal = asked[(k + 1) % asked.len()];
        for radius in [0.01, 1.0, 5.0] {
            wall_checks::check(&walls, p, goal, radius);
        }
    }
});
