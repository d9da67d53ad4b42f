//! The scenes: crowds that begin to move smoothly, Table 1's evacuation, and a wave.
//!
//! Each scene is a study, `scenarios/studies/accuracy_SCENE.json`, whose list has the points to measure.

use std::f64::consts::TAU;
use std::path::Path;

use serde::Deserialize;
use serde_json::{Value, json};

use crate::error::LabError;
use crate::jobs::read;
use crate::sweep::Study;
use engine::math::Vector;
use engine::simulation::Simulation;
use scenario::input::embedded;
use scenario::{Scenario, Setting, built_in};

/// The way in which a scene is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// By the positions of agents in the first two seconds.
    Motion,
    /// By measurements, over seeds.
    Statistics,
}

/// The velocity that a push adds to an agent, m/s, by the agent's position and the size of the room, meters.
type Push = fn(Vector, Vector) -> Vector;

/// A scene that is computed under many settings.
#[derive(Clone, Copy)]
pub struct Scene {
    /// Its name on the command line.
    pub name: &'static str,
    /// The way in which its errors are measured.
    pub kind: Kind,
    /// Whether quick plans skip it unless it is named.
    pub is_long: bool,
    /// The push with which the scene begins, at the end of its scenario; `None` if it begins with the scenario itself.
    push: Option<Push>,
}

/// All scenes.
pub const SCENES: [Scene; 12] = [
    scene("relaxed", Kind::Motion, false, Some(whirl)),
    scene("pulse", Kind::Motion, false, Some(compression)),
    scene("wall", Kind::Motion, false, None),
    scene("social", Kind::Motion, false, None),
    scene("rvo", Kind::Motion, false, None),
    scene("headway", Kind::Motion, false, None),
    scene("density-ahead", Kind::Motion, true, None),
    scene("drag", Kind::Motion, true, None),
    scene("evacuation", Kind::Statistics, false, None),
    scene("evacuation-social", Kind::Statistics, true, None),
    scene("evacuation-rvo", Kind::Statistics, true, None),
    scene("wave", Kind::Statistics, false, None),
];

const fn scene(name: &'static str, kind: Kind, is_long: bool, push: Option<Push>) -> Scene {
    Scene {
        name,
        kind,
        is_long,
        push,
    }
}

/// The content of a study's file, without its cells.
#[derive(Default, Deserialize)]
struct Text {
    #[serde(borrow)]
    description: &'static str,
    list: Vec<Entry>,
}

#[derive(Deserialize)]
struct Entry {
    label: &'static str,
}

impl Scene {
    /// The name of its study.
    fn study_name(&self) -> String {
        format!("accuracy_{}", self.name)
    }

    /// Its study; `seeds` replaces the number of seeds.
    ///
    /// # Errors
    /// The study is invalid.
    pub fn study(&self, seeds: Option<u64>) -> Result<Study, LabError> {
        Ok(Study::built_in(&self.study_name(), seeds, None)?)
    }

    fn text(&self) -> Text {
        let path = Path::new("studies").join(self.study_name() + ".json");
        built_in(&path).map_or_else(Text::default, |text| embedded(&self.study_name(), text))
    }

    /// A description, in one line.
    pub fn about(&self) -> &'static str {
        self.text().description
    }

    /// The labels of its points.
    pub fn labels(&self) -> impl Iterator<Item = &'static str> {
        self.text().list.into_iter().map(|entry| entry.label)
    }

    /// The document that the settings of all points change: that of the study's first cell, which has default settings.
    /// In scenes with a push, the crowd first comes to rest, and the document begins with the push.
    ///
    /// # Errors
    /// The scenario is invalid, or the crowd does not come to rest.
    pub fn document(&self, study: &Study) -> Result<Value, LabError> {
        let scenario = study.cells[0].case.scenario();
        let scenario = scenario.map_err(|error| LabError::of(self.name, error))?;
        let document = scenario.document;
        let Some(push) = self.push else {
            return Ok(document);
        };
        let mut crowd = simulation(&document, &[setting("precision", &json!("double"))?])?;
        run_until(&mut crowd, scenario.duration_secs)?;
        let size: [f64; 2] = read(&document["grids"][0]["max"])?;
        Ok(continued(&document, &crowd, |_, position, velocity| {
            *velocity += push(*position, size.into());
        }))
    }
}

