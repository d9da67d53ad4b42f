//! The report of one run.

use super::{facts, limits, settings};
use crate::lab::egress::Egress;
use crate::output::document::{Block, Document};
use crate::output::plot::Sheet;
use crate::output::results;
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
    let measurements = scenario.measurements.iter();
    blocks.extend(measurements.filter_map(|one| measured(one, &summary)));
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
    let caption = "Mean: from entry to exit. 50 %, 95 % and all: when these parts of those who started had left. \
                   Waited: the mean time in queues and waiting areas of those who have left.";
    let table = || Block::Table(results::journeys(journeys), caption.to_owned());
    (!journeys.is_empty()).then(table)
}

/// The values of a measurement with their definitions, and where it observes people; nothing without values.
fn measured(measurement: &Measurement, summary: &Summary) -> Option<Block> {
    let facts = facts::measured(measurement, summary);
    let places = measurement.observed();
    let mut about: Vec<String> = places
        .iter()
        .map(|(_, place)| format!("Where: {place}."))
        .collect();
    if measurement.about().has_thresholds {
        about.push("Thresholds are from the literature, not safety limits.".to_owned());
    }
    let table = || Block::Table(facts::table(&facts), about.join(" "));
    (!facts.is_empty()).then(table)
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
