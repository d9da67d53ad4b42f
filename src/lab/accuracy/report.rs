//! The report of `sandbox accuracy`.

use serde_json::{Value, json};

use super::pictures;
use super::results::{self, SceneResults};
use super::scenes::names;
use crate::error::LabError;
use output::document::{Block, Document, Findings, Names};
use output::table::Table;

/// The name of the table of the best choices of all scenes.
pub const CHOICES: &str = "choices";
/// The name of the files.
const NAME: &str = "accuracy";

/// The names of the files with results of these scenes.
pub fn file_names<'a>(scenes: impl Iterator<Item = &'a str>) -> Names {
    Names {
        name: NAME.to_owned(),
        tables: vec![NAME.to_owned()],
        figures: scenes.map(figure).collect(),
    }
}

/// The name of a scene's figure.
fn figure(scene: &str) -> String {
    format!("{NAME}-{scene}")
}

/// All results.
#[derive(Clone)]
pub struct Report {
    /// The results, scene by scene.
    pub scenes: Vec<SceneResults>,
    /// Whether the plan was quick, with few values, seeds and turns.
    pub quick: bool,
}

impl Report {
    /// Everything for readers and programs.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self) -> Result<Findings, LabError> {
        let choices: Vec<_> = self.scenes.iter().flat_map(SceneResults::choices).collect();
        let part = |name: &str, heading: String| Block::Part(name.to_owned(), heading);
        let mut blocks = vec![
            part(CHOICES, "The cheapest settings for each error".to_owned()),
            Block::table(results::table(&choices)),
        ];
        for found in &self.scenes {
            let (name, about) = (found.scene.name, found.scene.about());
            blocks.push(part(name, format!("{name}: {about}")));
            blocks.push(Block::text(&found.notes));
            blocks.push(Block::table(found.table()));
            blocks.push(Block::figure(&figure(name), pictures::sheet(found), about));
        }
        let document = Document::of("Run time against error", blocks);
        let findings = Findings::new(NAME, document, self.json());
        Ok(findings.with_table(NAME, &self.errors())?)
    }

    /// One row for each error of each point.
    fn errors(&self) -> Table {
        let mut rows = Vec::new();
        for found in &self.scenes {
            for point in &found.points {
                let all = found.quantities.iter().zip(&point.errors);
                let errors = all.filter_map(|(quantity, error)| Some((quantity, (*error)?)));
                rows.extend(errors.map(|(quantity, error)| (found, point, quantity, error)));
            }
        }
        Table::of(&rows)
            .column("scene", |(found, ..)| found.scene.name)
            .column("choice", |(_, point, ..)| point.trial.choice.as_str())
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
            .table()
    }

    /// All results as one object.
    fn json(&self) -> Value {
        let scenes = self.scenes.iter().map(|found| {
            json!({
                "scene": found.scene.name,
                "about": found.scene.about(),
                "notes": found.notes,
                "quantities": found.quantities,
                "points": found.points,
            })
        });
        json!({ "quick": self.quick, "scenes": scenes.collect::<Vec<_>>() })
    }
}
