//! The report of a study: its runs side by side, with their spread.

use std::collections::BTreeMap;
use std::path::Path;

use super::{facts, limits, settings, status};
use crate::curves::{BAND, Curve, curves, panel};
use crate::error::LabError;
use crate::gallery::{color, distinct, with_legend};
use crate::model::changes_profile;
use crate::sweep::{Combination, Drawing, Gathered, State, readable};
use analysis::statistics::MeanStd;
use engine::scene::Scene;
use output::document::{Block, Document};
use output::plot::Sheet;
use output::table::Table;
use runs::case::RunResult;
use runs::identity::ENGINE;
use scenario::Scenario;
use scenario::measurements::Quantity;

/// The most combinations beside each other in a table.
const BESIDE: usize = 3;
/// The most lines of a picture with curves.
const MOST_LINES: usize = 14;
/// The most panels of a figure.
const PANELS: usize = 4;
/// The first digits of a digest.
const DIGITS: usize = 32;

type Value = Box<dyn Fn(&RunResult) -> Option<f64>>;

/// A number of runs: its name, its definition, and its values.
struct Number {
    name: String,
    meaning: String,
    value: Value,
}

/// The report of the finished runs of a study in this file, whose results are in this folder.
///
/// # Errors
/// No run is finished, or a scenario has become invalid.
pub fn of_study(gathered: &Gathered, file: &Path, folder: &Path) -> Result<Document, LabError> {
    let study = gathered.study;
    let combinations = gathered.combinations();
    let finished: usize = combinations.iter().map(|one| one.results.len()).sum();
    if finished == 0 {
        return Err(LabError::missing(&study.name, "finished run"));
    }
    let first = combinations.iter().filter_map(|one| one.cells.first());
    let read = first.map(|cell| {
        let invalid = |error: scenario::ScenarioError| LabError::Data(error.to_string());
        cell.case.scenario().map_err(invalid)
    });
    let scenarios: Vec<Scenario> = read.collect::<Result<_, _>>()?;
    let names: Vec<String> = combinations
        .iter()
        .map(|one| name(one, &study.axes))
        .collect();
    let description = study.document["description"].as_str().unwrap_or_default();
    let about = format!(
        "{finished} of {} runs are finished: {} combination(s) of settings, each with up to {} seeds. Values are means \
         over the seeds ± half their 95 % confidence intervals (Student's t), then the least and the largest value. \
         [n of m]: the mean of the n runs that have a value; with the others it would be another one.",
        study.cells.len(),
        combinations.len(),
        study.seeds
    );
    let mut blocks = vec![Block::heading("Results"), Block::text(about)];
    blocks.extend(results(
        &numbers(gathered, &scenarios),
        &combinations,
        &names,
    ));
    blocks.extend(figures(gathered, &combinations, &names));
    blocks.push(Block::heading("Scenario"));
    if let (Some(scenario), Some(name)) = (scenarios.first(), names.first()) {
        blocks.push(Block::text(format!(
            "{}: {} Settings of the first combination ({name}) that differ from the defaults:",
            scenario.name, scenario.description
        )));
        blocks.push(settings::changed(scenario, "study"));
    }
    let groups = scenarios.iter().flat_map(|one| &one.scene.groups);
    let profiles = distinct(groups.map(|group| group.blend.name.as_str()));
    let scenes: Vec<&Scene> = scenarios.iter().map(|one| &one.scene).collect();
    blocks.extend(limits::limits(&scenes, &profiles));
    blocks.extend(status::status(
        &profiles,
        scenarios.iter().any(changes_profile),
    )?);
    blocks.extend(again(gathered, file, folder));
    Ok(Document::numbered(
        format!("Report on the study {}", study.name),
        description.to_owned(),
        blocks,
    ))
}

/// The varied settings of a combination in words.
fn name(one: &Combination, axes: &[String]) -> String {
    let varied = axes.iter().filter(|axis| *axis != "seed");
    let parts = varied.filter_map(|axis| {
        let value = readable(one.value(axis)?);
        Some(match axis.as_str() {
            "label" => value,
            axis => format!("{axis} {value}"),
        })
    });
    let name = parts.collect::<Vec<_>>().join(", ");
    match name.is_empty() {
        true => "all runs".to_owned(),
        false => name,
    }
}

/// The numbers of every run, then those of the measurements.
fn numbers(gathered: &Gathered, scenarios: &[Scenario]) -> Vec<Number> {
    let every = facts::NUMBERS.iter().map(|&(name, meaning, value)| Number {
        name: name.to_owned(),
        meaning: meaning.to_owned(),
        value: Box::new(move |run: &RunResult| value(&run.summary)),
    });
    let measurements = scenarios.iter().flat_map(|one| &one.measurements);
    let quantities = measurements.flat_map(|one| one.quantities());
    let known: BTreeMap<String, Quantity> = quantities.map(|one| (one.name.clone(), one)).collect();
    let names = gathered.numbers().into_iter();
    let measured = names.filter_map(|name| known.get(&name).cloned()).map(
        |Quantity {
             name,
             unit,
             meaning,
         }| Number {
            name: match unit {
                "" => name.clone(),
                unit => format!("{name} [{unit}]"),
            },
            meaning,
            value: Box::new(move |run: &RunResult| run.summary.metric(&name)),
        },
    );
    every.chain(measured).collect()
}

