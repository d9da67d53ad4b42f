//! Scenarios of JuPedSim's web app: `config.json` with `geometry.wkt` beside it, in a zip archive, or in one JSON file.
//!
//! Such a document becomes one of a [`File`](crate::file::File). JuPedSim's exits are areas: people leave when they
//! come into them. Here every side of such an area that borders on floor is the line of an exit. What has no
//! counterpart is named once in a note.

mod bundle;
mod fields;
mod floor;
mod people;
mod places;
mod routes;
mod sides;

pub use bundle::{config_in, text};

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::error::quote::shown;
use crate::error::{Problem, Under};
use bundle::{FILES, GEOMETRY};
use fields::{Notes, Object};
use floor::Floor;
use people::People;
use places::{Places, SIDE};
use routes::Routes;

/// The profile of people, unless the command line gives another.
const PROFILE: &str = "steer+sph";
/// What JuPedSim's runner takes where a file says nothing: the simulated time (s), the seed and the model.
const DURATION: f64 = 300.0;
const SEED: u64 = 42;
const MODEL: &str = "CollisionFreeSpeedModel";
/// The version of documents that is known.
const VERSION: &str = "2.0";
/// The keys of documents.
const ROOT: [&str; 18] = [
    "project_version",
    "config",
    "exits",
    "distributions",
    "checkpoints",
    "waiting_polygons",
    "zones",
    "obstacles",
    "journeys",
    "journeys_v2",
    "transitions",
    "waypoint_routing",
    GEOMETRY,
    "model_type",
    "seed",
    "name",
    "description",
    "sim_params",
];
const SETTINGS: [&str; 3] = ["simulationParams", "numberOfSimulations", "baseSeed"];
/// The parameters of JuPedSim's models with the web app's defaults.
const MODEL_PARAMETERS: [(&str, f64); 21] = [
    ("strength_neighbor_repulsion", 2.6),
    ("range_neighbor_repulsion", 0.1),
    ("gcfm_strength_neighbor_repulsion", 0.3),
    ("gcfm_strength_geometry_repulsion", 0.2),
    ("gcfm_max_neighbor_interaction_distance", 2.0),
    ("gcfm_max_geometry_interaction_distance", 2.0),
    ("gcfm_max_neighbor_repulsion_force", 9.0),
    ("gcfm_max_geometry_repulsion_force", 3.0),
    ("mass", 80.0),
    ("tau", 0.5),
    ("a_v", 1.0),
    ("a_min", 0.2),
    ("b_min", 0.2),
    ("b_max", 0.4),
    ("relaxation_time", 0.5),
    ("agent_strength", 2000.0),
    ("agent_range", 0.08),
    ("sfm_obstacle_scale", 2000.0),
    ("sfm_body_force", 120_000.0),
    ("sfm_friction", 240_000.0),
    ("T", 1.0),
];
/// Parameters of models without a default of their own.
const OTHER_PARAMETERS: [&str; 5] = [
    "s0",
    "anticipation_time",
    "model_type",
    "max_simulation_time",
    "dt",
];

/// Whether a document is a scenario of the web app, by its keys.
pub fn is_web_app(document: &Value) -> bool {
    let exits = document["exits"].as_object();
    let is_outlined = |exit: &Value| exit["coordinates"].is_array();
    exits.is_some_and(|exits| exits.values().any(is_outlined))
        || document["distributions"].is_object()
        || document["config"]["simulation_settings"].is_object()
}

/// What a translation leaves beside the document.
#[derive(Debug, Default)]
pub struct Translated {
    /// Notes on what has no counterpart.
    pub notes: Vec<String>,
    /// The file with the geometry, if it is not in the document.
    pub geometry: Option<PathBuf>,
    /// Whether the document was one of the web app.
    pub is_web_app: bool,
}

/// Whether a note is about the places of the lines of exits, which the user has not drawn: the sides of an exit can lie
/// behind each other and away from walls.
pub fn is_about_sides(note: &str) -> bool {
    let is_behind = note.contains(SIDE) && note.contains("is behind the exit");
    is_behind || note.contains("is at no wall, so people leave in the middle of the floor")
}

/// A problem with people or places, with the name of what they are in the web app.
pub fn named(problem: Problem, document: &Value) -> Problem {
    let element = problem.path.split_once('[').and_then(|(list, rest)| {
        let number: usize = rest.split_once(']')?.0.parse().ok()?;
        document[list][number]["name"].as_str()
    });
    match element {
        Some(name) => Problem::new(problem.path, format!("{}: {}", shown(name), problem.reason)),
        None => problem,
    }
}

/// Turns a scenario of the web app into one of this program. Leaves other documents as they are.
///
/// # Errors
/// The first problem, with its place in the document.
pub fn translate(document: &mut Value, file: &Path) -> Result<Translated, Problem> {
    if !is_web_app(document) {
        return Ok(Translated::default());
    }
    let names = document[FILES].clone();
    let mut notes = Notes::default();
    // In an archive the file that has the problem is named, too.
    let geometry = names[1].as_str();
    let inner = |problem: Problem| match names[0].as_str() {
        Some(name) if Some(&*problem.path) != geometry => {
            Problem::new(format!("{name}: {}", problem.path), problem.reason)
        }
        _ => problem,
    };
    let unpacked = unpack_parameters(document);
    let found = unpacked.and_then(|()| translated(document, file, &mut notes));
    let (found, geometry) = found.map_err(inner)?;
    *document = found;
    Ok(Translated {
        notes: notes.into_list(),
        geometry,
        is_web_app: true,
    })
}

