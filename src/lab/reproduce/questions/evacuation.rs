//! Questions about the room (§6.1): flow with social forces, walls and start positions, agents that stay behind.

use serde::Serialize;
use serde_json::{Value, json};

use super::Answer;
use super::variant::{
    AVOIDING, BLENDING, EULER, FINE, JITTER, ROUND, SHIPPED, SOFT_WALLS, THIN_TWICE, THRICE, TWICE,
    Variant, WALLS,
};
use crate::lab::reproduce::case::{Case, CaseResult};
use crate::lab::reproduce::comparison::Spread;
use crate::lab::reproduce::error::ReproduceError;
use crate::lab::reproduce::product::Plan;
use crate::lab::reproduce::published::{EvacuationRow, published, written};
use crate::lab::reproduce::runner::Results;
use crate::lab::reproduce::table1;
use crate::output::table::Table;

/// A gap between two arrivals of at least this counts as a clog, seconds.
const PAUSE: f64 = 2.0;

/// Some rows of Table 1 with some variants.
struct Question {
    title: &'static str,
    text: &'static str,
    /// The rows by profile and value.
    rows: &'static [(&'static str, f64)],
    variants: &'static [Variant],
    /// The end of the runs, seconds; `None` for the scenario's own end.
    until: Option<f64>,
}

const QUESTIONS: [Question; 5] = [
    Question {
        title: "Why is SF's flow at K^ag ≥ 500 above the paper's?",
        text: "Each line changes one thing. *Locked* runs never reach the 350th arrival; pauses are gaps of 2 s and more \
               between arrivals, summed until the 350th; the flow between pauses leaves them out.",
        rows: &[("sf", 1000.0), ("sf", 500.0)],
        variants: &[
            SHIPPED, TWICE, EULER, FINE, SOFT_WALLS, ROUND, WALLS[0], THIN_TWICE,
        ],
        until: None,
    },
    Question {
        title: "What do wall thickness, doorway shape and start positions do?",
        text: "The goal stays 1 m beyond the outer face.",
        rows: &[
            ("sph", 5.0),
            ("sf->sph", 5.0),
            ("rvo->sph", 5.0),
            ("sf", 50.0),
        ],
        variants: &[SHIPPED, WALLS[0], WALLS[1], WALLS[3], ROUND, JITTER],
        until: None,
    },
    Question {
        title: "Can the last two SF agents stay behind, as in the paper?",
        text: "In the paper 398 of 400 leave in all eleven rows with SF or SF+SPH, and 400 in all others.",
        rows: &[
            ("sf", 50.0),
            ("sf", 250.0),
            ("sf+sph", 5.0),
            ("sf->sph", 5.0),
        ],
        variants: &[SHIPPED, TWICE, THRICE, WALLS[2], WALLS[3]],
        until: None,
    },
    Question {
        title: "Why is plain RVO less dense than the paper's?",
        text: "These runs end after 16 s, when the density has been taken.",
        rows: &[("rvo", 1000.0)],
        variants: &AVOIDING,
        until: Some(16.0),
    },
    Question {
        title: "Why does the density of SF→SPH at ρ⁰max = 6 vary more than the paper's?",
        text: "Each line changes one thing.",
        rows: &[("sf->sph", 6.0), ("sf->sph", 4.0)],
        variants: &BLENDING,
        until: None,
    },
];

/// A row of Table 1.
fn row(profile: &str, value: f64) -> Result<EvacuationRow, ReproduceError> {
    let mut rows = published()?.table1.rows.into_iter();
    rows.find(|row| row.profile == profile && row.value == value)
        .ok_or_else(|| ReproduceError::Data(format!("Table 1 has no {profile} {value}")))
}

impl Question {
    fn runs(
        &self,
        plan: &Plan,
    ) -> Result<Vec<(EvacuationRow, Variant, Vec<Case>)>, ReproduceError> {
        let mut runs = Vec::new();
        for &(profile, value) in self.rows {
            let row = row(profile, value)?;
            for &variant in self.variants {
                let case = |seed| self.shortened(variant.of(table1::case(&row, seed)));
                runs.push((row.clone(), variant, plan.seeds().map(case).collect()));
            }
        }
        Ok(runs)
    }

    /// `text`, or a dash if the runs are shortened and cannot tell.
    fn at_the_end(&self, text: String) -> String {
        match self.until {
            Some(_) => "–".to_owned(),
            None => text,
        }
    }

    fn shortened(&self, case: Case) -> Case {
        match self.until {
            Some(secs) => case.set("duration_secs", secs).taking(2.0),
            None => case,
        }
    }

