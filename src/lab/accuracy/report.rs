//! The report of `sandbox accuracy`.

use super::found::{self, Found};
use super::scenes::names;
use crate::error::LabError;
use output::table::Table;
use runs::store::Store;

/// The name of the table of the best choices of all scenes.
pub const CHOICES: &str = "choices";

/// All results.
#[derive(Clone)]
pub struct Report {
    /// The results, scene by scene.
    pub scenes: Vec<Found>,
    /// Whether the plan was quick, with few values, seeds and turns.
    pub quick: bool,
}

impl Report {
    /// A table of the cheapest settings for each error.
    fn choices(&self) -> Table {
        let choices: Vec<_> = self.scenes.iter().flat_map(Found::choices).collect();
        found::table(&choices)
    }

    /// The cheapest settings for each error, then all points, as Markdown: (name, text).
    pub fn parts(&self) -> Vec<(String, String)> {
        let choices = [(CHOICES.to_owned(), self.choices().markdown())].into_iter();
        let scenes = self.scenes.iter().map(|found| {
            let text = format!("{}\n\n{}", found.notes, found.table().markdown());
            (found.scene.name.to_owned(), text)
        });
        choices.chain(scenes).collect()
    }

    /// The text for a terminal.
    pub fn text(&self) -> String {
        let scenes = self.scenes.iter().map(|found| {
            let (name, about, table) = (found.scene.name, found.scene.about(), found.table());
            format!("{name}: {about}\n{}\n\n{}\n", found.notes, table.text())
        });
        scenes.chain([self.choices().text()]).collect()
    }

    /// Writes tables, CSV and JSON into the store's folder.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, store: &Store) -> Result<(), LabError> {
        let parts = self.parts().into_iter();
        let text: String = parts
            .map(|(name, text)| format!("## {name}\n\n{text}\n"))
            .collect();
        store.write("accuracy.md", text.as_bytes())?;
        store.write("accuracy.csv", &self.csv()?)?;
        let json = format!("{}\n", self.json());
        store.write("accuracy.json", json.as_bytes())?;
        Ok(())
    }

    /// One row for each error of each point.
    fn csv(&self) -> Result<Vec<u8>, LabError> {
        let mut rows = Vec::new();
        for found in &self.scenes {
            for point in &found.points {
                let errors = found.quantities.iter().zip(&point.errors);
                let errors = errors.filter_map(|(quantity, error)| Some((quantity, (*error)?)));
                rows.extend(errors.map(|(quantity, error)| (found, point, quantity, error)));
            }
        }
        let table = Table::of(&rows)
            .column("scene", |(found, ..)| found.scene.name)
            .column("knob", |(_, point, ..)| point.trial.knob.as_str())
            .column("curve", |(_, point, ..)| point.trial.curve.as_str())
            .column("settings", |(_, point, ..)| names(&point.trial.settings))
            .column("default", |(_, point, ..)| point.trial.is_default)
            .column("ms_per_s", |(_, point, ..)| point.cost.median)
            .column("ms_per_s_min", |(_, point, ..)| point.cost.minimum)
            .column("ms_per_s_max", |(_, point, ..)| point.cost.maximum)
            .column("quantity", |(.., quantity, _)| quantity.name.as_str())
            .column("unit", |(.., quantity, _)| quantity.unit)
            .column("mean", |(.., error)| error.mean.map(|(mean, _)| mean))
            .column("mean_interval", |(.., error)| {
                error.mean.map(|(_, interval)| interval)
            })
            .column("error", |(.., error)| error.error)
            .column("error_interval", |(.., error)| error.interval)
            .table();
        Ok(table.csv()?)
    }

    /// All results as one object.
    pub fn json(&self) -> serde_json::Value {
        let scenes = self.scenes.iter().map(|found| {
            serde_json::json!({
                "scene": found.scene.name,
                "about": found.scene.about(),
                "notes": found.notes,
                "quantities": found.quantities,
                "points": found.points,
            })
        });
        serde_json::json!({ "quick": self.quick, "scenes": scenes.collect::<Vec<_>>() })
    }
}
