//! Speed-up over threads.

use serde::Serialize;
use serde_json::json;

use super::benchmark::Benchmark;
use super::crowd::Crowd;
use super::plan::Plan;
use super::report::Timings;
use super::timing::{alternate, going_on};
use crate::error::LabError;
use crate::gallery::{color, medians, single};
use crate::machine::Machine;
use analysis::statistics::Range;
use output::plot::{Axis, GRAY, Mark, Sheet, Style};
use output::table::Table;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "threads",
    about: "speed-up and efficiency of the concert's dense crowd on 1, 2, … all threads",
    run,
};

const SIZES: [u32; 3] = [400, 10_000, 100_000];
/// Frames until the crowd has settled.
const SETTLING: u64 = 50;
/// Agents × frames per repeat; the number of frames is clamped to `FRAMES`.
const AGENT_FRAMES: u64 = 2_000_000;
const FRAMES: [u64; 2] = [20, 2_000];

/// The results for one crowd and number of threads.
#[derive(Serialize)]
struct Speed {
    agents: u32,
    threads: usize,
    /// Frames per repeat.
    frames: u64,
    ms_per_frame: Range,
    /// Speed relative to one thread, turn by turn.
    speed_up: Range,
    /// The median speed-up per thread.
    efficiency: f64,
}

/// The powers of two below `all`, and `all`.
fn counts(all: usize) -> Vec<usize> {
    let doubled = std::iter::successors(Some(1), |count| Some(2 * count));
    let mut counts: Vec<usize> = doubled.take_while(|&count| count < all).collect();
    counts.push(all);
    counts
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Timings, LabError> {
    let counts = counts(Machine::here().hardware_threads);
    let mut rows = Vec::new();
    for &agents in plan.choose(&SIZES[..], &SIZES[..1]) {
        say(&format!("{agents} agents"));
        rows.append(&mut measure(agents, &counts, plan)?);
    }
    Ok(Timings {
        table: table(&rows),
        sheet: picture(&rows, &counts),
        rows: json!(rows),
        notes: vec![
            "The crowd of `scaling`. Every number of threads moves its own copy, and the copies take turns; speed-ups \
             are ratios of times in the same turn. A small crowd is a single task, for which no thread is woken."
                .to_owned(),
        ],
    })
}

fn measure(agents: u32, counts: &[usize], plan: &Plan) -> Result<Vec<Speed>, LabError> {
    let crowd = Crowd::concert(agents).settled(plan.choose(SETTLING, 5))?;
    let frames = plan.frames(agents, AGENT_FRAMES, FRAMES);
    let begun = counts
        .iter()
        .map(|&threads| going_on(crowd.clone(), threads));
    let mut contenders = begun.collect::<Result<Vec<_>, _>>()?;
    alternate(&mut contenders, 1, frames)?; // warm-up: fills the caches
    let times = alternate(&mut contenders, plan.repeats, frames)?;
    let row = |(&threads, ms): (&usize, &Vec<f64>)| {
        let speed_up = Range::of_ratios(&times[0], ms);
        Speed {
            agents,
            threads,
            frames,
            ms_per_frame: Range::of(ms),
            speed_up,
            efficiency: speed_up.median / threads as f64,
        }
    };
    Ok(counts.iter().zip(&times).map(row).collect())
}

fn table(rows: &[Speed]) -> Table {
    Table::of(rows)
        .column("agents", |row| row.agents)
        .column("threads", |row| row.threads)
        .range("ms/frame", 4, |row| row.ms_per_frame)
        .range("speed-up", 2, |row| row.speed_up)
        .fixed("efficiency [%]", 0, |row| 100.0 * row.efficiency)
        .table()
}

fn picture(rows: &[Speed], counts: &[usize]) -> Sheet {
    let all = counts.last().map_or(1.0, |&count| count as f64);
    let ideal = Style::broken(GRAY, 0.8, "ideal");
    let mut marks = vec![Mark::line([[1.0, 1.0], [all, all]], ideal)];
    for (k, size) in rows.chunk_by(|a, b| a.agents == b.agents).enumerate() {
        let points = size.iter().map(|row| (row.threads as f64, row.speed_up));
        let label = format!("{} agents", size[0].agents);
        marks.extend(medians(&points.collect::<Vec<_>>(), color(k), &label));
    }
    let speed_ups = rows.iter().map(|row| row.speed_up.maximum);
    let most = 1.1 * speed_ups.fold(all, f64::max);
    let ticks = counts.iter().map(|&k| (k as f64, k.to_string()));
    let x = Axis::linear("threads", [0.8, all + 0.2]).ticked(ticks);
    let y = Axis::linear("times as fast as on one thread", [0.0, most]);
    single("Speed-up over threads, a crowd at 5 P/m²", x, y, marks)
}
