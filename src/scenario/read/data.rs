//! `from`: the people of a trajectory file begin a scenario.

use std::path::Path;

use serde_json::Value;

use crate::error::quote::{shown, shown_message};
use crate::error::{Problem, Under};
use crate::file::File;
use crate::keys::from::{FILE, FROM, FromData, Person};
use crate::read::plans::PlanFile;
use crate::trajectories::{OnLevel, ReadOptions, TOO_FAST, Tracks, UNITS, read};

/// Velocities are means from this long before to this long after, seconds, as in the measurement `line_flow`.
const REACH: f64 = 0.2;

/// Replaces the name of the trajectory file, relative to `folder`, and the keys about it with the people, and adds
/// notes on keys that overrule the file. Returns the file.
pub fn fill(
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
            ("level", given.level.is_some()),
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
        for key in [
            "trajectory",
            "at_secs",
            "until_secs",
            "unit",
            "fps",
            "level",
        ] {
            object.remove(key);
        }
        let list =
            serde_json::to_value(&people).map_err(|error| Problem::new(FILE, error.to_string()))?;
        object.insert("people".to_owned(), list);
    }
    given.people = Some(people);
    Ok(Some((FILE, path)))
}

/// The trajectories of a file, and the time in it at which the scenario begins, seconds: before the first frame of the
/// file, that of this frame.
pub fn tracks(path: &Path, given: &FromData) -> Result<(Tracks, f64), Problem> {
    let options = ReadOptions {
        unit: given.unit,
        fps: given.fps,
        level: given.level.clone().map_or(OnLevel::Only, OnLevel::Named),
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
            "half of all steps in {file} are faster than {TOO_FAST} m/s; set `unit` ({}) and `fps` to those of \
             the file",
            UNITS.join(", ")
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
    let keys = ["fps", "unit", "level"];
    keys.iter().fold(said.to_owned(), |said, key| {
        said.replace(&format!("--{key}"), &format!("`{key}`"))
    })
}

/// The people in a file: those at the time, by id, then those who appear later, by time. Adds notes on keys that
/// overrule the file.
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
