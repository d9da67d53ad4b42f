//! Frame time and memory per agent against the number of agents.

use serde::Serialize;
use serde_json::json;

use super::crowd::Crowd;
use super::error::BenchError;
use super::machine::Memory;
use super::report::{Findings, three};
use super::timing::ms_per_frame;
use super::{Benchmark, Plan};
use crate::analysis::statistics::Range;
use crate::output::table::OldTable as Table;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "scaling",
    about: "time per agent and frame, and memory per agent, of the concert's dense crowd at several sizes",
    run,
};

const SIZES: [u32; 7] = [1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000];
/// The size that the others are compared with.
const REFERENCE: u32 = 10_000;
/// Frames until the crowd has settled: 2 s.
const SETTLING: u64 = 100;
/// Agents × frames per repeat; the number of frames is clamped to `FRAMES`.
const AGENT_FRAMES: u64 = 3_000_000;
const FRAMES: [u64; 2] = [15, 1_000];

/// The results for one size.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Row {
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

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Findings, BenchError> {
    let before = Memory::now();
    let largest = plan.choose(plan.largest, plan.largest.min(REFERENCE));
    let mut rows = Vec::new();
    for agents in SIZES.into_iter().filter(|&agents| agents <= largest) {
        say(&format!("{agents} agents"));
        rows.push(measure(agents, plan, before)?);
    }
    let median = |row: &Row| row.ns_per_agent_frame.median;
    let reference = rows.iter().find(|row| row.agents == REFERENCE).map(median);
    for row in &mut rows {
        row.ratio_to_10000 = reference.map(|reference| median(row) / reference);
    }
    Ok(Findings {
        table: table(&rows),
        rows: json!(rows),
        notes: notes(before),
        sheet: picture::sheet(&rows),
    })
}

fn measure(agents: u32, plan: &Plan, before: Option<Memory>) -> Result<Row, BenchError> {
    let peak_before = Memory::now();
    let mut simulation = Crowd::concert(agents).settled(plan.choose(SETTLING, 5))?;
    let [fewest, most] = FRAMES;
    let usual = (AGENT_FRAMES / u64::from(agents)).clamp(fewest, most);
    let frames = plan.choose(usual, 5);
    let times: Result<Vec<f64>, _> = (0..plan.repeats)
        .map(|_| ms_per_frame(&mut simulation, frames))
        .collect();
    let ms_per_frame = Range::of(&times?);
    let now = Memory::now();
    let per_agent = |bytes: u64| bytes as f64 / f64::from(agents);
    let resident = before.zip(now);
    let resident = resident.map(|(b, n)| per_agent(n.resident.saturating_sub(b.resident)));
    // A crowd that needs no more memory than an earlier one has no peak of its own.
    let peak = before.zip(peak_before.zip(now));
    let peak = peak.filter(|(_, (then, now))| now.peak > then.peak);
    Ok(Row {
        agents,
        frames,
        ns_per_agent_frame: ms_per_frame.times(1e6 / f64::from(agents)),
        ms_per_frame,
        ratio_to_10000: None,
        resident_bytes_per_agent: resident,
        peak_bytes_per_agent: peak.map(|(b, (_, n))| per_agent(n.peak - b.resident)),
    })
}

fn table(rows: &[Row]) -> Table {
    let head = [
        "agents",
        "frames",
        "ns/agent min",
        "median",
        "max",
        "ms/frame min",
        "median",
        "max",
        "to 10,000",
        "bytes/agent",
        "at peak",
    ];
    let mut table = Table::new(0, &head);
    let or_dash = |value: Option<f64>, digits: usize| {
        value.map_or_else(|| "–".to_owned(), |value| format!("{value:.digits$}"))
    };
    for row in rows {
        let mut cells = vec![row.agents.to_string(), row.frames.to_string()];
        cells.extend(three(&row.ns_per_agent_frame, 2));
        cells.extend(three(&row.ms_per_frame, 4));
        cells.extend([
            or_dash(row.ratio_to_10000, 2),
            or_dash(row.resident_bytes_per_agent, 0),
            or_dash(row.peak_bytes_per_agent, 0),
        ]);
        table.rows.push(cells);
    }
    table
}

fn notes(memory: Option<Memory>) -> Vec<String> {
    let crowd = "sph, μ = 5, K^goal = 0.1, a hexagonal grid with jitter at 5 P/m², everybody's goal the own place, \
                 timed from 2 s on.";
    let mut notes = vec![crowd.to_owned()];
    notes.push(match memory {
        Some(_) => "Memory is what the process holds with the crowd running, and at its peak, less what it held before the \
                    first crowd, program and threads included: below some 100,000 agents it says little."
            .to_owned(),
        None => "How much memory a process holds is read from /proc/self/status, which this system does not have.".to_owned(),
    });
    notes
}

mod picture {
    use super::Row;
    use crate::lab::bench::pictures::{self, around, color, dotted, range};
    use crate::output::plot::{Axis, Sheet};

    pub fn sheet(rows: &[Row]) -> Sheet {
        let agents = |row: &Row| f64::from(row.agents);
        let medians: Vec<[f64; 2]> = rows
            .iter()
            .map(|row| [agents(row), row.ns_per_agent_frame.median])
            .collect();
        let mut marks = dotted(&medians, color(0), "median").to_vec();
        marks.extend(rows.iter().map(|row| {
            let spread = row.ns_per_agent_frame;
            range(agents(row), [spread.minimum, spread.maximum], color(0))
        }));
        marks.push(crate::output::plot::Mark::Line(
            Vec::new(),
            crate::output::plot::Style::full(color(0), 0.8, "least to greatest"),
        ));
        let most = rows.iter().map(|row| row.ns_per_agent_frame.maximum);
        let most = most.fold(1.0, f64::max);
        pictures::sheet(
            "Time per agent and frame, a crowd at 5 P/m²".to_owned(),
            Axis::log("agents", around(rows.iter().map(agents), 1.3)),
            Axis::linear("time per agent and frame [ns]", [0.0, 1.1 * most]),
            marks,
        )
    }
}
