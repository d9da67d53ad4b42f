//! Errors in scenarios, with their places.

pub mod hints;
pub mod numbers;
pub mod quote;

use crate::error::quote::shown;
use engine::geometry::PolygonError;

/// Why a scenario cannot be run; displays as `FILE: key.path[3].key: reason`.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ScenarioError {
    /// The file could not be read.
    #[error("{file}: {reason}")]
    Unreadable {
        /// The file.
        file: String,
        /// The system's message, with advice.
        reason: String,
    },
    /// The text is not JSON, or has a duplicate key.
    #[error("{file}: line {line}, column {column}: {reason}")]
    Syntax {
        /// The file.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong there.
        reason: String,
    },
    /// A key or value is wrong.
    #[error("{file}: {problem}")]
    Invalid {
        /// The file, and the settings if it is valid without them.
        file: String,
        /// The place and the reason.
        problem: Problem,
    },
    /// A key or value that a setting put there is wrong.
    #[error("{setting}: {problem}")]
    Setting {
        /// The setting as given: `--set viscosity=-1`.
        setting: String,
        /// The place, relative to the setting's key, and the reason.
        problem: Problem,
    },
    /// Its run needs more memory than the machine has.
    #[error("{0}")]
    TooLarge(String),
    /// There is no built-in scenario of this name.
    #[error(
        "unknown scenario `{}`; the built-in scenarios are {known}",
        shown(name)
    )]
    UnknownName {
        /// The name asked for.
        name: String,
        /// The known names.
        known: String,
    },
}

/// A problem in a document: a key path and a reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The key path, as in `sources[0].every_secs`; empty for the whole document.
    pub path: String,
    /// The reason.
    pub reason: String,
}

impl std::fmt::Display for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        if self.path.is_empty() {
            f.write_str(&self.reason)
        } else {
            write!(f, "{}: {}", shown(&self.path), self.reason)
        }
    }
}

impl Problem {
    /// A problem at a key path.
    pub fn new(path: impl Into<String>, reason: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            reason: numbers::tidy(&reason.into()),
        }
    }

    /// The problem with its path relative to `path`, if it lies there or below.
    pub fn seen_from(&self, path: &str) -> Option<Self> {
        let rest = self.path.strip_prefix(path)?;
        let inside = rest.is_empty() || rest.starts_with(['.', '[']);
        inside.then(|| Self::new(rest.trim_start_matches('.'), self.reason.clone()))
    }

    /// The problem with `parent` before its path.
    pub fn under(self, parent: &str) -> Self {
        let joint = match self.path.chars().next() {
            None | Some('[') => "",
            Some(_) => ".",
        };
        Self {
            path: format!("{parent}{joint}{}", self.path),
            reason: self.reason,
        }
    }
}

impl From<PolygonError> for Problem {
    fn from(error: PolygonError) -> Self {
        Self::new("", error.to_string())
    }
}

/// Puts the parent's key before the path of a problem in a result.
pub trait Under {
    fn under(self, parent: &str) -> Self;
}

impl<T> Under for Result<T, Problem> {
    fn under(self, parent: &str) -> Self {
        self.map_err(|problem| problem.under(parent))
    }
}

/// "; did you mean `x`?" if one of `known` is similar to `given`, else empty. Case and what separates words do not
/// count, nor do missing words at the end.
pub fn suggestion<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    /// A prefix of at least this length suggests the full name.
    const STEM: usize = 4;
    let joined = |name: &str| {
        name.to_lowercase()
            .replace(|c: char| !c.is_alphanumeric(), "")
    };
    let slips = |name: &str| {
        let rest = name.strip_prefix(given).unwrap_or_default();
        if rest.starts_with('_') || (given.len() >= STEM && !rest.is_empty()) {
            1
        } else {
            let together = strsim::damerau_levenshtein(&joined(given), &joined(name));
            strsim::damerau_levenshtein(given, name).min(together)
        }
    };
    let most = (given.len() / 4).max(1);
    known
        .into_iter()
        .filter(|name| given.len() < 2 * name.len()) // else more letters would have to go than it has
        .map(|name| match given.eq_ignore_ascii_case(name) {
            true => (0, name),
            false => (slips(name), name),
        })
        .filter(|&(slips, name)| slips <= most && slips < name.len())
        .min()
        .map(|(_, name)| format!("; did you mean `{name}`?"))
        .unwrap_or_default()
}

