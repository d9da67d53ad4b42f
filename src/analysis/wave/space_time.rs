//! The space-time diagram: a strip of the crowd along the x axis, averaged over its width.

use serde::{Deserialize, Serialize};

use engine::frame::Frame;

/// A strip along the x axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Strip {
    /// Both ends, meters.
    pub x: [f64; 2],
    /// Maximum |y|, meters.
    pub half_width: f64,
    /// Length of a bin, meters.
    pub bin: f64,
}

impl Strip {
    /// The number of bins.
    pub fn bins(&self) -> usize {
        ((self.x[1] - self.x[0]) / self.bin).round() as usize
    }

    /// The center of a bin, meters.
    pub fn middle(&self, bin: usize) -> f64 {
        self.x[0] + (bin as f64 + 0.5) * self.bin
    }
}

/// Mean values over x and t; `None` in an empty bin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpaceTime {
    /// The strip.
    pub strip: Strip,
    /// Times, seconds, evenly spaced.
    pub times: Vec<f64>,
    /// Mean |v|, m/s: all bins at the first time, then all bins at the second, and so on.
    pub speed: Vec<Option<f64>>,
    /// Mean v_x, m/s, in the same order.
    pub velocity: Vec<Option<f64>>,
}

impl SpaceTime {
    /// An empty diagram.
    pub fn new(strip: Strip) -> Self {
        Self {
            strip,
            times: Vec::new(),
            speed: Vec::new(),
            velocity: Vec::new(),
        }
    }

    /// Adds the current frame.
    pub fn observe(&mut self, frame: &Frame) {
        let bins = self.strip.bins();
        let mut sums = vec![(0u32, 0.0, 0.0); bins];
        for i in frame.agents.present() {
            let (r, v) = (frame.agents.position[i], frame.agents.velocity[i]);
            let along = (r.x - self.strip.x[0]) / self.strip.bin;
            if r.y.abs() <= self.strip.half_width && along >= 0.0 && along < bins as f64 {
                let (count, speed, velocity) = &mut sums[along as usize];
                *count += 1;
                *speed += v.norm();
                *velocity += v.x;
            }
        }
        // Rounded to 0.1 mm/s: more digits would only make stored diagrams longer.
        let mean = |count: u32, sum: f64| {
            (count > 0).then(|| (1e4 * sum / f64::from(count)).round() / 1e4)
        };
        self.times.push(frame.clock.time());
        let means = sums.iter().map(|&(count, speed, _)| mean(count, speed));
        self.speed.extend(means);
        let means = sums.iter().map(|&(count, _, v)| mean(count, v));
        self.velocity.extend(means);
    }

    /// v_x of one bin over time, minus its mean before `start` seconds. `None` if the bin was ever empty or no time is
    /// before `start`.
    pub(super) fn disturbance(&self, bin: usize, start: f64) -> Option<Vec<f64>> {
        let bins = self.strip.bins();
        let values = (0..self.times.len()).map(|row| self.velocity[row * bins + bin]);
        let series = values.collect::<Option<Vec<f64>>>()?;
        let before = self.times.iter().filter(|&&time| time < start).count();
        if before == 0 {
            return None;
        }
        let mean = series[..before].iter().sum::<f64>() / before as f64;
        Some(series.into_iter().map(|v| v - mean).collect())
    }

    /// Time between columns, seconds.
    pub(super) fn time_step(&self) -> f64 {
        match self.times[..] {
            [first, .., last] => (last - first) / (self.times.len() - 1) as f64,
            _ => 0.0,
        }
    }
}
