//! The rows of a study, each with the errors asked for.

use serde_json::{Map, Value, json};

use super::answer::{ABOUT, Answer, Row};
use super::bounds::Bounded;
use super::question::{Question, QuestionError};
use super::run::run;
use super::wanted::Request;
use crate::error::LabError;
use crate::sweep::{Cell, Study, plain};
use analysis::round;
use output::document::{Block, Document, Findings, Names};
use output::table::{Columns, Table};
use runs::identity::ENGINE;
use runs::job::Listener;
use runs::store::Store;

/// The questions of a study: one for each combination of its settings.
pub struct Questions<'a> {
    study: &'a Study,
    wanted: Vec<String>,
    /// The first cell of each combination, with its question.
    pub rows: Vec<(&'a Cell, Question)>,
}

/// The answers to them.
pub struct Answers<'a> {
    pub(super) study: &'a Study,
    wanted: Vec<String>,
    /// The first cell of each combination, with its answer.
    pub rows: Vec<(&'a Cell, Answer)>,
}

impl<'a> Questions<'a> {
    /// The same request for each combination of settings. The study's number of seeds does not count; its first seed is
    /// the first one of each row.
    ///
    /// # Errors
    /// A combination does not have one of the results; the message names it.
    pub fn new(study: &'a Study, request: &Request) -> Result<Self, QuestionError> {
        let question = |cells: &'a [Cell]| {
            let cell = &cells[0];
            let question = Question::of(&cell.case, Vec::new(), request.clone(), study.memory);
            let in_row = |error| QuestionError::Row(cell.to_string(), Box::new(error));
            Ok((cell, question.map_err(in_row)?))
        };
        let rows = study.cells.chunks(study.seeds.max(1)).map(question);
        let wanted = request.wanted.iter().map(|wanted| wanted.name.clone());
        Ok(Self {
            study,
            wanted: wanted.collect(),
            rows: rows.collect::<Result<_, QuestionError>>()?,
        })
    }

    /// The names of the files with the answers.
    pub fn files(&self) -> Names {
        let name = name(self.study);
        Names::new(&name, &[&name], &[&name])
    }

    /// Makes the runs of all rows, row by row: each row knows the results of the rows before it.
    ///
    /// # Errors
    /// As [`run`](fn@super::run).
    pub fn answer(&self, store: &Store, listener: &dyn Listener) -> Result<Answers<'a>, LabError> {
        let all = self.rows.len();
        let (mut rows, mut known) = (Vec::new(), Vec::new());
        for (k, (cell, question)) in self.rows.iter().enumerate() {
            listener.notes(&format!("row {} of {all}: {cell}", k + 1));
            let runs = run(question, &known, store, listener)
                .map_err(|error| LabError::Failed(format!("{cell}: {error}")))?;
            known.extend(runs.known());
            rows.push((*cell, Answer::of(&runs)));
        }
        Ok(Answers {
            study: self.study,
            wanted: self.wanted.clone(),
            rows,
        })
    }
}

/// A combination of settings with its answer.
type Line<'a> = (&'a Cell, Answer);

impl Answers<'_> {
    /// Everything for readers and programs: the table of all results, then their costs.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self) -> Result<Findings, LabError> {
        self.findings_with(vec![
            Block::text(ABOUT),
            Block::table(self.table()),
            self.cost(),
        ])
    }

    /// The same with these blocks before the picture.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings_with(&self, mut blocks: Vec<Block>) -> Result<Findings, LabError> {
        let name = name(self.study);
        if !self.names().is_empty() {
            blocks.push(Block::figure(&name, self.sheet(), ""));
        }
        let title = format!("Estimates of the study {}", self.study.name);
        let findings = Findings::new(&name, Document::of(title, blocks), self.json());
        Ok(findings.with_table(&name, &self.for_programs())?)
    }

    /// The names of the wanted results.
    pub fn names(&self) -> &[String] {
        &self.wanted
    }

    /// The errors that are larger than asked for, and the results without values, a line for each.
    pub fn missed(&self) -> Vec<String> {
        let rows = self.rows.iter().flat_map(|(cell, answer)| {
            let reasons = answer.stopped.iter().chain(&answer.without);
            reasons.map(move |why| format!("{cell}: {why}"))
        });
        rows.collect()
    }

    /// As one JSON object.
    pub fn json(&self) -> Value {
        let entries = self.rows.iter().map(|(cell, answer)| {
            let settings: Map<String, Value> = cell.values.iter().cloned().collect();
            json!({ "settings": settings, "estimate": answer })
        });
        let rows: Vec<Value> = entries.collect();
        json!({ "study": self.study.name, "about": ABOUT, "engine": ENGINE, "rows": rows })
    }

    /// For readers: value ± error, and the number of runs.
    fn table(&self) -> Table {
        let mut columns = self.settings();
        for name in self.names() {
            columns = columns
                .column(name, |(_, answer)| {
                    let row = answer.row(name)?;
                    let [value, error] = [row.reached.value, row.reached.error];
                    Some(format!("{} ± {}", row.written(value), row.written(error)))
                })
                .column("reached", |(_, answer)| {
                    answer.row(name).map_or("no value", Row::yes_or_no)
                })
                .column("n", |(_, answer)| answer.row(name).map(Row::runs));
        }
        for (k, name) in self.bound_names().into_iter().enumerate() {
            columns = columns.column(&name, |(_, answer)| {
                answer.bounds[k].value.map(round::brief)
            });
        }
        columns.table()
    }

    /// What the rows cost.
    pub fn cost(&self) -> Block {
        let times = self.rows.iter().map(|(_, answer)| answer.secs);
        let secs = round::brief(times.sum());
        Block::Text(format!("{secs} s of computing on one core."))
    }

    /// For programs: one row per combination of settings.
    fn for_programs(&self) -> Table {
        let mut columns = self.settings();
        for name in self.names() {
            let reached = |line: &Line| Some(line.1.row(name)?.reached);
            columns = columns
                .column(name, |line| Some(reached(line)?.value))
                .column(&format!("{name}_error"), |line| Some(reached(line)?.error))
                .column(&format!("{name}_seeds"), |line| Some(reached(line)?.seeds))
                .column(&format!("{name}_step"), |line| Some(reached(line)?.step))
                .column(&format!("{name}_n"), |(_, answer)| {
                    answer.row(name).map(Row::runs)
                });
        }
        for (k, name) in self.bound_names().into_iter().enumerate() {
            columns = columns.column(&name, |(_, answer)| answer.bounds[k].value);
        }
        columns.table()
    }

    /// The names of bounds, with the share of runs in percent: `time_secs_95_percent`.
    fn bound_names(&self) -> Vec<String> {
        let first = self.rows.first();
        let asked = first.map(|(_, answer)| answer.bounds.as_slice());
        let bounds = asked.unwrap_or_default().iter();
        let percent = |of: &Bounded| round::brief(100.0 * of.bound.share);
        let name = |of: &Bounded| format!("{}_{}_percent", of.bound.name, percent(of));
        bounds.map(name).collect()
    }

    fn settings(&self) -> Columns<'_, Line<'_>> {
        let mut columns = Table::of(&self.rows);
        for axis in &self.study.axes {
            columns = columns.column(axis, |(cell, _)| {
                cell.value(axis).map_or(String::new(), plain)
            });
        }
        columns
    }
}

/// The name of the files with the answers, without an extension.
fn name(study: &Study) -> String {
    format!("{}-estimate", study.name)
}
