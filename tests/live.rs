//! `--spawn` and `--connect` with missing, disconnected and unresponsive viewers.

use std::io::Read;
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Command, Output};

use crate::common::program::{self, PROGRAM, json, start_and_wait, stderr, stop_with, text};
use crate::common::recording::Recording;
use sandbox::output::recording::{Address, AddressError};

fn evacuation(arguments: &[&str]) -> Output {
    program::run(&[&["evacuation", "--until", "0.2"], arguments].concat())
}

#[test]
fn without_a_viewer_nothing_is_computed() {
    let free = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = free.local_addr().unwrap().to_string();
    drop(free);
    let output = evacuation(&["--connect", &address]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(
        stderr(&output),
        format!(
            "error: no viewer answers at rerun+http://{address}/proxy (Connection refused (os error 111)); \
             start one with `rerun`, or let --spawn do it\n"
        )
    );
    assert!(output.stdout.is_empty());
}

#[test]
fn an_invalid_address_is_bad_input() {
    let output = evacuation(&["--connect", "ftp://here"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        stderr(&output),
        "error: --connect ftp://here: no address of a viewer: rerun+http://HOST:PORT/proxy or HOST:PORT is \
         needed\n"
    );
}

#[test]
fn an_address_is_whole_or_a_host_and_a_port() {
    let address = |text: &str| text.parse::<Address>().map(|address| address.to_string());
    let whole = "rerun+http://127.0.0.1:9876/proxy".to_owned();
    assert_eq!(address(&whole), Ok(whole.clone()));
    assert_eq!(address("127.0.0.1:9876"), Ok(whole.clone()));
    assert_eq!(address("127.0.0.1"), Ok(whole));
    let bracketed = "rerun+http://[::1]:9876/proxy".to_owned();
    assert_eq!(address("[::1]:9876"), Ok(bracketed));
    let wrong = [
        "",
        "http://",
        "ftp://127.0.0.1:1/proxy",
        "host:port",
        "a b:1",
    ];
    for wrong in wrong {
        assert_eq!(address(wrong), Err(AddressError), "{wrong}");
    }
}

#[test]
fn a_missing_viewer_is_reported_with_how_to_install_it() {
    let mut program = Command::new(PROGRAM);
    let output = program
        .args(["evacuation", "--spawn", "--until", "0.2"])
        .env("PATH", "")
        .output()
        .unwrap();
    // A viewer that happens to be open on this machine is used.
    if output.status.code() != Some(0) {
        assert_eq!(output.status.code(), Some(1));
        let said = stderr(&output);
        assert!(said.contains("`pip install rerun-sdk==0.36.3`"), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}

#[test]
fn a_viewer_that_disconnects_gives_a_note_and_the_file_is_complete() {
    let viewer = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = viewer.local_addr().unwrap().to_string();
    // Accepts every connection and closes it.
    std::thread::spawn(move || viewer.incoming().for_each(drop));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.rrd");
    let file = text(&path);
    let output = evacuation(&["--connect", &address, "--save", file]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert_eq!(said.matches(&note(&address)).count(), 1, "{said}");
    let recording = Recording::read(&path);
    let crowd = recording.pairs("/world/agents", "Points2D:positions");
    assert_eq!(crowd.len(), 3, "frames 0, 5 and 10");
}

fn note(address: &str) -> String {
    format!("note: the viewer at rerun+http://{address}/proxy went away before the run had ended: ")
}

/// Starts a viewer that passes every connection to `then`, each on its own thread; returns its address.
fn viewer(then: fn(TcpStream)) -> String {
    let viewer = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = viewer.local_addr().unwrap().to_string();
    std::thread::spawn(move || {
        for connection in viewer.incoming() {
            let connection = connection.unwrap();
            std::thread::spawn(move || then(connection));
        }
    });
    address
}

/// Neither reads nor answers, like a viewer that hangs or whose network is down.
fn silent(connection: TcpStream) {
    std::thread::park();
    drop(connection);
}

/// Reads as much as rerun sends before a viewer answers, then nothing more.
fn falls_silent(mut connection: TcpStream) {
    connection.read_exact(&mut [0; 20_000]).ok();
    silent(connection);
}

/// Reads the same amount, then closes the connection.
fn closes(mut connection: TcpStream) {
    connection.read_exact(&mut [0; 20_000]).ok();
}

/// Entities of a recording, and the positions and densities of its crowd.
fn crowd(path: &Path) -> impl PartialEq + use<> {
    let recording = Recording::read(path);
    let positions = recording.pairs("/world/agents", "Points2D:positions");
    assert!(!positions.is_empty());
    let densities = recording.numbers("/world/agents", "agent:density");
    assert!(!densities.is_empty());
    (recording.entities(), positions, densities)
}

#[test]
fn an_unresponsive_viewer_blocks_neither_the_run_nor_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, more: &[&str]| {
        let file = folder.path().join(name);
        let mut program = Command::new("timeout"); // in case the run hangs
        let output = program
            .args(["--signal=KILL", "60", PROGRAM, "evacuation", "--until", "2"])
            .args(["--record-every", "1", "--json", "--save", text(&file)])
            .args(more)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{name}: {}", stderr(&output));
        let report = json(&output);
        (
            stderr(&output),
            report["state_sha256"].clone(),
            crowd(&file),
        )
    };
    let (_, state, alone) = run("alone.rrd", &[]);
    type Behavior = fn(TcpStream);
    let viewers: [(&str, Behavior); 3] = [
        ("silent.rrd", silent),
        ("falls_silent.rrd", falls_silent),
        ("closes.rrd", closes),
    ];
    for (name, then) in viewers {
        let address = viewer(then);
        let (said, hash, recorded) = run(name, &["--connect", &address]);
        assert_eq!(said.matches(&note(&address)).count(), 1, "{name}: {said}");
        let silent = said.contains("it took no data for 2 s");
        assert_eq!(silent, name != "closes.rrd", "{said}");
        assert_eq!(hash, state, "{name}");
        assert!(recorded == alone, "{name}");
    }
}

#[test]
fn a_run_that_waits_for_a_viewer_can_be_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let file = folder.path().join(signal).with_extension("rrd");
        let address = viewer(silent);
        let run = ["concert", "--json", "--record-every", "1"];
        let more = ["--connect", &address, "--save", text(&file)];
        let child = start_and_wait(&[&run[..], &more].concat(), &[(&file, 1_000)]);
        // Kill the run if it has not ended after a minute.
        let guard = "for k in $(seq 300); do sleep 0.2; kill -0 $1 || exit; done; kill -KILL $1";
        let output = stop_with(child, &format!("kill -{signal} $1; {guard}"));
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{said}");
        let at_once = format!("{}it took no data for 0.2 s", note(&address));
        assert_eq!(said.matches(&at_once).count(), 1, "{said}");
        let report = json(&output);
        assert_eq!(report["interrupted"], true);
        let _ = crowd(&file);
    }
}

#[test]
fn rerun_off_in_the_environment_is_refused_before_anything_is_computed() {
    let folder = tempfile::tempdir().unwrap();
    let (rrd, csv) = ("x.rrd", "w.txt");
    std::fs::write(
        folder.path().join(csv),
        "# framerate: 10\n1 0 0 0\n1 1 0.1 0\n",
    )
    .unwrap();
    let viewer = viewer(silent);
    let commands: [&[&str]; 4] = [
        &["evacuation", "--until", "1", "--save", rrd],
        &["evacuation", "--until", "1", "--connect", &viewer],
        &["inspect", "evacuation", "--agent", "1", "--save", rrd],
        &["measure", csv, "--geometry", "none", "--out", "m"],
    ];
    let run = |command: &[&str], value: &str| {
        let mut program = Command::new(PROGRAM);
        let program = program.args(command).env("RERUN", value);
        program.current_dir(folder.path()).output().unwrap()
    };
    for command in commands {
        for value in ["off", "0", "FALSE"] {
            let output = run(command, value);
            assert_eq!(output.status.code(), Some(2), "{command:?}");
            assert_eq!(
                stderr(&output),
                format!(
                    "error: RERUN={value} in the environment switches recordings off: unset it, or set it to on\n"
                )
            );
            assert!(output.stdout.is_empty());
            let files = std::fs::read_dir(folder.path()).unwrap().count();
            assert_eq!(files, 1, "{command:?}");
        }
    }
    // Without a recording, `RERUN` has no effect; and rerun ignores other values.
    assert_eq!(run(&commands[0][..3], "off").status.code(), Some(0));
    let output = run(commands[0], "no");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let _ = crowd(&folder.path().join(rrd));
}
