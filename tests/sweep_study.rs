//! Study files: their cells, the order of these, and the messages for broken files.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use proptest::prelude::*;
use sandbox::lab::sweep::{Cell, Shard, Study};
use sandbox::scenario::{Scenario, Setting};
use serde::Deserialize;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::sweep::folder;

/// Three people who walk freely.
const SCENARIO: &str = r#"{"goal": [10, 0], "profile": "sph", "duration_secs": 1,
    "grids": [{"min": [0, 0], "max": [3, 1], "columns": 3, "rows": 1}]}"#;

/// Reads a text as a study, in `folder` next to the scenario `walk.json`.
fn read(folder: &Path, text: &str) -> Result<Study, String> {
    fs::write(folder.join("walk.json"), SCENARIO).unwrap();
    let path = folder.join("study.json");
    fs::write(&path, text).unwrap();
    let place = format!("{}/", folder.display());
    Study::read(&path, None).map_err(|error| error.to_string().replace(&place, ""))
}

/// A study, and the folder of its scenario.
fn study(document: &Value) -> (Study, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let study = read(folder.path(), &document.to_string()).unwrap();
    (study, folder)
}

/// Number, values in the order of the axes, and seed.
fn row(cell: &Cell) -> (usize, Vec<Value>, u64) {
    let values = cell.values.iter().map(|(_, value)| value.clone());
    (cell.number, values.collect(), cell.case.seed)
}

#[test]
fn the_first_axis_changes_slowest_and_seeds_change_fastest() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"{"scenario": "walk.json", "seeds": [7, 3],
        "grid": {"viscosity": [1, 0], "profile": ["sf", "sf->sph"]}}"#;
    let study = read(folder.path(), text).unwrap();
    assert_eq!(
        study.axes,
        ["viscosity", "profile"],
        "as written, not by the alphabet"
    );
    let rows: Vec<_> = study.cells.iter().map(row).collect();
    let expected = [
        (1, "sf", 7),
        (1, "sf", 3),
        (1, "sf->sph", 7),
        (1, "sf->sph", 3),
    ];
    for (k, (viscosity, profile, seed)) in expected.into_iter().enumerate() {
        assert_eq!(
            rows[k],
            (k + 1, vec![json!(viscosity), json!(profile)], seed)
        );
    }
    assert_eq!(rows[4], (5, vec![json!(0), json!("sf")], 7));
    assert_eq!(rows.len(), 8);
}

#[test]
fn a_list_a_grid_and_seeds_multiply() {
    let (study, _folder) = study(&json!({
        "scenario": "walk.json",
        "settings": {"viscosity": 2, "max_speed": 2},
        "list": [{}, {"viscosity": 5}, {"gas_constant": 100, "viscosity": 5}],
        "grid": {"preferred_speed": [1, 1.5]},
        "seeds": 2
    }));
    assert_eq!(study.cells.len(), 12);
    assert_eq!(study.axes, ["viscosity", "gas_constant", "preferred_speed"]);
    let of = |number: usize, key: &str| {
        let document = study.cells[number - 1].case.scenario().unwrap().document;
        document.pointer(&format!("/{key}")).cloned()
    };
    assert_eq!(of(1, "parameters/viscosity"), Some(json!(2)), "as for all");
    assert_eq!(
        of(5, "parameters/viscosity"),
        Some(json!(5)),
        "the list goes before"
    );
    assert_eq!(of(5, "parameters/gas_constant"), None);
    assert_eq!(of(12, "parameters/gas_constant"), Some(json!(100)));
    assert_eq!(of(12, "preferred_speed"), Some(json!(1.5)));
    assert_eq!(of(12, "seed"), Some(json!(2)));
    let keys: BTreeSet<_> = study.cells.iter().map(|cell| &cell.case.key).collect();
    assert_eq!(keys.len(), 12, "all are different");
}

#[test]
fn a_study_without_variations_is_one_cell_with_the_seed_of_the_scenario() {
    let (study, _folder) = study(&json!({"scenario": "walk.json", "settings": {"seed": 9}}));
    assert_eq!(study.cells.len(), 1);
    assert_eq!(study.cells[0].case.seed, 9);
    assert_eq!(study.cells[0].to_string(), "cell 1: seed=9");
}

#[test]
fn a_cell_equals_the_scenario_with_the_same_set_options() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"{"scenario": "walk.json", "seeds": [4],
        "grid": {"profile": ["rvo"], "grids.0.columns": [5], "population_seed": [8]}}"#;
    let study = read(folder.path(), text).unwrap();
    let settings = [
        "profile=rvo",
        "grids.0.columns=5",
        "population_seed=8",
        "seed=4",
    ];
    let settings: Vec<Setting> = settings.iter().map(|text| text.parse().unwrap()).collect();
    let scenario = Scenario::load(&folder.path().join("walk.json"), &settings).unwrap();
    assert_eq!(
        study.cells[0].case.scenario().unwrap().document,
        scenario.document
    );
}

