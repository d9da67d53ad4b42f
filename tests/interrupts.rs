//! Ctrl-C: a run finishes its current frame and closes its outputs; a second Ctrl-C ends it at once.
#![cfg(unix)]

use std::fs;

use crate::common::program::{json, start_and_wait, stderr, stop_with, text};

/// A run of one person that lasts for days.
const LONG: &str = r#"{"duration_secs": 1e6, "agents": [{"position": [0, 0], "goal": [9, 0]}]}"#;

#[test]
fn outputs_of_an_interrupted_run_are_complete_up_to_its_last_frame() {
    use std::collections::BTreeMap;

    let folder = tempfile::tempdir().unwrap();
    let [rrd, csv] = ["concert.rrd", "concert.csv"].map(|name| folder.path().join(name));
    let files = ["--save", text(&rrd), "--trajectory", text(&csv)];
    let run = [&["concert", "--json"][..], &files].concat();
    let output = stop_with(
        start_and_wait(&run, &[(&rrd, 1_000), (&csv, 100_000)]),
        "kill -INT $1",
    );
    let stderr = stderr(&output);
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("interrupted at "), "{stderr}");

    let report = json(&output);
    assert_eq!(report["interrupted"], true);
    let last = report["frames"].as_u64().unwrap() / 5;
    assert!(last < 1800, "it had ended by itself");

    let mut people: BTreeMap<u64, usize> = BTreeMap::new();
    let mut reader = csv::Reader::from_path(&csv).unwrap();
    for row in reader.deserialize() {
        let row: BTreeMap<String, String> = row.unwrap();
        *people.entry(row["frame"].parse().unwrap()).or_default() += 1;
    }
    assert!(people.keys().copied().eq(0..=last));
    assert!(
        people.values().all(|rows| rows % 100 == 0),
        "100 enter at once"
    );

    let recording = crate::common::recording::Recording::read(&rrd);
    let crowd = recording.pairs("/world/agents", "Points2D:positions");
    let recorded = crowd.iter();
    let recorded = recorded.map(|(frame, places)| (frame.cast_unsigned() / 5, places.len()));
    assert_eq!(recorded.collect::<BTreeMap<_, _>>(), people);
}

#[test]
fn sigterm_ends_a_run_with_its_summary() {
    let folder = tempfile::tempdir().unwrap();
    let [file, sqlite] = ["long.json", "long.sqlite"].map(|name| folder.path().join(name));
    fs::write(&file, LONG).unwrap();
    let run = ["run", text(&file), "--trajectory", text(&sqlite)];
    let output = stop_with(start_and_wait(&run, &[(&sqlite, 0)]), "kill -TERM $1");
    assert_eq!(output.status.code(), Some(143));
    let summary = String::from_utf8(output.stdout).unwrap();
    assert!(
        summary.contains("It ended: it was interrupted."),
        "{summary}"
    );
    let frames = summary.lines().next().unwrap().strip_suffix(" frames");
    let frames: i64 = frames.unwrap().rsplit(' ').next().unwrap().parse().unwrap();
    let connection = rusqlite::Connection::open(&sqlite).unwrap();
    let query = "SELECT max(frame), count(*) FROM frame_data";
    let found = connection.query_row(query, [], |row| Ok((row.get(0)?, row.get(1)?)));
    assert_eq!(found, Ok((frames / 5, frames / 5 + 1)));
    assert!(!folder.path().join("long.sqlite-journal").exists());
}

/// Trajectories of 40 people in 20,000 frames.
fn tracks() -> String {
    let frames = 0..20_000;
    let row = |frame: i32, id: i32| {
        let x = f64::from(frame % 500) * 0.02;
        format!("{id} {frame} {x} {}\n", f64::from(id) * 0.5)
    };
    let rows = frames.flat_map(|frame| (1..=40).map(move |id| row(frame, id)));
    format!(
        "# framerate: 25\n# id frame x/m y/m\n{}",
        rows.collect::<String>()
    )
}

#[test]
fn every_long_command_ends_by_sigterm() {
    use std::os::unix::process::ExitStatusExt;
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("long.json", LONG);
    write("tracks.txt", &tracks());
    write("study.json", r#"{"scenario": "long.json", "seeds": 3}"#);
    for typed in [
        "run long.json",
        "report long.json --out r.pdf",
        "report long.json --at 1000 --at 900000 --out r.html",
        "draw long.json --at 900000 --out d.svg",
        "draw long.json --from 10 --to 9000 --fps 10 --out d.gif",
        "draw long.json --egress --out e.svg",
        "draw tracks.txt --unit m --from 0 --to 790 --fps 25 --out t.gif",
        "inspect long.json --agent 0 --at 900000",
        "measure tracks.txt --unit m --line 5,0,5,20 --out measured",
        "sweep study.json --out swept",
        "estimate long.json --error time_secs=5%",
        "reproduce all --out reproduced",
        "calibrate headway --out calibrated",
        "bench stages --out benched",
        "accuracy --out accurate",
        "stress --out stressed",
        "verify --out verified",
        "validate --out validated",
    ] {
        let mut child = Command::new(crate::common::program::PROGRAM)
            .args(typed.split(' '))
            .current_dir(folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(1500));
        if let Some(status) = child.try_wait().unwrap() {
            let output = child.wait_with_output().unwrap();
            panic!("{typed} has ended: {status}: {}", stderr(&output));
        }
        let number = child.id().to_string();
        assert!(
            Command::new("kill")
                .args(["-TERM", &number])
                .status()
                .unwrap()
                .success()
        );
        let start = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            if start.elapsed() > Duration::from_secs(60) {
                child.kill().unwrap();
                panic!("{typed} goes on after SIGTERM");
            }
            std::thread::sleep(Duration::from_millis(10));
        };
        assert!(
            status.code() == Some(143) || status.signal() == Some(15),
            "{typed}: {status}"
        );
        // Neither half of a picture nor a temporary file is left.
        let names = fs::read_dir(folder.path()).unwrap().flatten();
        let names = names.map(|entry| entry.file_name().into_string().unwrap());
        let left: Vec<String> = names.filter(|name| name.contains('.')).collect();
        assert_eq!(left.len(), 3, "{typed}: {left:?}");
    }
}

#[test]
fn a_second_ctrl_c_ends_the_run_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let txt = folder.path().join("plaza.txt");
    let run = ["plaza", "--trajectory", text(&txt)];
    let often = "for k in 1 2 3 4 5 6 7 8 9; do kill -INT $1; sleep 0.002; done";
    let output = stop_with(start_and_wait(&run, &[(&txt, 0)]), often);
    assert_eq!(output.status.code(), Some(130));
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "", "no summary");
}
