//! Running studies: shards, kept results, failures and merging.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::Mutex;

use crate::common::sweep::{ROOM, cases, column, folder, put, rows};
use sandbox::analysis::statistics::student_95;
use sandbox::lab::sweep::{Cell, Gathered, Shard, State, Study, run};
use sandbox::runs::job::{Listener, Tally};
use sandbox::runs::store::Store;

/// Records the progress of a run.
#[derive(Default)]
struct Log {
    begun: Mutex<Vec<[usize; 2]>>,
    finished: Mutex<Vec<usize>>,
    failed: Mutex<Vec<usize>>,
    notes: Mutex<Vec<String>>,
    seconds: Mutex<[f64; 2]>,
}

/// The number of cells of a study that are finished, failed and missing.
fn counts(study: &Study, out: &Path) -> [usize; 3] {
    let states = Gathered::of(study, &Store::at(out)).states;
    let count = |name| states.iter().filter(|state| state.name() == name).count();
    ["finished", "failed", "missing"].map(count)
}

impl Listener for Log {
    fn begins(&self, cells: usize, kept: usize, seconds: f64) {
        self.begun.lock().unwrap().push([cells, kept]);
        self.seconds.lock().unwrap()[0] += seconds;
    }
    fn advances(&self, seconds: f64) {
        self.seconds.lock().unwrap()[1] += seconds;
    }
    fn finishes(&self, job: &str, _: f64) {
        self.finished.lock().unwrap().push(number(job));
    }
    fn fails(&self, job: &str, _: &str) {
        self.failed.lock().unwrap().push(number(job));
    }
    fn notes(&self, text: &str) {
        self.notes.lock().unwrap().push(text.to_owned());
    }
}

/// The number in the name of a cell's job, such as `cell 3: seed=1`.
fn number(job: &str) -> usize {
    let number = job.strip_prefix("cell ").unwrap().split(':').next();
    number.unwrap().parse().unwrap()
}

/// Two gas constants, two profiles, three seeds.
const GRID: &str = r#"{"scenario": "room.json", "seeds": 3,
    "grid": {"gas_constant": [100, 200], "profile": ["sph", "sf->sph"]}}"#;

fn run_in(study: &Study, out: &Path, shard: Shard) -> (Tally, Log) {
    let log = Log::default();
    let store = Store::open(out).unwrap();
    let tally = run(study, shard, &store, &log).unwrap();
    (tally, log)
}

fn write(study: &Study, out: &Path) {
    let store = Store::at(out);
    let findings = Gathered::of(study, &store).findings(None).unwrap();
    findings.write(out).unwrap();
}

#[test]
fn merged_shards_equal_the_whole_study() {
    let (folder, path) = folder(GRID);
    let study = Study::read(&path, None).unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    let (tally, log) = run_in(&study, &whole, Shard::WHOLE);
    assert_eq!([tally.jobs, tally.finished, tally.kept], [12, 12, 0]);
    let [expected, advanced] = *log.seconds.lock().unwrap();
    assert!(
        (expected - advanced).abs() < 1e-9 * expected,
        "the bar comes to its end"
    );
    for number in [2, 5, 1, 4, 3] {
        let shard = Shard::new(number, 5).unwrap();
        let (tally, _) = run_in(&study, &parts, shard);
        assert_eq!(
            tally.jobs,
            study.cells.iter().filter(|c| shard.has(c.number)).count()
        );
        assert_eq!(tally.finished, tally.jobs);
    }
    write(&study, &whole);
    write(&study, &parts);
    let read = |out: &Path, file: &str| rows(&out.join(file));
    assert_eq!(read(&whole, "study.csv"), read(&parts, "study.csv"));
    assert_eq!(
        read(&whole, "study-summary.csv"),
        read(&parts, "study-summary.csv")
    );
    assert_eq!(cases(&whole, ".json").len(), 12);
    assert!(cases(&whole, ".lock").is_empty());
    let hashes = column(&read(&whole, "study.csv"), "state_sha256");
    assert_eq!(
        hashes.iter().collect::<BTreeSet<_>>().len(),
        12,
        "settings and seeds matter"
    );
}

