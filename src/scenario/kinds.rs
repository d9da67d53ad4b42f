//! What a file is that was given in place of another one, and what to do with it.

use std::path::Path;

use serde_json::Value;

use crate::trajectories;

/// Endings of files that no command reads, with what they are.
const ENDINGS: [(&[&str], &str); 3] = [
    (
        &["dwg", "ifc"],
        "this format of CAD programs is not read: save it as DXF",
    ),
    (
        &["png", "jpg", "jpeg", "pdf", "svg", "gif"],
        "a picture is not read: give the outlines as DXF, GeoJSON, WKT or JuPedSim XML",
    ),
    (
        &["xlsx", "xls", "ods", "docx"],
        "this kind of file is not read: scenarios are JSON, plans DXF, GeoJSON, WKT or JuPedSim XML",
    ),
];
/// What trajectories and recordings are.
const RUN: &str = "holds a run that is over: `sandbox measure` and `sandbox draw` read it, and a scenario takes its \
                   people with `from`";

/// What a file with this name is, if it is neither a scenario nor a plan.
pub fn of_name(path: &Path) -> Option<&'static str> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    // Plans and scenarios may be text, too.
    if ending == "rrd" || (trajectories::has_ending(path) && ending != "txt") {
        return Some(RUN);
    }
    let mut known = ENDINGS.iter();
    let found = known.find(|(endings, _)| endings.contains(&ending.as_str()));
    found.map(|(_, what)| *what)
}

/// What a JSON document is, if it is not a scenario.
pub fn not_a_scenario(document: &Value) -> Option<&'static str> {
    let has = |key: &str| !document[key].is_null();
    let some = |keys: &[&str]| keys.iter().any(|key| has(key));
    let is_geojson = document["type"].is_string() && some(&["features", "geometry", "coordinates"]);
    match () {
        () if is_geojson => Some(
            "is a floor plan in GeoJSON, not a scenario: name it in the `walkable_area` of a scenario, or give it \
             with --geometry; a file that ends in .geojson can be drawn by itself",
        ),
        () if has("parameters") && has("fit") => {
            Some("is a calibration, not a scenario: `sandbox calibrate FILE` runs it")
        }
        () if has("scenario") && some(&["list", "grid", "seeds", "cases"]) => {
            Some("is a study, not a scenario: `sandbox sweep FILE` runs it")
        }
        () if has("state_sha256") && has("metrics") => Some(
            "is the result of a run, not a scenario: its `settings` are one; `sandbox compare A B` compares results",
        ),
        () if has("estimate") => {
            Some("is an estimate, not a scenario: `sandbox compare A B` compares two")
        }
        () => None,
    }
}

/// What a JSON document is that is given in place of a study, if it is neither that nor a scenario.
pub fn not_a_study(document: &Value) -> Option<&'static str> {
    let is_result = !document["state_sha256"].is_null() && !document["metrics"].is_null();
    is_result.then_some(
        "is the result of a run, not a study: its `settings` are a scenario; `sandbox compare A B` compares results",
    )
}

/// Whether a JSON document is a scenario, by its keys.
pub fn is_scenario(document: &Value) -> bool {
    const KEYS: [&str; 7] = [
        "walkable_area",
        "crowds",
        "grids",
        "agents",
        "exits",
        "sources",
        "entrances",
    ];
    let has = |key: &str| !document[key].is_null();
    !has("scenario") && !has("fit") && KEYS.iter().any(|key| has(key))
}
