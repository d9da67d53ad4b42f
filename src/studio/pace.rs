//! The speed at which a run is played, and the one that it reaches.

use std::time::{Duration, Instant};

/// A run that is this much late is too slow for its speed, seconds of real time.
const LATE: f64 = 0.25;
/// The time over which the reached speed is measured.
const MEASURED: Duration = Duration::from_secs(1);

/// The speed at which a run is played.
pub struct Pace {
    /// Whether the run is played.
    pub playing: bool,
    /// Seconds of the run per second; `None`: as fast as it can.
    pub speed: Option<f64>,
    /// A moment, and the time of the run at it.
    since: (Instant, f64),
    /// Whether the run is too slow for its speed.
    pub behind: bool,
    /// The reached speed.
    pub rate: Option<f64>,
    /// The moment since when it is measured, and the time of the run at it.
    measured: (Instant, f64),
}

impl Pace {
    /// That of a run at a time, which is not played yet.
    pub fn at(time: f64) -> Self {
        let now = Instant::now();
        Self {
            playing: false,
            speed: Some(1.0),
            since: (now, time),
            behind: false,
            rate: None,
            measured: (now, time),
        }
    }

    /// Begins anew at a time of the run, seconds.
    pub fn begin(&mut self, time: f64) {
        let now = Instant::now();
        self.since = (now, time);
        self.measured = (now, time);
        self.rate = None;
        self.behind = false;
    }

    /// The time that the run should have reached, seconds.
    pub fn due(&self) -> f64 {
        let (since, time) = self.since;
        self.speed.map_or(f64::INFINITY, |speed| {
            time + speed * since.elapsed().as_secs_f64()
        })
    }

    /// Notes the time that the run has reached.
    pub fn reach(&mut self, time: f64) {
        let (since, from) = self.measured;
        if since.elapsed() >= MEASURED {
            self.rate = Some((time - from) / since.elapsed().as_secs_f64());
            self.measured = (Instant::now(), time);
        }
        let Some(speed) = self.speed else {
            return;
        };
        let late = self.due() - time > LATE * speed;
        if late {
            // What is lost is not made up for.
            self.since = (Instant::now(), time);
        }
        self.behind = late || self.behind && self.rate.is_some_and(|rate| rate < 0.95 * speed);
    }
}
