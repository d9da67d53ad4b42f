//! The report of one run.

use std::fs;
use std::path::PathBuf;

use super::still::Still;
use super::watched::Watched;
use super::worth::worth;
use super::{facts, limits, people, settings, status};
use crate::egress::Egress;
use crate::error::LabError;
use crate::gallery::distinct;
use crate::model::changes_profile;
use engine::simulation::Simulation;
use output::document::{Block, Document, print};
use output::results;
use output::table::Table;
use runs::drive::Run;
use runs::identity::{ENGINE, Identity, sha256};
use runs::notes;
use runs::summary::{JourneyResult, PlaceResult, Summary};
use scenario::measurements::Measurement;
use scenario::quote::shown;
use scenario::{Scenario, in_building};

/// A file that a run reads.
pub struct InputFile {
    /// What it is.
    pub what: String,
    /// Its path.
    pub path: PathBuf,
}

/// Where a report comes from.
pub struct Sources<'a> {
    /// The command that repeats the run.
    pub command: &'a str,
    /// The command that makes the report.
    pub report: &'a str,
    /// The files that it reads.
    pub files: Vec<InputFile>,
}

/// The report of a run that has ended, and was watched from its first frame on.
///
/// # Errors
/// A file of the run cannot be read, or data that ship with the program are invalid.
pub fn of_run(run: &Run, watched: &Watched, sources: Sources) -> Result<Document, LabError> {
    let (scenario, simulation) = (&run.scenario, &run.simulation);
    let summary = Summary::of(run);
    let mut blocks = vec![Block::heading("Results")];
    let overview = facts::overview(&summary, &run.reason());
    blocks.push(Block::Table(facts::table(&overview), String::new()));
    blocks.extend(facts::stuck(&summary));
    blocks.extend(worth(scenario, &summary)?);
    blocks.extend(notes(run));
    let mut pictures = pictures(run, watched).into_iter();
    blocks.push(Block::heading("Scenario"));
    blocks.push(about(scenario, &summary));
    blocks.push(files(&sources.files)?);
    blocks.extend(pictures.next());
    blocks.push(Block::heading("People"));
    blocks.push(people::table(scenario, &watched.passages));
    if let Some(table) = watched.passages.table(&scenario.scene) {
        blocks.push(Block::heading("Exits, doors and gates"));
        blocks.push(table);
    }
    blocks.extend(waits(scenario, &summary.places));
    blocks.push(Block::heading("Settings that differ from the defaults"));
    blocks.push(settings::changed(scenario, "command line"));
    blocks.extend(egress(simulation, &summary));
    blocks.extend(watched.levels.blocks());
    blocks.push(Block::heading(
        "Flows, densities, levels of service, exposure",
    ));
    let measurements = scenario.measurements.iter();
    blocks.extend(measurements.filter_map(|one| measured(one, scenario, &summary)));
    blocks.push(Block::text(facts::DENSITY));
    blocks.push(Block::heading("Pictures"));
    blocks.extend(pictures);
    blocks.extend(highest(scenario, watched));
    let groups = scenario.scene.groups.iter();
    let profiles = distinct(groups.map(|group| group.blend.name.as_str()));
    blocks.extend(limits::limits(&[&scenario.scene], &profiles));
    blocks.extend(status::status(&profiles, changes_profile(scenario))?);
    blocks.extend(again(scenario, &summary, sources.command, sources.report));
    Ok(Document::numbered(
        format!("Report on the run {}", scenario.name),
        scenario.description.clone(),
        blocks,
    ))
}

/// What the program said of the scenario and of the run; nothing if it said nothing.
fn notes(run: &Run) -> Vec<Block> {
    let of_step = notes::of_step(&run.scenario.scene).into_iter();
    let before = of_step.chain(run.scenario.notes.iter().cloned());
    let all: Vec<String> = before.chain(notes::of(run)).collect();
    match all.is_empty() {
        true => Vec::new(),
        false => vec![Block::heading("Notes of the program"), Block::List(all)],
    }
}

/// The pictures of the run, the first one first.
fn pictures(run: &Run, watched: &Watched) -> Vec<Block> {
    let entered = run.simulation.frame().agents.entered();
    let pictures = watched.pictures(entered).into_iter();
    let figure = |(still, caption): (&Still, String)| {
        let colors = "Colors: the SPH densities at the agents.";
        let sheet = still.sheet(&run.scenario, &print());
        Block::figure("", sheet, format!("{caption} {colors}"))
    };
    pictures.map(figure).collect()
}

