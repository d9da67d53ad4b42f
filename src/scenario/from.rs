//! `from`: the people of a trajectory file begin a scenario.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::PlanFile;
use super::crowd::{Behavior, Crowd as Building};
use super::distribution::{self, Draw, traits};
use super::error::{Problem, Under};
use super::file::{FARTHEST, File, LONGEST_TIME};
use super::goals::{Aim, Target};
use super::profiles::ProfileChoice;
use crate::engine::agents::NewAgent;
use crate::engine::entrance::Latecomer;
use crate::engine::math::Vector;
use crate::scenario::quote::{shown, shown_message};
use crate::scenario::trajectories::{ReadOptions, TOO_FAST, Tracks, Unit, read};

/// The key.
const FROM: &str = "from";
/// The file, for messages about outputs that would replace it.
const FILE: &str = "from.trajectory";
/// Velocities are means from this long before to this long after, seconds, as in the measurement `line_flow`.
const REACH: f64 = 0.2;

/// The people of a trajectory file at one time, and those who appear in it later: `trajectory` or `people`.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct FromData {
    /// The name in reports. Default: `from`.
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// The trajectory file, relative to this file's folder: SQLite (JuPedSim), CSV or text.
    #[schemars(length(min = 1))]
    pub trajectory: Option<String>,
    /// With `trajectory`: the time in the file at which the scenario begins, seconds; frame f is at f / `fps`. Before the
    /// first frame it is that of this frame. Default: the first frame.
    #[schemars(range(min = -LONGEST_TIME, max = LONGEST_TIME))]
    pub at_secs: Option<f64>,
    /// With `trajectory`: people who appear in the file after this time in it are left out, seconds. Default: all enter.
    #[schemars(range(min = -LONGEST_TIME, max = LONGEST_TIME))]
    pub until_secs: Option<f64>,
    /// With `trajectory`: the unit of its coordinates. Default: as the file says.
    pub unit: Option<Unit>,
    /// With `trajectory`: its frames per second. Default: as the file says.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub fps: Option<f64>,
    /// Instead of `trajectory`: the people.
    pub people: Option<Vec<Person>>,
    /// The goal. Default: the scenario's goal.
    pub goal: Option<Aim>,
    /// Instead of `goal`: the name of the journey.
    pub journey: Option<String>,
    /// The behavior. Default: the scenario's profile.
    pub profile: Option<ProfileChoice>,
    /// Agents leave within this distance of their goal, meters. Default: they stay.
    #[schemars(range(max = 1e6), extend("exclusiveMinimum" = 0))]
    pub remove_within: Option<f64>,
    /// Whether arrivals count as evacuated.
    #[schemars(extend("default" = true))]
    pub counted: Option<bool>,
    /// s_pref, m/s: a number, or a distribution to draw from for each agent. Default: the scenario's `preferred_speed`.
    #[schemars(schema_with = "distribution::speed")]
    pub preferred_speed: Option<Draw>,
    /// D_i, meters: a number, or a distribution. Default: uniform from 0.215 to 0.265 (§5.6).
    #[schemars(schema_with = "distribution::radius")]
    pub radius: Option<Draw>,
    /// m_i, 1 for an average person: a number, or a distribution. Lighter agents need shorter time steps. Default:
    /// (D_i / 0.24)².
    #[schemars(schema_with = "distribution::mass")]
    pub mass: Option<Draw>,
}

/// A person: [id, seconds until it enters, x, y in meters, velocity along x, y in m/s]
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub(super) struct Person([f64; 6]);

impl Person {
    /// When it enters, seconds; those at 0 are there at the start.
    fn enters(&self) -> f64 {
        self.0[1]
    }

    fn position(&self) -> Vector {
        Vector::new(self.0[2], self.0[3])
    }

    fn velocity(&self) -> Vector {
        Vector::new(self.0[4], self.0[5])
    }

    fn check(&self) -> Result<(), Problem> {
        if !(0.0..=LONGEST_TIME).contains(&self.enters()) {
            let reason = format!(
                "enters at {} s; must be 0 to {LONGEST_TIME:e}",
                self.enters()
            );
            return Err(Problem::new("", reason));
        }
        match self.position().amax() > FARTHEST {
            true => {
                let reason =
                    format!("{self} is more than {FARTHEST:e} m from the origin; move the origin");
                Err(Problem::new("", reason))
            }
            false => Ok(()),
        }
    }
}

impl std::fmt::Display for Person {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let [id, _, x, y, ..] = self.0;
        write!(f, "person {id} at ({x:.2}, {y:.2}) m")
    }
}

