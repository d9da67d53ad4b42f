//! Fundamental diagrams: density, speed and flow in a region, person by person and frame by frame.

use std::collections::BTreeMap;

use serde::Serialize;

use super::Moment;
use crate::engine::scene::Region;

/// Width of a class of densities, P/m².
pub const CLASS: f64 = 0.5;

/// The means over everybody in a region in one frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FrameMean {
    /// The region, in the order given from 1.
    pub region: usize,
    /// The frame.
    pub frame: i64,
    /// When it is, seconds.
    pub time: f64,
    /// How many are there.
    pub people: usize,
    /// The mean of their densities, P/m².
    pub density: f64,
    /// The mean of the speeds that are known, m/s.
    pub speed: Option<f64>,
    /// Density times speed, P/(m s).
    pub flow: Option<f64>,
}

/// Mean and standard deviation of some numbers, one after the other (Welford 1962).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spread {
    /// How many.
    pub count: u64,
    /// Their mean.
    pub mean: f64,
    squares: f64,
}

impl Spread {
    pub(super) fn add(&mut self, value: f64) {
        self.count += 1;
        let off = value - self.mean;
        self.mean += off / self.count as f64;
        self.squares += off * (value - self.mean);
    }

    /// Of the numbers themselves, not of a sample.
    pub fn deviation(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }
}

/// Density, speed and flow of whoever or whatever has a density in one class.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Class {
    /// P/m².
    pub density: Spread,
    /// m/s.
    pub speed: Spread,
    /// ρ v of each, P/(m s).
    pub flow: Spread,
}

impl Class {
    pub(super) fn add(&mut self, density: f64, speed: f64) {
        self.density.add(density);
        self.speed.add(speed);
        self.flow.add(density * speed);
    }
}

/// Everything about one region.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagram {
    /// Where; `None`: everywhere.
    pub region: Option<Region>,
    /// Frame by frame; those without anybody there are not among them.
    pub frames: Vec<FrameMean>,
    /// Classes of [`CLASS`] by their number, from 0 up, of persons in single frames; empty ones are missing.
    pub of_persons: BTreeMap<usize, Class>,
    /// The same, of means over frames.
    pub of_frames: BTreeMap<usize, Class>,
}

impl Diagram {
    /// Nothing yet.
    pub fn new(region: Option<Region>) -> Self {
        Self {
            region,
            frames: Vec::new(),
            of_persons: BTreeMap::new(),
            of_frames: BTreeMap::new(),
        }
    }

    /// Adds a frame to region `number`.
    pub fn add(&mut self, number: usize, moment: &Moment) {
        let is_there = |p| self.region.is_none_or(|region| region.contains(p));
        let there = moment.people.iter();
        let there: Vec<_> = there.filter(|person| is_there(person.position)).collect();
        if there.is_empty() {
            return;
        }
        let (mut density, mut speed) = (Spread::default(), Spread::default());
        for person in &there {
            density.add(person.density);
            if let Some(velocity) = person.velocity {
                speed.add(velocity.norm());
                class(&mut self.of_persons, person.density).add(person.density, velocity.norm());
            }
        }
        let known = (speed.count > 0).then_some(speed.mean);
        if let Some(speed) = known {
            class(&mut self.of_frames, density.mean).add(density.mean, speed);
        }
        self.frames.push(FrameMean {
            region: number,
            frame: moment.frame,
            time: moment.time,
            people: there.len(),
            density: density.mean,
            speed: known,
            flow: known.map(|speed| density.mean * speed),
        });
    }
}

/// The class that a density is in.
fn class(classes: &mut BTreeMap<usize, Class>, density: f64) -> &mut Class {
    classes.entry((density / CLASS) as usize).or_default()
}
