//! What a command changed in a suite.

use serde::Serialize;

/// The settings and seeds that a command gave in place of those of the suite.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Changed {
    /// The settings, as `key=value`.
    pub settings: Vec<String>,
    /// The seeds, if they are not those of the suite.
    pub seeds: Vec<u64>,
}

impl Changed {
    /// Whether anything is changed.
    pub fn is_anything(&self) -> bool {
        !self.settings.is_empty() || !self.seeds.is_empty()
    }

    /// The changes in words; empty if there are none.
    pub fn text(&self) -> String {
        let quoted = self.settings.iter().map(|setting| format!("`{setting}`"));
        let settings = match self.settings.len() {
            0 => None,
            _ => Some(quoted.collect::<Vec<_>>().join(", ") + " in every scene"),
        };
        let seeds = match &self.seeds[..] {
            [] => None,
            [only] => Some(format!("seed {only}")),
            [first, .., last] => Some(format!("seeds {first} to {last}")),
        };
        let parts: Vec<String> = settings.into_iter().chain(seeds).collect();
        parts.join("; ")
    }
}
