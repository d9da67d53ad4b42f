//! Two answers compared: which differences are larger than their errors.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::prior::Prior;
use super::series::{Reached, Series};
use crate::differences::names;
use crate::error::LabError;
use crate::jobs::read;
use output::document::{Block, Document, Findings};
use output::table::{Table, as_precise};

/// What is read of an answer.
#[derive(Deserialize)]
struct Kept {
    scenario: String,
    profile: String,
    settings: Vec<String>,
    confidence: f64,
    first_seed: u64,
    results: Vec<Row>,
}

#[derive(Deserialize)]
struct Row {
    name: String,
    #[serde(flatten)]
    reached: Reached,
    steps: Vec<AtStep>,
}

#[derive(Deserialize)]
struct AtStep {
    step: f64,
    values: Vec<Option<f64>>,
}

/// A result of two answers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Change {
    /// Its name.
    pub name: String,
    /// The value of the first answer.
    pub a: f64,
    /// The value of the second answer.
    pub b: f64,
    /// Their difference, B − A, in the limit of fine steps.
    pub change: f64,
    /// The half width of its confidence interval.
    pub error: f64,
    /// Whether it is the difference of runs with the same seeds: what chance adds to both of them cancels.
    pub is_paired: bool,
    /// Whether the difference is larger than its error.
    pub is_clear: bool,
    /// If it is not: how many times as many runs would make the error as small as the difference, if that stays.
    pub times_runs: Option<f64>,
}

/// Two answers compared.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Compared {
    /// What A and B are: scenario, profile and settings.
    pub titles: [String; 2],
    /// The probability of the intervals.
    pub confidence: f64,
    /// The results that both have.
    pub results: Vec<Change>,
    /// The results that one of them lacks.
    pub missing: Vec<String>,
}

/// Whether this is the JSON of an answer.
pub fn is_answer(value: &Value) -> bool {
    value["estimate"]["results"].is_array()
}

/// The differences between two answers, each with its name in messages.
///
/// # Errors
/// One of them is not the JSON of an answer, or they have intervals of different probabilities.
pub fn compared(answers: [(&str, &Value); 2]) -> Result<Compared, LabError> {
    let kept = |(name, answer): (&str, &Value)| {
        let kept: Result<Kept, LabError> = read(&answer["estimate"]);
        kept.map_err(|error| LabError::Data(format!("{name}: {error}")))
    };
    let [first, second] = answers;
    let (a, b) = (kept(first)?, kept(second)?);
    if a.confidence != b.confidence {
        let reason = format!(
            "{} and {}: intervals of {} and {} % cannot be compared; estimate one of them again with the \
             other --confidence",
            first.0,
            second.0,
            100.0 * a.confidence,
            100.0 * b.confidence
        );
        return Err(LabError::Data(reason));
    }
    let of = |name: &str, all: &Kept| all.results.iter().position(|row| row.name == name);
    let pairs = a
        .results
        .iter()
        .filter_map(|row| Some((row, &b.results[of(&row.name, &b)?])));
    let same_seeds = a.first_seed == b.first_seed;
    let results = pairs.map(|(one, other)| change(one, other, a.confidence, same_seeds));
    let only = |one: &Kept, other: &Kept| -> Vec<String> {
        let names = one.results.iter().map(|row| row.name.clone());
        names.filter(|name| of(name, other).is_none()).collect()
    };
    Ok(Compared {
        titles: [&a, &b].map(Kept::title),
        confidence: a.confidence,
        results: results.collect(),
        missing: [only(&a, &b), only(&b, &a)].concat(),
    })
}

impl Kept {
    /// Scenario, profile and settings.
    fn title(&self) -> String {
        let parts = [&self.profile].into_iter().chain(&self.settings);
        let parts: Vec<&str> = parts.map(String::as_str).collect();
        format!("{} ({})", self.scenario, parts.join(", "))
    }
}