/// The results, and their definitions.
fn results(numbers: &[Number], combinations: &[Combination], names: &[String]) -> Vec<Block> {
    let parts = combinations.chunks(BESIDE).zip(names.chunks(BESIDE));
    let tables = parts.map(|(part, names)| Block::table(side_by_side(numbers, part, names)));
    let definitions = Table::of(numbers)
        .column("result", |number| number.name.as_str())
        .column("definition", |number| number.meaning.as_str())
        .table();
    let meaning = [
        Block::text("What the results mean:"),
        Block::Table(definitions, facts::DENSITY.to_owned()),
    ];
    tables.chain(meaning).collect()
}

/// Results in rows, combinations in columns.
fn side_by_side(numbers: &[Number], combinations: &[Combination], names: &[String]) -> Table {
    let mut columns = Table::of(numbers).column("result", |number| number.name.as_str());
    for (one, name) in combinations.iter().zip(names) {
        columns = columns.column(&format!("{name} ({} runs)", one.results.len()), |number| {
            let of_runs = one.results.iter().filter_map(|run| (number.value)(run));
            let values: Vec<f64> = of_runs.collect();
            let mean = spread(&values)?;
            let (count, all) = (values.len(), one.results.len());
            Some(match count < all {
                true => format!("{mean} [{count} of {all}]"),
                false => mean,
            })
        });
    }
    columns.table()
}

/// Mean, half the confidence interval, and range.
fn spread(values: &[f64]) -> Option<String> {
    let mean = MeanStd::of(values)?;
    let [least, most] = values
        .iter()
        .fold([f64::MAX, f64::MIN], |[low, high], &value| {
            [low.min(value), high.max(value)]
        });
    let text = match mean.interval_95() {
        _ if least == most => rounded(mean.mean),
        Some(half) => format!("{} ± {}", rounded(mean.mean), rounded(half)),
        None => rounded(mean.mean),
    };
    Some(match least == most {
        true => text,
        false => format!("{text} ({} to {})", rounded(least), rounded(most)),
    })
}

/// A number with four digits or more, as a reader compares them.
fn rounded(value: f64) -> String {
    let digits = match value.abs() {
        _ if value.fract() == 0.0 => 0,
        1000.0.. => 0,
        100.0.. => 1,
        10.0.. => 2,
        _ => 3,
    };
    format!("{value:.digits$}")
}

/// The picture of the study, and its mean curves.
fn figures(gathered: &Gathered, combinations: &[Combination], names: &[String]) -> Vec<Block> {
    let mut blocks = Vec::new();
    let drawing = Drawing {
        measurements: Vec::new(),
        over: Vec::new(),
    };
    if let Ok(Some(sheet)) = gathered.sheet(&drawing) {
        let caption = "Results over the varied settings; bands and bars are 95 % confidence intervals of the means.";
        blocks.push(Block::heading("Figures"));
        // Panels as large as those of other figures: few in each.
        blocks.extend(sheet.panels.chunks(PANELS).map(|panels| {
            let part = Sheet {
                panels: with_legend(panels.to_vec(), 2),
                columns: 2,
                ..sheet.clone()
            };
            Block::figure("", part, caption)
        }));
    }
    let numbered = combinations.iter().zip(names).enumerate();
    let drawn = numbered.take(MOST_LINES).flat_map(|(k, (one, name))| {
        let own = curves(&one.results).into_iter();
        own.map(move |curve| (curve, color(k), name.clone()))
    });
    let all: Vec<(Curve, _, String)> = drawn.collect();
    let kinds = distinct(all.iter().map(|(curve, ..)| curve.name.as_str()));
    let filled = kinds.iter().filter_map(|kind| {
        let lines = all.iter().filter(|(curve, ..)| curve.name == *kind);
        let own = lines.map(|(curve, color, name)| (curve, *color, name.clone()));
        panel(&own.collect::<Vec<_>>())
    });
    let panels: Vec<_> = filled.collect();
    if !panels.is_empty() {
        let columns = panels.len().min(2);
        let sheet = Sheet::new("", columns, [220.0, 160.0], with_legend(panels, columns));
        let caption = format!("Mean curves over the seeds; {BAND}.");
        blocks.push(Block::figure("", sheet, caption));
    }
    blocks
}

/// The commands, and the runs with their digests.
fn again(gathered: &Gathered, file: &Path, folder: &Path) -> [Block; 3] {
    let (file, folder) = (file.display(), folder.display());
    let commands = vec![
        format!("sandbox sweep {file} --out {folder}"),
        format!("sandbox report {file} --results {folder}"),
    ];
    let about = format!(
        "The runs. Digest: the first {DIGITS} of 64 digits of the SHA-256 of the final state, which the same version \
         gives again on any number of threads (version {}, engine {ENGINE}).",
        env!("CARGO_PKG_VERSION")
    );
    [
        Block::heading("How to run it again"),
        Block::Code(commands),
        Block::Table(cells(gathered), about),
    ]
}

fn cells(gathered: &Gathered) -> Table {
    let rows: Vec<_> = gathered.study.cells.iter().zip(&gathered.states).collect();
    Table::of(&rows)
        .column("run", |(cell, _)| cell.to_string())
        .column("state", |(_, state)| state.name())
        .column("end [s]", |(_, state)| {
            state
                .result()
                .map(|run| format!("{:.2}", run.summary.time_secs))
        })
        .column("digest, or why it failed", |(_, state)| match state {
            State::Finished(run) => {
                let digest = run.summary.state_sha256.chars();
                Some(digest.take(DIGITS).collect::<String>())
            }
            State::Failed(message) => Some(message.clone()),
            State::Missing => None,
        })
        .table()
}
