//! Products: tables and figures.

use serde_json::{Value, json};

use crate::error::LabError;
use crate::sweep::{Cell, Gathered, Study};
use output::document::{Block, Document, Findings, Names};
use output::plot::Sheet;

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
    /// The names of its tables for programs.
    pub tables: &'static [&'static str],
    /// Whether it has a figure, which has its name.
    pub has_figure: bool,
    /// What its studies found.
    pub find: fn(&Product, &[Gathered]) -> Result<Findings, LabError>,
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
    /// The names of its files.
    pub fn names(&self) -> Names {
        let figures: &[&str] = if self.has_figure { &[self.name] } else { &[] };
        Names::new(self.name, self.tables, figures)
    }

    /// Its findings of these blocks.
    pub fn findings(&self, blocks: Vec<Block>, data: Value) -> Findings {
        Findings::new(self.name, Document::of(self.about, blocks), data)
    }

    /// Its findings if it is a figure.
    pub fn figure(&self, sheet: Sheet) -> Findings {
        let figure = Block::figure(self.name, sheet, self.about);
        let data = json!({ "figure": self.name, "about": self.about });
        self.findings(vec![figure], data)
    }

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
