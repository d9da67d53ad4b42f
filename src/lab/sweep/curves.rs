//! The mean curves of a study: one for each combination of settings, with its band over the seeds.

use super::Study;
use super::gathered::Gathered;
use super::pictures::other;
use crate::curves::{BAND, Curve, csv, curves, panel};
use crate::error::LabError;
use crate::gallery::{color, distinct, with_legend};
use output::plot::{Print, Sheet};
use runs::store::Store;

/// The most lines of a picture: colors repeat after them.
const MOST_LINES: usize = 14;
/// The most panels in a row.
const COLUMNS: usize = 3;

impl Study {
    /// The names of the files with mean curves, if its runs measure any: a table and the picture.
    pub fn curve_files(&self) -> Vec<String> {
        let pictures = Print::of_program().extensions();
        let ends = ["csv"].into_iter().chain(pictures);
        ends.map(|end| format!("{}-curves.{end}", self.name))
            .collect()
    }
}

impl Gathered<'_> {
    /// Writes `NAME-curves.csv` and the picture into the store's folder, if the runs measure curves. The picture has
    /// the first combinations only, if there are many.
    ///
    /// # Errors
    /// A file cannot be written.
    pub(super) fn write_curves(&self, store: &Store) -> Result<Vec<String>, LabError> {
        let combinations = self.combinations();
        let all = combinations.iter().flat_map(|one| {
            let label = other(one, &[], &self.study.axes);
            let own = curves(&one.results).into_iter();
            own.map(move |curve| (label.clone(), curve))
        });
        let all: Vec<(String, Curve)> = all.collect();
        if all.is_empty() {
            return Ok(Vec::new());
        }
        let labels = distinct(all.iter().map(|(label, _)| label.as_str()));
        let names = distinct(all.iter().map(|(_, curve)| curve.name.as_str()));
        let panels = names.iter().filter_map(|name| {
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
        let panels = with_legend(panels.collect(), COLUMNS);
        let title = format!("{}; {BAND}", self.study.name);
        let columns = COLUMNS.min(panels.len().max(1));
        let sheet = Sheet::new(&title, columns, [220.0, 160.0], panels);
        let name = format!("{}-curves", self.study.name);
        store.write(&format!("{name}.csv"), &csv(&all)?)?;
        sheet.save(&store.path(&name))?;
        Ok(self.study.curve_files())
    }
}