/// Sines of both coordinates, up to 0.3 m/s: a whirl that is nearly at rest at the walls.
fn whirl(r: Vector, size: Vector) -> Vector {
    let wave = |x: f64, length: f64| (TAU * x / length).sin();
    Vector::new(wave(r.y, size.y), -wave(r.x, size.x)) * 0.3
}

/// A pulse of up to 0.8 m/s along the corridor.
fn compression(r: Vector, size: Vector) -> Vector {
    let along = (r.x - 0.3 * size.x) / 1.5;
    Vector::new(0.8 * (-0.5 * along * along).exp(), 0.0)
}

/// The setting `key=value`; an error if the key is unknown.
pub fn setting(key: &str, value: &Value) -> Result<Setting, LabError> {
    let text = value.as_str().map_or(value.to_string(), str::to_owned);
    Setting::new(key, value.clone(), format!("{key}={text}"))
        .map_err(|error| LabError::Data(error.to_string()))
}

/// The names of some settings: `time_step_secs=0.04 integrator=midpoint`.
pub fn names(settings: &[Setting]) -> String {
    let names = settings.iter().map(Setting::to_string);
    names.collect::<Vec<_>>().join(" ")
}

/// The scenario of a document under some settings; an error if a setting is invalid.
pub fn scenario(document: &Value, settings: &[Setting]) -> Result<Scenario, LabError> {
    Scenario::parse(&document.to_string(), "scene.json", settings)
        .map_err(|error| LabError::of(names(settings), error))
}

/// The first frame of a document under some settings; an error if a setting is invalid or an agent cannot be placed.
pub fn simulation(document: &Value, settings: &[Setting]) -> Result<Simulation, LabError> {
    let scene = scenario(document, settings)?.scene;
    Simulation::new(scene).map_err(|fault| LabError::of(names(settings), fault))
}

/// Computes frames until this time, seconds, or until a frame fails.
pub fn run_until(crowd: &mut Simulation, seconds: f64) -> Result<(), LabError> {
    while crowd.frame().clock.time() < seconds {
        let time = crowd.frame().clock.time();
        let stepped = crowd.step();
        stepped.map_err(|fault| LabError::of(format!("at {time} s"), fault))?;
    }
    Ok(())
}

/// The indices of all agents, sorted by id.
pub fn by_id(crowd: &Simulation) -> Vec<usize> {
    let agents = crowd.frame().agents;
    let mut order: Vec<usize> = (0..agents.len()).collect();
    order.sort_by_key(|&i| agents.id[i]);
    order
}

/// The document with the crowd's current agents in place of its own agents, grids and events. `change` gets the id,
/// the position and the velocity of each agent.
pub fn continued(
    document: &Value,
    crowd: &Simulation,
    change: impl Fn(u32, &mut Vector, &mut Vector),
) -> Value {
    let agents = crowd.frame().agents;
    let people = by_id(crowd).into_iter().map(|i| {
        let (mut position, mut velocity) = (agents.position[i], agents.velocity[i]);
        change(agents.id[i], &mut position, &mut velocity);
        let mut person = json!({
            "position": <[f64; 2]>::from(position),
            "velocity": <[f64; 2]>::from(velocity),
            "radius": agents.radius[i],
            "mass": agents.mass[i],
        });
        // In periodic scenes agents walk along the axis.
        if crowd.scene().period.is_none() {
            person["goal"] = json!(<[f64; 2]>::from(agents.goal[i]));
        }
        if !agents.newcomer[i] {
            person["mean_density"] = json!(agents.mean_density[i]);
        }
        person
    });
    let mut document = document.clone();
    document["agents"] = people.collect();
    document["grids"] = json!([]);
    document["events"] = json!([]);
    document
}
