//! All settings of a scenario, those that it does not name included.

use serde_json::{Map, Value, json};

use crate::file::File;
use crate::file::schema::property;
use crate::keys::calibrated;
use crate::keys::catalog::Parameters;
use crate::keys::names::names;
use crate::read::scenario::Scenario;

impl Scenario {
    /// The [`document`](Scenario::document) with the defaults of the keys that it lacks, and the parameters of its
    /// default profile. `time_step_secs` is the step in seconds, and `integrator` its name, also where the document
    /// says `auto`.
    pub fn settings(&self) -> Value {
        let given = self.document.as_object().cloned().unwrap_or_default();
        let mut all = filled(names::<File>(), given);
        let calibrated = calibrated::named(&self.profile_name);
        let mut own = calibrated.map_or(Map::new(), |profile| profile.parameters.given().clone());
        let set = all.get("parameters").and_then(Value::as_object);
        own.extend(set.cloned().unwrap_or_default());
        let parameters = filled(names::<Parameters>(), own);
        all.insert("parameters".to_owned(), Value::Object(parameters));
        // A profile that is defined in full stays as it is.
        if !all.get("profile").is_some_and(Value::is_object) {
            all.insert("profile".to_owned(), json!(self.profile_name));
        }
        all.insert(
            "time_step_secs".to_owned(),
            json!(self.scene.clock.time_step()),
        );
        if let Some(width) = self.passage_width {
            all.insert("min_passage_width".to_owned(), json!(width));
        }
        all.insert("integrator".to_owned(), json!(self.scene.integrator));
        Value::Object(all)
    }
}

/// `given`, and the defaults of the other `keys` that have one.
fn filled(keys: &[&'static str], given: Map<String, Value>) -> Map<String, Value> {
    let is_given = |key: &str| given.get(key).is_some_and(|value| !value.is_null());
    let missing = keys.iter().filter(|key| !is_given(key));
    let defaults =
        missing.filter_map(|key| Some(((*key).to_owned(), property(key).get("default")?.clone())));
    let mut all: Map<String, Value> = defaults.collect();
    all.extend(given.into_iter().filter(|(_, value)| !value.is_null()));
    all
}
