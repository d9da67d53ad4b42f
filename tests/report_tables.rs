//! Tables and texts of reports: people, lines, every value on the pages of a PDF, the status of profiles.

use std::collections::BTreeMap;
use std::fs;
use std::process::Command;

use sandbox::lab::suite::Status;
use serde_json::json;

use crate::common::html::rows;
use crate::common::pdf;
use crate::common::program::{run_in, stderr};
use crate::common::room::{done, scenario};

#[test]
fn people_and_lines_are_those_of_the_scenario_and_of_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let plan = json!({
        "name": "two rooms", "duration_secs": 60, "profile": "steer+sph", "stop": {"when_empty": true},
        "preferred_speed": 1.2,
        "walkable_area": "plan.wkt",
        "exits": [{"name": "out", "line": [[12, 1], [12, 3]], "closed_secs": [[0, 2], [40, 50]]}],
        "doors": [{"name": "door", "line": [[6.1, 1.5], [6.1, 2.7]]}],
        "journeys": [{"name": "leave", "stages": ["out"]}],
        "crowds": [
            {"name": "classroom", "area": [[1, 0.5], [5, 0.5], [5, 3.5], [1, 3.5]], "number": 8, "journey": "leave",
             "premovement_secs": {"uniform": [1, 4]}, "preferred_speed": {"normal": {"mean": 1.3, "std": 0.2}}},
            {"area": [[7, 0.5], [11, 0.5], [11, 3.5], [7, 3.5]], "number": 5, "journey": "leave"}
        ],
        "entrances": [{"name": "late", "line": [[0, 1], [0, 3]], "at_secs": [3, 5, 7], "journey": "leave"}]
    });
    let wkt = "POLYGON ((0 0, 6 0, 6 1.5, 6.2 1.5, 6.2 0, 12 0, 12 4, 6.2 4, 6.2 2.7, 6 2.7, 6 4, 0 4, 0 0))";
    fs::write(folder.path().join("plan.wkt"), wkt).unwrap();
    fs::write(folder.path().join("rooms.json"), plan.to_string()).unwrap();
    let run = done(folder.path(), &["run", "rooms.json", "--json"]);
    done(folder.path(), &["report", "rooms.json", "--json"]);
    let html = fs::read_to_string(folder.path().join("rooms.html")).unwrap();
    let people = rows(&html, "People");
    assert_eq!(
        people[0][..5],
        [
            "classroom",
            "8",
            "8",
            "normal: mean 1.3, std 0.2",
            "uniform (1, 4)"
        ]
    );
    assert_eq!(people[1][..5], ["crowds[1]", "5", "5", "1.2", "0"]);
    assert_eq!(people[2][..5], ["late", "0", "3", "1.2", "0"]);
    assert!(people.iter().all(|row| row[6] == "leave"));
    let lines = rows(&html, "Exits, doors and gates");
    let known = run["places"].as_array().unwrap();
    let place = |name: &str| known.iter().find(|one| one["name"] == name).unwrap();
    let [out, door] = ["out", "door"].map(|name| {
        let row = lines.iter().find(|row| row[0] == name).unwrap();
        assert_eq!(row[4], place(name)["passed"].to_string(), "{row:?}");
        row
    });
    assert_eq!(out[1..4], ["exit", "2.00", "2 to 40, from 50"]);
    assert_eq!(door[1..4], ["door", "1.20", "always"]);
    assert_eq!(out[4], "16");
    let ends = out[5..7].iter().map(|text| text.parse::<f64>().unwrap());
    let ends: Vec<f64> = ends.collect();
    let [first, last] = [0, 1].map(|k| place("out")["from_to_secs"][k].as_f64().unwrap());
    assert!(
        (ends[0] - first).abs() < 0.16 && (ends[1] - last).abs() < 0.16,
        "{ends:?}"
    );
    let flow: f64 = out[7].parse().unwrap();
    assert!((flow - 15.0 / (last - first) / 2.0).abs() < 0.02, "{flow}");
    // The version of the plan.
    let digest = |name: &str| {
        let output = Command::new("sha256sum")
            .arg(folder.path().join(name))
            .output()
            .unwrap();
        String::from_utf8(output.stdout).unwrap()[..64].to_owned()
    };
    let files = rows(&html, "Scenario");
    assert_eq!(files[0], ["rooms.json", "scenario", &digest("rooms.json")]);
    assert_eq!(files[1], ["plan.wkt", "walkable_area", &digest("plan.wkt")]);
}

