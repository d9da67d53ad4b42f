//! Spreads and errors of the step in many scenes, for the file that ships with the program.

use serde_json::json;

use super::coverage::{Pool, pooled, question};
use sandbox::analysis::round;
use sandbox::lab::error::LabError;
use sandbox::lab::estimate::{Known, Prior};
use sandbox::output::document::{Block, Document, Findings};
use sandbox::output::table::Table;
use sandbox::runs::job::Listener;
use sandbox::runs::store::Store;

/// The name of the study, of its files, and of its table in documents.
pub const KNOWLEDGE: &str = "knowledge";

/// The profiles.
const PROFILES: [&str; 9] = [
    "sph",
    "walk+sph",
    "sf->sph",
    "rvo->sph",
    "steer+sph",
    "sf+sph",
    "rvo+sph",
    "sf",
    "rvo",
];
/// The scenes, relative to the shipped scenarios, with the number of profiles whose runs are made.
const SCENES: [(&str, usize); 7] = [
    ("evacuation.json", 4),
    ("validation/gap.json", 5),
    ("validation/door.json", 9),
    ("validation/entrance.json", 9),
    ("validation/corner.json", 9),
    ("validation/corridor.json", 9),
    ("validation/two_ways.json", 9),
];
/// The number of runs at each step.
const SEEDS: usize = 20;

/// Results of many scenes.
pub struct Knowledge {
    known: Vec<Known>,
    secs: f64,
}

/// Makes the runs that are not in the store.
///
/// # Errors
/// A run fails, or results cannot be stored.
pub fn knowledge(store: &Store, listener: &dyn Listener) -> Result<Knowledge, LabError> {
    let (mut known, mut secs) = (Vec::new(), 0.0);
    let pool = Pool {
        seeds: SEEDS,
        repeats: 0,
    };
    for (file, profiles) in SCENES {
        for profile in &PROFILES[..profiles] {
            let question = question(file, profile, &[])?;
            let (runs, _) = pooled(&question, pool, store, listener)?;
            secs += runs.measured_secs();
            let results = question.names.iter().filter_map(|name| {
                let means = runs.series(name).means(&Prior::NONE)?;
                Known::of(&question, name, &means)
            });
            known.extend(results);
        }
    }
    Ok(Knowledge { known, secs })
}

impl Knowledge {
    /// Everything for readers and programs. The data are the file that ships with the program.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self) -> Result<Findings, LabError> {
        let table = Table::of(&self.known)
            .column("scene", |known| known.scene.as_str())
            .column("profile", |known| known.profile.as_str())
            .column("result", |known| known.result.as_str())
            .fixed("spread [%]", 2, |known| 100.0 * known.spread)
            .fixed("error at 0.02 s [spreads]", 2, |known| known.error)
            .table();
        let hours = round::brief(self.secs / 3600.0);
        let document = Document::of(
            "What estimates know before their first run",
            vec![
                Block::table(table.clone()),
                Block::Text(format!("{hours} hours on one core.")),
            ],
        );
        let known = self.known.iter();
        let known = known.map(|known| Known {
            spread: short(known.spread),
            error: short(known.error),
            error_std: known.error_std.map(short),
            ..known.clone()
        });
        let data = json!(known.collect::<Vec<_>>());
        Ok(Findings::new(KNOWLEDGE, document, data).with_table(KNOWLEDGE, &table)?)
    }
}

/// A number with three digits.
fn short(number: f64) -> f64 {
    format!("{number:.2e}").parse().unwrap_or(number)
}
