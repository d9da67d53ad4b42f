//! All outputs are checked before anything is computed: no output replaces another file, and failed commands leave
//! no files behind.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs::{self, Permissions};
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, symlink};
use std::os::unix::process::CommandExt;
use std::process::Command;

use sandbox::runs::checkpoint::Checkpoint;
use sandbox::runs::outputs::{Manner, Outputs, OutputsError, write_whole};

use crate::common::outputs::{SCENARIO, contents, folder, refused, run};
use crate::common::program::{PROGRAM, json, stderr};

#[test]
fn two_outputs_to_one_file_are_refused_under_any_names() {
    let folder = folder();
    for (files, names) in [
        (
            "--trajectory a.csv --trajectory ./a.csv",
            ["a.csv", "./a.csv"],
        ),
        (
            "--trajectory a.csv --trajectory dir/../a.csv",
            ["a.csv", "dir/../a.csv"],
        ),
        (
            "--trajectory dir/a.db --trajectory linked/a.db",
            ["dir/a.db", "linked/a.db"],
        ),
        (
            "--trajectory dangling.csv --checkpoint new",
            ["dangling.csv", "new"],
        ),
        (
            "--trajectory a.csv --checkpoint a.csv",
            ["--trajectory a.csv", "--checkpoint a.csv"],
        ),
        (
            "--trajectory a.db --checkpoint a.db-journal",
            ["a.db-journal", "--checkpoint"],
        ),
    ] {
        let typed = format!("run s.json {files} --force");
        refused(
            folder.path(),
            &typed,
            2,
            &[names[0], names[1], "are the same file"],
        );
    }
    // Several outputs may write to a device.
    let null = folder.path().join("null.csv");
    symlink("/dev/null", null).unwrap();
    let typed = "run s.json --trajectory null.csv --trajectory null.csv --force";
    assert_eq!(run(folder.path(), typed).status.code(), Some(0));
}

#[test]
fn an_input_is_never_replaced() {
    let folder = folder();
    fs::copy(folder.path().join("c"), folder.path().join("c.csv")).unwrap();
    let json = r#"{"scenario": "planned.json", "name": "area"}"#;
    fs::write(folder.path().join("study.json"), json).unwrap();
    fs::create_dir(folder.path().join("cases")).unwrap();
    for (typed, names) in [
        (
            "run s.json --trajectory link.csv",
            ["--trajectory link.csv", "the scenario s.json"],
        ),
        (
            "run s.json --trajectory hard.csv",
            ["--trajectory hard.csv", "the scenario s.json"],
        ),
        (
            "run s.json --checkpoint dir/../s.json",
            ["--checkpoint dir/../s.json", "s.json"],
        ),
        (
            "run planned.json --trajectory area.csv",
            ["--trajectory", "walkable_area area.csv"],
        ),
        (
            "run s.json --geometry area.csv --trajectory area.csv",
            ["--trajectory", "--geometry area.csv"],
        ),
        (
            "resume c.csv --trajectory c.csv",
            ["--trajectory c.csv", "the checkpoint c.csv"],
        ),
        ("sweep study.json --out .", ["--out ./area.csv", "area.csv"]),
    ] {
        let message = [names[0], names[1], "an input is never replaced"];
        refused(folder.path(), &format!("{typed} --force"), 2, &message);
    }
    fs::rename(
        folder.path().join("tracks.txt"),
        folder.path().join("agents.csv"),
    )
    .unwrap();
    let typed = "measure agents.csv --out . --force";
    refused(
        folder.path(),
        typed,
        2,
        &["--out ./agents.csv", "the trajectories agents.csv"],
    );
}

#[test]
fn a_recording_never_replaces_a_scenario_and_must_end_in_rrd() {
    let folder = folder();
    let inspect = "inspect s.json --agent 0 --force --save";
    for run in ["run s.json --force --save", inspect] {
        let words = [
            "--save link.rrd",
            "the scenario s.json",
            "are the same file",
        ];
        refused(folder.path(), &format!("{run} link.rrd"), 2, &words);
        let words = ["'s.json'", "--save", "must end in .rrd"];
        refused(folder.path(), &format!("{run} s.json"), 2, &words);
        refused(
            folder.path(),
            &format!("{run} no/x.rrd"),
            2,
            &["--save no/x.rrd: the folder no does not exist: make it"],
        );
        fs::create_dir_all(folder.path().join("d.rrd")).unwrap();
        refused(
            folder.path(),
            &format!("{run} d.rrd"),
            1,
            &["--save d.rrd", "is a folder"],
        );
    }
}

