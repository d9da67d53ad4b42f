//! `sandbox compare`: what differs between two results. Results hold their settings.

use std::path::Path;

use sandbox::lab::differences::{Difference, Differences, NotAReport, of_reports, of_tracks};
use sandbox::lab::reproduce::published_for;
use sandbox::scenario::trajectories::{OnLevel, ReadOptions, read_text};
use sandbox::scenario::{Scenario, Setting};
use serde_json::{Value, json};

use crate::common::program::{refused, run, run_json};

fn told(differences: &Differences) -> String {
    differences.findings().unwrap().document.text()
}

fn shipped(settings: &[&str]) -> Scenario {
    let settings: Vec<Setting> = settings.iter().map(|text| text.parse().unwrap()).collect();
    Scenario::shipped("evacuation", &settings).unwrap()
}

#[test]
fn settings_hold_defaults_and_what_a_profile_sets() {
    let settings = shipped(&["viscosity=7"]).settings();
    assert_eq!(settings["parameters"]["viscosity"], 7);
    assert_eq!(settings["parameters"]["gas_constant"], 200.0);
    assert_eq!(settings["time_step_secs"], 0.02);
    assert_eq!(settings["integrator"], "semi-implicit");
    // A profile's own parameters count unless the scenario sets them.
    let calibrated = shipped(&["profile=walk+sph"]).settings();
    assert_ne!(
        calibrated["parameters"]["rest_density_max"],
        settings["parameters"]["rest_density_max"]
    );
    let set = shipped(&["profile=walk+sph", "rest_density_max=5"]).settings();
    assert_eq!(set["parameters"]["rest_density_max"], 5);
    // An automatic step is given in seconds, and another spelling of a profile is the same profile.
    let automatic = shipped(&["time_step_secs=auto"]);
    assert_eq!(
        automatic.settings()["time_step_secs"],
        automatic.scene.clock.time_step()
    );
    assert_eq!(
        shipped(&["profile=sf-sph"]).settings(),
        shipped(&["profile=sf->sph"]).settings()
    );
}

#[test]
fn the_settings_of_a_result_are_a_scenario_with_the_same_result() {
    let scenario = shipped(&["duration_secs=1", "gas_constant=300"]);
    let again = Scenario::parse(&scenario.settings().to_string(), "again.json", &[]).unwrap();
    assert_eq!(again.scene.groups, scenario.scene.groups);
    assert_eq!(again.scene.agents, scenario.scene.agents);
    assert_eq!(again.settings(), scenario.settings());
}

#[test]
fn a_scenario_lists_the_settings_that_differ_from_its_file() {
    let changes = |settings: &[&str]| shipped(settings).changes;
    assert!(changes(&[]).is_empty());
    assert_eq!(
        changes(&["gas_constant=300", "seed=2"]),
        ["gas_constant=300", "seed=2"]
    );
    assert!(changes(&["seed=1"]).is_empty(), "the file's own value");
}

#[test]
fn published_values_belong_to_the_settings_of_the_table_only() {
    let density = |settings: &[&str]| {
        published_for(&shipped(settings))
            .first()
            .map(|first| first.1)
    };
    let five = density(&["profile=sph", "rest_density_max=5"]).unwrap();
    let eight = density(&["profile=sph", "rest_density_max=8", "seed=7"]).unwrap();
    // Table 1 of the paper.
    assert_eq!([five, eight], [5.09, 7.23]);
    assert!(density(&["profile=sf", "agent_stiffness=50"]).is_some());
    // The defaults are settings of a row, too, by whatever kind of number.
    for defaults in [&[][..], &["rest_density_max=5.0"], &["seed=3"]] {
        assert_eq!(density(defaults), Some(five), "{defaults:?}");
    }
    assert_eq!(density(&["profile=sf"]), Some(4.21));
    for settings in [
        &["gas_constant=300"][..],
        &["rest_density_max=5.5"],
        &["time_step_secs=0.01"],
    ] {
        assert_eq!(density(settings), None, "{settings:?}");
    }
}

fn result(metrics: &Value, settings: &Value) -> Value {
    json!({"state_sha256": "0", "metrics": metrics, "settings": settings, "ms_per_frame": 1.0})
}

