//! Values of experiments to which nothing was fitted, as `docs/findings/held_out.json` has them. They were counted
//! outside of this repository.

use std::collections::BTreeMap;

use serde::Deserialize;

/// How many values are within their tolerances, and of how many.
pub type Count = [usize; 2];

/// The values that were held out.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeldOut {
    /// What they are.
    pub about: String,
    /// The commit whose program was run.
    pub commit: String,
    /// The profile that was counted.
    pub profile: String,
    /// The number of runs.
    pub runs: usize,
    /// All values.
    pub values: Count,
    /// The mean deviation, in tolerances.
    pub mean_deviation: f64,
    /// The values by kind of run.
    pub kinds: Vec<Kind>,
    /// The share of other profiles, in words.
    pub others: BTreeMap<String, String>,
    /// Another program on some of these runs.
    pub beside: Beside,
}

/// The values of runs of one kind.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kind {
    /// Its name.
    pub name: String,
    /// Its values.
    pub values: Count,
    /// What misses.
    #[serde(default)]
    pub note: String,
}

/// Models on the same runs.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beside {
    /// The other program, and its settings.
    pub program: String,
    /// The number of runs.
    pub runs: usize,
    /// The values of each model.
    pub values: BTreeMap<String, Count>,
}

impl HeldOut {
    /// What a report says of a profile; `None` if it was not counted.
    pub fn said_of(&self, profile: &str) -> Option<String> {
        let [inside, all] = self.values;
        let (commit, runs) = (&self.commit, self.runs);
        if let Some(share) = self.others.get(profile) {
            return Some(format!(
                "held out: {share} of {all} values of {runs} runs are within their tolerances (counted on {commit})."
            ));
        }
        let said = self.kinds.iter().map(|kind| {
            let [inside, all] = kind.values;
            let note = match kind.note.as_str() {
                "" => String::new(),
                note => format!(" ({note})"),
            };
            format!("{} {inside} of {all}{note}", kind.name)
        });
        let kinds: Vec<String> = said.collect();
        (profile == self.profile).then(|| {
            format!(
                "held out: {inside} of {all} values of {runs} runs are within their tolerances. {}. They were counted \
                 outside of the project, on {commit}, with data that was never opened in it and stays closed. By kind: \
                 {}. Mean deviation: {} tolerances.",
                self.about,
                kinds.join("; "),
                self.mean_deviation
            )
        })
    }
}
