//! Another simulator in place of ours: a command that reads scenes and writes trajectories, which are measured.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

use super::data::{has_result, of_tracks};
use super::keys::Case as Of;
use super::known::label;
use super::quantity::Quantity;
use crate::error::LabError;
use crate::jobs::results;
use crate::sweep::Cell;
use engine::journeys::{Choice, Kind};
use engine::math::Vector;
use engine::scene::Scene;
use engine::simulation::Simulation;
use output::trajectory::walkable_area;
use runs::identity::Identity;
use runs::job::{Job, Listener};
use runs::store::Store;
use runs::summary::Summary;
use scenario::Scenario;
use scenario::quote::shown;
use scenario::trajectories::{ReadOptions, read};

/// A guess of the time of a run, seconds.
const EXPECTED_SECS: f64 = 10.0;

/// Why a command cannot be judged by a case whose runs are these scenarios; `None` if it can.
pub fn refused(case: &Of, scenarios: &[Scenario]) -> Option<String> {
    let unmeasured = case.checks.iter().flat_map(|check| &check.quantity);
    let mut unmeasured = unmeasured.filter_map(|quantity| match quantity {
        Quantity::Named(name) if scenarios.iter().all(|one| has_result(one, name)) => None,
        Quantity::Named(name) => Some(name.as_str()),
        Quantity::Other(_) => Some("a result of our own runs"),
    });
    if let Some(name) = unmeasured.next() {
        return Some(format!(
            "it checks {}, which is not measured in trajectories: only `line_flow` and `push` are",
            shown(name)
        ));
    }
    scenarios.iter().find_map(|scenario| scene(scenario).err())
}

/// The results of a command for each cell, in their order: of trajectories that `store` does not have.
///
/// # Errors
/// The command fails, or its trajectories cannot be read.
pub fn summaries(
    command: &str,
    cells: &[&Cell],
    store: &Store,
    listener: &dyn Listener,
) -> Result<Vec<Summary>, LabError> {
    let key = |cell: &Cell| Identity::of("runner", format!("{command} {}", cell.case.key));
    let mut jobs = Vec::new();
    for &cell in cells {
        let work = move |_: &mut dyn FnMut(f64)| simulated(command, cell, store);
        jobs.push(Job::new(name(cell), key(cell), EXPECTED_SECS, work));
    }
    let computed = results(&jobs, store, listener)?;
    let of = |cell: &&Cell| computed.of(&name(cell), &key(cell));
    cells.iter().map(of).collect()
}

fn name(cell: &Cell) -> String {
    format!("{}, seed {}", label(cell), cell.case.seed)
}

/// Writes the scene of a run into the folder of results, lets the command simulate it, and measures its trajectories.
fn simulated(command: &str, cell: &Cell, store: &Store) -> Result<Summary, String> {
    let failed = |error: &dyn std::fmt::Display| error.to_string();
    let scenario = cell.case.scenario().map_err(|error| failed(&error))?;
    let folder = store.path(&format!(
        "scenes/{}",
        name(cell).replace(", ", "-").replace(' ', "-")
    ));
    fs::create_dir_all(&folder).map_err(|error| failed(&error))?;
    let (described, floor) = scene(&scenario)?;
    let [scene, floor_file, out] =
        ["scene.json", "floor.wkt", "trajectories.txt"].map(|file| folder.join(file));
    fs::write(&floor_file, floor).map_err(|error| failed(&error))?;
    fs::write(&scene, format!("{described:#}\n")).map_err(|error| failed(&error))?;
    let ended = shell(command, &scene, &out).output();
    let ended = ended.map_err(|error| format!("`{command}`: {error}"))?;
    if !ended.status.success() {
        let said = String::from_utf8_lossy(&ended.stderr);
        let last = said.lines().rfind(|line| !line.trim().is_empty());
        return Err(format!(
            "`{command}` failed ({}): {}",
            ended.status,
            shown(last.unwrap_or("it said nothing"))
        ));
    }
    let tracks = read(&out, &ReadOptions::default()).map_err(|error| {
        format!(
            "`{command}` must write trajectories to the file that is its last argument: {error}"
        )
    })?;
    Ok(Summary {
        scenario: scenario.name.clone(),
        profile: command.to_owned(),
        seed: scenario.seed,
        agents: tracks.ids.len() as u32,
        ..of_tracks(&tracks, 0.0, &scenario)
    })
}

