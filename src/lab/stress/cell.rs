//! The largest time step at which a crowd comes to rest, found by bisection.

use serde::{Deserialize, Serialize};

use super::condition::Condition;
use super::rest::{Remains, Rest};
use engine::clock::PAPER_COARSE_STEP;
use engine::simulation::Fault;
use engine::stability::FITTED;
use runs::identity::Identity;
use runs::job::{Job, Progress};

/// No time step is longer, seconds: Δt_fine never exceeds Δt_coarse.
const LONGEST: f64 = PAPER_COARSE_STEP;
/// A time step of this fraction of the formula's shows the motion of the model itself.
const FINE: f64 = 0.2;
/// The search changes the formula's step by this factor until it passes the limit.
const WIDTH: f64 = 1.25;
/// The search gives up at this fraction of the formula's step.
const SHORTEST: f64 = 1e-3;

/// The result under one condition.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// The largest stable step, seconds.
    pub largest: f64,
    /// The step that `auto` chooses, seconds.
    pub auto: f64,
    /// Whether `auto` is stable.
    pub auto_is_stable: bool,
    /// The speed that remains at fine steps, in the room with the higher speed, m/s.
    pub fine_speed: f64,
    /// The same at `auto`.
    pub auto_speed: f64,
}

impl Limit {
    fn find(crowd: &Rest, bisections: u32, under: (Condition, u64)) -> Result<Self, Fault> {
        let (mode, scheme) = (crowd.mode(), under.0.scheme);
        let (formula, auto) = (mode.largest_step(scheme, &FITTED), mode.time_step(scheme));
        let at_auto = crowd.rooms(auto, under)?;
        Ok(Self {
            largest: largest(crowd, formula, bisections, under)?,
            auto,
            auto_is_stable: at_auto.iter().all(Remains::are_stable),
            fine_speed: fastest(&crowd.rooms(FINE * formula, under)?),
            auto_speed: fastest(&at_auto),
        })
    }

    /// `auto` over the largest stable step.
    pub fn ratio(&self) -> f64 {
        self.auto / self.largest
    }
}

/// The largest stable step, seconds, by bisection between the last step on one side of the limit and the first on the
/// other.
fn largest(
    crowd: &Rest,
    guess: f64,
    bisections: u32,
    under: (Condition, u64),
) -> Result<f64, Fault> {
    let rises = crowd.is_stable(guess, under)?;
    let factor = if rises { WIDTH } else { 1.0 / WIDTH };
    let (mut from, mut to) = (guess, (guess * factor).min(LONGEST));
    while crowd.is_stable(to, under)? == rises {
        if to >= LONGEST || to < SHORTEST * guess {
            return Ok(to);
        }
        (from, to) = (to, (to * factor).min(LONGEST));
    }
    let (mut low, mut high) = if rises { (from, to) } else { (to, from) };
    for _ in 0..bisections {
        let middle = (low * high).sqrt();
        match crowd.is_stable(middle, under)? {
            true => low = middle,
            false => high = middle,
        }
    }
    Ok(low)
}

fn fastest(rooms: &[Remains]) -> f64 {
    let speeds = rooms.iter().filter_map(|room| room.speed);
    speeds.fold(0.0, f64::max)
}

/// One point of the maps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// The crowd.
    pub crowd: Rest,
    /// The results, in the order of [`Condition::ALL`].
    pub limits: [Limit; Condition::ALL.len()],
}

impl Cell {
    /// Finds the largest stable step of a crowd; its agents are drawn with the seeds after `first_seed`.
    ///
    /// # Errors
    /// An agent cannot be placed at the start.
    pub fn find(crowd: Rest, bisections: u32, first_seed: u64) -> Result<Self, Fault> {
        let limit = |condition| Limit::find(&crowd, bisections, (condition, first_seed));
        let [paper, exact_walls, verlet] = Condition::ALL.map(limit);
        Ok(Self {
            crowd,
            limits: [paper?, exact_walls?, verlet?],
        })
    }

    /// The job that finds it.
    pub fn job(crowd: Rest, bisections: u32, first_seed: u64) -> Job<'static> {
        let mut name = format!(
            "map k={} ρ⁰max={} K^ag={} μ={}, {bisections} bisections, seeds after {first_seed}",
            crowd.gas_constant, crowd.rest_density_max, crowd.agent_stiffness, crowd.viscosity
        );
        if crowd.law.walking_law.is_some() {
            name += &format!(", {}", crowd.law);
        }
        // Simulated seconds: 8 s in two rooms with three crowds, mostly for the fine steps.
        let simulated = 48.0 * (1.0 / FINE + f64::from(bisections) + 3.0);
        let mode = crowd.mode();
        let frames = Condition::ALL.map(|on| simulated / mode.largest_step(on.scheme, &FITTED));
        let expected = 5e-5 * frames.iter().sum::<f64>();
        let work = move |_: Progress| Self::find(crowd, bisections, first_seed);
        Job::new(name.clone(), Identity::of(&name, ""), expected, work)
    }

    /// Whether `auto` is stable under every condition.
    pub fn auto_is_stable(&self) -> bool {
        self.limits.iter().all(|limit| limit.auto_is_stable)
    }
}
