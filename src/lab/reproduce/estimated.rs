//! Table 1 as estimates: the paper's values beside ours in the limit of fine steps, with their errors.

use super::comparison::Band;
use super::published::{PublishedRow, published, written};
use super::row::BANDS_IN_WORDS;
use super::table1::{value_with_band, varied};
use crate::error::LabError;
use crate::estimate::{ABOUT, Answer, Answers, Reached};
use crate::sweep::Cell;
use output::document::{Block, Findings};
use output::table::Table;

/// A row of the paper beside ours.
type Row<'a> = (PublishedRow, &'a Answer);

/// The name of the table in documents.
pub const ESTIMATED: &str = "table1-estimate";

/// The table: a verdict says whether the whole interval of our value is inside of the band around the
/// paper's.
///
/// # Errors
/// The paper's values cannot be read, or it has no such row.
pub fn estimated(answers: &Answers) -> Result<Findings, LabError> {
    let paper = published().table1.rows;
    let pairs = answers.rows.iter().map(|(cell, answer)| {
        let published = paper.iter().find(|row| is_of(cell, row)).cloned();
        let row =
            published.ok_or_else(|| LabError::missing(cell.to_string(), "row of the paper"))?;
        Ok((row, answer))
    });
    let rows: Vec<Row> = pairs.collect::<Result<_, LabError>>()?;
    let mut columns = Table::of(&rows)
        .column("profile", |(paper, _)| written(&paper.profile))
        .column("setting", |(paper, _)| paper.varied.as_ref().map(varied));
    let mut counts = [0; 3];
    for name in answers.names() {
        let of = |row: &Row| value_with_band(&row.0, name);
        let reached = |row: &Row| Some(row.1.row(name)?.reached);
        for row in &rows {
            if let Some(((paper, band), ours)) = of(row).zip(reached(row)) {
                counts[verdict(paper, band, ours) as usize] += 1;
            }
        }
        columns = columns
            .fixed(&format!("{name}: paper"), 2, |row| {
                of(row).map(|(paper, _)| paper)
            })
            .column("ours", |(_, answer)| {
                let row = answer.row(name)?;
                let [value, error] = [row.reached.value, row.reached.error];
                Some(format!("{} ± {}", row.written(value), row.written(error)))
            })
            .column("difference", |row| {
                let (paper, band) = of(row)?;
                let off = reached(row)?.value - paper;
                Some(match band {
                    Band::Absolute(_) => format!("{off:+.2}"),
                    Band::Relative(_) => format!("{:+.1} %", 100.0 * off / paper),
                })
            })
            .column("band", |row| {
                let (paper, band) = of(row)?;
                Some(verdict(paper, band, reached(row)?).text())
            });
    }
    let [kept, undecided, missed] = counts;
    let verdict = format!(
        "{kept} of {} values are inside their bands with their whole interval, {missed} outside, {undecided} neither: \
         {BANDS_IN_WORDS}. The paper's values are those of its time step, ours of the limit of fine steps. {ABOUT}",
        counts.iter().sum::<usize>(),
    );
    answers.findings_with(vec![
        Block::Part(ESTIMATED.to_owned(), "Table 1 with errors".to_owned()),
        Block::table(columns.table()),
        Block::text(verdict),
        Block::Part("costs".to_owned(), "Costs".to_owned()),
        answers.cost(),
    ])
}

/// Whether a cell has the settings of a row.
fn is_of(cell: &Cell, row: &PublishedRow) -> bool {
    let number = |key: &str| cell.value(key).and_then(serde_json::Value::as_f64);
    let has_value = |varied: &super::Varied| number(&varied.setting) == Some(varied.value);
    cell.value("profile").and_then(|name| name.as_str()) == Some(&row.profile)
        && row.varied.as_ref().is_some_and(has_value)
}

/// Whether a value is inside of a band.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    /// Its whole interval is.
    Kept,
    /// A part of the interval is.
    Undecided,
    /// No part is.
    Missed,
}

impl Verdict {
    fn text(self) -> &'static str {
        match self {
            Self::Kept => "kept",
            Self::Undecided => "undecided",
            Self::Missed => "**missed**",
        }
    }
}

fn verdict(paper: f64, band: Band, reached: Reached) -> Verdict {
    let most = match band {
        Band::Relative(part) => part * paper.abs(),
        Band::Absolute(most) => most,
    };
    let off = (reached.value - paper).abs();
    if off + reached.error <= most {
        Verdict::Kept
    } else if off - reached.error > most {
        Verdict::Missed
    } else {
        Verdict::Undecided
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_kept_or_missed_only_with_its_whole_interval() {
        let of = |value, error| Reached {
            value,
            error,
            seeds: error,
            step: 0.0,
        };
        for (band, unit) in [(Band::Relative(0.1), 0.2), (Band::Absolute(0.2), 0.2)] {
            for side in [-1.0, 1.0] {
                let at =
                    |parts: f64, error| verdict(2.0, band, of(2.0 + side * parts * unit, error));
                assert_eq!(at(0.5, 0.09), Verdict::Kept);
                assert_eq!(at(0.5, 0.11), Verdict::Undecided);
                assert_eq!(at(1.5, 0.11), Verdict::Undecided);
                assert_eq!(at(1.5, 0.09), Verdict::Missed);
            }
        }
    }
}
