//! What commands read: scenarios with the settings of the command line, trajectories, floor plans.

use std::fmt::Display;
use std::path::Path;

use super::arguments::{SceneOptions, setting};
use super::failure::Failure;
use super::terminal::talk;
use lab::machine::main_memory;
use lab::measure::Site;
use runs::case::Source;
use runs::outputs::Outputs;
use scenario::floor_plan::{self, FloorPlan, is_plan};
use scenario::quote::shown;
use scenario::trajectories::{self, ReadOptions, Tracks};
use scenario::{Draft, Scenario, Setting};

/// The default profile is the paper's, as files of earlier versions expect; it is not for questions about real people.
const DEFAULT_PROFILE_NOTE: &str = "note: no `profile` is given: `sph`, the default, is the paper's, whose dense \
                                    crowds walk two to five times as fast as people do; `steer+sph` is fitted to \
                                    experiments (docs/findings/validation.md)";

/// Reads a scenario and applies the settings of the command line. `until` is the flag that sets another end, and the
/// end in seconds. Writing the output files takes `writing` bytes of memory per agent. Adds the files that were read to
/// `outputs`.
pub fn scenario(
    source: &Source,
    scene: &SceneOptions,
    until: Option<(&str, f64)>,
    writing: u64,
    outputs: &mut Outputs,
) -> Result<Scenario, Failure> {
    let draft = draft(source, scene, until, outputs)?;
    let is_default = draft.has_default_profile();
    let of_plans = draft.notes().to_vec();
    let (scenario, _) = draft.within(main_memory(), writing).inspect_err(|_| {
        // How the plan was read may explain the error.
        of_plans
            .iter()
            .for_each(|note| talk(&format!("note: {note}")));
    })?;
    if let Source::File(path) = source {
        outputs.reads("the scenario", path);
        if is_default && !is_plan(path) {
            talk(DEFAULT_PROFILE_NOTE);
        }
    }
    for (key, path) in &scenario.files {
        outputs.reads(key, path);
    }
    for note in &scenario.notes {
        talk(&format!("note: {note}"));
    }
    Ok(scenario)
}

/// Reads a scenario whose values are not compared yet; `until` as for [`scenario`].
pub fn draft(
    source: &Source,
    scene: &SceneOptions,
    until: Option<(&str, f64)>,
    outputs: &mut Outputs,
) -> Result<Draft, Failure> {
    let settings = settings(scene, until, outputs)?;
    let (text, file) = source.text()?;
    Ok(Draft::read(&text, &file, &settings)?)
}

/// The settings of the command line; `until` as for [`scenario`].
pub fn settings(
    scene: &SceneOptions,
    until: Option<(&str, f64)>,
    outputs: &mut Outputs,
) -> Result<Vec<Setting>, Failure> {
    let (until_flag, until) =
        until.map_or(("", None), |(flag, secs)| (flag, Some(secs.to_string())));
    let seed = scene.changes.seed.map(|seed| seed.to_string());
    let flags = [
        ("--profile", "profile", scene.profile.clone()),
        ("--preset", "preset", scene.preset.clone()),
        ("--seed", "seed", seed),
        (until_flag, "duration_secs", until),
        ("--time-step", "time_step_secs", scene.time_step.clone()),
    ];
    let typed = scene.changes.settings()?;
    let mut settings = Vec::new();
    let mut last = None;
    for (flag, key, value) in flags {
        let Some(value) = value else { continue };
        let made = setting(&format!("{key}={value}"))?;
        let setting = made.typed_as(format!("{flag} {}", shown(&value)));
        if flag == "--at" {
            last = Some(setting); // applied last: --at beyond the end moves the end, even one given by --set
            continue;
        }
        if let Some(other) = typed.iter().find(|other| other.path() == setting.path()) {
            return Err(Failure::Input(format!(
                "{setting} and {other} set the same key: give only one of them"
            )));
        }
        settings.push(setting);
    }
    if let Some(path) = &scene.geometry {
        let text = format!("--geometry {}", path.display());
        outputs.reads("--geometry", path);
        settings.extend(Setting::plan_file(path, &text));
    }
    settings.extend(typed.into_iter().chain(last));
    Ok(settings)
}

/// Reads the plan of `--geometry`.
fn floor_plan(path: &Path) -> Result<FloorPlan, Failure> {
    let read = floor_plan::read(path);
    let plan = read.map_err(|error| Failure::Input(format!("--geometry {error}")))?;
    for note in &plan.notes {
        talk(&format!("note: --geometry {}: {note}", path.display()));
    }
    Ok(plan)
}

/// Rejects a period that ends before it begins: two options with their times, seconds.
pub fn in_order((first, from): (&str, f64), (second, to): (&str, f64)) -> Result<(), Failure> {
    match to < from {
        true => Err(Failure::Input(format!(
            "{second} {to} is before {first} {from}"
        ))),
        false => Ok(()),
    }
}

/// The option for the frame rate of trajectories.
pub const FPS: &str = "--fps";
/// The same of commands that have another rate, too.
pub const TRAJECTORY_FPS: &str = "--trajectory-fps";

/// Reads trajectories for a command with this option for their frame rate.
pub fn tracks(path: &Path, options: &ReadOptions, rate_option: &str) -> Result<Tracks, Failure> {
    let read = trajectories::read(path, options);
    let tracks = read.map_err(|error| error.with_rate_option(rate_option))?;
    for note in &tracks.notes {
        let note = note.replace(FPS, rate_option);
        talk(&format!("note: {}: {note}", path.display()));
    }
    Ok(tracks)
}

/// The value of `--geometry` for no walls.
pub const NO_WALLS: &str = "none";

/// The walls, from the floor plan `geometry` or else from the trajectory file at `path`.
pub fn site(path: &Path, geometry: Option<&Path>, tracks: &Tracks) -> Result<Site, Failure> {
    let plan = match (geometry, tracks.walkable.as_slice()) {
        (Some(path), _) if path.as_os_str() == NO_WALLS => None,
        (Some(path), _) => Some(floor_plan(path)?),
        (None, []) => None,
        (None, [text]) => Some(floor_plan::parse_wkt(text).map_err(|error| own(path, &error))?),
        (None, several) => {
            let problem = format!("{} geometries, one after the other", several.len());
            return Err(own(path, &problem));
        }
    };
    let cut = plan.map_or(Ok(Vec::new()), FloorPlan::solids);
    let solids = cut.map_err(|error| Failure::Input(format!("the floor plan: {error}")))?;
    Ok(Site::new(solids))
}

/// The error for a problem with the geometry in a trajectory file.
fn own(path: &Path, problem: &dyn Display) -> Failure {
    let path = path.display();
    Failure::Input(format!(
        "{path}: its geometry: {problem}; give another one with --geometry, or use --geometry {NO_WALLS}"
    ))
}
