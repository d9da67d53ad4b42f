//! Pages: what they hold against the trajectories of the same run, and how they end.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::common::page::{Page, elements};
use crate::common::program::{json, refused, run, run_in, run_json, stderr, text};
use crate::common::recording::Recording;
use crate::common::room::scenario;

/// A row of a CSV file of trajectories.
#[derive(Debug, Deserialize)]
struct Row {
    time: f64,
    id: i64,
    pos_x: f64,
    pos_y: f64,
    speed: f64,
    density: f64,
    radius: f64,
}

/// The rows of each frame.
fn rows(csv: &Path) -> Vec<Vec<Row>> {
    let mut frames: Vec<Vec<Row>> = Vec::new();
    for row in csv::Reader::from_path(csv).unwrap().into_deserialize() {
        let row: Row = row.unwrap();
        match frames.last_mut() {
            Some(last) if last[0].time == row.time => last.push(row),
            _ => frames.push(vec![row]),
        }
    }
    frames
}

/// Checks every person in every frame; `error` is the most that densities and speeds may be off beside their rounding.
fn agrees(page: &Page, frames: &[Vec<Row>], error: f64) {
    assert_eq!(page.crowds.len(), frames.len());
    for ((people, rows), time) in page.crowds.iter().zip(frames).zip(&page.times) {
        assert!((time - rows[0].time).abs() < 1e-6);
        let ids: Vec<i64> = rows.iter().map(|row| row.id).collect();
        assert!(people.keys().eq(&ids), "{time}");
        for row in rows {
            let person = &people[&row.id];
            let [x, y] = page.position(person);
            let off = (x - row.pos_x).hypot(y - row.pos_y);
            assert!(off <= 0.01, "{} at {time}: {off} m off", row.id);
            for (name, value) in [("density", row.density), ("speed", row.speed)] {
                let shown = page.value(person, name).unwrap();
                let most = 0.5 * page.unit(name) + error * value + 1e-9;
                assert!((shown - value).abs() <= most, "{name} {shown} {value}");
            }
            assert!((person.radius - row.radius).abs() <= 0.0005 + 1e-9);
        }
    }
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }
}

#[test]
fn a_page_has_the_people_of_the_run_and_so_has_a_page_of_its_recording_or_trajectories() {
    let folder = Folder::new();
    let files = ["run.html", "run.rrd", "run.csv"].map(|name| folder.path(name));
    let [html, rrd, csv] = files.each_ref().map(|file| text(file));
    let saves = ["--save", html, "--save", rrd, "--trajectory", csv];
    run_json(&[&["evacuation", "--until", "3", "--json"], &saves[..]].concat());
    let page = Page::read(&files[0]);
    let rows = rows(&files[2]);
    agrees(&page, &rows, 0.0);
    // The time series are those of the trajectories.
    let names = page.scene["series"].as_array().unwrap().iter();
    let names: Vec<&str> = names.map(|series| series[1].as_str().unwrap()).collect();
    let of = |name: &str| &page.series[names.iter().position(|one| *one == name).unwrap()];
    for (k, rows) in rows.iter().enumerate() {
        assert_eq!(of("agents")[k], Some(rows.len() as f64));
        let most = rows.iter().map(|row| row.density).fold(0.0, f64::max);
        assert!((of("maximum density")[k].unwrap() - most).abs() < 1e-4 * most);
    }
    for (from, error) in [(rrd, 0.001), (csv, 0.0)] {
        let out = folder.path("other.html");
        let made = run_json(&["page", from, "--out", text(&out), "--force", "--json"]);
        assert_eq!(made["frames"], rows.len());
        agrees(&Page::read(&out), &rows, error);
    }
}

