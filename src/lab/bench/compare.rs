//! This engine compared with others, on the same crowd.

mod jupedsim;
mod rustsim;

use serde::Serialize;
use serde_json::json;

use super::crowd::Crowd;
use super::pictures::{around, color, dots, sheet};
use super::report::Findings;
use super::timing::{Contender, alternate, failed, going_on};
use super::{Benchmark, Plan};
use crate::analysis::statistics::Range;
use crate::engine::pairs::Precision;
use crate::engine::simulation::Simulation;
use crate::lab::error::LabError;
use crate::lab::machine::Machine;
use crate::output::plot::{Axis, Sheet};
use crate::output::table::Table;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "compare",
    about: "time per step of social forces beside rustsim-crowd and JuPedSim, on the same crowd",
    run,
};

/// The paper's radius of social forces, meters.
const WIDE: f64 = 5.0;
/// Steps per turn; the same number of warm-up steps comes first.
const STEPS: u64 = 10;

/// An engine with one setting.
#[derive(Clone, Serialize)]
struct Description {
    engine: String,
    model: &'static str,
    /// Agents farther away have no effect, meters.
    radius: f64,
    precision: &'static str,
    /// Δt, seconds.
    time_step: f64,
    threads: usize,
}

/// An engine that takes part.
type Entry = (Description, Contender<'static>);

/// The times of one engine.
#[derive(Serialize)]
struct Row {
    #[serde(flatten)]
    description: Description,
    ms_per_step: Range,
    /// Time relative to this engine with the same radius and number of threads.
    ratio: Range,
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Findings, LabError> {
    let agents = plan.choose(10_000, 400);
    let crowd = Crowd::streams(agents, "sf").settled(0)?;
    let threads = Machine::here().hardware_threads;
    let mut notes = vec![differences(agents)];
    let mut others = Vec::new();
    for (engine, joined) in [
        ("rustsim-crowd", rustsim::entries(&crowd, threads)),
        ("JuPedSim", jupedsim::entries(&crowd, &plan.python)),
    ] {
        match joined {
            Ok(mut entries) => others.append(&mut entries),
            Err(missing) => notes.push(format!("{engine} is missing: {missing}")),
        }
    }
    let ours = ours(agents, &others, threads)?;
    let rows = race(ours, others, plan, say)?;
    Ok(Findings {
        table: table(&rows),
        sheet: picture(&rows),
        rows: json!(rows),
        notes,
    })
}

/// Lets all engines take turns. Each is compared with the entry of `ours` that has the same radius and number of
/// threads.
fn race(
    ours: Vec<Entry>,
    others: Vec<Entry>,
    plan: &Plan,
    say: &dyn Fn(&str),
) -> Result<Vec<Row>, LabError> {
    let own = ours.len();
    let (descriptions, mut contenders): (Vec<Description>, Vec<_>) =
        ours.into_iter().chain(others).unzip();
    say(&format!("{} engines and settings", contenders.len()));
    let steps = plan.choose(STEPS, 2);
    alternate(&mut contenders, 1, steps)?; // warm-up: allocates memory
    let times = alternate(&mut contenders, plan.repeats, steps)?;
    let row = |(description, ms): (&Description, &Vec<f64>)| {
        let alike = |ours: &Description| {
            (ours.radius, ours.threads) == (description.radius, description.threads)
        };
        let base = descriptions[..own].iter().position(alike).unwrap_or(0);
        Row {
            description: description.clone(),
            ms_per_step: Range::of(ms),
            ratio: Range::of_ratios(ms, &times[base]),
        }
    };
    Ok(descriptions.iter().zip(&times).map(row).collect())
}

/// This engine with the paper's radius on one thread and on all, and with the settings of the others.
fn ours(agents: u32, others: &[Entry], all: usize) -> Result<Vec<Entry>, LabError> {
    let mut wanted = vec![(WIDE, 1), (WIDE, all)];
    wanted.extend(
        others
            .iter()
            .map(|(other, _)| (other.radius, other.threads)),
    );
    wanted.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    wanted.dedup();
    let entry = |(radius, threads)| {
        let mut crowd = Crowd::streams(agents, "sf");
        crowd.parameters.avoidance_radius = Some(radius);
        let simulation = Simulation::new(crowd.scene()?).map_err(failed)?;
        let description = Description {
            engine: "sandbox".to_owned(),
            model: "social force, elliptical, anticipating, with contact",
            radius,
            precision: match simulation.scene().precision {
                Precision::Double => "f64",
                Precision::Mixed => "mixed",
            },
            time_step: simulation.frame().clock.time_step(),
            threads,
        };
        Ok((description, going_on(simulation, threads)?))
    };
    wanted.into_iter().map(entry).collect()
}

fn differences(agents: u32) -> String {
    format!(
        "The same {agents} agents with the same radii at the same positions at 4 P/m², half of them walking to the right \
         and half to the left, no walls; {STEPS} steps come before the first that count. A step is one step of the engine, \
         whose time steps differ. The models and the precision differ too (mixed: f64, with sums over near pairs in f32). \
         Here (§5.3.1) a force depends on the relative velocity, acts in the field of view only, and agents that touch \
         push; rustsim-crowd has Helbing's circular exponential force without contact; JuPedSim adds Helbing's body force \
         and friction. The radius cuts each force off; rustsim-crowd's follows from the range B of its force (8 B + 1 m), \
         so that 5 m means B = 0.5 m. JuPedSim's is fixed, and it runs on one thread. A ratio is to this engine with the \
         same radius on as many threads, turn by turn."
    )
}

fn table(rows: &[Row]) -> Table {
    Table::of(rows)
        .column("engine", |row| row.description.engine.as_str())
        .column("model", |row| row.description.model)
        .column("precision", |row| row.description.precision)
        .fixed("radius [m]", 2, |row| row.description.radius)
        .column("Δt [s]", |row| row.description.time_step)
        .column("threads", |row| row.description.threads)
        .range("ms/step", 3, |row| row.ms_per_step)
        .range("ratio", 2, |row| row.ratio)
        .table()
}

fn picture(rows: &[Row]) -> Sheet {
    let name = |row: &Row| {
        format!(
            "{}, {} thread(s)",
            row.description.engine, row.description.threads
        )
    };
    let mut names: Vec<String> = Vec::new();
    for name in rows.iter().map(name) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let marks = names.iter().enumerate().flat_map(|(k, engine)| {
        let own = rows.iter().filter(|row| name(row) == *engine);
        let points = own.map(|row| (row.description.radius, row.ms_per_step));
        dots(&points.collect::<Vec<_>>(), color(k), engine)
    });
    let times = rows.iter().map(|row| row.ms_per_step);
    let times = times.flat_map(|range| [range.minimum, range.maximum]);
    let x = Axis::linear("radius [m]", [0.0, 6.0]);
    let y = Axis::log("time per step [ms]", around(times, 1.3));
    sheet(
        "Social forces at 4 P/m², time per step",
        x,
        y,
        marks.collect(),
    )
}
