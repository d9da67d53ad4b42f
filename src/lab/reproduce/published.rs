//! The values that the paper published (`published.json`).

use serde::Deserialize;

use crate::lab::error::LabError;

/// All values, with their source.
#[derive(Debug, Clone, Deserialize)]
pub struct Published {
    /// The paper.
    pub source: String,
    /// The room evacuation.
    pub table1: Table<EvacuationRow>,
    /// Crossing and bottleneck.
    pub table2: Table<CrossingRow>,
}

/// One table of the paper.
#[derive(Debug, Clone, Deserialize)]
pub struct Table<Row> {
    /// Where it is in the paper, and what it contains.
    pub place: String,
    /// Its rows, in order.
    pub rows: Vec<Row>,
}

/// A row of Table 1.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct EvacuationRow {
    /// The profile's name (§5.5).
    pub profile: String,
    /// The key of the parameter that varies.
    pub setting: String,
    /// Its value.
    pub value: f64,
    /// Number of agents that left the room.
    pub evacuated: f64,
    /// Mean of ρ_i at 15 s, P/m².
    pub density: f64,
    /// Standard deviation of ρ_i at 15 s, P/m².
    pub deviation: f64,
    /// Evacuees per second until the 350th.
    pub flow: f64,
}

/// A row of Table 2.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct CrossingRow {
    /// The profile's name (§5.5).
    pub profile: String,
    /// Mean of ρ_i at 45 s in front of the door, P/m².
    pub density: f64,
    /// Standard deviation of ρ_i there, P/m².
    pub deviation: f64,
    /// Evacuees per second in the first 60 s.
    pub flow: f64,
}

/// Reads the values that ship with the program.
///
/// # Errors
/// The file is not JSON of this form.
pub fn published() -> Result<Published, LabError> {
    let invalid = |error| LabError::Data(format!("published.json: {error}"));
    serde_json::from_str(include_str!("published.json")).map_err(invalid)
}

/// A profile in the paper's notation: `rvo->sph` is RVO→SPH.
pub fn written(profile: &str) -> String {
    profile.to_uppercase().replace("->", "→")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_rows_are_there() {
        let published = published().unwrap();
        assert_eq!(published.table1.rows.len(), 30);
        assert_eq!(published.table2.rows.len(), 7);
        assert!(published.source.contains("10.1016/j.cag.2021.06.005"));
        assert_eq!(written("rvo->sph"), "RVO→SPH");
    }
}
