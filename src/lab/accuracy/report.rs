//! What `sandbox accuracy` prints and writes.

use std::fmt::Write;

use super::found::Found;
use super::knob::are_default;
use super::walls::WallReport;
use crate::lab::error::LabError;
use crate::output::table::OldTable as Table;
use crate::runs::store::Store;

/// The name of the wall measurements in lists of scenes.
pub const WALLS: &str = "wall-integrals";

/// All results.
#[derive(Clone)]
pub struct Report {
    /// The results, scene by scene.
    pub scenes: Vec<Found>,
    /// The accuracy of the integrals over walls, if it was measured.
    pub walls: Option<WallReport>,
    /// Was the plan quick, with few values, seeds and turns?
    pub quick: bool,
}

impl Report {
    /// A table of the cheapest settings for each error.
    fn choices(&self) -> Table {
        let mut choices = Table::new(
            3,
            &["scene", "error", "settings", "ms per s", "error found"],
        );
        choices.rows = self.scenes.iter().flat_map(Found::choices).collect();
        choices
    }

    /// The cheapest settings for each error, then all points, as Markdown: (name, text).
    pub fn parts(&self) -> Vec<(String, String)> {
        let mut parts = vec![("choices".to_owned(), self.choices().markdown())];
        for found in &self.scenes {
            let text = format!("{}\n\n{}", found.notes, found.table().markdown());
            parts.push((found.scene.name.to_owned(), text));
        }
        let walls = self.walls.iter();
        parts.extend(walls.map(|walls| (WALLS.to_owned(), walls.markdown())));
        parts
    }

    /// The text for a terminal.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for found in &self.scenes {
            let _ = write!(
                text,
                "{}: {}\n{}\n\n{}\n",
                found.scene.name,
                found.scene.about,
                found.notes,
                found.table().text()
            );
        }
        if !self.scenes.is_empty() {
            text += &self.choices().text();
        }
        text + &self
            .walls
            .as_ref()
            .map(WallReport::markdown)
            .unwrap_or_default()
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
        if let Some(walls) = &self.walls {
            store.write("accuracy-walls.csv", &walls.csv()?)?;
        }
        let json = format!("{}\n", self.json());
        store.write("accuracy.json", json.as_bytes())?;
        Ok(())
    }

    /// One row for each error of each point.
    fn csv(&self) -> Result<Vec<u8>, LabError> {
        let mut table = Table::new(
            0,
            &[
                "scene",
                "knob",
                "curve",
                "settings",
                "default",
                "ms_per_s",
                "ms_per_s_min",
                "ms_per_s_max",
                "quantity",
                "unit",
                "mean",
                "mean_interval",
                "error",
                "error_interval",
            ],
        );
        for found in &self.scenes {
            for point in &found.points {
                for (quantity, measured) in found.quantities.iter().zip(&point.errors) {
                    let Some(measured) = measured else { continue };
                    let (mean, interval) = measured.mean.unzip();
                    let number =
                        |value: Option<f64>| value.map_or(String::new(), |v| v.to_string());
                    table.add([
                        found.scene.name.to_owned(),
                        point.knob.name().to_owned(),
                        point.curve.clone(),
                        point.settings.join(" "),
                        are_default(&point.settings).to_string(),
                        point.cost.median.to_string(),
                        point.cost.minimum.to_string(),
                        point.cost.maximum.to_string(),
                        quantity.name.clone(),
                        quantity.unit.to_owned(),
                        number(mean),
                        number(interval),
                        measured.error.to_string(),
                        measured.interval.to_string(),
                    ]);
                }
            }
        }
        table
            .csv()
            .map_err(|error| LabError::Data(error.to_string()))
    }

    /// All results as one object.
    pub fn json(&self) -> serde_json::Value {
        let scenes = self.scenes.iter().map(|found| {
            let points = found.points.iter().map(|point| {
                serde_json::json!({
                    "knob": point.knob.name(),
                    "curve": point.curve,
                    "settings": point.settings,
                    "default": are_default(&point.settings),
                    "ms_per_s": point.cost,
                    "errors": point.errors,
                })
            });
            serde_json::json!({
                "scene": found.scene.name,
                "about": found.scene.about,
                "notes": found.notes,
                "quantities": found.quantities,
                "points": points.collect::<Vec<_>>(),
            })
        });
        serde_json::json!({ "quick": self.quick, "scenes": scenes.collect::<Vec<_>>(), "walls": self.walls })
    }
}
