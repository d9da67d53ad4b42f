//! Distributions of people → crowds, and entrances for those who enter during the run.

use serde_json::{Value, json};

use super::fields::{Notes, Object};
use super::floor::{Floor, Part};
use super::places::ends;
use super::routes::Routes;
use crate::error::Problem;

const DISTRIBUTION: [&str; 8] = [
    "type",
    "coordinates",
    "parameters",
    "journey_weights",
    "shape",
    "center",
    "radius",
    "name",
];
const PARAMETERS: [&str; 24] = [
    "number",
    "initial_number",
    "radius",
    "radius_distribution",
    "radius_std",
    "v0",
    "v0_distribution",
    "v0_std",
    "desired_speed",
    "desired_speed_distribution",
    "desired_speed_std",
    "distribution_mode",
    "percentage",
    "use_flow_spawning",
    "flow_start_time",
    "flow_end_time",
    "flow_schedule",
    "use_premovement",
    "premovement_distribution",
    "premovement_param_a",
    "premovement_param_b",
    "premovement_seed",
    "name",
    "type",
];
/// What JuPedSim's runner takes where a file says nothing: people, radius (m), speed (m/s), times of entry (s).
const NUMBER: u64 = 10;
const NUMBER_ON_FLOOR: u64 = 100;
const RADIUS: f64 = 0.2;
const SPEED: f64 = 1.2;
const ENTER_UNTIL: f64 = 10.0;
/// The bounds of normally distributed radii (m) and speeds (m/s).
const RADII: [f64; 2] = [0.1, 1.0];
const SPEEDS: [f64; 2] = [0.1, 5.0];
/// A full distribution covers this part of its area with bodies of at least this radius, meters.
const FULL: f64 = 0.5;
const LEAST_RADIUS: f64 = 0.1;
/// Crowds that cover a larger part of their area stand on a grid: so many do not fit at random places.
const DENSE: f64 = 0.35;

/// The crowds and entrances of a scenario.
#[derive(Debug, Default)]
pub struct People {
    pub crowds: Vec<Value>,
    pub entrances: Vec<Value>,
}

/// A time in which people enter, seconds, and their number.
type Window = (f64, f64, u64);

impl People {
    /// The people of a document.
    pub fn read(
        root: &Object,
        floor: &Floor,
        routes: &Routes,
        notes: &mut Notes,
    ) -> Result<Self, Problem> {
        let mut people = Self::default();
        let distributions = root.elements("distributions")?;
        if distributions.is_empty() {
            notes.add(format!(
                "there are no distributions: {NUMBER_ON_FLOOR} people stand anywhere in the walkable area"
            ));
            people.fill(floor);
        }
        for (id, distribution) in distributions {
            distribution.note_unknown(&DISTRIBUTION, notes);
            let parameters = distribution.object_or_empty("parameters")?;
            parameters.note_unknown(&PARAMETERS, notes);
            match floor.part(&distribution)? {
                Some(part) => people.add(id, &part, &parameters, routes, notes)?,
                None => notes.add(format!(
                    "distributions.{id} lies outside of the walkable area and is left out"
                )),
            }
        }
        Ok(people)
    }

    /// People anywhere in the walkable area.
    fn fill(&mut self, floor: &Floor) {
        let Some(area) = floor.largest() else {
            return;
        };
        let rings: Vec<crate::keys::shapes::Ring> = area.rings().map(Into::into).collect();
        self.crowds.push(json!({
            "area": rings, "number": NUMBER_ON_FLOOR, "radius": RADIUS, "preferred_speed": SPEED,
        }));
    }

