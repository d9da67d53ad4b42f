//! `sandbox reproduce`: the paper's tables and figures.

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::arguments::ErrorOptions;
use super::estimate::all_reached;
use super::failure::Failure;
use super::terminal::say_text;
use super::update::CaseOptions;
use super::watch::Watch;
use lab::estimate::Questions;
use lab::machine::main_memory;
use lab::reproduce::{PRODUCTS, Product, estimated, reproduce};
use lab::sweep::Study;
use runs::store::Store;

#[derive(Args)]
pub struct ReproduceOptions {
    /// Tables and figures to regenerate
    #[arg(required = true, value_parser = PossibleValuesParser::new(names()))]
    pub what: Vec<String>,
    /// Number of seeds per row of a table: 1, 2, …
    #[arg(
        long,
        default_value_t = 5,
        conflicts_with = "asked",
        value_parser = clap::value_parser!(u64).range(1..=1000)
    )]
    pub seeds: u64,
    #[command(flatten)]
    pub error: ErrorOptions,
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
    if options.error.is_given() {
        return estimate(options);
    }
    let wanted = |product: &&Product| {
        let named = options.what.iter().any(|name| name == product.name);
        named || product.in_all && options.what.iter().any(|name| name == ALL)
    };
    let products: Vec<&Product> = PRODUCTS.iter().filter(wanted).collect();
    let names: Vec<&str> = products.iter().map(|product| product.name).collect();
    let store = options.cases.store(&names)?;
    let texts = reproduce(&products, options.seeds, &store, &Watch::new())?;
    let said = texts.iter().try_for_each(|text| say_text(text));
    options.cases.document.put(names.into_iter().zip(&texts))?;
    said
}

/// Table 1 with the errors asked for.
fn estimate(options: &ReproduceOptions) -> Result<(), Failure> {
    /// The name of the table in documents and files.
    const TABLE: &str = "table1-estimate";
    if options.what != ["table1"] || options.error.errors.is_empty() {
        let reason = "--error needs rows that have the same results; give it with table1 alone";
        return Err(Failure::Input(reason.to_owned()));
    }
    options.cases.check(&[TABLE])?;
    let study = Study::built_in("table1", None, main_memory())?;
    let questions = Questions::new(&study, &options.error.request())?;
    let store = Store::open(&options.cases.out)?;
    let answers = questions.answer(&store, &Watch::new())?;
    let text = estimated(&answers)?;
    answers.write(&store)?;
    let costs = answers.costs();
    store.write(
        &format!("{TABLE}.md"),
        format!("{text}\n{costs}").as_bytes(),
    )?;
    let said = say_text(&format!("{text}\n{costs}"));
    options.cases.document.put([(TABLE, &text)])?;
    said?;
    all_reached(&answers)
}
