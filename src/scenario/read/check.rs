//! The contents of a file → a scenario that can run, or the first problem.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use serde_json::Value;

use crate::error::{Problem, Under};
use crate::file::{File, meant, range};
use crate::keys::limits::MOST_NUMBERED;
use crate::keys::limits::{DEFAULT_DURATION, DEFAULT_PROFILE};
use crate::keys::people::{Behavior, People};
use crate::keys::profiles::{ProfileChoice, ProfileName};
use crate::keys::shapes::region;
use crate::read::draft::{Draft, Inputs};
use crate::read::parsed::parsed;
use crate::read::plans::Plans;
use crate::read::scenario::Scenario;
use crate::read::{curves, data, late, levels, plans, preset};
use crate::scene::levels::check_reach;
use crate::scene::need::Need;
use crate::scene::origin::Items;
use crate::scene::people::Population;
use crate::scene::surroundings::Surroundings;
use crate::scene::{
    doubts, interventions, journeys, numerics, off_floor, overcrowded, periodic, profiles, routes,
    slits, surroundings, view, widest,
};
use crate::trajectories::Tracks;
use crate::{file, measurements};
use engine::forces::push::PushForce;
use engine::geometry::Polygon;
use engine::math::{Vector, direction};
use engine::period::Period;
use engine::profile::{Blend, Override};
use engine::scene::{Push, Routing, Scene};

impl Draft {
    /// Reads `document`, and the files that it names from the folder of `path`.
    pub(super) fn of(document: Value, path: &Path) -> Result<Self, Problem> {
        let mut document = preset::completed(document);
        without_schema(&mut document)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut notes = Vec::new();
        let (mut plans, mut files) = Plans::take(&mut document, folder, &mut notes)?;
        files.extend(curves::fill(&mut document, folder)?);
        let laid_out = levels::side_by_side(&document);
        if !matches!(laid_out, Ok(None)) {
            // What is wrong with single keys comes first.
            range::check(&document).map_err(|problem| meant::clearer(problem, &document))?;
        }
        let building = laid_out?;
        let plane = building
            .as_ref()
            .map_or(&document, |building| &building.document);
        let mut keys = Self::check_keys(plane)?;
        let places = std::mem::take(&mut plans.places);
        plans.enter(&mut keys);
        files.extend(data::fill(&mut document, &mut keys, folder, &mut notes)?);
        let need = Need::of(&keys, &numerics::first_clock(&keys), duration(&keys))?;
        Ok(Self {
            document,
            files,
            places,
            keys,
            building,
            notes,
            need,
            inputs: Inputs::default(),
            is_web_app: false,
        })
    }

    /// Checks names, types and ranges.
    pub(super) fn check_keys(document: &Value) -> Result<File, Problem> {
        let keys = Self::checked_keys(document);
        keys.map_err(|problem| meant::clearer(problem, document))
    }

    fn checked_keys(document: &Value) -> Result<File, Problem> {
        range::check(document)?;
        // serde does not say where an error is in keys that several structs share.
        for list in ["agents", "grids", "crowds", "sources", "entrances"] {
            let items = document[list].as_array().into_iter().flatten();
            for (k, item) in items.enumerate() {
                let shared = match list {
                    "agents" => parsed::<Behavior>(item).map(drop),
                    _ => shared(item),
                };
                shared.under(&format!("{list}[{k}]"))?;
            }
        }
        if let Some(from) = document.get("from").filter(|from| from.is_object()) {
            shared(from).under("from")?;
        }
        let keys = parsed(document)?;
        range::check_names(document)?;
        Ok(keys)
    }

    /// The trajectories from which the scenario begins, and the time in them at which it does, seconds; `None` if it
    /// names no file. The file's name is relative to the folder of `path`.
    pub(super) fn tracks(&self, path: &Path) -> Result<Option<(Tracks, f64)>, Problem> {
        let Some(given) = &self.keys.from else {
            return Ok(None);
        };
        let folder = path.parent().unwrap_or(Path::new(""));
        let file = given.trajectory.as_ref().map(|name| folder.join(name));
        let tracks = file.map(|file| data::tracks(&file, given)).transpose();
        tracks.under("from")
    }

    /// The end of the run, and the time up to which what begins is not late, seconds: the later end of the file without
    /// settings, `own`, if they make the run shorter.
    pub(super) fn ends(&self, own: Option<&Value>) -> [f64; 2] {
        let end = duration(&self.keys);
        let own = own.map(|own| own["duration_secs"].as_f64().unwrap_or(DEFAULT_DURATION));
        [end, own.map_or(end, |own| own.max(end))]
    }

