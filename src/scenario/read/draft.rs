//! A scenario file with its settings, read and checked key by key, before any agents are placed.

use std::path::Path;

use serde_json::{Value, json};

use crate::error::numbers::tidy;
use crate::error::{Problem, ScenarioError};
use crate::file::File;
use crate::floor_plan::Place;
use crate::jupedsim;
use crate::kinds;
use crate::read::levels::{SideBySide, without_level};
use crate::read::plans::PlanFile;
use crate::read::scenario::Scenario;
use crate::read::setting::Setting;
use crate::read::{document, late, plans};
use crate::scene::levels;
use crate::scene::need::Need;
use crate::scene::surroundings::WALKABLE_AREA;
use crate::trajectories::Tracks;

/// A scenario whose names, types and ranges are valid. Relations between values are not checked yet.
#[derive(Debug, Clone)]
pub struct Draft {
    /// The JSON, with its preset expanded and the files that it names inlined, but for floor plans, which `keys` have.
    pub(super) document: Value,
    /// The files that it names.
    pub(super) files: Vec<PlanFile>,
    /// What its floor plans name.
    pub(super) places: Vec<Place>,
    pub(super) keys: File,
    /// A building with its levels side by side: `keys` are those of its plane.
    pub(super) building: Option<SideBySide>,
    /// Notes on these files, for readers of the results.
    pub(super) notes: Vec<String>,
    pub(super) need: Need,
    pub(super) inputs: Inputs,
    /// Whether it is a scenario of JuPedSim's web app.
    pub(super) is_web_app: bool,
}

/// The file and the settings of a draft: error messages name the one that caused a problem.
#[derive(Debug, Clone, Default)]
pub(super) struct Inputs {
    file: String,
    /// The file without settings; `None` if there are none.
    without: Option<Value>,
    /// The settings with their paths in the document.
    settings: Vec<(String, Setting)>,
}

impl Draft {
    /// Reads a scenario from JSON and applies the settings. Messages call it `file`; paths in it are relative to the
    /// folder of `file`.
    ///
    /// # Errors
    /// The text is not JSON, a name, type or range is wrong, or there are too many agents.
    pub fn read(text: &str, file: &str, settings: &[Setting]) -> Result<Self, ScenarioError> {
        let mut inputs = Inputs {
            file: file.to_owned(),
            without: None,
            settings: Vec::with_capacity(settings.len()),
        };
        let mut document = document::read(text, file)?;
        let translated = jupedsim::translate(&mut document, Path::new(file));
        let translated = translated.map_err(|problem| inputs.blame(problem))?;
        if let Some(what) = kinds::not_a_scenario(&document) {
            return Err(inputs.blame(Problem::new("", what)));
        }
        document::rename_old_keys(&mut document).map_err(|problem| inputs.blame(problem))?;
        if document.is_object() && !settings.is_empty() {
            inputs.without = Some(document.clone());
            for setting in settings {
                let applied = setting.apply(&mut document);
                let path = applied.map_err(|problem| setting.refused(problem))?;
                inputs.settings.push((path, setting.clone()));
            }
        }
        let copy = translated.is_web_app.then(|| document.clone());
        let named = |problem| copy.iter().fold(problem, jupedsim::named);
        let draft = Self::of(document, Path::new(file));
        let mut draft = draft.map_err(|problem| inputs.blame(named(problem)))?;
        inputs.check_replaced()?;
        draft.need.text = text.len() as u64;
        draft.is_web_app = translated.is_web_app;
        draft.notes.splice(0..0, translated.notes);
        let geometry = translated.geometry.into_iter();
        draft
            .files
            .extend(geometry.map(|path| (WALKABLE_AREA, path)));
        Ok(Self { inputs, ..draft })
    }

    /// The size of its run.
    pub fn need(&self) -> &Need {
        &self.need
    }

    /// Notes on the files that it names.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Whether agents behave by the default profile: the scenario gives none.
    pub fn has_default_profile(&self) -> bool {
        self.keys.profile.is_none()
    }

    /// The trajectories from which it begins, and the time in them at which it does, seconds; `None` if it names no
    /// file.
    ///
    /// # Errors
    /// The file has changed since [`read`](Self::read), and is invalid now.
    pub fn trajectories(&self) -> Result<Option<(Tracks, f64)>, ScenarioError> {
        let tracks = self.tracks(Path::new(&self.inputs.file));
        tracks.map_err(|problem| self.inputs.blame(problem))
    }

