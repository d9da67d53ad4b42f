//! Results go to stdout, messages to stderr.

use std::io::{ErrorKind, Write};

use serde_json::Value;

use super::failure::Failure;
use scenario::quote::printable;
use scenario::tidy;

/// Writes results to stdout. A closed pipe (`| head`) is not an error.
pub fn say(text: impl AsRef<[u8]>) -> Result<(), Failure> {
    let mut stdout = std::io::stdout();
    let said = stdout.write_all(text.as_ref());
    match said.and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Output(format!("stdout: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes a text to stdout, with control characters escaped: it may quote names from files.
pub fn say_text(text: &str) -> Result<(), Failure> {
    say(printable(text))
}

/// Writes results to stdout, as JSON or as text with control characters escaped.
pub fn tell(
    as_json: bool,
    json: impl FnOnce() -> Value,
    text: impl FnOnce() -> String,
) -> Result<(), Failure> {
    match as_json {
        true => say(format!("{}\n", json())),
        false => say_text(&text()),
    }
}

/// Writes a line to stderr, with short numbers and control characters escaped. Errors are ignored: the exit code tells
/// of failures.
pub fn talk(line: &str) {
    writeln!(std::io::stderr(), "{}", printable(&tidy(line))).ok();
}