#[test]
fn a_resumed_run_may_replace_its_own_checkpoint() {
    let folder = folder();
    let first = fs::read(folder.path().join("c")).unwrap();
    let goes_on = run(folder.path(), "resume c --checkpoint ./c --until 2");
    assert_eq!(goes_on.status.code(), Some(0), "{}", stderr(&goes_on));
    assert_ne!(fs::read(folder.path().join("c")).unwrap(), first);
    let words = ["--until 1:", "the checkpoint c was written at 2.00 s"];
    refused(folder.path(), "resume c --until 1", 2, &words);
    // A resumed run may not replace any other checkpoint.
    fs::copy(folder.path().join("c"), folder.path().join("d")).unwrap();
    refused(
        folder.path(),
        "resume c --checkpoint d",
        2,
        &["d: already exists"],
    );
}

#[test]
fn an_unwritable_path_is_refused_with_the_reason() {
    let folder = folder();
    for (typed, words) in [
        (
            "run s.json --checkpoint no/c",
            "--checkpoint no/c: the folder no does not exist: make it",
        ),
        (
            "run s.json --force --checkpoint dir",
            "--checkpoint dir: cannot be written: it is a folder",
        ),
        (
            "run s.json --checkpoint s.json/c",
            "--checkpoint s.json/c: cannot be written: Not a",
        ),
        (
            "run s.json --trajectory a.csv --checkpoint no/c",
            "--checkpoint no/c",
        ),
        (
            "measure tracks.txt --out dir/new/s --geometry none --cell 0",
            "--cell",
        ),
        (
            "measure tracks.txt --out s.json",
            "--out s.json: cannot be written: Not a",
        ),
    ] {
        let is_input = words == "--cell" || words.contains("no/c");
        let code = if is_input { 2 } else { 1 };
        refused(folder.path(), typed, code, &[words]);
    }
    refused(
        folder.path(),
        "measure no.txt --out dir/new/s",
        2,
        &["no.txt"],
    );
    // Root can write to every file, so another user runs the program.
    let file = folder.path().join("theirs.csv");
    fs::write(&file, "theirs").unwrap();
    fs::set_permissions(&file, Permissions::from_mode(0o444)).unwrap();
    fs::set_permissions(folder.path(), Permissions::from_mode(0o777)).unwrap();
    for option in ["--trajectory", "--checkpoint"] {
        let mut program = Command::new(PROGRAM);
        if fs::metadata(&file).unwrap().uid() == 0 {
            program.uid(65534);
        }
        let typed = ["run", "s.json", "--force", option, "theirs.csv"];
        let output = program.args(typed).current_dir(&folder).output().unwrap();
        let words = format!("{option} theirs.csv: cannot be written: Permission denied");
        assert!(stderr(&output).contains(&words), "{}", stderr(&output));
        assert_eq!(output.status.code(), Some(1));
        assert_eq!(fs::read(&file).unwrap(), b"theirs");
    }
}

#[test]
fn a_checkpoint_is_written_through_links_and_replaces_no_device() {
    let folder = folder();
    symlink("dir/c", folder.path().join("link")).unwrap();
    for force in ["", " --force"] {
        let output = run(
            folder.path(),
            &format!("run s.json --checkpoint link{force}"),
        );
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(folder.path().join("link").is_symlink());
        assert!(Checkpoint::read(&folder.path().join("dir/c")).is_ok());
    }
    fs::remove_file(folder.path().join("dir/c")).unwrap();
    let fifo = folder.path().join("fifo");
    let made = Command::new("mkfifo").arg(&fifo).status().unwrap();
    assert!(made.success());
    refused(
        folder.path(),
        "run s.json --force --checkpoint fifo",
        1,
        &["FIFO"],
    );
    assert!(fs::metadata(&fifo).unwrap().file_type().is_fifo());
}

