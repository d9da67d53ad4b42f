//! How many values are as expected: by kind of case, and by whether they were fitted.

use super::check::Judgment;
use super::finding::{Finding, is_fitted};
use super::report::Report;
use crate::gallery::distinct;
use output::table::Table;

/// The values of a kind, by profile.
struct Line {
    name: String,
    /// For each profile, how many values are as expected, and of how many.
    counts: Vec<[usize; 2]>,
}

impl Report<'_> {
    /// How many values of each profile are as expected: a table with a line for each kind of case, then for values that
    /// the profile was fitted to, and for the others. `None` if no case has a kind.
    pub(super) fn counts(&self) -> Option<Table> {
        let findings = self.findings.iter();
        let kinds = distinct(findings.filter_map(|one| one.case.kind.as_deref()));
        if kinds.is_empty() {
            return None;
        }
        let of_kind = kinds.iter().map(|&kind| {
            self.line(kind, |finding, _| {
                finding.case.kind.as_deref() == Some(kind)
            })
        });
        let last = [
            self.line("all", |_, _| true),
            self.line("fitted to it", is_fitted),
            self.line("not fitted to it", |finding, check| {
                !is_fitted(finding, check)
            }),
        ];
        let lines: Vec<Line> = of_kind.chain(last).collect();
        let mut table =
            Table::of(&lines).column("values within the tolerance", |line| line.name.clone());
        for (k, profile) in self.profiles.iter().enumerate() {
            table = table.column(profile, move |line: &Line| {
                let [inside, all] = line.counts[k];
                match all {
                    0 => "–".to_owned(),
                    _ => format!("{inside} of {all}"),
                }
            });
        }
        Some(table.table())
    }

    /// The values of which `counts` is true, given the finding and the number of the check.
    fn line(&self, name: &str, counts: impl Fn(&Finding, usize) -> bool) -> Line {
        let counts = |profile: &String| self.count(profile, &counts);
        Line {
            name: name.to_owned(),
            counts: self.profiles.iter().map(counts).collect(),
        }
    }

    /// The values of a profile of which `counts` is true that are as expected, and all of them.
    pub(super) fn count(
        &self,
        profile: &str,
        counts: impl Fn(&Finding, usize) -> bool,
    ) -> [usize; 2] {
        let own = self.findings.iter().filter(|one| one.profile == profile);
        let checks = own.flat_map(|one| {
            let checks = one.checks.iter().enumerate();
            checks.map(move |(k, check)| (one, k, check))
        });
        let counted = checks
            .filter(|(finding, k, check)| check.expected.is_measured() && counts(finding, *k));
        let passed: Vec<bool> = counted
            .map(|(_, _, check)| Judgment::is_passed(check))
            .collect();
        let inside = passed.iter().filter(|&&passed| passed).count();
        [inside, passed.len()]
    }
}
