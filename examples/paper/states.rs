//! States of crowds in JSON: read, and written with every term of every agent.

use std::error::Error;
use std::fs;

use serde_json::{Value, from_value, json};

use super::{
    Agent, Crowd, Wall, acceleration, acting, behavior, evacuation, evaluate, hidden_regions, terms,
};

/// What the program answers to its arguments.
pub fn answer(arguments: impl Iterator<Item = String>) -> Result<Value, Box<dyn Error>> {
    let arguments: Vec<String> = arguments.collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["evacuation"] => evacuation::results("sph", None),
        ["evacuation", profile] => evacuation::results(profile, None),
        ["evacuation", profile, setting] => evacuation::results(profile, Some(setting.parse()?)),
        [file] => evaluated(serde_json::from_str(&fs::read_to_string(file)?)?),
        _ => Err("usage: paper STATE.json | paper evacuation [PROFILE [K^ag or ρ⁰max]]".into()),
    }
}

/// A state, or a document with a list of `states`, with the results that are `expected` for each agent.
pub fn evaluated(mut document: Value) -> Result<Value, Box<dyn Error>> {
    if let Some(states) = document.get_mut("states").and_then(Value::as_array_mut) {
        states.iter_mut().try_for_each(evaluate_state)?;
    } else {
        evaluate_state(&mut document)?;
    }
    Ok(document)
}

fn evaluate_state(state: &mut Value) -> Result<(), Box<dyn Error>> {
    let mut crowd = crowd(state)?;
    evaluate(&mut crowd);
    let agents = crowd.agents.iter().map(|i| described(&crowd, i));
    state["expected"] = agents.collect();
    Ok(())
}

/// The crowd of a state: its `profile`, `viscosity` (μ), `obstacles` as lists of corners, and `agents`. The keys of an
/// agent are in `agent`; without `mean_density` it is in its first frame.
fn crowd(state: &Value) -> Result<Crowd, Box<dyn Error>> {
    let profile: String = from_value(state["profile"].clone())?;
    let obstacles: Vec<Vec<[f64; 2]>> = from_value(state["obstacles"].clone())?;
    let agents = state["agents"].as_array().into_iter().flatten();
    let agents = (0..).zip(agents).map(|(id, keys)| agent(id, keys));
    let mut behavior = behavior(&profile)?;
    behavior.viscosity = from_value(state["viscosity"].clone())?;
    Ok(Crowd {
        agents: agents.collect::<Result<_, _>>()?,
        walls: obstacles
            .iter()
            .flat_map(|corners| Wall::around(corners))
            .collect(),
        behavior,
        seed: 1,
        frame: 0,
    })
}

fn agent(id: u32, keys: &Value) -> Result<Agent, serde_json::Error> {
    let vector = |key: &str| from_value::<[f64; 2]>(keys[key].clone());
    let number = |key: &str| from_value::<f64>(keys[key].clone());
    Ok(Agent {
        id,
        position: vector("position")?.into(),
        velocity: vector("velocity")?.into(),
        goal: vector("goal")?.into(),
        radius: number("radius")?,
        mass: number("mass")?,
        mean_density: from_value(keys["mean_density"].clone())?,
        ..Agent::default()
    })
}

/// Everything that acts on agent i of an evaluated crowd.
fn described(crowd: &Crowd, i: &Agent) -> Value {
    let pair = |v| json!(<[f64; 2]>::from(v));
    let profiles = acting(&crowd.behavior, i.density).into_iter();
    let profiles = profiles.map(|(profile, weight)| {
        let terms = terms(crowd, i, profile).into_iter();
        let terms = terms.map(|(name, term)| (name.to_owned(), pair(term)));
        let accelerations = Value::Object(terms.collect());
        json!({ "name": profile.name, "weight": weight, "accelerations": accelerations })
    });
    let walls = hidden_regions(crowd, i).map(|p_k| {
        json!({
            "nearest_point": pair(p_k.nearest_point),
            "representative_point": pair(p_k.representative_point),
            "hidden_area": p_k.area,
        })
    });
    json!({
        "density": i.density,
        "density_from_agents": i.density - i.density_by_walls,
        "density_from_walls": i.density_by_walls,
        "mean_density": i.mean_density,
        "rest_density": i.rest_density,
        "pressure": i.pressure,
        "profiles": profiles.collect::<Value>(),
        "acceleration": pair(acceleration(crowd, i)),
        "walls": walls.collect::<Value>(),
    })
}
