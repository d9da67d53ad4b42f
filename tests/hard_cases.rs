//! Full disks, and folders that cannot be created or that vanish: exit code 1, one error line that names the path,
//! and earlier results are kept.
#![cfg(target_os = "linux")]

use std::fs::{self, File};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output};
use std::time::Duration;

use crate::common::program::{self, PROGRAM, json, start_and_wait, stderr, stop_with, text};

/// Runs the program with files limited to `blocks` KiB, as on a disk that fills up.
fn with_file_limit(blocks: u32, arguments: &[&str]) -> Output {
    let limit = format!(r#"trap "" XFSZ; ulimit -f {blocks}; exec "$0" "$@""#);
    let mut bash = Command::new("bash");
    let bash = bash.args(["-c", &limit, PROGRAM]).args(arguments);
    bash.output().unwrap()
}

/// Expects exit code 1, and returns the only error line on stderr, which must be the last line.
fn only_error(arguments: &[&str], output: &Output) -> String {
    only_error_of(1, arguments, output)
}

/// The same with another exit code.
fn only_error_of(code: i32, arguments: &[&str], output: &Output) -> String {
    let stderr = stderr(output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    let mut lines = stderr.lines().filter(|line| !line.starts_with("note: "));
    let errors: Vec<&str> = lines
        .by_ref()
        .filter(|l| l.starts_with("error: "))
        .collect();
    assert_eq!(errors.len(), 1, "{arguments:?}: {stderr}");
    assert!(stderr.ends_with(&format!("{}\n", errors[0])), "{stderr}");
    errors[0].to_owned()
}

/// Commands that write a file or folder: the arguments before its path, and its extension (none for a folder).
const WRITERS: [(&[&str], &str); 9] = [
    (
        &["evacuation", "--until", "0.1", "--force", "--save"],
        "rrd",
    ),
    (
        &["evacuation", "--until", "0.1", "--force", "--trajectory"],
        "csv",
    ),
    (
        &["evacuation", "--until", "0.1", "--force", "--trajectory"],
        "txt",
    ),
    (
        &["evacuation", "--until", "0.1", "--force", "--trajectory"],
        "sqlite",
    ),
    (
        &["inspect", "evacuation", "--agent", "1", "--force", "--save"],
        "rrd",
    ),
    (&["reproduce", "table1", "--out"], ""),
    (&["bench", "threads", "--quick", "--out"], ""),
    (&["stress", "--quick", "--out"], ""),
    (&["accuracy", "--quick", "--out"], ""),
];

#[test]
fn an_unwritable_path_is_named_before_anything_is_computed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "precious").unwrap();
    let man: (&[&str], _) = (&["generate", "man", "--out"], "");
    for (arguments, extension) in WRITERS.into_iter().chain([man]) {
        let below = file.join("x").with_extension(extension);
        let missing = folder.path().join("no").join("x").with_extension(extension);
        let is_folder = extension.is_empty();
        // A missing output folder is created, so that only a file in its place is an error.
        for path in [&below, if is_folder { &file } else { &missing }] {
            let arguments = [arguments, &[text(path)]].concat();
            let output = program::run(&arguments);
            // A folder that does not exist is a mistake in the command.
            let code = if *path == missing { 2 } else { 1 };
            let said = only_error_of(code, &arguments, &output);
            assert!(said.contains(text(path)), "{said}");
            assert!(output.stdout.is_empty(), "{arguments:?}");
        }
    }
    assert_eq!(fs::read(&file).unwrap(), b"precious");
}

#[test]
fn every_writer_names_its_path_on_a_full_disk() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, extension) in WRITERS
        .into_iter()
        .filter(|(_, extension)| !extension.is_empty())
    {
        let path = folder.path().join("full").with_extension(extension);
        symlink("/dev/full", &path).ok();
        let arguments = [arguments, &[text(&path)]].concat();
        let said = only_error(&arguments, &program::run(&arguments));
        assert!(said.contains(text(&path)), "{said}");
        assert!(said.ends_with("; nothing is in it"), "{said}");
    }
}

