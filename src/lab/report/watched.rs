//! What a report sees of its run while it runs.

use super::levels::OnLevels;
use super::passages::Passages;
use super::peaks::Peaks;
use super::still::Still;
use engine::simulation::Simulation;
use scenario::Scenario;

/// Between the moments that may be the one at which half of the agents had left, this share more must have left.
const MORE: f64 = 0.05;

/// What the report of a run needs beside the results.
pub struct Watched {
    /// The times of pictures that are asked for, seconds, ascending; `None`: the report has its own.
    at: Option<Vec<f64>>,
    /// The pictures so far: the first frame, then those that are asked for.
    pub stills: Vec<Still>,
    /// The moment of the highest density so far.
    highest: Option<(f64, Still)>,
    /// Moments at which half of the agents that had entered had left. If more enter, a later one is that of half of
    /// all agents.
    halves: Vec<Still>,
    /// The map of the highest densities.
    pub peaks: Peaks,
    /// The people who enter, and those who pass lines.
    pub passages: Passages,
    /// The people on each level of a building.
    pub levels: OnLevels,
}

impl Watched {
    /// Nothing yet. `at` has the times of pictures that are asked for, seconds.
    pub fn new(scenario: &Scenario, at: &[f64]) -> Self {
        let mut times = at.to_vec();
        times.retain(|&time| time > 0.0);
        times.sort_by(f64::total_cmp);
        times.dedup();
        Self {
            at: (!at.is_empty()).then_some(times),
            stills: Vec::new(),
            highest: None,
            halves: Vec::new(),
            peaks: Peaks::new(scenario),
            passages: Passages::new(scenario),
            levels: OnLevels::new(scenario),
        }
    }

    /// Prepares a run: every frame has densities from now on, also if its profile needs none. They change no result.
    pub fn prepare(simulation: &mut Simulation) {
        simulation.request_density_until(u64::MAX);
    }

    /// Sees an evaluated frame. Call it in every frame.
    pub fn see(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        self.passages.see(simulation);
        self.levels.see(simulation);
        if self.stills.is_empty() {
            self.stills.push(Still::of(simulation));
        }
        while let Some(time) = self.missing()
            && frame.clock.frame() >= frame.clock.frame_at(time)
        {
            self.stills.push(Still::of(simulation));
        }
        if frame.clock.is_coarse() {
            self.peaks.add(simulation);
        }
        if self.at.is_none() {
            self.see_highest(simulation);
            self.see_half(simulation);
        }
    }

    /// The first time of a picture, seconds, that has not come yet.
    pub fn missing(&self) -> Option<f64> {
        self.at.as_ref()?.get(self.stills.len().max(1) - 1).copied()
    }

    fn see_highest(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        if !frame.clock.is_coarse() {
            return;
        }
        let densities = &frame.fields.density;
        let present = frame.agents.present().filter(|&i| i < densities.len());
        let most = present.map(|i| densities[i]).fold(0.0, f64::max);
        if most > self.highest.as_ref().map_or(0.0, |(most, _)| *most) {
            self.highest = Some((most, Still::of(simulation)));
        }
    }

    fn see_half(&mut self, simulation: &Simulation) {
        let half = simulation.frame().agents.entered().div_ceil(2) as usize;
        let left = simulation.outcome().arrivals.len();
        self.halves.retain(|still| still.left >= half);
        let is_next = match self.halves.last() {
            None => left >= half.max(1),
            // Once all have entered, the first one stays that of half of all.
            Some(last) => {
                let next = (last.left as f64 * (1.0 + MORE)).ceil() as usize;
                simulation.expects_agents() && left >= next.max(last.left + 1)
            }
        };
        if is_next {
            self.halves.push(Still::of(simulation));
        }
    }

    /// The pictures with their captions, in the order of time: the first frame, then those that are asked for, or the
    /// highest density and when half of the agents had left. `entered` agents have entered.
    pub fn pictures(&self, entered: u32) -> Vec<(&Still, String)> {
        let mut all: Vec<(&Still, String)> = Vec::new();
        let of = |still: &Still| match still.count() {
            1 => format!("1 agent at {:.2} s", still.time),
            count => format!("{count} agents at {:.2} s", still.time),
        };
        for (k, still) in self.stills.iter().enumerate() {
            let plan = if k == 0 { "The plan: " } else { "" };
            all.push((still, format!("{plan}{}.", of(still))));
        }
        if let Some((most, still)) = &self.highest {
            let caption = format!("{}, with the highest density, {most:.2} P/m².", of(still));
            all.push((still, caption));
        }
        if let Some(still) = self.halves.first() {
            let caption = format!("{}, when {} of {entered} had left.", of(still), still.left);
            all.push((still, caption));
        }
        all.sort_by(|(one, _), (other, _)| one.time.total_cmp(&other.time));
        all.dedup_by(|(later, caption), (still, first)| {
            let is_same = later.time == still.time;
            if is_same {
                *first = format!("{first} {caption}");
            }
            is_same
        });
        all
    }
}
