//! Fig. 11: frame time per task against the number of agents.

use super::super::product::{Needs, Product};
use crate::error::LabError;
use engine::simulation::Stage;
use output::plot::{Axis, BLACK, Corner, LINES, Mark, Panel, Sheet, Style, line_color};
use output::table::Table;
use scenario::measurements::{FrameTime, StageTimes};

/// The figure.
pub const PRODUCT: Product = Product {
    name: "fig11",
    about: "frame time per task against the number of agents; measured alone, on all threads",
    in_all: true,
    studies: &["fig11"],
    needs: Needs::Alone,
    tables: &["fig11"],
    has_figure: true,
    find: |product, studies| {
        let cells = studies.iter().flat_map(|study| &study.states);
        let of_cells = cells.map(|state| state.result()?.summary.data(FrameTime::NAME));
        let complete: Option<Vec<StageTimes>> = of_cells.collect();
        let times = complete.ok_or_else(|| LabError::missing("fig11", FrameTime::NAME))?;
        let threads = times.first().map_or(0, |time| time.threads);
        let machine = format!("{threads} threads of this machine");
        let findings = product.figure(sheet(&times, &machine));
        Ok(findings.with_table(product.name, &table(&times))?)
    },
};

/// The paper's totals on six threads of a laptop with a Core i7-7920HQ (§6.4): agents, ms per frame.
const PAPER: [[f64; 2]; 2] = [[10_000.0, 4.94], [30_000.0, 18.57]];

/// The ends of the axis of agents.
const SIZES: [f64; 2] = [2_000.0, 120_000.0];

/// The stages in the order of the legend, with the paper's names.
const TASKS: [(Stage, &str); 11] = [
    (Stage::Sort, "1 sorting (paper: kd-tree)"),
    (Stage::Neighbors, "2 neighbors"),
    (Stage::PreferredVelocity, "3 preferred velocity"),
    (Stage::DensityAndPressure, "4 density and pressure"),
    (Stage::Acceleration, "5 acceleration"),
    (Stage::Integration, "6 integration"),
    (Stage::Packing, "packing"),
    (Stage::Schedule, "entries and pushes"),
    (Stage::WalkingLaws, "walking laws"),
    (Stage::Rvo, "velocity obstacles"),
    (Stage::Removal, "removal"),
];

/// The sheet from measurements in order of the number of agents; `machine` names the machine.
fn sheet(times: &[StageTimes], machine: &str) -> Sheet {
    let mut marks = Vec::new();
    let agents = |time: &StageTimes| time.agents as f64;
    for (k, (stage, task)) in TASKS.into_iter().enumerate() {
        let point = |time: &StageTimes| Some([agents(time), time.of_stage(stage)?]);
        let points: Vec<[f64; 2]> = times.iter().filter_map(point).collect();
        if !points.is_empty() {
            let dots = Mark::dots(points.clone(), Style::full(line_color(k), 1.8, ""));
            marks.push(Mark::line(points, Style::full(line_color(k), 1.2, task)));
            marks.push(dots);
        }
    }
    let total = times.iter().map(|time| [agents(time), time.total()]);
    marks.push(Mark::line(total, Style::full(BLACK, 1.8, "total")));
    let paper = Style::broken(BLACK, 3.5, "total in the paper, 6 threads");
    marks.push(Mark::dots(PAPER, paper));
    let real_time = Style::broken(LINES[6], 0.8, "real time (20 ms)");
    marks.push(Mark::line(SIZES.map(|agents| [agents, 20.0]), real_time));
    let x = Axis::log("agents", SIZES);
    let y = Axis::log("time per frame [ms]", [0.005, 200.0]);
    let panel = Panel::new(machine, x, y, marks).with_legend(Corner::Beside);
    let title = "Fig. 11: frame time per task, concert";
    Sheet::new(title, 1, [420.0, 300.0], vec![panel])
}

/// One line per number of agents, with the milliseconds per frame of every stage.
fn table(times: &[StageTimes]) -> Table {
    let mut table = Table::of(times)
        .column("agents", |time| time.agents)
        .column("threads", |time| time.threads)
        .column("total_ms", StageTimes::total);
    for stage in Stage::ALL {
        let name = format!("{}_ms", stage.name());
        table = table.column(&name, |time| time.of_stage(stage).unwrap_or(0.0));
    }
    table.table()
}
