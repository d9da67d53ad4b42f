//! Levels as they are drawn, before their shapes are united.

use super::shape::Shape;

/// What a level is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LevelForm {
    /// Flat, at a height, meters.
    Floor(f64),
    /// A flight of stairs.
    Stairs,
    /// A ramp.
    Ramp,
}

/// An edge at which people walk from one level to another.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanJoin {
    /// The numbers of the two levels.
    pub levels: [usize; 2],
    /// Its ends, meters.
    pub line: [[f64; 2]; 2],
}

/// A level before its shapes are united.
#[derive(Debug)]
pub(super) struct DrawnLevel {
    pub name: String,
    pub form: LevelForm,
    pub shapes: Vec<Shape>,
}

/// The levels of a file before their shapes are united.
#[derive(Debug, Default)]
pub(super) struct DrawnLevels {
    pub levels: Vec<DrawnLevel>,
    pub joins: Vec<PlanJoin>,
    pub notes: Vec<String>,
}
