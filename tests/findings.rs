//! Results in files of every kind: each says the same as the terminal, no command replaces a file unasked, and all
//! commands with results have them.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::pdf;
use crate::common::program::{run_in, stderr};
use crate::common::room;

const ENDINGS: [&str; 5] = ["pdf", "html", "md", "csv", "json"];

/// A command with results.
struct Command {
    typed: &'static [&'static str],
    /// Its folder, if it has one.
    folder: Option<&'static str>,
    /// Whether the files have a report, which says more than the terminal.
    has_report: bool,
}

const fn command(typed: &'static [&'static str], folder: Option<&'static str>) -> Command {
    Command {
        typed,
        folder,
        has_report: false,
    }
}

const COMMANDS: [Command; 11] = [
    Command {
        has_report: true,
        ..command(&["run", "room.json"], None)
    },
    command(&["inspect", "room.json", "--agent", "3", "--at", "1"], None),
    Command {
        has_report: true,
        ..command(&["sweep", "study.json"], Some("study"))
    },
    command(
        &["estimate", "study.json", "--error", "time_secs=50%"],
        Some("study"),
    ),
    command(
        &["estimate", "room.json", "--error", "time_secs=50%"],
        Some("estimate"),
    ),
    command(
        &["verify", "2", "6", "--profile", "sph"],
        Some("verification"),
    ),
    command(&["verify", "suite.json"], Some("verification")),
    command(&["validate", "suite.json"], Some("validation")),
    command(
        &["calibrate", "fit.json", "--generations", "1"],
        Some("fit"),
    ),
    command(
        &["measure", "tracks.csv", "--line", "7,1,7,5"],
        Some("tracks-measured"),
    ),
    command(&["compare", "a.json", "b.json"], None),
];

/// A room, its tracks and results, and studies of it.
fn inputs(folder: &Path) {
    room::scenario(folder);
    let write = |file: &str, text: &Value| fs::write(folder.join(file), text.to_string()).unwrap();
    let study = json!({
        "scenario": "room.json", "grid": {"preferred_speed": [1.0, 1.4]}, "seeds": 2
    });
    write("study.json", &study);
    let mut suite = json!({"scenario": "room.json", "grid": {"profile": ["sph", "sf->sph"]}});
    suite["cases"] = json!([{
        "name": "all", "about": "Twelve people leave", "checks": [
            {"name": "remain", "quantity": "remaining", "expected": {"between": [0, 0]}},
            {"name": "time [s]", "quantity": "time_secs", "expected": {"between": [0, 1]}}
        ]
    }]);
    write("suite.json", &suite);
    let value = json!({"quantity": "line_passages", "value": 6, "tolerance": 0.5});
    let fit = json!({
        "parameters": [{"name": "preferred_speed", "bounds": [0.5, 2], "start": 1.6}],
        "fit": [{"scenario": "room.json", "name": "room", "values": [value]}],
        "seeds": 1, "final_seeds": [7], "search": {"population": 4, "generations": 2}
    });
    write("fit.json", &fit);
    for (name, seed) in [("a", "1"), ("b", "2")] {
        let tracks = format!("{name}.csv");
        let typed = ["run", "room.json", "--seed", seed, "--trajectory", &tracks];
        let run = room::done(folder, &[&typed[..], &["--json"]].concat());
        write(&format!("{name}.json"), &run);
    }
    fs::rename(folder.join("a.csv"), folder.join("tracks.csv")).unwrap();
}

/// The cells of all tables of a Markdown file.
fn cells(markdown: &str) -> BTreeSet<String> {
    let rows = markdown.lines().filter(|line| line.starts_with("| "));
    let cells = rows.flat_map(|row| row.trim_matches('|').split(" | "));
    let cells = cells.map(|cell| cell.trim().replace(['*', '`'], ""));
    cells
        .filter(|cell| !["---", ""].contains(&cell.as_str()))
        .collect()
}

/// A text without white space, which is where lines break.
fn dense(text: &str) -> String {
    text.split_whitespace().collect()
}

fn unescaped(html: &str) -> String {
    let pairs = [
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&quot;", "\""),
        ("&#39;", "'"),
        ("&amp;", "&"),
    ];
    let tags = ["<code>", "</code>", "<b>", "</b>"];
    let html = tags
        .iter()
        .fold(html.to_owned(), |text, tag| text.replace(tag, ""));
    pairs
        .iter()
        .fold(html, |text, (from, to)| text.replace(from, to))
}

