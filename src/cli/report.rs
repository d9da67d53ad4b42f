//! The results of a run as text or JSON.

use serde_json::{Map, Value, json};

use crate::runs::drive::Run;
use crate::runs::summary::{Summary, value};
use crate::scenario::quote::shown;

/// The summary, with threads and run times.
pub fn json(run: &Run, interrupted: bool) -> Value {
    let stages = run.simulation.stages().ms_per_frame();
    let stages = stages.map(|(stage, ms)| (stage.name().to_owned(), json!(ms)));
    let [ms, real_time_factor] = speed(run);
    let mut report = json!(Summary::of(run));
    report["interrupted"] = json!(interrupted);
    report["threads"] = json!(rayon::current_num_threads());
    report["ms_per_frame"] = json!(ms);
    report["real_time_factor"] = json!(real_time_factor);
    report["stages_ms"] = Value::Object(stages.collect::<Map<_, _>>());
    report
}

/// The measurements and run times.
pub fn text(run: &Run, interrupted: bool) -> String {
    let frame = run.simulation.frame();
    let mut text = format!(
        "{} ({}), seed {}: {} agents, {:.2} s in {} frames{}\n",
        shown(&run.scenario.name),
        shown(&run.scenario.profile_name),
        run.scenario.seed,
        frame.agents.entered(),
        frame.clock.time(),
        frame.clock.frame(),
        if interrupted { ", interrupted" } else { "" },
    );
    for metric in run.metrics.results(&run.simulation) {
        let value = match (value(&metric), metric.value) {
            (Value::Number(count), _) if count.is_u64() => count.to_string(),
            (_, Some(value)) => format!("{value:.3}"),
            (_, None) => "–".to_owned(),
        };
        text += &format!("  {:<24} {value:>10} {}\n", metric.name, metric.unit);
    }
    let threads = rayon::current_num_threads();
    let [ms, real_time_factor] = speed(run);
    text += &format!(
        "{ms:.3} ms per frame on {threads} thread(s), {real_time_factor:.1} × real time\n"
    );
    for (stage, ms) in run.simulation.stages().ms_per_frame() {
        text += &format!("  {:<24} {ms:>10.4} ms\n", stage.name());
    }
    text
}

/// Milliseconds per frame without output files, and the simulated time divided by the run time.
fn speed(run: &Run) -> [f64; 2] {
    let ms = run.simulation.stages().total_ms_per_frame();
    [ms, 1e3 * run.simulation.frame().clock.time_step() / ms]
}
