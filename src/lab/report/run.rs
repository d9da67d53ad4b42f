//! The report of one run.

use super::{facts, limits, settings};
use crate::lab::egress::Egress;
use crate::output::document::{Block, Document};
use crate::output::plot::Sheet;
use crate::output::table::Table;
use crate::runs::drive::Run;
use crate::runs::identity::{ENGINE, Identity};
use crate::runs::summary::{JourneyResult, Summary};
use crate::scenario::Scenario;
use crate::scenario::measurements::Measurement;

/// Where a report comes from.
pub struct Sources<'a> {
    /// The command that repeats the run.
    pub command: &'a str,
    /// The command that makes the report.
    pub report: &'a str,
    /// Pictures with their times, seconds.
    pub pictures: Vec<(f64, Sheet)>,
}

/// The report of a run that has ended.
pub fn of_run(run: &Run, sources: Sources) -> Document {
    let (scenario, simulation) = (&run.scenario, &run.simulation);
    let summary = Summary::of(run);
    let mut blocks = vec![Block::heading("Results")];
    let overview = facts::overview(&summary, &run.reason());
    blocks.push(Block::Table(facts::table(&overview), String::new()));
    blocks.extend(facts::stuck(&summary));
    blocks.extend(about(scenario, &summary));
    let mut pictures = sources.pictures.into_iter();
    let plan = pictures.next().map(|(time, sheet)| {
        let caption = format!("The plan with the agents at {time:.2} s, before they walk.");
        Block::figure(sheet, caption)
    });
    blocks.extend(plan);
    blocks.push(Block::heading("Settings that differ from the defaults"));
    blocks.push(settings::changed(scenario));
    let egress = Egress::of(simulation);
    if !egress.exits.is_empty() {
        blocks.push(Block::heading("Egress"));
        let caption = "People out over time: the number of agents that have reached their exit or goal. Dashed: when \
                       50, 95 and 100 % of the agents that entered had left.";
        blocks.push(Block::figure(egress.sheet(""), caption));
        let caption = "Shares are of the people who left. 50 %, 95 % and all of an exit are of the people who left \
                       there, of the last row of all who entered. Goals: people without an exit.";
        blocks.push(Block::Table(egress.table(), caption.to_owned()));
        blocks.extend(journeys(&summary.journeys));
    }
    blocks.push(Block::heading(
        "Flows, densities, levels of service, exposure",
    ));
    for measurement in &scenario.measurements {
        let facts = facts::measured(measurement, &summary);
        if !facts.is_empty() {
            let caption = caption(measurement);
            blocks.push(Block::Table(facts::table(&facts), caption));
        }
    }
    blocks.push(Block::text(facts::DENSITY));
    let later: Vec<(f64, Sheet)> = pictures.collect();
    if !later.is_empty() {
        blocks.push(Block::heading("Pictures"));
    }
    blocks.extend(later.into_iter().map(|(time, sheet)| {
        Block::figure(
            sheet,
            format!("The agents after {time:.2} s, colored by SPH density."),
        )
    }));
    blocks.extend(limits::limits(&[scenario.profile_name.as_str()]));
    blocks.extend(limits::status());
    blocks.extend(again(scenario, &summary, sources.command, sources.report));
    Document {
        title: format!("Report on the run {}", scenario.name),
        subtitle: scenario.description.clone(),
        blocks,
    }
}

/// The scenario in a few lines.
fn about(scenario: &Scenario, summary: &Summary) -> Vec<Block> {
    let clock = scenario.scene.clock;
    let text = format!(
        "{} agents behave by the profile `{}`, except where a group has its own; seed {}; at most {} s in steps of {} \
         s.",
        summary.agents,
        scenario.profile_name,
        scenario.seed,
        scenario.duration_secs,
        clock.time_step(),
    );
    vec![Block::heading("Scenario"), Block::text(text)]
}

/// The journeys; nothing without any.
fn journeys(journeys: &[JourneyResult]) -> Option<Block> {
    let table = Table::of(journeys)
        .column("journey", |row| row.name.as_str())
        .column("started", |row| row.left.started)
        .column("left", |row| row.left.finished)
        .fixed("mean time [s]", 1, |row| row.left.mean_secs)
        .fixed("50 % [s]", 1, |row| row.left.t50_secs)
        .fixed("95 % [s]", 1, |row| row.left.t95_secs)
        .fixed("all [s]", 1, |row| row.left.t100_secs)
        .fixed("waited [s]", 1, |row| row.left.waited_secs)
        .table();
    let caption = "Mean time: from entry to exit. 50 %, 95 % and all: when these parts of those who started had left. \
                   Waited: the mean time in queues and waiting areas of those who have left.";
    (!journeys.is_empty()).then(|| Block::Table(table, caption.to_owned()))
}

/// What a reader must know beside the definitions.
fn caption(measurement: &Measurement) -> String {
    match measurement.about().has_thresholds {
        true => "Thresholds are from the literature, not safety limits.".to_owned(),
        false => String::new(),
    }
}

/// Digests, and how to run it again.
fn again(scenario: &Scenario, summary: &Summary, command: &str, report: &str) -> Vec<Block> {
    let version = env!("CARGO_PKG_VERSION");
    vec![
        Block::heading("How to run it again"),
        Block::Code(vec![command.to_owned(), report.to_owned()]),
        Block::text(
            "The same version gives the same results to the last bit, on any number of threads: the digest of the \
             final state must be the one below.",
        ),
        Block::List(vec![
            format!(
                "digest of the final state (SHA-256): {}",
                summary.state_sha256
            ),
            format!(
                "identity of the run (program, settings, files): {}",
                Identity::of_run(scenario)
            ),
            format!("version {version}, engine {ENGINE}"),
        ]),
    ]
}
