//! How many agents enter a run and how much memory it takes, estimated before any agents are placed.

use crate::error::{Problem, ScenarioError};
use crate::file::File;
use crate::keys::from::FromData;
use crate::keys::interventions::Intervention;
use crate::keys::numerics::TimeStep;
use crate::keys::people::{Crowd, Entrance, Grid};
use crate::scene::{surroundings, wall_lists};
use engine::clock::{Clock, PAPER_COARSE_STEP};
use engine::scene::Scene;

/// Most agents that may enter in one run.
pub const MOST_AGENTS: u64 = 10_000_000;

/// Memory of the program itself with its threads, bytes.
const PROGRAM: u64 = 12 << 20;
/// Memory per initial agent, in the scenario and in the engine, bytes. Measured at 5 P/m² on two threads (peak
/// resident memory including the program, MB, and this estimate):
///
/// | agents | sph | rvo | estimate |
/// |---|---|---|---|
/// | 1,000 | 9.1 | 9.2 | 13.1 |
/// | 10,000 | 13.4 | 13.0 | 18.1 |
/// | 100,000 | 54.8 | 47.1 | 67.6 |
/// | 1,000,000 | 465 | – | 563 |
const AGENT: u64 = 690;
/// Memory per agent that enters later, bytes: growing arrays have spare capacity.
const LATER_AGENT: u64 = 650;
/// Memory per corner of an obstacle, with its wall and its share of the indices, bytes.
const WALL: u64 = 400;
/// Memory per byte of a scenario's text, for the document and the parsed scenario, bytes. 100,000 single agents (2.9
/// MB of text) take 228 MB, and 100,000 square obstacles (6.5 MB) take 322 MB; the estimates are 258 and 595 MB.
const TEXT: u64 = 65;

/// Memory per entry in the lists of walls near agents, bytes, with spare capacity: the lists grow in steps.
const LISTED: u64 = 5;

/// Upper bounds on the size of a scenario's run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Need {
    /// Agents at the start.
    pub initial: u64,
    /// Agents that enter during the whole run, including the initial ones.
    pub entering: u64,
    /// Walls of all obstacles and of the walkable area.
    pub walls: u64,
    /// Bytes of the scenario's text.
    pub text: u64,
    /// Entries in the lists of walls near agents; 0 until [`with_lists`](Self::with_lists) sets it.
    pub listed: u64,
    /// Bytes of path maps; 0 until [`with_lists`](Self::with_lists) sets it.
    pub routes: u64,
}

impl Need {
    /// Estimate of a run's peak memory if no agents leave, bytes: between one and two times the measured memory.
    /// Memory for writing output files is not included.
    pub fn bytes(&self) -> u64 {
        let later = self.entering.saturating_sub(self.initial);
        let parts = [
            (self.initial, AGENT),
            (later, LATER_AGENT),
            (self.walls, WALL),
            (self.text, TEXT),
            (self.listed, LISTED),
            (self.routes, 1),
        ];
        let products = parts.map(|(count, bytes)| count.saturating_mul(bytes));
        products.into_iter().fold(PROGRAM, u64::saturating_add)
    }

    /// The same need, with the lists of walls near agents for the ranges and walls of `scene`, and its path maps.
    pub fn with_lists(self, scene: &Scene) -> Self {
        Self {
            listed: wall_lists::entries(scene, self.entering),
            routes: scene
                .routes
                .as_ref()
                .map_or(0, |routes| routes.bytes() as u64),
            ..self
        }
    }

    /// Checks that a run fits into `there` bytes of memory. Writing its outputs takes `output` bytes per agent;
    /// messages call its scenario `file`.
    ///
    /// # Errors
    /// It does not fit; the message has the estimate.
    pub fn check(&self, file: &str, output: u64, there: u64) -> Result<(), ScenarioError> {
        let output = self.entering.saturating_mul(output);
        let estimate = self.bytes().saturating_add(output);
        if estimate <= there {
            return Ok(());
        }
        let (later, agents) = (self.entering - self.initial, self.entering);
        let entering = match later {
            0 => String::new(),
            later => format!(" ({later} of them from sources and entrances)"),
        };
        let listed = self.listed.saturating_mul(LISTED);
        let parts = [
            (output, "to write files"),
            (listed, "to list walls near agents"),
        ]
        .into_iter()
        .filter(|&(bytes, _)| bytes > 0)
        .map(|(bytes, what)| format!("{} of it {what}", in_units(bytes)));
        let parts = match parts.collect::<Vec<_>>().join(", ") {
            none if none.is_empty() => none,
            some => format!(" ({some})"),
        };
        let smaller = match listed > estimate / 2 {
            true => "smaller avoidance_radius and support_radius, ",
            false => "",
        };
        Err(ScenarioError::TooLarge(format!(
            "{file}: {agents} agents{entering} and {} walls would take {} of memory{parts}, and this machine has \
             {}: use {smaller}fewer agents, a shorter run (--until) if they enter later, or a larger machine",
            self.walls,
            in_units(estimate),
            in_units(there),
        )))
    }