    fn add(
        &mut self,
        id: &str,
        part: &Part,
        parameters: &Object,
        routes: &Routes,
        notes: &mut Notes,
    ) -> Result<(), Problem> {
        let radius = parameters.number("radius", 0.01)?.unwrap_or(RADIUS);
        let number = number(parameters, part, radius, notes)?;
        let (windows, initial) = windows(parameters, number)?;
        let traits = json!({
            "radius": drawn(parameters, "radius", radius, RADII)?,
            "preferred_speed": speed(parameters)?,
        });
        let covered = initial as f64 * std::f64::consts::PI * radius * radius / part.square_meters;
        let mut crowd = traits.clone();
        crowd["area"] = part.corners();
        if covered > DENSE {
            crowd["spacing"] = "grid".into();
        }
        if parameters.flag("use_premovement") {
            match initial {
                0 => notes.add(format!(
                    "distributions.{id}: people who enter during the run walk at once"
                )),
                _ => crowd["premovement_secs"] = premovement(parameters)?,
            }
            if parameters.says("premovement_seed") {
                notes.add("premovement_seed: `population_seed` is used in its place");
            }
        }
        for (journey, number) in split(&routes.from(id, false), initial) {
            let mut crowd = crowd.clone();
            crowd["number"] = number.into();
            self.crowds.push(named(crowd, id, journey));
        }
        for (from, until, number) in windows {
            for (journey, number) in split(&routes.from(id, true), number) {
                let mut entrance = traits.clone();
                entrance["line"] = ends(part.middle_line());
                entrance["from_secs"] = from.into();
                entrance["per_sec"] = (number as f64 / (until - from)).into();
                entrance["number"] = number.into();
                self.entrances.push(named(entrance, id, journey));
            }
        }
        Ok(())
    }
}

/// Keys of people with their name and journey.
fn named(mut keys: Value, id: &str, journey: Option<&str>) -> Value {
    keys["name"] = id.into();
    if let Some(journey) = journey {
        keys["name"] = format!("{id}, {journey}").into();
        keys["journey"] = journey.into();
    }
    keys
}

/// The number of people in a distribution.
fn number(
    parameters: &Object,
    part: &Part,
    radius: f64,
    notes: &mut Notes,
) -> Result<u64, Problem> {
    let mode = parameters.word("distribution_mode")?.unwrap_or("by_number");
    let default = match mode {
        "by_percentage" => 50.0,
        "fill_area" | "until_full" => 100.0,
        _ => {
            if mode != "by_number" {
                notes.add(format!(
                    "distribution_mode {mode} is unknown; `number` is used"
                ));
            }
            return Ok(parameters.whole("number")?.unwrap_or(NUMBER));
        }
    };
    let percentage = parameters.number("percentage", 0.0)?.unwrap_or(default);
    let body = std::f64::consts::PI * radius.max(LEAST_RADIUS).powi(2);
    let capacity = (FULL * (part.square_meters / body).floor())
        .floor()
        .max(1.0);
    Ok((capacity * percentage.floor().clamp(1.0, 100.0) / 100.0)
        .floor()
        .max(1.0) as u64)
}

/// The times in which people enter, and how many stand on the floor from the start.
fn windows(parameters: &Object, number: u64) -> Result<(Vec<Window>, u64), Problem> {
    let schedule = parameters.list("flow_schedule")?;
    let mut windows = Vec::new();
    for entry in &schedule {
        let time = |key, other| -> Result<Option<f64>, Problem> {
            Ok(entry.number(key, 0.0)?.or(entry.number(other, 0.0)?))
        };
        let [from, until] = [
            time("flow_start_time", "start_time_s")?,
            time("flow_end_time", "end_time_s")?,
        ];
        let number = entry.whole("number")?.or(entry.whole("sim_count")?);
        let (Some(from), Some(until), Some(number)) = (from, until, number) else {
            return Err(entry.problem("number", "needs flow_start_time, flow_end_time and number"));
        };
        if until <= from {
            return Err(entry.problem("flow_end_time", "must be later than flow_start_time"));
        }
        windows.push((from, until, number));
    }
    if !schedule.is_empty() {
        return Ok((windows, parameters.whole("initial_number")?.unwrap_or(0)));
    }
    if !parameters.flag("use_flow_spawning") {
        return Ok((
            windows,
            parameters.whole("initial_number")?.unwrap_or(number),
        ));
    }
    let from = parameters.number("flow_start_time", 0.0)?.unwrap_or(0.0);
    let until = parameters
        .number("flow_end_time", 0.0)?
        .unwrap_or(ENTER_UNTIL);
    if until <= from {
        return Err(parameters.problem("flow_end_time", "must be later than flow_start_time"));
    }
    Ok((vec![(from, until, number)], 0))
}

