//! Fig. 11: frame time per task against the number of agents.

use serde::{Deserialize, Serialize};

use crate::plot::{Axis, BLACK, Corner, LINES, Mark, Panel, Point, Sheet, Style};
use crate::simulation::{Simulation, Stage};

/// The paper's totals, six threads of a laptop Core i7-7920HQ (§6.4): agents, ms per frame.
const PAPER: [[f64; 2]; 2] = [[10_000.0, 4.94], [30_000.0, 18.57]];

/// Mean frame time of one crowd.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrameTime {
    /// How many people.
    pub agents: usize,
    /// Milliseconds per frame of every stage that ran, by [`Stage::name`].
    pub stages: Vec<(String, f64)>,
}

impl FrameTime {
    /// What a simulation has measured since its stages were last reset.
    pub fn of(simulation: &Simulation) -> Self {
        let stages = simulation.stages().ms_per_frame();
        Self {
            agents: simulation.frame().agents.len(),
            stages: stages.map(|(s, ms)| (s.name().to_owned(), ms)).collect(),
        }
    }

    /// All stages together, ms.
    pub fn total(&self) -> f64 {
        self.stages.iter().map(|(_, ms)| ms).sum()
    }

    fn of_stage(&self, stage: Stage) -> Option<f64> {
        let found = self.stages.iter().find(|(name, _)| name == stage.name())?;
        Some(found.1).filter(|&ms| ms > 0.0)
    }
}

/// What the paper calls a stage.
fn task(stage: Stage) -> &'static str {
    match stage {
        Stage::Sort => "1 sorting (paper: kd-tree)",
        Stage::Neighbors => "2 neighbours",
        Stage::PreferredVelocity => "3 preferred velocity",
        Stage::DensityAndPressure => "4 density and pressure",
        Stage::Acceleration => "5 acceleration",
        Stage::Integration => "6 integration",
        Stage::Rvo => "velocity obstacles",
    }
}

/// The sheet from measurements by rising number of agents; `machine` says on what.
pub fn sheet(times: &[FrameTime], machine: &str) -> Sheet {
    let order = [
        Stage::Sort,
        Stage::Neighbors,
        Stage::PreferredVelocity,
        Stage::DensityAndPressure,
        Stage::Acceleration,
        Stage::Integration,
        Stage::Rvo,
    ];
    let mut marks = Vec::new();
    let agents = |time: &FrameTime| time.agents as f64;
    for (stage, color) in order.into_iter().zip(LINES) {
        let point = |time: &FrameTime| Some([agents(time), time.of_stage(stage)?]);
        let points: Vec<[f64; 2]> = times.iter().filter_map(point).collect();
        if !points.is_empty() {
            let dots = points.iter().map(|&[x, y]| Point { x, y, error: 0.0 });
            let dots = dots.collect();
            marks.push(Mark::Line(points, Style::full(color, 1.2, task(stage))));
            marks.push(Mark::Points(dots, Style::full(color, 1.8, "")));
        }
    }
    let total: Vec<[f64; 2]> = times.iter().map(|t| [agents(t), t.total()]).collect();
    marks.push(Mark::Line(total, Style::full(BLACK, 1.8, "total")));
    let paper = PAPER.map(|[x, y]| Point { x, y, error: 0.0 });
    let label = "total in the paper, 6 threads";
    marks.push(Mark::Points(
        paper.to_vec(),
        Style::broken(BLACK, 3.5, label),
    ));
    let real_time = vec![[2_000.0, 20.0], [120_000.0, 20.0]];
    marks.push(Mark::Line(
        real_time,
        Style::broken(LINES[6], 0.8, "real time (20 ms)"),
    ));
    let panel = Panel {
        title: machine.to_owned(),
        x: Axis::log("agents", [2_000.0, 120_000.0]),
        y: Axis::log("time per frame [ms]", [0.005, 200.0]),
        marks,
        bar: None,
        legend: Some(Corner::LowerRight),
    };
    Sheet {
        title: "Fig. 11: frame time per task, concert".to_owned(),
        columns: 1,
        panel_size: [420.0, 300.0],
        shared_axes: false,
        row_titles: Vec::new(),
        bar: None,
        panels: vec![panel],
    }
}
