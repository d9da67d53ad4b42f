//! Reports and egress curves on the command line: what they contain, and what is refused.

use std::fs;

use crate::common::pictures;
use crate::common::program::{refused, run_in, stderr};
use crate::common::room::{done, scenario};

#[test]
fn a_report_has_every_value_of_the_run_with_its_definition() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    let run = done(folder.path(), &["run", "room.json", "--json"]);
    done(folder.path(), &["report", "room.json", "--json"]);
    let html = fs::read_to_string(folder.path().join("room.html")).unwrap();
    for name in run["metrics"].as_object().unwrap().keys() {
        assert!(html.contains(&format!("<td>{name}</td>")), "{name}");
    }
    // Measured also if the scenario does not ask for them.
    for name in ["exposure_above_5_agents", "service_queue_f", "delay_secs"] {
        assert!(html.contains(name), "{name}");
    }
    assert!(html.contains(run["state_sha256"].as_str().unwrap()));
    assert!(html.contains(run["identity"].as_str().unwrap()));
    assert!(html.contains("sandbox run room.json"));
    assert!(html.contains("room &lt;&amp;&gt;") && !html.contains("room <&>"));
    // Every row of the results has a definition.
    let table = html.split("<h2>Results</h2>").nth(1).unwrap();
    let table = table.split("</table>").next().unwrap();
    for row in table.split("<tr>").skip(2) {
        let definition = row.split("<td>").nth(3).unwrap();
        assert!(definition.len() > "</td></tr>".len() + 10, "{row}");
    }
    assert_eq!(
        html.matches("http").count(),
        html.matches("http-equiv").count()
    );
}

#[test]
fn a_time_without_people_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    for (at, said) in [
        ("1e9", "--at 1000000000: the run ends at 30 s"),
        (
            "29",
            "--at 29: no agents are left at that time: the last one leaves at",
        ),
    ] {
        let output = run_in(
            folder.path(),
            &["report", "room.json", "--at", "1", "--at", at],
        );
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
        assert!(!folder.path().join("room.html").exists());
    }
}

#[test]
fn a_study_is_reported_with_means_ranges_and_digests() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    let study = r#"{"scenario": "room.json", "settings": {"duration_secs": 4}, "seeds": 2,
                    "grid": {"preferred_speed": [1.0, 1.4]}}"#;
    fs::write(folder.path().join("study.json"), study).unwrap();
    let report = ["report", "study.json", "--json"];
    let refusal = run_in(folder.path(), &report);
    assert_eq!(refusal.status.code(), Some(2));
    assert!(stderr(&refusal).contains("run `sandbox sweep study.json` first"));
    let results = done(folder.path(), &["sweep", "study.json", "--json"]);
    done(folder.path(), &report);
    let html = fs::read_to_string(folder.path().join("study.html")).unwrap();
    for cell in results["cells"].as_array().unwrap() {
        let digest = cell["result"]["state_sha256"].as_str().unwrap();
        assert!(html.contains(&digest[..32]), "{digest}");
    }
    assert!(html.contains("preferred_speed 1.4 (2 runs)"));
    assert!(html.contains("line_passages [agents]"));
    let settings = ["report", "study.json", "--seed", "3"];
    let refusal = run_in(folder.path(), &settings);
    assert_eq!(refusal.status.code(), Some(2));
}

#[test]
fn the_egress_table_counts_all_who_left_by_exit() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    let picture = [
        "draw",
        "room.json",
        "--egress",
        "--out",
        "egress.svg",
        "--json",
    ];
    let drawn = done(folder.path(), &picture);
    let svg = fs::read_to_string(folder.path().join("egress.svg")).unwrap();
    let texts = pictures::texts(&svg);
    for text in ["time [s]", "east", "west", "all"] {
        assert!(
            texts.iter().any(|one| one == text),
            "no {text} in {texts:?}"
        );
    }
    let run = done(
        folder.path(),
        &["run", "room.json", "--trajectory", "room.sqlite", "--json"],
    );
    let exits = drawn["exits"].as_array().unwrap();
    let count = |name: &str| {
        let exit = exits.iter().find(|exit| exit["exit"] == name);
        exit.map_or(0, |exit| exit["secs"].as_array().unwrap().len() as u64)
    };
    for place in run["places"].as_array().unwrap() {
        assert_eq!(
            count(place["name"].as_str().unwrap()),
            place["passed"].as_u64().unwrap()
        );
    }
    // The people of the trajectories are last seen when they leave, within a frame of them (0.1 s).
    let tracks = [
        "draw",
        "room.sqlite",
        "--egress",
        "--out",
        "tracks.svg",
        "--json",
    ];
    let tracks = done(folder.path(), &tracks);
    let seen = tracks["exits"][0]["secs"].as_array().unwrap();
    let last = seen.last().unwrap().as_f64().unwrap();
    let left = run["t100_secs"].as_f64().unwrap();
    // Those in the last frame of the file have not left.
    assert!(
        last <= left && seen.len() <= 12,
        "{last} {left} {}",
        seen.len()
    );
}

#[test]
fn people_in_the_last_frame_of_trajectories_have_not_left() {
    let folder = tempfile::tempdir().unwrap();
    // Person k is last seen at k seconds, the last one in the last frame.
    let mut tracks = "# framerate: 10\n# id frame x/m y/m\n".to_owned();
    for frame in 0..=50_i32 {
        for id in (1..=5_i32).filter(|id| frame <= 10 * id) {
            tracks += &format!("{id} {frame} {} {id}\n", 0.1 * f64::from(frame));
        }
    }
    fs::write(folder.path().join("walk.txt"), tracks).unwrap();
    let typed = ["draw", "walk.txt", "--egress", "--out", "egress.svg"];
    let output = run_in(folder.path(), &typed);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let note = "1 person is still there in the last frame, at 5.00 s";
    assert!(said.contains(&format!("note: {note}")), "{said}");
    let svg = fs::read_to_string(folder.path().join("egress.svg")).unwrap();
    let texts = pictures::texts(&svg);
    assert!(texts.iter().any(|one| one == note), "{texts:?}");
    // 4 of 5 are out; when 95 % and all had left is not known.
    let table = String::from_utf8(output.stdout).unwrap();
    let all = table.lines().find(|line| line.starts_with("all")).unwrap();
    let cells: Vec<&str> = all.split_whitespace().collect();
    assert_eq!(cells, ["all", "4", "80.0", "1.0", "3.0", "–", "–"]);
}

#[test]
fn reports_and_curves_of_the_wrong_thing_are_refused() {
    refused(
        &["report", "evacuation", "--out", "report.txt"],
        2,
        &["the name must end in .html, .pdf, .md, .csv or .json"],
    );
    refused(
        &["report", "evacuation", "--results", "folder"],
        2,
        &["--results folder: is for studies"],
    );
    refused(
        &["draw", "concert", "--egress", "--at", "3"],
        2,
        &["--egress", "--at"],
    );
}
