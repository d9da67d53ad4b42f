//! The scenes: crowds that begin to move smoothly, and Table 1's evacuation.

use serde_json::{Value, json};

use super::lyapunov::golden;
use crate::engine::math::Vector;
use crate::engine::simulation::Simulation;
use crate::lab::error::LabError;
use crate::scenario::{Scenario, Setting};

/// How a scene is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// By the positions of agents in the first two seconds.
    Motion,
    /// By numbers of Table 1, over seeds.
    Evacuation,
    /// By the speed of a wave, over seeds.
    Wave,
}

/// A scene that is computed under many settings.
#[derive(Clone, Copy)]
pub struct Scene {
    /// Its name on the command line.
    pub name: &'static str,
    /// A description, in one line.
    pub about: &'static str,
    /// How its errors are measured.
    pub kind: Kind,
    /// The number of seeds, if it is judged over seeds.
    pub seeds: u64,
    /// Do quick plans skip it unless it is named?
    pub is_long: bool,
    document: fn() -> Result<Value, LabError>,
}

/// All scenes.
pub const SCENES: [Scene; 9] = [
    Scene {
        name: "relaxed",
        about: "900 people at rest in a closed room at 5 P/m², set into a smooth whirl",
        kind: Kind::Motion,
        seeds: 1,
        is_long: false,
        document: relaxed,
    },
    Scene {
        name: "pulse",
        about: "900 people at rest in a corridor at 5 P/m², and a pulse of compression",
        kind: Kind::Motion,
        seeds: 1,
        is_long: false,
        document: pulse,
    },
    Scene {
        name: "wall",
        about: "400 people, each alone, walking against a wall at all angles",
        kind: Kind::Motion,
        seeds: 1,
        is_long: false,
        document: wall,
    },
    Scene {
        name: "social",
        about: "two streams of 300 people through each other, sf+sph",
        kind: Kind::Motion,
        seeds: 1,
        is_long: false,
        document: || Ok(streams("sf+sph")),
    },
    Scene {
        name: "rvo",
        about: "two streams of 300 people through each other, rvo+sph",
        kind: Kind::Motion,
        seeds: 1,
        is_long: false,
        document: || Ok(streams("rvo+sph")),
    },
    Scene {
        name: "evacuation",
        about: "Table 1's evacuation, sph",
        kind: Kind::Evacuation,
        seeds: 5,
        is_long: false,
        document: || evacuation("sph"),
    },
    Scene {
        name: "evacuation-social",
        about: "Table 1's evacuation, sf->sph",
        kind: Kind::Evacuation,
        seeds: 5,
        is_long: true,
        document: || evacuation("sf->sph"),
    },
    Scene {
        name: "evacuation-rvo",
        about: "Table 1's evacuation, rvo->sph",
        kind: Kind::Evacuation,
        seeds: 5,
        is_long: true,
        document: || evacuation("rvo->sph"),
    },
    Scene {
        name: "wave",
        about: "a push in a corridor of 1,200 people at 5 P/m², sph with μ = 5",
        kind: Kind::Wave,
        seeds: 5,
        is_long: false,
        document: || Ok(corridor()),
    },
];

impl Scene {
    /// The scenario document.
    ///
    /// # Errors
    /// The scene cannot be prepared.
    pub fn document(&self) -> Result<Value, LabError> {
        (self.document)()
    }
}

/// The scenario of a document under some settings.
///
/// # Errors
/// A setting is invalid.
pub fn scenario(document: &Value, settings: &[String]) -> Result<Scenario, LabError> {
    let set: Result<Vec<Setting>, _> = settings.iter().map(|text| text.parse()).collect();
    let set = set.map_err(|error| LabError::Data(error.to_string()))?;
    let name = document["name"].as_str().unwrap_or("scene").to_owned();
    Scenario::parse(&document.to_string(), &format!("{name}.json"), &set)
        .map_err(|error| LabError::of(settings.join(" "), error))
}

/// The first frame of a document under some settings.
///
/// # Errors
/// A setting is invalid, or an agent cannot be placed.
pub fn simulation(document: &Value, settings: &[String]) -> Result<Simulation, LabError> {
    let scene = scenario(document, settings)?.scene;
    Simulation::new(scene).map_err(|fault| LabError::of(settings.join(" "), fault))
}