#[test]
fn finished_cells_are_not_run_again_and_a_changed_study_runs_only_new_cells() {
    let (folder, path) = folder(GRID);
    let out = folder.path().join("out");
    run_in(&Study::read(&path, None).unwrap(), &out, Shard::WHOLE);
    let (tally, log) = run_in(&Study::read(&path, None).unwrap(), &out, Shard::WHOLE);
    assert_eq!([tally.finished, tally.kept], [0, 12]);
    assert!(log.finished.lock().unwrap().is_empty());
    let wider = GRID
        .replace("[100, 200]", "[300, 200, 100]")
        .replace("3,\n", "4,\n");
    let study = Study::read(&put(folder.path(), &wider), None).unwrap();
    let (tally, log) = run_in(&study, &out, Shard::WHOLE);
    assert_eq!([tally.jobs, tally.kept, tally.finished], [24, 12, 12]);
    let is_new = |cell: &&Cell| cell.values[0].1 == 300 || cell.case.seed == 4;
    let new: BTreeSet<usize> = study
        .cells
        .iter()
        .filter(is_new)
        .map(|c| c.number)
        .collect();
    let ran: BTreeSet<usize> = log.finished.lock().unwrap().iter().copied().collect();
    assert_eq!(ran, new);
}

#[test]
fn two_runs_at_once_in_one_folder_share_the_work() {
    let (folder, path) = folder(&GRID.replace("\"seeds\": 3", "\"seeds\": 12"));
    let study = Study::read(&path, None).unwrap();
    let out = folder.path().join("out");
    Store::open(&out).unwrap();
    let [(one, log_of_one), (other, log_of_other)] = std::thread::scope(|scope| {
        let begin = || scope.spawn(|| run_in(&study, &out, Shard::WHOLE));
        [begin(), begin()].map(|thread| thread.join().unwrap())
    });
    for tally in [&one, &other] {
        assert!(tally.failed.is_empty());
        assert_eq!(tally.finished + tally.kept + tally.by_others, 48);
    }
    let finished = [log_of_one, log_of_other].map(|log| log.finished.into_inner().unwrap());
    let mut finished = finished.concat();
    finished.sort_unstable();
    assert_eq!(finished, (1..=48).collect::<Vec<_>>(), "each once");
    assert!(cases(&out, ".lock").is_empty());
}

#[test]
fn a_lock_left_by_a_killed_process_is_ignored() {
    let (folder, path) = folder(r#"{"scenario": "room.json"}"#);
    let study = Study::read(&path, None).unwrap();
    let out = folder.path().join("out");
    Store::open(&out).unwrap();
    let left = out.join(format!("cases/{}.lock", study.cells[0].case.key));
    fs::write(&left, "").unwrap();
    assert_eq!(run_in(&study, &out, Shard::WHOLE).0.finished, 1);
    assert!(!left.exists());
}

#[test]
fn a_failed_cell_is_recorded_and_the_others_finish() {
    let (folder, path) = folder(
        r#"{"scenario": "crack.json", "seeds": 2,
            "grid": {"sources.0.jitter": [1, 0, 1e-8]}}"#,
    );
    let study = Study::read(&path, None).unwrap();
    let out = folder.path().join("out");
    let (tally, log) = run_in(&study, &out, Shard::WHOLE);
    assert_eq!([tally.finished, tally.failed.len()], [4, 2]);
    let (cell, message) = &tally.failed[0];
    assert_eq!(cell, "cell 1: sources.0.jitter=1 seed=1");
    assert!(message.contains("no free point"), "{message}");
    let mut failed = log.failed.into_inner().unwrap();
    failed.sort_unstable();
    assert_eq!(failed, [1, 2]);
    write(&study, &out);
    let table = rows(&out.join("study.csv"));
    assert_eq!(
        column(&table, "status")[..3],
        ["failed", "failed", "finished"]
    );
    assert_eq!(column(&table, "error")[0], *message);
    assert_eq!(column(&table, "state_sha256")[1], "");
    assert_eq!(
        column(&rows(&out.join("study-summary.csv")), "runs"),
        ["0", "2", "2"]
    );
    let (again, _) = run_in(&study, &out, Shard::WHOLE);
    assert_eq!(
        [again.kept, again.finished, again.failed.len()],
        [4, 0, 2],
        "only these again"
    );
    let store = Store::at(&out);
    assert_eq!(store.failure(&study.cells[0].case.key).unwrap().attempts, 2);
}