#[test]
fn a_full_disk_leaves_pictures_and_reports_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let draw = ["draw", "evacuation", "--at", "0.1"];
    let moving = [
        "draw",
        "evacuation",
        "--from",
        "0",
        "--to",
        "0.3",
        "--fps",
        "10",
    ];
    let egress = ["draw", "evacuation", "--egress"];
    let report = ["report", "evacuation", "--until", "0.2"];
    for (arguments, extension) in [
        (&draw[..], "svg"),
        (&draw, "png"),
        (&draw, "pdf"),
        (&moving, "gif"),
        (&moving, "png"),
        (&egress, "svg"),
        (&report, "html"),
        (&report, "pdf"),
    ] {
        let name = format!("full.{extension}");
        let path = folder.path().join(&name);
        let arguments = [arguments, &["--force", "--out", text(&path)]].concat();
        for precious in [None, Some("precious")] {
            if let Some(precious) = precious {
                fs::write(&path, precious).unwrap();
            }
            let said = only_error(&arguments, &with_file_limit(4, &arguments));
            assert!(
                said.contains(text(&path)) && said.contains("File too large"),
                "{said}"
            );
            assert_eq!(
                fs::read_to_string(&path).ok().as_deref(),
                precious,
                "{arguments:?}"
            );
            let names = fs::read_dir(folder.path()).unwrap().flatten();
            let names: Vec<_> = names.map(|entry| entry.file_name()).collect();
            assert_eq!(
                names,
                Vec::from_iter(precious.map(|_| name.as_str())),
                "{arguments:?}"
            );
        }
        assert_eq!(
            program::run(&arguments).status.code(),
            Some(0),
            "{arguments:?}"
        );
        assert!(fs::read(&path).unwrap() != b"precious", "{arguments:?}");
        fs::remove_file(&path).unwrap();
    }
    // Devices are written in place.
    let device = folder.path().join("device.svg");
    symlink("/dev/full", &device).unwrap();
    let said = program::run(&[&draw[..], &["--force", "--out", text(&device)]].concat());
    let said = stderr(&said);
    assert!(
        said.contains("device.svg: No space left on device"),
        "{said}"
    );
    assert!(fs::symlink_metadata(&device).unwrap().is_symlink());
}

#[test]
fn unprintable_results_are_an_error_and_unprintable_notes_are_not() {
    let full = || File::create("/dev/full").unwrap();
    let run = [
        "evacuation",
        "--until",
        "0.2",
        "--time-step",
        "0.1",
        "--json",
    ];
    for arguments in [
        &["list"][..],
        &["generate", "zsh"],
        &["generate", "man"],
        &run,
    ] {
        let mut program = Command::new(PROGRAM);
        let output = program.args(arguments).stdout(full()).output().unwrap();
        let stderr = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(stderr.contains("error: stdout: No space"), "{stderr}");
    }
    assert!(!program::run(&run).stderr.is_empty(), "a warning");
    let mut program = Command::new(PROGRAM);
    let output = program.args(run).stderr(full()).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(json(&output)["frames"], 2);
}

/// The number of frames in a trajectory file, all of which must be complete.
fn frames(path: &Path) -> u64 {
    if path.extension().unwrap() == "sqlite" {
        let connection = rusqlite::Connection::open(path).unwrap();
        let whole = "SELECT count(*), (SELECT count(*) FROM trajectory_data) FROM frame_data";
        let count = connection.query_row(whole, [], |row| Ok((row.get(0)?, row.get(1)?)));
        let (frames, rows): (i64, i64) = count.unwrap();
        assert_eq!(rows, 400 * frames);
        return frames.unsigned_abs();
    }
    let lines = fs::read_to_string(path).unwrap();
    assert!(lines.ends_with('\n'));
    let is_row = |line: &&str| line.starts_with(|c: char| c.is_ascii_digit());
    let rows = lines.lines().filter(is_row).count();
    assert_eq!(rows % 400, 0);
    rows as u64 / 400
}

