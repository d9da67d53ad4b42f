//! Shell completions and man pages.

use std::fs;
use std::io;
use std::path::Path;

use clap::{CommandFactory, ValueEnum};
use clap_complete::{Shell, generate};
use clap_mangen::{Man, generate_to};

use super::failure::Failure;
use super::terminal::say;
use super::values::MAN;
use runs::outputs::{Manner, Outputs};

/// `sandbox generate`.
pub fn generated(what: &str, folder: Option<&Path>) -> Result<(), Failure> {
    match (what, folder) {
        (MAN, folder) => man(folder),
        (shell, None) => {
            let shell = Shell::from_str(shell, false).map_err(Failure::Input)?;
            completions(shell)
        }
        (shell, Some(folder)) => Err(Failure::Input(format!(
            "--out {}: is for `generate man`; the script of {shell} goes to the standard output",
            folder.display()
        ))),
    }
}

/// Prints the script of a shell.
pub fn completions(shell: Shell) -> Result<(), Failure> {
    let mut command = super::commands::Arguments::command();
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    generate(shell, &mut command, name, &mut script);
    say(script)
}

/// Prints the program's page, or writes all pages into a folder.
pub fn man(folder: Option<&Path>) -> Result<(), Failure> {
    // `sandbox help` has no page.
    let command = super::commands::Arguments::command().disable_help_subcommand(true);
    if let Some(folder) = folder {
        let path = folder.display();
        let failed = |error: io::Error| Failure::Output(format!("cannot write {path}: {error}"));
        let mut outputs = Outputs::new(true);
        outputs.writes("--out", folder, Manner::Folder);
        outputs.check()?;
        fs::create_dir_all(folder).map_err(failed)?;
        return generate_to(command, folder).map_err(failed);
    }
    let mut page = Vec::new();
    let rendered = Man::new(command).render(&mut page);
    rendered.map_err(|error| Failure::Output(error.to_string()))?;
    say(page)
}
