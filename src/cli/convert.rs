//! `sandbox convert`: a floor plan or a scenario as JSON or GeoJSON.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::arguments::SceneOptions;
use super::failure::Failure;
use super::inputs;
use super::terminal::{talk, tell};
use runs::case::Source;
use runs::outputs::{Manner, Outputs, write_file};
use scenario::begun;
use scenario::floor_plan::is_plan;

#[derive(Args)]
pub struct ConvertOptions {
    /// A floor plan, a scenario, or the name of a built-in one
    pub input: PathBuf,
    /// The file to write: a scenario (.json) that needs no other file, or the floor and the places as GeoJSON
    /// (.geojson), in meters
    #[arg(short, long, value_name = "FILE")]
    pub out: PathBuf,
    #[command(flatten)]
    pub scene: SceneOptions,
}

pub fn run(options: &ConvertOptions) -> Result<(), Failure> {
    let out = &options.out;
    let ending = out
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    if ending != "json" && ending != "geojson" {
        let reason = format!(
            "--out {}: the file must end in .json or .geojson",
            out.display()
        );
        return Err(Failure::Input(reason));
    }
    let mut outputs = Outputs::new(options.scene.program.force);
    outputs.reads("the input", &options.input);
    outputs.writes("--out", out, Manner::File);
    outputs.check()?;
    let source = Source::at(options.input.clone());
    let mut draft = inputs::draft(&source, &options.scene, None, &mut outputs)?;
    let places = draft.places().len();
    if ending == "json" && is_plan(&options.input) {
        let settings = inputs::settings(&options.scene, None, &mut outputs)?;
        draft = begun(&options.input, &draft, &settings)?;
    }
    let scenario = draft.clone().scenario()?;
    let text = match ending.as_str() {
        "geojson" => format!("{:#}\n", draft.to_geojson()),
        _ => scenario.to_text(),
    };
    let written = write_file(out, text.as_bytes());
    written.map_err(|error| Failure::Output(format!("{}: {error}", out.display())))?;
    for note in scenario.notes {
        talk(&format!("note: {note}"));
    }
    let file = out.display().to_string();
    tell(
        options.scene.program.json,
        || json!({"file": file, "places": places}),
        || format!("{file}: the floor, and {places} place(s) that the plan names\n"),
    )
}
