//! The report of a suite.

use serde_json::json;

use super::{Case, Check, Skipped, Suite, THROUGH_WALLS};
use crate::analysis::statistics::Range;
use crate::lab::error::LabError;
use crate::output::table::Table;
use crate::runs::store::Store;

/// The checks of one case with one profile and seed.
#[derive(Clone)]
pub struct Finding {
    /// The case.
    pub case: &'static Case,
    /// The profile.
    pub profile: String,
    /// The seed; `None` for means over seeds.
    pub seed: Option<u64>,
    /// The checks.
    pub checks: Vec<Check>,
}

impl Finding {
    /// Whether all values are as expected.
    pub fn is_passed(&self) -> bool {
        self.checks.iter().all(Check::is_passed)
    }
}

/// All findings.
pub struct Report {
    /// The suite.
    pub suite: &'static Suite,
    /// The profiles, in the order of the columns.
    pub profiles: Vec<String>,
    /// The findings, by case, profile and seed.
    pub findings: Vec<Finding>,
    /// Cases without data, which neither pass nor fail.
    pub skipped: Vec<Skipped>,
}

/// A check of a case, with all profiles and seeds.
struct Row<'a> {
    /// The findings of the case.
    findings: Vec<&'a Finding>,
    /// The number of the check.
    check: usize,
}

impl Row<'_> {
    fn case(&self) -> &'static Case {
        self.findings[0].case
    }

    fn check(&self) -> &Check {
        &self.findings[0].checks[self.check]
    }

    /// The check of walls is shown only if it fails.
    fn is_shown(&self) -> bool {
        let mut checks = self.findings.iter().map(|one| &one.checks[self.check]);
        self.check().quantity != THROUGH_WALLS || checks.any(|check| !check.is_passed())
    }

    /// The least and the largest value of a profile over the seeds, bold if one is not as expected.
    fn values(&self, profile: &str) -> String {
        let own = self.findings.iter().filter(|one| one.profile == profile);
        let checks: Vec<&Check> = own.map(|one| &one.checks[self.check]).collect();
        let values: Option<Vec<f64>> = checks.iter().map(|check| check.value).collect();
        let range = values.map(|values| Range::of(&values));
        let ends = range.map_or([None; 2], |range| [range.minimum, range.maximum].map(Some));
        let mut text = match ends.map(written) {
            [low, high] if low == high => low,
            [low, high] => format!("{low} to {high}"),
        };
        if let [only] = checks[..]
            && let Some(error) = only.error()
        {
            text += &format!(" ({:+.0} %)", 100.0 * error);
        }
        match checks.iter().all(|check| check.is_passed()) {
            true => text,
            false => format!("**{text}**"),
        }
    }
}

/// Three digits behind the point at most.
fn written(value: Option<f64>) -> String {
    let rounded = |value: f64| (1e3 * value).round() / 1e3;
    value.map_or("–".to_owned(), |value| rounded(value).to_string())
}

impl Report {
    /// Misses of the suite's profiles that are not known misses; empty if there are none.
    pub fn failures(&self) -> Vec<String> {
        let missed = self.findings.iter().filter(|finding| !finding.is_passed());
        let is_known = |one: &Finding| one.case.known_miss(&one.profile).is_some();
        let new = missed
            .filter(|one| self.suite.profiles.contains(&one.profile.as_str()) && !is_known(one));
        let lines = new.map(|finding| {
            let missed = finding.checks.iter().filter(|check| !check.is_passed());
            let missed = missed.map(|check| {
                let (value, expected) = (written(check.value), check.expected_written());
                format!("{} is {value}, expected {expected}", check.quantity)
            });
            let missed: Vec<String> = missed.collect();
            let Finding {
                case,
                profile,
                seed,
                ..
            } = finding;
            let seed = seed.map_or(String::new(), |seed| format!(", seed {seed}"));
            format!("case {}, {profile}{seed}: {}", case.id, missed.join("; "))
        });
        lines.collect()
    }

    /// Whether a profile passes a case with all seeds; `None` without a finding.
    fn is_passed(&self, case: &Case, profile: &str) -> Option<bool> {
        let own = |one: &&Finding| one.case.id == case.id && one.profile == profile;
        let mut own = self.findings.iter().filter(own).peekable();
        own.peek()?;
        Some(own.all(Finding::is_passed))
    }