#[test]
fn parts_begin_where_the_last_one_ends_while_people_come_and_go() {
    let folder = Folder::new();
    let scenario = r#"{"name": "flow", "duration_secs": 60, "profile": "sph", "preferred_speed": 1,
        "sources": [{"min": [0, 0], "max": [0, 4], "columns": 1, "rows": 3, "every_secs": 3, "times": 12,
                     "goal": [12, 2], "remove_within": 0.5}]}"#;
    fs::write(folder.path("flow.json"), scenario).unwrap();
    let [html, csv] = ["a.html", "a.csv"].map(|name| folder.path(name));
    let files = ["--save", text(&html), "--trajectory", text(&csv)];
    let flow = folder.path("flow.json");
    run_json(&[&["run", text(&flow), "--json"], &files[..]].concat());
    let page = Page::read(&html);
    assert!(page.parts > 1);
    // Frames without anybody have no rows.
    let mut rows = rows(&csv).into_iter().peekable();
    for (people, time) in page.crowds.iter().zip(&page.times) {
        let here = rows.next_if(|rows| (rows[0].time - time).abs() < 1e-6);
        let ids: Vec<i64> = here.iter().flatten().map(|row| row.id).collect();
        assert!(people.keys().eq(&ids), "{time}");
        for row in here.iter().flatten() {
            let [x, y] = page.position(&people[&row.id]);
            assert!((x - row.pos_x).hypot(y - row.pos_y) <= 0.01);
        }
    }
    assert!(rows.next().is_none());
}

#[test]
fn pages_and_recordings_end_with_the_last_frame_of_the_run() {
    let folder = Folder::new();
    scenario(folder.0.path());
    let [room, html, rrd] = ["room.json", "a.html", "a.rrd"].map(|name| folder.path(name));
    let saves = ["--save", text(&html), "--save", text(&rrd)];
    let run_it = ["run", text(&room), "--record-every", "1000000", "--json"];
    let report = run_json(&[&run_it[..], &saves].concat());
    let page = Page::read(&html);
    let end = report["time_secs"].as_f64().unwrap();
    assert!(end > 1.0);
    assert_eq!(page.times.len(), 2);
    assert_eq!(page.times[0], 0.0);
    assert!((page.times[1] - end).abs() < 1e-6, "{:?}", page.times);
    // People there and people who have left, as the results say.
    assert_eq!(page.series[0], [Some(12.0), Some(0.0)]);
    assert_eq!(page.series[1], [Some(0.0), Some(12.0)]);
    assert_eq!(report["arrived"], 12);
    let recording = Recording::read(&rrd);
    let agents = recording.numbers("/stats/crowd/agents", "Scalars:scalars");
    let last = report["frames"].as_i64().unwrap();
    assert_eq!(agents, [(0, vec![12.0]), (last, vec![0.0])]);
    let outcome = crate::common::html::rows(&page.html, "Outcome");
    let time = outcome.iter().find(|row| row[0] == "simulated time [s]");
    let rounded = (100.0 * end).round() / 100.0;
    assert_eq!(time.unwrap()[1].parse::<f64>(), Ok(rounded));
}

#[test]
fn the_same_run_makes_the_same_bytes_on_any_number_of_threads() {
    let folder = Folder::new();
    let bytes = |threads: &str| {
        let file = folder.path(threads);
        let file = file.with_extension("html");
        let run = ["evacuation", "--until", "2", "--threads", threads, "--json"];
        run_json(&[&run[..], &["--save", text(&file)]].concat());
        fs::read(file).unwrap()
    };
    assert!(bytes("1") == bytes("2"));
}

#[test]
fn accelerations_of_debug_agents_are_those_that_inspect_prints() {
    let folder = Folder::new();
    let [file, moment] = ["run.html", "moment.html"].map(|name| folder.path(name));
    let run_it = ["evacuation", "--until", "2", "--debug-agents", "17,42"];
    assert_eq!(
        run(&[&run_it[..], &["--save", text(&file)]].concat())
            .status
            .code(),
        Some(0)
    );
    let inspect = [
        "inspect",
        "evacuation",
        "--at",
        "2",
        "--agent",
        "17",
        "--agent",
        "42",
        "--json",
    ];
    let printed = run_json(&[&inspect[..], &["--save", text(&moment)]].concat());
    for file in [&file, &moment] {
        let page = Page::read(file);
        assert_eq!(page.scene["terms"][0][0], "total");
        let last = page.forces.last().unwrap();
        assert!(last.keys().eq(&[17, 42]));
        for agent in printed["agents"].as_array().unwrap() {
            let person = &last[&agent["id"].as_i64().unwrap()];
            for axis in 0..2 {
                let sum = f64::from(person.values[axis]) * page.unit("acceleration");
                let own = agent["acceleration"][axis].as_f64().unwrap();
                // The run computes in single precision, `inspect` in double.
                assert!((sum - own).abs() <= 0.005 + 1e-3 * own.abs(), "{sum} {own}");
            }
        }
    }
}

