//! The time that people spend in dense crowds and the time that they stand, and the size of the crowds.
//!
//! The densities are usual thresholds in the literature on crowds (Fruin 1993, Still 2014), not safety limits.

use serde::{Deserialize, Serialize};

use super::local::Local;

/// The densities that count as dense, P/m².
pub const DENSITIES: [f64; 3] = [4.0, 5.0, 6.0];
/// Below this speed people count as standing, m/s.
pub const SLOW: f64 = 0.2;

/// The number of intervals between samples that a sample represents: the interval before it, and none for the first
/// sample. So `n` samples represent `n - 1` intervals.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Weight {
    has_begun: bool,
}

impl Weight {
    /// The weight of the next sample.
    pub fn of_next(&mut self) -> u32 {
        u32::from(std::mem::replace(&mut self.has_begun, true))
    }
}

/// The number of consecutive intervals in which a condition held: up to now, and the maximum.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Spell {
    now: u32,
    longest: u32,
}

impl Spell {
    /// Adds a sample of this [`Weight`].
    pub fn add(&mut self, holds: bool, weight: u32) {
        self.now = if holds { self.now + weight } else { 0 };
        self.longest = self.longest.max(self.now);
    }

    /// The largest number of intervals in a row.
    pub fn longest(&self) -> f64 {
        f64::from(self.longest)
    }
}

/// A crowd above one of [`DENSITIES`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    /// The largest area at one time, m²: Σ 1/ρ over the people above the density.
    pub area: f64,
    /// The most people at one time.
    pub people: u32,
    /// The intervals with at least one person above the density.
    pub spell: Spell,
}

/// The part of a crowd above one of [`DENSITIES`] at one time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Dense {
    /// m²: Σ 1/ρ over these people.
    pub area: f64,
    /// Their number.
    pub people: u32,
}

/// The observations of people at several times.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Exposure {
    /// By number of the person: the number of intervals above each of [`DENSITIES`], and slower than [`SLOW`]; `None`
    /// if in no sample.
    intervals: Vec<[Option<u32>; 4]>,
    /// One per density.
    pub alarms: [Alarm; 3],
    weight: Weight,
}

/// The exposure of all people to one condition.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Exposed {
    /// The number of people who were exposed.
    pub people: u32,
    /// The sum of their times, seconds.
    pub person_secs: f64,
    /// The longest time of one person, seconds.
    pub longest_secs: f64,
}

/// One person's exposure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PersonExposure {
    /// The number of the person.
    pub agent: u32,
    /// Seconds above 4 P/m².
    pub above_4_secs: f64,
    /// Seconds above 5 P/m².
    pub above_5_secs: f64,
    /// Seconds above 6 P/m².
    pub above_6_secs: f64,
    /// Seconds below 0.2 m/s.
    pub slow_secs: f64,
}

impl Exposure {
    /// Adds the people at one time; returns the part of them above each density.
    pub fn add<'a>(&mut self, people: impl Iterator<Item = &'a Local>) -> [Dense; 3] {
        let mut dense = [Dense::default(); 3];
        let weight = self.weight.of_next();
        let count = |intervals: &mut Option<u32>| *intervals.get_or_insert(0) += weight;
        for person in people {
            let number = person.number as usize;
            if self.intervals.len() <= number {
                self.intervals.resize(number + 1, [None; 4]);
            }
            let own = &mut self.intervals[number];
            for (k, &density) in DENSITIES.iter().enumerate() {
                if person.density > density {
                    count(&mut own[k]);
                    dense[k].area += 1.0 / person.density;
                    dense[k].people += 1;
                }
            }
            if person.speed.is_some_and(|speed| speed < SLOW) {
                count(&mut own[3]);
            }
        }
        for (alarm, now) in self.alarms.iter_mut().zip(dense) {
            alarm.area = alarm.area.max(now.area);
            alarm.people = alarm.people.max(now.people);
            alarm.spell.add(now.people > 0, weight);
        }
        dense
    }

    /// The exposure to each of [`DENSITIES`] and to standing; samples are `secs` seconds apart.
    pub fn exposed(&self, secs: f64) -> [Exposed; 4] {
        std::array::from_fn(|k| {
            let counts = self.intervals.iter().filter_map(|own| own[k]);
            let sum: u64 = counts.clone().map(u64::from).sum();
            Exposed {
                people: counts.clone().count() as u32,
                person_secs: sum as f64 * secs,
                longest_secs: f64::from(counts.max().unwrap_or(0)) * secs,
            }
        })
    }

    /// The exposure of each person who was exposed to anything; samples are `secs` seconds apart.
    pub fn of_people(&self, secs: f64) -> impl Iterator<Item = PersonExposure> + '_ {
        let people = self.intervals.iter().zip(0..);
        let exposed = people.filter(|(own, _)| own.iter().any(Option::is_some));
        exposed.map(move |(own, agent)| {
            let [above_4_secs, above_5_secs, above_6_secs, slow_secs] =
                own.map(|count| f64::from(count.unwrap_or(0)) * secs);
            PersonExposure {
                agent,
                above_4_secs,
                above_5_secs,
                above_6_secs,
                slow_secs,
            }
        })
    }
}
