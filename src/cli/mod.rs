//! The command line: arguments, commands, messages and exit codes. The only module that names clap.
//!
//! What several commands share stands above them; commands do not use each other. Programs beside this one take from
//! here their exit codes ([`main_of`]) and the options of benchmarks ([`TimingOptions`]) and of documents with tables
//! ([`UpdateOptions`]).

mod failure;
mod terminal;
mod tips;
mod values;

mod documents;

mod arguments;
mod inputs;
mod interrupt;
mod memory;
mod update;
mod watch;

mod checkpoint;
mod results;

mod frames;
mod moment;
mod notes;
mod reported;

mod output;

mod accuracy;
mod bench;
mod calibrate;
mod compare;
mod convert;
mod page;

mod draw;
mod drive;
mod estimate;
mod inspect;
mod list;
mod measure;
mod report;
mod reproduce;
mod stress;
mod studio;
mod suite;
mod sweep;

mod commands;
mod manual;

pub use arguments::{ErrorOptions, PrintOptions};
pub use bench::{ResultOptions, TimingOptions};
pub use failure::Failure;
pub use results::json as json_report;
pub use update::{CaseOptions, UpdateOptions};
pub use watch::Watch;

use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

use clap::Parser;

use ::output::plot::take_lacked;
use commands::{Arguments, Command};
use engine::pairs::Vectors;
use runs::case::Source;
use scenario::quote::shown;
use terminal::talk;

/// Runs the program with the arguments of this process; see [`main_with`].
pub fn main() -> ExitCode {
    ExitCode::from(main_with(std::env::args_os()))
}

/// Runs the program with these arguments, the first of which is its name, and returns the exit code: 0 success, 1 the
/// command failed, 2 invalid input, 130 and 143 interrupted. Results go to stdout, messages to stderr.
pub fn main_with(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    main_of(arguments, |arguments: Arguments| run(arguments.command))
}

/// Runs another program with these arguments as [`main_with`] runs this one: with the same messages and exit codes.
pub fn main_of<A: Parser>(
    arguments: impl IntoIterator<Item = OsString>,
    run: impl FnOnce(A) -> Result<(), Failure>,
) -> u8 {
    let typed: Vec<OsString> = arguments.into_iter().collect();
    let failure = match A::try_parse_from(&typed) {
        Ok(arguments) => Vectors::check()
            .map_err(Failure::Input)
            .and_then(|()| run(arguments))
            .err(),
        Err(error) => {
            let error = tips::added(error, &A::command(), &typed);
            error.print().ok();
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    let lacked = take_lacked();
    if !lacked.is_empty() {
        talk(&format!(
            "note: the font of PNG and PDF files lacks {}: boxes stand for these letters; SVG and HTML files show them",
            shown(&lacked)
        ));
    }
    // Where the program is not the main function of its process, nothing else does.
    std::io::stdout().flush().ok();
    failure.map_or(0, |failure| {
        talk(&format!("error: {failure}"));
        failure.exit_code()
    })
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Evacuation(options) => drive::run(&Source::named("evacuation"), &options),
        Command::Crossing(options) => drive::run(&Source::named("crossing"), &options),
        Command::Concert(options) => drive::run(&Source::named("concert"), &options),
        Command::Plaza(options) => drive::run(&Source::named("plaza"), &options),
        Command::Run { file, options } => drive::run(&Source::at(file), &options),
        Command::Resume(options) => drive::resume(&options),
        Command::Inspect(options) => inspect::run(&options),
        Command::Draw(options) => draw::run(&options),
        Command::Convert(options) => convert::run(&options),
        Command::Page(options) => {
            old("page", "draw RUN -o FILE.html");
            page::run(&options)
        }
        Command::Report(options) => report::run(&options),
        Command::Studio(options) => studio::run(&options),
        Command::Reproduce(options) => reproduce::run(&options),
        Command::Bench(options) => bench::run(&options),
        Command::Accuracy(options) => accuracy::run(&options),
        Command::Stress(options) => stress::run(&options),
        Command::Verify(options) => suite::verify(&options),
        Command::Validate(options) => suite::validate(&options),
        Command::Calibrate(options) => calibrate::run(&options),
        Command::Schema => {
            old("schema", "list --schema");
            list::schema()
        }
        Command::Sweep(options) => sweep::run(&options),
        Command::Estimate(options) => estimate::run(&options),
        Command::Measure(options) => measure::run(&options),
        Command::Compare(options) => compare::run(&options),
        Command::List { schema: true, .. } => list::schema(),
        Command::List {
            measurements: true,
            document,
            json,
            ..
        } => list::measurements(&document, json),
        Command::List {
            settings: true,
            document,
            json,
            ..
        } => list::settings(&document, json),
        Command::List { document, json, .. } => list::overview(&document, json),
        Command::Generate { what, out } => manual::generated(&what, out.as_deref()),
        Command::Completions { shell } => {
            old("completions", "generate SHELL");
            manual::completions(shell)
        }
        Command::Man { out } => {
            old("man", "generate man");
            manual::man(out.as_deref())
        }
    }
}

/// A note on an old spelling of a command.
fn old(spelling: &str, new: &str) {
    talk(&format!(
        "note: `sandbox {spelling}` is `sandbox {new}` now; the old spelling works in this version only"
    ));
}
