//! `--spawn` and `--connect`: what is said where nobody looks on, or somebody has gone.
#![cfg(all(feature = "cli", feature = "recording"))]

use std::net::TcpListener;
use std::process::{Command, Output};

use crate::common;
use crate::common::program::PROGRAM;

fn sandbox(arguments: &[&str]) -> Output {
    let run = ["evacuation", "--until", "0.2"];
    let mut program = Command::new(PROGRAM);
    program.args(run).args(arguments).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn without_a_viewer_nothing_is_computed() {
    let free = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = free.local_addr().unwrap().to_string();
    drop(free);
    let output = sandbox(&["--connect", &address]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(
        said(&output),
        format!(
            "error: no viewer answers at rerun+http://{address}/proxy (Connection refused (os error 111)); \
             start one with `rerun`, or let --spawn do it\n"
        )
    );
    assert!(output.stdout.is_empty());
}

#[test]
fn an_address_that_is_none_is_bad_input() {
    let output = sandbox(&["--connect", "ftp://here"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        said(&output),
        "error: --connect ftp://here: no address of a viewer: rerun+http://HOST:PORT/proxy or HOST:PORT is \
         needed\n"
    );
}

#[test]
fn where_no_viewer_is_installed_its_source_is_named() {
    let mut program = Command::new(PROGRAM);
    let output = program
        .args(["evacuation", "--spawn", "--until", "0.2"])
        .env("PATH", "")
        .output()
        .unwrap();
    // Somebody who runs these tests may have a viewer open: it is then taken.
    if output.status.code() != Some(0) {
        assert_eq!(output.status.code(), Some(1));
        let said = said(&output);
        assert!(said.contains("`pip install rerun-sdk==0.36.3`"), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}

#[test]
fn a_viewer_that_goes_away_is_a_note_and_the_file_is_whole() {
    let viewer = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = viewer.local_addr().unwrap().to_string();
    // Takes every connection, and closes it.
    std::thread::spawn(move || viewer.incoming().for_each(drop));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.rrd");
    let file = common::program::text(&path);
    let output = sandbox(&["--connect", &address, "--save", file]);
    let said = said(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let note = "note: the viewer went away before the run had ended: ";
    assert_eq!(said.matches(note).count(), 1, "{said}");
    let recording = sandbox::recording::Recording::read(&path).unwrap();
    let crowd = recording.pairs("/world/agents", "Points2D:positions");
    assert_eq!(crowd.len(), 3, "frames 0, 5 and 10");
}
