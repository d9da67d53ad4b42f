//! The results of a run as text or JSON.

use serde_json::{Map, Value, json};

use crate::engine::simulation::Simulation;
use crate::runs::summary::{Summary, value};
use crate::scenario::Scenario;
use crate::scenario::measurements::{Metric, Metrics};
use crate::scenario::quote::shown;

/// The results of one run.
pub struct Report<'a> {
    scenario: &'a Scenario,
    simulation: &'a Simulation,
    measured: &'a Metrics,
    metrics: Vec<Metric>,
    interrupted: bool,
}

impl<'a> Report<'a> {
    pub fn new(
        scenario: &'a Scenario,
        simulation: &'a Simulation,
        metrics: &'a Metrics,
        interrupted: bool,
    ) -> Self {
        Self {
            scenario,
            simulation,
            measured: metrics,
            metrics: metrics.results(simulation),
            interrupted,
        }
    }

    /// The whole report, ready to print.
    pub fn render(&self, as_json: bool) -> String {
        if as_json {
            format!("{}\n", self.json())
        } else {
            self.text()
        }
    }

    /// The summary, with threads and run times.
    fn json(&self) -> Value {
        let stages: Map<String, Value> = self
            .simulation
            .stages()
            .ms_per_frame()
            .map(|(stage, ms)| (stage.name().to_owned(), json!(ms)))
            .collect();
        let mut report = json!(Summary::of(self.scenario, self.simulation, self.measured));
        report["interrupted"] = json!(self.interrupted);
        report["threads"] = json!(rayon::current_num_threads());
        report["ms_per_frame"] = json!(self.ms_per_frame());
        report["real_time_factor"] = json!(self.real_time_factor());
        report["stages_ms"] = Value::Object(stages);
        report
    }

    fn text(&self) -> String {
        let frame = self.simulation.frame();
        let mut text = format!(
            "{} ({}), seed {}: {} agents, {:.2} s in {} frames{}\n",
            shown(&self.scenario.name),
            shown(&self.scenario.profile_name),
            self.scenario.seed,
            frame.agents.entered(),
            frame.clock.time(),
            frame.clock.frame(),
            if self.interrupted {
                ", interrupted"
            } else {
                ""
            },
        );
        for metric in &self.metrics {
            let value = match (value(metric), metric.value) {
                (Value::Number(count), _) if count.is_u64() => count.to_string(),
                (_, Some(value)) => format!("{value:.3}"),
                (_, None) => "–".to_owned(),
            };
            text += &format!("  {:<24} {value:>10} {}\n", metric.name, metric.unit);
        }
        let threads = rayon::current_num_threads();
        text += &format!(
            "{:.3} ms per frame on {threads} thread(s), {:.1} × real time\n",
            self.ms_per_frame(),
            self.real_time_factor(),
        );
        for (stage, ms) in self.simulation.stages().ms_per_frame() {
            text += &format!("  {:<24} {ms:>10.4} ms\n", stage.name());
        }
        text
    }

    /// Run time of the simulation, without output files.
    fn ms_per_frame(&self) -> f64 {
        self.simulation.stages().total_ms_per_frame()
    }

    fn real_time_factor(&self) -> f64 {
        1e3 * self.simulation.frame().clock.time_step() / self.ms_per_frame()
    }
}
