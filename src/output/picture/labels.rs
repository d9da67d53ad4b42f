//! Labels that do not cover each other.

use super::{Frame, TEXT_HEIGHT, dark};
use crate::engine::math::Vector;
use crate::output::colors::Rgb;
use crate::output::plot::{LABEL_SIZE, Label, Mark};

/// The mean width of a letter, as a part of the text's size.
const LETTER: f64 = 0.58;
/// Labels keep this distance from their points, points.
const GAP: f64 = 4.0;
/// Longer texts are cut.
const MOST_LETTERS: usize = 48;

/// All eight sides of a point and its center, the best first.
pub const AROUND: [[i8; 2]; 9] = [
    [0, 1],
    [0, -1],
    [1, 0],
    [-1, 0],
    [1, 1],
    [-1, 1],
    [1, -1],
    [-1, -1],
    [0, 0],
];

/// The width of a text, points.
pub fn width_of(text: &str) -> f64 {
    LETTER * LABEL_SIZE * text.chars().count() as f64
}

/// The labels of a panel.
pub struct Labels<'a> {
    frame: &'a Frame,
    placed: Vec<([Vector; 2], Label)>,
}

impl<'a> Labels<'a> {
    pub fn new(frame: &'a Frame) -> Self {
        Self {
            frame,
            placed: Vec::new(),
        }
    }

    /// Adds a label at the first of `places` where it fits into the panel and covers no other label; else at the first
    /// where it fits into the panel.
    pub fn add(&mut self, text: &str, color: Rgb, places: &[(Vector, [i8; 2])]) {
        let mut text = text.to_owned();
        if text.chars().count() > MOST_LETTERS {
            text = text.chars().take(MOST_LETTERS - 1).chain(['…']).collect();
        }
        let boxes = places
            .iter()
            .map(|&(p, side)| (self.around(&text, p, side), p, side));
        let frame = self.frame;
        let fits = |[low, high]: &[Vector; 2]| {
            low.x >= frame.min.x
                && low.y >= frame.min.y
                && high.x <= frame.max.x
                && high.y <= frame.max.y
        };
        let inside: Vec<_> = boxes.filter(|(around, ..)| fits(around)).collect();
        let overlaps = |[low, high]: &[Vector; 2]| {
            let covers = |([l, h], _): &([Vector; 2], Label)| {
                low.x < h.x && l.x < high.x && low.y < h.y && l.y < high.y
            };
            self.placed.iter().any(covers)
        };
        let free = inside.iter().find(|(around, ..)| !overlaps(around));
        let Some(&(around, p, side)) = free.or(inside.first()) else {
            return;
        };
        let gap = Vector::from(side.map(f64::from)) * frame.meters(GAP);
        let label = Label {
            at: (p + gap).into(),
            side,
            text,
            color: dark(color),
        };
        self.placed.push((around, label));
    }

    /// The corners of the box around a text beside `p`.
    fn around(&self, text: &str, p: Vector, side: [i8; 2]) -> [Vector; 2] {
        let size = [width_of(text), TEXT_HEIGHT].map(|points| self.frame.meters(points));
        let half = Vector::from(size) * 0.5;
        let side = Vector::from(side.map(f64::from));
        let center = p + side * self.frame.meters(GAP) + side.component_mul(&half);
        [center - half, center + half]
    }

    pub fn into_marks(self) -> impl Iterator<Item = Mark> {
        self.placed.into_iter().map(|(_, label)| Mark::Label(label))
    }
}
