//! Jitter: the residual motion of a crowd at rest (§6.3.2 and §6.3.3 in numbers).

use serde::{Deserialize, Serialize};

use crate::engine::simulation::{Fault, Simulation};
use crate::lab::error::LabError;
use crate::runs::drive::{Then, drive};
use crate::runs::identity::Identity;
use crate::runs::job::Job;
use crate::scenario::{Scenario, ScenarioError, Setting, SettingError};

/// The crowd: `scenarios/stress/small_concert.json`.
const CONCERT: &str = include_str!("../../../scenarios/stress/small_concert.json");
/// The measured intervals: before the push and long after it, seconds.
const WINDOWS: [[f64; 2]; 2] = [[35.0, 40.0], [50.0, 60.0]];
/// The agents in this fraction with the lowest densities form the rim.
const RIM: f64 = 0.25;

/// A variant of the settings for the same crowd.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Variant {
    /// Its name.
    pub label: &'static str,
    /// Its settings, as `--set` takes them.
    pub settings: &'static [&'static str],
}

/// All variants, the baseline first.
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

/// The residual motion of a crowd.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Jitter {
    /// Mean kinetic energy of an agent before the push and long after it, m²/s² (an average agent has mass 1).
    pub energy: [f64; 2],
    /// The same for the inner crowd and for its rim, the least dense quarter, long after the push.
    pub inside_and_rim: [f64; 2],
    /// Mean density at the end, P/m².
    pub density: f64,
    /// The smallest distance between two centers at the end, relative to the sum of their radii.
    pub closest: f64,
}

impl Variant {
    /// The scenario.
    ///
    /// # Errors
    /// A setting is invalid.
    pub fn scenario(&self) -> Result<Scenario, LabError> {
        let settings: Result<Vec<Setting>, SettingError> =
            self.settings.iter().map(|text| text.parse()).collect();
        let settings = settings.map_err(|error| LabError::Data(error.to_string()))?;
        let scenario = Scenario::parse(CONCERT, "small_concert.json", &settings);
        scenario.map_err(|error: ScenarioError| LabError::of(self.label.to_owned(), error))
    }

    /// The job that measures it.
    pub fn job(self) -> Job<'static> {
        let expected = if self.settings.contains(&"time_step_secs=0.002") {
            15.0
        } else {
            1.5
        };
        let name = format!("jitter {}", self.label);
        Job::new(
            name.clone(),
            Identity::of(&name, CONCERT),
            expected,
            move |_| self.measure(),
        )
    }

    /// Runs and measures it.
    ///
    /// # Errors
    /// The run fails.
    pub fn measure(&self) -> Result<Jitter, LabError> {
        let scenario = self.scenario()?;
        let failed = |fault| LabError::of(self.label.to_owned(), fault);
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

/// Adds the kinetic energy of each agent to the means of all agents, of the inner crowd and of the rim.
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
