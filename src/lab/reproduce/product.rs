//! Products: tables and figures.

use crate::error::LabError;
use crate::sweep::{Cell, Gathered, Study};
use output::plot::Sheet;
use runs::store::Store;

/// A table or a figure.
pub struct Product {
    /// Its name on the command line.
    pub name: &'static str,
    /// A description, in one line.
    pub about: &'static str,
    /// Whether it is part of `all`.
    pub in_all: bool,
    /// Its studies, at least one: files under `scenarios/studies/`, without their extension.
    pub studies: &'static [&'static str],
    /// The cells that it needs.
    pub needs: Needs,
    /// Writes its files into the store's folder from its studies, and returns a text about them.
    pub write: fn(&[Gathered], &Store) -> Result<String, LabError>,
}

/// The cells that a product needs of its studies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Needs {
    /// All cells, with as many seeds as the user asks for.
    Seeds,
    /// All cells, with the seeds of the study.
    All,
    /// The cells with these labels.
    Labeled(&'static [&'static str]),
    /// All cells, each alone on all threads, because their computing time is measured.
    Alone,
}

impl Needs {
    pub(super) fn has(&self, cell: &Cell) -> bool {
        match self {
            Self::Labeled(labels) => cell.label().is_some_and(|own| labels.contains(&own)),
            Self::Seeds | Self::All | Self::Alone => true,
        }
    }
}

impl Product {
    /// Its studies, with `seeds` seeds per row if it is a table.
    ///
    /// # Errors
    /// A study is invalid.
    pub fn studies(&self, seeds: u64) -> Result<Vec<Study>, LabError> {
        let seeds = (self.needs == Needs::Seeds).then_some(seeds);
        let study = |name: &&str| Ok(Study::built_in(name, seeds, None)?);
        self.studies.iter().map(study).collect()
    }
}

/// Writes a picture into the store's folder, and returns a line with the file names.
pub(super) fn save(sheet: &Sheet, store: &Store, name: &str) -> Result<String, LabError> {
    let stem = store.path(name);
    sheet.save(&stem)?;
    Ok(format!("{0}.svg, {0}.png\n", stem.display()))
}
