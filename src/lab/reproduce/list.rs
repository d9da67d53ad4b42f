//! The tables and figures that can be reproduced.

use super::product::{Needs, Product};
use super::{figures, questions, table1, table2};
use crate::error::LabError;
use crate::jobs::finished;
use crate::sweep::{Gathered, Study};
use output::document::Findings;
use runs::job::{self, Listener};
use runs::store::Store;

/// All products, in the paper's order, then questions about the tables.
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
];

/// Computes the missing runs of `products`, and returns what each found.
///
/// # Errors
/// A run fails, or its result cannot be stored.
pub fn reproduce(
    products: &[&Product],
    seeds: u64,
    store: &Store,
    listener: &dyn Listener,
) -> Result<Vec<Findings>, LabError> {
    let read: Result<Vec<Vec<Study>>, _> = products.iter().map(|p| p.studies(seeds)).collect();
    let studies = read?;
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
    let find = |(product, studies): (&&Product, &Vec<Study>)| {
        let gathered = studies.iter().map(|study| Gathered::of(study, store));
        (product.find)(product, &gathered.collect::<Vec<_>>())
    };
    products.iter().zip(&studies).map(find).collect()
}
