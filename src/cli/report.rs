//! The results of a run as text or JSON.

use std::collections::BTreeMap;

use serde::Deserialize as _;
use serde_json::{Map, Value, json};

use crate::lab::reproduce::published_for;
use crate::output::table::Table;
use crate::runs::drive::{End, Run};
use crate::runs::identity::Identity;
use crate::runs::summary::{JourneyResult, PlaceResult, Summary, value};
use crate::scenario::measurements::{HEADWAY, Integrity, STUCK_AFTER, StuckGroup};
use crate::scenario::quote::shown;

/// The summary, with version, identity, all settings, threads and run times.
pub fn json(run: &Run) -> Value {
    let stages = run.simulation.stages().ms_per_frame();
    let stages = stages.map(|(stage, ms)| (stage.name().to_owned(), json!(ms)));
    let [ms, real_time_factor] = speed(run);
    let mut report = json!(Summary::of(run));
    report["version"] = json!(env!("CARGO_PKG_VERSION"));
    report["identity"] = json!(Identity::of_run(&run.scenario));
    report["settings"] = run.scenario.settings();
    let published: BTreeMap<_, _> = published_for(&run.scenario).into_iter().collect();
    if !published.is_empty() {
        report["paper"] = json!(published);
    }
    report["interrupted"] = json!(run.end == Some(End::Interrupted));
    report["threads"] = json!(rayon::current_num_threads());
    report["ms_per_frame"] = json!(ms);
    report["real_time_factor"] = json!(real_time_factor);
    report["stages_ms"] = Value::Object(stages.collect::<Map<_, _>>());
    report
}

/// The least width of names.
const NAME_WIDTH: usize = 24;

/// The measurements and run times, and a sentence on how the run ended.
pub fn text(run: &Run) -> String {
    let frame = run.simulation.frame();
    let mut text = format!(
        "{} ({}), seed {}: {} agents, {:.2} s in {} frames\n",
        shown(&run.scenario.name),
        shown(&run.scenario.profile_name),
        run.scenario.seed,
        frame.agents.entered(),
        frame.clock.time(),
        frame.clock.frame(),
    );
    let metrics = run.metrics.results(&run.simulation);
    let published = published_for(&run.scenario);
    let names = metrics.iter().map(|metric| metric.name.chars().count());
    let width = names.fold(NAME_WIDTH, usize::max);
    for metric in metrics {
        let value = match (value(&metric), metric.value) {
            (Value::Number(count), _) if count.is_u64() => count.to_string(),
            (_, Some(value)) => format!("{value:.3}"),
            (_, None) => "–".to_owned(),
        };
        let paper = published.iter().find(|(name, _)| *name == metric.name);
        let paper = paper.map(|(_, paper)| format!("  (paper, Table 1: {paper})"));
        let paper = paper.unwrap_or_default();
        text += &format!(
            "  {:<width$} {value:>10} {}{paper}\n",
            metric.name, metric.unit
        );
    }
    text += &through_walls(run);
    let mut measured = run.scenario.measurements.iter();
    if measured.any(|one| one.about().has_thresholds) {
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
    text + &ending(run)
}

/// The numbers of agents that entered, arrived and remain, the reason why the run ended, and the agents that are stuck.
fn ending(run: &Run) -> String {
    /// The most causes to print.
    const MOST: usize = 3;
    let (frame, outcome) = (run.simulation.frame(), run.simulation.outcome());
    let (entered, arrived) = (frame.agents.entered(), outcome.arrivals.len());
    let (remain, time) = (frame.agents.count_present(), frame.clock.time());
    let mut text = format!(
        "{entered} agents entered, {arrived} arrived, {remain} remain; the run ended at {time:.2} s: {}.\n",
        run.reason(),
    );
    let groups = run.metrics.stuck(&run.simulation);
    let stuck: usize = groups.iter().map(|group| group.agents).sum();
    if stuck == 0 {
        return text;
    }
    text += &format!(
        "{stuck} of {remain} agents are stuck: they made less than {HEADWAY} m of headway in {STUCK_AFTER} s of \
         walking.\n"
    );
    for StuckGroup {
        cause,
        agents,
        agent,
        at: [x, y],
        for_secs,
    } in groups.iter().take(MOST)
    {
        text += &format!(
            "  {agents}: {cause} (agent {agent} at ({x:.2}, {y:.2}), for {for_secs:.0} s)\n"
        );
    }
    if groups.len() > MOST {
        text += &format!(
            "  and {} more causes: --json lists them\n",
            groups.len() - MOST
        );
    }
    text
}

/// The ids of the agents that `integrity` has found in walls; empty without any.
fn through_walls(run: &Run) -> String {
    let mut data = run.metrics.data();
    let ids = data.find(|(name, _)| name == Integrity::NAME);
    let ids = ids.and_then(|(_, ids)| Vec::<u32>::deserialize(ids).ok());
    let Some(ids) = ids else {
        return String::new();
    };
    let ids: Vec<String> = ids.iter().map(u32::to_string).collect();
    let first = ids.join(", ");
    format!("  through walls, by id (at most ten): {first}; `sandbox inspect --agent` shows them\n")
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
