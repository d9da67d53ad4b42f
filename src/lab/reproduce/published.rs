//! The values that the paper published (`published.json`).

use serde::{Deserialize, Serialize};

use scenario::input::embedded;

/// All values, with their source.
#[derive(Debug, Clone, Deserialize)]
pub struct Published {
    /// The paper.
    pub source: String,
    /// The room evacuation.
    pub table1: PublishedTable,
    /// Crossing and bottleneck.
    pub table2: PublishedTable,
}

/// One table of the paper.
#[derive(Debug, Clone, Deserialize)]
pub struct PublishedTable {
    /// Its place in the paper, and its contents.
    pub place: String,
    /// Its rows, in order.
    pub rows: Vec<PublishedRow>,
}

/// A row of a table.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct PublishedRow {
    /// The profile's name (§5.5).
    pub profile: String,
    /// The property that distinguishes rows of the same profile in Table 1.
    #[serde(flatten)]
    pub varied: Option<Varied>,
    /// Number of agents that left the room, in Table 1.
    pub evacuated: Option<f64>,
    /// Mean of ρ_i at 15 s (Table 1), or at 45 s in front of the door (Table 2), P/m².
    pub density: f64,
    /// Standard deviation of ρ_i at the same place and time, P/m².
    pub deviation: f64,
    /// Evacuees per second until the 350th (Table 1), or in the first 60 s (Table 2).
    pub flow: f64,
}

/// The parameter that varies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Varied {
    /// Its key.
    pub setting: String,
    /// Its value.
    pub value: f64,
}

/// The values that the paper published.
pub fn published() -> Published {
    embedded("published.json", include_str!("published.json"))
}

/// A profile in the paper's notation: `rvo->sph` is RVO→SPH.
pub fn written(profile: &str) -> String {
    profile.to_uppercase().replace("->", "→")
}