impl FromData {
    fn people(&self) -> &[Person] {
        self.people.as_deref().unwrap_or_default()
    }

    /// The number of people at the start.
    pub(super) fn initial(&self) -> u64 {
        let people = self.people().iter();
        people.filter(|person| person.enters() <= 0.0).count() as u64
    }

    /// The number of people who enter later, until `last` seconds.
    pub(super) fn later(&self, last: f64) -> u64 {
        let people = self.people().iter();
        let later = people.filter(|person| person.enters() > 0.0 && person.enters() <= last);
        later.count() as u64
    }
}

/// Replaces the name of the trajectory file, relative to `folder`, and the keys about it with the people, and adds notes
/// on keys that overrule the file. Returns the file.
pub(super) fn fill(
    document: &mut Value,
    keys: &mut File,
    folder: &Path,
    notes: &mut Vec<String>,
) -> Result<Option<PlanFile>, Problem> {
    let Some(given) = &mut keys.from else {
        return Ok(None);
    };
    let Some(name) = &given.trajectory else {
        for (key, is_given) in [
            ("at_secs", given.at_secs.is_some()),
            ("until_secs", given.until_secs.is_some()),
            ("unit", given.unit.is_some()),
            ("fps", given.fps.is_some()),
        ] {
            if is_given {
                let reason = "is for `trajectory`, which is not given; add it, or remove this";
                return Err(Problem::new(format!("{FROM}.{key}"), reason));
            }
        }
        return match given.people {
            Some(_) => Ok(None),
            None => Err(Problem::new(FROM, "needs either `trajectory` or `people`")),
        };
    };
    if given.people.is_some() {
        let reason = "either `trajectory` or `people`, not both";
        return Err(Problem::new(format!("{FROM}.people"), reason));
    }
    let path = folder.join(name);
    let people = people(&path, given, notes).under(FROM)?;
    if let Some(Value::Object(object)) = document.get_mut(FROM) {
        for key in ["trajectory", "at_secs", "until_secs", "unit", "fps"] {
            object.remove(key);
        }
        let list = serde_json::to_value(&people);
        let list = list.map_err(|error| Problem::new(FILE, error.to_string()))?;
        object.insert("people".to_owned(), list);
    }
    given.people = Some(people);
    Ok(Some((FILE, path)))
}

/// The trajectories of a file, and the time in it at which the scenario begins, seconds: before the first frame of the
/// file, that of this frame.
pub(super) fn tracks(path: &Path, given: &FromData) -> Result<(Tracks, f64), Problem> {
    let options = ReadOptions {
        unit: given.unit,
        fps: given.fps,
    };
    let tracks = read(path, &options)
        .map_err(|error| Problem::new("trajectory", shown_message(&in_keys(&error.to_string()))))?;
    let file = shown(&path.display().to_string());
    if tracks.unit.is_none() {
        let reason =
            format!("missing, and {file} names none (x/m or x/cm); set it to \"m\" or \"cm\"");
        return Err(Problem::new("unit", reason));
    }
    if tracks.median_speed() > TOO_FAST {
        let reason = format!(
            "half of all steps in {file} are faster than {TOO_FAST} m/s; set `unit` (\"m\" or \"cm\") and `fps` to \
             those of the file"
        );
        return Err(Problem::new("trajectory", reason));
    }
    let [first, last] = [0, tracks.frames.len() - 1].map(|k| tracks.time(tracks.frames[k]));
    let near = tracks.rounding();
    let at = given.at_secs.unwrap_or(first);
    if at < first - near {
        return Ok((tracks, first));
    }
    if at > last + near {
        let reason = format!("{at} s is outside of the data: {file} has {first} to {last} s");
        return Err(Problem::new("at_secs", reason));
    }
    Ok((tracks, at))
}

/// A message for the command line, with keys instead of options.
fn in_keys(said: &str) -> String {
    said.replace("--fps", "`fps`").replace("--unit", "`unit`")
}

