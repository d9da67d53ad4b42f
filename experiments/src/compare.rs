//! This engine compared with others, on the same crowds.

mod ours;
mod picture;
mod python;
mod race;
mod rustsim;
mod setting;

use std::path::Path;

use sandbox::lab::bench::{Crowd, Plan, Report, Timings};
use sandbox::lab::error::LabError;
use sandbox::lab::machine::Machine;
use sandbox::output::table::Table;
use serde_json::json;

use self::race::{PATIENCE, Racer, Row, TURN, race};
use self::setting::Setting;

/// Its name on the command line.
pub const NAME: &str = "compare";
/// A description, in one line.
pub const ABOUT: &str =
    "computing time beside rustsim-crowd, JuPedSim and RVO2, on the same crowds";

/// The paper's radius of avoidance, meters.
const WIDE: f64 = 5.0;
/// Bodies do not overlap at the start, and agents that avoid each other still move, P/m².
const DENSITY: f64 = 2.0;
const SIZES: [u32; 5] = [100, 1_000, 10_000, 100_000, 1_000_000];
/// The size of the main crowd, with which all settings are measured.
const MAIN: u32 = 10_000;
/// The most repeats with larger crowds.
const FEW: usize = 3;

/// The crowd of all engines: half of the agents walk to the right and half to the left.
fn crowd(agents: u32, profile: &'static str) -> Crowd {
    Crowd {
        density: DENSITY,
        ..Crowd::streams(agents, profile)
    }
}

/// Runs the comparison with the engines that the Python interpreter `python` has, and reports its progress with `say`.
///
/// # Errors
/// A simulation fails, or another program stops.
pub fn measure(plan: &Plan, python: &Path, say: &dyn Fn(&str)) -> Result<Report, LabError> {
    let findings = run(plan, python, say)?;
    Ok(Report::of(NAME, ABOUT, plan, findings))
}

fn run(plan: &Plan, python: &Path, say: &dyn Fn(&str)) -> Result<Timings, LabError> {
    let sizes = plan.choose(&SIZES[..], &[100, 400]).iter().copied();
    let sizes: Vec<u32> = sizes.filter(|&agents| agents <= plan.largest).collect();
    let main = sizes.iter().copied().filter(|&agents| agents <= MAIN).max();
    let mut notes = vec![conditions(), differences()];
    let others = others(python, &mut notes);
    let ours = ours::settings(&others, Machine::here().hardware_threads)?;
    let own = ours.len();
    let mut racers: Vec<Racer> = ours.into_iter().chain(others).map(Racer::new).collect();
    let mut rows = Vec::new();
    for agents in sizes {
        let is_main = Some(agents) == main;
        let mut taking_part = Vec::new();
        let mut own_here = 0;
        for (k, racer) in racers.iter_mut().enumerate() {
            if !is_main && !racer.setting.all_sizes {
                continue;
            }
            match racer.too_slow(agents) {
                Some(reason) => notes.push(reason),
                None => {
                    own_here += usize::from(k < own);
                    taking_part.push(racer);
                }
            }
        }
        say(&format!(
            "{agents} agents, {} engines and settings",
            taking_part.len()
        ));
        let repeats = match agents > MAIN {
            true => plan.repeats.min(FEW),
            false => plan.repeats,
        };
        let crowd = crowd(agents, "sf").settled(0)?;
        rows.append(&mut race(&mut taking_part, own_here, &crowd, repeats)?);
    }
    rows.sort_by_key(|row| Some(row.agents) != main);
    Ok(Timings {
        table: table(&rows),
        sheet: picture::picture(&rows),
        rows: json!(rows),
        notes,
    })
}

/// The settings of the other engines. Those that are missing get a note.
fn others(python: &Path, notes: &mut Vec<String>) -> Vec<Setting> {
    let mut found = vec![(
        "rustsim-crowd",
        rustsim::settings(Machine::here().hardware_threads),
    )];
    let packages = python::PACKAGES.iter();
    found.extend(packages.map(|package| (package.engine, package.settings(python))));
    let mut others = Vec::new();
    for (engine, settings) in found {
        match settings {
            Ok(mut settings) => others.append(&mut settings),
            Err(missing) => notes.push(format!("{engine} is missing: {missing}")),
        }
    }
    others
}

fn conditions() -> String {
    format!(
        "All engines get the same agents with the same radii at the same positions at {DENSITY} P/m², half of them \
         walking to the right and half to the left, no walls. Each uses its own time step Δt, so the cost is \
         computing time per simulated second: time per step / Δt. A turn is {TURN} s of simulated time, fewer steps \
         where these take long. The engines take turns, after first steps that do not count. A ratio is the cost \
         relative to this engine: the same family of models with the same radius on as many threads, turn by turn. \
         The mean speed is the mean distance of the agents from their first positions over the simulated time: all \
         engines really move them. Larger crowds are left out where a step or placing the agents would take more than \
         {PATIENCE} s."
    )
}

fn differences() -> String {
    format!(
        "The models differ. Social forces: here (§5.3.1) a force depends on the relative velocity, acts in the field \
         of view only, and agents that touch push; rustsim-crowd has Helbing's circular exponential force without \
         contact; JuPedSim adds body force and friction. rustsim-crowd's radius follows from the range B of its force \
         (8 B + 1 m), so that {WIDE} m means B = 0.5 m. JuPedSim's radii are fixed. Velocity obstacles: here (§5.3.2) \
         an agent chooses among 250 random velocities every 0.1 s; RVO2 solves a linear program in every step, with \
         no limit on the neighbors within the radius, or with the 10 nearest as in its examples, a time horizon of 2 \
         s, and the time step of its examples, 0.25 s. Its preferred velocities are set once. JuPedSim's speed models \
         have no counterpart here. JuPedSim and RVO2 run on one thread. Precision differs, too (mixed: f64, with sums \
         over near pairs in f32)."
    )
}

fn table(rows: &[Row]) -> Table {
    Table::of(rows)
        .column("agents", |row| row.agents)
        .column("engine", |row| row.description.engine.as_str())
        .column("model", |row| row.description.model)
        .column("precision", |row| row.description.precision)
        .fixed("radius [m]", 2, |row| row.description.radius)
        .column("threads", |row| row.description.threads)
        .column("Δt [s]", |row| row.description.time_step)
        .fixed("ms/step", 3, |row| row.ms_per_step.median)
        .range("ms/simulated s", 2, |row| row.ms_per_simulated_second)
        .range("ratio", 2, |row| row.ratio)
        .fixed("mean speed [m/s]", 2, |row| row.mean_speed)
        .table()
}