    /// Checks the relations between values and places the agents.
    ///
    /// # Errors
    /// The first problem, with its place.
    pub fn scenario(mut self) -> Result<Scenario, ScenarioError> {
        let inputs = std::mem::take(&mut self.inputs);
        let is_web_app = self.is_web_app;
        let translated = is_web_app.then(|| self.document.clone());
        let building = self.building.as_ref();
        let levels = building.map(|building| building.levels.clone());
        let in_building = |text: &str| levels::in_building(levels.as_deref(), text);
        let ends = self.ends(inputs.without.as_ref());
        let late = self.late(ends);
        let built = self.built(Path::new(&inputs.file), ends[1]);
        let mut scenario = built.map_err(|problem| {
            let named = translated.iter().fold(problem, jupedsim::named);
            inputs.blame(Problem::new(named.path, in_building(&named.reason)))
        })?;
        scenario.notes.extend(late);
        scenario.notes.extend(late::idle(&scenario.scene, ends));
        scenario.notes.extend(late::short(&scenario.scene, ends));
        scenario.notes.extend(late::missed(&scenario.scene, ends));
        scenario.notes.extend(late::kept(&scenario.scene, ends));
        scenario
            .notes
            .retain(|note| !is_web_app || !jupedsim::is_about_sides(note));
        let notes = scenario.notes.iter();
        scenario.notes = notes.map(|note| in_building(&tidy(note))).collect();
        scenario.changes = inputs.changes();
        Ok(scenario)
    }

    /// The [`scenario`](Self::scenario) and the size of its run, if it fits into `there` bytes of memory (`None`: no
    /// limit). Writing its outputs takes `output` bytes per agent.
    ///
    /// # Errors
    /// It does not fit, or an error of [`scenario`](Self::scenario).
    pub fn within(
        self,
        there: Option<u64>,
        output: u64,
    ) -> Result<(Scenario, Need), ScenarioError> {
        let (file, need) = (self.inputs.file.clone(), self.need);
        let check = |need: &Need| need.check(&file, output, there.unwrap_or(u64::MAX));
        check(&need)?;
        let scenario = self.scenario()?;
        let need = need.with_lists(&scenario.scene);
        check(&need)?;
        Ok((scenario, need))
    }
}

impl Inputs {
    /// Checks the values in the file that settings replace.
    fn check_replaced(&self) -> Result<(), ScenarioError> {
        let Some(document) = &self.without else {
            return Ok(());
        };
        for (path, setting) in &self.settings {
            let key = &setting.path()[0];
            let is_there = setting.value_in(document).is_some_and(|v| !v.is_null());
            let Some(value) = document.get(key).filter(|_| is_there) else {
                continue;
            };
            if value.is_string() && (plans::KEYS.contains(&key.as_str()) || key == plans::LEVELS) {
                continue; // the name of a file
            }
            let alone = without_level(json!({ key: value }));
            let problem = Draft::check_keys(&alone).err();
            // Other settings may mend what lies elsewhere.
            if let Some(problem) = problem.filter(|problem| problem.seen_from(path).is_some()) {
                let file = self.file.clone();
                return Err(ScenarioError::Invalid { file, problem });
            }
        }
        Ok(())
    }

    /// The settings whose values differ from those in the file, as typed.
    fn changes(&self) -> Vec<String> {
        let differs = |(path, setting): &&(String, Setting)| {
            let file = self.without.as_ref();
            let before = file.and_then(|file| setting.value_in(file));
            // Elements that were added to a list have no value in the file.
            path.ends_with(']') || before != Some(setting.value())
        };
        let changes = self.settings.iter().filter(differs);
        let mut changes: Vec<_> = changes.map(|(_, setting)| setting.brief()).collect();
        changes.dedup(); // a floor plan sets several keys
        changes
    }

    /// The error for a problem: it names the setting that put the value there, else the file, and the settings if the
    /// file is valid without them.
    fn blame(&self, problem: Problem) -> ScenarioError {
        for (path, setting) in self.settings.iter().rev() {
            if let Some(problem) = problem.seen_from(path) {
                return setting.refused(problem);
            }
        }
        let mut file = self.file.clone();
        if let Some(document) = &self.without {
            let path = Path::new(&self.file);
            let alone = Draft::of(document.clone(), path);
            if alone
                .and_then(|draft| draft.built(path, f64::INFINITY))
                .is_ok()
            {
                let settings = self.settings.iter();
                let mut settings: Vec<_> = settings.map(|(_, one)| format!(" {one}")).collect();
                settings.dedup();
                file.push_str(" with");
                file.extend(settings);
            }
        }
        ScenarioError::Invalid { file, problem }
    }
}
