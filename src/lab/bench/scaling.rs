//! Frame time and memory per agent against the number of agents.

use serde::Serialize;
use serde_json::json;

use super::crowd::Crowd;
use super::plan::{Benchmark, Plan};
use super::report::Findings;
use super::timing::ms_per_frame;
use crate::analysis::statistics::Range;
use crate::lab::error::LabError;
use crate::lab::gallery::{around, color, medians, single};
use crate::lab::machine::Resident;
use crate::output::plot::{Axis, Mark, Sheet, Style};
use crate::output::table::Table;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "scaling",
    about: "time per agent and frame, and memory per agent, of the concert's dense crowd at several sizes",
    run,
};

const SIZES: [u32; 9] = [
    1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000,
];
/// The size that the others are compared with.
const REFERENCE: u32 = 10_000;
/// Frames until the crowd has settled: 2 s.
const SETTLING: u64 = 100;
/// Agents × frames per repeat; the number of frames is clamped to `FRAMES`.
const AGENT_FRAMES: u64 = 3_000_000;
const FRAMES: [u64; 2] = [15, 1_000];

/// The results for one size.
#[derive(Serialize)]
struct Size {
    agents: u32,
    /// Frames per repeat.
    frames: u64,
    ns_per_agent_frame: Range,
    ms_per_frame: Range,
    /// Median time per agent relative to that of 10,000 agents.
    ratio_to_10000: Option<f64>,
    resident_bytes_per_agent: Option<f64>,
    peak_bytes_per_agent: Option<f64>,
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Findings, LabError> {
    let before = Resident::read();
    let largest = plan.choose(plan.largest, plan.largest.min(REFERENCE));
    let mut rows = Vec::new();
    for agents in SIZES.into_iter().filter(|&agents| agents <= largest) {
        say(&format!("{agents} agents"));
        rows.push(measure(agents, plan, before)?);
    }
    let median = |row: &Size| row.ns_per_agent_frame.median;
    let reference = rows.iter().find(|row| row.agents == REFERENCE).map(median);
    for row in &mut rows {
        row.ratio_to_10000 = reference.map(|reference| median(row) / reference);
    }
    let memory = "Memory is what the process holds with the crowd running, and at its peak, minus what it held before \
                  the first crowd. It includes the program and its threads: below about 100,000 agents it means \
                  little.";
    let unknown =
        "The memory of a process is read from /proc/self/status, which this system does not have.";
    let memory = if before.is_some() { memory } else { unknown };
    Ok(Findings {
        table: table(&rows),
        sheet: picture(&rows),
        rows: json!(rows),
        notes: vec![
            "sph, μ = 5, K^goal = 0.1, a hexagonal grid with jitter at 5 P/m²; the goal of each agent is its own \
             position; timed from 2 s on."
                .to_owned(),
            memory.to_owned(),
        ],
    })
}

fn measure(agents: u32, plan: &Plan, before: Option<Resident>) -> Result<Size, LabError> {
    let peak_before = Resident::read();
    let mut simulation = Crowd::concert(agents).settled(plan.choose(SETTLING, 5))?;
    let frames = plan.frames(agents, AGENT_FRAMES, FRAMES);
    let times = (0..plan.repeats).map(|_| ms_per_frame(&mut simulation, frames));
    let ms_per_frame = Range::of(&times.collect::<Result<Vec<f64>, _>>()?);
    let now = Resident::read();
    let per_agent = |bytes: u64| bytes as f64 / f64::from(agents);
    let resident = before.zip(now);
    let resident = resident.map(|(b, n)| per_agent(n.now.saturating_sub(b.now)));
    // A crowd that needs no more memory than an earlier one has no peak of its own.
    let peak = before.zip(peak_before.zip(now));
    let peak = peak.filter(|(_, (then, now))| now.peak > then.peak);
    Ok(Size {
        agents,
        frames,
        ns_per_agent_frame: ms_per_frame.times(1e6 / f64::from(agents)),
        ms_per_frame,
        ratio_to_10000: None,
        resident_bytes_per_agent: resident,
        peak_bytes_per_agent: peak.map(|(b, (_, n))| per_agent(n.peak - b.now)),
    })
}

fn table(rows: &[Size]) -> Table {
    Table::of(rows)
        .column("agents", |row| row.agents)
        .column("frames", |row| row.frames)
        .range("ns/agent", 2, |row| row.ns_per_agent_frame)
        .range("ms/frame", 4, |row| row.ms_per_frame)
        .fixed("to 10,000", 2, |row| row.ratio_to_10000)
        .fixed("bytes/agent", 0, |row| row.resident_bytes_per_agent)
        .fixed("at peak", 0, |row| row.peak_bytes_per_agent)
        .table()
}

fn picture(rows: &[Size]) -> Sheet {
    let point = |row: &Size| (f64::from(row.agents), row.ns_per_agent_frame);
    let points: Vec<(f64, Range)> = rows.iter().map(point).collect();
    let mut marks = medians(&points, color(0), "median");
    let range = Style::full(color(0), 0.8, "minimum to maximum");
    marks.push(Mark::line([], range));
    let most = points.iter().map(|(_, range)| range.maximum);
    let times = [0.0, 1.1 * most.fold(1.0, f64::max)];
    let x = Axis::log("agents", around(points.iter().map(|point| point.0), 1.3));
    let y = Axis::linear("time per agent and frame [ns]", times);
    single("Time per agent and frame, a crowd at 5 P/m²", x, y, marks)
}