/// The map of the highest densities; nothing without agents.
fn highest(scenario: &Scenario, watched: &Watched) -> Option<Block> {
    let peaks = &watched.peaks;
    let most = peaks.highest()?;
    let caption = format!(
        "The highest SPH density over the run at an agent in each cell of {} m; cells without color had no agent. \
         The highest of all is {most:.2} P/m².",
        peaks.cell
    );
    Some(Block::figure("", peaks.sheet(scenario, &print()), caption))
}

/// How people leave; nothing if nobody does.
fn egress(simulation: &Simulation, summary: &Summary) -> Vec<Block> {
    let egress = Egress::of(simulation);
    if egress.exits.is_empty() {
        return Vec::new();
    }
    let curve = "People out over time: the number of agents that have reached their exit or goal. Dashed: when 50, \
                 95 and 100 % of the agents that entered had left.";
    let table = "Shares are of all who entered. 50 %, 95 % and all of an exit are of the people who left there, of \
                 the last row of all who entered. Goals: people without an exit.";
    let first = [
        Block::heading("Egress"),
        Block::figure("", egress.sheet(""), curve),
        Block::Table(egress.table(), table.to_owned()),
    ];
    let blocks = first.into_iter().chain(journeys(&summary.journeys));
    blocks.collect()
}

/// The scenario in a few lines.
fn about(scenario: &Scenario, summary: &Summary) -> Block {
    let clock = scenario.scene.clock;
    Block::text(format!(
        "One run with seed {}: {} agents behave by the profile `{}`, except where a group has its own; at most {} s in \
         steps of {} s. How much the results differ between seeds is not known from one run: `sandbox sweep` with \
         `seeds` and a report on that study say it.",
        scenario.seed,
        summary.agents,
        shown(&scenario.profile_name),
        scenario.duration_secs,
        clock.time_step(),
    ))
}

/// The files of the run with their digests.
fn files(files: &[InputFile]) -> Result<Block, LabError> {
    let row = |one: &InputFile| -> Result<[String; 3], LabError> {
        let file = one.path.clone();
        let bytes = fs::read(&file).map_err(|error| LabError::Unread { file, error })?;
        let name = one.path.file_name().unwrap_or_default().to_string_lossy();
        Ok([shown(&name), one.what.clone(), sha256(&bytes)])
    };
    let rows: Vec<[String; 3]> = files.iter().map(row).collect::<Result<_, _>>()?;
    if rows.is_empty() {
        return Ok(Block::text(
            "The scenario and its floor plan are built into the program.",
        ));
    }
    let table = Table::of(&rows)
        .column("file", |[name, ..]| name.as_str())
        .column("what", |[_, what, _]| what.as_str())
        .column("SHA-256", |[.., digest]| digest.as_str())
        .table();
    let caption = "The version of the plan: a file with another digest is another plan.";
    Ok(Block::Table(table, caption.to_owned()))
}

/// Waiting areas and queues, with the times there as given; nothing without any.
fn waits(scenario: &Scenario, places: &[PlaceResult]) -> Vec<Block> {
    let all = &scenario.scene.journeys.places;
    let held = |row: &PlaceResult| {
        let place = all.iter().find(|place| place.name == row.name);
        place.map_or(String::new(), |place| people::held(scenario, place))
    };
    let waits = |place: &&PlaceResult| ["waiting area", "queue"].contains(&place.kind.as_str());
    let rows: Vec<&PlaceResult> = places.iter().filter(waits).collect();
    let table = Table::of(&rows)
        .column("place", |row| shown(&row.name))
        .column("kind", |row| row.kind.as_str())
        .column("people stay", |row| held(row))
        .column("people", |row| row.passed)
        .fixed("mean wait [s]", 1, |row| row.waited_secs)
        .table();
    match rows.is_empty() {
        true => Vec::new(),
        false => vec![
            Block::heading("Waiting areas and queues"),
            Block::Table(
                table,
                "People: those who have left it, each counted once. Mean wait: per visit."
                    .to_owned(),
            ),
        ],
    }
}

/// The journeys; nothing without any.
fn journeys(journeys: &[JourneyResult]) -> Option<Block> {
    let caption = "Mean: from entry to exit. 50 %, 95 % and all: when these parts of those who started had left. \
                   Waited: the mean time in queues and waiting areas of those who have left.";
    let table = || Block::Table(results::journeys(journeys), caption.to_owned());
    (!journeys.is_empty()).then(table)
}

/// The values of a measurement with their definitions, and where it observes people; nothing without values.
fn measured(measurement: &Measurement, scenario: &Scenario, summary: &Summary) -> Option<Block> {
    let facts = facts::measured(measurement, summary);
    let levels = scenario.scene.levels.as_deref();
    let places = measurement.observed();
    let mut about: Vec<String> = places
        .iter()
        .map(|(_, place)| format!("Where: {}.", in_building(levels, &place.to_string())))
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
