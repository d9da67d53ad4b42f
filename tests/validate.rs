//! Validation: scenes and their runs, means over seeds, and the command.

use std::fs;

use crate::common::pictures;
use crate::common::program::{refused, run, stderr, text};
use crate::common::tracks::file_of_a_row;
use sandbox::lab::suite::{Expected, Judgment};

#[test]
fn a_value_passes_within_the_tolerance_of_the_measured_one() {
    let expected = Expected::Near {
        value: Some(2.0),
        tolerance: 0.06,
    };
    let judgment = |value| Judgment {
        quantity: "flow".to_owned(),
        value,
        expected,
        run: None,
    };
    let is_passed = |value| judgment(Some(value)).is_passed();
    assert!(is_passed(2.12) && is_passed(1.88));
    assert!(!is_passed(2.13) && !is_passed(1.87));
    assert!(!judgment(None).is_passed());
    assert!((judgment(Some(3.0)).error().unwrap() - 0.5).abs() < 1e-12);
    assert_eq!(expected.to_string(), "2 ± 6 %");
    let deviation = |value| judgment(Some(value)).deviation().unwrap();
    assert!((deviation(2.12) - 1.0).abs() < 1e-12 && deviation(2.0) == 0.0);
    assert!((deviation(4.0) + deviation(1.0)).abs() < 1e-12);
    assert_eq!(judgment(None).deviation(), None);
}

#[test]
fn validate_judges_means_over_seeds() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("v");
    let csv = |seeds: &str| {
        let mut typed = vec!["validate", "door", "--profile", "sph", "--seeds", seeds];
        typed.extend(["--out", text(&out)]);
        let output = run(&typed);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        fs::read_to_string(out.join("validation.csv")).unwrap()
    };
    let flow = |csv: &str| -> f64 {
        let line = csv.lines().find(|line| line.contains("flow")).unwrap();
        line.split(',').nth(4).unwrap().parse().unwrap()
    };
    let one = flow(&csv("1"));
    let picture = fs::read_to_string(out.join("deviations.svg")).unwrap();
    for value in ["door: flow", "door: density", "door: speed"] {
        assert!(picture.contains(value), "{value}");
    }
    let both = csv("2");
    assert_eq!(both.matches("flow").count(), 1, "{both}");
    let cell = |seed: &str| {
        let scenario = "scenarios/validation/door.json";
        let seed = format!("seed={seed}");
        let output = run(&[
            "run",
            scenario,
            "--profile",
            "sph",
            "--set",
            &seed,
            "--json",
        ]);
        let result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        result["metrics"]["door_flow_per_s"].as_f64().unwrap()
    };
    assert!((one - cell("1")).abs() < 1e-9);
    assert!((flow(&both) - 0.5 * (cell("1") + cell("2"))).abs() < 1e-9);
    refused(&["validate", "gate"], 2, &["gate: no such case", "gap-2.4"]);
}

/// People who come one by one, one per second, and walk through the entrance at 1 m/s.
fn file_of_people() -> String {
    let mut text = "# framerate: 25 fps\n# id frame x/m y/m\n".to_owned();
    for person in 0..20 {
        for frame in 0..=120 {
            let y = 3.0 - f64::from(frame) / 25.0;
            text += &format!("{person} {} 0 {y}\n", 25 * person + frame);
        }
    }
    text
}

#[test]
fn scenes_with_data_are_compared_with_the_data_and_skipped_without() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("data");
    fs::create_dir(&data).unwrap();
    let out = folder.path().join("v");
    let report = || {
        fs::remove_dir_all(&out).ok();
        let mut typed = vec![
            "validate",
            "data-bottleneck",
            "data-corridor",
            "--profile",
            "sph",
        ];
        typed.extend(["--out", text(&out), "--data", text(&data)]);
        let output = run(&typed);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        fs::read_to_string(out.join("validation.md")).unwrap()
    };
    let none = report();
    assert!(
        none.contains("Skipped because data are missing: 2."),
        "{none}"
    );
    assert!(
        none.contains("040_c_56_h-.txt, from doi:10.34735/ped.2018.1"),
        "{none}"
    );
    assert!(!none.contains("Passed"), "{none}");

    fs::write(data.join("040_c_56_h-.txt"), file_of_people()).unwrap();
    let some = report();
    assert!(
        some.contains("Skipped because data are missing: 1."),
        "{some}"
    );
    // One person per second; each is 0.8 s in 0.64 m².
    for expected in ["flow [P/s] | 1 ± 6 %", "speed [m/s] | 1 ± 10 %"] {
        assert!(some.contains(expected), "{some}");
    }
    let density = some.lines().find(|line| line.contains("density")).unwrap();
    let density = density.split('|').nth(4).unwrap().trim();
    let density: f64 = density.split(' ').next().unwrap().parse().unwrap();
    assert!((density - 0.8 / 0.64).abs() < 0.15, "{density}");
    let texts = pictures::texts_of(&out.join("passages"));
    assert!(
        texts.iter().any(|text| text.contains("data bottleneck")),
        "{texts:?}"
    );
    let picture = image::open(out.join("data-bottleneck.png"))
        .unwrap()
        .to_rgb8();
    let marks = picture.pixels().filter(|pixel| pixel.0 != [255; 3]).count();
    assert!(marks > 1000, "{marks} pixels");

    let nowhere = folder.path().join("nowhere");
    refused(
        &["validate", "data-bottleneck", "--data", text(&nowhere)],
        2,
        &["--data", "nowhere", "give the folder"],
    );
}

#[test]
fn pushes_need_both_files_and_are_compared_with_them() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("data");
    fs::create_dir(&data).unwrap();
    let out = folder.path().join("v");
    let report = || {
        fs::remove_dir_all(&out).ok();
        let mut typed = vec!["validate", "data-push", "data-push-to-wall"];
        typed.extend(["--profile", "sph"]);
        typed.extend(["--out", text(&out), "--data", text(&data)]);
        let output = run(&typed);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        fs::read_to_string(out.join("validation.md")).unwrap()
    };
    fs::write(data.join("push_tue_15.csv"), file_of_a_row([0.8, 3.37])).unwrap();
    let alone = report();
    assert!(
        alone.contains("Skipped because data are missing: 2."),
        "{alone}"
    );
    assert!(alone.contains("has no push_tue_15.txt"), "{alone}");

    fs::write(
        data.join("push_tue_15.txt"),
        "TimeS Force\n0 0\n0.4 20\n0.6 0\n",
    )
    .unwrap();
    fs::write(data.join("push_wed_03.csv"), file_of_a_row([-0.1, -1.9])).unwrap();
    fs::write(data.join("push_wed_03.txt"), "0 0\n0.4 20\n0.6 0\n").unwrap();
    let both = report();
    assert!(!both.contains("Skipped"), "{both}");
    // 0.4 m per 0.16 s, and four people behind the first one who walk at 0.5 m/s at the same time.
    for expected in [
        "front, from six speeds [m/s] | 2.5 ± 20 %",
        "speeds passed on [m/s] | 2 ± 30 %",
        "top speed of person 5 [m/s] | 0.5 ± 30 %",
        "reach of person 1 [m] | 0.5 ± 30 %",
    ] {
        assert_eq!(both.matches(expected).count(), 2, "{expected}: {both}");
    }
}
