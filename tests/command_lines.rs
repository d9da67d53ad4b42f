//! Broken command lines and files, and their exact error messages.

use std::collections::BTreeMap;
use std::fs;

use crate::common::program::{run, stderr};
use serde::Deserialize;

/// Input files, and command lines in which `{}` stands for the folder of these files.
#[derive(Deserialize)]
struct Broken {
    files: BTreeMap<String, String>,
    lines: Vec<Line>,
}

/// A command line, and the expected lines on stderr.
#[derive(Deserialize)]
struct Line {
    typed: Vec<String>,
    said: Vec<String>,
}

#[test]
fn every_broken_command_line_is_refused_with_its_exact_message() {
    let broken: Broken =
        serde_json::from_str(include_str!("data/broken_command_lines.json")).unwrap();
    assert!(broken.lines.len() >= 60);
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in &broken.files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    fs::write(folder.path().join("not_utf8.json"), b"{\"name\": \"\xff\"}").unwrap();
    let place = folder.path().to_str().unwrap();
    for Line { typed, said } in &broken.lines {
        let arguments = typed.iter().map(|argument| argument.replace("{}", place));
        let arguments: Vec<String> = arguments.collect();
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let output = run(&arguments);
        let stderr = stderr(&output).replace(place, "{}");
        assert_eq!(stderr.trim_end(), said.join("\n"), "{typed:?}");
        assert_eq!(output.status.code(), Some(2), "{typed:?}");
        assert!(output.stdout.is_empty(), "{typed:?}");
    }
    // No file has been created or replaced.
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        broken.files.len() + 1
    );
    for (name, text) in &broken.files {
        let kept = fs::read_to_string(folder.path().join(name)).unwrap();
        assert_eq!(kept, *text, "{name}");
    }
}

#[test]
fn a_debug_agent_that_never_enters_is_named_at_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    // The run ends before the second agent enters, which is not known in advance.
    let text = r#"{"goal": [0.1, 0], "stop": {"idle_secs": 0.2}, "agents": [{"position": [0, 0]}],
        "sources": [{"min": [0, 5], "max": [0, 9], "columns": 1, "rows": 1, "every_secs": 9, "start_secs": 9}]}"#;
    fs::write(path("late.json"), text).unwrap();
    let (file, save) = (path("late.json"), path("late.rrd"));
    let typed = ["run", &file, "--save", &save, "--debug-agents", "0,1"];
    let output = run(&typed);
    let stderr = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    let note = "note: --debug-agents: 1 never entered: only 1 agents entered, with ids from 0";
    assert!(stderr.contains(note), "{stderr}");
}
