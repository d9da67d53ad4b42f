//! `sandbox reproduce`: the paper's tables and figures.

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::arguments::ErrorOptions;
use super::documents::add_folder;
use super::estimate::all_reached;
use super::failure::Failure;
use super::terminal::talk;
use super::update::CaseOptions;
use super::watch::Watch;
use lab::estimate::Questions;
use lab::machine::main_memory;
use lab::reproduce::{ESTIMATED, PRODUCTS, Product, estimated, reproduce};
use lab::sweep::Study;
use output::document::{Findings, Names};
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
    PRODUCTS.iter().map(|one| one.name).chain([ALL]).collect()
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
    let cases = &options.cases;
    cases.apply(&names)?;
    let files: Vec<Names> = products.iter().map(|product| product.names()).collect();
    let mut outputs = cases.outputs([]);
    for files in &files {
        add_folder(&mut outputs, &cases.out, files);
    }
    outputs.may_replace(cases.replace.force);
    cases
        .files
        .add_to(&mut outputs, &Names::joined(TITLE, &files));
    outputs.check()?;
    let store = Store::open(&cases.out)?;
    let found = reproduce(&products, options.seeds, &store, &Watch::new())?;
    for one in &found {
        one.write(&cases.out)?;
    }
    let folder = cases.out.display();
    talk(&format!("note: {} are in {folder}", names.join(", ")));
    let all = Findings::joined(TITLE, "Tables and figures of the paper", found);
    let said = cases.files.give(&all, cases.json, None);
    cases.document.put(all.document.parts(TITLE))?;
    said
}

/// The name of all products.
const TITLE: &str = "reproduction";

/// Table 1 with the errors asked for.
fn estimate(options: &ReproduceOptions) -> Result<(), Failure> {
    if options.what != ["table1"] || options.error.errors.is_empty() {
        let reason = "--error needs rows that have the same results; give it with table1 alone";
        return Err(Failure::Input(reason.to_owned()));
    }
    let cases = &options.cases;
    cases.apply(&[ESTIMATED])?;
    let study = Study::built_in("table1", None, main_memory())?;
    let questions = Questions::new(&study, &options.error.request())?;
    let store = cases.open(cases.outputs([]), &questions.files())?;
    let answers = questions.answer(&store, &Watch::new())?;
    cases.give(&estimated(&answers)?)?;
    all_reached(&answers)
}
