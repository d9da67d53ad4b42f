//! The report of a suite.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::changed::Changed;
use super::check::Judgment;
use super::file::Suite;
use super::finding::{Finding, Lacks, Skipped, THROUGH_WALLS, is_fitted};
use super::keys::Case;
use super::passed::Passed;
use crate::error::LabError;
use analysis::statistics::Range;
use output::document::{Block, Document, Findings};
use output::plot::Sheet;
use output::table::Table;

/// All findings.
pub struct Report<'a> {
    /// The suite.
    pub suite: &'a Suite,
    /// The profiles, in the order of the columns.
    pub profiles: Vec<String>,
    /// The findings, by case, profile and seed.
    pub findings: Vec<Finding<'a>>,
    /// Cases without data, which neither pass nor fail.
    pub skipped: Vec<Skipped<'a>>,
    /// What is not as in the suite.
    pub changed: Changed,
    /// Figures of all results, by the names of their files.
    pub figures: Vec<(&'static str, Sheet)>,
}

/// A check of a case, with all profiles and seeds.
struct Row<'a> {
    /// The findings of the case.
    findings: &'a [Finding<'a>],
    /// The number of the check.
    check: usize,
}

impl Row<'_> {
    fn case(&self) -> &Case {
        self.findings[0].case
    }

    fn check(&self) -> &Judgment {
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
        let checks: Vec<&Judgment> = own.map(|one| &one.checks[self.check]).collect();
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

impl<'a> Report<'a> {
    /// Misses of the suite's profiles that are not known misses; empty if there are none.
    pub fn failures(&self) -> Vec<String> {
        let profiles = &self.suite.profiles;
        let is_new = |one: &&Finding| {
            let is_own = profiles.is_empty() || profiles.contains(&one.profile);
            !one.is_passed() && is_own && !one.case.known_misses.contains_key(&one.profile)
        };
        let lines = self.findings.iter().filter(is_new).map(|finding| {
            let wrong = finding.checks.iter().filter(|check| !check.is_passed());
            let sentences = wrong.map(|check| {
                let (value, expected) = (written(check.value), check.expected);
                format!("{} is {value}, expected {expected}", check.quantity)
            });
            let missed: Vec<String> = sentences.collect();
            let (case, profile) = (&finding.case.name, &finding.profile);
            let seed = finding
                .seed
                .map_or(String::new(), |seed| format!(", seed {seed}"));
            format!("case {case}, {profile}{seed}: {}", missed.join("; "))
        });
        lines.collect()
    }

    /// Whether a profile passes a case with all seeds; `None` without a finding.
    fn is_passed(&self, case: &Case, profile: &str) -> Option<bool> {
        let is_own = |one: &&Finding| one.case.name == case.name && one.profile == profile;
        let mut own = self.findings.iter().filter(is_own).peekable();
        own.peek()?;
        Some(own.all(Finding::is_passed))
    }

    /// The known misses of a case with this outcome: profiles and reasons, in the order of the suite's profiles.
    fn known_misses(&self, case: &'a Case, passed: bool) -> Vec<(&'a str, &'a str)> {
        let known = case.known_misses.iter();
        let now = known.filter(|(of, _)| self.is_passed(case, of) == Some(passed));
        let mut misses: Vec<_> = now.map(|(of, why)| (of.as_str(), why.as_str())).collect();
        misses.sort_by_key(|(of, _)| self.suite.profiles.iter().position(|own| own == of));
        misses
    }

    /// Known misses that pass with all seeds: they should be removed from the list.
    pub fn no_longer_missed(&self) -> Vec<String> {
        let passed = |case: &'a Case| {
            let passed = self.known_misses(case, true).into_iter();
            passed.map(|(profile, _)| format!("case {}, {profile}: passes now", case.name))
        };
        self.cases().into_iter().flat_map(passed).collect()
    }

    /// The cases, in order.
    fn cases(&self) -> Vec<&'a Case> {
        let mut cases: Vec<&Case> = self.findings.iter().map(|one| one.case).collect();
        cases.dedup_by_key(|case| &case.name);
        cases
    }

    /// Everything for readers and programs.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self) -> Result<Findings, LabError> {
        let mut blocks = Vec::new();
        if self.changed.is_anything() {
            let changed = self.changed.text();
            blocks.push(Block::Text(format!(
                "**Not the suite as it is**: {changed}."
            )));
        }
        if !self.findings.is_empty() {
            blocks.push(Block::text(self.overview()));
            blocks.extend(self.counts().map(Block::table));
            blocks.push(Block::table(self.table(&self.rows())));
            let reasons = self.reasons();
            if !reasons.is_empty() {
                blocks.push(Block::text("Known misses:"));
                blocks.push(Block::List(reasons));
            }
        }
        for lacks in [Lacks::Data, Lacks::Scene] {
            let own = self.skipped.iter().filter(|one| one.lacks == lacks);
            let skipped = own.map(|one| {
                let (name, title) = (&one.case.name, one.case.title());
                format!("**{name}**, {title}: {}.", one.why)
            });
            let skipped: Vec<String> = skipped.collect();
            if !skipped.is_empty() {
                let (why, count) = (lacks.reason(), skipped.len());
                blocks.push(Block::Text(format!("Skipped because {why}: {count}.")));
                blocks.push(Block::List(skipped));
            }
        }
        let figures = self.figures.iter();
        blocks.extend(figures.map(|(name, sheet)| Block::figure(name, sheet.clone(), "")));
        let document = Document::of(format!("Results of the suite {}", self.suite.name), blocks);
        let findings = Findings::new(&self.suite.name, document, self.json());
        Ok(findings.with_table(&self.suite.name, &self.values())?)
    }

    /// How many cases each profile passes.
    fn overview(&self) -> String {
        let checks = self.findings.iter().flat_map(|one| &one.checks);
        let mut passages = checks
            .filter(|check| check.quantity == THROUGH_WALLS)
            .peekable();
        let walls = match passages.peek().is_some() && passages.all(Judgment::is_passed) {
            true => " In no run did anyone pass through a wall.",
            false => "",
        };
        let counted = self.profiles.iter().map(|profile| self.counted(profile));
        let counts = counted.collect::<Vec<_>>().join(", by ");
        format!("Passed by {counts}. Bold: not as expected.{walls}")
    }

    /// What a profile passes.
    pub fn passed(&self, profile: &str) -> Passed {
        let cases = self.cases();
        let is_missed = |case: &&&Case| self.is_passed(case, profile) != Some(true);
        let missed: Vec<String> = cases
            .iter()
            .filter(is_missed)
            .map(|case| case.name.clone())
            .collect();
        Passed {
            cases: cases.len(),
            passed: cases.len() - missed.len(),
            missed,
            values: self.count(profile, |_, _| true),
            fitted: self.count(profile, is_fitted),
            ratios: self.ratios(profile),
        }
    }

    /// The values of a profile over the measured ones, by case and name.
    fn ratios(&self, profile: &str) -> BTreeMap<String, BTreeMap<String, f64>> {
        let own = self.findings.iter().filter(|one| one.profile == profile);
        let of_case = own.map(|finding| {
            let values = finding.checks.iter().filter_map(|check| {
                let ratio = 1.0 + check.error()?;
                Some((check.quantity.clone(), (1e4 * ratio).round() / 1e4))
            });
            (
                finding.case.name.clone(),
                values.collect::<BTreeMap<_, _>>(),
            )
        });
        of_case.filter(|(_, values)| !values.is_empty()).collect()
    }

    /// The same in words.
    fn counted(&self, profile: &str) -> String {
        let Passed {
            cases,
            passed,
            values,
            ..
        } = self.passed(profile);
        let values = match values {
            [_, 0] => String::new(),
            [inside, count] => format!(" ({inside} of {count} values)"),
        };
        format!("{profile}: {passed} of {cases} cases{values}")
    }

    /// The reasons of known misses. Consecutive cases that the same profiles miss for the same reason share a line.
    fn reasons(&self) -> Vec<String> {
        let mut reasons: Vec<(Vec<&str>, Vec<&str>, &str)> = Vec::new();
        for case in self.cases() {
            let missed = self.known_misses(case, false);
            for one_reason in missed.chunk_by(|a, b| a.1 == b.1) {
                let profiles: Vec<&str> = one_reason.iter().map(|(profile, _)| *profile).collect();
                let why = one_reason[0].1;
                match reasons.last_mut() {
                    Some((cases, of, same)) if *of == profiles && *same == why => {
                        cases.push(&case.name)
                    }
                    _ => reasons.push((vec![&case.name], profiles, why)),
                }
            }
        }
        let line = |(cases, profiles, why): (Vec<&str>, Vec<&str>, &str)| {
            format!("**{}**, {}: {why}.", cases.join(", "), profiles.join(", "))
        };
        reasons.into_iter().map(line).collect()
    }

    fn rows(&self) -> Vec<Row<'_>> {
        let of_cases = self.findings.chunk_by(|a, b| a.case.name == b.case.name);
        let rows = of_cases.flat_map(|findings| {
            let checks = 0..findings[0].checks.len();
            checks.map(move |check| Row { findings, check })
        });
        rows.filter(Row::is_shown).collect()
    }

    fn table(&self, rows: &[Row]) -> Table {
        let first = |row: &Row, text: String| if row.check == 0 { text } else { String::new() };
        let mut table = Table::of(rows)
            .column("case", |row| first(row, row.case().name.clone()))
            .column("what it shows", |row| first(row, row.case().title()))
            .column("quantity", |row| row.check().quantity.clone())
            .column("expected", |row| row.check().expected.to_string());
        for profile in &self.profiles {
            table = table.column(profile, move |row| row.values(profile));
        }
        table.table()
    }

    /// One row for each value.
    fn values(&self) -> Table {
        let checks = self.findings.iter().flat_map(|finding| {
            let checks = finding.checks.iter();
            checks.map(move |check| (finding, check))
        });
        let rows: Vec<(&Finding, &Judgment)> = checks.collect();
        let bound = |check: &Judgment, k: usize| {
            let bound = check.expected.bounds()[k];
            bound.is_finite().then_some(bound)
        };
        let values = Table::of(&rows)
            .column("case", |(finding, _)| finding.case.name.as_str())
            .column("profile", |(finding, _)| finding.profile.as_str())
            .column("seed", |(finding, _)| finding.seed)
            .column("quantity", |(_, check)| check.quantity.as_str())
            .column("value", |(_, check)| check.value)
            .column("least", |(_, check)| bound(check, 0))
            .column("most", |(_, check)| bound(check, 1))
            .column("passed", |(_, check)| check.is_passed());
        let changed = self.changed.text();
        match self.changed.is_anything() {
            true => values.column("changed", |_| changed.as_str()).table(),
            false => values.table(),
        }
    }

    /// One object for each case, profile and seed.
    fn json(&self) -> Value {
        let entry = |finding: &Finding| {
            json!({
                "case": finding.case.name, "profile": finding.profile, "seed": finding.seed,
                "passed": finding.is_passed(), "checks": finding.checks,
            })
        };
        let skipped = self.skipped.iter();
        let skipped = skipped.map(|one| json!({"case": one.case.name, "skipped": one.why}));
        let mut entries: Vec<Value> = self.findings.iter().map(entry).chain(skipped).collect();
        if self.changed.is_anything() {
            let entries = entries.iter_mut();
            entries.for_each(|entry| entry["changed"] = json!(self.changed));
        }
        json!(entries)
    }
}
