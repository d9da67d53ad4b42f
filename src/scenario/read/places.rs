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
/// The key that says on which level an element lies.
const LEVEL: &str = "level";
/// The keys that have a geometry.
const KEYS: [&str; 7] = ["line", "area", "path", "at", "facing", "position", "goal"];

/// What the plan of a floor names.
#[derive(Debug, Default)]
pub struct Site {
    /// The level that has this floor; `None` without levels.
    pub level: Option<String>,
    pub places: Vec<Place>,
    /// Where lines across areas end.
    pub floor: Vec<Area>,
}

/// Replaces the names of places in `document` by their geometry. In a building, an element without `level` gets that of
/// the place that it names.
pub fn enter(document: &mut Value, sites: &[Site]) -> Result<(), Problem> {
    if sites.iter().all(|site| site.places.is_empty()) {
        return Ok(());
    }
    for (list, keys) in LISTS {
        let elements = document.get_mut(list).and_then(Value::as_array_mut);
        for (k, element) in elements.into_iter().flatten().enumerate() {
            let at = format!("{list}[{k}]");
            let mut plan = Plan::of(element, sites);
            plan.complete(element, keys)
                .and_then(|()| plan.replace(element))
                .map_err(|problem| problem.under(&at))?;
            plan.enter_level(element);
        }
    }
    for key in WITHIN {
        if let Some(value) = document.get_mut(key) {
            replace_in(key, value, sites).map_err(|problem| problem.under(key))?;
        }
    }
    Ok(())
}

/// Replaces names under a key at the top of a file: in each element of a list, and in each measurement, on its own.
fn replace_in(key: &str, value: &mut Value, sites: &[Site]) -> Result<(), Problem> {
    match value {
        Value::Array(list) => {
            for (k, one) in list.iter_mut().enumerate() {
                let at = format!("[{k}]");
                match (key, one) {
                    ("measurements", Value::Object(kinds)) => {
                        for (kind, one) in kinds {
                            let at = format!("{at}.{kind}");
                            replace_one(one, sites).map_err(|problem| problem.under(&at))?;
                        }
                    }
                    (_, one) => replace_one(one, sites).map_err(|problem| problem.under(&at))?,
                }
            }
            Ok(())
        }
        value if KEYS.contains(&key) => Plan::of(value, sites).given(key, value),
        value => Plan::of(value, sites).replace(value),
    }
}

fn replace_one(element: &mut Value, sites: &[Site]) -> Result<(), Problem> {
    let mut plan = Plan::of(element, sites);
    plan.replace(element)?;
    plan.enter_level(element);
    Ok(())
}

/// The places that an element may name.
struct Plan<'a> {
    sites: &'a [Site],
    /// The level of the element, as far as it is known.
    level: Option<String>,
}

impl<'a> Plan<'a> {
    fn of(element: &Value, sites: &'a [Site]) -> Self {
        let level = element.get(LEVEL).and_then(Value::as_str);
        Self {
            sites,
            level: level.map(str::to_owned),
        }
    }

    /// Gives an element the level of what it names.
    fn enter_level(self, element: &mut Value) {
        if let (Some(level), Some(keys)) = (self.level, element.as_object_mut()) {
            keys.insert(LEVEL.to_owned(), level.into());
        }
    }

    /// Gives an element of a list the geometry of the place that it names: one that is a name alone, or has no
    /// geometry.
    fn complete(&mut self, element: &mut Value, keys: &[&str]) -> Result<(), Problem> {
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
        if self.found(&name).is_empty() {
            return Ok(());
        }
        let (site, place) = self.place(&name)?;
        let key = match (keys, place.form) {
            ([_, point], Form::Point) => point,
            _ => &keys[0],
        };
        element[*key] = geometry(place, key, &site.floor)?;
        Ok(())
    }

    /// Replaces names under the keys of geometries, at any depth.
    fn replace(&mut self, value: &mut Value) -> Result<(), Problem> {
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
    fn given(&mut self, key: &str, value: &mut Value) -> Result<(), Problem> {
        let Value::String(name) = value else {
            return Ok(());
        };
        let (site, place) = self.place(name)?;
        *value = geometry(place, key, &site.floor)?;
        Ok(())
    }

    /// The places of this name, on the level of the element if that is known.
    fn found(&self, name: &str) -> Vec<(&'a Site, &'a Place)> {
        let on_level = |site: &&'a Site| self.level.is_none() || site.level == self.level;
        let sites = self.sites.iter().filter(on_level);
        let all = sites.flat_map(|site| site.places.iter().map(move |place| (site, place)));
        all.filter(|(_, place)| place.name == name).collect()
    }

    /// The place of this name, which determines the level of the element.
    fn place(&mut self, name: &str) -> Result<(&'a Site, &'a Place), Problem> {
        let wrong = |reason: String| Err(Problem::new("", reason));
        let found = self.found(name);
        let plan = match &self.level {
            Some(level) => format!("the plan of `{}`", shown(level)),
            None => "the plan".to_owned(),
        };
        match &found[..] {
            &[(site, place)] => {
                self.level = site.level.clone().or(self.level.take());
                Ok((site, place))
            }
            [] => {
                let mut elsewhere = self.sites.iter().filter(|site| {
                    let mut places = site.places.iter();
                    places.any(|place| place.name == name)
                });
                let near = match elsewhere.next() {
                    Some(Site {
                        level: Some(level), ..
                    }) => format!("; that of `{}` has one", shown(level)),
                    _ => {
                        let places = self.sites.iter().flat_map(|site| &site.places);
                        suggestion(name, places.map(|place| place.name.as_str()))
                    }
                };
                let listed = match self.sites.iter().any(|site| site.level.is_some()) {
                    true => "",
                    false => "; `sandbox draw` of the plan lists them",
                };
                wrong(format!(
                    "{plan} has no place with the name `{}`{near}{listed}",
                    shown(name)
                ))
            }
            [(first, _), others @ ..]
                if others.iter().any(|(site, _)| site.level != first.level) =>
            {
                let mut levels: Vec<String> = found
                    .iter()
                    .filter_map(|(site, _)| Some(format!("`{}`", shown(site.level.as_ref()?))))
                    .collect();
                levels.dedup();
                wrong(format!(
                    "`{}` is a place on the levels {}: give `level`, too",
                    shown(name),
                    levels.join(", ")
                ))
            }
            all => wrong(format!(
                "{plan} has {} places with the name `{}`; give each a name of its own",
                all.len(),
                shown(name)
            )),
        }
    }
}

/// The geometry of a place, as a key has it. Lines across areas end at the walls of `floor`.
fn geometry(place: &Place, key: &str, floor: &[Area]) -> Result<Value, Problem> {
    let first = place.rings.first().map_or(&[][..], Vec::as_slice);
    let found = match (key, place.form) {
        ("line", Form::Line) if first.len() == 2 => Some(json!(first)),
        ("line", Form::Area) => across(place, floor).map(|ends| json!(ends.map(<[f64; 2]>::from))),
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

/// The middle of the rectangle around a place, meters.
fn middle(place: &Place) -> Vector {
    let [low, high] = place.extent();
    (low + high) * 0.5
}
