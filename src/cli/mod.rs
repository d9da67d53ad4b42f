//! What was typed and what it means. The only place that names clap.

mod accuracy;
mod arguments;
mod bench;
mod checkpoint;
mod drive;
mod inspect;
mod interrupt;
mod list;
mod manual;
mod measure;
mod memory;
mod output;
mod report;
mod reproduce;
mod stress;
mod sweep;
mod trajectory;
mod update;
mod values;
mod watch;

use std::io::{ErrorKind, Write};
use std::process::ExitCode;

use clap::Parser;

use crate::engine::breakdown::Breakdown;
use crate::engine::simulation::{Fault, Simulation};
use crate::lab::reproduce::ReproduceError;
use crate::runs::outputs::{Outputs, OutputsError};
use crate::scenario::floor_plan;
use crate::scenario::quote::{printable, shown};
use crate::scenario::{Need, Scenario, ScenarioError, Setting, read_text, shipped_text};
use arguments::{Arguments, Command, Source};

/// Why a command did not do what was asked.
#[derive(Debug, thiserror::Error)]
enum Failure {
    /// What was typed or read makes no sense: exit code 2.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The same, on the command line: exit code 2.
    #[error("{0}")]
    Input(String),
    /// The run cannot go on: exit code 1.
    #[error(transparent)]
    Fault(#[from] Fault),
    /// The same, and somebody laid open in the frame where it ended: exit code 1.
    #[error("{fault}\n{agent}")]
    LaidOpen {
        /// What happened.
        fault: Fault,
        /// To whom.
        agent: Box<Breakdown>,
    },
    /// A file cannot be written: exit code 1.
    #[error("{0}")]
    Output(String),
    /// Something cannot be reproduced: exit code 1.
    #[error(transparent)]
    Reproduce(#[from] ReproduceError),
    /// Somebody asked the run to end, and it did: exit code 130 or 143.
    #[error("interrupted at {time:.2} s; results and files end there")]
    Interrupted {
        /// The frame it ended with, seconds.
        time: f64,
        /// By which signal.
        exit_code: u8,
    },
}

impl Failure {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Scenario(_) | Self::Input(_) => 2,
            Self::Fault(_) | Self::LaidOpen { .. } | Self::Output(_) | Self::Reproduce(_) => 1,
            Self::Interrupted { exit_code, .. } => *exit_code,
        }
    }
}

impl From<OutputsError> for Failure {
    fn from(error: OutputsError) -> Self {
        match error {
            OutputsError::Unwritable { .. } => Self::Output(error.to_string()),
            error => Self::Input(error.to_string()),
        }
    }
}

impl Failure {
    /// With every force on whom it happened to.
    fn laid_open(self, simulation: &mut Simulation) -> Self {
        match self {
            Self::Fault(fault) => match Breakdown::of_fault(simulation, &fault) {
                Some(agent) => Self::LaidOpen {
                    fault,
                    agent: Box::new(agent),
                },
                None => Self::Fault(fault),
            },
            other => other,
        }
    }
}

/// Runs the program; results go to stdout, talk to stderr. Exit code 0: done, 1: the run failed,
/// 2: bad input, 130 and 143: interrupted.
pub fn main() -> ExitCode {
    let command = Arguments::parse().command;
    match run(command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            talk(&format!("error: {failure}"));
            ExitCode::from(failure.exit_code())
        }
    }
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Evacuation(options) => drive::run(&Source::Shipped("evacuation"), &options),
        Command::Crossing(options) => drive::run(&Source::Shipped("crossing"), &options),
        Command::Concert(options) => drive::run(&Source::Shipped("concert"), &options),
        Command::Plaza(options) => drive::run(&Source::Shipped("plaza"), &options),
        Command::Run { file, options } => drive::run(&Source::File(file), &options),
        Command::Resume(options) => drive::resume(&options),
        Command::Inspect(options) => inspect::run(&options),
        Command::Reproduce(options) => reproduce::run(&options),
        Command::Bench(options) => bench::run(&options),
        Command::Accuracy(options) => accuracy::run(&options),
        Command::Stress(options) => stress::run(&options),
        Command::Schema => list::schema(),
        Command::Sweep(options) => sweep::run(&options),
        Command::Measure(options) => measure::run(&options),
        Command::List { settings } => list::run(settings),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man { out } => manual::man(out.as_deref()),
    }
}

/// Reads a scenario with the settings of the command line, among them its end, after the flag that gives
/// it; what is written of it takes `writing` bytes of memory per agent. `outputs` learns what was read.
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
            last = Some(setting); // a moment beyond the end moves the end, however it was given
            continue;
        }
        if let Some(other) = typed.iter().find(|other| other.path() == setting.path()) {
            return Err(Failure::Input(format!(
                "{setting} and {other} set the same key: give one of them"
            )));
        }
        settings.push(setting);
    }
    if let Some(path) = &scene.geometry {
        let text = format!("--geometry {}", path.display());
        outputs.reads("--geometry", path);
        let plan = floor_plan::read(path);
        let plan = plan.map_err(|error| Failure::Input(format!("--geometry {error}")))?;
        settings.extend(Setting::floor_plan(&plan, &text));
    }
    settings.extend(typed.into_iter().chain(last));
    let (text, file) = match source {
        Source::Shipped(name) => (shipped_text(name)?.to_owned(), format!("{name}.json")),
        Source::File(path) => (read_text(path)?, path.display().to_string()),
    };
    let need = Need::parse(&text, &file, &settings)?;
    memory::check(&file, &need, writing)?;
    let scenario = Scenario::parse(&text, &file, &settings)?;
    memory::check(&file, &need.with_lists(&scenario.scene), writing)?;
    if let Source::File(path) = source {
        outputs.reads("the scenario", path);
    }
    for (key, path) in &scenario.files {
        outputs.reads(key, path);
    }
    Ok(scenario)
}

fn setting(text: &str) -> Result<Setting, Failure> {
    text.parse()
        .map_err(|error| Failure::Input(format!("--set {}: {error}", shown(text))))
}

/// Writes results to stdout; a reader that has gone (`| head`) is no failure.
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

/// Writes a line to stderr, without anything that a terminal obeys; where that is not possible nothing is lost
/// that the exit code does not tell.
fn talk(line: &str) {
    writeln!(std::io::stderr(), "{}", printable(line)).ok();
}

/// Where rayon looks for a number of threads, in this order.
const THREADS: [&str; 2] = ["RAYON_NUM_THREADS", "RAYON_RS_NUM_CPUS"];

/// Makes rayon use so many threads, else as many as the environment says, else all cores; to be called before
/// anything else, which may compute in parallel.
fn use_threads(threads: Option<usize>) -> Result<(), Failure> {
    let given = THREADS.into_iter().find_map(|name| {
        Some((
            name,
            std::env::var(name).ok().filter(|text| !text.is_empty())?,
        ))
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
