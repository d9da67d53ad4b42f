//! This engine compared with others, on the same crowd.

mod jupedsim;
mod rustsim;

use serde::Serialize;
use serde_json::json;

use super::crowd::Crowd;
use super::error::BenchError;
use super::machine::Machine;
use super::report::{Findings, three};
use super::timing::{Contender, GoingOn, alternate, pool};
use super::{Benchmark, Plan};
use crate::analysis::statistics::Range;
use crate::engine::agents::Agents;
use crate::engine::pairs::Precision;
use crate::engine::scene::Scene;
use crate::engine::simulation::Simulation;
use crate::output::table::OldTable as Table;

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
#[derive(Debug, Clone, PartialEq, Serialize)]
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
struct Entry {
    description: Description,
    contender: Box<dyn Contender>,
}

/// The initial state that every engine starts from.
struct Start<'a> {
    scene: &'a Scene,
    agents: &'a Agents,
    /// The machine's hardware threads.
    threads: usize,
}

/// The times of one engine.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Row {
    #[serde(flatten)]
    description: Description,
    ms_per_step: Range,
    /// Time relative to this engine with the same radius and number of threads.
    ratio: Range,
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Findings, BenchError> {
    let agents = plan.choose(10_000, 400);
    let crowd = Crowd::streams(agents, "sf").settled(0)?;
    let start = Start {
        scene: crowd.scene(),
        agents: crowd.frame().agents,
        threads: Machine::here().hardware_threads,
    };
    let mut notes = vec![differences(agents)];
    let mut others = Vec::new();
    for (engine, joined) in [
        ("rustsim-crowd", rustsim::entries(&start)),
        ("JuPedSim", jupedsim::entries(&start, &plan.python)),
    ] {
        match joined {
            Ok(mut entries) => others.append(&mut entries),
            Err(missing) => notes.push(format!("{engine} is missing: {missing}")),
        }
    }
    let ours = ours(agents, &others, start.threads)?;
    let rows = race(ours, others, plan, say)?;
    Ok(Findings {
        table: table(&rows),
        rows: json!(rows),
        notes,
        sheet: picture::sheet(&rows),
    })
}

/// Lets all engines take turns. Each is compared with the entry of `ours` that has the same radius and number of
/// threads.
fn race(
    ours: Vec<Entry>,
    others: Vec<Entry>,
    plan: &Plan,
    say: &dyn Fn(&str),
) -> Result<Vec<Row>, BenchError> {
    let own = ours.len();
    let entries = ours.into_iter().chain(others);
    let (descriptions, mut contenders): (Vec<Description>, Vec<_>) = entries
        .map(|entry| (entry.description, entry.contender))
        .unzip();
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
fn ours(agents: u32, others: &[Entry], all: usize) -> Result<Vec<Entry>, BenchError> {
    let mut wanted = vec![(WIDE, 1), (WIDE, all)];
    wanted.extend(
        others
            .iter()
            .map(|entry| (entry.description.radius, entry.description.threads)),
    );
    wanted.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    wanted.dedup();
    let entry = |(radius, threads)| {
        let mut crowd = Crowd::streams(agents, "sf");
        crowd.parameters.avoidance_radius = Some(radius);
        let simulation = Simulation::new(crowd.scene()?)?;
        Ok(Entry {
            description: Description {
                engine: "sandbox".to_owned(),
                model: "social force, elliptical, anticipating, with contact",
                radius,
                precision: match simulation.scene().precision {
                    Precision::Double => "f64",
                    Precision::Mixed => "mixed",
                },
                time_step: simulation.frame().clock.time_step(),
                threads,
            },
            contender: Box::new(GoingOn {
                simulation,
                pool: pool(threads)?,
            }),
        })
    };
    wanted.into_iter().map(entry).collect()
}

fn differences(agents: u32) -> String {
    format!(
        "The same {agents} people with the same radii from the same places at 4 P/m², half of them on their way to the right \
         and half to the left, no walls; {STEPS} steps come before the first that count. A step is a step of the engine's own length. \
         What differs: the models, and the numbers (mixed: f64, with sums over near pairs in f32). Here (§5.3.1) a force depends on the relative velocity, in the field of view only, and \
         people who touch push; rustsim-crowd has Helbing's circular exponential force without contact; JuPedSim adds \
         Helbing's body force and friction. The radius cuts each force off; rustsim-crowd's follows from the range B of its \
         force (8 B + 1 m), of which 5 m makes 0.5 m. JuPedSim's is fixed, and it runs on one thread. A ratio is to this \
         engine with the same radius on as many threads, turn by turn."
    )
}

fn table(rows: &[Row]) -> Table {
    let head = [
        "engine",
        "model",
        "precision",
        "radius m",
        "dt s",
        "threads",
        "ms/step min",
        "median",
        "max",
        "ratio min",
        "median",
        "max",
    ];
    let mut table = Table::new(3, &head);
    for row in rows {
        let engine = &row.description;
        let mut cells = vec![
            engine.engine.clone(),
            engine.model.to_owned(),
            engine.precision.to_owned(),
            format!("{:.2}", engine.radius),
            engine.time_step.to_string(),
            engine.threads.to_string(),
        ];
        cells.extend(three(&row.ms_per_step, 3));
        cells.extend(three(&row.ratio, 2));
        table.rows.push(cells);
    }
    table
}

mod picture {
    use super::Row;
    use crate::lab::bench::pictures::{self, around, color, range};
    use crate::output::plot::{Axis, Mark, Point, Sheet, Style};

    pub fn sheet(rows: &[Row]) -> Sheet {
        let mut marks: Vec<Mark> = Vec::new();
        let mut engines: Vec<(&str, usize)> = Vec::new();
        for row in rows {
            let engine = (row.description.engine.as_str(), row.description.threads);
            if !engines.contains(&engine) {
                engines.push(engine);
            }
        }
        for (k, &(engine, threads)) in engines.iter().enumerate() {
            let own = rows.iter().filter(|row| {
                (row.description.engine.as_str(), row.description.threads) == (engine, threads)
            });
            marks.extend(own.clone().map(|row| {
                let spread = row.ms_per_step;
                let ends = [spread.minimum, spread.maximum];
                range(row.description.radius, ends, color(k))
            }));
            let points = own.map(|row| Point {
                x: row.description.radius,
                y: row.ms_per_step.median,
                error: 0.0,
            });
            let label = format!("{engine}, {threads} thread(s)");
            marks.push(Mark::Points(
                points.collect(),
                Style::full(color(k), 3.0, &label),
            ));
        }
        let spreads = rows.iter().map(|row| row.ms_per_step);
        let times = spreads.flat_map(|spread| [spread.minimum, spread.maximum]);
        pictures::sheet(
            "Social forces at 4 P/m², time per step".to_owned(),
            Axis::linear("radius [m]", [0.0, 6.0]),
            Axis::log("time per step [ms]", around(times, 1.3)),
            marks,
        )
    }
}
