//! The contents of a file → a scenario that can run, or the first problem.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;

use super::crowd::{Crowd, MOST_NUMBERED};
use super::crowding;
use super::error::{Problem, Under, in_plain_words};
use super::file::{self, File, Object, ProfileChoice, TimeStep};
use super::need::Need;
use super::range::{COARSE_EVERY, MAX_SPEED, PREFERRED_SPEED, Range, TIME, TIME_STEP};
use super::range::{point, region};
use super::{PlanFile, Scenario, Stop, View, parameters, plan, preset, profiles};
use crate::analysis::stability;
use crate::engine::clock::{Clock, PAPER_COARSE_STEP, PAPER_TIME_STEP, SHORTEST_TIME_STEP};
use crate::engine::math::Vector;
use crate::engine::profile::Override;
use crate::engine::scene::{Push, Region, Scene};
use crate::scenario::measurements;

/// Default duration, seconds.
const DEFAULT_DURATION: f64 = 60.0;
/// Default profile.
const DEFAULT_PROFILE: &str = "sph";
/// Margin of the default view around walls, agents, goals and sources, meters.
const DEFAULT_MARGIN: f64 = 1.0;
/// K^goal of a push.
pub(super) const GOAL_SCALE: Range = Range::at_least(0.0, 1e9);
/// Times that must not be zero, seconds.
pub(super) const UNTIL: Range = Range::above(0.0, 1e7);

/// Estimates the size of a run of `document`. Apart from that only names and types are checked.
pub(super) fn need(document: &Value, path: &Path) -> Result<Need, Problem> {
    let file = read(&complete(document, path)?.0)?;
    let duration_secs = duration(&file)?;
    Need::of(&file, &first_clock(&file)?, duration_secs)
}

/// The document with its preset expanded and the files that it names inlined. File names are relative to the folder
/// of `path`. Returns the files with their keys.
fn complete(document: &Value, path: &Path) -> Result<(Value, Vec<PlanFile>), Problem> {
    let mut document = preset::fill(document);
    without_schema(&mut document)?;
    let files = plan::fill(&mut document, path.parent().unwrap_or(Path::new("")))?;
    Ok((document, files))
}

/// Checks `document`, which was read from `path`. The file's name is the default name of the scenario, and its folder
/// holds the files that the scenario names.
pub(super) fn scenario(document: &Value, path: &Path) -> Result<Scenario, Problem> {
    let (document, files) = complete(document, path)?;
    let file = read(&document)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = file.name.clone().unwrap_or_else(|| stem.into_owned());
    if name.is_empty() {
        return Err(Problem::new("name", "must not be empty"));
    }
    let duration_secs = duration(&file)?;
    let mut scene = empty_scene(&file)?;
    parameters::check(&file.parameters.0).under("parameters")?;
    let choice = file.profile.clone();
    let choice = choice.unwrap_or_else(|| ProfileChoice::Named(DEFAULT_PROFILE.to_owned()));
    let blend = profiles::blend(&choice, &file.parameters.0).under("profile")?;
    file.goal.map(|goal| point("goal", goal)).transpose()?;
    let need = Need::of(&file, &scene.clock, duration_secs)?;
    Crowd::new(&file, &blend, &mut scene).enter()?;
    crowding::check(&file, &scene, duration_secs)?;
    measurements::check(&file.measurements)?;
    scene.pushes = pushes(&file.events)?;
    if file.time_step_secs == Some(TimeStep::Auto) {
        scene.clock = automatic_clock(&file, &scene)?;
    }
    Ok(Scenario {
        name,
        description: file.description.clone().unwrap_or_default(),
        duration_secs,
        stop: stop(&file.stop.0).under("stop")?,
        measurements: file.measurements,
        view: view(file.view.as_ref(), &scene).under("view")?,
        debug_agents: match &file.debug_agents {
            Some(ids) => without_repetition(ids)?,
            None => spread(need.entering),
        },
        entering: need.entering,
        profile_name: blend.name,
        document,
        files,
        scene,
    })
}

/// Removes `$schema`, by which editors find the schema.
fn without_schema(document: &mut Value) -> Result<(), Problem> {
    let given = document
        .as_object_mut()
        .and_then(|document| document.remove("$schema"));
    match given {
        None | Some(Value::String(_)) => Ok(()),
        Some(_) => Err(Problem::new(
            "$schema",
            "must be text, the location of the schema",
        )),
    }
}

/// Deserializes the document, which checks names and types.
fn read(document: &Value) -> Result<File, Problem> {
    let file: Result<Object<File>, _> = serde_path_to_error::deserialize(document);
    file.map(|Object(file)| file).map_err(|error| {
        let path = error.path().to_string();
        let path = if path == "." { String::new() } else { path };
        Problem::new(path, in_plain_words(&error.into_inner().to_string()))
    })
}

fn duration(file: &File) -> Result<f64, Problem> {
    let duration_secs = file.duration_secs.unwrap_or(DEFAULT_DURATION);
    TIME.check("duration_secs", duration_secs)
}

/// The clock; with the paper's step if the step is missing or `auto`.
fn first_clock(file: &File) -> Result<Clock, Problem> {
    TIME_STEP.check_given("longest_step_secs", file.longest_step_secs)?;
    match file.time_step_secs {
        Some(TimeStep::Given(step)) => clock(file, step),
        Some(TimeStep::Auto) | None => clock(file, PAPER_TIME_STEP),
    }
}