#[test]
fn a_disk_that_fills_up_leaves_whole_frames_and_the_error_counts_them() {
    let folder = tempfile::tempdir().unwrap();
    for extension in ["csv", "txt", "sqlite"] {
        let path = folder.path().join("run").with_extension(extension);
        let run = [
            "evacuation",
            "--profile",
            "sf",
            "--until",
            "6",
            "--trajectory",
            text(&path),
        ];
        let output = with_file_limit(400, &run);
        let said = only_error(&run, &output);
        assert!(said.contains(text(&path)), "{said}");
        let kept = frames(&path);
        let words = match kept {
            0 => "nothing is in it".to_owned(),
            kept => format!("its first {kept} frames are kept"),
        };
        assert!(said.ends_with(&words), "{kept}: {said}");
        assert!(kept > 0 || extension == "sqlite", "{said}");
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn a_recording_on_a_disk_that_fills_up_is_readable_and_the_run_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.rrd");
    let run = [
        "evacuation",
        "--until",
        "4",
        "--json",
        "--record-every",
        "1",
        "--save",
        text(&path),
    ];
    let output = with_file_limit(1_000, &run);
    let said = only_error(&run, &output);
    assert!(
        said.contains(text(&path)) && said.contains("File too large"),
        "{said}"
    );
    assert!(said.ends_with("; it opens, but ends early"), "{said}");
    assert_eq!(json(&output)["frames"], 200);
    let recording = crate::common::recording::Recording::read(&path);
    assert!(recording.entities().contains("/world/geometry/walls"));
}

#[test]
fn a_folder_that_vanishes_during_a_run_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    for extension in ["csv", "sqlite", "rrd"] {
        let place = folder.path().join("place");
        fs::create_dir(&place).unwrap();
        let path = place.join("run").with_extension(extension);
        let option = if extension == "rrd" {
            "--save"
        } else {
            "--trajectory"
        };
        let run = ["concert", option, text(&path)];
        let child = start_and_wait(&run, &[(&path, 0)]);
        fs::remove_dir_all(&place).unwrap();
        let output = stop_with(child, "kill -INT $1");
        let said = only_error(&run, &output);
        assert!(said.contains(text(&path)), "{said}");
        assert!(!said.contains("kept"), "{said}");
    }
}

#[test]
fn measurements_are_printed_even_if_they_cannot_be_saved() {
    let folder = tempfile::tempdir().unwrap();
    let run = [
        "bench",
        "threads",
        "--quick",
        "--json",
        "--out",
        text(folder.path()),
    ];
    let output = with_file_limit(0, &run);
    let said = only_error(&run, &output);
    assert!(
        said.contains(text(&folder.path().join("threads.json"))),
        "{said}"
    );
    assert_eq!(json(&output)["benchmark"], "threads");
}

#[test]
fn finished_cases_are_kept_and_counted_when_a_result_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = text(folder.path());
    let run = [
        "accuracy",
        "relaxed",
        "--knob",
        "integrator",
        "--quick",
        "--out",
        out,
    ];
    let place = folder.path().join("accuracy.json");
    let cases = folder.path().join("cases");
    // A case that has begun has a lock there.
    let is_result = |file: &Path| file.extension().is_some_and(|kind| kind == "json");
    let finished = || {
        let files = fs::read_dir(&cases).into_iter().flatten().flatten();
        files.filter(|file| is_result(&file.path())).count()
    };
    // In the way from the start: refused before anything is computed.
    fs::create_dir(&place).unwrap();
    let said = only_error(&run, &program::run(&run));
    assert!(said.contains(text(&place)), "{said}");
    assert_eq!(finished(), 0);
    fs::remove_dir(&place).unwrap();
    // In the way from the first finished case on: named at the end.
    let mut child = start_and_wait(&run, &[]);
    while finished() == 0 {
        assert_eq!(child.try_wait().unwrap(), None, "the run has ended");
        std::thread::sleep(Duration::from_millis(1));
    }
    fs::create_dir(&place).unwrap();
    let said = only_error(&run, &child.wait_with_output().unwrap());
    assert!(said.contains(text(&place)), "{said}");
    let count = finished();
    assert!(count > 0, "{said}");
    let kept = format!("; {count} finished case(s) are kept in {}", text(&cases));
    assert!(said.ends_with(&kept), "{said}");
    fs::remove_dir(&place).unwrap();
    let again = program::run(&run);
    let stderr = stderr(&again);
    assert_eq!(again.status.code(), Some(0), "{stderr}");
    assert!(
        stderr.contains(&format!("0 case(s) to run, {count} kept")),
        "{stderr}"
    );
}
