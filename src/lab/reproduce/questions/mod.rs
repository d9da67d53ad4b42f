//! Questions that the paper leaves open, answered with runs of its tables with one change at a time.

mod crossing;
mod evacuation;
mod geometry;
mod variant;

use serde_json::json;

use super::error::ReproduceError;
use super::product::{Plan, Product};
use super::store::Store;

/// All questions.
pub const PRODUCT: Product = Product {
    name: "questions",
    about: "what walls, doorways, starts and guesses change in Tables 1 and 2",
    in_all: false,
    cases: |plan| {
        let mut cases = evacuation::cases(plan)?;
        cases.append(&mut crossing::cases(plan)?);
        Ok(cases)
    },
    write,
};

/// A question with the answer from the runs.
struct Answer {
    title: &'static str,
    /// What was varied, and how to read the table.
    text: &'static str,
    /// Markdown.
    table: String,
    data: serde_json::Value,
}

fn write(
    plan: &Plan,
    results: &super::runner::Results,
    store: &Store,
) -> Result<String, ReproduceError> {
    let mut answers = evacuation::answers(plan, results)?;
    answers.push(crossing::answer(plan, results)?);
    let sections = answers.iter().map(|answer| {
        let Answer {
            title, text, table, ..
        } = answer;
        format!("### {title}\n\n{text}\n\n{table}\n")
    });
    let seeds = format!("Over {} seed(s).\n\n", plan.seeds);
    let markdown: String = std::iter::once(seeds).chain(sections).collect();
    let data: Vec<_> = answers
        .iter()
        .map(|answer| json!({ "question": answer.title, "rows": answer.data }))
        .collect();
    let json = json!({ "seeds": plan.seeds, "questions": data });
    store.write("questions.md", markdown.as_bytes())?;
    store.write("questions.json", format!("{json:#}\n").as_bytes())?;
    Ok(markdown)
}
