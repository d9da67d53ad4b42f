//! The command line: arguments, commands, messages and exit codes. The only module that names clap.
//!
//! Programs beside this one take from here their exit codes ([`main_of`]) and the options of benchmarks
//! ([`TimingOptions`]) and of documents with tables ([`UpdateOptions`]).

mod accuracy;
mod arguments;
mod bench;
mod calibrate;
mod checkpoint;
mod commands;
mod compare;
mod draw;
mod drive;
mod inspect;
mod interrupt;
mod list;
mod manual;
mod measure;
mod memory;
mod moment;
mod notes;
mod output;
mod report;
mod reproduce;
mod stress;
mod suite;
mod sweep;
mod trajectory;
mod update;
mod values;
mod watch;

pub use arguments::PrintOptions;
pub use bench::{ResultOptions, TimingOptions};
pub use report::json as json_report;
pub use update::UpdateOptions;

use std::ffi::OsString;
use std::io::{ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use serde_json::Value;

use crate::engine::breakdown::Breakdown;
use crate::engine::simulation::{Fault, Simulation};
use crate::lab::error::LabError;
use crate::lab::machine::main_memory;
use crate::lab::measure::MeasureError;
use crate::lab::sweep::StudyError;
use crate::runs::case::Source;
use crate::runs::error::StoreError;
use crate::runs::outputs::{Outputs, OutputsError};
use crate::scenario::floor_plan::{self, FloorPlan};
use crate::scenario::quote::{printable, shown};
use crate::scenario::trajectories::ReadError;
use crate::scenario::{Draft, Scenario, ScenarioError, Setting};
use commands::{Arguments, Command};

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A scenario or a setting is invalid: exit code 2.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Another input is invalid: exit code 2.
    #[error("{0}")]
    Input(String),
    /// Trajectories cannot be read: exit code 2.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Trajectories cannot be measured as asked for: exit code 2.
    #[error(transparent)]
    Measure(#[from] MeasureError),
    /// A study is invalid: exit code 2.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The simulation failed: exit code 1.
    #[error(transparent)]
    Fault(#[from] Fault),
    /// The simulation failed, with the forces on the agent concerned: exit code 1.
    #[error("{fault}\n{agent}")]
    LaidOpen {
        /// The fault.
        fault: Fault,
        /// The forces on the agent in the last frame.
        agent: Box<Breakdown>,
    },
    /// A file cannot be written: exit code 1.
    #[error("{0}")]
    Output(String),
    /// `reproduce`, `accuracy` or `stress` failed: exit code 1.
    #[error(transparent)]
    Reproduce(#[from] LabError),
    /// A signal ended the run: exit code 130 or 143.
    #[error("interrupted at {time:.2} s; results and files end there")]
    Interrupted {
        /// The time of the last frame, seconds.
        time: f64,
        /// The exit code, 128 + the signal's number.
        exit_code: u8,
    },
}

impl From<OutputsError> for Failure {
    fn from(error: OutputsError) -> Self {
        match error {
            OutputsError::Unwritable(..) => Self::Output(error.to_string()),
            error => Self::Input(error.to_string()),
        }
    }
}

impl From<StoreError> for Failure {
    fn from(error: StoreError) -> Self {
        LabError::from(error).into()
    }
}

impl Failure {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Fault(_) | Self::LaidOpen { .. } | Self::Output(_) | Self::Reproduce(_) => 1,
            Self::Interrupted { exit_code, .. } => *exit_code,
            Self::Scenario(_) | Self::Input(_) => 2,
            Self::Read(_) | Self::Measure(_) | Self::Study(_) => 2,
        }
    }

    /// Adds the forces on the agent that caused a fault.
    fn laid_open(self, simulation: &mut Simulation) -> Self {
        let Self::Fault(fault) = self else {
            return self;
        };
        match Breakdown::of_fault(simulation, &fault).map(Box::new) {
            Some(agent) => Self::LaidOpen { fault, agent },
            None => Self::Fault(fault),
        }
    }
}

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
    let failure = match A::try_parse_from(arguments) {
        Ok(arguments) => run(arguments).err(),
        Err(error) => {
            error.print().ok();
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
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
        Command::Run { file, options } => drive::run(&Source::File(file), &options),
        Command::Resume(options) => drive::resume(&options),
        Command::Inspect(options) => inspect::run(&options),
        Command::Draw(options) => draw::run(&options),
        Command::Reproduce(options) => reproduce::run(&options),
        Command::Bench(options) => bench::run(&options),
        Command::Accuracy(options) => accuracy::run(&options),
        Command::Stress(options) => stress::run(&options),
        Command::Verify(options) => suite::verify(&options),
        Command::Validate(options) => suite::validate(&options),
        Command::Calibrate(options) => calibrate::run(&options),
        Command::Schema => list::schema(),
        Command::Sweep(options) => sweep::run(&options),
        Command::Measure(options) => measure::run(&options),
        Command::Compare(options) => compare::run(&options),
        Command::List { settings, json } => list::run(settings, json),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man { out } => manual::man(out.as_deref()),
    }
}

/// Reads a scenario and applies the settings of the command line. `until` is the flag that sets another end, and the
/// end in seconds. Writing the output files takes `writing` bytes of memory per agent. Adds the files that were read to
/// `outputs`.
fn scenario(
    source: &Source,
    scene: &arguments::SceneOptions,
    until: Option<(&str, f64)>,
    writing: u64,
    outputs: &mut Outputs,
) -> Result<Scenario, Failure> {
    let (until_flag, until) =
        until.map_or(("", None), |(flag, secs)| (flag, Some(secs.to_string())));
    let seed = scene.seed.map(|seed| seed.to_string());
    let flags = [
        ("--profile", "profile", scene.profile.clone()),
        ("--preset", "preset", scene.preset.clone()),
        ("--seed", "seed", seed),
        (until_flag, "duration_secs", until),
        ("--time-step", "time_step_secs", scene.time_step.clone()),
    ];
    let typed: Vec<Setting> = scene
        .set
        .iter()
        .map(|text| setting(text))
        .collect::<Result<_, _>>()?;
    let mut settings = Vec::new();
    let mut last = None;
    for (flag, key, value) in flags {
        let Some(value) = value else { continue };
        let setting = setting(&format!("{key}={value}"))?;
        let setting = setting.typed_as(format!("{flag} {}", shown(&value)));
        if flag == "--at" {
            last = Some(setting); // applied last: --at beyond the end moves the end, even one given by --set
            continue;
        }
        if let Some(other) = typed.iter().find(|other| other.path() == setting.path()) {
            return Err(Failure::Input(format!(
                "{setting} and {other} set the same key: give only one of them"
            )));
        }
        settings.push(setting);
    }
    if let Some(path) = &scene.geometry {
        let text = format!("--geometry {}", path.display());
        outputs.reads("--geometry", path);
        let plan = floor_plan::read(path);
        let plan = plan.map_err(|error| Failure::Input(format!("--geometry {error}")))?;
        note_plan(path, &plan);
        settings.extend(Setting::floor_plan(&plan, &text));
    }
    settings.extend(typed.into_iter().chain(last));
    let (text, file) = source.text()?;
    let (scenario, _) = Draft::read(&text, &file, &settings)?.within(main_memory(), writing)?;
    if let Source::File(path) = source {
        outputs.reads("the scenario", path);
    }
    for (key, path) in &scenario.files {
        outputs.reads(key, path);
    }
    for note in &scenario.notes {
        talk(&format!("note: {note}"));
    }
    Ok(scenario)
}

/// Prints the notes on the plan of `--geometry`.
fn note_plan(path: &Path, plan: &FloorPlan) {
    for note in &plan.notes {
        talk(&format!("note: --geometry {}: {note}", path.display()));
    }
}

fn setting(text: &str) -> Result<Setting, Failure> {
    text.parse()
        .map_err(|error| Failure::Input(format!("--set {}: {error}", shown(text))))
}

/// Writes results to stdout. A closed pipe (`| head`) is not an error.
fn say(text: impl AsRef<[u8]>) -> Result<(), Failure> {
    let mut stdout = std::io::stdout();
    let said = stdout.write_all(text.as_ref());
    match said.and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Output(format!("stdout: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes results to stdout, as JSON or as text.
fn tell(
    as_json: bool,
    json: impl FnOnce() -> Value,
    text: impl FnOnce() -> String,
) -> Result<(), Failure> {
    match as_json {
        true => say(format!("{}\n", json())),
        false => say(text()),
    }
}

/// Writes a line to stderr, with control characters escaped. Errors are ignored: the exit code tells of failures.
fn talk(line: &str) {
    writeln!(std::io::stderr(), "{}", printable(line)).ok();
}

/// The environment variables from which rayon takes the number of threads, in this order.
const THREADS: [&str; 2] = ["RAYON_NUM_THREADS", "RAYON_RS_NUM_CPUS"];

/// Sets the number of rayon's threads: `threads`, else the environment's number, else all cores. Call it before
/// anything that may compute in parallel.
fn use_threads(threads: Option<usize>) -> Result<(), Failure> {
    let given = THREADS.into_iter().find_map(|name| {
        let text = std::env::var(name).ok().filter(|text| !text.is_empty())?;
        Some((name, text))
    });
    let (source, threads) = match (threads, given) {
        (Some(threads), _) => ("--threads", threads),
        (None, Some((name, text))) => match values::threads(&text) {
            Ok(threads) => (name, threads),
            Err(error) => {
                let reason = format!("{name}={text} in the environment: {error}");
                return Err(Failure::Input(reason));
            }
        },
        (None, None) => return Ok(()),
    };
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::Output(format!("{source} {threads}: {error}")))
}