#[test]
fn the_failure_of_a_cell_is_removed_when_the_cell_finishes() {
    let (folder, path) = folder(r#"{"scenario": "room.json", "seeds": 2}"#);
    let study = Study::read(&path, None).unwrap();
    let out = folder.path().join("out");
    let scenario = folder.path().join("room.json");
    fs::write(&scenario, ROOM.replace("0.4", "0.3")).unwrap();
    let (tally, _) = run_in(&study, &out, Shard::WHOLE);
    assert_eq!(tally.failed.len(), 2);
    assert!(
        tally.failed[0].1.contains("has changed"),
        "{:?}",
        tally.failed
    );
    fs::write(&scenario, ROOM).unwrap();
    assert_eq!(run_in(&study, &out, Shard::WHOLE).0.finished, 2);
    assert_eq!(counts(&study, &out), [2, 0, 0]);
    assert_eq!(cases(&out, ".json").len(), 2, "no failure is left");
}

#[test]
fn a_damaged_result_is_computed_again() {
    let (folder, path) = folder(r#"{"scenario": "room.json", "seeds": 2}"#);
    let study = Study::read(&path, None).unwrap();
    let out = folder.path().join("out");
    run_in(&study, &out, Shard::WHOLE);
    let before = Gathered::of(&study, &Store::at(&out));
    let file = out.join(format!("cases/{}.json", study.cells[1].case.key));
    fs::write(&file, "{\"key\"").unwrap();
    let (tally, log) = run_in(&study, &out, Shard::WHOLE);
    assert_eq!([tally.kept, tally.finished], [1, 1]);
    assert!(log.notes.into_inner().unwrap()[0].contains(file.to_str().unwrap()));
    let hash = |gathered: &Gathered| {
        let State::Finished(result) = &gathered.states[1] else {
            panic!("not finished");
        };
        result.summary.state_sha256.clone()
    };
    assert_eq!(hash(&Gathered::of(&study, &Store::at(&out))), hash(&before));
}

#[test]
fn equal_cells_are_computed_once_and_counted_as_repeated() {
    let (folder, path) = folder(
        r#"{"scenario": "room.json", "list": [{"seed": 1}, {"seed": 2}, {"seed": 1, "profile": "sph"}]}"#,
    );
    let study = Study::read(&path, None).unwrap();
    let out = folder.path().join("out");
    let counts = |tally: &Tally| [tally.jobs, tally.finished, tally.kept, tally.repeated];
    assert_eq!(counts(&run_in(&study, &out, Shard::WHOLE).0), [3, 2, 0, 1]);
    assert_eq!(counts(&run_in(&study, &out, Shard::WHOLE).0), [3, 0, 2, 1]);
}

#[test]
fn the_summary_has_means_over_seeds_with_confidence_intervals() {
    let (folder, path) = folder(GRID);
    let study = Study::read(&path, None).unwrap();
    let out = folder.path().join("out");
    run_in(&study, &out, Shard::WHOLE);
    write(&study, &out);
    let numbers = |file: &str, name: &str| -> Vec<f64> {
        let values = column(&rows(&out.join(file)), name);
        values.iter().map(|value| value.parse().unwrap()).collect()
    };
    let values = numbers("study.csv", "density_mean_0.2s");
    let means = numbers("study-summary.csv", "density_mean_0.2s_mean");
    let intervals = numbers("study-summary.csv", "density_mean_0.2s_ci95");
    assert_eq!(
        numbers("study-summary.csv", "density_mean_0.2s_n"),
        [3.0; 4]
    );
    for (k, seeds) in values.chunks(3).enumerate() {
        let mean = seeds.iter().sum::<f64>() / 3.0;
        let variance = seeds.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 2.0;
        let interval = student_95(3).unwrap() * (variance / 3.0).sqrt();
        assert!((means[k] - mean).abs() < 1e-12 && (intervals[k] - interval).abs() < 1e-12);
        assert!(interval > 0.0);
    }
    let combination = column(&rows(&out.join("study-summary.csv")), "profile");
    assert_eq!(combination, ["sph", "sf->sph", "sph", "sf->sph"]);
}

#[test]
fn missing_cells_have_a_row_too() {
    let (folder, path) = folder(GRID);
    let study = Study::read(&path, None).unwrap();
    let out = folder.path().join("out");
    run_in(&study, &out, Shard::new(2, 3).unwrap());
    write(&study, &out);
    let table = rows(&out.join("study.csv"));
    assert_eq!(
        column(&table, "status")[..4],
        ["missing", "finished", "missing", "missing"]
    );
    assert_eq!(counts(&study, &out), [4, 0, 8]);
    let summary = rows(&out.join("study-summary.csv"));
    assert_eq!(column(&summary, "runs"), ["1"; 4]);
    assert_eq!(
        column(&summary, "evacuated_ci95"),
        [""; 4],
        "one value has no interval"
    );
}

#[test]
fn a_study_with_memory_for_one_cell_at_a_time_gives_the_same_results() {
    let (folder, path) = folder(GRID);
    let study = Study::read(&path, None).unwrap();
    let bytes = study.cells.iter().map(|cell| cell.case.need.bytes()).max();
    let tight = Study::read(&path, bytes).unwrap();
    let cells = [(study, "free"), (tight, "tight")].map(|(study, name)| {
        let out = folder.path().join(name);
        let (tally, _) = run_in(&study, &out, Shard::WHOLE);
        assert_eq!([tally.jobs, tally.finished], [12, 12]);
        let store = Store::at(&out);
        let states = Gathered::of(&study, &store).states.into_iter();
        let summary = |state| match state {
            State::Finished(result) => result.summary,
            _ => panic!("not finished"),
        };
        states.map(summary).collect::<Vec<_>>()
    });
    assert!(cells[0] == cells[1]);
}

#[test]
fn labels_name_cells_and_measurements_are_added_to_the_scenarios_own() {
    let (folder, path) = folder(
        r#"{"scenario": "room.json", "measurements": [{"closest": {}}], "seeds": 2,
            "list": [{"label": "soft", "gas_constant": 100}, {"label": "stiff", "gas_constant": 400}]}"#,
    );
    let study = Study::read(&path, None).unwrap();
    assert_eq!(study.axes, ["label", "gas_constant"]);
    assert_eq!(study.cells[2].label(), Some("stiff"));
    let (tally, log) = run_in(&study, folder.path(), Shard::WHOLE);
    assert_eq!((tally.finished, log.failed.lock().unwrap().len()), (4, 0));
    let store = Store::at(folder.path());
    let gathered = Gathered::of(&study, &store);
    for label in ["soft", "stiff"] {
        let (cell, result) = gathered.labeled(label).unwrap();
        let scenario = cell.case.scenario().unwrap();
        let own = sandbox::scenario::Scenario::parse(ROOM, "room.json", &[]).unwrap();
        assert_eq!(scenario.measurements.len(), own.measurements.len() + 1);
        let closest = result.summary.metric("closest_centers").unwrap();
        assert!((0.0..=1.0).contains(&closest), "{closest}");
    }
    assert!(gathered.labeled("softer").is_err());
    // A terminal shows the labels, not the settings behind them.
    let text = gathered.findings(None).unwrap().document.text();
    assert!(
        text.contains("stiff") && !text.contains("gas_constant"),
        "{text}"
    );
}

#[test]
fn a_result_of_another_case_or_a_damaged_one_is_computed_again() {
    let (folder, path) = folder(r#"{"scenario": "room.json", "seeds": 2}"#);
    let study = Study::read(&path, None).unwrap();
    let out = folder.path().join("out");
    run_in(&study, &out, Shard::WHOLE);
    let files = cases(&out, ".json");
    for spoil in [0, 1] {
        match spoil {
            0 => _ = fs::copy(&files[0], &files[1]).unwrap(),
            _ => fs::write(&files[1], "{").unwrap(),
        }
        // Until then it counts as failed, with its file.
        let gathered = Gathered::of(&study, &Store::at(&out));
        let states = gathered.states.iter().filter_map(|state| match state {
            State::Failed(reason) => Some(reason.as_str()),
            _ => None,
        });
        let [reason] = states.collect::<Vec<_>>()[..] else {
            panic!("one cell is damaged");
        };
        assert!(reason.starts_with(files[1].to_str().unwrap()), "{reason}");
        let (tally, log) = run_in(&study, &out, Shard::WHOLE);
        assert_eq!((tally.kept, tally.finished), (1, 1));
        assert!(log.notes.lock().unwrap()[0].contains("computed again"));
    }
}
