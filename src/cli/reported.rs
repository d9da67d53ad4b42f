//! The report of a run, for commands that run a scenario.

use std::ops::ControlFlow;

use serde_json::json;

use super::arguments::SceneOptions;
use super::failure::Failure;
use super::moment::none_left;
use super::results;
use lab::report::{InputFile, Sources, Watched, of_run};
use output::document::{Findings, Names};
use runs::case::Source;
use runs::drive::{End, Observer, Run};
use scenario::Scenario;
use scenario::measurements::Measurement;

/// What was typed: a scenario, its settings, and the times of pictures.
pub struct Typed<'a> {
    pub source: &'a Source,
    pub scene: &'a SceneOptions,
    pub until: Option<f64>,
    pub at: &'a [f64],
}

/// The names of the files with the results of a run.
pub fn names(scenario: &Scenario) -> Names {
    Names::new(&scenario.name, &[&scenario.name], &[]).numbered()
}

/// Everything about a run that has ended, and was watched from its first frame on.
pub fn findings(run: &Run, watched: &Watched, typed: &Typed) -> Result<Findings, Failure> {
    let name = match typed.source {
        Source::BuiltIn(path) => path.file_stem().unwrap_or_default().to_string_lossy(),
        Source::File(path) => path.to_string_lossy(),
    };
    let words = words(&name, typed.scene, typed.until);
    let command = match typed.source {
        Source::BuiltIn(_) => format!("sandbox {}", words.join(" ")),
        Source::File(_) => format!("sandbox run {}", words.join(" ")),
    };
    let at = typed.at.iter().map(|at| format!("--at {at}"));
    let report = words.iter().cloned().chain(at).collect::<Vec<_>>();
    let sources = Sources {
        command: &command,
        report: &format!("sandbox report {}", report.join(" ")),
        files: files(&run.scenario, typed),
    };
    results::findings(run, of_run(run, watched, sources)?)
}

/// The files that a run reads.
fn files(scenario: &Scenario, typed: &Typed) -> Vec<InputFile> {
    let own = match typed.source {
        Source::File(path) => Some(("scenario", path.clone())),
        Source::BuiltIn(_) => None,
    };
    let geometry = typed.scene.geometry.iter();
    let plan = geometry.map(|path| ("--geometry", path.clone()));
    let all = own.into_iter().chain(scenario.files.iter().cloned());
    all.chain(plan)
        .map(|(what, path)| InputFile {
            what: what.to_owned(),
            path,
        })
        .collect()
}

/// Lets the report watch the run, and ends it if no agents are left for a picture.
pub struct Watch<'a>(pub &'a mut Watched);

impl Observer<Failure> for Watch<'_> {
    fn observe(&mut self, run: &Run, _: f64, then: ControlFlow<End>) -> Result<(), Failure> {
        let simulation = &run.simulation;
        self.0.see(simulation);
        let Some(missing) = self.0.missing() else {
            return Ok(());
        };
        let is_empty = simulation.frame().agents.count_present() == 0;
        let option = format!("--at {missing}");
        match then {
            _ if is_empty && !simulation.expects_agents() => {
                Err(none_left((&option, missing), simulation))
            }
            ControlFlow::Break(end) if end != End::Interrupted => Err(Failure::Input(format!(
                "{option}: the run ends at {:.2} s: {}",
                simulation.frame().clock.time(),
                run.reason()
            ))),
            _ => Ok(()),
        }
    }
}

/// Adds the measurements that every report has. They change no result.
pub fn complete(scenario: &mut Scenario) -> Result<(), Failure> {
    let has = |is: fn(&Measurement) -> bool| scenario.measurements.iter().any(is);
    let has_journeys = !scenario.scene.journeys.journeys.is_empty();
    let wanted = [
        (
            "egress",
            has_journeys && !has(|one| matches!(one, Measurement::Egress(_))),
        ),
        (
            "exposure",
            !has(|one| matches!(one, Measurement::Exposure(_))),
        ),
        (
            "service_levels",
            !has(|one| matches!(one, Measurement::ServiceLevels(_))),
        ),
    ];
    for (name, _) in wanted.into_iter().filter(|(_, is_wanted)| *is_wanted) {
        let parsed = serde_json::from_value(json!({ name: {} }));
        let keys = parsed.map_err(|error| Failure::Input(format!("{name}: {error}")))?;
        scenario.measurements.push(keys);
    }
    Ok(())
}

/// The scenario and its settings, as typed into a shell.
pub fn words(run: &str, scene: &SceneOptions, until: Option<f64>) -> Vec<String> {
    let seed = scene.changes.seed.map(|seed| seed.to_string());
    let until = until.map(|until| until.to_string());
    let path = scene.geometry.as_ref();
    let geometry = path.map(|path| path.display().to_string());
    let options = [
        ("--profile", scene.profile.clone()),
        ("--seed", seed),
        ("--preset", scene.preset.clone()),
        ("--time-step", scene.time_step.clone()),
        ("--geometry", geometry),
        ("--until", until),
    ];
    let given = options
        .into_iter()
        .filter_map(|(name, value)| Some((name, value?)));
    let set = scene.changes.set.iter().map(|one| ("--set", one.clone()));
    let words = given
        .chain(set)
        .map(|(name, value)| format!("{name} {}", quoted(&value)));
    [quoted(run)].into_iter().chain(words).collect()
}

/// A word as a shell reads it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "+-=_./,:%".contains(c);
    match word.chars().all(is_plain) && !word.is_empty() {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}
