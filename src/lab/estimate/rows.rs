//! The rows of a study, each with the errors asked for.

use serde_json::{Map, Value, json};

use super::answer::{ABOUT, Answer, Row};
use super::question::{Question, QuestionError};
use super::run::run;
use super::wanted::Request;
use crate::lab::error::LabError;
use crate::lab::gallery::{spanned, with_legend};
use crate::lab::sweep::{Cell, Study, plain};
use crate::output::plot::{Axis, BLACK, Mark, Panel, Point, Print, Sheet, Style};
use crate::output::table::{Columns, Table};
use crate::runs::identity::ENGINE;
use crate::runs::job::Listener;
use crate::runs::store::Store;

/// The most panels in a row.
const COLUMNS: usize = 3;

/// The questions of a study: one for each combination of its settings.
pub struct Questions<'a> {
    study: &'a Study,
    questions: Vec<(&'a Cell, Question)>,
}

/// The answers to them.
pub struct Answers<'a> {
    study: &'a Study,
    /// The first cell of each combination, with its answer.
    pub rows: Vec<(&'a Cell, Answer)>,
}

impl<'a> Questions<'a> {
    /// The same request for each combination of settings. The study's number of seeds does not count; its first seed is
    /// the first one of each row.
    ///
    /// # Errors
    /// A combination does not have one of the results.
    pub fn new(study: &'a Study, request: &Request) -> Result<Self, QuestionError> {
        let firsts = study
            .cells
            .chunks(study.seeds.max(1))
            .map(|cells| &cells[0]);
        let question = |cell: &'a Cell| {
            let question = Question::of(&cell.case, Vec::new(), request.clone(), study.memory)?;
            Ok((cell, question))
        };
        Ok(Self {
            study,
            questions: firsts.map(question).collect::<Result<_, QuestionError>>()?,
        })
    }

    /// The names of the files with the answers.
    pub fn files(&self) -> Vec<String> {
        let pictures = Print::of_program().extensions();
        let ends = ["json", "csv"].into_iter().chain(pictures);
        ends.map(|end| format!("{}-estimate.{end}", self.study.name))
            .collect()
    }

    /// Makes the runs of all rows, row by row.
    ///
    /// # Errors
    /// As [`run`](fn@super::run).
    pub fn answer(&self, store: &Store, listener: &dyn Listener) -> Result<Answers<'a>, LabError> {
        let all = self.questions.len();
        let rows = self
            .questions
            .iter()
            .enumerate()
            .map(|(k, (cell, question))| {
                listener.notes(&format!("row {} of {all}: {cell}", k + 1));
                let runs = run(question, store, listener)
                    .map_err(|error| LabError::Failed(format!("{cell}: {error}")))?;
                Ok((*cell, Answer::of(&runs)))
            });
        Ok(Answers {
            study: self.study,
            rows: rows.collect::<Result<_, LabError>>()?,
        })
    }
}

/// A combination of settings with its answer.
type Line<'a> = (&'a Cell, Answer);

impl Answers<'_> {
    /// The names of the results.
    fn names(&self) -> Vec<String> {
        let first = self.rows.first();
        let results = first.map(|(_, answer)| answer.results.as_slice());
        let results = results.unwrap_or_default().iter();
        results.map(|row| row.name.clone()).collect()
    }

    /// The errors that are larger than asked for, a line for each.
    pub fn missed(&self) -> Vec<String> {
        let rows = self.rows.iter().filter_map(|(cell, answer)| {
            let why = answer.stopped.as_ref()?;
            Some(format!("{cell}: {why}"))
        });
        rows.collect()
    }

    /// As one JSON object.
    pub fn json(&self) -> Value {
        let rows = self.rows.iter().map(|(cell, answer)| {
            let settings: Map<String, Value> = cell.values.iter().cloned().collect();
            json!({ "settings": settings, "estimate": answer })
        });
        let rows: Vec<Value> = rows.collect();
        json!({ "study": self.study.name, "about": ABOUT, "engine": ENGINE, "rows": rows })
    }

    /// For a terminal: value ± error, and the number of runs.
    pub fn text(&self) -> String {
        let mut columns = self.settings();
        for (k, name) in self.names().iter().enumerate() {
            columns = columns
                .column(name, |(_, answer)| {
                    let row = &answer.results[k];
                    let [value, error] = [row.reached.value, row.reached.error];
                    format!("{} ± {}", row.written(value), row.written(error))
                })
                .column("reached", |(_, answer)| answer.results[k].yes_or_no())
                .column("n", |(_, answer)| runs(&answer.results[k]));
        }
        format!("{ABOUT}\n\n{}", columns.table().text())
    }

    /// As CSV.
    ///
    /// # Errors
    /// The table cannot be written.
    pub fn csv(&self) -> Result<Vec<u8>, LabError> {
        let mut columns = self.settings();
        for (k, name) in self.names().iter().enumerate() {
            columns = columns
                .column(name, |(_, answer)| answer.results[k].reached.value)
                .column(&format!("{name}_error"), |(_, answer)| {
                    answer.results[k].reached.error
                })
                .column(&format!("{name}_seeds"), |(_, answer)| {
                    answer.results[k].reached.seeds
                })
                .column(&format!("{name}_step"), |(_, answer)| {
                    answer.results[k].reached.step
                })
                .column(&format!("{name}_n"), |(_, answer)| runs(&answer.results[k]));
        }
        Ok(columns.table().csv()?)
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

    /// A panel for each result, with an error bar for each row.
    pub fn sheet(&self) -> Sheet {
        let axes = &self.study.axes;
        let label = |cell: &Cell| {
            let values = axes.iter().filter_map(|axis| cell.value(axis)).map(plain);
            values.collect::<Vec<_>>().join(", ")
        };
        let labels: Vec<String> = self.rows.iter().map(|(cell, _)| label(cell)).collect();
        let panels = self.names().into_iter().enumerate().map(|(k, name)| {
            let points = self
                .rows
                .iter()
                .enumerate()
                .map(|(place, (_, answer))| Point {
                    x: place as f64 + 0.5,
                    y: answer.results[k].reached.value,
                    error: answer.results[k].reached.error,
                });
            let points: Vec<Point> = points.collect();
            let ends = points.iter().flat_map(|p| [p.y - p.error, p.y + p.error]);
            let x = Axis::names(&axes.join(", "), labels.clone());
            let y = Axis::linear(&name, spanned(ends));
            let marks = vec![Mark::Points(points, Style::full(BLACK, 2.4, ""))];
            Panel::new("", x, y, marks)
        });
        let panels = with_legend(panels.collect(), COLUMNS);
        Sheet::new(
            &self.study.name,
            COLUMNS.min(panels.len().max(1)),
            [200.0, 130.0],
            panels,
        )
    }
}

/// The number of runs with a value.
fn runs(row: &Row) -> usize {
    row.steps.iter().map(|at| at.runs).sum()
}