/// The command with the two files as further arguments.
fn shell(command: &str, scene: &Path, out: &Path) -> Command {
    let mut shell = match cfg!(windows) {
        true => Command::new("cmd"),
        false => Command::new("sh"),
    };
    match cfg!(windows) {
        true => shell.args(["/C", command]),
        false => shell.args(["-c", &format!("{command} \"$0\" \"$1\"")]),
    };
    shell.arg(scene).arg(out);
    shell
}

/// A scenario as other simulators can take it: its JSON and its floor as WKT, or why there is none.
fn scene(scenario: &Scenario) -> Result<(Value, String), String> {
    let scene = &scenario.scene;
    if scene.period.is_some() {
        return Err("its scene is periodic".to_owned());
    }
    let places = &scene.journeys.places;
    if !places.iter().any(|place| place.is_exit()) {
        return Err("its scene has no exits".to_owned());
    }
    let (mut exits, mut waypoints) = (Vec::new(), Vec::new());
    for place in places {
        let (list, line) = match &place.kind {
            Kind::Exit(exit) => (&mut exits, exit.line),
            Kind::Line(line) => (&mut waypoints, *line),
            _ => return Err(format!("{} is no line", shown(&place.name))),
        };
        list.push(json!({"name": place.name, "line": line.map(point)}));
    }
    let mut journeys = Vec::new();
    for journey in &scene.journeys.journeys {
        let mut stages = Vec::new();
        for stage in &journey.stages {
            if stage.choice != Choice::Nearest && stage.places.len() > 1 {
                let name = shown(&journey.name);
                return Err(format!(
                    "people on the journey {name} choose otherwise than the nearest place"
                ));
            }
            let names = stage.places.iter().map(|&k| &places[usize::from(k)].name);
            stages.push(names.collect::<Vec<_>>());
        }
        journeys.push(json!({"name": journey.name, "stages": stages}));
    }
    let simulation = Simulation::new(scene.clone()).map_err(|error| error.to_string())?;
    let floor =
        walkable_area(&simulation, scenario.view.region).map_err(|error| error.to_string())?;
    let described = json!({
        "name": scenario.name,
        "seed": scenario.seed,
        "duration_secs": scenario.duration_secs,
        "floor": "floor.wkt",
        "exits": exits,
        "waypoints": waypoints,
        "journeys": journeys,
        "people": people(scenario, &simulation)?,
    });
    Ok((described, floor))
}

/// Everybody who starts in the scene or arrives in it.
fn people(scenario: &Scenario, simulation: &Simulation) -> Result<Vec<Value>, String> {
    let scene = simulation.scene();
    if !scene.sources.is_empty() {
        return Err("people of its scene enter on grids again and again".to_owned());
    }
    let agents = simulation.frame().agents;
    let first = agents.entered();
    let speed = |own: Option<f64>| own.unwrap_or(scene.preferred_speed);
    let from_start = (0..agents.len()).map(|i| Person {
        id: agents.id[i],
        at: 0.0,
        position: agents.position[i],
        radius: agents.radius[i],
        speed: speed(agents.preferred_speed.get(i).copied()),
        group: agents.group[i],
    });
    let arrivals = scene.arrivals(first, scenario.duration_secs);
    let later = (first..).zip(arrivals).map(|(id, late)| Person {
        id,
        at: late.at,
        position: late.agent.position,
        radius: late
            .agent
            .radius
            .unwrap_or_else(|| engine::agents::radius_of(scene.seed, id)),
        speed: speed(late.agent.preferred_speed),
        group: late.agent.group,
    });
    from_start
        .chain(later)
        .map(|one| one.described(scene))
        .collect()
}

/// A person of a scene.
struct Person {
    id: u32,
    at: f64,
    position: Vector,
    radius: f64,
    speed: f64,
    group: u16,
}

impl Person {
    fn described(&self, scene: &Scene) -> Result<Value, String> {
        let group = &scene.groups[usize::from(self.group)];
        if group.direction.is_some() {
            return Err("people of its scene walk in a direction, not to places".to_owned());
        }
        let journeys = &scene.journeys.journeys;
        let journey = group
            .journey
            .ok_or("people of its scene walk to points of their own");
        let journey = &journeys[usize::from(journey?)];
        Ok(json!({
            "id": self.id,
            "enters_secs": self.at,
            "position": point(self.position),
            "radius": self.radius,
            "preferred_speed": self.speed,
            "motivation": group.motivation,
            "journey": journey.name,
        }))
    }
}

fn point(p: Vector) -> [f64; 2] {
    [p.x, p.y]
}
