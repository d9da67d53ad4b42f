//! Tips for command lines that no command understands: the words of this program for those of others.

use std::path::Path;

use clap::error::{ContextKind, ContextValue, ErrorKind};

/// Words for commands, and what is typed here.
const COMMANDS: [(&str, &str); 10] = [
    ("simulate", "sandbox run FILE"),
    ("start", "sandbox run FILE"),
    ("version", "sandbox --version"),
    ("plot", "sandbox draw RUN"),
    ("view", "sandbox page RUN"),
    ("show", "sandbox draw RUN, or sandbox page RUN"),
    ("analyze", "sandbox measure FILE"),
    ("analyse", "sandbox measure FILE"),
    ("scenarios", "sandbox list"),
    ("profiles", "sandbox list"),
];

/// Words for options, and what is typed here.
const OPTIONS: [(&str, &str); 10] = [
    ("--duration", "--until SECS"),
    ("--time", "--until SECS"),
    ("--end", "--until SECS"),
    ("--model", "--profile NAME"),
    ("--output", FILES),
    ("--out", FILES),
    ("-o", FILES),
    ("--plan", "--geometry FILE"),
    ("--param", "--set KEY=VALUE"),
    ("settings", "--settings"),
];
const FILES: &str =
    "--save FILE for a recording (.rrd) or a page (.html), --trajectory FILE for positions";

/// A tip on an error of the command line; `None` without one.
pub fn of(error: &clap::Error) -> Option<String> {
    let text = |kind: ContextKind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let known = |words: &[(&str, &str)], given: &str| {
        let found = words.iter().find(|(word, _)| *word == given);
        found.map(|(_, here)| format!("tip: {here}"))
    };
    match error.kind() {
        ErrorKind::InvalidSubcommand => {
            let given = text(ContextKind::InvalidSubcommand)?;
            let is_file = Path::new(given).is_file();
            let as_file =
                is_file.then(|| format!("tip: for the file {given}: sandbox run {given}"));
            as_file.or_else(|| known(&COMMANDS, given))
        }
        ErrorKind::UnknownArgument => {
            let given = text(ContextKind::InvalidArg)?;
            let ending = Path::new(given).extension().unwrap_or_default();
            let is_picture = ["png", "svg", "pdf", "gif", "html"]
                .iter()
                .any(|one| ending == *one);
            let as_output = is_picture.then(|| format!("tip: --out {given}"));
            as_output.or_else(|| known(&OPTIONS, given))
        }
        _ => None,
    }
}
