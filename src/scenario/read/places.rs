//! Names of a plan's areas, lines and points in a scenario: they are replaced by their geometry.

use serde_json::{Value, json};

use crate::error::quote::shown;
use crate::error::{Problem, suggestion};
use crate::floor_plan::{Form, Place, across};
use engine::geometry::Area;
use engine::math::Vector;

/// The lists whose elements may be names, and the keys that their geometry has.
const LISTS: [(&str, &[&str]); 8] = [
    ("exits", &["line"]),
    ("doors", &["line"]),
    ("entrances", &["line"]),
    ("waypoints", &["line", "at"]),
    ("waiting_areas", &["area"]),
    ("queues", &["path"]),
    ("zones", &["area"]),
    ("crowds", &["area"]),
];
/// The keys at the top of a file in which a name may stand for a geometry.
const WITHIN: [&str; 6] = [
    "goal",
    "grids",
    "agents",
    "sources",
    "measurements",
    "labels",
];
/// The keys that have a geometry.
const KEYS: [&str; 7] = ["line", "area", "path", "at", "facing", "position", "goal"];

/// Replaces the names of `places` in `document` by their geometry. Lines across areas end at the walls of `floor`.
pub fn enter(document: &mut Value, places: &[Place], floor: &[Area]) -> Result<(), Problem> {
    if places.is_empty() {
        return Ok(());
    }
    let plan = Plan { places, floor };
    for (list, keys) in LISTS {
        let elements = document.get_mut(list).and_then(Value::as_array_mut);
        for (k, element) in elements.into_iter().flatten().enumerate() {
            let at = format!("{list}[{k}]");
            plan.complete(element, keys)
                .map_err(|problem| problem.under(&at))?;
            plan.replace(element)
                .map_err(|problem| problem.under(&at))?;
        }
    }
    for key in WITHIN {
        if let Some(value) = document.get_mut(key) {
            let given = if KEYS.contains(&key) {
                plan.given(key, value)
            } else {
                plan.replace(value)
            };
            given.map_err(|problem| problem.under(key))?;
        }
    }
    Ok(())
}

struct Plan<'a> {
    places: &'a [Place],
    floor: &'a [Area],
}

impl Plan<'_> {
    /// Gives an element of a list the geometry of the place that it names: one that is a name alone, or has no
    /// geometry.
    fn complete(&self, element: &mut Value, keys: &[&str]) -> Result<(), Problem> {
        if let Value::String(name) = element {
            self.place(name)?;
            *element = json!({ "name": name.clone() });
        }
        let has_geometry = keys.iter().any(|key| element.get(key).is_some());
        let name = element
            .get("name")
            .and_then(Value::as_str)
            .map(str::to_owned);
        let Some(name) = name.filter(|_| !has_geometry) else {
            return Ok(());
        };
        let is_there = self.places.iter().any(|place| place.name == name);
        if !is_there {
            return Ok(());
        }
        let place = self.place(&name)?;
        let key = match (keys, place.form) {
            ([_, point], Form::Point) => point,
            _ => &keys[0],
        };
        element[*key] = self.geometry(place, key)?;
        Ok(())
    }

    /// Replaces names under the keys of geometries, at any depth.
    fn replace(&self, value: &mut Value) -> Result<(), Problem> {
        match value {
            Value::Array(list) => {
                for (k, one) in list.iter_mut().enumerate() {
                    self.replace(one)
                        .map_err(|problem| problem.under(&format!("[{k}]")))?;
                }
            }
            Value::Object(keys) => {
                for (key, one) in keys {
                    let given = if KEYS.contains(&key.as_str()) {
                        self.given(key, one)
                    } else {
                        self.replace(one)
                    };
                    given.map_err(|problem| problem.under(key))?;
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Replaces a name under the key of a geometry.
    fn given(&self, key: &str, value: &mut Value) -> Result<(), Problem> {
        let Value::String(name) = value else {
            return Ok(());
        };
        *value = self.geometry(self.place(name)?, key)?;
        Ok(())
    }

    /// The place of this name.
    fn place(&self, name: &str) -> Result<&Place, Problem> {
        let mut found = self.places.iter().filter(|place| place.name == name);
        let wrong = |reason: String| Problem::new("", reason);
        match (found.next(), found.count()) {
            (Some(place), 0) => Ok(place),
            (Some(_), others) => Err(wrong(format!(
                "the plan has {} places with the name `{}`; give each a name of its own",
                others + 1,
                shown(name)
            ))),
            (None, _) => {
                let known = self.places.iter().map(|place| place.name.as_str());
                let near = suggestion(name, known);
                Err(wrong(format!(
                    "the plan has no place with the name `{}`{near}; `sandbox draw` of the plan lists them",
                    shown(name)
                )))
            }
        }
    }

    /// The geometry of a place, as a key has it.
    fn geometry(&self, place: &Place, key: &str) -> Result<Value, Problem> {
        let first = place.rings.first().map_or(&[][..], Vec::as_slice);
        let found = match (key, place.form) {
            ("line", Form::Line) if first.len() == 2 => Some(json!(first)),
            ("line", Form::Area) => {
                across(place, self.floor).map(|ends| json!(ends.map(<[f64; 2]>::from)))
            }
            ("area", Form::Area) if place.rings.len() == 1 => Some(json!(first)),
            ("area", Form::Area) => Some(json!(place.rings)),
            ("path", Form::Line) => Some(json!(first)),
            ("line" | "area" | "path", _) => None,
            (_, Form::Point) => first.first().map(|point| json!(point)),
            (_, Form::Area) => {
                let middle: [f64; 2] = middle(place).into();
                Some(json!(middle))
            }
            _ => None,
        };
        found.ok_or_else(|| {
            let form = match place.form {
                Form::Area => "an area",
                Form::Line if first.len() > 2 => "a line with bends",
                Form::Line => "a line",
                Form::Point => "a point",
            };
            let reason = format!(
                "`{}` is {form} of the plan; `{key}` needs another form",
                shown(&place.name)
            );
            Problem::new("", reason)
        })
    }
}

/// The middle of the rectangle around a place, meters.
fn middle(place: &Place) -> Vector {
    let [low, high] = place.extent();
    (low + high) * 0.5
}