#[test]
fn no_name_ends_an_element_and_nothing_points_outside() {
    let folder = Folder::new();
    let name = r#"</script><script>alert('1')</script><img src=\"http://x/y\">"#;
    let scenario = format!(
        r#"{{"name": "{name}", "description": "{name}", "duration_secs": 0.1, "profile": "sph",
        "walkable_area": [[[[0,0],[9,0],[9,9],[0,9]]]],
        "exits": [{{"name": "{name}", "line": [[9, 4], [9, 5]]}}],
        "journeys": [{{"name": "{name}", "stages": ["{name}"]}}],
        "grids": [{{"min": [1,1], "max": [2,2], "columns": 2, "rows": 2, "journey": "{name}"}}]}}"#
    );
    fs::write(folder.path("hostile.json"), scenario).unwrap();
    let output = run_in(
        folder.0.path(),
        &["run", "hostile.json", "--save", "a.html"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let page = Page::read(&folder.path("a.html"));
    let scripts = elements(&page.html, "<script");
    assert!(!page.html.contains("<script>alert"));
    // One script, the scene, a block of people, one of forces, the time series.
    assert_eq!(scripts.len(), 5);
    assert!(!page.html.contains("<img"));
    for source in ["src=\"", "href=\"", "url(", "import("] {
        let mut found = page.html.match_indices(source);
        assert!(found.all(|(at, _)| page.html[at + source.len()..].starts_with("data:")));
    }
}

#[test]
fn draw_makes_the_page_of_a_run_and_refuses_what_pages_do_not_have() {
    let folder = Folder::new();
    let names = ["a.csv", "one.html", "other.html", "b.html"].map(|name| folder.path(name));
    let [tracks, one, other, wrong] = names.each_ref().map(|file| text(file));
    run_json(&[
        "evacuation",
        "--until",
        "0.5",
        "--trajectory",
        tracks,
        "--json",
    ]);
    run_json(&["draw", tracks, "-o", one, "--json"]);
    run_json(&["page", tracks, "-o", other, "--json"]);
    assert_eq!(fs::read(one).unwrap(), fs::read(other).unwrap());
    let of_pictures = ["draw", tracks, "-o", wrong, "--field", "speed"];
    refused(&of_pictures, 2, &["--field is for pictures", ".svg"]);
    let other_profile = ["draw", tracks, "-o", wrong, "--profile", "sf"];
    refused(&other_profile, 2, &["--profile needs a scenario"]);
    let picture = ["draw", tracks, "-o", "a.svg", "--page-viewer", "viewer"];
    refused(&picture, 2, &["--page-viewer viewer: is for pages"]);
    let scenario = ["draw", "evacuation", "-o", wrong];
    refused(&scenario, 2, &["sandbox run evacuation --save"]);
    assert!(!Path::new(wrong).exists());
}

#[test]
fn wrong_outputs_are_refused_before_anything_is_computed() {
    let folder = Folder::new();
    let names = ["a.html", "b.html", "a.txt", "plan.html"].map(|name| folder.path(name));
    let [a, b, wrong, old] = names.each_ref().map(|file| text(file));
    let others = ["a.rrd", "a.csv"].map(|name| folder.path(name));
    let [rrd, csv] = others.each_ref().map(|file| text(file));
    refused(
        &["evacuation", "--save", wrong],
        2,
        &["must end in .rrd", ".html"],
    );
    refused(
        &["evacuation", "--save", a, "--save", b],
        2,
        &["a run has one recording (.rrd) and one page (.html)"],
    );
    fs::write(old, "mine").unwrap();
    refused(
        &["evacuation", "--save", old],
        2,
        &["already exists; use --force"],
    );
    assert_eq!(fs::read_to_string(old).unwrap(), "mine");
    refused(&["page", wrong], 2, &["a.txt"]);
    fs::write(wrong, "no numbers").unwrap();
    refused(&["page", wrong, "--out", a], 2, &["a.txt"]);
    refused(
        &["page", "none.rrd", "--unit", "cm", "--out", a],
        2,
        &["--unit is for trajectory files"],
    );
    let viewer = ["--page-viewer", "nowhere"];
    refused(
        &[&["evacuation", "--save", a][..], &viewer].concat(),
        2,
        &["needs a recording and a page"],
    );
    let both = ["evacuation", "--save", a, "--save", rrd];
    let install = "pip install rerun-notebook==0.36.3";
    refused(&[&both[..], &viewer].concat(), 2, &["nowhere", install]);
    refused(
        &[&["page", csv][..], &viewer].concat(),
        2,
        &["is for recordings"],
    );
    refused(
        &["page", "none.rrd", "--out", "a.png"],
        2,
        &["must end in .html"],
    );
    assert!(!Path::new(a).exists());
}

#[cfg(unix)]
#[test]
fn a_full_disk_is_an_error_and_an_interrupted_run_leaves_a_whole_page() {
    use crate::common::program::{start_and_wait, stop_with};

    let folder = Folder::new();
    std::os::unix::fs::symlink("/dev/full", folder.path("full.html")).unwrap();
    let output = run_in(
        folder.0.path(),
        &[
            "evacuation",
            "--until",
            "1",
            "--force",
            "--save",
            "full.html",
        ],
    );
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(
        said.contains("full.html: No space left on device"),
        "{said}"
    );

    let html = folder.path("concert.html");
    let run = ["concert", "--json", "--save", text(&html)];
    let output = stop_with(start_and_wait(&run, &[(&html, 100_000)]), "kill -INT $1");
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    let report = json(&output);
    let page = Page::read(&html);
    assert!(page.html.trim_end().ends_with("</html>"));
    assert!(page.html.contains("interrupted"));
    // The frame at which it was interrupted is there, too.
    let frames = report["frames"].as_u64().unwrap().div_ceil(5) + 1;
    assert_eq!(page.times.len() as u64, frames);
    // Rows of a hundred people enter together.
    let counts: BTreeMap<usize, usize> = page
        .crowds
        .iter()
        .map(|people| (people.len() % 100, 1))
        .collect();
    assert!(counts.keys().eq(&[0]));
}

/// A package with a viewer whose files only tests know.
fn package(folder: &Folder) -> PathBuf {
    let package = folder.path("rerun_notebook");
    fs::create_dir_all(package.join("static")).unwrap();
    fs::create_dir(folder.path("rerun_notebook-0.36.3.dist-info")).unwrap();
    fs::write(package.join("static/widget.js"), "script").unwrap();
    fs::write(package.join("static/re_viewer_bg.wasm"), vec![7; 100_000]).unwrap();
    package
}

#[test]
fn a_page_with_the_viewer_has_the_whole_recording_and_may_still_request_nothing() {
    let folder = Folder::new();
    let [html, rrd, other] = ["a.html", "a.rrd", "b.html"].map(|name| folder.path(name));
    let package = package(&folder);
    let viewer = ["--page-viewer", text(&package)];
    let saves = ["--save", text(&html), "--save", text(&rrd)];
    run_json(
        &[
            &["evacuation", "--until", "1", "--json"],
            &saves[..],
            &viewer,
        ]
        .concat(),
    );
    run_json(
        &[
            &["page", text(&rrd), "--json", "--out", text(&other)][..],
            &viewer,
        ]
        .concat(),
    );
    for html in [&html, &other] {
        let page = Page::read(html);
        assert_eq!(page.bytes("recording").concat(), fs::read(&rrd).unwrap());
        assert_eq!(page.bytes("rerun-script").concat(), b"script");
        assert_eq!(page.bytes("rerun-program").concat(), vec![7; 100_000]);
        let policy = page.html.split_once("Content-Security-Policy").unwrap().1;
        let policy = policy.split_once('>').unwrap().0;
        assert!(
            policy.contains("default-src 'none'")
                && !policy.contains("http")
                && !policy.contains('*')
        );
    }
}