#[test]
fn differences_name_settings_and_measurements_with_their_change() {
    let a = result(
        &json!({"flow": 4.0, "count": 3}),
        &json!({"parameters": {"k": 200}, "grids": [{"rows": 2}]}),
    );
    let mut b = result(
        &json!({"flow": 5.0, "count": 3}),
        &json!({"parameters": {"k": 300}, "grids": [{"rows": 2}]}),
    );
    b["ms_per_frame"] = json!(9.0); // run times are not compared
    let found = of_reports(&a, &b).unwrap();
    let names = |all: &[Difference]| all.iter().map(|one| one.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&found.settings), ["parameters.k"]);
    assert_eq!(names(&found.results), ["flow"]);
    assert_eq!(
        (found.results[0].change(), found.results[0].percent()),
        (Some(1.0), Some(25.0))
    );
    assert_eq!(found.equal, 2); // count, state
    let floats = result(
        &json!({"flow": 4, "count": 3.0}),
        &json!({"parameters": {"k": 200.0}, "grids": [{"rows": 2}]}),
    );
    assert!(of_reports(&a, &floats).unwrap().settings.is_empty());
    assert!(of_reports(&a, &floats).unwrap().results.is_empty());
    let none = of_reports(&a, &a).unwrap();
    assert_eq!((none.settings.len(), none.results.len()), (0, 0));
    let study = json!({"study": "x"});
    for (pair, which) in [([&a, &study], 1), ([&study, &a], 0)] {
        let error = of_reports(pair[0], pair[1]).unwrap_err();
        assert_eq!(error, NotAReport { which });
    }
}

#[test]
fn numbers_that_differ_by_rounding_are_equal() {
    let run = |flow: f64| result(&json!({"flow": flow}), &json!({"speed": flow}));
    for (other, differs) in [
        (1.8 + 4.0 * f64::EPSILON, false),
        (1.8 * (1.0 + 1e-13), false),
        (1.8 * (1.0 + 1e-11), true),
        (0.0, true),
    ] {
        let found = of_reports(&run(1.8), &run(other)).unwrap();
        let counts = (found.results.len(), found.settings.len());
        let expected = usize::from(differs);
        assert_eq!(counts, (expected, expected), "{other}");
    }
    let tiny = of_reports(&run(0.0), &run(1e-300)).unwrap();
    assert_eq!(tiny.results.len(), 1, "a relative difference of 1");
}

#[test]
fn entries_of_lists_come_after_single_values() {
    let run = |value: f64| result(&json!({"data": [{"x": value}], "flow": value}), &json!({}));
    let found = of_reports(&run(1.0), &run(2.0)).unwrap();
    let names: Vec<&str> = found.results.iter().map(|one| one.name.as_str()).collect();
    assert_eq!(names, ["flow", "data[0].x"]);
}

fn tracks(text: &str) -> sandbox::scenario::trajectories::Tracks {
    read_text(
        Path::new("t.csv"),
        text.as_bytes(),
        &ReadOptions {
            fps: Some(10.0),
            unit: None,
            level: OnLevel::Only,
        },
    )
    .unwrap()
}

#[test]
fn trajectories_differ_from_the_first_time_at_which_a_person_is_elsewhere() {
    let a = tracks("id,frame,x,y\n1,0,0,0\n1,1,0,0\n1,2,0,0\n1,3,0,0\n");
    let b = tracks("id,frame,x,y\n1,0,0,0\n1,1,0,0\n1,2,3,4\n1,3,0,0\n");
    let found: Differences = of_tracks(&a, &b);
    let value = |name: &str| {
        let one = found.results.iter().find(|one| one.name.starts_with(name));
        one.unwrap_or_else(|| panic!("{name}: {found:?}"))
            .b
            .as_f64()
            .unwrap()
    };
    assert!((value("positions differ from") - 0.2).abs() < 1e-12);
    assert_eq!(value("largest distance"), 5.0);
    assert!((value("root mean square") - 2.5).abs() < 1e-12); // √(25 / 4)
    assert!(of_tracks(&a, &a).results.is_empty());
}

#[test]
fn rows_of_people_that_only_one_file_has_are_counted_and_the_text_says_what_is_not_compared() {
    let a = tracks("id,frame,x,y\n1,0,0,0\n2,0,9,0\n1,1,0,0\n2,1,9,0\n");
    // Person 2 has another id in the second frame.
    let renamed = tracks("id,frame,x,y\n1,0,0,0\n2,0,9,0\n1,1,0,0\n7,1,9,0\n");
    let found = of_tracks(&a, &renamed);
    let rows = found
        .results
        .iter()
        .find(|one| one.name.starts_with("rows with an id"));
    let rows = rows.unwrap_or_else(|| panic!("{found:?}"));
    assert_eq!([&rows.a, &rows.b], [&json!(1), &json!(1)]);
    assert!(told(&found).contains("Other columns, such as densities and speeds, are not."));
    let same = told(&of_tracks(&a, &a));
    assert!(same.starts_with("0 result(s) differ, "), "{same}");
    assert!(same.contains("Compared: who is where and when"), "{same}");
}

