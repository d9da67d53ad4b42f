//! Frame time and memory per agent against the number of agents.

use serde::Serialize;
use serde_json::json;

use super::benchmark::Benchmark;
use super::crowd::Crowd;
use super::plan::Plan;
use super::report::Timings;
use super::timing::{failed, ms_of, ms_per_frame};
use crate::error::LabError;
use crate::gallery::{around, color, medians, single};
use crate::machine::Resident;
use analysis::statistics::Range;
use engine::clock::{Clock, PAPER_TIME_STEP};
use engine::scene::Integrator;
use engine::simulation::{Simulation, Stage};
use output::plot::{Axis, Mark, Sheet};
use output::table::Table;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "scaling",
    about: "time per agent and frame, and memory per agent, of crowds of several sizes, at rest and walking",
    run,
};

const SIZES: [u32; 9] = [
    1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000,
];
/// The size that the others are compared with.
const REFERENCE: u32 = 10_000;
/// The time until a crowd has settled, seconds.
const SETTLING_SECS: f64 = 2.0;
/// Agents × frames per repeat; the number of frames is clamped to `FRAMES`.
const AGENT_FRAMES: u64 = 3_000_000;
const FRAMES: [u64; 2] = [15, 1_000];

/// The sizes of crowds that walk.
const WALKING: [u32; 3] = [10_000, 100_000, 1_000_000];

/// A crowd that is measured at several sizes.
struct Kind {
    name: &'static str,
    crowd: fn(u32) -> Crowd,
    integrator: Integrator,
    /// Seconds.
    time_step: f64,
    sizes: &'static [u32],
}

impl Kind {
    const fn walking(name: &'static str, crowd: fn(u32) -> Crowd) -> Self {
        Self {
            name,
            crowd,
            integrator: Integrator::SemiImplicit,
            time_step: PAPER_TIME_STEP,
            sizes: &WALKING,
        }
    }
}

/// At rest, and walking with the paper's numerics, those of `preset=fast`, and laws fitted to experiments.
const KINDS: [Kind; 6] = [
    Kind {
        sizes: &SIZES,
        ..Kind::walking(AT_REST, Crowd::concert)
    },
    Kind::walking("sph, 2 P/m²", |agents| Crowd::walkers(agents, 2.0, "sph")),
    Kind::walking("sph, 5 P/m²", |agents| Crowd::walkers(agents, 5.0, "sph")),
    Kind {
        integrator: Integrator::VelocityVerlet,
        time_step: FAST_TIME_STEP,
        ..Kind::walking("sph, 5 P/m², fast", |agents| {
            Crowd::walkers(agents, 5.0, "sph")
        })
    },
    Kind::walking("walk+sph, 2 P/m²", |agents| {
        Crowd::walkers(agents, 2.0, "walk+sph")
    }),
    Kind::walking("steer+sph, 2 P/m²", |agents| {
        Crowd::walkers(agents, 2.0, "steer+sph")
    }),
];
/// The crowd at rest.
const AT_REST: &str = "at rest, 5 P/m²";
/// The time step of `preset=fast` for these crowds, seconds.
const FAST_TIME_STEP: f64 = 0.05;

