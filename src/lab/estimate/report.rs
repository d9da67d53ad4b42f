//! The answer for readers and programs.

use super::answer::{ABOUT, Answer, AtStep, ModelError, Row};
use super::bounds::Bounded;
use super::pictures::{bound_sheet, curve_sheet, sheet};
use super::run::Runs;
use crate::curves::csv as curves_csv;
use crate::error::LabError;
use crate::model::ModelPart;
use analysis::round;
use output::document::{Block, Document, Findings, Names};
use output::table::{Columns, Table, as_precise};

/// The names of the files with an answer: its results, the means at each step, bounds and curves.
pub fn names(name: &str) -> Names {
    let of = |end: &str| format!("{name}{end}");
    let [steps, bounds, curves] = ["-steps", "-bounds", "-curves"].map(of);
    Names::new(
        name,
        &[name, &steps, &bounds, &curves],
        &[name, &bounds, &curves],
    )
}

/// A row at one of its steps.
type Step<'a> = (&'a Row, &'a AtStep);

impl Answer {
    /// Everything for readers and programs, with these pictures of the results, of their curves and of the bounds.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self, name: &str, runs: &Runs) -> Result<Findings, LabError> {
        let names = names(name);
        let [main, steps, bounds, curves] = [0, 1, 2, 3].map(|k| names.tables[k].as_str());
        let mut blocks = self.blocks();
        let mut tables = Vec::new();
        if !self.results.is_empty() {
            blocks.push(Block::figure(main, sheet(runs, self), ""));
            tables.push((main, self.for_programs()));
            tables.push((steps, self.steps_for_programs()));
        }
        if !self.bounds.is_empty() {
            tables.push((bounds, self.bounds_for_programs()));
        }
        blocks.extend(bound_sheet(self).map(|sheet| Block::figure(bounds, sheet, "")));
        let drawn = curve_sheet(runs, self);
        if let Some((sheet, _)) = &drawn {
            blocks.push(Block::figure(curves, sheet.clone(), ""));
        }
        let title = format!("Estimate of {}", self.scenario);
        let whole = Findings::new(name, Document::of(title, blocks), self.json());
        let mut findings = tables.iter().try_fold(whole, |findings, (name, table)| {
            findings.with_table(name, table)
        })?;
        if let Some((_, rows)) = &drawn {
            findings.tables.push((curves.to_owned(), curves_csv(rows)?));
        }
        Ok(findings)
    }

    fn blocks(&self) -> Vec<Block> {
        let settings = match self.settings.is_empty() {
            true => String::new(),
            false => format!(", {}", self.settings.join(", ")),
        };
        let mut blocks = vec![Block::Text(format!(
            "{} ({}{settings}), {} % confidence. {ABOUT}",
            self.scenario,
            self.profile,
            round::brief(100.0 * self.confidence),
        ))];
        if !self.results.is_empty() {
            blocks.push(Block::table(self.results_table()));
            blocks.extend(
                Some(self.parts())
                    .filter(|text| !text.is_empty())
                    .map(Block::Text),
            );
            let about = "Means at each step (± standard deviation of runs):";
            blocks.push(Block::Table(self.steps_table(), about.to_owned()));
        }
        if !self.bounds.is_empty() {
            let about = "Bounds on single runs, at one time step whose error is not part of them:";
            blocks.push(Block::Table(self.bounds_table(), about.to_owned()));
            let sentences: String = self.bounds.iter().map(Bounded::sentence).collect();
            blocks.push(Block::Text(sentences));
        }
        blocks.push(Block::Text(self.costs() + "\n" + &self.limits()));
        blocks
    }

    /// The parts of the error of each result in words, a line for each.
    fn parts(&self) -> String {
        let percent = round::brief(100.0 * self.confidence);
        let line = |row: &Row| {
            let value = row.reached.value;
            let written = |number: f64| row.written(number);
            let [number, error] = [value, row.reached.error].map(written);
            let mut parts = vec![format!(
                "{}: {number}; chance and step ± {error} ({percent} %)",
                row.name
            )];
            parts.extend(row.parameters.map(|part| part.text(value, written)));
            parts.push(match &row.model {
                Some(ModelError::Known(part)) => part.text(value, written),
                Some(ModelError::Unknown { unknown }) => {
                    format!("the error of the model is not known: {unknown}")
                }
                None => return String::new(),
            });
            parts.join("; ") + "\n"
        };
        self.results.iter().map(line).collect()
    }

    /// Runs without values, and what was not reached, a line for each.
    fn limits(&self) -> String {
        let mut text = String::new();
        for (name, share) in self.runs.notable() {
            text += &format!("{} of {} runs {name}: {share}.\n", share.count, share.of);
        }
        for why in &self.without {
            text += &format!("{why}.\n");
        }
        if let Some(why) = &self.stopped {
            let reached = |row: &Row| format!("{} to {}", row.name, row.percent());
            let rows = self.results.iter();
            let rows = rows.filter(|row| !row.is_reached && row.missing == 0);
            let missed: Vec<String> = rows.map(reached).collect();
            if !missed.is_empty() {
                text += &format!("Not reached, as {why}: {}.\n", missed.join(", "));
            }
        }
        text
    }

    fn results_table(&self) -> Table {
        let columns = Table::of(&self.results)
            .column("result", |row| row.name.as_str())
            .column("value", |row| row.written(row.reached.value))
            .column("±", |row| row.written(row.reached.error))
            .column("± %", Row::percent)
            .column("seeds", |row| row.written(row.reached.seeds))
            .column("step", |row| row.written(row.reached.step))
            .column("wanted", |row| row.wanted.as_str())
            .column("reached", Row::yes_or_no)
            .column("order", |row| format!("{:.1}", row.order));
        match self.results.iter().any(|row| row.missing > 0) {
            true => columns
                .column("runs with a value", |row| row.with_value.to_string())
                .table(),
            false => columns.table(),
        }
    }

    fn bounds_table(&self) -> Table {
        let side = |bound: &Bounded| if bound.bound.is_upper() { "≤" } else { "≥" };
        Table::of(&self.bounds)
            .column("result", |bound| bound.bound.name.as_str())
            .column("runs", |bound| {
                let inner = round::brief(100.0 * bound.bound.inner());
                format!("{inner} % {}", side(bound))
            })
            .column("bound", |bound| {
                bound
                    .value
                    .map(|value| as_precise(value, 1e-3 * value.abs()))
            })
            .column("rank", |bound| {
                let rank = bound.rank.map_or("–".to_owned(), |rank| rank.to_string());
                format!("{rank} of {}", bound.runs)
            })
            .column("confidence", |bound| {
                let percent = |holds: f64| format!("{:.1} %", 100.0 * holds);
                bound.confidence.map(percent)
            })
            .column("step [s]", |bound| round::brief(bound.step))
            .table()
    }

    fn steps(&self) -> Vec<Step<'_>> {
        let rows = self.results.iter();
        rows.flat_map(|row| row.steps.iter().map(move |step| (row, step)))
            .collect()
    }

    fn steps_table(&self) -> Table {
        let rows = self.steps();
        by_step(&rows)
            .column("mean", |(row, at)| match at.deviation {
                Some(deviation) => format!("{} ± {}", row.written(at.mean), row.written(deviation)),
                None => row.written(at.mean),
            })
            .column("error of the step", |(row, at)| {
                row.written(at.error_of_step)
            })
            .table()
    }

    /// What the runs cost, and what the default settings would have cost.
    fn costs(&self) -> String {
        let mut text = format!(
            "{} runs, {} s of computing on one core.",
            self.runs.all,
            round::brief(self.secs)
        );
        for row in self.results.iter().filter(|row| row.reached.error > 0.0) {
            text += &row.at_default_step();
        }
        text
    }

    /// One line per result.
    fn for_programs(&self) -> Table {
        let finest = |row: &Row| row.steps.first().map(|at| at.step);
        let columns = Table::of(&self.results)
            .column("result", |row| row.name.as_str())
            .column("value", |row| row.reached.value)
            .column("error", |row| row.reached.error)
            .column("seeds", |row| row.reached.seeds)
            .column("step", |row| row.reached.step)
            .column("n", Row::runs)
            .column("wanted", |row| row.wanted.as_str())
            .column("reached", |row| row.is_reached)
            .column("confidence", |_| self.confidence)
            .column("finest_step_secs", finest)
            .column("order", |row| row.order)
            .column("missing", |row| row.missing)
            .column("with_value", |row| row.with_value.count)
            .column("with_value_low", |row| row.with_value.interval[0])
            .column("with_value_high", |row| row.with_value.interval[1])
            .column("parameters_low", |row| Some(row.parameters?.low))
            .column("parameters_high", |row| Some(row.parameters?.high))
            .column("model_low", |row| Some(row.model_part()?.low))
            .column("model_high", |row| Some(row.model_part()?.high));
        columns.table()
    }

    /// One line per bound.
    fn bounds_for_programs(&self) -> Table {
        let columns = Table::of(&self.bounds)
            .column("result", |bound| bound.bound.name.as_str())
            .column("share", |bound| bound.bound.share)
            .column("bound", |bound| bound.value)
            .column("rank", |bound| bound.rank)
            .column("n", |bound| bound.runs)
            .column("needed", |bound| bound.needed)
            .column("confidence", |bound| bound.confidence)
            .column("populations", |bound| bound.populations[0])
            .column("runs_per_population", |bound| bound.populations[1])
            .column("step_secs", |bound| bound.step)
            .column("missing", |bound| bound.missing);
        columns.table()
    }

    /// One line per result and step.
    fn steps_for_programs(&self) -> Table {
        let rows = self.steps();
        let columns = by_step(&rows)
            .column("mean", |(_, at)| at.mean)
            .column("deviation", |(_, at)| at.deviation)
            .column("error_of_step", |(_, at)| at.error_of_step);
        columns.table()
    }
}

