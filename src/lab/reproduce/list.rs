//! The tables and figures that can be reproduced.

use super::product::{Needs, Product};
use super::{figures, physics, questions, table1, table2};
use crate::error::LabError;
use crate::jobs::finished;
use crate::sweep::{Gathered, Study};
use runs::job::{self, Listener};
use runs::store::Store;

/// All products, in the paper's order, then open questions.
pub const PRODUCTS: &[Product] = &[
    table1::PRODUCT,
    table2::PRODUCT,
    figures::figure::<5>(),
    figures::figure::<6>(),
    figures::figure::<7>(),
    figures::WAVES,
    figures::figure::<8>(),
    figures::figure::<9>(),
    figures::figure::<10>(),
    figures::FIG11,
    figures::STUDY,
    questions::PRODUCT,
    physics::OSCILLATIONS,
    physics::SWAYING,
    physics::SWAYING_RATES,
    physics::START_WAVES,
    physics::QUEUE_PUSHES,
    physics::PHENOMENA,
];

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
