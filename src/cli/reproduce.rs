//! `sandbox reproduce`: the paper's tables and figures.

use std::fs;
use std::io::{self, IsTerminal};
use std::path::Path;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use super::arguments::ReproduceOptions;
use super::{Failure, say, use_threads};
use crate::reproduce::{
    CaseResult, Listener, PRODUCTS, Plan, Product, Store, put_between, reproduce,
};

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
        // Better told before hours of computing than after.
        fs::metadata(file).map_err(|error| failed(file, &error))?;
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
    watch.bar.finish_and_clear();
    let said = said?;
    if let Some(file) = &options.update {
        let names = products.iter().map(|product| product.name);
        update(file, names.zip(said.iter().map(String::as_str)))?;
    }
    said.iter().try_for_each(|text| say(text))
}

/// Puts texts into the places that a file has for them.
fn update<'a>(file: &Path, texts: impl Iterator<Item = (&'a str, &'a str)>) -> Result<(), Failure> {
    let mut document = fs::read_to_string(file).map_err(|error| failed(file, &error))?;
    for (name, text) in texts {
        if let Some(changed) = put_between(&document, name, text) {
            document = changed;
        }
    }
    fs::write(file, document).map_err(|error| failed(file, &error))
}

fn failed(file: &Path, error: &io::Error) -> Failure {
    Failure::Output(format!("{}: {error}", file.display()))
}

/// A progress bar on stderr; where that is no terminal, a line for every finished case.
struct Watch {
    bar: ProgressBar,
    lines: bool,
}

impl Watch {
    fn new() -> Self {
        let bar = ProgressBar::new(0);
        let template = "{bar:30} {percent} % of the work, {eta} left; {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self {
            bar,
            lines: !std::io::stderr().is_terminal(),
        }
    }
}

/// Expected seconds → steps of the bar.
fn steps(seconds: f64) -> u64 {
    (seconds * 1e3).round() as u64
}

impl Listener for Watch {
    fn begins(&self, cases: usize, kept: usize, seconds: f64) {
        self.notes(&format!("{cases} case(s) to run, {kept} kept from before"));
        self.bar.set_length(steps(seconds));
        self.bar.enable_steady_tick(Duration::from_secs(1));
    }

    fn advances(&self, seconds: f64) {
        self.bar.inc(steps(seconds));
    }

    fn finishes(&self, result: &CaseResult) {
        let CaseResult {
            case,
            computed_in_secs,
            ..
        } = result;
        let text = format!("{case}: {computed_in_secs:.1} s");
        if self.lines {
            let (done, all) = (self.bar.position(), self.bar.length().unwrap_or_default());
            let left = self.bar.eta().as_secs();
            let percent = 100 * done / all.max(1);
            eprintln!("{percent:>3} %, {left} s left; {text}");
        } else {
            self.bar.set_message(text);
        }
    }

    fn notes(&self, text: &str) {
        self.bar.suspend(|| eprintln!("note: {text}"));
    }
}
