//! This engine beside others, on the same crowd.

mod jupedsim;
mod rustsim;

use serde::Serialize;
use serde_json::json;

use super::crowd::Crowd;
use super::error::BenchError;
use super::machine::Machine;
use super::report::{Findings, Table};
use super::spread::{Spread, ratios};
use super::timing::{Contender, GoingOn, alternate, pool};
use super::{Benchmark, Plan};
use crate::agents::Agents;
use crate::simulation::Simulation;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "compare",
    about: "time per step of social forces beside rustsim-crowd and JuPedSim, on the same crowd",
    run,
};

/// The paper's radius of social forces, metres.
const WIDE: f64 = 5.0;

/// One engine with one setting.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Description {
    engine: String,
    model: &'static str,
    /// Others farther away do not count, metres.
    radius: f64,
    precision: &'static str,
    /// Seconds.
    time_step: f64,
    threads: usize,
}

/// Somebody to compare.
struct Entry {
    description: Description,
    contender: Box<dyn Contender>,
}

/// What an engine can be given: where everybody is, how wide, and where to.
struct Start<'a> {
    agents: &'a Agents,
    /// m/s.
    preferred_speed: f64,
    /// m/s.
    max_speed: f64,
    /// All threads of the machine.
    threads: usize,
}

/// One engine's times.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Row {
    #[serde(flatten)]
    description: Description,
    ms_per_step: Spread,
    /// How many times as long it takes as this engine with the same radius on as many threads.
    ratio: Spread,
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Findings, BenchError> {
    let agents = plan.choose(10_000, 400);
    let crowd = Crowd::streams(agents, "sf").settled(0)?;
    let start = Start {
        agents: crowd.frame().agents,
        preferred_speed: crowd.scene().preferred_speed,
        max_speed: crowd.scene().max_speed,
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
            Err(missing) => {
                say(&format!("without {engine}: {missing}"));
                notes.push(format!("{engine} is missing: {missing}"));
            }
        }
    }
    let mut entries = ours(agents, &others, start.threads)?;
    let own = entries.len();
    entries.append(&mut others);
    let (descriptions, mut contenders): (Vec<_>, Vec<_>) = entries
        .into_iter()
        .map(|entry| (entry.description, entry.contender))
        .unzip();
    say(&format!(
        "{agents} agents, {} engines and settings",
        contenders.len()
    ));
    alternate(&mut contenders, 1, plan.choose(10, 2))?;
    let times = alternate(&mut contenders, plan.repeats, plan.choose(10, 2))?;
    let base = |of: &Description| {
        let same = |d: &Description| (d.radius, d.threads) == (of.radius, of.threads);
        descriptions[..own].iter().position(same).unwrap_or(0)
    };
    let row = |(description, ms): (&Description, &Vec<f64>)| Row {
        description: description.clone(),
        ms_per_step: Spread::of(ms),
        ratio: Spread::of(&ratios(ms, &times[base(description)])),
    };
    let rows: Vec<Row> = descriptions.iter().zip(&times).map(row).collect();
    Ok(Findings {
        table: table(&rows),
        rows: json!(rows),
        notes,
        #[cfg(feature = "plot")]
        sheet: picture::sheet(&rows),
    })
}

/// This engine with the paper's radius on one and on all threads, and as the others are set.
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
                precision: "f64, contact f32",
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
         and half to the left, no walls; ten steps before the first that count. A step is a step of the engine's own length. \
         What differs: the models. Here (§5.3.1) a force depends on the relative velocity, in the field of view only, and \
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
        cells.extend(row.ms_per_step.cells(3));
        cells.extend(row.ratio.cells(2));
        table.rows.push(cells);
    }
    table
}

#[cfg(feature = "plot")]
mod picture {
    use super::Row;
    use crate::bench::pictures::{self, around, color};
    use crate::plot::{Axis, Mark, Point, Sheet, Style};

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
        let times = rows.iter().map(|row| row.ms_per_step.median);
        pictures::sheet(
            "Social forces at 4 P/m², time per step".to_owned(),
            Axis::linear("radius [m]", [0.0, 6.0]),
            Axis::log("time per step [ms]", around(times, 1.5)),
            marks,
        )
    }
}