#[test]
fn every_command_with_results_writes_the_same_in_five_kinds_of_files() {
    for Command {
        typed, has_report, ..
    } in &COMMANDS
    {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        inputs(folder);
        let files = ENDINGS.map(|ending| format!("x.{ending}"));
        let asked = files.iter().flat_map(|file| ["-o", file]);
        let all: Vec<&str> = typed.iter().copied().chain(asked).collect();
        let output = run_in(folder, &all);
        let said = stderr(&output);
        let is_judged = typed.contains(&"suite.json");
        assert_eq!(
            output.status.code(),
            Some(i32::from(is_judged)),
            "{typed:?}: {said}"
        );
        let stdout = String::from_utf8(output.stdout).unwrap();
        let read = |file: &str| fs::read(folder.join(file)).unwrap();
        let text = |file: &str| String::from_utf8(read(file)).unwrap();
        let (markdown, html) = (text("x.md"), unescaped(&text("x.html")));
        let pages = pdf::pages(&read("x.pdf"));
        let pages = dense(
            &pages
                .iter()
                .map(|page| page.text.as_str())
                .collect::<String>(),
        );
        let cells = cells(&markdown);
        assert!(
            cells.len() > 1 || typed[0] == "inspect",
            "{typed:?}: {markdown}"
        );
        for cell in &cells {
            assert!(
                html.contains(&format!(">{cell}</t")),
                "{typed:?}: no {cell:?} in the HTML"
            );
            assert!(
                pages.contains(&dense(cell)),
                "{typed:?}: no {cell:?} in the PDF"
            );
            assert!(
                *has_report || stdout.contains(cell),
                "{typed:?}: no {cell:?} in {stdout}"
            );
        }
        // Every figure of the Markdown is a file beside it.
        for link in markdown.split("](").skip(1) {
            let file = link.split(')').next().unwrap();
            assert!(text(file).starts_with("<svg"), "{typed:?}: {file}");
        }
        assert_eq!(
            markdown.matches("](").count(),
            html.matches("<img ").count(),
            "{typed:?}"
        );
        let mut table = csv::Reader::from_path(folder.join("x.csv")).unwrap();
        let width = table.headers().unwrap().len();
        let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
        assert!(width > 1 && !rows.is_empty(), "{typed:?}");
        // The runs are kept, so that the same command says the same.
        let more: &[&str] = match typed[0] {
            "measure" => &["--json", "--force"],
            _ => &["--json"],
        };
        let again = run_in(folder, &[typed, more].concat());
        let printed: Value = serde_json::from_slice(&again.stdout).unwrap();
        let written: Value = serde_json::from_slice(&read("x.json")).unwrap();
        let keys = |value: &Value| {
            let entries = value.as_object();
            entries.map(|entries| entries.keys().cloned().collect::<Vec<_>>())
        };
        assert_eq!(keys(&printed), keys(&written), "{typed:?}");
        if !has_report {
            assert_eq!(printed, written, "{typed:?}");
        }
    }
}

#[test]
fn no_command_replaces_a_file_unasked() {
    for Command { typed, folder, .. } in &COMMANDS {
        let place = tempfile::tempdir().unwrap();
        let place = place.path();
        inputs(place);
        let output = run_in(place, &[typed, &["-o", "x.md", "-o", "x.csv"][..]].concat());
        let said = stderr(&output);
        let mut written: Vec<String> = Vec::new();
        for line in said.lines().filter(|line| line.starts_with("note: x.")) {
            let files = line
                .trim_start_matches("note: ")
                .trim_end_matches(" written");
            written.extend(files.split(", ").map(str::to_owned));
        }
        assert!(written.len() >= 2, "{typed:?}: {said}");
        for file in &written {
            let mine = tempfile::tempdir().unwrap();
            inputs(mine.path());
            fs::write(mine.path().join(file), "mine").unwrap();
            let ending = Path::new(file).extension().unwrap().to_str().unwrap();
            let of = if ending == "svg" { "x.md" } else { "x.csv" };
            let asked = if file.starts_with("x.") {
                file.as_str()
            } else {
                of
            };
            assert_kept(mine.path(), &[typed, &["-o", asked][..]].concat(), file);
        }
        let Some(folder) = folder else {
            continue;
        };
        let listed = format!("note: written to {folder}: ");
        let line = said.lines().find_map(|line| line.strip_prefix(&listed));
        let line = line.unwrap_or_else(|| panic!("{typed:?}: {said}"));
        for file in line.split(", ") {
            let mine = tempfile::tempdir().unwrap();
            inputs(mine.path());
            fs::create_dir(mine.path().join("other")).unwrap();
            let file = format!("other/{file}");
            fs::write(mine.path().join(&file), "mine").unwrap();
            assert_kept(
                mine.path(),
                &[typed, &["--out", "other"][..]].concat(),
                &file,
            );
        }
    }
}

/// A command does not replace this file.
fn assert_kept(folder: &Path, typed: &[&str], file: &str) {
    let output = run_in(folder, typed);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{typed:?}, {file}: {said}");
    assert!(
        said.contains("already exists; use --force"),
        "{typed:?}: {said}"
    );
    assert_eq!(fs::read(folder.join(file)).unwrap(), b"mine", "{typed:?}");
}

#[test]
fn values_that_are_not_as_expected_are_bold() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    inputs(folder);
    let typed = ["verify", "suite.json", "-o", "x.html", "-o", "x.md"];
    assert_eq!(run_in(folder, &typed).status.code(), Some(1));
    let text = |file: &str| fs::read_to_string(folder.join(file)).unwrap();
    let json: Value = serde_json::from_str(&text("verification/suite.json")).unwrap();
    for finding in json.as_array().unwrap() {
        let time = finding["checks"][1]["value"].as_f64().unwrap();
        let time = (1e3 * time).round() / 1e3;
        assert!(text("x.md").contains(&format!("| **{time}** |")), "{time}");
        assert!(
            text("x.html").contains(&format!("><b>{time}</b></td>")),
            "{time}"
        );
    }
}

#[test]
fn a_run_with_files_of_results_and_a_checkpoint_can_be_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    inputs(folder);
    let first = [
        "run",
        "room.json",
        "--until",
        "1",
        "--checkpoint",
        "c",
        "-o",
        "x.json",
        "--json",
    ];
    room::done(folder, &first);
    let resumed = room::done(folder, &["resume", "c", "-o", "r.json", "--json"]);
    let whole = room::done(folder, &["run", "room.json", "--json"]);
    for key in ["state_sha256", "metrics"] {
        assert_eq!(resumed[key], whole[key], "{key}");
    }
    let text = fs::read_to_string(folder.join("r.json")).unwrap();
    let written: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(written["metrics"], whole["metrics"]);
}
