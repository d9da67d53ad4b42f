//! Sums over pairs that visit each pair once: the densities of a dense crowd (Eq. 9), in the way of the engine, and
//! with each pair added to both of its agents.
//!
//! The engine adds every agent j of a list to the eight agents of its cluster, so each pair is visited twice, and no
//! sum writes to another agent. Here a cluster only visits agents that come after it, and adds what they receive from
//! it to them: the sum over its eight lanes. This is one thread; with more, agents of two threads would receive from
//! both, in an order that must not depend on them.

use std::ops::Range;
use std::time::Instant;

use sandbox::analysis::statistics::Range as Times;
use sandbox::engine::density::from_agents;
use sandbox::engine::neighbors::{BLOCK, Neighbors, Run};
use sandbox::engine::pairs::prelude::*;
use sandbox::engine::pairs::{
    Bodies, Lanes, Packed, PairSum, Simd, add_pairs, dispatch, level, load, splat, spread, store,
};
use sandbox::lab::bench::{Benchmark, Crowd, Plan, Timings};
use sandbox::lab::error::LabError;
use sandbox::lab::gallery::{color, medians, single};
use sandbox::output::plot::{Axis, Sheet};
use sandbox::output::table::Table;
use serde::Serialize;
use serde_json::json;

/// The experiment.
pub const BENCHMARK: Benchmark = Benchmark {
    name: "symmetric",
    about: "densities with each pair visited once, beside those of the engine, on one thread",
    run,
};

/// The crowd at rest at 5 P/m².
const AGENTS: u32 = 10_000;
const FRAMES: u64 = 50;
/// The sums per repeat.
const SUMS: usize = 100;

#[derive(Serialize)]
struct Row {
    sums: &'static str,
    /// Agents j that a cluster visits, per agent.
    visited: f64,
    ns_per_agent: Times,
    ratio: f64,
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Timings, LabError> {
    say("densities of 10,000 agents");
    let mut simulation = Crowd::concert(AGENTS).settled(plan.choose(FRAMES, 2))?;
    simulation
        .evaluate()
        .map_err(|fault| LabError::of("crowd", fault))?;
    let frame = simulation.frame();
    let Packed::Mixed(columns) = frame.packed else {
        return Err(LabError::Data(
            "the crowd is not in mixed precision".to_owned(),
        ));
    };
    let (bodies, neighbors) = (&columns.bodies, frame.neighbors);
    let count = frame.agents.len();
    let halves = halved(neighbors, count);
    let (mut twice, mut once) = (vec![0.0; count], vec![0.0; count]);
    let mut received = vec![0.0_f32; count];
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..plan.repeats {
        times[0].push(timed(plan, || {
            for (b, out) in twice.chunks_mut(BLOCK).enumerate() {
                from_agents(bodies, neighbors.near().block(b), out);
            }
        }));
        times[1].push(timed(plan, || {
            received.fill(0.0);
            symmetric(bodies, &halves, &mut received, &mut once);
        }));
    }
    let difference = twice.iter().zip(&once).map(|(a, b)| (a - b).abs() / a);
    let difference = difference.fold(0.0, f64::max);
    let listed = |runs: &[Run]| runs.iter().map(|run| run.agents.len()).sum::<usize>();
    let blocks = (0..count.div_ceil(BLOCK)).map(|b| neighbors.near().block(b));
    let all: usize = blocks
        .flat_map(|block| block.clusters())
        .map(|(_, runs)| listed(runs))
        .sum();
    let half: usize = halves.iter().map(|(_, runs)| listed(runs)).sum();
    let medians = times.each_ref().map(|times| Times::of(times).median);
    let row = |k: usize, sums, visited: usize| Row {
        sums,
        visited: visited as f64 / count as f64,
        ns_per_agent: Times::of(&times[k]).times(1e6 / count as f64),
        ratio: medians[k] / medians[0],
    };
    let rows = [
        row(0, "each pair from both sides", all),
        row(1, "each pair once", half),
    ];
    Ok(Timings {
        table: Table::of(&rows)
            .column("sums", |row| row.sums)
            .fixed("visited/agent", 2, |row| row.visited)
            .range("ns/agent", 2, |row| row.ns_per_agent)
            .fixed("ratio", 2, |row| row.ratio)
            .table(),
        sheet: picture(&rows),
        rows: json!(rows),
        notes: vec![format!(
            "The largest relative difference of two densities is {difference:.1e}."
        )],
    })
}

fn picture(rows: &[Row]) -> Sheet {
    let most = rows.iter().map(|row| row.ns_per_agent.maximum);
    let times = [0.0, 1.1 * most.fold(1.0, f64::max)];
    let marks = rows.iter().enumerate().flat_map(|(k, row)| {
        let point = (row.visited, row.ns_per_agent);
        medians(&[point], color(k), row.sums)
    });
    let x = Axis::linear("agents visited per agent", [0.0, 10.0]);
    let y = Axis::linear("time per agent [ns]", times);
    single(
        "Densities of 10,000 agents at 5 P/m²",
        x,
        y,
        marks.collect(),
    )
}

/// Milliseconds per sum.
fn timed(plan: &Plan, mut work: impl FnMut()) -> f64 {
    let sums = plan.choose(SUMS, 2);
    let start = Instant::now();
    (0..sums).for_each(|_| work());
    1e3 * start.elapsed().as_secs_f64() / sums as f64
}

/// The clusters, each with the part of its runs from its own first agent on.
fn halved(neighbors: &Neighbors, count: usize) -> Vec<(Range<usize>, Vec<Run>)> {
    let blocks = (0..count.div_ceil(BLOCK)).map(|b| neighbors.near().block(b));
    let clusters = blocks.flat_map(|block| block.clusters());
    let later = |(agents, runs): (Range<usize>, &[Run])| {
        let first = agents.start as u32;
        let runs = runs.iter().filter(|run| run.agents.end > first);
        let runs = runs.map(|run| Run {
            agents: run.agents.start.max(first)..run.agents.end,
            laps: run.laps,
        });
        (agents, runs.collect())
    };
    clusters.map(later).collect()
}

/// Eq. 9 without walls for eight agents i, and for the agents j behind them.
struct DensityOfPairs<'a, S: Simd> {
    mass: &'a [f32],
    /// m_i; 0 in lanes without agent.
    own_mass: Lanes<f32, S>,
    scale: Lanes<f32, S>,
    sum: Lanes<f32, S>,
    /// What the agents j receive.
    received: &'a mut [f32],
    /// The end of the cluster: its own agents receive nothing here.
    end: usize,
}

