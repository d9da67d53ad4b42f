//! Speed-up over threads.

use serde::Serialize;
use serde_json::json;

use super::crowd::Crowd;
use super::error::BenchError;
use super::machine::Machine;
use super::report::{Findings, three};
use super::timing::{Contender, GoingOn, alternate, pool};
use super::{Benchmark, Plan};
use crate::analysis::statistics::Range;
use crate::output::table::OldTable as Table;

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
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Row {
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

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Findings, BenchError> {
    let counts = counts(Machine::here().hardware_threads);
    let mut rows = Vec::new();
    for agents in plan.choose(&SIZES[..], &SIZES[..1]) {
        say(&format!("{agents} agents"));
        rows.append(&mut measure(*agents, &counts, plan)?);
    }
    Ok(Findings {
        table: table(&rows),
        rows: json!(rows),
        notes: vec![
            "The crowd of `scaling`. Every number of threads moves its own copy, and they take turns; speed-ups are of each \
             turn's times. Few agents are one piece of work, and no thread is woken for them."
                .to_owned(),
        ],
        sheet: picture::sheet(&rows),
    })
}

fn measure(agents: u32, counts: &[usize], plan: &Plan) -> Result<Vec<Row>, BenchError> {
    let crowd = Crowd::concert(agents).settled(plan.choose(SETTLING, 5))?;
    let [fewest, most] = FRAMES;
    let usual = (AGENT_FRAMES / u64::from(agents)).clamp(fewest, most);
    let frames = plan.choose(usual, 5);
    let mut contenders: Vec<Box<dyn Contender>> = Vec::new();
    for &threads in counts {
        contenders.push(Box::new(GoingOn {
            simulation: crowd.clone(),
            pool: pool(threads)?,
        }));
    }
    alternate(&mut contenders, 1, frames)?; // warm-up: fills the caches
    let times = alternate(&mut contenders, plan.repeats, frames)?;
    let row = |(&threads, ms): (&usize, &Vec<f64>)| {
        let speed_up = Range::of_ratios(&times[0], ms);
        Row {
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

fn table(rows: &[Row]) -> Table {
    let head = [
        "agents",
        "threads",
        "ms/frame min",
        "median",
        "max",
        "speed-up min",
        "median",
        "max",
        "efficiency",
    ];
    let mut table = Table::new(0, &head);
    for row in rows {
        let mut cells = vec![row.agents.to_string(), row.threads.to_string()];
        cells.extend(three(&row.ms_per_frame, 4));
        cells.extend(three(&row.speed_up, 2));
        cells.push(format!("{:.0} %", 100.0 * row.efficiency));
        table.rows.push(cells);
    }
    table
}

mod picture {
    use super::Row;
    use crate::lab::bench::pictures::{self, color, dotted, range};
    use crate::output::plot::{Axis, GRAY, Mark, Sheet, Style};

    pub fn sheet(rows: &[Row]) -> Sheet {
        let all = rows
            .iter()
            .map(|row| row.threads as f64)
            .fold(1.0, f64::max);
        let ideal = vec![[1.0, 1.0], [all, all]];
        let mut marks = vec![Mark::Line(ideal, Style::broken(GRAY, 0.8, "ideal"))];
        for (k, size) in rows.chunk_by(|a, b| a.agents == b.agents).enumerate() {
            let points: Vec<[f64; 2]> = size
                .iter()
                .map(|row| [row.threads as f64, row.speed_up.median])
                .collect();
            let label = format!("{} agents", size[0].agents);
            marks.extend(dotted(&points, color(k), &label));
            marks.extend(size.iter().map(|row| {
                let spread = row.speed_up;
                range(
                    row.threads as f64,
                    [spread.minimum, spread.maximum],
                    color(k),
                )
            }));
        }
        let most = rows
            .iter()
            .map(|row| row.speed_up.maximum)
            .fold(all, f64::max);
        let mut x = Axis::linear("threads", [0.8, all + 0.2]);
        let mut counts: Vec<usize> = rows.iter().map(|row| row.threads).collect();
        counts.dedup();
        counts.sort_unstable();
        counts.dedup();
        x.ticks = counts
            .into_iter()
            .map(|count| (count as f64, count.to_string()))
            .collect();
        pictures::sheet(
            "Speed-up over threads, a crowd at 5 P/m²".to_owned(),
            x,
            Axis::linear("times as fast as on one thread", [0.0, 1.1 * most]),
            marks,
        )
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn threads_double_up_to_all_of_them() {
        assert_eq!(super::counts(1), [1]);
        assert_eq!(super::counts(2), [1, 2]);
        assert_eq!(super::counts(6), [1, 2, 4, 6]);
    }
}