fn change(a: &Row, b: &Row, confidence: f64, same_seeds: bool) -> Change {
    let paired = same_seeds.then(|| paired(a, b, confidence)).flatten();
    let (change, error) = match paired {
        Some(paired) => (paired.value, paired.error),
        None => (
            b.reached.value - a.reached.value,
            a.reached.error.hypot(b.reached.error),
        ),
    };
    let is_clear = change.abs() > error;
    let times = (error / change).powi(2);
    Change {
        name: a.name.clone(),
        a: a.reached.value,
        b: b.reached.value,
        change,
        error,
        is_paired: paired.is_some(),
        is_clear,
        times_runs: (!is_clear && times.is_finite()).then_some(times),
    }
}

/// The difference from pairs of runs with the same step and seed, if both answers have enough of them and pairs differ
/// less than runs with different seeds.
fn paired(a: &Row, b: &Row, confidence: f64) -> Option<Reached> {
    /// The part of the runs that must have a partner.
    const MOST: f64 = 0.8;
    let mut steps = Vec::new();
    let mut all: [Vec<Vec<Option<f64>>>; 3] = Default::default();
    let mut pairs = 0;
    for one in &a.steps {
        let Some(other) = b.steps.iter().find(|other| other.step == one.step) else {
            continue;
        };
        let pairs_of_step = one.values.iter().zip(&other.values);
        let both: Vec<(f64, f64)> = pairs_of_step
            .filter_map(|(x, y)| Some(((*x)?, (*y)?)))
            .collect();
        pairs += both.len();
        steps.push(one.step);
        all[0].push(both.iter().map(|(x, _)| Some(*x)).collect());
        all[1].push(both.iter().map(|(_, y)| Some(*y)).collect());
        all[2].push(both.iter().map(|(x, y)| Some(y - x)).collect());
    }
    let runs = |row: &Row| row.steps.iter().map(|at| at.values.len()).sum::<usize>();
    if (pairs as f64) < MOST * runs(a).max(runs(b)) as f64 {
        return None;
    }
    let [x, y, difference] = all.map(|values| {
        let steps = steps.clone();
        Series { steps, values }.means(&Prior::NONE)
    });
    let (x, y, difference) = (x?, y?, difference?);
    (difference.variance < x.variance + y.variance).then(|| difference.reached(confidence))
}

impl Compared {
    /// Everything for readers and programs.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self) -> Result<Findings, LabError> {
        let verdict = |one: &Change| match (one.is_clear, one.times_runs) {
            (true, _) => "differ".to_owned(),
            (false, Some(times)) if times < 1e3 => {
                format!("undecided; {times:.1} times the runs would decide")
            }
            (false, _) => "no difference found".to_owned(),
        };
        let table = Table::of(&self.results)
            .column("result", |one| one.name.as_str())
            .column("A", |one| as_precise(one.a, one.error))
            .column("B", |one| as_precise(one.b, one.error))
            .column("B − A", |one| as_precise(one.change, one.error))
            .column("±", |one| as_precise(one.error, one.error))
            .column(
                "seeds",
                |one| if one.is_paired { "same" } else { "different" },
            )
            .column("verdict", verdict)
            .table();
        let missing = match self.missing.as_slice() {
            [] => String::new(),
            names => format!("Only one of them has {}.\n", names.join(", ")),
        };
        let [a, b] = &self.titles;
        let interval = format!(
            "± is the {} % interval of the difference, from chance and time steps.",
            100.0 * self.confidence
        );
        let blocks = vec![
            Block::Text(format!("A: {a}\nB: {b}")),
            Block::table(table.clone()),
            Block::Text(missing + &interval),
        ];
        let document = Document::of("Comparison of two estimates", blocks);
        let name = names().name;
        let findings = Findings::new(&name, document, json!({ "compared": self }));
        Ok(findings.with_table(&name, &table)?)
    }
}
