//! Crowd pressure ρ Var(v), after Helbing, Johansson and Al-Abideen, *Dynamics of crowd disasters: An empirical study*
//! (Phys. Rev. E 75, 046109, 2007).

use serde::{Deserialize, Serialize};

use super::exposure::{Spell, Weight};
use super::local::Local;

/// The pressure at which crowd turbulence began at Mina in 2006, about ten minutes before the accident, 1/s². An
/// observation of one crowd, not a safety limit.
pub const BEFORE_ACCIDENT: f64 = 0.02;

/// The observations of people at several times.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Pressures {
    /// The person with the highest pressure so far, and when, seconds.
    pub peak: Option<(Local, f64)>,
    /// The intervals with at least one person above [`BEFORE_ACCIDENT`].
    pub spell: Spell,
    /// The most people above it at one time.
    pub people: u32,
    /// The sum of all pressures, 1/s², and their number.
    sum: (f64, u64),
    weight: Weight,
}

impl Pressures {
    /// Adds the people at a time in seconds; returns the highest pressure at this time, 1/s².
    pub fn add<'a>(&mut self, time: f64, people: impl Iterator<Item = &'a Local>) -> Option<f64> {
        let (mut highest, mut above) = (None, 0);
        for person in people {
            let Some(pressure) = person.pressure else {
                continue;
            };
            self.sum = (self.sum.0 + pressure, self.sum.1 + 1);
            above += u32::from(pressure > BEFORE_ACCIDENT);
            if highest.is_none_or(|highest| pressure > highest) {
                highest = Some(pressure);
            }
            let peak = self.peak.and_then(|(peak, _)| peak.pressure);
            if peak.is_none_or(|peak| pressure > peak) {
                self.peak = Some((*person, time));
            }
        }
        self.people = self.people.max(above);
        self.spell.add(above > 0, self.weight.of_next());
        highest
    }

    /// The mean over people and times, 1/s².
    pub fn mean(&self) -> Option<f64> {
        let (sum, count) = self.sum;
        (count > 0).then(|| sum / count as f64)
    }
}
