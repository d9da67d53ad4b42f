//! The results of a run as text or JSON.

use serde_json::{Map, Value, json};

use crate::output::table::Table;
use crate::runs::drive::Run;
use crate::runs::summary::{JourneyResult, PlaceResult, Summary, value};
use crate::scenario::measurements::Measurement;
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

/// The least width of names.
const NAME_WIDTH: usize = 24;

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
    let metrics = run.metrics.results(&run.simulation);
    let names = metrics.iter().map(|metric| metric.name.chars().count());
    let width = names.fold(NAME_WIDTH, usize::max);
    for metric in metrics {
        let value = match (value(&metric), metric.value) {
            (Value::Number(count), _) if count.is_u64() => count.to_string(),
            (_, Some(value)) => format!("{value:.3}"),
            (_, None) => "–".to_owned(),
        };
        text += &format!("  {:<width$} {value:>10} {}\n", metric.name, metric.unit);
    }
    if run.scenario.measurements.iter().any(has_thresholds) {
        text += "  (thresholds are from the literature, not safety limits: docs/measurements.md)\n";
    }
    text += &journeys(run);
    let threads = rayon::current_num_threads();
    let [ms, real_time_factor] = speed(run);
    text += &format!(
        "{ms:.3} ms per frame on {threads} thread(s), {real_time_factor:.1} × real time\n"
    );
    for (stage, ms) in run.simulation.stages().ms_per_frame() {
        text += &format!("  {:<NAME_WIDTH$} {ms:>10.4} ms\n", stage.name());
    }
    text
}

/// Does it compare with thresholds of the literature?
fn has_thresholds(measurement: &Measurement) -> bool {
    matches!(
        measurement,
        Measurement::Exposure(_)
            | Measurement::ServiceLevels(_)
            | Measurement::CrowdPressure(_)
            | Measurement::BodyForces(_)
            | Measurement::WallForces(_)
    )
}

/// Tables of the journeys and places; empty without journeys.
fn journeys(run: &Run) -> String {
    let journeys = JourneyResult::all(&run.simulation);
    let places = PlaceResult::all(&run.simulation);
    if journeys.is_empty() {
        return String::new();
    }
    let journeys = Table::of(&journeys)
        .column("journey", |row| shown(&row.name))
        .column("started", |row| row.left.started)
        .column("left", |row| row.left.finished)
        .fixed("mean s", 1, |row| row.left.mean_secs)
        .fixed("50 % at s", 1, |row| row.left.t50_secs)
        .fixed("95 %", 1, |row| row.left.t95_secs)
        .fixed("all", 1, |row| row.left.t100_secs)
        .fixed("waited s", 1, |row| row.left.waited_secs);
    let places = Table::of(&places)
        .column("place", |row| shown(&row.name))
        .column("kind", |row| row.kind.as_str())
        .column("passed", |row| row.passed)
        .fixed("share %", 1, |row| row.share.map(|share| 100.0 * share))
        .fixed("first s", 1, |row| row.from_to_secs.map(|[first, _]| first))
        .fixed("last s", 1, |row| row.from_to_secs.map(|[_, last]| last))
        .fixed("waited s", 1, |row| row.waited_secs);
    format!("{}\n{}\n", journeys.table().text(), places.table().text())
}

/// Milliseconds per frame without output files, and the simulated time divided by the run time.
fn speed(run: &Run) -> [f64; 2] {
    let ms = run.simulation.stages().total_ms_per_frame();
    [ms, 1e3 * run.simulation.frame().clock.time_step() / ms]
}
