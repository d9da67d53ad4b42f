//! What was played, as files: the program itself makes them, from the scenario with what was done.

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};

use scenario::Scenario;
use serde_json::Value;

use crate::answer::{Answer, Refusal};

/// A kind of file: its ending, its type, and the words of the command before and after the scenario.
struct Kind {
    ending: &'static str,
    kind: &'static str,
    before: &'static [&'static str],
    after: &'static [&'static str],
}

const KINDS: [Kind; 4] = [
    Kind {
        ending: "html",
        kind: "text/html",
        before: &["run"],
        after: &["--json", "--save"],
    },
    Kind {
        ending: "rrd",
        kind: "application/octet-stream",
        before: &["run"],
        after: &["--json", "--save"],
    },
    Kind {
        ending: "pdf",
        kind: "application/pdf",
        before: &["report"],
        after: &["--out"],
    },
    Kind {
        ending: "png",
        kind: "image/png",
        before: &["draw"],
        after: &["--at", "{time}", "--out"],
    },
];

/// A run as it was played, up to a time.
pub struct Played {
    /// The scenario that was given.
    pub scenario: Scenario,
    /// The same with what was done.
    pub document: Value,
    /// The time of the current frame, seconds.
    pub time: f64,
}

impl Played {
    /// The scenario as text: a run of it ends in the same state.
    fn text(self) -> String {
        let played = Scenario {
            document: self.document,
            ..self.scenario
        };
        played.to_text()
    }

    /// The file of a kind, which `program` makes.
    ///
    /// # Errors
    /// There is no such kind, or the program says why not.
    pub fn file(self, ending: &str, program: &[OsString]) -> Result<Answer, Refusal> {
        let (name, time) = (file_name(&self.scenario.name), self.time);
        let named = |answer: Answer| Answer {
            file: Some(format!("{name}.{ending}")),
            ..answer
        };
        let text = self.text();
        if ending == "json" {
            return Ok(named(Answer::of("application/json", text)));
        }
        let Some(kind) = KINDS.iter().find(|kind| kind.ending == ending) else {
            let message = format!("as: {ending}: give json, html, rrd, pdf or png");
            return Err(Refusal::wrong(message));
        };
        let folder = tempfile::tempdir().map_err(Refusal::failed)?;
        let [from, to] =
            ["json", ending].map(|ending| folder.path().join(format!("{name}.{ending}")));
        std::fs::write(&from, text).map_err(Refusal::failed)?;
        let after = kind
            .after
            .iter()
            .map(|word| word.replace("{time}", &time.to_string()));
        let mut words: Vec<OsString> = kind.before.iter().map(OsString::from).collect();
        words.push(from.into());
        words.extend(after.map(OsString::from));
        words.push(to.clone().into());
        run(program, &words, folder.path())?;
        let content = std::fs::read(&to).map_err(Refusal::failed)?;
        Ok(named(Answer::of(kind.kind, content)))
    }
}

/// Runs a command of the program; its message if it fails.
fn run(program: &[OsString], words: &[OsString], folder: &Path) -> Result<(), Refusal> {
    let Some((program, first)) = program.split_first() else {
        return Err(Refusal::failed("the program does not know its own place"));
    };
    let done = Command::new(program)
        .args(first)
        .args(words)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .output()
        .map_err(Refusal::failed)?;
    if done.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&done.stderr);
    let error = said.lines().rev().find(|line| line.starts_with("error"));
    let last = error.or(said.lines().last());
    let words = last.unwrap_or("the program failed");
    Err(Refusal::failed(words.trim_start_matches("error: ")))
}

/// A name for files: letters, digits, and what joins them.
fn file_name(name: &str) -> String {
    let plain = |c: char| match c.is_alphanumeric() || c == '-' || c == '_' {
        true => c,
        false => '-',
    };
    let name: String = name.chars().take(80).map(plain).collect();
    match name.is_empty() {
        true => "drawing".to_owned(),
        false => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_are_plain() {
        assert_eq!(file_name("my hall/2"), "my-hall-2");
        assert_eq!(file_name("../x"), "---x");
        assert_eq!(file_name(""), "drawing");
    }
}
