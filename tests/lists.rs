//! `sandbox list`: its tables on pages of the documentation, and its JSON.

use std::fs;

use serde_json::Value;

use crate::common::program::{refused, run, run_json, stderr};

#[test]
fn the_pages_hold_what_the_lists_write_into_them() {
    let folder = tempfile::tempdir().unwrap();
    for (list, page) in [
        ("--measurements", "measurements.md"),
        ("--settings", "settings.md"),
    ] {
        let path = format!("docs/reference/{page}");
        let copy = folder.path().join(page);
        fs::copy(&path, &copy).unwrap();
        let output = run(&["list", list, "--update", copy.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let [kept, written] =
            [path.as_ref(), copy.as_path()].map(|file| fs::read_to_string(file).unwrap());
        for (k, (kept, written)) in kept.lines().zip(written.lines()).enumerate() {
            let command = format!("sandbox list {list} --update {path}");
            assert_eq!(
                kept,
                written,
                "{path}, line {}: `{command}` writes the right",
                k + 1
            );
        }
        assert_eq!(kept, written, "{path}");
    }
}

#[test]
fn nested_keys_are_listed_in_short_and_in_full() {
    let lists = run_json(&["list", "--settings", "--json"]);
    let short = lists["nested"].as_object().unwrap();
    let full = lists["objects"].as_array().unwrap();
    assert_eq!(short.len(), full.len());
    for object in full {
        let names = short[object["object"].as_str().unwrap()].as_str().unwrap();
        for doc in object["keys"].as_array().unwrap() {
            let key = doc["key"].as_str().unwrap();
            let shown = match doc["presence"].as_str().unwrap() {
                "optional" => format!("{key}?"),
                _ => key.to_owned(),
            };
            let words = names.strip_prefix("one of ").unwrap_or(names);
            let mut words = words.split(", ").flat_map(|word| word.split(" or "));
            assert!(words.any(|word| word == shown), "{shown}: {names}");
        }
    }
    let settings = lists["settings"].as_array().unwrap();
    let is_optional = |doc: &Value| doc["presence"] == "optional";
    assert!(settings.iter().all(is_optional));
}

#[test]
fn a_document_is_updated_by_a_list_with_a_table() {
    let words = "--update page.md: inserts the tables of --settings or of --measurements; give one of them, too";
    refused(&["list", "--update", "page.md"], 2, &[words]);
}
