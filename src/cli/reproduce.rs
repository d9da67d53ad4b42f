//! `sandbox reproduce`: the paper's tables and figures.

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::failure::Failure;
use super::terminal::say;
use super::update::CaseOptions;
use super::watch::Watch;
use crate::lab::reproduce::{PRODUCTS, Product, reproduce};

#[derive(Args)]
pub struct ReproduceOptions {
    /// Tables and figures to regenerate
    #[arg(required = true, value_parser = PossibleValuesParser::new(names()))]
    pub what: Vec<String>,
    /// Number of seeds per row of a table: 1, 2, …
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub seeds: u64,
    #[command(flatten)]
    pub cases: CaseOptions,
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
        .map(|(name, about)| format!("  {name:<12} {about}\n"))
        .collect()
}

pub fn run(options: &ReproduceOptions) -> Result<(), Failure> {
    let wanted = |product: &&Product| {
        let named = options.what.iter().any(|name| name == product.name);
        named || product.in_all && options.what.iter().any(|name| name == ALL)
    };
    let products: Vec<&Product> = PRODUCTS.iter().filter(wanted).collect();
    let names: Vec<&str> = products.iter().map(|product| product.name).collect();
    let store = options.cases.store(&names)?;
    let texts = reproduce(&products, options.seeds, &store, &Watch::new())?;
    let said = texts.iter().try_for_each(say);
    options.cases.document.put(names.into_iter().zip(&texts))?;
    said
}
