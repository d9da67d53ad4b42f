//! `sandbox reproduce`: the paper's tables and figures.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::update::{check, update};
use super::values::threads;
use super::watch::Watch;
use super::{Failure, say, use_threads};
use crate::lab::reproduce::{PRODUCTS, Product, reproduce};
use crate::runs::store::Store;

#[derive(Args)]
pub struct ReproduceOptions {
    /// Tables and figures to regenerate
    #[arg(required = true, value_parser = PossibleValuesParser::new(names()))]
    pub what: Vec<String>,
    /// Number of seeds per row of a table: 1, 2, …
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub seeds: u64,
    /// Folder for the results; cases finished there are not run again
    #[arg(long, value_name = "DIR", default_value = "reproduction")]
    pub out: PathBuf,
    /// Also insert the text about each table into this file, between the lines <!-- NAME --> and <!-- /NAME -->
    #[arg(long, value_name = "FILE.md")]
    pub update: Option<PathBuf>,
    /// Number of cases to compute at once, each on one thread [default: all cores]
    #[arg(long, value_parser = threads)]
    pub threads: Option<usize>,
}

/// The name of all products with `in_all`.
const ALL: &str = "all";

/// The names of all products, and [`ALL`].
pub fn names() -> Vec<&'static str> {
    PRODUCTS
        .iter()
        .map(|product| product.name)
        .chain([ALL])
        .collect()
}

/// All products and [`ALL`], each with a line about it.
pub fn about() -> String {
    let products = PRODUCTS.iter().map(|p| (p.name, p.about));
    let outside = PRODUCTS.iter().filter(|p| !p.in_all).map(|p| p.name);
    let without: Vec<&str> = outside.collect();
    let all = match without.as_slice() {
        [] => "everything".to_owned(),
        names => format!("everything but {}", names.join(", ")),
    };
    let lines = products.chain([(ALL, all.as_str())]);
    lines
        .map(|(name, about)| format!("  {name:<10} {about}\n"))
        .collect()
}

pub fn run(options: &ReproduceOptions) -> Result<(), Failure> {
    use_threads(options.threads)?;
    if let Some(file) = &options.update {
        check(file, &options.out)?;
    }
    let store = Store::open(&options.out)?;
    let wanted = |product: &&Product| {
        let named = options.what.iter().any(|name| name == product.name);
        named || product.in_all && options.what.iter().any(|name| name == ALL)
    };
    let products: Vec<&Product> = PRODUCTS.iter().filter(wanted).collect();
    let watch = Watch::new();
    let said = reproduce(&products, options.seeds, &store, &watch);
    watch.ends();
    let said = said?;
    // Results are printed even if they cannot be saved.
    let updated = options.update.as_ref().map_or(Ok(()), |file| {
        let names = products.iter().map(|product| product.name);
        update(file, names.zip(said.iter().map(String::as_str)))
    });
    said.iter().try_for_each(say)?;
    updated
}