    /// Counts the agents and walls of `file`. `clock` is the scenario's clock; it does not matter if the time step is
    /// `auto`.
    pub fn of(file: &File, clock: &Clock, duration_secs: f64) -> Result<Self, Problem> {
        let mut need = Self {
            walls: surroundings::walls(file),
            ..Self::default()
        };
        let cells = |grid: &Grid| u64::from(grid.columns) * u64::from(grid.rows);
        let last_entry = last_entry(file, clock, duration_secs);
        let entering = |source| cells(source).saturating_mul(entries(source, last_entry));
        let through = |entrance: &Entrance| entrance.most(last_entry);
        let (from, late) = (file.from.iter(), file.from.iter());
        let lists: [(&str, bool, Box<dyn Iterator<Item = u64>>); 7] = [
            ("from", true, Box::new(from.map(FromData::initial))),
            ("agents", true, Box::new(file.agents.iter().map(|_| 1))),
            ("grids", true, Box::new(file.grids.iter().map(cells))),
            (
                "crowds",
                true,
                Box::new(file.crowds.iter().map(Crowd::most)),
            ),
            (
                "sources",
                false,
                Box::new(file.sources.iter().map(entering)),
            ),
            (
                "entrances",
                false,
                Box::new(file.entrances.iter().map(through)),
            ),
            (
                "from",
                false,
                Box::new(late.map(|from| from.later(last_entry))),
            ),
        ];
        for (list, is_initial, counts) in lists {
            for (k, agents) in counts.enumerate() {
                need.entering = need.entering.saturating_add(agents);
                if is_initial {
                    need.initial = need.entering;
                }
                if need.entering > MOST_AGENTS {
                    return Err(need.too_many(list, k, duration_secs));
                }
            }
        }
        let added = file.interventions.iter().map(Intervention::adds);
        need.entering = added.fold(need.entering, u64::saturating_add);
        Ok(need)
    }

    /// The problem that too many agents enter with element `k` of a list.
    fn too_many(&self, list: &str, k: usize, duration_secs: f64) -> Problem {
        let agents = match self.entering {
            countable @ ..1_000_000_000_000 => countable.to_string(),
            more => format!("{:.1e}", more as f64),
        };
        let (place, fewer) = match list {
            "from" => (list.to_owned(), "agents"),
            "crowds" => (format!("{list}[{k}]"), "agents"),
            "entrances" => (
                format!("{list}[{k}]"),
                "agents per second, or a lower `number`",
            ),
            _ => (format!("{list}[{k}]"), "columns, rows or entries"),
        };
        let reason = format!(
            "too many: with these, {agents} agents enter within {duration_secs} s, which takes {} of memory; at most \
             {MOST_AGENTS} are allowed: use fewer {fewer}",
            in_units(self.bytes()),
        );
        Problem::new(place, reason)
    }
}

/// The latest time at which agents enter, seconds: agents due later do not enter before the end.
pub fn last_entry(file: &File, clock: &Clock, duration_secs: f64) -> f64 {
    if let Some(TimeStep::Auto(_)) = file.time_step_secs {
        // The step depends on the agents; the last frame is at most half a step late.
        let longest = match file.longest_step_secs {
            Some(TimeStep::Fixed(longest)) => longest,
            Some(TimeStep::Auto(_)) | None => PAPER_COARSE_STEP,
        };
        return duration_secs + 0.5 * longest;
    }
    let last = clock.frame_at(duration_secs);
    let coarse = last - last % u64::from(clock.coarse_every());
    // The same rounding as in `Clock::coarse_frame_at`.
    (coarse as f64 + 1e-6) * clock.time_step()
}

/// How many times agents enter from a source.
pub fn entries(source: &Grid, last_entry: f64) -> u64 {
    let [start, every] = source.schedule();
    // The cast saturates: a negative number becomes 0.
    let entries = ((last_entry - start) / every).floor() + 1.0;
    (entries as u64).min(source.times.map_or(u64::MAX, u64::from))
}

/// Formats a number of bytes with three digits and a unit.
pub fn in_units(bytes: u64) -> String {
    const UNITS: [&str; 6] = ["bytes", "kB", "MB", "GB", "TB", "PB"];
    let mut value = bytes as f64;
    let mut unit = 0;
    while value >= 999.5 && unit + 1 < UNITS.len() {
        value /= 1000.0;
        unit += 1;
    }
    let digits = match value {
        value if unit == 0 || value >= 99.95 => 0,
        value if value >= 9.995 => 1,
        _ => 2,
    };
    format!("{value:.digits$} {}", UNITS[unit])
}
