//! The results of a run as text or JSON.

use std::collections::BTreeMap;

use serde::Deserialize as _;
use serde_json::{Map, Value, json};

use super::failure::Failure;
use engine::scene::{Group, Scene};
use lab::reproduce::published_for;
use output::document::{Document, Findings};
use output::results as tables;
use output::table::Table;
use runs::drive::{End, Run};
use runs::identity::Identity;
use runs::summary::{JourneyResult, PlaceResult, Summary, value};
use scenario::measurements::{HEADWAY, Integrity, Metric, STUCK_AFTER, StuckGroup};
use scenario::quote::shown;

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

/// The results of a run with this document: a table of its values, and everything for programs.
pub fn findings(run: &Run, document: Document) -> Result<Findings, Failure> {
    let metrics = run.metrics.results(&run.simulation);
    let table = Table::of(&metrics)
        .column("measurement", |metric| metric.name.as_str())
        .column("value", |metric| metric.value)
        .column("unit", |metric| metric.unit)
        .table();
    let name = &run.scenario.name;
    let findings = Findings::new(name, document, json(run)).with_table(name, &table);
    findings.map_err(|error| Failure::Output(error.to_string()))
}

/// The least width of names.
const NAME_WIDTH: usize = 24;
/// The width of lines of names.
const LINE: usize = 100;
/// The most entries of a list in the overview.
const MOST: usize = 3;

/// What an engineer asks first, the measurements, the tables of journeys and places, and the run time; with the stages
/// of a frame if `verbose`.
pub fn text(run: &Run, verbose: bool) -> String {
    let summary = Summary::of(run);
    let mut text = format!(
        "{} ({}{}), seed {}: {:.2} s in {} frames\n",
        shown(&summary.scenario),
        shown(&summary.profile),
        motivation(&run.scenario.scene),
        summary.seed,
        summary.time_secs,
        summary.frames,
    );
    text += &overview(run, &summary);
    text += &measured(run);
    text += &through_walls(run);
    let mut measurements = run.scenario.measurements.iter();
    if measurements.any(|one| one.about().has_thresholds) {
        text += "  (thresholds are from the literature, not safety limits: docs/reference/measurements.md)\n";
    }
    text += &journeys(run);
    let threads = rayon::current_num_threads();
    let [ms, real_time_factor] = speed(run);
    text += &format!(
        "{ms:.3} ms per frame on {threads} thread(s), {real_time_factor:.1} × real time\n"
    );
    if verbose {
        for (stage, ms) in run.simulation.stages().ms_per_frame() {
            text += &format!("  {:<NAME_WIDTH$} {ms:>10.4} ms\n", stage.name());
        }
    }
    text
}

/// The motivation of the people, if a walking law reads it: ", motivation 0", with the zones that raise it.
fn motivation(scene: &Scene) -> String {
    let reads = |group: &&Group| {
        let law = group.blend.walking_law().and_then(|law| law.headings());
        law.is_some_and(|law| law.gap.longest() > 1.0 || law.gap.shortest() < 1.0)
    };
    let values = scene
        .groups
        .iter()
        .filter(reads)
        .map(|group| group.motivation);
    let Some([low, high]) = values.fold(None, |ends: Option<[f64; 2]>, value| {
        let [low, high] = ends.unwrap_or([value; 2]);
        Some([low.min(value), high.max(value)])
    }) else {
        return String::new();
    };
    let zones = scene.journeys.zones.iter().map(|zone| zone.motivation);
    let zones = match zones.fold(0.0, f64::max) {
        most if most > low => format!(", {most} in zones"),
        _ => String::new(),
    };
    match low == high {
        true => format!(", motivation {low}{zones}"),
        false => format!(", motivation {low} to {high}{zones}"),
    }
}

/// How the run ended, the people out, the times that they took, the highest density, the longest queues and the agents
/// that are stuck.
fn overview(run: &Run, summary: &Summary) -> String {
    let Summary {
        agents,
        arrived,
        remaining,
        ..
    } = summary;
    let mut text = format!(
        "It ended: {}. {agents} agents entered, {arrived} left, {remaining} remain.\n",
        run.reason(),
    );
    let mut line = |name: &str, value: String| {
        text += &format!("  {name:<NAME_WIDTH$} {value}\n");
    };
    if *arrived > 0 {
        line("left", times_out(summary));
    }
    let exits = summary.places.iter().filter(|place| place.kind == "exit");
    let exits = exits.map(|exit| {
        let percent = exit.share.map_or(0.0, |share| 100.0 * share);
        format!("{} {} ({percent:.0} %)", shown(&exit.name), exit.passed)
    });
    let mut exits: Vec<String> = exits.collect();
    let at_exits: f64 = summary.places.iter().filter_map(|exit| exit.share).sum();
    let elsewhere = ((1.0 - at_exits) * *arrived as f64).round();
    if elsewhere > 0.0 && !exits.is_empty() {
        let percent = 100.0 * (1.0 - at_exits);
        exits.push(format!("at goals {elsewhere} ({percent:.0} %)"));
    }
    if !exits.is_empty() {
        line("left by exit", exits.join(", "));
    }
    let highest = summary.highest_density.map(|highest| {
        let ([x, y], secs) = (highest.at, highest.at_secs);
        let density = highest.density_per_m2;
        let large = highest.of_large().map(|large| format!(", {large}"));
        let large = large.unwrap_or_default();
        format!("{density:.2} P/m² at ({x:.2}, {y:.2}) after {secs:.2} s (SPH density{large})")
    });
    let none = match *agents {
        0 => "none: no agents entered",
        _ => "not computed by this profile",
    };
    let highest = highest.unwrap_or_else(|| none.to_owned());
    line("highest density", highest);
    let queues = summary.longest_queues.iter();
    let queues = queues.map(|queue| {
        let (before, agents, secs) = (shown(&queue.before), queue.agents, queue.at_secs);
        let density = queue.density_per_m2.map_or(String::new(), |density| {
            format!(", at up to {density:.1} P/m²")
        });
        let Some(outside) = queue.outside else {
            return format!("{agents} before {before} after {secs:.0} s{density}");
        };
        // The density of a queue with a line is that of those outside of it.
        format!(
            "{agents} before {before} after {secs:.0} s (up to {} outside of its line, at {:.0} s{density}; {:.0} s \
             each on average)",
            outside.agents, outside.at_secs, outside.mean_secs
        )
    });
    line("longest queue", listed(queues.collect(), "none"));
    let stuck = match summary.stuck {
        0 => "none".to_owned(),
        stuck => format!(
            "{stuck} of {remaining}: they made less than {HEADWAY} m of headway in {STUCK_AFTER} s of walking"
        ),
    };
    line("stuck", stuck);
    text + &stuck_because(&summary.stuck_because)
}

