//! The levels of a building in a file: people on different levels stand above each other, so one level is read.

use std::collections::BTreeSet;
use std::path::Path;

use super::error::ReadError;
use crate::error::quote::shown;
use crate::error::suggestion;

/// The name of the column with the names of levels.
pub const LEVEL: &str = "level";

/// The name of a level as one word, for texts whose columns are separated by blanks.
pub fn one_word(name: &str) -> String {
    let words: Vec<&str> = name.split_whitespace().collect();
    words.join("_")
}

/// Whether `wanted` is the name of a level, or has underscores where this has blanks, or the other way around.
pub fn is_named(wanted: &str, name: &str) -> bool {
    wanted == name || one_word(wanted) == one_word(name)
}

/// The people that are read of a file with a column `level`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum OnLevel {
    /// All, if they are on one level. Several levels are refused.
    #[default]
    Only,
    /// Those on the level of this name.
    Named(String),
    /// All, on whatever level: nothing that depends on their distances may be measured.
    Any,
}

/// The levels in a file, and the one that is read.
#[derive(Debug, Default)]
pub struct Levels {
    wanted: OnLevel,
    names: BTreeSet<String>,
}

impl Levels {
    /// The levels of a file of which these people are read.
    pub fn new(wanted: &OnLevel) -> Self {
        Self {
            wanted: wanted.clone(),
            names: BTreeSet::new(),
        }
    }

    /// Whether people on the level `name` are read.
    pub fn includes(&mut self, name: &str) -> bool {
        if !self.names.contains(name) {
            self.names.insert(name.to_owned());
        }
        match &self.wanted {
            OnLevel::Named(wanted) => is_named(wanted, name),
            OnLevel::Only | OnLevel::Any => true,
        }
    }

    /// Checks that the file has the level that is wanted, or one only.
    pub fn check(&self, path: &Path) -> Result<(), ReadError> {
        let all = || -> String {
            let names = self.names.iter().map(|name| format!("`{}`", shown(name)));
            names.collect::<Vec<_>>().join(", ")
        };
        let problem = match &self.wanted {
            OnLevel::Only if self.names.len() > 1 => format!(
                "its people are on several levels of a building: choose one with --level: {}",
                all()
            ),
            OnLevel::Named(_) if self.names.is_empty() => {
                "it has no column `level`: leave --level out".to_owned()
            }
            OnLevel::Named(name) if !self.names.iter().any(|own| is_named(name, own)) => {
                let near = suggestion(name, self.names.iter().map(String::as_str));
                let known = match near.is_empty() {
                    true => format!("; there are {}", all()),
                    false => near,
                };
                format!("no people are on a level named `{}`{known}", shown(name))
            }
            _ => return Ok(()),
        };
        Err(ReadError::file(path, problem))
    }
}