#[test]
fn the_scenario_may_be_varied_too() {
    let (study, _folder) = study(&json!({
        "grid": {"scenario": ["walk.json", "evacuation"]},
        "settings": {"duration_secs": 2}
    }));
    let names = study
        .cells
        .iter()
        .map(|cell| cell.case.scenario().unwrap().name);
    assert_eq!(names.collect::<Vec<_>>(), ["walk", "evacuation"]);
}

#[test]
fn the_key_of_a_cell_depends_only_on_its_scenario() {
    let (varied, _folder) =
        study(&json!({"scenario": "walk.json", "grid": {"viscosity": [1, 2]}, "seeds": 2}));
    let (fixed, _other) = study(&json!({
        "scenario": "walk.json", "name": "other",
        "settings": {"viscosity": 2}, "seeds": [2]
    }));
    assert_eq!(fixed.cells[0].case.key, varied.cells[3].case.key);
    assert_ne!(fixed.cells[0].case.key, varied.cells[2].case.key);
}

proptest! {
    #[test]
    fn every_cell_is_in_exactly_one_shard(of in 1_usize..40, cell in 1_usize..1000) {
        let having = (1..=of).filter(|&number| Shard::new(number, of).unwrap().has(cell));
        prop_assert_eq!(having.count(), 1);
    }
}

#[test]
fn shards_have_similar_sizes_and_begin_with_the_cell_of_their_number() {
    for of in 1..=12 {
        let sizes = (1..=of).map(|number| {
            let shard: Shard = format!("{number}/{of}").parse().unwrap();
            assert!(shard.has(number));
            (1..=100).filter(|&cell| shard.has(cell)).count()
        });
        let sizes: BTreeSet<usize> = sizes.collect();
        assert!(sizes.last().unwrap() - sizes.first().unwrap() <= 1);
    }
    for wrong in ["0/3", "4/3", "1/0", "1", "a/b", "-1/3", "1/3/4", ""] {
        let said = wrong.parse::<Shard>().unwrap_err();
        assert_eq!(
            said, "not a shard i/n with 1 ≤ i ≤ n, such as 2/8",
            "{wrong}"
        );
    }
}

/// A broken study and the expected message.
#[derive(Deserialize)]
struct Broken {
    study: Value,
    message: String,
}

#[test]
fn every_broken_study_is_reported_with_its_place_and_reason() {
    let folder = tempfile::tempdir().unwrap();
    let cases: Vec<Broken> =
        serde_json::from_str(include_str!("data/broken_studies.json")).unwrap();
    for Broken { study, message } in cases {
        let said = read(folder.path(), &study.to_string()).err();
        assert_eq!(said, Some(message), "{study}");
    }
}

#[test]
fn invalid_json_is_reported_with_line_and_column() {
    let folder = tempfile::tempdir().unwrap();
    let said = |text: &str| read(folder.path(), text).err().unwrap();
    assert_eq!(
        said("{\"scenario\": \"evacuation\",\n \"seeds\": 2,}"),
        "study.json: line 2, column 13: a comma before a closing bracket; remove it"
    );
    assert_eq!(
        said("{\"grid\": {\"seed\": [1],\n \"seed\": [2]}}"),
        "study.json: line 2, column 7: key `seed` is given twice; remove one"
    );
    let missing = Study::read(&folder.path().join("no.json"), None).unwrap_err();
    assert!(missing.to_string().contains("no.json: No such file"));
}

#[test]
fn a_broken_scenario_is_named_with_its_file() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.json"), r#"{"max_speed": 0}"#).unwrap();
    assert_eq!(
        read(folder.path(), r#"{"scenario": "bad.json"}"#).unwrap_err(),
        "study.json: cell 1: bad.json: max_speed: must be above 0 and at most 100, not 0"
    );
}

#[test]
fn a_cell_that_does_not_fit_into_memory_is_refused_before_anything_is_computed() {
    let text = r#"{"scenario": "room.json", "grid": {"grids.0.columns": [3, 2000], "grids.0.max.0": [900]}}"#;
    let (_folder, path) = folder(text);
    let all = Study::read(&path, Some(1 << 30)).unwrap();
    let [small, large] = [0, 1].map(|cell| all.cells[cell].case.need.bytes());
    assert!(large > small + 2_000_000, "{small} {large}");
    let error = Study::read(&path, Some(large - 1)).unwrap_err().to_string();
    assert!(error.contains(": cell 2: "), "{error}");
    assert!(
        error.contains("6000 agents and 4 walls would take "),
        "{error}"
    );
    assert!(error.contains(", and this machine has "), "{error}");
    assert!(Study::read(&path, Some(large)).is_ok());
}