/// The results for one size.
#[derive(Serialize)]
struct Size {
    crowd: &'static str,
    agents: u32,
    /// Frames per repeat.
    frames: u64,
    ns_per_agent_frame: Range,
    ms_per_frame: Range,
    /// Median time per agent relative to that of 10,000 agents of the same kind.
    ratio_to_10000: Option<f64>,
    /// Median time relative to that of as many agents at rest.
    ratio_to_rest: Option<f64>,
    /// Simulated seconds per second of computing.
    real_time_factor: f64,
    /// The part of a frame in which agents are sorted and listed.
    sorts_and_lists: f64,
    resident_bytes_per_agent: Option<f64>,
    peak_bytes_per_agent: Option<f64>,
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Timings, LabError> {
    let before = Resident::read();
    let largest = plan.choose(plan.largest, plan.largest.min(REFERENCE));
    let mut rows: Vec<Size> = Vec::new();
    for kind in &KINDS {
        for &agents in kind.sizes.iter().filter(|&&agents| agents <= largest) {
            say(&format!("{}, {agents} agents", kind.name));
            rows.push(measure(kind, agents, plan, before)?);
        }
    }
    let median = |crowd: &str, agents: u32| {
        let mut rows = rows.iter();
        let row = rows.find(|row| row.crowd == crowd && row.agents == agents);
        row.map(|row| row.ns_per_agent_frame.median)
    };
    let computed = rows.iter().map(|row| {
        let own = row.ns_per_agent_frame.median;
        let to = |other: Option<f64>| other.map(|other| own / other);
        let reference = median(row.crowd, REFERENCE);
        [to(reference), to(median(AT_REST, row.agents))]
    });
    let ratios: Vec<_> = computed.collect();
    for (row, ratios) in rows.iter_mut().zip(ratios) {
        [row.ratio_to_10000, row.ratio_to_rest] = ratios;
    }
    let words = "Memory is what the process holds with the crowd running, and at its peak, minus what it held before \
                  the first crowd. It includes the program and its threads: below about 100,000 agents it means \
                  little.";
    let unknown =
        "The memory of a process is read from /proc/self/status, which this system does not have.";
    let memory = if before.is_some() { words } else { unknown };
    Ok(Timings {
        table: table(&rows),
        sheet: picture(&rows),
        rows: json!(rows),
        notes: vec![
            "Hexagonal grids with jitter; timed from 2 s on. At rest: sph, μ = 5, K^goal = 0.1, the goal of each agent \
             is its own position. The others walk to the right, all at a preferred speed of 1.34 m/s, in steps of \
             0.02 s; fast: velocity Verlet, 0.05 s."
                .to_owned(),
            memory.to_owned(),
        ],
    })
}

fn measure(
    kind: &Kind,
    agents: u32,
    plan: &Plan,
    before: Option<Resident>,
) -> Result<Size, LabError> {
    let peak_before = Resident::read();
    let mut scene = (kind.crowd)(agents).scene()?;
    scene.integrator = kind.integrator;
    scene.clock = Clock::new(kind.time_step, Clock::nearest_coarse_every(kind.time_step));
    let mut simulation = Simulation::new(scene).map_err(failed)?;
    let settling = (SETTLING_SECS / kind.time_step).round() as u64;
    ms_per_frame(&mut simulation, plan.choose(settling, 5))?;
    simulation.reset_stages();
    let frames = plan.frames(agents, AGENT_FRAMES, FRAMES);
    let times = (0..plan.repeats).map(|_| ms_per_frame(&mut simulation, frames));
    let ms_per_frame = Range::of(&times.collect::<Result<Vec<f64>, _>>()?);
    let now = Resident::read();
    let per_agent = |bytes: u64| bytes as f64 / f64::from(agents);
    let both = before.zip(now);
    let resident = both.map(|(b, n)| per_agent(n.now.saturating_sub(b.now)));
    // A crowd that needs no more memory than an earlier one has no peak of its own.
    let peaks = before.zip(peak_before.zip(now));
    let peak = peaks.filter(|(_, (then, now))| now.peak > then.peak);
    let stages = simulation.stages();
    let listing = [Stage::Sort, Stage::Neighbors].map(|stage| ms_of(stages, stage));
    Ok(Size {
        crowd: kind.name,
        agents,
        frames,
        ns_per_agent_frame: ms_per_frame.times(1e6 / f64::from(agents)),
        ms_per_frame,
        ratio_to_10000: None,
        ratio_to_rest: None,
        real_time_factor: 1e3 * kind.time_step / ms_per_frame.median,
        sorts_and_lists: listing.iter().sum::<f64>() / stages.total_ms_per_frame(),
        resident_bytes_per_agent: resident,
        peak_bytes_per_agent: peak.map(|(b, (_, n))| per_agent(n.peak - b.now)),
    })
}

fn table(rows: &[Size]) -> Table {
    Table::of(rows)
        .column("crowd", |row| row.crowd)
        .column("agents", |row| row.agents)
        .column("frames", |row| row.frames)
        .range("ns/agent", 2, |row| row.ns_per_agent_frame)
        .range("ms/frame", 4, |row| row.ms_per_frame)
        .fixed("to 10,000", 2, |row| row.ratio_to_10000)
        .fixed("to at rest", 2, |row| row.ratio_to_rest)
        .fixed("of real time", 2, |row| row.real_time_factor)
        .fixed("sorts, lists [%]", 0, |row| 100.0 * row.sorts_and_lists)
        .fixed("bytes/agent", 0, |row| row.resident_bytes_per_agent)
        .fixed("at peak", 0, |row| row.peak_bytes_per_agent)
        .table()
}

fn picture(rows: &[Size]) -> Sheet {
    let point = |row: &Size| (f64::from(row.agents), row.ns_per_agent_frame);
    let drawn = KINDS.iter().enumerate().flat_map(|(k, kind)| {
        let own = rows.iter().filter(|row| row.crowd == kind.name);
        medians(&own.map(point).collect::<Vec<_>>(), color(k), kind.name)
    });
    let marks: Vec<Mark> = drawn.collect();
    let points = rows.iter().map(point);
    let most = points.clone().map(|(_, range)| range.maximum);
    let times = [0.0, 1.1 * most.fold(1.0, f64::max)];
    let x = Axis::log("agents", around(points.map(|point| point.0), 1.3));
    let y = Axis::linear("time per agent and frame [ns]", times);
    single("Time per agent and frame", x, y, marks)
}
