//! `sandbox reproduce`: the paper's tables and figures.

use super::arguments::ReproduceOptions;
use super::update::{check, update};
use super::watch::Watch;
use super::{Failure, say, use_threads};
use crate::reproduce::{PRODUCTS, Plan, Product, Store, reproduce};

/// The name for everything that has `in_all`.
const ALL: &str = "all";

/// What can be asked for.
pub fn names() -> Vec<&'static str> {
    PRODUCTS
        .iter()
        .map(|product| product.name)
        .chain([ALL])
        .collect()
}

/// What can be asked for, with a line about each.
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
        check(file)?;
    }
    let store = Store::open(&options.out)?;
    let plan = Plan {
        seeds: options.seeds,
    };
    let wanted = |product: &&Product| {
        let named = options.what.iter().any(|name| name == product.name);
        named || product.in_all && options.what.iter().any(|name| name == ALL)
    };
    let products: Vec<&Product> = PRODUCTS.iter().filter(wanted).collect();
    let watch = Watch::new();
    let said = reproduce(&products, &plan, &store, &watch);
    watch.ends();
    let said = said?;
    if let Some(file) = &options.update {
        let names = products.iter().map(|product| product.name);
        update(file, names.zip(said.iter().map(String::as_str)))?;
    }
    said.iter().try_for_each(say)
}