    /// A note on what begins after the end of the run.
    pub(super) fn late(&self, [end, last]: [f64; 2]) -> Option<String> {
        late::note(&self.document, end, last)
    }

    /// Checks relations between values and places the agents. The name of the file `path` is the default name of the
    /// scenario; the file without settings has its end at `last`, seconds, or the run if that is later.
    pub(super) fn built(self, path: &Path, last: f64) -> Result<Scenario, Problem> {
        let keys = &self.keys;
        periodic::check_keys(keys)?;
        let Surroundings { solids, mut behind } = Surroundings::of(keys)?;
        let building = self.building.as_ref();
        let seen = building.into_iter().flat_map(|one| one.seen.clone());
        behind.extend(seen);
        let without_effect = surroundings::without_effect(keys);
        let default = ProfileChoice::Named(ProfileName(DEFAULT_PROFILE.to_owned()));
        let choice = keys.profile.as_ref().unwrap_or(&default);
        let blend = profiles::blend(choice, &keys.parameters).under("profile")?;
        let mut scene = empty_scene(keys, solids);
        scene.behind = behind;
        scene.levels = building.map(|building| building.levels.clone());
        let mut notes = self.notes.clone();
        let populated = self.populate(&mut scene, &blend, &mut notes);
        let items = populated.map_err(|problem| likely_cause(problem, &without_effect))?;
        scene.integrator = keys.integrator.for_scene(&scene);
        scene.clock = numerics::clock_for(keys, &scene)?;
        check_reach(&scene)?;
        scene.interventions = interventions::read(&keys.interventions, &scene)?;
        let passage_width = widest::passable(&items.origins(keys, &scene));
        interventions::add_routes(&mut scene, passage_width)?;
        let placed = scene.agents.len() as u64;
        let fewer = self.need.initial.saturating_sub(placed); // crowds with a density
        let entering = self.need.entering - fewer;
        notes.extend(doubts::notes(keys, &scene, entering, last));
        notes.extend(slits::note(&scene.walls));
        notes.extend(without_effect?);
        let view = view::of(keys.view.as_ref(), &scene).under("view")?;
        notes.extend(view::unseen(keys, &view.region));
        let mut document = self.document;
        plans::write(&self.files, keys, &mut document);
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Scenario {
            name: keys.name.clone().unwrap_or_else(|| stem.into_owned()),
            description: keys.description.clone().unwrap_or_default(),
            seed: seed(keys),
            duration_secs: duration(keys),
            stop: keys.stop.clone(),
            measurements: keys.measurements.clone(),
            view,
            labels: keys.labels.iter().map(Into::into).collect(),
            changes: Vec::new(),
            debug_agents: match &keys.debug_agents {
                Some(ids) => without_repetition(ids)?,
                None => spread(entering),
            },
            entering,
            profile_name: blend.name,
            document,
            files: self.files,
            places: self.places,
            notes,
            passage_width,
            scene,
        })
    }

    /// Adds the places, the people and their routes to a scene, and checks that all lie on the floor.
    fn populate(
        &self,
        scene: &mut Scene,
        blend: &Blend,
        notes: &mut Vec<String>,
    ) -> Result<Items, Problem> {
        let (keys, behind) = (&self.keys, &scene.behind.clone());
        let levels = scene.levels.as_deref();
        scene.journeys = journeys::journeys(keys, (&scene.walls, behind, levels), notes)?;
        let entered = Population::new(keys, blend, behind, scene).enter();
        let (of_people, items) =
            entered.map_err(|problem| meant::clearer(problem, &self.document))?;
        notes.extend(of_people);
        overcrowded::check(keys, (scene, &items), duration(keys))?;
        measurements::check(&keys.measurements, &scene.journeys.journeys)?;
        off_floor::check(keys, scene)?;
        off_floor::check_waypoints(scene, behind)?;
        off_floor::check_starts(&items.origins(keys, scene), behind)?;
        add_pushes(scene, &keys.events)?;
        periodic::check(keys, scene)?;
        scene.routing = Routing {
            choice: keys.route_choice.unwrap_or_default(),
            knowledge: keys.knowledge,
        };
        routes::add((keys, &items), scene, behind, notes)?;
        Ok(items)
    }
}

/// A problem with its likely cause: for a place off the floor, a part of the plan without effect.
fn likely_cause(problem: Problem, without_effect: &Result<Vec<String>, Problem>) -> Problem {
    match without_effect.as_deref().unwrap_or_default().first() {
        Some(note) if problem.reason.contains("outside of the walkable area") => {
            Problem::new(problem.path, format!("{}; {note}", problem.reason))
        }
        _ => problem,
    }
}