#[test]
fn a_report_has_the_notes_of_the_run_and_the_limits_that_the_scenario_gives() {
    let folder = tempfile::tempdir().unwrap();
    let gates = json!({
        "name": "gates", "duration_secs": 40, "profile": "steer+sph", "time_step_secs": 0.1,
        "walkable_area": [[[[0, 0], [14, 0], [14, 8], [0, 8]]]],
        "exits": [
            {"name": "gate", "line": [[14, 1], [14, 2]], "most_per_sec": 0.3},
            {"name": "free", "line": [[14, 6], [14, 7]]}
        ],
        "queues": [{"name": "till", "path": [[10, 4], [8, 4]], "service_secs": {"uniform": [1, 2]}, "servers": 2}],
        "waiting_areas": [{"name": "hall", "area": [[6, 1], [8, 1], [8, 3], [6, 3]], "for_secs": 5}],
        "journeys": [{"name": "buy", "stages": ["till", "gate"]}, {"name": "wait", "stages": ["hall", "free"]}],
        "crowds": [
            {"name": "buyers", "area": [[1, 4], [4, 4], [4, 7], [1, 7]], "number": 9, "journey": "buy"},
            {"name": "wheelchairs", "area": [[1, 1], [4, 1], [4, 3], [1, 3]], "number": 2, "journey": "wait",
             "radius": 0.35, "mass": 2.5}
        ],
        "entrances": [
            {"name": "door", "line": [[0, 1], [0, 1.6]], "at_secs": [2, 2, 2, 2, 2, 2], "journey": "wait"}
        ],
        "events": [
            {"name": "push", "at_secs": 1, "for_secs": 0.5, "region": [[12, 6.5], [13, 7.5]], "goal_scale": 2}
        ]
    });
    fs::write(folder.path().join("gates.json"), gates.to_string()).unwrap();
    let run = run_in(folder.path(), &["run", "gates.json"]);
    let said = stderr(&run);
    let notes = said.lines().filter_map(|line| {
        let note = line
            .strip_prefix("note: ")
            .or_else(|| line.strip_prefix("warning: "))?;
        Some(note.to_owned())
    });
    let notes: Vec<String> = notes.collect();
    // The step, agents that wait for room to enter, and a push without agents.
    assert!(notes.len() >= 3, "{said}");
    for file in ["gates.html", "gates.pdf"] {
        done(
            folder.path(),
            &["report", "gates.json", "-o", file, "--json"],
        );
    }
    let html = fs::read_to_string(folder.path().join("gates.html")).unwrap();
    let (_, list) = html.split_once("<h2>Notes of the program</h2>").unwrap();
    let (list, _) = list.split_once("</ul>").unwrap();
    let listed = list.split("<li>").skip(1).map(|item| {
        let (text, _) = item.split_once("</li>").unwrap();
        text.replace("&quot;", "\"")
            .replace("&gt;", ">")
            .replace("&lt;", "<")
            .replace("&amp;", "&")
    });
    assert_eq!(listed.collect::<Vec<_>>(), notes);
    let words = |text: &str| text.split_whitespace().collect::<String>();
    let pdf = fs::read(folder.path().join("gates.pdf")).unwrap();
    let pages: String = pdf::pages(&pdf)
        .iter()
        .map(|page| words(&page.text))
        .collect();
    for note in &notes {
        assert!(pages.contains(&words(note)), "{note}");
    }
    let lines = rows(&html, "Exits, doors and gates");
    assert_eq!([&lines[0][4], &lines[1][4]], ["0.3", "–"]);
    assert!(html.contains("<li>People are discs on one flat floor."));
    let waits = rows(&html, "Waiting areas and queues");
    let stay = |name: &str| waits.iter().find(|row| row[0] == name).unwrap()[2].clone();
    assert_eq!(stay("hall"), "for 5 s");
    let till = stay("till");
    assert!(
        till.starts_with("served by 2 at a time, uniform (1, 2) s each; room for "),
        "{till}"
    );
    let people = rows(&html, "People");
    assert_eq!(people[0][6..8], ["–", "–"]);
    assert_eq!(people[1][6..8], ["0.35", "2.5"]);
}

#[test]
fn a_pdf_has_every_value_of_the_run_on_pages_that_fit_and_the_same_bytes_each_time() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    let run = done(folder.path(), &["run", "room.json", "--json"]);
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
    let pages = pdf::pages(&one);
    let words: Vec<String> = pages.iter().map(pdf::Page::words).collect();
    for (k, words) in words.iter().enumerate() {
        let number = format!("{} / {}", k + 1, pages.len());
        assert!(
            words.contains(&number) && words.len() > number.len() + 40,
            "{words}"
        );
    }
    let all = words.join(" ");
    let is_there = |text: &str| assert!(all.contains(text), "no {text:?} in {all}");
    for (name, value) in run["metrics"].as_object().unwrap() {
        let value = match value {
            value if value.is_u64() => value.to_string(),
            value => value
                .as_f64()
                .map_or("–".to_owned(), |value| format!("{value:.3}")),
        };
        is_there(&format!("{name} {value}"));
    }
    for key in ["state_sha256", "identity", "profile"] {
        is_there(run[key].as_str().unwrap());
    }
    for (key, name) in [
        ("t50_secs", "50 % out [s]"),
        ("t95_secs", "95 % out [s]"),
        ("t100_secs", "all out [s]"),
    ] {
        is_there(&format!("{name} {:.2}", run[key].as_f64().unwrap()));
    }
    for (key, name) in [
        ("agents", "entered"),
        ("arrived", "left"),
        ("remaining", "remain"),
        ("stuck", "stuck"),
    ] {
        is_there(&format!("{name} {}", run[key]));
    }
    let highest = &run["highest_density"];
    is_there(&format!(
        "highest density [P/m²] {:.2}",
        highest["density_per_m2"].as_f64().unwrap()
    ));
    for place in run["places"].as_array().unwrap() {
        is_there(&format!(
            "{} exit 2.00 always {}",
            place["name"].as_str().unwrap(),
            place["passed"]
        ));
    }
    for heading in [
        "Results",
        "Scenario",
        "People",
        "Egress",
        "Pictures",
        "How to run it again",
    ] {
        is_there(heading);
    }
}

