//! The states that forces keep for agents.

use serde::{Deserialize, Serialize};

use super::columns::{Column, Spare};
use crate::math::Vector;
use crate::period::Axis;

/// The state that a force keeps for each agent: a few numbers per agent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct States {
    /// The name of the force.
    pub force: String,
    /// The axes of the numbers that are coordinates.
    along: Vec<Option<Axis>>,
    /// The numbers of agent 0, of agent 1 and so on; NaN for agents on which the force does not act.
    values: Vec<f64>,
}

impl States {
    /// No states yet, for numbers that are coordinates along these axes.
    pub fn new(force: &str, along: Vec<Option<Axis>>) -> Self {
        Self {
            force: force.to_owned(),
            along,
            values: Vec::new(),
        }
    }

    /// How many numbers an agent has.
    pub fn width(&self) -> usize {
        self.along.len()
    }

    /// The state of agent `i`; `None` if the force does not act on it.
    #[inline]
    pub fn of(&self, i: usize) -> Option<&[f64]> {
        let state = self.values.get(i * self.width()..(i + 1) * self.width())?;
        (!state[0].is_nan()).then_some(state)
    }

    /// As [`of`](Self::of), to be changed.
    pub fn of_mut(&mut self, i: usize) -> Option<&mut [f64]> {
        let width = self.width();
        let state = self.values.get_mut(i * width..(i + 1) * width)?;
        (!state[0].is_nan()).then_some(state)
    }

    /// The numbers of agent `i`, whether or not the force acts on it.
    pub fn slot_mut(&mut self, i: usize) -> &mut [f64] {
        let width = self.width();
        &mut self.values[i * width..(i + 1) * width]
    }

    /// Adds agents up to this number, without states; returns their indices.
    pub fn extend_to(&mut self, count: usize) -> std::ops::Range<usize> {
        let known = self.count();
        Column::extend_to(self, count);
        known..count
    }

    /// The numbers of all agents, [`width`](Self::width) per agent.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Whether both are states of the same force, with the same numbers.
    pub fn is_like(&self, other: &Self) -> bool {
        self.force == other.force && self.along == other.along
    }

    /// Moves the coordinates of agent `i` by `way`, meters.
    pub fn shift(&mut self, i: usize, way: Vector) {
        let axes = self.along.clone();
        for (value, along) in self.of_mut(i).into_iter().flatten().zip(axes) {
            *value += match along {
                Some(Axis::X) => way.x,
                Some(Axis::Y) => way.y,
                None => 0.0,
            };
        }
    }
}

impl Column for States {
    fn count(&self) -> usize {
        self.values.len() / self.width()
    }

    fn extend_to(&mut self, count: usize) {
        self.values.resize(count * self.width(), f64::NAN);
    }

    fn arrange(&mut self, order: &[u32], _: &mut Spare) {
        let width = self.width();
        let state = |&i: &u32| &self.values[i as usize * width..(i as usize + 1) * width];
        self.values = order.iter().flat_map(state).copied().collect();
    }
}