/// The document with the simulation's current agents in place of its own agents, grids and events.
pub fn continued(document: &Value, simulation: &Simulation) -> Value {
    let agents = simulation.frame().agents;
    let mut order: Vec<usize> = (0..agents.len()).collect();
    order.sort_by_key(|&i| agents.id[i]);
    let people = order.into_iter().map(|i| {
        let mut person = json!({
            "position": <[f64; 2]>::from(agents.position[i]),
            "velocity": <[f64; 2]>::from(agents.velocity[i]),
            "goal": <[f64; 2]>::from(agents.goal[i]),
            "radius": agents.radius[i],
            "mass": agents.mass[i],
        });
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

/// The document after `seconds`. `push` gives each agent an additional velocity by its position.
fn relaxed_for(
    document: &Value,
    seconds: f64,
    push: impl Fn(Vector) -> Vector,
) -> Result<Value, LabError> {
    let mut simulation = simulation(document, &["precision=double".to_owned()])?;
    while simulation.frame().clock.time() < seconds {
        simulation
            .step()
            .map_err(|fault| LabError::of(document["name"].to_string(), fault))?;
    }
    let mut after = continued(document, &simulation);
    for agent in after["agents"].as_array_mut().into_iter().flatten() {
        let pair = |value: &Value| {
            value
                .as_array()
                .map(|list| [0, 1].map(|k| list[k].as_f64()))
        };
        let [Some([Some(x), Some(y)]), Some([Some(u), Some(v)])] =
            [&agent["position"], &agent["velocity"]].map(pair)
        else {
            continue;
        };
        let velocity = Vector::new(u, v) + push(Vector::new(x, y));
        agent["velocity"] = json!(<[f64; 2]>::from(velocity));
    }
    Ok(after)
}

/// A closed room of `width` × `height` meters: two L-shaped walls, 1 m thick.
fn room(width: f64, height: f64) -> Value {
    let (right, top) = (width + 1.0, height + 1.0);
    json!([
        [
            [-1, -1],
            [right, -1],
            [right, 0],
            [0, 0],
            [0, top],
            [-1, top]
        ],
        [
            [right, 0],
            [right, top],
            [0, top],
            [0, height],
            [width, height],
            [width, 0]
        ]
    ])
}

/// Agents at 5 P/m² with a preferred speed of 0.
fn at_rest(name: &str, columns: u32, rows: u32) -> (Value, [f64; 2]) {
    let spacing = 0.2_f64.sqrt();
    let [width, height] = [columns, rows].map(|count| f64::from(count) * spacing);
    let document = json!({
        "name": name,
        "preferred_speed": 0,
        "obstacles": room(width, height),
        "grids": [{
            "min": [0, 0], "max": [width, height], "columns": columns, "rows": rows,
            "jitter": 0.1, "goal_offset": [0, 0]
        }],
    });
    (document, [width, height])
}

/// Time in which the crowds come to rest, seconds.
const REST: f64 = 10.0;

fn relaxed() -> Result<Value, LabError> {
    let (document, [width, height]) = at_rest("relaxed", 30, 30);
    let wave = |x: f64, length: f64| (std::f64::consts::TAU * x / length).sin();
    relaxed_for(&document, REST, |r| {
        Vector::new(wave(r.y, height), -wave(r.x, width)) * 0.3
    })
}

fn pulse() -> Result<Value, LabError> {
    let (document, [width, _]) = at_rest("pulse", 75, 12);
    relaxed_for(&document, REST, |r| {
        let along = (r.x - 0.3 * width) / 1.5;
        Vector::new(0.8 * (-0.5 * along * along).exp(), 0.0)
    })
}

/// Agents 5 m apart, each walking to a goal behind a wall along the x axis.
fn wall() -> Result<Value, LabError> {
    let people = (0..400).map(|k| {
        let (column, row) = (f64::from(k % 100), f64::from(k / 100));
        let (x, y) = (5.0 * column, 100.0 * row + 0.6 + 0.8 * golden(k));
        let slant = 3.0 * (column / 50.0 - 1.0);
        json!({ "position": [x, y], "goal": [x + slant, 100.0 * row - 1.5] })
    });
    let walls = (0..4).map(|row| {
        let y = 100.0 * f64::from(row);
        json!([[-10, y - 3.0], [510, y - 3.0], [510, y], [-10, y]])
    });
    Ok(json!({
        "name": "wall",
        "obstacles": walls.collect::<Vec<_>>(),
        "agents": people.collect::<Vec<_>>(),
    }))
}

/// Two blocks of agents that walk through each other, at 1 P/m² each.
fn streams(profile: &str) -> Value {
    let block = |x: f64, way: f64| {
        json!({
            "min": [x, 0], "max": [x + 15.0, 20], "columns": 15, "rows": 20, "jitter": 0.3,
            "goal_offset": [way, 0]
        })
    };
    json!({
        "name": "streams",
        "profile": profile,
        "grids": [block(0.0, 60.0), block(13.0, -60.0)],
    })
}

fn evacuation(profile: &str) -> Result<Value, LabError> {
    let profile = format!("profile={profile}").parse();
    let profile = profile
        .map_err(|error: crate::scenario::SettingError| LabError::Data(error.to_string()))?;
    let scenario = Scenario::shipped("evacuation", &[profile]);
    let scenario = scenario.map_err(|error| LabError::of("evacuation".to_owned(), error))?;
    Ok(scenario.document)
}

/// Begin and end of the push, seconds, and the far end of the agents that take part, meters.
pub const PUSH: ([f64; 2], f64) = ([15.0, 15.5], 5.0);
/// The corridor's length and half its width, meters.
pub const CORRIDOR: [f64; 2] = [40.2, 3.0];

/// A corridor from y = −3 to 3. The agents at its near end push as in the paper's concert crowd (§6.3), but once and
/// over the whole width.
fn corridor() -> Value {
    let [length, half] = CORRIDOR;
    let ([begins, ends], source) = PUSH;
    let (right, top) = (length + 1.0, half + 1.0);
    json!({
        "name": "wave",
        "parameters": { "viscosity": 5, "goal_scale": 0.1 },
        "obstacles": [
            [[-1, -top], [right, -top], [right, -half], [0, -half], [0, top], [-1, top]],
            [[right, -half], [right, top], [0, top], [0, half], [length, half], [length, -half]]
        ],
        "grids": [{
            "min": [0, -half], "max": [length, half], "columns": 90, "rows": 13, "jitter": 0.1,
            "goal_offset": [100, 0]
        }],
        "events": [{
            "at_secs": begins, "for_secs": ends - begins,
            "region": [[source - 1.0, -half], [source, half]],
            "goal_scale": 1, "ignore_contact": true, "ignore_sph": true
        }],
    })
}
