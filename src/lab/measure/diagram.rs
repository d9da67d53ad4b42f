//! Fundamental diagrams: density, speed and flow in a region, per person and per frame.

use std::collections::BTreeMap;

use serde::Serialize;

use super::Moment;
use crate::analysis::statistics::MeanStd;
use crate::engine::scene::Region;

/// Width of a density class, P/m².
pub const CLASS: f64 = 0.5;

/// Means over all people in a region in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FrameMean {
    /// Number of the region, from 1 in the given order.
    pub region: usize,
    /// The frame.
    pub frame: i64,
    /// Time of the frame, seconds.
    pub time: f64,
    /// Number of people.
    pub people: usize,
    /// Mean of their densities, P/m².
    pub density: f64,
    /// Mean of the known speeds, m/s.
    pub speed: Option<f64>,
    /// Density times speed, P/(m s).
    pub flow: Option<f64>,
}

/// Density, speed and flow of the people or frames in a density class.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Class {
    /// P/m².
    pub density: MeanStd,
    /// m/s.
    pub speed: MeanStd,
    /// ρ v of each, P/(m s).
    pub flow: MeanStd,
}

/// The results for one region.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Diagram {
    /// The region; `None` for everywhere.
    pub region: Option<Region>,
    /// Frame by frame; frames without people in the region are absent.
    pub frames: Vec<FrameMean>,
    /// Classes of people in single frames, by number: class k begins at k times [`CLASS`]. Empty classes are absent.
    pub of_persons: BTreeMap<usize, Class>,
    /// Classes of means over frames, by number.
    pub of_frames: BTreeMap<usize, Class>,
}

impl Diagram {
    /// Adds a frame; `number` is that of the region.
    pub fn add(&mut self, number: usize, moment: &Moment) {
        let is_there = |p| self.region.is_none_or(|region| region.contains(p));
        let there = moment.people.iter();
        let there: Vec<_> = there.filter(|person| is_there(person.position)).collect();
        if there.is_empty() {
            return;
        }
        let (mut density, mut speed) = (MeanStd::default(), MeanStd::default());
        for person in &there {
            density.add(person.density);
            if let Some(velocity) = person.velocity {
                speed.add(velocity.norm());
                add(&mut self.of_persons, person.density, velocity.norm());
            }
        }
        let (density, speed) = (density.mean, (speed.count > 0).then_some(speed.mean));
        if let Some(speed) = speed {
            add(&mut self.of_frames, density, speed);
        }
        self.frames.push(FrameMean {
            region: number,
            frame: moment.frame,
            time: moment.time,
            people: there.len(),
            density,
            speed,
            flow: speed.map(|speed| density * speed),
        });
    }
}

/// Adds a person or a frame to its class.
fn add(classes: &mut BTreeMap<usize, Class>, density: f64, speed: f64) {
    let class = classes.entry((density / CLASS) as usize).or_default();
    class.density.add(density);
    class.speed.add(speed);
    class.flow.add(density * speed);
}
