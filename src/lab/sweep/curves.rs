//! The mean curves of a study: one for each combination of settings, with its band over the seeds.

use super::Study;
use super::gathered::Gathered;
use super::pictures::other;
use crate::curves::{BAND, Curve, csv, curves, panel};
use crate::error::LabError;
use crate::gallery::{color, distinct, with_legend};
use output::plot::Sheet;

/// The most lines of a picture: colors repeat after them.
const MOST_LINES: usize = 14;
/// The most panels in a row.
const COLUMNS: usize = 3;

/// The mean curves of a study, each with the label of its combination of settings.
pub(super) struct MeanCurves<'a> {
    study: &'a Study,
    all: Vec<(String, Curve)>,
}

impl Gathered<'_> {
    /// The mean curves, if the runs measure any.
    pub(super) fn mean_curves(&self) -> MeanCurves<'_> {
        let combinations = self.combinations();
        let all = combinations.iter().flat_map(|one| {
            let label = other(one, &[], &self.study.axes);
            let own = curves(&one.results).into_iter();
            own.map(move |curve| (label.clone(), curve))
        });
        MeanCurves {
            study: self.study,
            all: all.collect(),
        }
    }
}

impl MeanCurves<'_> {
    /// As CSV; `None` without curves.
    pub(super) fn csv(&self) -> Result<Option<Vec<u8>>, LabError> {
        match self.all.is_empty() {
            true => Ok(None),
            false => csv(&self.all).map(Some),
        }
    }

    /// As a picture of the first combinations; `None` without curves.
    pub(super) fn sheet(&self) -> Option<Sheet> {
        let all = &self.all;
        if all.is_empty() {
            return None;
        }
        let labels = distinct(all.iter().map(|(label, _)| label.as_str()));
        let names = distinct(all.iter().map(|(_, curve)| curve.name.as_str()));
        let drawn = names.iter().filter_map(|name| {
            let own = all.iter().filter(|(_, curve)| curve.name == *name);
            let lines = own.filter_map(|(label, curve)| {
                let number = labels.iter().position(|other| other == label)?;
                let label = format!(
                    "{label}{}{} runs",
                    if label.is_empty() { "" } else { ": " },
                    curve.runs
                );
                (number < MOST_LINES).then(|| (curve, color(number), label))
            });
            panel(&lines.collect::<Vec<_>>())
        });
        let panels = with_legend(drawn.collect(), COLUMNS);
        let title = format!("{}; {BAND}", self.study.name);
        let columns = COLUMNS.min(panels.len().max(1));
        Some(Sheet::new(&title, columns, [220.0, 160.0], panels))
    }
}
