//! Exits, checkpoints and zones → the places and zones of a scenario.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::fields::{Notes, Object};
use super::floor::{Floor, Part};
use super::sides::open_sides;
use crate::error::Problem;
use engine::math::Vector;

/// What stands between the id of an exit and the number of its side.
pub const SIDE: &str = " side ";
/// The keys of exits, checkpoints and zones that are read, or that only drawings need.
const EXIT: [&str; 8] = [
    "type",
    "coordinates",
    "enable_throughput_throttling",
    "max_throughput",
    "shape",
    "center",
    "radius",
    "name",
];
const CHECKPOINT: [&str; 12] = [
    "type",
    "coordinates",
    "enable_throughput_throttling",
    "max_throughput",
    "shape",
    "center",
    "radius",
    "name",
    "waiting_time",
    "waiting_time_distribution",
    "waiting_time_std",
    "speed_factor",
];
const ZONE: [&str; 7] = [
    "type",
    "coordinates",
    "speed_factor",
    "shape",
    "center",
    "radius",
    "name",
];
/// The shortest time that a person waits where waiting times are normally distributed, seconds.
const SHORTEST_WAIT: f64 = 0.1;
/// The standard deviation of waiting times that is used if none is given, seconds.
const WAIT_STD: f64 = 1.0;
/// The range of speed factors.
const FACTORS: [f64; 2] = [0.01, 3.0];
/// A checkpoint that is longer than this part of its width is a line, otherwise a disk.
const LONG: f64 = 2.0;
/// The radius of the smallest disk of a checkpoint, meters.
const SMALLEST: f64 = 0.3;

/// Where people go.
#[derive(Debug, Default)]
pub struct Places {
    /// The names of the lines of each exit.
    pub exits: BTreeMap<String, Vec<String>>,
    /// The checkpoints in order.
    pub checkpoints: Vec<String>,
    /// The lists of a scenario.
    pub lists: BTreeMap<&'static str, Vec<Value>>,
}

impl Places {
    /// The places and zones of a document.
    pub fn read(root: &Object, floor: &Floor, notes: &mut Notes) -> Result<Self, Problem> {
        let mut places = Self::default();
        for (id, exit) in root.elements("exits")? {
            exit.note_unknown(&EXIT, notes);
            places.add_exit(id, &exit, floor, notes)?;
        }
        if places.exits.is_empty() {
            return Err(Problem::new("exits", "needs at least one exit"));
        }
        let older = root.says("waiting_polygons") && !root.says("checkpoints");
        let key = if older {
            "waiting_polygons"
        } else {
            "checkpoints"
        };
        for (id, checkpoint) in root.elements(key)? {
            checkpoint.note_unknown(&CHECKPOINT, notes);
            places.add_checkpoint(id, &checkpoint, floor, notes)?;
        }
        for (id, zone) in root.elements("zones")? {
            zone.note_unknown(&ZONE, notes);
            let factor = zone.number("speed_factor", 0.0)?.unwrap_or(1.0);
            match floor.part(&zone)? {
                Some(part) => places.add_zone(id, &part, factor, notes),
                None => notes.add(format!(
                    "zones.{id} lies outside of the walkable area and is left out"
                )),
            }
        }
        Ok(places)
    }

    /// A stage of a journey at which people go to a place.
    pub fn stage(&self, id: &str) -> Value {
        match self.exits.get(id).map(Vec::as_slice) {
            None => id.into(),
            Some([line]) => line.as_str().into(),
            Some(lines) => json!({ "nearest": lines }),
        }
    }

    /// The stage at which people go to the nearest exit.
    pub fn nearest_exit(&self) -> Value {
        let lines: Vec<&String> = self.exits.values().flatten().collect();
        match lines[..] {
            [line] => line.as_str().into(),
            _ => json!({ "nearest": lines }),
        }
    }

    fn add(&mut self, list: &'static str, element: Value) {
        self.lists.entry(list).or_default().push(element);
    }

