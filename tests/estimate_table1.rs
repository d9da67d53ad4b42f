//! `sandbox reproduce table1 --error`: rows of Table 1 as estimates beside the paper's values.

use std::path::Path;

use sandbox::lab::estimate::{Limits, Questions, Request, Sampling};
use sandbox::lab::reproduce::{estimated, published};
use sandbox::lab::sweep::Study;
use sandbox::runs::store::Store;

use crate::common::pictures;
use crate::common::program::refused;

/// Two rows of the table with fewer people, in another order than the paper's.
const ROWS: &str = r#"{
  "scenario": "evacuation", "seeds": 2,
  "settings": {"grids.0.columns": 7, "grids.0.rows": 7, "measurements.1.flow_of_first.arrivals": 30},
  "list": [{"profile": "sph", "rest_density_max": 5}, {"profile": "sf", "agent_stiffness": 50}]
}"#;

fn request(errors: &[&str]) -> Request {
    Request {
        wanted: errors.iter().map(|text| text.parse().unwrap()).collect(),
        bounds: Vec::new(),
        sampling: Sampling::Seeds,
        confidence: 0.95,
        limits: Limits {
            runs: 200,
            secs: None,
        },
    }
}

#[test]
fn rows_stand_beside_the_values_of_the_paper_that_they_belong_to() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path()).unwrap();
    let study = Study::parse(ROWS, Path::new("table1.json")).unwrap();
    let questions = Questions::new(&study, &request(&["flow_per_s=10%", "time_secs=10%"])).unwrap();
    let answers = questions.answer(&store, &()).unwrap();
    assert!(answers.missed().is_empty());
    let findings = estimated(&answers).unwrap();
    let parts = findings.document.parts("");
    let (name, text) = &parts[0];
    assert_eq!(name, "table1-estimate");
    let lines: Vec<&str> = text.lines().collect();
    let paper = published().table1.rows;
    for (line, (profile, setting)) in lines[2..]
        .iter()
        .zip([("sph", "rest_density_max"), ("sf", "agent_stiffness")])
    {
        let value = if profile == "sph" { 5.0 } else { 50.0 };
        let row = paper.iter().find(|row| {
            let varied = row.varied.as_ref().unwrap();
            row.profile == profile && varied.setting == setting && varied.value == value
        });
        let flow = format!("{:.2}", row.unwrap().flow);
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        assert_eq!(
            (cells[0], cells[2]),
            (profile.to_uppercase().as_str(), flow.as_str()),
            "{line}"
        );
        assert!(
            cells[3].contains(" ± ") && cells[4].ends_with(" %"),
            "{line}"
        );
        // The paper has no values of times.
        assert_eq!((cells[6], cells[9]), ("–", "–"), "{line}");
    }
    assert!(
        text.contains("of 2 values are inside their bands"),
        "{text}"
    );
    let written = findings.write(folder.path()).unwrap();
    let table = folder.path().join("table1-estimate.csv");
    assert!(written.contains(&table), "{written:?}");
    let texts = pictures::texts_of(&folder.path().join("table1-estimate"));
    assert!(texts.iter().any(|text| text.contains("sph")), "{texts:?}");
}

#[test]
fn only_table_1_has_rows_with_the_same_results() {
    let words = ["--error needs rows", "table1 alone"];
    let asked = ["--error", "flow_per_s=5%", "--out", "never"];
    refused(
        &[&["reproduce", "table1", "table2"], &asked[..]].concat(),
        2,
        &words,
    );
    refused(&[&["reproduce", "fig5"], &asked[..]].concat(), 2, &words);
    refused(
        &[&["reproduce", "table1", "--seeds", "2"], &asked[..]].concat(),
        2,
        &["--seeds"],
    );
    let unknown = [
        "reproduce",
        "table1",
        "--error",
        "density_mean_15=1%",
        "--out",
        "never",
    ];
    refused(&unknown, 2, &["cell 1", "did you mean", "density_mean_15s"]);
}

#[test]
fn options_of_scenarios_and_of_studies_without_errors_are_refused() {
    let asked = ["table1", "--error", "flow_per_s=5%", "--out", "never"];
    for (command, more, said) in [
        ("estimate", &["--shard", "1/2"][..], "'--shard'"),
        (
            "estimate",
            &["--profile", "sf"],
            "--profile sf: is for scenarios; table1 is a study",
        ),
        ("estimate", &["--plan"], "--plan: is for scenarios"),
        ("sweep", &["--shard", "1/2"], "without --shard"),
    ] {
        refused(&[&[command], &asked[..], more].concat(), 2, &[said]);
    }
}