/// The people on each journey: rounded parts; the last journey has the rest.
fn split<'a>(journeys: &[(Option<&'a str>, f64)], number: u64) -> Vec<(Option<&'a str>, u64)> {
    let sum: f64 = journeys.iter().map(|(_, weight)| weight).sum();
    let mut rest = number;
    let last = journeys.len().saturating_sub(1);
    let parts = journeys.iter().enumerate().map(|(k, &(journey, weight))| {
        let share = (number as f64 * weight / sum).round_ties_even() as u64;
        let part = if k == last { rest } else { share.min(rest) };
        rest -= part;
        (journey, part)
    });
    parts.filter(|&(_, part)| part > 0).collect()
}

/// The preferred speed, by its present or former name.
fn speed(parameters: &Object) -> Result<Value, Problem> {
    let name = match parameters.says("desired_speed") {
        true => "desired_speed",
        false => "v0",
    };
    let mean = parameters.number(name, 0.0)?.unwrap_or(SPEED);
    let has_own = parameters.says(&format!("{name}_distribution"));
    let other = if has_own || name == "v0" { name } else { "v0" };
    drawn(parameters, other, mean, SPEEDS)
}

/// A trait: its mean, or a normal distribution.
fn drawn(
    parameters: &Object,
    name: &str,
    mean: f64,
    [min, max]: [f64; 2],
) -> Result<Value, Problem> {
    let key = format!("{name}_distribution");
    let std = parameters
        .number(&format!("{name}_std"), 0.0)?
        .unwrap_or(0.0);
    match parameters.word(&key)?.unwrap_or("constant") {
        "gaussian" if std > 0.0 => {
            let mean = mean.clamp(min, max);
            Ok(json!({"normal": {"mean": mean, "std": std, "min": min, "max": max}}))
        }
        "constant" | "gaussian" => Ok(mean.into()),
        _ => Err(parameters.problem(&key, "must be `constant` or `gaussian`")),
    }
}

/// The time until people walk.
fn premovement(parameters: &Object) -> Result<Value, Problem> {
    const KEY: &str = "premovement_distribution";
    let name = parameters.word(KEY)?.unwrap_or("gamma");
    let preset = match name {
        "gamma" => Some([1.291, 103.901]),
        "lognormal" => Some([4.586, 0.967]),
        "weibull" => Some([139.285, 1.195]),
        "uniform" => Some([0.0, 60.0]),
        "normal" => None,
        _ => {
            let reason = "must be `gamma`, `lognormal`, `weibull`, `uniform` or `normal`";
            return Err(parameters.problem(KEY, reason));
        }
    };
    let [a, b] = ["premovement_param_a", "premovement_param_b"];
    let both = parameters
        .number(a, f64::MIN)?
        .zip(parameters.number(b, f64::MIN)?);
    let given = both.map(|(a, b)| [a, b]).or(preset);
    let [a, b] = given.ok_or_else(|| parameters.problem(a, format!("is needed, and {b}")))?;
    Ok(match name {
        "gamma" => json!({"gamma": {"shape": a, "scale": b}}),
        "lognormal" => json!({"lognormal": {"log_mean": a, "log_std": b}}),
        "weibull" => json!({"weibull": {"scale": a, "shape": b}}),
        "normal" => json!({"normal": {"mean": a, "std": b, "min": 0.0}}),
        _ => json!({"uniform": [a, b]}),
    })
}