/// The scene without agents, sources and pushes.
fn empty_scene(file: &File) -> Result<Scene, Problem> {
    let paper = Scene::default();
    let clock = first_clock(file)?;
    let preferred_speed = file.preferred_speed.unwrap_or(paper.preferred_speed);
    let max_speed = file.max_speed.unwrap_or(paper.max_speed);
    let seed = file.seed.unwrap_or(paper.seed);
    let obstacles = plan::solids(file)?;
    Ok(Scene {
        seed: file.population_seed.unwrap_or(seed),
        behaviour_seed: Some(file.behaviour_seed.unwrap_or(seed)),
        clock,
        integrator: file.integrator,
        wall_method: file.wall_method,
        precision: file.precision,
        neighbor_lists: file.neighbor_lists,
        preferred_speed: PREFERRED_SPEED.check("preferred_speed", preferred_speed)?,
        max_speed: MAX_SPEED.check("max_speed", max_speed)?,
        ..Scene::with_obstacles(obstacles)
    })
}

fn clock(file: &File, time_step: f64) -> Result<Clock, Problem> {
    let time_step = TIME_STEP.check("time_step_secs", time_step)?;
    let coarse_every = file
        .coarse_every
        .unwrap_or_else(|| Clock::nearest_coarse_every(time_step));
    COARSE_EVERY.check("coarse_every", f64::from(coarse_every))?;
    Ok(Clock::new(time_step, coarse_every))
}

/// The clock with the step that `auto` finds for `scene`, which is otherwise complete.
fn automatic_clock(file: &File, scene: &Scene) -> Result<Clock, Problem> {
    let step = stability::time_step(scene).ok_or_else(|| {
        let reason = "`auto` works only with the integrators `semi-implicit` and `velocity-verlet`; \
                      give a number";
        Problem::new("time_step_secs", reason)
    })?;
    let longest = file.longest_step_secs.unwrap_or(PAPER_COARSE_STEP);
    let step = step.min(longest);
    if step < SHORTEST_TIME_STEP {
        let reason = format!(
            "`auto` finds no step: this crowd is so stiff that it needs {step:e} s, below the shortest step of \
             {SHORTEST_TIME_STEP:e} s; lower gas_constant, viscosity or the stiffnesses, or raise the masses"
        );
        return Err(Problem::new("time_step_secs", reason));
    }
    clock(file, step)
}

fn pushes(events: &[Object<file::Event>]) -> Result<Vec<Push>, Problem> {
    if events.len() > MOST_NUMBERED {
        let reason = format!(
            "{} events; at most {MOST_NUMBERED} are allowed",
            events.len()
        );
        return Err(Problem::new("events", reason));
    }
    let numbered = events.iter().enumerate();
    numbered
        .map(|(k, Object(event))| {
            let name = format!("events[{k}]");
            push(event, &name).under(&name)
        })
        .collect()
}

fn push(event: &file::Event, place: &str) -> Result<Push, Problem> {
    let name = event.name.as_deref().unwrap_or(place);
    if name.is_empty() {
        return Err(Problem::new("name", "must not be empty"));
    }
    Ok(Push {
        name: name.to_owned(),
        at: TIME.check("at_secs", event.at_secs)?,
        lasting: TIME.check("for_secs", event.for_secs)?,
        region: region("region", event.region)?,
        change: Override {
            goal_scale: GOAL_SCALE.check_given("goal_scale", event.goal_scale)?,
            ignore_contact: event.ignore_contact,
            ignore_sph: event.ignore_sph,
        },
    })
}

fn stop(given: &file::Stop) -> Result<Stop, Problem> {
    Ok(Stop {
        when_empty: given.when_empty,
        idle_secs: UNTIL.check_given("idle_secs", given.idle_secs)?,
    })
}

fn view(given: Option<&Object<file::View>>, scene: &Scene) -> Result<View, Problem> {
    let Some(Object(given)) = given else {
        return Ok(View {
            region: surroundings(scene),
            opens_at_secs: 0.0,
        });
    };
    let region = region("region", given.region)?;
    if region.min.x == region.max.x || region.min.y == region.max.y {
        return Err(Problem::new(
            "region",
            "encloses no area: its corners must differ in x and in y",
        ));
    }
    Ok(View {
        region,
        opens_at_secs: TIME.check("opens_at_secs", given.opens_at_secs)?,
    })
}

/// The bounding box of walls, agents, goals and sources, with a margin.
fn surroundings(scene: &Scene) -> Region {
    let corners = scene.walls.iter().map(|wall| wall.start);
    let agents = scene
        .agents
        .iter()
        .flat_map(|agent| [agent.position, agent.goal]);
    let sources = scene
        .sources
        .iter()
        .flat_map(|source| [source.grid.min, source.grid.max]);
    let margin = Vector::new(DEFAULT_MARGIN, DEFAULT_MARGIN);
    let bounds = corners
        .chain(agents)
        .chain(sources)
        .map(|p| (p, p))
        .reduce(|(low, high), (p, _)| (low.inf(&p), high.sup(&p)));
    let (low, high) = bounds.unwrap_or((Vector::zeros(), Vector::zeros()));
    Region {
        min: low - margin,
        max: high + margin,
    }
}

/// A dozen ids spread evenly over `entering` agents, or all ids if there are fewer.
fn spread(entering: u64) -> Vec<u32> {
    const DOZEN: u64 = 12;
    let count = entering.min(DOZEN);
    let ids = (0..count).map(|k| (2 * k + 1) * entering / (2 * count));
    ids.map(|id| id as u32).collect() // at most MOST_AGENTS
}

fn without_repetition(ids: &[u32]) -> Result<Vec<u32>, Problem> {
    let mut seen = BTreeSet::new();
    for (k, id) in ids.iter().enumerate() {
        if !seen.insert(id) {
            let reason = format!("agent {id} is listed twice; remove one");
            return Err(Problem::new(format!("debug_agents[{k}]"), reason));
        }
    }
    Ok(ids.to_vec())
}