/// Parses the parameters of distributions that are JSON in a text.
fn unpack_parameters(document: &mut Value) -> Result<(), Problem> {
    let distributions = document.get_mut("distributions");
    let elements = distributions.and_then(Value::as_object_mut);
    for (id, element) in elements.into_iter().flatten() {
        if let Some(Value::String(text)) = element.get("parameters") {
            let parsed = serde_json::from_str(text).map_err(|error| {
                let path = format!("distributions.{id}.parameters");
                Problem::new(path, format!("must be JSON: {error}"))
            });
            element["parameters"] = parsed?;
        }
    }
    Ok(())
}

/// The scenario, and the file with the geometry if it is not in the document.
fn translated(
    document: &Value,
    file: &Path,
    notes: &mut Notes,
) -> Result<(Value, Option<PathBuf>), Problem> {
    let root = Object::root(document)?;
    root.note_unknown(&ROOT, notes);
    let mut scenario = settings(&root, notes)?;
    let obstacles = root.elements("obstacles")?;
    let outlined = obstacles
        .iter()
        .filter(|(_, obstacle)| obstacle.says("coordinates"));
    let rings: Vec<_> = outlined
        .map(|(_, obstacle)| obstacle.polygon())
        .collect::<Result<_, _>>()?;
    let (path, text) = match root.word(GEOMETRY)? {
        Some(text) => (None, text.to_owned()),
        None => {
            let beside =
                bundle::geometry_beside(file).map_err(|reason| Problem::new("", reason))?;
            (Some(beside.0), beside.1)
        }
    };
    let of_file = path
        .as_deref()
        .and_then(Path::file_name)
        .and_then(OsStr::to_str);
    let geometry = of_file.or(document[FILES][1].as_str()).unwrap_or(GEOMETRY);
    let floor = Floor::new(&text, &rings).under(geometry)?;
    let places = Places::read(&root, &floor, notes)?;
    let routes = Routes::read(&root, &places, notes)?;
    let people = People::read(&root, &floor, &routes, notes)?;
    scenario["walkable_area"] = floor.to_value();
    scenario["journeys"] = routes.journeys.into();
    scenario["crowds"] = people.crowds.into();
    scenario["entrances"] = people.entrances.into();
    for (key, list) in places.lists {
        scenario[key] = list.into();
    }
    scenario["stop"] = json!({"when_empty": true});
    let name = root.word("name")?.map(str::to_owned);
    if let Some(name) = name.or_else(|| folder_name(file)) {
        scenario["name"] = name.into();
    }
    if let Some(description) = root.word("description")? {
        scenario["description"] = description.into();
    }
    Ok((scenario, path))
}

/// The name of a scenario whose file is only named `config.json`: that of its folder.
fn folder_name(file: &Path) -> Option<String> {
    let is_plain = file.file_name().is_some_and(|name| name == "config.json");
    let folder = file.parent().filter(|_| is_plain)?.file_name()?;
    Some(folder.to_string_lossy().into_owned())
}

/// The keys of the whole scenario.
fn settings(root: &Object, notes: &mut Notes) -> Result<Value, Problem> {
    let config = root.object_or_empty("config")?;
    let settings = config.object_or_empty("simulation_settings")?;
    settings.note_unknown(&SETTINGS, notes);
    let parameters = settings.object_or_empty("simulationParams")?;
    if let Some(version) = root
        .word("project_version")?
        .filter(|&version| version != VERSION)
    {
        notes.add(format!(
            "project_version {}: read as {VERSION}",
            shown(version)
        ));
    }
    let seed = root.whole("seed")?.or(settings.whole("baseSeed")?);
    let model = parameters.word("model_type")?.or(root.word("model_type")?);
    notes.add(format!(
        "model_type {}: people walk by the profile `{PROFILE}` unless another one is given",
        shown(model.unwrap_or(MODEL))
    ));
    note_parameters(&parameters, notes);
    if let Some(runs) = settings
        .whole("numberOfSimulations")?
        .filter(|&runs| runs > 1)
    {
        notes.add(format!(
            "numberOfSimulations {runs}: this is one run; `sandbox estimate` makes several"
        ));
    }
    let duration = parameters
        .number("max_simulation_time", 0.0)?
        .unwrap_or(DURATION);
    Ok(json!({"profile": PROFILE, "seed": seed.unwrap_or(SEED), "duration_secs": duration}))
}

/// Notes the parameters of JuPedSim's models that have been changed.
fn note_parameters(parameters: &Object, notes: &mut Notes) {
    let of_models: Vec<&str> = MODEL_PARAMETERS.iter().map(|(name, _)| *name).collect();
    let known = [of_models, OTHER_PARAMETERS.to_vec()].concat();
    parameters.note_unknown(&known, notes);
    let number = |name: &str| parameters.get(name).and_then(Value::as_f64);
    let models = MODEL_PARAMETERS.iter();
    let other =
        models.filter_map(|(name, default)| Some((name, number(name).filter(|x| x != default)?)));
    let changed: Vec<String> = other
        .map(|(name, value)| format!("{name} {value}"))
        .collect();
    if !changed.is_empty() {
        notes.add(format!(
            "parameters of JuPedSim's models have no effect: {}",
            changed.join(", ")
        ));
    }
    if let Some(step) = number("dt") {
        notes.add(format!("dt {step}: `time_step_secs` sets the time step"));
    }
}