    fn add_exit(
        &mut self,
        id: &str,
        exit: &Object,
        floor: &Floor,
        notes: &mut Notes,
    ) -> Result<(), Problem> {
        let wrong = |reason: &str| exit.problem("coordinates", reason);
        let part = floor.part(exit)?.ok_or_else(|| {
            wrong("lies outside of the walkable area, so that no person comes in")
        })?;
        let mut lines = open_sides(&part, floor);
        if lines.is_empty() {
            return Err(wrong(
                "no side of it borders on floor from which people could come in",
            ));
        }
        let rate = exit
            .number("max_throughput", 0.0)?
            .filter(|&rate| rate > 0.0)
            .filter(|_| exit.flag("enable_throughput_throttling"));
        if rate.is_some() && lines.len() > 1 {
            notes.add(format!(
                "exits.{id}: people come in by the longest of its {} open sides alone, as its throughput is limited",
                lines.len()
            ));
            lines.truncate(1);
        }
        let several = lines.len() > 1;
        let mut names = Vec::new();
        for (k, line) in lines.into_iter().enumerate() {
            let name = match several {
                true => format!("{id}{SIDE}{}", k + 1),
                false => id.to_owned(),
            };
            let mut element = json!({"name": name, "line": ends(line)});
            if let Some(rate) = rate {
                element["most_per_sec"] = rate.into();
            }
            self.add("exits", element);
            names.push(name);
        }
        self.exits.insert(id.to_owned(), names);
        Ok(())
    }

    fn add_checkpoint(
        &mut self,
        id: &str,
        checkpoint: &Object,
        floor: &Floor,
        notes: &mut Notes,
    ) -> Result<(), Problem> {
        let Some(part) = floor.part(checkpoint)? else {
            let reason = "lies outside of the walkable area, so that no person reaches it";
            return Err(checkpoint.problem("coordinates", reason));
        };
        self.checkpoints.push(id.to_owned());
        let wait = checkpoint.number("waiting_time", 0.0)?.unwrap_or(0.0);
        if wait > 0.0 {
            let secs = waiting_time(checkpoint, wait)?;
            self.add(
                "waiting_areas",
                json!({"name": id, "area": part.corners(), "for_secs": secs}),
            );
            return Ok(());
        }
        let (length, width, _) = part.extent();
        let waypoint = match length > LONG * width {
            true => json!({"name": id, "line": ends(part.middle_line())}),
            false => {
                let within = part.inner_radius().max(SMALLEST);
                json!({"name": id, "at": point(part.center()), "within": within})
            }
        };
        self.add("waypoints", waypoint);
        let factor = checkpoint.number("speed_factor", 0.0)?.unwrap_or(1.0);
        if checkpoint.flag("enable_throughput_throttling") {
            notes.add(format!(
                "checkpoints.{id}: throughput is not limited at checkpoints; `exits` and `queues` limit it"
            ));
        } else {
            self.add_zone(id, &part, factor, notes);
        }
        Ok(())
    }

    fn add_zone(&mut self, id: &str, part: &Part, factor: f64, notes: &mut Notes) {
        let [least, most] = FACTORS;
        let within = factor.clamp(least, most);
        if within != factor {
            notes.add(format!(
                "{id}: speed_factor {factor} is out of range; {within} is used"
            ));
        }
        if within != 1.0 {
            self.add(
                "zones",
                json!({"name": id, "area": part.corners(), "speed_factor": within}),
            );
        }
    }
}

/// How long people wait at a checkpoint.
fn waiting_time(checkpoint: &Object, mean: f64) -> Result<Value, Problem> {
    const KEY: &str = "waiting_time_distribution";
    match checkpoint.word(KEY)?.unwrap_or("constant") {
        "constant" => Ok(mean.into()),
        "gaussian" => {
            let std = checkpoint
                .number("waiting_time_std", 0.0)?
                .unwrap_or(WAIT_STD);
            Ok(json!({"normal": {"mean": mean, "std": std, "min": SHORTEST_WAIT}}))
        }
        _ => Err(checkpoint.problem(KEY, "must be `constant` or `gaussian`")),
    }
}

/// A point as in a scenario.
pub fn point(p: Vector) -> Value {
    json!([p.x, p.y])
}

/// The ends of a line as in a scenario.
pub fn ends(line: [Vector; 2]) -> Value {
    line.map(point).into_iter().collect()
}
