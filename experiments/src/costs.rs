//! What runs with a preset alone would cost for the errors that estimates of rows of Table 1 reach.

use sandbox::analysis::round;
use sandbox::lab::error::LabError;
use sandbox::lab::estimate::{
    Answer, OfPreset, Question, QuestionError, Questions, Request, Timed,
};
use sandbox::lab::gallery::around;
use sandbox::lab::jobs::results;
use sandbox::lab::sweep::Study;
use sandbox::output::document::{Block, Document, Findings};
use sandbox::output::plot::{Axis, BLACK, Corner, GRAY, Mark, Panel, Sheet, Style, line_color};
use sandbox::output::table::Table;
use sandbox::runs::case::{Case, RunResult};
use sandbox::runs::error::RunError;
use sandbox::runs::job::{Job, Listener};
use sandbox::runs::store::Store;
use sandbox::scenario::Preset;
use serde_json::json;

/// The name of the results.
pub const COSTS: &str = "costs";
const PRESETS: [Preset; 3] = [Preset::Paper, Preset::Fast, Preset::Accurate];
/// The number of runs with each preset that are timed.
const TIMED: usize = 3;
/// What a row costs: by its estimate; by each preset, if the error of its step is known; by the paper's, if it is not.
const KINDS: [&str; 5] = ["estimate", "paper", "fast", "accurate", "paper, step found"];

/// Estimates rows of Table 1 with these errors, and times runs with each preset.
///
/// # Errors
/// A run fails, or results cannot be stored.
pub fn costs(
    request: &Request,
    store: &Store,
    listener: &dyn Listener,
) -> Result<Findings, LabError> {
    let study = Study::built_in("table1_errors", None, None)?;
    let invalid = |error: QuestionError| LabError::Data(error.to_string());
    let questions = Questions::new(&study, request).map_err(invalid)?;
    let answers = questions.answer(store, listener)?;
    let rows = questions.rows.iter().zip(&answers.rows);
    let rows = rows.map(|((cell, question), (_, answer))| {
        let timed = timed(question, store, listener)?;
        Ok((cell.to_string(), answer, secs(answer, timed)))
    });
    let rows: Vec<(String, &Answer, [Option<f64>; 5])> = rows.collect::<Result<_, LabError>>()?;
    let mut columns = Table::of(&rows).column("row", |(row, ..)| row.clone());
    for (k, kind) in KINDS.into_iter().enumerate() {
        columns = columns.column(&format!("{kind} [s]"), move |(.., secs)| {
            secs[k].map(round::brief)
        });
    }
    let table = columns.table();
    let colors = [line_color(0), GRAY, line_color(1), line_color(2), BLACK];
    let panel = |name: &String| {
        let points = |k: usize| {
            rows.iter().filter_map(move |(_, answer, secs)| {
                let of = answer.row(name)?.reached;
                Some([secs[k]?, 100.0 * of.error / of.value.abs()])
            })
        };
        let along = |axis: usize| (0..5).flat_map(points).map(move |point| point[axis]);
        let mark = |k: usize| Mark::dots(points(k), Style::full(colors[k], 2.2, KINDS[k]));
        let x = Axis::log("computing time [s]", around(along(0), 1.3));
        let y = Axis::log(&format!("error of {name} [%]"), around(along(1), 1.3));
        Panel::new("", x, y, (0..5).map(mark).collect()).with_legend(Corner::Beside)
    };
    let costs = answers.names().iter().map(panel);
    let panels = answers.panels().into_iter().chain(costs).collect();
    let title = "Costs of estimates and of presets";
    let sheet = Sheet::new(title, 2, [200.0, 130.0], panels);
    let blocks = vec![Block::table(table.clone()), Block::figure(COSTS, sheet, "")];
    let document = Document::of(title, blocks);
    let data = json!({ "estimates": answers.json(), "kinds": KINDS });
    Ok(Findings::new(COSTS, document, data).with_table(COSTS, &table)?)
}

/// The times of all runs that give the errors of an answer, seconds on one core, by their kinds; `None` if no number of
/// runs gives them.
fn secs(answer: &Answer, timed: [Timed; 3]) -> [Option<f64>; 5] {
    let rows = || answer.results.iter();
    let at = |timed: Timed| rows().map(move |row| OfPreset::of(timed, row));
    let [paper, fast, accurate] = timed.map(|timed| {
        let runs: Option<Vec<f64>> = at(timed).map(|of| of.runs).collect();
        Some(runs?.into_iter().fold(1.0, f64::max).ceil() * timed.secs)
    });
    let pairs = at(timed[0]).map(|of| of.runs_at_two_steps);
    // Half the step takes twice the time.
    let found = 3.0 * pairs.fold(2.0, f64::max).ceil() * timed[0].secs;
    [Some(answer.secs), paper, fast, accurate, Some(found)]
}

/// Runs with each preset.
fn timed(
    question: &Question,
    store: &Store,
    listener: &dyn Listener,
) -> Result<[Timed; 3], LabError> {
    let invalid = |error: RunError| LabError::of(question.title[0].clone(), error);
    let (step, secs) = (0.0, 0.0);
    let mut timed = PRESETS.map(|preset| Timed { preset, step, secs });
    for of in &mut timed {
        let case = |k| {
            let preset = ("preset", json!(of.preset));
            question.with([preset, ("seed", json!(question.seed(k)))])
        };
        let cases = (0..TIMED).map(case);
        let cases: Vec<Case> = cases.collect::<Result<_, _>>().map_err(invalid)?;
        let name = |case: &Case| format!("{:?}, seed {}", of.preset, case.seed);
        let jobs: Vec<Job> = cases.iter().map(|case| case.job(name(case))).collect();
        let results = results(&jobs, store, listener)?;
        for job in &jobs {
            let run: RunResult = results.of(&job.name, &job.key)?;
            of.step = run.summary.time_secs / run.summary.frames as f64;
            of.secs += run.wall_secs / TIMED as f64;
        }
    }
    Ok(timed)
}