#[test]
fn the_status_is_that_of_the_profiles_of_the_run_and_of_the_documents() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    done(folder.path(), &["report", "room.json", "--json"]);
    let html = fs::read_to_string(folder.path().join("room.html")).unwrap();
    let (_, status) = html
        .split_once("<h2>Verification and validation</h2>")
        .unwrap();
    let (status, _) = status.split_once("</ul>").unwrap();
    assert!(
        status.contains("not checked against the texts of these guidelines"),
        "{status}"
    );
    let document = include_str!("../docs/findings/validation.md");
    let (_, counts) = document.split_once("by steer+sph: ").unwrap();
    let (counts, _) = counts.split_once(" values)").unwrap();
    let (cases, values) = counts.split_once(" cases (").unwrap();
    assert!(
        status.contains(&format!("{values} measured values are within")),
        "{status}"
    );
    assert!(
        status.contains(&format!("all values of {cases} scenes")),
        "{status}"
    );
    for other in ["walk+sph", "rvo", "sf-&gt;sph"] {
        assert!(!status.contains(other), "{other}: {status}");
    }
    // A profile of the paper has its own numbers.
    let paper = [
        "report",
        "room.json",
        "--profile",
        "sf->sph",
        "--until",
        "1",
        "--force",
        "--json",
    ];
    done(folder.path(), &paper);
    let html = fs::read_to_string(folder.path().join("room.html")).unwrap();
    let (_, counts) = document.split_once("by sf->sph: ").unwrap();
    let values = counts
        .split_once(" cases (")
        .unwrap()
        .1
        .split(" values)")
        .next()
        .unwrap();
    assert!(html.contains(&format!("{values} measured values are within")));
}

/// The results of a suite by profile, from the table of its document: the cases, and those with a bold value.
fn documented(document: &str, suite: &str) -> BTreeMap<String, (usize, Vec<String>)> {
    let (_, table) = document.split_once(&format!("<!-- {suite} -->")).unwrap();
    let (table, _) = table.split_once(&format!("<!-- /{suite} -->")).unwrap();
    let lines = table
        .lines()
        .skip_while(|line| !line.starts_with("| case "));
    let lines = lines.take_while(|line| line.starts_with('|'));
    let cells = |line: &str| -> Vec<String> {
        let cells = line.trim_matches('|').split('|');
        cells.map(|cell| cell.trim().to_owned()).collect()
    };
    let rows: Vec<Vec<String>> = lines.map(cells).collect();
    let profiles = rows[0].iter().enumerate().skip(4);
    let of = |(column, profile): (usize, &String)| {
        let (mut case, mut count, mut missed) = ("", 0, Vec::new());
        for row in &rows[2..] {
            if !row[0].is_empty() {
                (case, count) = (&row[0], count + 1);
            }
            let is_missed = row[column].starts_with("**");
            if is_missed && missed.last().map(String::as_str) != Some(case) {
                missed.push(case.to_owned());
            }
        }
        (profile.clone(), (count, missed))
    };
    profiles.map(of).collect()
}

#[test]
fn reports_read_the_results_that_the_documents_have() {
    for (suite, document, status) in [
        (
            "verification",
            include_str!("../docs/findings/verification.md"),
            include_str!("../docs/findings/verification.json"),
        ),
        (
            "validation",
            include_str!("../docs/findings/validation.md"),
            include_str!("../docs/findings/validation.json"),
        ),
    ] {
        let status: Status = serde_json::from_str(status).unwrap();
        assert_eq!(status.suite, suite);
        let (_, counts) = document.split_once("\nPassed by ").unwrap();
        for (profile, (cases, missed)) in documented(document, suite) {
            let passed = &status.profiles[&profile];
            assert_eq!(
                (passed.cases, &passed.missed),
                (cases, &missed),
                "{profile}"
            );
            assert_eq!(passed.passed, cases - missed.len());
            let values = match passed.values {
                [_, 0] => String::new(),
                [inside, all] => format!(" ({inside} of {all} values)"),
            };
            let words = format!("{profile}: {} of {cases} cases{values}", passed.passed);
            assert!(counts.contains(&words), "{words}");
        }
    }
}
