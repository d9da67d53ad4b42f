//! The tables and figures that can be reproduced.

use super::case::Case;
use super::error::ReproduceError;
use super::figures;
use super::runner::{Listener, Results, run};
use super::store::Store;
use super::{questions, table1, table2};

/// A table or a figure.
pub struct Product {
    /// Its name on the command line.
    pub name: &'static str,
    /// A description, in one line.
    pub about: &'static str,
    /// Is it part of `all`?
    pub in_all: bool,
    /// The cases that it needs.
    pub cases: fn(&Plan) -> Result<Vec<Case>, ReproduceError>,
    /// Writes its files into the store's folder, and returns a text about them.
    pub write: fn(&Plan, &Results, &Store) -> Result<String, ReproduceError>,
}

/// How much to compute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    /// Seeds per row of a table: 1, 2, …
    pub seeds: u64,
}

impl Plan {
    /// The seeds.
    pub fn seeds(&self) -> impl Iterator<Item = u64> + use<> {
        1..=self.seeds
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

/// Computes the missing cases of `products` and writes the products. Returns the text about each.
///
/// # Errors
/// A case cannot be computed, or a file cannot be written.
pub fn reproduce(
    products: &[&Product],
    plan: &Plan,
    store: &Store,
    listener: &dyn Listener,
) -> Result<Vec<String>, ReproduceError> {
    let mut cases = Vec::new();
    for product in products {
        cases.append(&mut (product.cases)(plan)?);
    }
    let results = run(store, &cases, listener)?;
    products
        .iter()
        .map(|product| (product.write)(plan, &results, store))
        .collect()
}
