//! Reports and egress curves on the command line: what they contain, in both formats, and what is refused.

use std::fs;
use std::path::Path;

use serde_json::json;

use crate::common::program::{json, refused, run_in, stderr};

/// 12 people leave a room by two exits.
fn scenario(folder: &Path) {
    let room = json!({
        "name": "room <&>", "description": "Twelve people & two doors", "duration_secs": 30,
        "profile": "steer+sph", "stop": {"when_empty": true},
        "walkable_area": [[[[0, 0], [8, 0], [8, 6], [0, 6]]]],
        "exits": [{"name": "east", "line": [[8, 2], [8, 4]]}, {"name": "west", "line": [[0, 2], [0, 4]]}],
        "journeys": [{"name": "out", "stages": [{"nearest": ["east", "west"]}]}],
        "crowds": [{"area": [[1, 1], [7, 1], [7, 5], [1, 5]], "number": 12, "journey": "out"}],
        "measurements": [{"line_flow": {"line": [[7.5, 2], [7.5, 4]]}}]
    });
    fs::write(folder.join("room.json"), room.to_string()).unwrap();
}

fn done(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    let output = run_in(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    json(&output)
}

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
fn a_pdf_has_several_pages_with_fonts_and_the_same_bytes_each_time() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    let write = |name: &str, threads: &str| {
        let at = ["--at", "1", "--at", "3"];
        let first = [
            "report",
            "room.json",
            "--out",
            name,
            "--threads",
            threads,
            "--json",
        ];
        done(folder.path(), &[&first[..], &at].concat());
        fs::read(folder.path().join(name)).unwrap()
    };
    let (one, two) = (write("one.pdf", "1"), write("two.pdf", "2"));
    assert!(one == two, "reports of the same run differ");
    let text = String::from_utf8_lossy(&one);
    assert!(text.starts_with("%PDF-"));
    let pages = text.matches("/Type /Page\n").count();
    assert!(pages >= 4, "{pages} pages");
    assert_eq!(text.matches("/FontFile2").count(), 1);
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
        "egress.png",
        "--json",
    ];
    let drawn = done(folder.path(), &picture);
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
    let size = fs::metadata(folder.path().join("egress.png"))
        .unwrap()
        .len();
    assert!(size > 5_000, "{size} bytes");
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
fn reports_and_curves_of_the_wrong_thing_are_refused() {
    refused(
        &["report", "evacuation", "--out", "report.txt"],
        2,
        &["a report's name must end in .html or .pdf"],
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
