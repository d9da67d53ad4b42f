//! Parameters: keys of scenarios, bounds, and the coordinate between 0 and 1 that is searched.

use serde_json::{Value, json};

use super::file::{ParameterKeys, Scale};
use crate::error::LabError;
use scenario::quote::shown;
use scenario::{Problem, Setting};

/// A parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// The keys that get its value; `*` stands for every element of a list.
    pub(super) keys: Vec<String>,
    /// The least and the largest value.
    pub bounds: [f64; 2],
    /// The value at which the search begins.
    pub start: f64,
    /// Whether the search leaves it there.
    pub frozen: bool,
    scale: Scale,
    /// Half the width of the uniform distribution around the value that the keys get; `None`: the keys get the value
    /// itself.
    half_width: Option<f64>,
}

impl Parameter {
    /// A checked parameter; `place` is its place in the file.
    pub(super) fn new(keys: ParameterKeys, place: &str) -> Result<Self, Problem> {
        let problem = |key: &str, reason: String| Problem::new(format!("{place}.{key}"), reason);
        let [low, high] = keys.bounds;
        if low >= high {
            let reason = format!("must be two numbers, the smaller one first, not [{low}, {high}]");
            return Err(problem("bounds", reason));
        }
        if keys.scale == Scale::Log && low <= 0.0 {
            let reason = format!("must be above 0 on a logarithmic scale, not {low}");
            return Err(problem("bounds[0]", reason));
        }
        if let Some(start) = keys.start.filter(|start| !(low..=high).contains(start)) {
            let reason = format!("must be within the bounds {low} and {high}, not {start}");
            return Err(problem("start", reason));
        }
        if keys.frozen && keys.start.is_none() {
            let reason = "must be given: a frozen parameter keeps it";
            return Err(problem("start", reason.to_owned()));
        }
        if let Some(half) = keys.half_width.filter(|half| *half <= 0.0) {
            return Err(problem(
                "half_width",
                format!("must be above 0, not {half}"),
            ));
        }
        check_text(&keys.name, &format!("{place}.name"))?;
        let paths = keys.keys.unwrap_or_else(|| vec![keys.name.clone()]);
        if paths.is_empty() {
            return Err(problem("keys", "must not be empty".to_owned()));
        }
        let mut parameter = Self {
            name: keys.name,
            keys: paths,
            bounds: keys.bounds,
            start: low,
            frozen: keys.frozen,
            scale: keys.scale,
            half_width: keys.half_width,
        };
        parameter.start = keys.start.unwrap_or_else(|| parameter.value(0.5));
        Ok(parameter)
    }

    /// The value at a coordinate, with six digits.
    pub fn value(&self, coordinate: f64) -> f64 {
        let [low, high] = self.bounds;
        let value = match self.scale {
            Scale::Linear => low + (high - low) * coordinate,
            Scale::Log => low * (high / low).powf(coordinate),
        };
        rounded(value).clamp(low, high)
    }

    /// The coordinate of a value: 0 and 1 at the bounds.
    pub fn coordinate(&self, value: f64) -> f64 {
        let [low, high] = self.bounds;
        match self.scale {
            Scale::Linear => (value - low) / (high - low),
            Scale::Log => (value / low).ln() / (high / low).ln(),
        }
    }

    /// The setting of its keys for a value.
    pub(super) fn written(&self, value: f64) -> Value {
        match self.half_width {
            None => json!(value),
            Some(half) => json!({"uniform": [rounded(value - half), rounded(value + half)]}),
        }
    }

    /// The settings that set the value in a scene with this document; empty if the scene has none of the keys.
    pub(super) fn settings(&self, value: f64, document: &Value) -> Result<Vec<Setting>, LabError> {
        let paths = self.keys.iter().flat_map(|key| places(key, document));
        let setting = |path: String| {
            let text = format!("{}={value}", shown(&self.name));
            let setting = Setting::new(&path, self.written(value), text);
            setting.map_err(|error| LabError::Data(error.to_string()))
        };
        paths.map(setting).collect()
    }
}

/// Six significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// The keys that a key with `*` stands for in a document: one for each element of the list before the `*`. A list that
/// the document lacks has no elements.
pub(super) fn places(key: &str, document: &Value) -> Vec<String> {
    let segments: Vec<&str> = key.split('.').collect();
    let Some(star) = segments.iter().position(|segment| *segment == "*") else {
        return vec![key.to_owned()];
    };
    let pointer = segments[..star].iter().map(|segment| format!("/{segment}"));
    let list = document.pointer(&pointer.collect::<String>());
    let count = list.and_then(Value::as_array).map_or(0, Vec::len);
    let element = |k: usize| {
        let number = k.to_string();
        let mut segments = segments.clone();
        segments[star] = &number;
        places(&segments.join("."), document)
    };
    (0..count).flat_map(element).collect()
}

/// Whether the name is short and printable.
pub(super) fn check_text(name: &str, place: &str) -> Result<(), Problem> {
    match !name.is_empty() && shown(name) == name {
        true => Ok(()),
        false => {
            let reason = "must have 1 to 80 characters, and no control characters";
            Err(Problem::new(place, reason))
        }
    }
}
