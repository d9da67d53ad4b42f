//! Jitter: how much a crowd at rest still moves (§6.3.2 and §6.3.3 as numbers).

use serde::{Deserialize, Serialize};

use crate::engine::simulation::{Fault, Simulation};
use crate::lab::job::Job;
use crate::lab::reproduce::ReproduceError;
use crate::runs::drive::{Then, drive};
use crate::scenario::{Scenario, ScenarioError, Setting, SettingError};

/// The crowd: `scenarios/stress/small_concert.json`.
const CONCERT: &str = include_str!("../../../scenarios/stress/small_concert.json");
/// When is looked: before the push and long after it, seconds.
const WINDOWS: [[f64; 2]; 2] = [[35.0, 40.0], [50.0, 60.0]];
/// The least dense part of the crowd is its rim.
const RIM: f64 = 0.25;

/// A way to settle the same crowd.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Variant {
    /// What it is called.
    pub label: &'static str,
    /// What makes it, as `--set` takes it.
    pub settings: &'static [&'static str],
}

/// The baseline first.
pub const VARIANTS: [Variant; 12] = [
    variant("dynamic ρ⁰, μ = 5", &[]),
    variant("dynamic ρ⁰, μ = 0", &["viscosity=0"]),
    variant("static ρ⁰, μ = 5", &["rest_density_min=5"]),
    variant("static ρ⁰, μ = 0", &["rest_density_min=5", "viscosity=0"]),
    variant("dynamic ρ⁰, μ = 5, no contact", &["agent_stiffness=0"]),
    variant(
        "dynamic ρ⁰, μ = 0, no contact",
        &["agent_stiffness=0", "viscosity=0"],
    ),
    variant(
        "static ρ⁰, μ = 5, no contact",
        &["agent_stiffness=0", "rest_density_min=5"],
    ),
    variant(
        "static ρ⁰, μ = 0, no contact",
        &["agent_stiffness=0", "rest_density_min=5", "viscosity=0"],
    ),
    variant(
        "dynamic ρ⁰, μ = 5, no contact, Δt = 0.002 s",
        &["agent_stiffness=0", "time_step_secs=0.002"],
    ),
    variant("dynamic ρ⁰, μ = 5, exact walls", &["wall_method=exact"]),
    variant(
        "no SPH, K^ag = 50",
        &["gas_constant=0", "viscosity=0", "wall_stiffness=1000"],
    ),
    variant(
        "no SPH, K^ag = 1000",
        &[
            "gas_constant=0",
            "viscosity=0",
            "wall_stiffness=1000",
            "agent_stiffness=1000",
        ],
    ),
];

const fn variant(label: &'static str, settings: &'static [&'static str]) -> Variant {
    Variant { label, settings }
}

/// How much a crowd moves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Jitter {
    /// Mean kinetic energy of a person before the push and long after it, m²/s² (mass 1 = average).
    pub energy: [f64; 2],
    /// The same of the inner crowd and of its rim, the least dense quarter, long after the push.
    pub inside_and_rim: [f64; 2],
    /// Mean density at the end, P/m².
    pub density: f64,
    /// The least distance of two centres at the end, in parts of the sum of their radii.
    pub closest: f64,
}

impl Variant {
    /// The crowd.
    ///
    /// # Errors
    /// A setting makes no sense.
    pub fn scenario(&self) -> Result<Scenario, ReproduceError> {
        let settings: Result<Vec<Setting>, SettingError> =
            self.settings.iter().map(|text| text.parse()).collect();
        let settings = settings.map_err(|error| ReproduceError::Data(error.to_string()))?;
        let scenario = Scenario::parse(CONCERT, "small_concert.json", &settings);
        scenario.map_err(|error: ScenarioError| ReproduceError::Scenario {
            case: self.label.to_owned(),
            error,
        })
    }

    /// The job of measuring it.
    pub fn job(self) -> Job {
        let expected = if self.settings.contains(&"time_step_secs=0.002") {
            15.0
        } else {
            1.5
        };
        let name = format!("jitter {}", self.label);
        Job::new(name, expected, move || self.measure()).depending_on(CONCERT)
    }

    /// Runs it and measures.
    ///
    /// # Errors
    /// The run cannot go on.
    pub fn measure(&self) -> Result<Jitter, ReproduceError> {
        let scenario = self.scenario()?;
        let failed = |fault| ReproduceError::Fault {
            case: self.label.to_owned(),
            fault,
        };
        let mut simulation = Simulation::new(scenario.scene.clone()).map_err(failed)?;
        simulation.request_density_until(u64::MAX);
        let mut windows = [[Mean::default(); 3]; 2];
        let driven = drive(&mut simulation, scenario.duration_secs, |simulation, _| {
            let now = simulation.frame().clock.time();
            for (sums, [from, to]) in windows.iter_mut().zip(WINDOWS) {
                if (from..=to).contains(&now) {
                    add_energies(simulation, sums);
                }
            }
            Ok::<Then, Fault>(Then::GoOn)
        });
        driven.map_err(failed)?;
        let density = &simulation.frame().fields.density;
        let [before, after] = windows.map(|sums| sums.map(|sum| sum.value()));
        Ok(Jitter {
            energy: [before[0], after[0]],
            inside_and_rim: [after[1], after[2]],
            density: density.iter().sum::<f64>() / density.len().max(1) as f64,
            closest: super::watch::closest(&simulation),
        })
    }
}

#[derive(Debug, Clone, Copy, Default)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1.0;
    }

    fn value(self) -> f64 {
        self.sum / self.count.max(1.0)
    }
}

/// Adds everybody's kinetic energy to the means of all, of the inside and of the rim.
fn add_energies(simulation: &Simulation, [all, inside, rim]: &mut [Mean; 3]) {
    let frame = simulation.frame();
    let (agents, density) = (frame.agents, &frame.fields.density);
    let mut sorted = density.clone();
    sorted.sort_by(f64::total_cmp);
    let Some(&dense) = sorted.get((RIM * sorted.len() as f64) as usize) else {
        return;
    };
    let bodies = agents.mass.iter().zip(&agents.velocity);
    for ((mass, velocity), &density) in bodies.zip(density) {
        let energy = 0.5 * mass * velocity.norm_squared();
        all.add(energy);
        if density >= dense {
            inside.add(energy);
        } else {
            rim.add(energy);
        }
    }
}