/// Rewrites a message of serde without Rust terms, and adds a suggestion for unknown names: without a long list of all.
pub fn in_plain_words(said: &str) -> String {
    /// Longer lists of names hide the suggestion.
    const LISTED: usize = 10;
    let (head, given, tail) = around_the_given(said);
    let is_name = said.starts_with("unknown field") || said.starts_with("unknown variant");
    let known = || tail.split('`').skip(2).step_by(2);
    let near = match is_name {
        true => suggestion(given, known()),
        false => String::new(),
    };
    let plain = |words: &str| {
        WORDS.iter().fold(words.to_owned(), |said, (rust, plain)| {
            said.replacen(rust, plain, 1)
        })
    };
    let tail = match near.is_empty() {
        true => plain(tail),
        false if known().count() > LISTED => format!("`{near}"),
        false => plain(tail).replacen(", expected", &format!("{near} Expected"), 1),
    };
    let hint = hints::of_type(said, given);
    format!("{}{}{tail}{hint}", plain(head), shown(given))
}

/// Splits a message of serde into the parts before, in and after the text that it quotes from the document.
fn around_the_given(said: &str) -> (&str, &str, &str) {
    const BEFORE: [&str; 4] = [
        "unknown field `",
        "unknown variant `",
        "invalid type: string \"",
        "invalid value: string \"",
    ];
    let around = BEFORE.iter().find_map(|before| {
        let start = said.starts_with(before).then_some(before.len())?;
        let quote = &before[before.len() - 1..];
        let ends = [", expected ", ", there are no "].map(|next| format!("{quote}{next}"));
        let end = ends.iter().find_map(|end| said.rfind(end));
        Some((start, end.filter(|&end| end >= start)?))
    });
    let (start, end) = around.unwrap_or((said.len(), said.len()));
    (&said[..start], &said[start..end], &said[end..])
}

/// Phrases of serde and serde_json with their replacements.
const WORDS: [(&str, &str); 25] = [
    (
        "invalid type: unit variant, expected newtype variant",
        "must be an object with the keys of the measurement: {\"density\": {\"at_secs\": 15}}",
    ),
    ("expected f64", "expected a number"),
    ("expected u32", "expected a whole number from 0 to 2^32 - 1"),
    ("expected u64", "expected a whole number from 0 to 2^64 - 1"),
    ("expected an array of length", "expected a list of length"),
    (
        "expected fewer elements in array",
        "expected fewer elements in the list",
    ),
    (
        "expected fewer elements in map",
        "expected an object with exactly one key",
    ),
    ("expected enum", "expected an object with exactly one key"),
    ("expected a sequence", "expected a list"),
    ("expected a map", "expected an object"),
    ("expected a boolean", "expected true or false"),
    ("expected a string", "expected text in quotes"),
    ("invalid type: sequence", "invalid type: a list"),
    ("invalid type: map", "invalid type: an object"),
    ("invalid value: string", "invalid value: text"),
    ("invalid type: string", "invalid type: text"),
    ("unknown field", "unknown key"),
    ("unknown variant", "unknown value"),
    ("missing field", "missing key"),
    ("EOF while parsing", "the text ends within"),
    (
        "expected value",
        "expected a value: a number, text in quotes, true, false, null, a list or an object",
    ),
    (
        "number out of range",
        "number out of range: the largest is 1.7e308",
    ),
    (
        "trailing comma",
        "a comma before a closing bracket; remove it",
    ),
    (
        "trailing characters",
        "more text after the end of the scenario; remove it",
    ),
    ("recursion limit exceeded", "nested more than 127 deep"),
];