    fn answer(&self, plan: &Plan, results: &Results) -> Result<Answer, ReproduceError> {
        let mut table = Table::new(
            0,
            &[
                "profile",
                "changed",
                "evacuated",
                "locked",
                "density [P/m²]",
                "its deviation",
                "flow [P/s]",
                "pauses [s]",
                "flow between pauses",
            ],
        );
        let mut data = Vec::new();
        for (row, variant, cases) in self.runs(plan)? {
            let outcome = Outcome::new(&cases, results)?;
            let symbol = table1::setting_written(&row.setting, row.value);
            let profile = format!("{}, {symbol}", written(&row.profile));
            table.add([
                profile,
                variant.name.to_owned(),
                self.at_the_end(outcome.evacuated_written()),
                self.at_the_end(format!("{} of {}", outcome.locked, cases.len())),
                Outcome::written(outcome.density),
                Outcome::written(outcome.deviation),
                Outcome::written(outcome.flow),
                Outcome::written(outcome.pauses),
                Outcome::written(outcome.flow_between_pauses),
            ]);
            data.push(json!({
                "profile": row.profile, "setting": row.setting, "value": row.value,
                "changed": variant.name, "outcome": outcome,
            }));
        }
        let papers: Result<Vec<String>, ReproduceError> = self
            .rows
            .iter()
            .map(|&(p, v)| Ok(paper(&row(p, v)?)))
            .collect();
        Ok(Answer {
            title: self.title,
            text: self.text,
            table: format!("{}\nThe paper: {}.\n", table.markdown(), papers?.join("; ")),
            data: Value::from(data),
        })
    }
}

/// The paper's values of a row.
fn paper(row: &EvacuationRow) -> String {
    format!(
        "{}, {}: {} evacuated, {:.2} [{:.2}] P/m², {:.2} P/s",
        written(&row.profile),
        table1::setting_written(&row.setting, row.value),
        row.evacuated,
        row.density,
        row.deviation,
        row.flow
    )
}

/// The results of a row and variant over the seeds.
#[derive(Debug, Clone, Serialize)]
struct Outcome {
    evacuated: Vec<usize>,
    locked: usize,
    density: Option<Spread>,
    deviation: Option<Spread>,
    flow: Option<Spread>,
    pauses: Option<Spread>,
    flow_between_pauses: Option<Spread>,
}

impl Outcome {
    fn new(cases: &[Case], results: &Results) -> Result<Self, ReproduceError> {
        let runs: Result<Vec<&CaseResult>, _> = cases.iter().map(|case| results.of(case)).collect();
        let runs = runs?;
        let metric = |name: &str| -> Result<Vec<f64>, ReproduceError> {
            let values: Result<Vec<_>, _> = runs.iter().map(|run| run.metric(name)).collect();
            Ok(values?.into_iter().flatten().collect())
        };
        let flow = metric("flow_per_s")?;
        let whole: Vec<&[f64]> = runs
            .iter()
            .filter_map(|run| run.arrivals.get(..350))
            .collect();
        let pauses: Vec<f64> = whole.iter().map(|times| paused(times)).collect();
        let between = whole.iter().zip(&pauses).map(|(times, paused)| {
            let span = times[times.len() - 1] - times[0];
            (times.len() - 1) as f64 / (span - paused)
        });
        let between: Vec<f64> = between.collect();
        Ok(Self {
            evacuated: runs.iter().map(|run| run.arrivals.len()).collect(),
            locked: runs.len() - flow.len(),
            density: Spread::of(&metric("density_mean_15s")?),
            deviation: Spread::of(&metric("density_std_15s")?),
            flow: Spread::of(&flow),
            pauses: Spread::of(&pauses),
            flow_between_pauses: Spread::of(&between),
        })
    }

    /// The number of evacuees: once if all runs agree, else for each run.
    fn evacuated_written(&self) -> String {
        let mut numbers = self.evacuated.clone();
        numbers.dedup();
        let each: Vec<String> = match numbers.as_slice() {
            [one] => vec![one.to_string()],
            _ => self.evacuated.iter().map(usize::to_string).collect(),
        };
        each.join(", ")
    }

    fn written(spread: Option<Spread>) -> String {
        spread.map_or_else(|| "–".to_owned(), |spread| spread.written())
    }
}

/// The sum of the pauses between arrivals, seconds.
fn paused(times: &[f64]) -> f64 {
    let gaps = times.windows(2).map(|pair| pair[1] - pair[0]);
    gaps.filter(|&gap| gap >= PAUSE)
        .fold(0.0, |sum, gap| sum + gap)
}

/// The cases of all questions.
pub(super) fn cases(plan: &Plan) -> Result<Vec<Case>, ReproduceError> {
    let mut cases = Vec::new();
    for question in &QUESTIONS {
        cases.extend(
            question
                .runs(plan)?
                .into_iter()
                .flat_map(|(_, _, cases)| cases),
        );
    }
    Ok(cases)
}

/// The answers to all questions.
pub(super) fn answers(plan: &Plan, results: &Results) -> Result<Vec<Answer>, ReproduceError> {
    QUESTIONS
        .iter()
        .map(|question| question.answer(plan, results))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pauses_are_long_gaps_only() {
        assert_eq!(paused(&[0.0, 1.0, 4.0, 4.5, 6.5]), 5.0);
        assert_eq!(paused(&[1.0]), 0.0);
    }

    #[test]
    fn the_numbers_of_evacuees_are_told_once_if_they_agree() {
        let outcome = |evacuated: &[usize]| Outcome {
            evacuated: evacuated.to_vec(),
            locked: 0,
            density: None,
            deviation: None,
            flow: None,
            pauses: None,
            flow_between_pauses: None,
        };
        assert_eq!(outcome(&[398, 398]).evacuated_written(), "398");
        assert_eq!(
            outcome(&[398, 400, 398]).evacuated_written(),
            "398, 400, 398"
        );
    }
}
