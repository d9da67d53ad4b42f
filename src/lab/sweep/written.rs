//! The text of a study, from a file or built into the program.

use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde_json::Value;

use runs::case::Source;
use scenario::{Problem, ScenarioError, built_in, in_plain_words, input, kinds, read_document};

/// The text of a study, a suite or a calibration, and where it comes from.
#[derive(Debug, Clone)]
pub(crate) struct Written {
    /// The text.
    pub text: String,
    /// The path of the file, relative to `scenarios/` if it is built in.
    path: PathBuf,
    built_in: bool,
}

impl Written {
    /// A file's text.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn read(path: &Path) -> Result<Self, ScenarioError> {
        let text = input::text(path).map_err(|error| ScenarioError::Unreadable {
            file: path.display().to_string(),
            reason: error.to_string(),
        })?;
        Ok(Self::of(&text, path))
    }

    /// The text of a file that was read already.
    pub fn of(text: &str, path: &Path) -> Self {
        Self {
            text: text.to_owned(),
            path: path.to_owned(),
            built_in: false,
        }
    }

    /// A built-in text: the file `FOLDER/NAME.json` under `scenarios/`.
    ///
    /// # Errors
    /// There is no such file.
    pub fn built_in(folder: &str, name: &str) -> Result<Self, ScenarioError> {
        let path = Path::new(folder).join(format!("{name}.json"));
        match built_in(&path) {
            Some(text) => Ok(Self {
                text: text.to_owned(),
                path,
                built_in: true,
            }),
            None => Err(ScenarioError::Unreadable {
                file: path.display().to_string(),
                reason: "no such study is built into the program".to_owned(),
            }),
        }
    }

    /// A file's text, or the built-in one of this name if there is no such file.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn open(path: &Path, folder: &str) -> Result<Self, ScenarioError> {
        let name = path.to_str().filter(|_| !path.exists());
        if let Some(built_in) = name.and_then(|name| Self::built_in(folder, name).ok()) {
            return Ok(built_in);
        }
        match name.filter(|name| Source::shipped(name).is_some()) {
            Some(name) => Err(ScenarioError::Unreadable {
                file: name.to_owned(),
                reason: format!("is a scenario, no file of this command: sandbox run {name}"),
            }),
            None => Self::read(path),
        }
    }

    /// Its contents, and what their keys say. `needs` names the required keys, for the message about a file that is not
    /// an object.
    ///
    /// # Errors
    /// The text is not JSON, or a name or type is wrong.
    pub fn parsed<T: DeserializeOwned>(&self, needs: &str) -> Result<(Value, T), ScenarioError> {
        let document = read_document(&self.text, &self.file())?;
        if kinds::is_scenario(&document) {
            let reason = format!(
                "is a scenario, `sandbox run FILE` runs it; here a study is needed: an object with {needs}, which may \
                 name this file"
            );
            return Err(self.invalid(Problem::new("", reason)));
        }
        if let Some(what) = kinds::not_a_study(&document) {
            return Err(self.invalid(Problem::new("", what)));
        }
        let keys = self.keys(needs).map_err(|problem| self.invalid(problem))?;
        Ok((document, keys))
    }

    fn keys<T: DeserializeOwned>(&self, needs: &str) -> Result<T, Problem> {
        if !self.text.trim_start().starts_with('{') {
            let reason = format!("must be an object, {{…}}, with {needs}");
            return Err(Problem::new("", reason));
        }
        let mut deserializer = serde_json::Deserializer::from_str(&self.text);
        serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
            let path = error.path().to_string();
            let problem = error.inner();
            let place = format!(" at line {} column {}", problem.line(), problem.column());
            let said = problem.to_string();
            let reason = in_plain_words(said.strip_suffix(&place).unwrap_or(&said));
            Problem::new(if path == "." { String::new() } else { path }, reason)
        })
    }

    /// The error that the file has this problem.
    pub fn invalid(&self, problem: Problem) -> ScenarioError {
        ScenarioError::Invalid {
            file: self.file(),
            problem,
        }
    }

    /// The scenario in a file that it refers to, if it exists.
    pub(super) fn scenario(&self, name: &str) -> Result<Source, PathBuf> {
        let path = self.path.parent().unwrap_or(Path::new("")).join(name);
        match self.built_in {
            true if built_in(&path).is_some() => Ok(Source::BuiltIn(path)),
            false if path.is_file() => Ok(Source::File(path)),
            _ => Err(path),
        }
    }

    /// The name of the file in messages.
    pub fn file(&self) -> String {
        self.path.display().to_string()
    }

    /// The file's name without its ending.
    pub fn stem(&self) -> String {
        let stem = self.path.file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    }
}