/// When 50 %, 95 % and all agents had left.
fn times_out(summary: &Summary) -> String {
    let times = [
        ("50 %", summary.t50_secs),
        ("95 %", summary.t95_secs),
        ("all", summary.t100_secs),
    ];
    let times = times.map(|(part, secs)| match secs {
        Some(secs) => format!("{part} at {secs:.2} s"),
        None => format!("{part} not by the end"),
    });
    times.join(", ")
}

/// The first entries of a list.
fn listed(entries: Vec<String>, none: &str) -> String {
    match entries.len() {
        0 => none.to_owned(),
        count if count > MOST => format!(
            "{}, and {} more: --json lists them",
            entries[..MOST].join(", "),
            count - MOST
        ),
        _ => entries.join(", "),
    }
}

/// The agents that are stuck, by the likely cause.
fn stuck_because(groups: &[StuckGroup]) -> String {
    let mut text = String::new();
    for StuckGroup {
        cause,
        agents,
        agent,
        at: [x, y],
        for_secs,
    } in groups.iter().take(MOST)
    {
        text += &format!(
            "    {agents}: {cause} (agent {agent} at ({x:.2}, {y:.2}), for {for_secs:.0} s)\n"
        );
    }
    if groups.len() > MOST {
        let more = groups.len() - MOST;
        text += &format!("    and {more} more causes: --json lists them\n");
    }
    text
}

/// The values of the measurements, one group per measurement. Values of 0 stand together in lines, and missing ones.
fn measured(run: &Run) -> String {
    let metrics = run.metrics.results(&run.simulation);
    let published = published_for(&run.scenario);
    let names = metrics.iter().map(|metric| metric.name.chars().count());
    let width = names.fold(NAME_WIDTH, usize::max);
    let line = |metric: &Metric| {
        let value = match (value(metric), metric.value) {
            (Value::Number(count), _) if count.is_u64() => count.to_string(),
            (_, Some(value)) => format!("{value:.3}"),
            (_, None) => "–".to_owned(),
        };
        let paper = published.iter().find(|(name, _)| *name == metric.name);
        let paper = paper.map(|(_, paper)| format!("  (paper, Table 1: {paper})"));
        let (name, unit, paper) = (&metric.name, metric.unit, paper.unwrap_or_default());
        let line = format!("  {name:<width$} {value:>10} {unit}{paper}");
        format!("{}\n", line.trim_end())
    };
    let mut text = String::new();
    let mut before = 2;
    for group in metrics.chunk_by(|one, other| one.measurement == other.measurement) {
        // Groups stand apart.
        if before.max(group.len()) > 1 {
            text.push('\n');
        }
        before = group.len();
        let alike = |value| group.iter().filter(move |metric| metric.value == value);
        let mut folded = vec![("0:", Some(0.0)), ("–:", None)];
        folded.retain(|(_, value)| alike(*value).count() > 1);
        let stands = |metric: &&Metric| folded.iter().all(|(_, value)| metric.value != *value);
        text.extend(group.iter().filter(stands).map(line));
        for &(head, value) in &folded {
            text += &names_of(head, alike(value).map(|metric| metric.name.as_str()));
        }
    }
    text
}

/// The names of values that are alike, in lines.
fn names_of<'a>(head: &str, names: impl Iterator<Item = &'a str>) -> String {
    let mut lines: Vec<String> = Vec::new();
    for name in names {
        match lines.last_mut() {
            Some(line) if line.len() + name.len() < LINE => *line += &format!(", {name}"),
            _ => lines.push(name.to_owned()),
        }
    }
    let lines = lines.iter().enumerate();
    let lines = lines.map(|(k, line)| format!("  {} {line}", if k == 0 { head } else { "  " }));
    lines.collect::<Vec<_>>().join(",\n") + "\n"
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
    let [journeys, places] = [tables::journeys(&journeys), tables::places(&places)];
    format!("{}\n{}\n", journeys.text(), places.text())
}

/// Milliseconds per frame without output files, and the simulated time divided by the run time.
fn speed(run: &Run) -> [f64; 2] {
    let ms = run.simulation.stages().total_ms_per_frame();
    [ms, 1e3 * run.simulation.frame().clock.time_step() / ms]
}
