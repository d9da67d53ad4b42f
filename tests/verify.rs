//! Verification: cases and their runs, judgments, and the command.

use std::collections::BTreeSet;
use std::fs;

use crate::common::program::{refused, run, stderr, text};
use sandbox::lab::suite::{Case, Check, Finding, Report};
use sandbox::lab::sweep::Study;
use sandbox::lab::verify::VERIFICATION;

fn named(id: &str) -> &'static Case {
    VERIFICATION.all().find(|case| case.id == id).unwrap()
}

#[test]
fn the_cases_use_all_runs_of_the_study_and_no_others() {
    let study = Study::built_in("verification", None, None).unwrap();
    let known: BTreeSet<&str> = study.cells.iter().filter_map(|cell| cell.label()).collect();
    let used: BTreeSet<&str> = VERIFICATION
        .all()
        .flat_map(|case| case.runs)
        .copied()
        .collect();
    assert_eq!(used, known);
    assert_eq!(
        study.document["grid"]["profile"],
        serde_json::json!(VERIFICATION.profiles)
    );
    for case in VERIFICATION.all() {
        assert!(case.runs.contains(&case.picture.0), "{}", case.id);
        let mut misses = case.misses.iter();
        assert!(
            misses.all(|(profile, why)| VERIFICATION.profiles.contains(profile) && !why.is_empty())
        );
    }
    let ids: BTreeSet<&str> = VERIFICATION.all().map(|case| case.id).collect();
    assert_eq!(ids.len(), VERIFICATION.all().count());
}

#[test]
fn cases_are_chosen_by_id_or_number() {
    let ids = |names: &[&str]| -> Vec<&str> {
        let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
        VERIFICATION
            .chosen(&names)
            .unwrap()
            .iter()
            .map(|case| case.id)
            .collect()
    };
    assert_eq!(ids(&["12"]), ["12a", "12b", "12c", "12d"]);
    assert_eq!(ids(&["iso1", "1"]), ["1", "iso1"]);
    assert_eq!(ids(&["12c"]), ["12c"]);
    assert_eq!(ids(&[]).len(), VERIFICATION.all().count());
    assert_eq!(
        VERIFICATION.chosen(&["6".to_owned(), "8".to_owned()]).err(),
        Some("8".to_owned())
    );
}

#[test]
fn a_value_passes_inside_of_its_range_ends_included() {
    let between = |value| Check::between("x", value, 1.0, 2.0).is_passed();
    assert!(between(Some(1.0)) && between(Some(2.0)) && between(Some(1.5)));
    assert!(!between(Some(0.999)) && !between(Some(2.001)) && !between(None));
    assert!(!between(Some(f64::NAN)));
    assert!(Check::at_most("x", Some(-1e9), 0.0).is_passed());
    assert!(!Check::at_least("x", Some(-1e-3), 0.0).is_passed());
    assert!(Check::reported("x", None).is_passed());
}

/// A report of one case with one value by `sph`.
fn report(case: &'static Case, value: f64) -> Report {
    Report {
        skipped: Vec::new(),
        suite: &VERIFICATION,
        profiles: vec!["sph".to_owned()],
        findings: vec![Finding {
            case,
            profile: "sph".to_owned(),
            seed: Some(1),
            checks: vec![Check::at_most("time [s]", Some(value), 10.0)],
        }],
    }
}

#[test]
fn a_miss_fails_unless_it_is_known_and_a_known_one_that_passes_is_told() {
    let (passing, missing) = (named("6"), named("4"));
    assert!(missing.known_miss("sph").is_some() && passing.known_miss("sph").is_none());
    assert_eq!(report(passing, 9.0).failures(), [""; 0]);
    let failures = report(passing, 11.0).failures();
    assert_eq!(
        failures,
        ["case 6, sph, seed 1: time [s] is 11, expected at most 10"]
    );
    assert!(report(missing, 11.0).failures().is_empty());
    assert!(report(missing, 11.0).no_longer_missed().is_empty());
    assert_eq!(
        report(missing, 9.0).no_longer_missed(),
        ["case 4, sph: passes now"]
    );
    assert!(report(missing, 11.0).markdown().contains("**11**"));
    let mut other = report(passing, 11.0);
    other.findings[0].profile = "sf".to_owned();
    assert!(other.failures().is_empty());
}

#[test]
fn verify_judges_the_chosen_cases_and_draws_them() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("v");
    let out_text = text(&out).to_owned();
    let output = run(&[
        "verify", "--only", "6", "--only", "iso9", "--out", &out_text,
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let printed = String::from_utf8(output.stdout).unwrap();
    let written = fs::read_to_string(out.join("verification.md")).unwrap();
    assert_eq!(printed.trim(), written.trim());
    assert!(
        printed.starts_with("Passed by sph: 2 of 2 cases"),
        "{printed}"
    );
    assert!(printed.contains("In no run did anyone pass through a wall."));
    for picture in ["6.png", "iso9.png"] {
        assert!(out.join(picture).exists(), "{picture}");
    }
    let csv = fs::read_to_string(out.join("verification.csv")).unwrap();
    assert!(
        csv.lines()
            .any(|line| line.starts_with("6,sf->sph,1,people out,20,20,20,true")),
        "{csv}"
    );
}

#[test]
fn unknown_cases_and_tables_of_some_cases_are_refused() {
    refused(
        &["verify", "--only", "8"],
        2,
        &["--only 8: no such case", "12a", "iso13"],
    );
    let unknown = ["verify", "--only", "6", "--profile", "sphh"];
    refused(&unknown, 2, &["sphh"]);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("table.md");
    fs::write(&file, "<!-- verification -->\n<!-- /verification -->\n").unwrap();
    let update = ["verify", "--only", "6", "--update", text(&file)];
    refused(&update, 2, &["--update needs all cases and profiles"]);
}