/// Checks the keys that groups have in common, those of behavior by themselves.
fn shared(group: &Value) -> Result<(), Problem> {
    parsed::<Behavior>(group)?;
    parsed::<People>(group).map(drop)
}

/// Removes `$schema`, by which editors find the schema.
fn without_schema(document: &mut Value) -> Result<(), Problem> {
    let object = document.as_object_mut();
    let given = object.and_then(|document| document.remove("$schema"));
    match given {
        None | Some(Value::String(_)) => Ok(()),
        Some(_) => {
            let reason = "must be text, the location of the schema";
            Err(Problem::new("$schema", reason))
        }
    }
}

fn duration(keys: &File) -> f64 {
    keys.duration_secs.unwrap_or(DEFAULT_DURATION)
}

fn seed(keys: &File) -> u64 {
    keys.seed.unwrap_or(Scene::default().seed)
}

/// The scene without agents, sources and pushes.
fn empty_scene(keys: &File, solids: Vec<Polygon>) -> Scene {
    let paper = Scene::default();
    let seed = seed(keys);
    Scene {
        seed: keys.population_seed.unwrap_or(seed),
        behavior_seed: Some(keys.behavior_seed.unwrap_or(seed)),
        clock: numerics::first_clock(keys),
        wall_method: keys.wall_method,
        precision: keys.precision,
        neighbor_lists: keys.neighbor_lists,
        preferred_speed: keys.preferred_speed.unwrap_or(paper.preferred_speed),
        max_speed: keys.max_speed.unwrap_or(paper.max_speed),
        max_speed_ratio: max_speed_ratio(keys, &paper),
        period: keys.periodic.map(Period::from),
        ..Scene::with_obstacles(solids)
    }
}

/// s_max / s_pref of agents with a preferred speed of their own; `None` if the file gives s_max.
fn max_speed_ratio(keys: &File, paper: &Scene) -> Option<f64> {
    let preferred = keys.preferred_speed.filter(|&speed| speed > 0.0);
    let ratio = paper.max_speed / preferred.unwrap_or(paper.preferred_speed);
    keys.max_speed.is_none().then_some(ratio)
}

/// Adds the pushes among the events, and their forces.
fn add_pushes(scene: &mut Scene, events: &[file::Event]) -> Result<(), Problem> {
    if events.len() > MOST_NUMBERED {
        let reason = format!(
            "{} events; at most {MOST_NUMBERED} are allowed",
            events.len()
        );
        return Err(Problem::new("events", reason));
    }
    for (k, event) in events.iter().enumerate() {
        let place = format!("events[{k}]");
        let given = (event.for_secs, event.region);
        let given_changes = [&event.open, &event.close, &event.release];
        let changes = given_changes.into_iter().flatten().count();
        let (lasting, corners) = match (given, changes) {
            ((Some(lasting), Some(corners)), 0) => (lasting, corners),
            ((None, None), 1) => continue,
            _ => {
                let reason = "give one of `open`, `close` and `release`, or both `for_secs` and `region` of a push";
                return Err(Problem::new(place, reason));
            }
        };
        let push = scene.pushes.len() as u16; // at most MOST_NUMBERED
        if let Some(force) = force(push, event).under(&place)? {
            scene.own_forces.push(Arc::new(force));
        }
        scene.pushes.push(Push {
            region: region("region", corners).under(&place)?,
            name: event.name.clone().unwrap_or(place),
            at: event.at_secs,
            lasting,
            change: Override {
                goal_scale: event.goal_scale,
                ignore_contact: event.ignore_contact,
                ignore_sph: event.ignore_sph,
            },
        });
    }
    Ok(())
}

/// The force of a push, if it has one.
fn force(push: u16, event: &file::Event) -> Result<Option<PushForce>, Problem> {
    let Some(curve) = &event.acceleration else {
        return match event.direction {
            Some(_) => {
                let reason = "is for `acceleration`, which is not given; add it, or remove this";
                Err(Problem::new("direction", reason))
            }
            None => Ok(None),
        };
    };
    let way = event.direction.map_or(Vector::x(), Vector::from);
    if way == Vector::zeros() {
        return Err(Problem::new("direction", "must not be [0, 0]"));
    }
    Ok(Some(PushForce {
        push,
        at: event.at_secs,
        direction: direction(way),
        curve: curve.points().under("acceleration")?,
    }))
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
