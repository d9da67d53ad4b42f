//! The tables and figures that can be reproduced.

use super::{figures, questions, table1, table2};
use crate::lab::error::LabError;
use crate::lab::jobs::finished;
use crate::lab::sweep::{Cell, Gathered, Study};
use crate::runs::job::{self, Listener};
use crate::runs::store::Store;

/// A table or a figure.
pub struct Product {
    /// Its name on the command line.
    pub name: &'static str,
    /// A description, in one line.
    pub about: &'static str,
    /// Is it part of `all`?
    pub in_all: bool,
    /// Its studies: files under `scenarios/studies/`, without their extension.
    pub studies: &'static [&'static str],
    /// What it needs of them.
    pub needs: Needs,
    /// Writes its files into the store's folder, and returns a text about them.
    pub write: fn(&[Gathered], &Store) -> Result<String, LabError>,
}

/// What a product needs of its studies.
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
    fn has(&self, cell: &Cell) -> bool {
        match self {
            Self::Labeled(labels) => cell.label().is_some_and(|own| labels.contains(&own)),
            Self::Seeds | Self::All | Self::Alone => true,
        }
    }
}

/// All products, in the paper's order.
pub const PRODUCTS: &[Product] = &[
    table1::PRODUCT,
    table2::PRODUCT,
    figures::FIG5,
    figures::FIG6,
    figures::FIG7,
    figures::WAVES,
    figures::FIG8,
    figures::FIG9,
    figures::FIG10,
    figures::FIG11,
    figures::STUDY,
    questions::PRODUCT,
];

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

/// Computes the missing runs of `products` and writes the products. Returns the text about each.
///
/// # Errors
/// A run fails, or a file cannot be written.
pub fn reproduce(
    products: &[&Product],
    seeds: u64,
    store: &Store,
    listener: &dyn Listener,
) -> Result<Vec<String>, LabError> {
    let studies: Result<Vec<Vec<Study>>, _> = products.iter().map(|p| p.studies(seeds)).collect();
    let studies = studies?;
    let mut jobs = Vec::new();
    for (product, studies) in products.iter().zip(&studies) {
        for study in studies {
            let mut own = study.jobs(|cell| product.needs.has(cell));
            own.iter_mut()
                .for_each(|job| job.alone = product.needs == Needs::Alone);
            jobs.extend(own);
        }
    }
    finished(&job::run(&jobs, store, None, listener)?)?;
    let write = |(product, studies): (&&Product, &Vec<Study>)| {
        let gathered = studies.iter().map(|study| Gathered::of(study, store));
        (product.write)(&gathered.collect::<Vec<_>>(), store)
    };
    products.iter().zip(&studies).map(write).collect()
}