#[test]
fn the_permissions_of_a_checkpoint_follow_the_umask() {
    let folder = folder();
    for (umask, mode) in [("022", 0o644), ("027", 0o640), ("077", 0o600)] {
        let file = folder.path().join(umask);
        let script = format!(r#"umask {umask}; exec "$0" run s.json --checkpoint {umask}"#);
        let mut shell = Command::new("sh");
        let shell = shell.args(["-c", &script, PROGRAM]).current_dir(&folder);
        assert!(shell.output().unwrap().status.success());
        assert_eq!(fs::metadata(&file).unwrap().mode() & 0o777, mode, "{umask}");
    }
    // An existing file keeps its permissions.
    let file = folder.path().join("077");
    run(folder.path(), "run s.json --checkpoint 077 --force");
    assert_eq!(fs::metadata(&file).unwrap().mode() & 0o777, 0o600);
}

#[test]
fn a_run_continues_after_a_checkpoint_that_cannot_be_written() {
    let folder = folder();
    // 400 people enter after a second, and their checkpoint exceeds the file size limit.
    let text = r#"{"goal": [99, 0], "duration_secs": 1.9, "agents": [{"position": [0, 0]}], "sources": [
        {"min": [0, 2], "max": [10, 12], "columns": 20, "rows": 20, "every_secs": 9, "start_secs": 1}]}"#;
    fs::write(folder.path().join("grows.json"), text).unwrap();
    let command =
        r#"trap "" XFSZ; ulimit -f 8; exec "$0" run grows.json --json --checkpoint g "$@""#;
    let more = [
        "--checkpoint-every",
        "0.5",
        "--trajectory",
        "g.txt",
        "--trajectory-fps",
        "0.5",
    ];
    let mut bash = Command::new("bash");
    let bash = bash.args(["-c", command, PROGRAM]).args(more);
    let output = bash.current_dir(&folder).output().unwrap();
    let stderr = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    let report = json(&output);
    assert_eq!(
        [&report["frames"], &report["agents"]],
        [95, 401],
        "{stderr}"
    );
    let error = stderr.lines().last().unwrap();
    assert!(
        error.starts_with("error: --checkpoint g: cannot be written: File too large"),
        "{error}"
    );
    assert!(
        error.ends_with("; the checkpoint of 0.50 s is kept"),
        "{error}"
    );
    assert!(!stderr.contains(".tmp"), "{stderr}");
    assert!(Checkpoint::read(&folder.path().join("g")).is_ok());
    assert!(
        fs::read_to_string(folder.path().join("g.txt"))
            .unwrap()
            .ends_with("0\n")
    );
    let names = contents(folder.path());
    assert!(
        names.keys().all(|name| !name.starts_with(".tmp")),
        "{names:?}"
    );
}

#[test]
fn recording_from_beyond_the_end_is_refused_or_noted() {
    let folder = folder();
    let typed = "run s.json --save a.rrd --record-from 30";
    refused(
        folder.path(),
        typed,
        2,
        &["--record-from 30: the run ends at 1 s"],
    );
    let stops = SCENARIO.replacen('{', r#"{"stop": {"idle_secs": 0.2}, "#, 1);
    fs::write(folder.path().join("stops.json"), stops).unwrap();
    let typed = "run stops.json --save a.rrd --record-from 0.9";
    let output = run(folder.path(), typed);
    assert_eq!(output.status.code(), Some(0));
    assert!(
        stderr(&output).contains("note: no frame was recorded"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn the_updated_file_must_have_places_for_tables_and_lie_outside_of_the_results() {
    let folder = folder();
    fs::write(folder.path().join("report.md"), "mine").unwrap();
    for command in [
        "stress --quick",
        "accuracy --quick",
        "reproduce table1",
        "verify",
    ] {
        let typed = format!("{command} --out new --update report.md");
        refused(
            folder.path(),
            &typed,
            2,
            &["--update report.md", "no place for a table"],
        );
        let typed = format!("{command} --out . --update report.md");
        refused(folder.path(), &typed, 2, &["--update report.md", "--out ."]);
        let typed = format!("{command} --out new --update dir");
        refused(
            folder.path(),
            &typed,
            1,
            &["--update dir", "it is a folder"],
        );
    }
}

#[test]
fn a_file_is_replaced_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "before").unwrap();
    let failed = write_whole(&file, |_| Err(std::io::Error::other("full")));
    assert!(failed.is_err());
    let all = BTreeMap::from([("file".to_owned(), Some(b"before".to_vec()))]);
    assert_eq!(contents(folder.path()), all);
    symlink("round", folder.path().join("round")).unwrap();
    let mut outputs = Outputs::new(true);
    outputs.writes("--out", &folder.path().join("round"), Manner::Whole);
    assert!(matches!(outputs.check(), Err(OutputsError::Unwritable(..))));
}
