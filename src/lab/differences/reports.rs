//! Differences between two results of runs.

use serde_json::{Map, Value};

use super::{Differences, different};

/// The keys of results that depend on the machine: they are not compared.
const OF_THE_MACHINE: [&str; 4] = ["threads", "ms_per_frame", "real_time_factor", "stages_ms"];
/// Keys that are compared by their contents, under the names of the contents.
const GROUPS: [&str; 1] = ["metrics"];
/// The key of the settings.
const SETTINGS: &str = "settings";

/// A JSON value is not the result of a run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("not the result of a run; write one with `sandbox run SCENARIO --json > FILE`")]
pub struct NotAReport {
    /// Which of the two it is: 0 or 1.
    pub which: usize,
}

/// The differences between two runs, as `--json` reports them. Run times are not compared.
///
/// # Errors
/// A value is not the result of a run.
pub fn of_reports(a: &Value, b: &Value) -> Result<Differences, NotAReport> {
    let [a, b] = [(a, 0), (b, 1)].map(|(report, which)| {
        let is_run = report["state_sha256"].is_string() && report["metrics"].is_object();
        let report = report.as_object().filter(|_| is_run);
        report.ok_or(NotAReport { which })
    });
    let (a, b) = (a?, b?);
    let mut differences = Differences::default();
    if let (Some(a), Some(b)) = (settings(a), settings(b)) {
        differences.settings = different(a, b).0;
    }
    let [a, b] = [a, b].map(results);
    differences.add_results(&a, &b);
    Ok(differences)
}

fn settings(report: &Map<String, Value>) -> Option<&Map<String, Value>> {
    report.get(SETTINGS)?.as_object()
}

/// The results, with measurements by their own names.
fn results(report: &Map<String, Value>) -> Map<String, Value> {
    let mut results = Map::new();
    for (key, value) in report {
        match value {
            Value::Object(group) if GROUPS.contains(&key.as_str()) => {
                results.extend(group.clone());
            }
            _ if key == SETTINGS || OF_THE_MACHINE.contains(&key.as_str()) => {}
            value => {
                results.insert(key.clone(), value.clone());
            }
        }
    }
    results
}
