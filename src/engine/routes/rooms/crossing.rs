//! Where routes cross openings.

use super::Rooms;
use super::side::Side;
use crate::math::{Vector, direction};

/// Where a way crosses an opening.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The side of the opening from which it comes.
    pub side: Side,
    /// The number of points of the way before.
    pub after: usize,
    /// Where, meters.
    pub at: Vector,
}

impl Rooms {
    /// Where a way over `points` from `p` first leaves the room of triangle `t`; `None` if it stays there.
    pub fn first_crossing(
        &self,
        p: Vector,
        t: u32,
        points: impl IntoIterator<Item = Vector>,
    ) -> Option<Crossing> {
        let (sides, mut from) = (self.sides_in(self.room(t)), p);
        let mut points = beside_corners(p, points).enumerate();
        points.find_map(|(after, to)| {
            let straight = [std::mem::replace(&mut from, to), to];
            let part = |side| {
                let pieces = self.opening(side).pieces.iter();
                let crossed = pieces.filter_map(|&piece| crossing(piece, straight));
                Some((crossed.reduce(f64::min)?, side))
            };
            let crossed = sides.iter().filter_map(|&side| part(side));
            let (part, side) = crossed.min_by(|a, b| a.0.total_cmp(&b.0))?;
            let at = straight[0] + part * (to - straight[0]);
            Some(Crossing { side, after, at })
        })
    }
}

/// The points of a way from `p`, whose corners are moved off their walls: openings end at corners, and walls go on
/// behind them.
fn beside_corners(
    p: Vector,
    points: impl IntoIterator<Item = Vector>,
) -> impl Iterator<Item = Vector> {
    let (mut points, mut before) = (points.into_iter().peekable(), p);
    std::iter::from_fn(move || {
        let point = points.next()?;
        let away = points.peek().map_or(Vector::zeros(), |next| {
            // The wall is on the side to which the way turns.
            direction(direction(point - before) - direction(next - point))
        });
        before = point;
        Some(point + away * OFF_WALLS)
    })
}

/// Corners are moved off their walls by this, meters.
const OFF_WALLS: f64 = 1e-3;

/// A straight way that ends this near to an opening, as a part of its length, ends there.
const TOUCHING: f64 = 1e-7;

/// The part of a straight way before it crosses an opening; `None` if it does not.
fn crossing([a, b]: [Vector; 2], [from, to]: [Vector; 2]) -> Option<f64> {
    let (along, way) = (b - a, to - from);
    let across = way.perp(&along);
    let part = (a - from).perp(&along) / across;
    let share = (a - from).perp(&way) / across;
    let is_crossed = (0.0..=1.0).contains(&share) && (0.0..1.0 - TOUCHING).contains(&part);
    is_crossed.then_some(part)
}
