//! `sandbox draw --egress`: the number of people out over time.

use std::path::Path;

use serde_json::json;

use super::{DrawOptions, extension, print, refuse_settings};
use crate::cli::failure::Failure;
use crate::cli::inputs::{TRAJECTORY_FPS, scenario, tracks};
use crate::cli::moment;
use crate::cli::terminal::{talk, tell};
use lab::egress::Egress;
use runs::case::Source;
use runs::drive::Run;
use runs::outputs::{Manner, Outputs};
use scenario::quote::shown;
use scenario::trajectories::{self, OnLevel, ReadOptions};

/// Draws the curve, and prints the table.
pub fn draw(options: &DrawOptions, out: &Path, mut outputs: Outputs) -> Result<(), Failure> {
    outputs.writes("--out", out, Manner::File);
    let path = Path::new(&options.run);
    let (title, egress) = match extension(path).as_str() {
        "rrd" => {
            return Err(Failure::Input(format!(
                "--egress: {} is a recording, which does not say who has left; give the scenario or its trajectories",
                options.run
            )));
        }
        _ if trajectories::has_ending(path) => {
            refuse_settings(options, &options.scene)?;
            outputs.reads("the trajectories", path);
            outputs.check()?;
            let own = options.tracks.reading(options.trajectory_fps);
            let read = ReadOptions {
                level: OnLevel::Any,
                ..own.clone()
            };
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            let all = tracks(path, &read, TRAJECTORY_FPS)?;
            match &options.tracks.level {
                None => (stem.into_owned(), Egress::of_tracks(&all, &all)),
                Some(level) => {
                    // The file goes on after the last one has left the level.
                    let on_level = tracks(path, &own, TRAJECTORY_FPS)?;
                    let title = format!("{stem}: people who leave {}", shown(level));
                    (title, Egress::of_tracks(&on_level, &all))
                }
            }
        }
        _ if options.tracks.level.is_some() => {
            let reason = "--egress of a scenario shows the people who leave the building, on all levels: leave --level \
                          out, or give trajectories (sandbox run FILE --trajectory FILE) to see who leaves a level";
            return Err(Failure::Input(reason.to_owned()));
        }
        _ => simulated(options, outputs)?,
    };
    if egress.exits.iter().all(|(_, times)| times.is_empty()) {
        let run = &options.run;
        return Err(Failure::Input(format!("--egress: nobody leaves {run}")));
    }
    if let Some(note) = egress.note() {
        talk(&format!("note: {note}"));
    }
    let print = print(options, false);
    egress.sheet(&title).save_as(out, &print)?;
    let file = out.display().to_string();
    let times_by_exit = egress.exits.iter();
    let exits = times_by_exit.map(|(name, times)| json!({"exit": name, "secs": times}));
    tell(
        options.scene.program.json,
        || json!({"file": file, "entered": egress.entered, "exits": exits.collect::<Vec<_>>()}),
        || format!("{}{file}: people out over time\n", egress.table().text()),
    )
}

/// A scenario to its end.
fn simulated(options: &DrawOptions, mut outputs: Outputs) -> Result<(String, Egress), Failure> {
    let source = Source::named(&options.run);
    let whole = scenario(&source, &options.scene, None, 0, &mut outputs)?;
    outputs.check()?;
    let mut run = Run::new(whole)?;
    moment::to_the_end(&mut run, [])?;
    Ok((run.scenario.name.clone(), Egress::of(&run.simulation)))
}