impl<'a, S: Simd> PairSum<f32, S> for DensityOfPairs<'a, S> {
    type Run = (&'a [f32], usize);

    #[inline(always)]
    fn run(&self, run: Range<usize>) -> Self::Run {
        (&self.mass[run.clone()], run.start)
    }

    #[inline(always)]
    fn add(&mut self, simd: S, [dx, dy]: [Lanes<f32, S>; 2], (mass, first): Self::Run, j: usize) {
        let (zero, one) = (splat::<f32, S>(simd, 0.0), splat::<f32, S>(simd, 1.0));
        let squared = dy.mul_add(dy, dx * dx);
        let rest = squared.mul_add(self.scale, one).max(zero);
        let kernel = rest * rest * rest;
        self.sum = spread::<f32, S>(simd, mass[j]).mul_add(kernel, self.sum);
        if first + j >= self.end {
            let mut lanes = [0.0_f32; 8];
            (self.own_mass * kernel).store_slice(&mut lanes);
            let [a, b, c, d, e, f, g, h] = lanes;
            self.received[first + j] += ((a + b) + (c + d)) + ((e + f) + (g + h));
        }
    }
}

fn symmetric(
    bodies: &Bodies<f32>,
    clusters: &[(Range<usize>, Vec<Run>)],
    received: &mut [f32],
    out: &mut [f64],
) {
    dispatch!(level(), simd => sums(simd, bodies, clusters, received, out));
}

#[inline(always)]
fn sums<S: Simd>(
    simd: S,
    bodies: &Bodies<f32>,
    clusters: &[(Range<usize>, Vec<Run>)],
    received: &mut [f32],
    out: &mut [f64],
) {
    for (agents, runs) in clusters {
        let per_h: Lanes<f32, S> = load(simd, &bodies.per_support, agents.start);
        let squared = per_h * per_h;
        let mut own = [0.0; 8];
        own[..agents.len()].copy_from_slice(&bodies.mass[agents.clone()]);
        let mut sum = DensityOfPairs {
            mass: &bodies.mass,
            own_mass: load(simd, &own, 0),
            scale: squared * splat::<f32, S>(simd, -bodies.unit * bodies.unit),
            sum: splat::<f32, S>(simd, 0.0),
            received,
            end: agents.end,
        };
        add_pairs(simd, bodies, (agents.start, runs), &mut sum);
        // Clusters come in order: what this one receives is complete.
        for (i, sum) in agents.clone().zip(store::<f32, S>(sum.sum)) {
            let scale = f64::from(bodies.per_support[i]).powi(2) * 4.0 / std::f64::consts::PI;
            out[i] = (sum + f64::from(received[i])) * scale;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sums_are_the_same_to_rounding_and_one_visits_about_half() {
        let plan = Plan {
            repeats: 1,
            quick: true,
            largest: AGENTS,
        };
        let findings = run(&plan, &|_| {}).unwrap();
        let visited = |k: usize| findings.rows[k]["visited"].as_f64().unwrap();
        assert!(visited(1) < 0.65 * visited(0), "{}", findings.rows);
        let said = findings.notes[0]
            .trim_end_matches('.')
            .rsplit(' ')
            .next()
            .unwrap();
        assert!(said.parse::<f64>().unwrap() < 1e-5, "{said}");
    }
}
