//! `sandbox studio`: draw, play and change crowds in the browser of this machine.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use clap::Args;
use serde_json::json;

use super::arguments::use_threads;
use super::failure::Failure;
use super::interrupt::Interrupt;
use super::output::viewer;
use super::terminal::{talk, tell};
use super::values::threads;
use lab::machine::main_memory;
use runs::case::Source;
use studio::{Server, ServerError, Studio};

pub const EXAMPLES: &str = "\
Examples:
  sandbox studio
  sandbox studio scenarios/station.json
  sandbox studio station.dxf --no-browser --port 8080";

#[derive(Args)]
pub struct StudioOptions {
    /// The scenario to open: a file, a floor plan, or the name of a built-in one [default: a page with examples]
    pub scenario: Option<PathBuf>,
    /// The port of the page on this machine [default: a free one]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub port: Option<u16>,
    /// Print the address of the page only
    #[arg(long)]
    pub no_browser: bool,
    /// Show the runs live in a Rerun viewer, too; starts one if none is running
    #[arg(long)]
    pub spawn: bool,
    /// Show the runs live in the viewer at this address, too: rerun+http://HOST:PORT/proxy, or HOST:PORT
    #[arg(long, value_name = "URL", conflicts_with = "spawn")]
    pub connect: Option<String>,
    /// Number of threads; the results do not depend on it [default: all cores]
    #[arg(long, value_parser = threads)]
    pub threads: Option<usize>,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

pub fn run(options: &StudioOptions) -> Result<(), Failure> {
    use_threads(options.threads)?;
    let interrupt = Interrupt::listen().map_err(|error| Failure::Output(error.to_string()))?;
    let studio = Studio {
        scenario: options.scenario.clone().map(Source::at),
        port: options.port,
        memory: main_memory(),
        viewer: viewer(options.connect.as_deref(), options.spawn)?,
        program: program(),
    };
    let server = Server::start(studio).map_err(|error| match error {
        ServerError::Scenario(_) => Failure::Input(error.to_string()),
        ServerError::Viewer(_) | ServerError::Port { .. } => Failure::Output(error.to_string()),
    })?;
    let address = server.address();
    tell(
        options.json,
        || json!({"address": address}),
        || format!("{address}\n"),
    )?;
    talk(
        "the studio is open at this address until Ctrl-C; what you draw and play stays on this machine",
    );
    if !options.no_browser
        && let Err(error) = open::that_detached(&address)
    {
        talk(&format!(
            "note: no browser could be started ({error}); open the address in one"
        ));
    }
    let flag = interrupt.flag();
    server.run(|| flag.load(Ordering::Relaxed));
    Ok(())
}

/// This program, and its first arguments: as a module of Python, the program is Python.
fn program() -> Vec<OsString> {
    let Ok(own) = std::env::current_exe() else {
        return Vec::new();
    };
    let stem = own.file_stem().unwrap_or_default().to_string_lossy();
    match stem.starts_with("python") {
        true => vec![own.clone().into(), "-m".into(), "sandbox_crowds".into()],
        false => vec![Path::new(&own).into()],
    }
}
