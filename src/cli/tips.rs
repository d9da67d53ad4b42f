//! Tips for command lines that no command understands: the words of this program for those of others, and the commands
//! that have an option.

use std::ffi::OsString;
use std::path::Path;

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command};

use runs::case::Source;
use scenario::quote::printable;

/// Words for commands, and what is typed here.
const COMMANDS: [(&str, &str); 10] = [
    ("simulate", "sandbox run FILE"),
    ("start", "sandbox run FILE"),
    ("version", "sandbox --version"),
    ("plot", "sandbox draw RUN"),
    ("view", "sandbox draw RUN -o FILE.html"),
    ("show", "sandbox draw RUN"),
    ("analyze", "sandbox measure FILE"),
    ("analyse", "sandbox measure FILE"),
    ("scenarios", "sandbox list"),
    ("profiles", "sandbox list"),
];

/// Words for options, the option that the command must have, and what is typed here.
const OPTIONS: [(&str, &str, &str); 11] = [
    ("--duration", "--until", "--until SECS"),
    ("--time", "--until", "--until SECS"),
    ("--end", "--until", "--until SECS"),
    ("--model", "--profile", "--profile NAME"),
    ("--output", "--trajectory", FILES),
    ("--out", "--trajectory", FILES),
    ("--output", "--out", "--out FILE"),
    ("--save", "--out", "--out FILE"),
    ("--plan", "--geometry", "--geometry FILE"),
    ("--param", "--set", "--set KEY=VALUE"),
    ("settings", "--settings", "--settings"),
];
const FILES: &str = "-o FILE for a report, --save FILE for a recording (.rrd) or a page (.html), --trajectory FILE for \
                     positions; `sandbox draw` draws a picture";

/// This many commands that have an option are named.
const NAMED: usize = 4;

/// An error of a command line, with tips on what to type; `command` is the program, and `typed` its arguments.
pub fn added(mut error: clap::Error, command: &Command, typed: &[OsString]) -> clap::Error {
    let text = |kind: ContextKind| match error.get(kind) {
        Some(ContextValue::String(text)) => text.clone(),
        _ => String::new(),
    };
    let words = match error.kind() {
        ErrorKind::InvalidSubcommand => {
            let tip = of_command(&text(ContextKind::InvalidSubcommand));
            tip.into_iter().collect()
        }
        ErrorKind::UnknownArgument => {
            let mut typed = typed.iter().skip(1);
            let used = typed.find_map(|one| command.find_subcommand(one));
            of_argument(&text(ContextKind::InvalidArg), command, used)
        }
        _ => return error,
    };
    let mut tips: Vec<StyledStr> = words.iter().map(|tip| printable(tip).into()).collect();
    if let Some(ContextValue::StyledStrs(own)) = error.remove(ContextKind::Suggested) {
        // Nothing here has a name that begins with dashes.
        let is_useful =
            |tip: &StyledStr| tips.is_empty() && !tip.to_string().contains(" as a value");
        let own: Vec<StyledStr> = own.into_iter().filter(is_useful).collect();
        tips.extend(own);
    }
    if !tips.is_empty() {
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(tips));
    }
    error
}

/// A tip on an unknown command.
fn of_command(given: &str) -> Option<String> {
    if Path::new(given).is_file() {
        return Some(format!("for the file {given}: sandbox run {given}"));
    }
    let known = COMMANDS.iter().find(|(word, _)| *word == given);
    known.map(|(_, here)| (*here).to_owned())
}

/// Tips on an unknown argument of the command `used`.
fn of_argument(given: &str, program: &Command, used: Option<&Command>) -> Vec<String> {
    let given = given.split('=').next().unwrap_or_default();
    let ending = Path::new(given).extension().unwrap_or_default();
    let endings = ["png", "svg", "pdf", "gif", "html"];
    if !given.starts_with('-') && endings.iter().any(|one| ending == *one) {
        return vec![format!("--out {given}")];
    }
    let is_here = |option: &str| used.is_some_and(|used| has(used, option));
    let mut options = OPTIONS.iter();
    let found = options.find(|(word, option, _)| *word == given && is_here(option));
    let known = found.map(|(.., here)| (*here).to_owned());
    known.into_iter().chain(owners(given, program)).collect()
}

/// Whether a command has an option such as `--at` or `-o`.
fn has(command: &Command, option: &str) -> bool {
    let is_it = |arg: &Arg| match (option.strip_prefix("--"), option.strip_prefix('-')) {
        (Some(long), _) => arg.get_long() == Some(long),
        (None, Some(short)) => arg.get_short().is_some_and(|own| short.chars().eq([own])),
        (None, None) => false,
    };
    command.get_arguments().any(is_it)
}

/// What says which commands have an option. The commands of built-in scenarios have those of `run`.
fn owners(option: &str, program: &Command) -> Option<String> {
    let shown = program.get_subcommands().filter(|one| !one.is_hide_set());
    let commands = shown.filter(|one| has(one, option)).map(Command::get_name);
    let names: Vec<&str> = commands
        .filter(|name| Source::shipped(name).is_none())
        .collect();
    let named = match names.as_slice() {
        [] => return None,
        [one] => (*one).to_owned(),
        [first @ .., last] if names.len() <= NAMED => format!("{} and {last}", first.join(", ")),
        names => format!(
            "{} and {} more commands",
            names[..NAMED].join(", "),
            names.len() - NAMED
        ),
    };
    Some(format!("{option} belongs to {named}"))
}