/// The people in a file: those at the time, by id, then those who appear later, by time. Adds notes on keys that overrule
/// the file.
fn people(path: &Path, given: &FromData, notes: &mut Vec<String>) -> Result<Vec<Person>, Problem> {
    let (tracks, at) = tracks(path, given)?;
    let overruled = tracks.notes.iter().filter(|note| note.starts_with("--"));
    notes.extend(overruled.map(|note| format!("{FROM}: {}", in_keys(note))));
    let near = tracks.rounding();
    if let Some(early) = given.at_secs.filter(|early| *early < at - near) {
        notes.push(format!(
            "{FROM}.at_secs: {early} s is before the data: the scenario begins with their first frame, at {at} s"
        ));
    }
    let until = given.until_secs.unwrap_or(f64::INFINITY);
    if until < at {
        let reason = format!("{until} is before the start at {at} s; raise it");
        return Err(Problem::new("until_secs", reason));
    }
    let (mut there, mut later) = (Vec::new(), Vec::new());
    for p in 0..tracks.ids.len() {
        let [appears, leaves] = tracks.times_of(p);
        if leaves < at - near || appears > until + near {
            continue;
        }
        let is_there = appears <= at + near;
        let time = if is_there { at } else { appears };
        let (place, velocity) = (tracks.place_at(p, time), tracks.velocity_at(p, time, REACH));
        let id = tracks.ids[p] as f64;
        let person = Person([id, time - at, place.x, place.y, velocity.x, velocity.y]);
        if is_there { &mut there } else { &mut later }.push(person);
    }
    later.sort_by(|a: &Person, b| a.enters().total_cmp(&b.enters()));
    there.extend(later);
    match there.is_empty() {
        false => Ok(there),
        true => {
            let file = shown(&path.display().to_string());
            let reason =
                format!("no one is in {file} at {at} s, or appears in it later until {until} s");
            Err(Problem::new("at_secs", reason))
        }
    }
}

impl Building<'_> {
    /// Adds the people of `from`.
    pub(super) fn add_data(&mut self, given: &FromData) -> Result<(), Problem> {
        let draws = [&given.preferred_speed, &given.radius, &given.mass, &None];
        let traits = traits(draws)?;
        let journey = self.journey(given.journey.as_deref(), given.goal.is_some())?;
        let target = self.target(given.goal, journey, given.remove_within)?;
        let behavior = Behavior {
            journey,
            direction: target.direction,
            profile: given.profile.as_ref(),
            remove_within: given.remove_within,
            counted: given.counted,
        };
        for (k, person) in given.people().iter().enumerate() {
            person.check().under(&format!("people[{k}]"))?;
        }
        self.check_floor(given.people())?;
        let group = self.group(given.name.as_deref().unwrap_or(FROM), behavior, traits)?;
        let agent = |person: &Person| agent(person, &target, group);
        let (there, mut later): (Vec<&Person>, Vec<&Person>) = given
            .people()
            .iter()
            .partition(|person| person.enters() <= 0.0);
        if self.scene.period.is_some() && !later.is_empty() {
            let reason = format!(
                "in a periodic scene none come in, and {} people appear after the start; set `until_secs` to `at_secs`",
                later.len()
            );
            return Err(Problem::new("", reason));
        }
        later.sort_by(|a, b| a.enters().total_cmp(&b.enters()));
        let mut faster = 0;
        for person in &there {
            let id = self.scene.agents.len() as u32;
            let slowed = self.scene.slowed(agent(person), id);
            faster += usize::from(slowed.velocity != person.velocity());
            self.scene.agents.push(slowed);
        }
        if faster > 0 {
            self.notes.push(format!(
                "{faster} of {} people of `{FROM}` are faster at the start than `max_speed` allows, and are slowed to it",
                there.len()
            ));
        }
        let latecomer = |person: &Person| Latecomer {
            at: person.enters(),
            agent: agent(person),
        };
        self.scene
            .latecomers
            .extend(later.into_iter().map(latecomer));
        Ok(())
    }

    /// Checks that nobody begins in a wall: data and walls would not belong together.
    fn check_floor(&self, people: &[Person]) -> Result<(), Problem> {
        let walls = &self.scene.walls;
        let place = |person: &Person| match self.scene.period {
            Some(period) => period.wrapped(person.position()).0,
            None => person.position(),
        };
        let within = |person: &&Person| walls.obstacle_at(place(person)).is_some();
        let Some(first) = people.iter().find(within) else {
            return Ok(());
        };
        let reason = format!(
            "{first} is in an obstacle or outside of the walkable area, as {} of {} people are; mend the walls, or choose \
             `unit`, the origin and `until_secs` to fit them",
            people.iter().filter(within).count(),
            people.len()
        );
        Err(Problem::new("", reason))
    }
}

fn agent(person: &Person, target: &Target, group: u16) -> NewAgent {
    let position = person.position();
    NewAgent {
        velocity: person.velocity(),
        ..NewAgent::at(position, target.goal_from(position), group)
    }
}
