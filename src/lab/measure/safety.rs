//! Quantities for safety engineers, from trajectories: exposure, alarms, level of service, crowd pressure, and the
//! times at which people have left. Forces need a model and are measured in runs only.

use rayon::prelude::*;
use serde::Serialize;

use super::Moment;
use analysis::crowd_pressure::Pressures;
use analysis::exposure::Exposure;
use analysis::local::{Local, People};
use analysis::service::Levels;
use analysis::site::Site;
use scenario::trajectories::Tracks;

/// The observations of people in samples of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Safety {
    /// The time between two samples, seconds: whole frames.
    pub secs: f64,
    /// Frame numbers between two samples.
    every: i64,
    /// The first frame, in which the first sample is taken.
    first: i64,
    /// Time in dense crowds, time standing, alarms.
    pub exposure: Exposure,
    /// Levels of service.
    pub levels: Levels,
    /// Crowd pressure.
    pub pressures: Pressures,
    /// The samples.
    pub samples: Vec<Sample>,
    /// The last frame of each person.
    last: Vec<Option<i64>>,
}

/// People at one time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sample {
    /// The frame.
    pub frame: i64,
    /// Seconds.
    pub time: f64,
    /// Number of people.
    pub people: usize,
    /// Number of people above 4 P/m².
    pub people_above_4: u32,
    /// The same above 5 P/m².
    pub people_above_5: u32,
    /// The same above 6 P/m².
    pub people_above_6: u32,
    /// The area above 4 P/m², m².
    pub area_above_4: f64,
    /// The same above 5 P/m².
    pub area_above_5: f64,
    /// The same above 6 P/m².
    pub area_above_6: f64,
    /// The highest crowd pressure, 1/s².
    pub pressure: Option<f64>,
}

/// The times at which fractions of the people had left, seconds; `None` if they had not by the end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Departures {
    /// The number of people.
    pub people: usize,
    /// The number of people who had left before the last frame.
    pub left: usize,
    /// The time at which half of the people had left.
    pub t50_secs: Option<f64>,
    /// The time at which 95 % had left.
    pub t95_secs: Option<f64>,
    /// The time at which all had left.
    pub t100_secs: Option<f64>,
}

impl Safety {
    /// Nothing seen yet. Samples are `every_secs` apart, from the frame `first` on.
    pub fn new(tracks: &Tracks, first: i64, every_secs: f64) -> Self {
        let frames = (every_secs / tracks.interval()).round().max(1.0) as i64;
        Self {
            secs: frames as f64 * tracks.interval(),
            every: frames.saturating_mul(tracks.step),
            first,
            exposure: Exposure::default(),
            levels: Levels::default(),
            pressures: Pressures::default(),
            samples: Vec::new(),
            last: vec![None; tracks.ids.len()],
        }
    }

    /// Adds some frames, in order.
    pub fn add(&mut self, moments: &[Moment], site: &Site) {
        for moment in moments {
            for person in &moment.people {
                self.last[person.number as usize] = Some(moment.frame);
            }
        }
        let is_due = |moment: &&Moment| (moment.frame - self.first).rem_euclid(self.every) == 0;
        let due: Vec<&Moment> = moments.iter().filter(is_due).collect();
        let local: Vec<Vec<Local>> = due.par_iter().map(|moment| local(moment, site)).collect();
        for (moment, people) in due.into_iter().zip(&local) {
            let last = self.samples.last().map(|last| last.frame);
            if last.is_some_and(|last| moment.frame - last > self.every) {
                // There were no people in the frames between.
                self.exposure.add([].iter());
                self.pressures.add(moment.time, [].iter());
            }
            self.levels.add(people.iter());
            let [four, five, six] = self.exposure.add(people.iter());
            self.samples.push(Sample {
                frame: moment.frame,
                time: moment.time,
                people: people.len(),
                people_above_4: four.people,
                people_above_5: five.people,
                people_above_6: six.people,
                area_above_4: four.area,
                area_above_5: five.area,
                area_above_6: six.area,
                pressure: self.pressures.add(moment.time, people.iter()),
            });
        }
    }

    /// The times at which fractions of the people had left. A person leaves after its last frame, unless that is the
    /// last frame of all.
    pub fn departures(&self, tracks: &Tracks) -> Departures {
        let seen = self.last.iter().copied().flatten();
        let end = seen.clone().max();
        let mut frames: Vec<i64> = seen.clone().filter(|&last| Some(last) != end).collect();
        frames.sort_unstable();
        let people = seen.count();
        let time_of = |part: f64| {
            let count = (part * people as f64).ceil() as usize;
            let frame = frames.get(count.checked_sub(1)?)?;
            Some(tracks.time(*frame))
        };
        Departures {
            people,
            left: frames.len(),
            t50_secs: time_of(0.5),
            t95_secs: time_of(0.95),
            t100_secs: time_of(1.0),
        }
    }
}

/// The people of a frame with their surroundings.
fn local(moment: &Moment, site: &Site) -> Vec<Local> {
    let all = moment.people.iter();
    let people = People::new(all.map(|person| (person.number, person.position, person.velocity)));
    people.local(&people.at(site), true)
}
