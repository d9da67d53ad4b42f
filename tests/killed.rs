//! After `kill -9` at any moment, data recorded more than two seconds earlier is readable.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::time::Duration;

use crate::common::program::{start_and_wait, text};
use crate::common::recording::Recording;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::runs::checkpoint::Checkpoint;

/// The number of runs that are killed.
const KILLED: u64 = 50;
/// The number of runs at a time.
const AT_A_TIME: u64 = 5;
/// Data older than this is safe.
const SAFE: Duration = Duration::from_secs(2);

/// 100 people who stay for days. One frame in 50 is recorded in every output.
const LONG: &str = r#"{
  "duration_secs": 1e6, "profile": "rvo->sph", "goal": [5, 5],
  "grids": [{"min": [0, 0], "max": [10, 10], "columns": 10, "rows": 10}]
}"#;

/// The last frame in the CSV file, which is written without delay, numbered as in the recording.
fn last_frame(csv: &Path) -> u64 {
    let text = fs::read_to_string(csv).unwrap();
    let whole = text.rsplit_once('\n').unwrap().0;
    let last = whole.lines().last().unwrap();
    50 * last.split(',').next().unwrap().parse::<u64>().unwrap()
}

/// Kills a run at a random moment and checks its outputs.
fn kill_one(seed: u64) {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let [scenario, rrd, csv] = ["long.json", "a.rrd", "a.csv"].map(file);
    let [sqlite, checkpoint] = ["a.sqlite", "a.checkpoint"].map(file);
    fs::write(&scenario, LONG).unwrap();
    let mut run = vec![
        "run",
        text(&scenario),
        "--threads",
        "1",
        "--record-every",
        "50",
    ];
    run.extend(["--save", text(&rrd), "--checkpoint", text(&checkpoint)]);
    run.extend(["--trajectory", text(&csv), "--trajectory", text(&sqlite)]);
    run.extend(["--trajectory-fps", "1"]);
    let mut child = start_and_wait(&run, &[(&csv, 40_000), (&checkpoint, 0)]);
    let pause = ChaCha8Rng::seed_from_u64(seed).random_range(0.0..1.0);
    std::thread::sleep(Duration::from_secs_f64(pause));
    let safe = last_frame(&csv);
    std::thread::sleep(SAFE);
    // On a busy machine the run may have had no time of its own since then.
    let later = last_frame(&csv);
    while last_frame(&csv) < later + 2 * 50 {
        std::thread::sleep(Duration::from_millis(10));
    }
    child.kill().unwrap(); // SIGKILL
    child.wait().unwrap();

    let recording = Recording::read(&rrd);
    let crowd = recording.pairs("/world/agents", "Points2D:positions");
    let frames: Vec<u64> = crowd
        .iter()
        .map(|(frame, _)| frame.cast_unsigned())
        .collect();
    let last = *frames.last().unwrap();
    assert!(
        last >= safe,
        "seed {seed}: the recording ends at {last} of {safe}"
    );
    assert!(
        frames.iter().copied().eq((0..=last).step_by(50)),
        "seed {seed}"
    );
    assert!(crowd.iter().all(|(_, places)| places.len() == 100));

    let connection = rusqlite::Connection::open(&sqlite).unwrap();
    let rows = "SELECT max(frame), count(*) FROM trajectory_data";
    let rows = connection.query_row(rows, [], |row| Ok((row.get(0)?, row.get(1)?)));
    let (last, rows): (i64, i64) = rows.unwrap();
    assert!(
        50 * last.unsigned_abs() >= safe,
        "seed {seed}: SQLite ends at {last} of {safe}"
    );
    assert_eq!(rows, 100 * (last + 1), "seed {seed}");

    let left = Checkpoint::read(&checkpoint).unwrap();
    assert!(left.is_of_this_engine());
}

#[test]
fn data_recorded_two_seconds_before_a_kill_is_readable() {
    std::thread::scope(|scope| {
        let kill_some = |first| {
            for seed in (first..KILLED).step_by(AT_A_TIME as usize) {
                kill_one(seed);
            }
        };
        for first in 0..AT_A_TIME {
            scope.spawn(move || kill_some(first));
        }
    });
}