/// The first columns of tables by step.
fn by_step<'r>(rows: &'r [Step<'r>]) -> Columns<'r, Step<'r>> {
    Table::of(rows)
        .column("result", |(row, _)| row.name.as_str())
        .column("step_secs", |(_, at)| at.step)
        .column("runs", |(_, at)| at.runs)
}

impl Bounded {
    /// What the bound means.
    fn sentence(&self) -> String {
        let [populations, repetitions] = self.populations;
        let of = match repetitions {
            1 => format!("{populations} populations with one run each"),
            _ => format!("{populations} populations with {repetitions} runs each"),
        };
        let missing = match self.missing {
            0 => String::new(),
            missing => format!(" {missing} runs have no value and count as beyond all others."),
        };
        let means = match self.confidence {
            Some(holds) => format!(
                "another run is beyond this value with at most {} % probability; this statement is true with {:.1} %",
                round::brief(100.0 * (1.0 - self.bound.inner())),
                100.0 * holds
            ),
            None => "runs with the same population are not independent, so no probability is given"
                .to_owned(),
        };
        format!("{}: {of}; {means}.{missing}\n", self.bound.name)
    }
}

impl Row {
    /// The bounds of the model's error, if they are known.
    fn model_part(&self) -> Option<&ModelPart> {
        match self.model.as_ref()? {
            ModelError::Known(part) => Some(part),
            ModelError::Unknown { .. } => None,
        }
    }

