//! Verification: cases and their runs, judgments, and the command.

use std::fs;

use crate::common::program::{refused, run, stderr, text};
use sandbox::lab::suite::{Case, Changed, Expected, Finding, Judgment, Report, Suite};

fn verification() -> Suite {
    Suite::built_in("verification").unwrap()
}

fn named<'a>(suite: &'a Suite, name: &str) -> &'a Case {
    suite.cases.iter().find(|case| case.name == name).unwrap()
}

#[test]
fn cases_are_chosen_by_name_or_number() {
    let suite = verification();
    let names = |names: &[&str]| -> Vec<&str> {
        let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
        let chosen = suite.chosen(&names).unwrap().into_iter();
        chosen.map(|case| case.name.as_str()).collect()
    };
    assert_eq!(names(&["12"]), ["12a", "12b", "12c", "12d"]);
    assert_eq!(names(&["iso1", "1"]), ["1", "iso1"]);
    assert_eq!(names(&["12c"]), ["12c"]);
    assert_eq!(names(&[]).len(), suite.cases.len());
    let unknown = suite.chosen(&["6".to_owned(), "17".to_owned()]).err();
    assert_eq!(unknown, Some("17".to_owned()));
}

fn judgment(value: Option<f64>, expected: Expected) -> Judgment {
    Judgment {
        quantity: "time [s]".to_owned(),
        value,
        expected,
        run: None,
    }
}

#[test]
fn a_value_passes_inside_of_its_range_ends_included() {
    let between = |value| judgment(value, Expected::Between([1.0, 2.0])).is_passed();
    assert!(between(Some(1.0)) && between(Some(2.0)) && between(Some(1.5)));
    assert!(!between(Some(0.999)) && !between(Some(2.001)) && !between(None));
    assert!(!between(Some(f64::NAN)));
    let at_most = Expected::Between([f64::NEG_INFINITY, 0.0]);
    assert!(judgment(Some(-1e9), at_most).is_passed());
    let at_least = Expected::Between([0.0, f64::INFINITY]);
    assert!(!judgment(Some(-1e-3), at_least).is_passed());
    assert!(judgment(None, Expected::Any).is_passed());
}

/// A report of one case with one value by `sph`, expected to be at most 10.
fn report<'a>(suite: &'a Suite, case: &'a Case, value: f64) -> Report<'a> {
    let at_most = Expected::Between([f64::NEG_INFINITY, 10.0]);
    Report {
        skipped: Vec::new(),
        changed: Changed::default(),
        suite,
        profiles: vec!["sph".to_owned()],
        findings: vec![Finding {
            case,
            profile: "sph".to_owned(),
            seed: Some(1),
            checks: vec![judgment(Some(value), at_most)],
        }],
        figures: Vec::new(),
    }
}

#[test]
fn a_miss_fails_unless_it_is_known_and_a_known_one_that_passes_is_told() {
    let suite = verification();
    let (passing, missing) = (named(&suite, "6"), named(&suite, "4"));
    assert!(missing.known_misses.contains_key("sph") && passing.known_misses.is_empty());
    let report = |case, value| report(&suite, case, value);
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
    let findings = report(missing, 11.0).findings().unwrap();
    let (_, text) = findings.document.parts("verification").remove(0);
    assert!(text.contains("**11**"), "{text}");
    let mut other = report(passing, 11.0);
    other.findings[0].profile = "sf".to_owned();
    assert!(other.failures().is_empty());
}

#[test]
fn verify_judges_the_chosen_cases_and_draws_them() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("v");
    let out_text = text(&out).to_owned();
    let output = run(&["verify", "6", "iso9", "--out", &out_text]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let printed = String::from_utf8(output.stdout).unwrap();
    let written = fs::read_to_string(out.join("verification.md")).unwrap();
    for text in [&printed, &written] {
        assert!(
            text.contains("Passed by sph: 2 of 2 cases, by sf->sph: 2 of 2 cases"),
            "{text}"
        );
    }
    assert!(written.starts_with("# Results of the suite verification\n\nPassed by"));
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
    refused(&["verify", "17"], 2, &["17: no such case", "12a", "iso13"]);
    let unknown = ["verify", "6", "--profile", "sphh"];
    refused(&unknown, 2, &["sphh"]);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("table.md");
    fs::write(&file, "<!-- verification -->\n<!-- /verification -->\n").unwrap();
    let update = ["verify", "6", "--update", text(&file)];
    refused(&update, 2, &["--update needs all cases and profiles"]);
}