#[test]
fn seeds_and_ids_are_compared_digit_by_digit_and_have_no_percentages() {
    let largest = u64::MAX;
    let run = |seed: u64, agent: u32| {
        let mut run = result(&json!({"flow": agent}), &json!({"seed": seed}));
        run["seed"] = json!(seed);
        run["stuck_because"] = json!([{"agents": agent, "agent": agent}]);
        run
    };
    let found = of_reports(&run(largest, 2), &run(largest - 1, 4)).unwrap();
    assert_eq!(found.settings.len(), 1, "{found:?}");
    let percent = |name: &str| {
        let one = found.results.iter().find(|one| one.name == name);
        one.unwrap_or_else(|| panic!("{name}: {found:?}")).percent()
    };
    assert_eq!(percent("seed"), None);
    assert_eq!(percent("stuck_because[0].agent"), None);
    assert_eq!(percent("stuck_because[0].agents"), Some(100.0));
    assert_eq!(percent("flow"), Some(100.0));
}

/// The text on stdout.
fn text(arguments: &[&str]) -> String {
    String::from_utf8(run(arguments).stdout).unwrap()
}

#[test]
fn the_program_compares_files_of_one_kind() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    for (name, seed) in [("a", "1"), ("b", "2")] {
        let [csv, rrd] = ["csv", "rrd"].map(|extension| path(&format!("{name}.{extension}")));
        let run = [
            "evacuation",
            "--until",
            "1",
            "--seed",
            seed,
            "--trajectory",
            &csv,
            "--save",
            &rrd,
            "--json",
        ];
        std::fs::write(path(&format!("{name}.json")), text(&run)).unwrap();
    }
    let (a, b) = (path("a.json"), path("b.json"));
    let found = run_json(&["compare", &a, &b, "--json"]);
    assert_eq!(found["settings"], json!([{"name": "seed", "a": 1, "b": 2}]));
    assert!(text(&["compare", &a, &b]).contains("seed"));
    assert!(text(&["compare", &path("a.csv"), &path("b.csv")]).contains("positions differ from"));
    refused(&["compare", &a, &path("b.csv")], 2, &["give two of a kind"]);
    let answer = path("answer.json");
    std::fs::write(&answer, r#"{"estimate": {"results": []}}"#).unwrap();
    let one_is = format!("{answer} is an estimate, {a} is not");
    refused(&["compare", &a, &answer], 2, &[&one_is]);
    refused(&["compare", &answer, &a], 2, &[&one_is]);
    // A recording has the result of its run.
    let recorded = |name: &str| path(&format!("{name}.rrd"));
    let same = run_json(&["compare", &a, &recorded("a"), "--json"]);
    assert_eq!([&same["settings"], &same["results"]], [&json!([]); 2]);
    let other = run_json(&["compare", &recorded("a"), &recorded("b"), "--json"]);
    assert_eq!(
        [&other["settings"], &other["results"]],
        [&found["settings"], &found["results"]]
    );
    let moment = path("moment.rrd");
    run(&[
        "inspect",
        "evacuation",
        "--agent",
        "1",
        "--at",
        "0.1",
        "--save",
        &moment,
    ]);
    refused(
        &["compare", &a, &moment],
        2,
        &["moment.rrd: the recording has no results"],
    );
}

#[test]
fn lists_say_what_each_scenario_and_profile_is() {
    let list = run_json(&["list", "--json"]);
    let described = |entries: &Value| {
        let entries = entries.as_array().unwrap();
        assert!(!entries.is_empty());
        entries
            .iter()
            .all(|one| one["description"].as_str().unwrap().len() > 20)
    };
    assert!(described(&list["scenarios"]));
    assert!(described(&list["profiles"]["paper"]));
    assert!(described(&list["profiles"]["calibrated"]));
    let settings = run_json(&["list", "--settings", "--json"]);
    let first = settings["settings"].as_array().unwrap();
    assert!(
        first
            .iter()
            .any(|one| one["key"] == "gas_constant" && one["default"] == "200")
    );
}