    /// A number of this result with as many decimals as its error has in two digits.
    pub fn written(&self, number: f64) -> String {
        as_precise(number, self.reached.error)
    }

    /// The error of the default step, and the runs at it alone that give the same error as all runs.
    fn at_default_step(&self) -> String {
        let (name, default) = (&self.name, self.default);
        let [found, reached] = [default.error_of_step, self.reached.error];
        let [error, around] = [found, reached].map(|error| self.written(error));
        let step = format!("default step of {} s", round::brief(default.timed.step));
        let what = match found.abs() < reached {
            true => format!("No error of the {step} was found in {name} (± {around})"),
            false => format!("The {step} has an error of {error} in {name}"),
        };
        match default.runs.map(f64::ceil) {
            Some(runs) => format!(
                " {what}: the same ± takes {runs} run{} at this step alone, {} s.",
                if runs == 1.0 { "" } else { "s" },
                round::brief(runs * default.timed.secs)
            ),
            None => format!(" {what}: no number of runs at this step gives ± {around}."),
        }
    }

    /// Whether the error is as small as asked for.
    pub(super) fn yes_or_no(&self) -> &'static str {
        ["no", "yes"][usize::from(self.is_reached)]
    }

    /// The half width in percent of the value.
    fn percent(&self) -> String {
        self.reached.percent().unwrap_or_else(|| "–".to_owned())
    }
}