    /// Known misses that pass with all seeds: they should be removed from the list.
    pub fn no_longer_missed(&self) -> Vec<String> {
        let passed = |case: &'static Case| {
            let misses = case.misses.iter().map(|(profile, _)| *profile);
            let passed = misses.filter(|profile| self.is_passed(case, profile) == Some(true));
            passed.map(move |profile| format!("case {}, {profile}: passes now", case.id))
        };
        self.cases().into_iter().flat_map(passed).collect()
    }

    /// The cases, in order.
    fn cases(&self) -> Vec<&'static Case> {
        let mut cases: Vec<&'static Case> = self.findings.iter().map(|one| one.case).collect();
        cases.dedup_by_key(|case| case.id);
        cases
    }

    /// All results as Markdown: a summary, a table, and the reasons of the misses.
    pub fn markdown(&self) -> String {
        let count = |profile: &String| {
            let cases = self.cases();
            let passed = cases
                .iter()
                .filter(|case| self.is_passed(case, profile) == Some(true));
            let values = self.findings.iter().filter(|one| one.profile == *profile);
            let values = values.flat_map(|one| &one.checks);
            let compared: Vec<&Check> = values.filter(|check| check.is_compared()).collect();
            let inside = compared.iter().filter(|check| check.is_passed()).count();
            let values = match compared.len() {
                0 => String::new(),
                count => format!(" ({inside} of {count} values)"),
            };
            format!(
                "{profile}: {} of {} cases{values}",
                passed.count(),
                cases.len()
            )
        };
        let counts: Vec<String> = self.profiles.iter().map(count).collect();
        let walls = match self
            .rows()
            .iter()
            .any(|row| row.check().quantity == THROUGH_WALLS)
        {
            false => " In no run did anyone pass through a wall.",
            true => "",
        };
        let table = self.table();
        // Consecutive cases that the same profiles miss for the same reason share a line.
        let mut reasons: Vec<(Vec<&str>, Vec<&str>, &str)> = Vec::new();
        for case in self.cases() {
            let missed = case.misses.iter();
            let missed = missed.filter(|(of, _)| self.is_passed(case, of) == Some(false));
            let missed: Vec<_> = missed.collect();
            for one_reason in missed.chunk_by(|a, b| a.1 == b.1) {
                let profiles: Vec<&str> = one_reason.iter().map(|(profile, _)| *profile).collect();
                let why = one_reason[0].1;
                match reasons.last_mut() {
                    Some((cases, of, same)) if *of == profiles && *same == why => {
                        cases.push(case.id)
                    }
                    _ => reasons.push((vec![case.id], profiles, why)),
                }
            }
        }
        let line = |(cases, profiles, why): (Vec<&str>, Vec<&str>, &str)| {
            format!(
                "- **{}**, {}: {why}.\n",
                cases.join(", "),
                profiles.join(", ")
            )
        };
        let mut misses: String = reasons.into_iter().map(line).collect();
        if !misses.is_empty() {
            misses = format!("\nKnown misses:\n\n{misses}");
        }
        let mut skips = match self.skipped.len() {
            0 => String::new(),
            count => format!("Skipped, for want of data: {count}.\n\n"),
        };
        for Skipped { case, why } in &self.skipped {
            skips += &format!("- **{}**, {}: {why}.\n", case.id, case.about);
        }
        if self.findings.is_empty() {
            return skips;
        }
        if !skips.is_empty() {
            skips.insert(0, '\n');
        }
        let counts = counts.join(", by ");
        format!("Passed by {counts}. Bold: not as expected.{walls}\n\n{table}{misses}{skips}")
    }

    fn rows(&self) -> Vec<Row<'_>> {
        let rows = self.cases().into_iter().flat_map(|case| {
            let own = self.findings.iter().filter(|one| one.case.id == case.id);
            let findings: Vec<&Finding> = own.collect();
            let checks = findings[0].checks.len();
            (0..checks).map(move |check| Row {
                findings: findings.clone(),
                check,
            })
        });
        rows.filter(Row::is_shown).collect()
    }

    fn table(&self) -> String {
        let rows = self.rows();
        let first = |row: &Row, text: &'static str| if row.check == 0 { text } else { "" };
        let mut table = Table::of(&rows)
            .column("case", |row| first(row, row.case().id))
            .column("what it shows", |row| first(row, row.case().about))
            .column("quantity", |row| row.check().quantity.clone())
            .column("expected", |row| row.check().expected_written());
        for profile in &self.profiles {
            table = table.column(profile, move |row| row.values(profile));
        }
        table.table().markdown()
    }

    /// Writes all results as Markdown, CSV and JSON into the store's folder, under the name of the suite.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, store: &Store) -> Result<(), LabError> {
        let name = |ending: &str| format!("{}.{ending}", self.suite.name);
        store.write(&name("md"), self.markdown().as_bytes())?;
        let rows = self.findings.iter().flat_map(|finding| {
            let checks = finding.checks.iter();
            checks.map(move |check| (finding, check))
        });
        let rows: Vec<(&Finding, &Check)> = rows.collect();
        let bound =
            |check: &Check, k: usize| Some(check.bounds()[k]).filter(|bound| bound.is_finite());
        let csv = Table::of(&rows)
            .column("case", |(finding, _)| finding.case.id)
            .column("profile", |(finding, _)| finding.profile.as_str())
            .column("seed", |(finding, _)| finding.seed)
            .column("quantity", |(_, check)| check.quantity.as_str())
            .column("value", |(_, check)| check.value)
            .column("least", |(_, check)| bound(check, 0))
            .column("most", |(_, check)| bound(check, 1))
            .column("passed", |(_, check)| check.is_passed());
        store.write(&name("csv"), &csv.table().csv()?)?;
        let entry = |finding: &Finding| {
            json!({
                "case": finding.case.id, "profile": finding.profile, "seed": finding.seed,
                "passed": finding.is_passed(), "checks": finding.checks,
            })
        };
        let skipped = self.skipped.iter();
        let skipped = skipped.map(|one| json!({"case": one.case.id, "skipped": one.why}));
        let entries: Vec<_> = self.findings.iter().map(entry).chain(skipped).collect();
        store.write(&name("json"), format!("{:#}\n", json!(entries)).as_bytes())?;
        Ok(())
    }
}
