//! `sandbox reproduce`: finished cases are kept, and four rows of Table 1 stay within their bands.

use std::fs;
use std::path::{Path, PathBuf};
use std::slice;
use std::sync::Mutex;

use sandbox::lab::reproduce::{
    Case, CaseResult, EvacuationRow, Key, Listener, PRODUCTS, Plan, ReproduceError, Row, Store,
    published, reproduce, run, table1_case,
};
use tempfile::TempDir;

/// Records the progress of a run.
#[derive(Default)]
struct Log {
    begun: Mutex<Vec<[usize; 2]>>,
    finished: Mutex<Vec<String>>,
    notes: Mutex<Vec<String>>,
    seconds: Mutex<[f64; 2]>,
}

impl Listener for Log {
    fn begins(&self, cases: usize, kept: usize, seconds: f64) {
        self.begun.lock().unwrap().push([cases, kept]);
        self.seconds.lock().unwrap()[0] += seconds;
    }
    fn advances(&self, seconds: f64) {
        self.seconds.lock().unwrap()[1] += seconds;
    }
    fn finishes(&self, result: &CaseResult) {
        self.finished.lock().unwrap().push(result.case.clone());
    }
    fn notes(&self, text: &str) {
        self.notes.lock().unwrap().push(text.to_owned());
    }
}

/// The evacuation, for half a second.
fn short(seed: u64) -> Case {
    Case::shipped("evacuation")
        .set("duration_secs", 0.5)
        .seed(seed)
        .taking(0.1)
}

fn store() -> (TempDir, Store) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path()).unwrap();
    (folder, store)
}

fn kept_files(store: &Store) -> Vec<PathBuf> {
    let files = fs::read_dir(store.path("cases")).unwrap();
    let mut files: Vec<PathBuf> = files.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// Runs cases; returns how many were computed and how many were kept, and the notes.
fn computed(store: &Store, cases: &[Case]) -> ([usize; 2], Vec<String>) {
    let log = Log::default();
    let results = run(store, cases, &log).unwrap();
    for case in cases {
        results.of(case).unwrap();
    }
    let begun = log.begun.lock().unwrap()[0];
    assert_eq!(log.finished.lock().unwrap().len(), begun[0]);
    let [expected, told] = *log.seconds.lock().unwrap();
    assert!((expected - told).abs() < 1e-9, "{told} of {expected}");
    (begun, log.notes.into_inner().unwrap())
}

#[test]
fn finished_cases_are_not_run_again_and_new_ones_are() {
    let (_folder, store) = store();
    assert_eq!(computed(&store, &[short(1), short(2)]).0, [2, 0]);
    let before: Vec<_> = kept_files(&store)
        .iter()
        .map(|file| fs::metadata(file).unwrap().modified().unwrap())
        .collect();
    assert_eq!(computed(&store, &[short(1), short(2), short(3)]).0, [1, 2]);
    let untouched = kept_files(&store)
        .iter()
        .filter(|file| before.contains(&fs::metadata(file).unwrap().modified().unwrap()))
        .count();
    assert_eq!(untouched, 2);
    // A partial file under a temporary name is ignored.
    fs::write(store.path("cases/.tmp1234"), "{").unwrap();
    assert_eq!(computed(&store, &[short(1), short(2), short(3)]).0, [0, 3]);
}

#[test]
fn kept_results_equal_computed_results() {
    let (_folder, store) = store();
    let case = short(4).snapshot(0.2);
    let first = run(&store, slice::from_ref(&case), &()).unwrap();
    let second = run(&store, slice::from_ref(&case), &()).unwrap();
    assert_eq!(first.of(&case).unwrap(), second.of(&case).unwrap());
    let snapshot = second.of(&case).unwrap().snapshot(0.2).unwrap();
    assert_eq!(snapshot.time_secs, 0.2);
    let missing = second.of(&case).unwrap().snapshot(0.3).unwrap_err();
    assert!(
        missing.to_string().contains("snapshot at 0.3 s"),
        "{missing}"
    );
    assert!(
        second
            .of(&short(5))
            .unwrap_err()
            .to_string()
            .contains("seed=5")
    );
}

#[test]
fn a_damaged_result_is_noted_and_computed_again() {
    let (_folder, store) = store();
    computed(&store, &[short(1)]);
    let file = kept_files(&store).remove(0);
    let whole = fs::read(&file).unwrap();
    fs::write(&file, &whole[..whole.len() / 2]).unwrap();
    let (begun, notes) = computed(&store, &[short(1)]);
    assert_eq!(begun, [1, 0]);
    assert!(notes[0].contains("computed again"), "{notes:?}");
    assert!(notes[0].contains(file.to_str().unwrap()), "{notes:?}");
    assert_eq!(computed(&store, &[short(1)]), ([0, 1], Vec::new()));
}

#[test]
fn a_result_of_another_case_is_not_used() {
    let (_folder, store) = store();
    computed(&store, &[short(1), short(2)]);
    let files = kept_files(&store);
    fs::copy(&files[0], &files[1]).unwrap();
    let (begun, notes) = computed(&store, &[short(1), short(2)]);
    assert_eq!(begun, [1, 1]);
    assert!(notes[0].contains("another case"), "{notes:?}");
}

#[test]
fn equal_runs_are_run_once_and_keep_all_requested_snapshots() {
    let (_folder, store) = store();
    let (early, late) = (short(1).snapshot(0.1), short(1).snapshot(0.4));
    assert_eq!(computed(&store, &[early.clone(), late.clone()]).0, [1, 0]);
    assert_eq!(computed(&store, slice::from_ref(&late)).0, [0, 1]);
    // A new snapshot needs a new run, which keeps the old snapshots.
    assert_eq!(computed(&store, &[short(1).snapshot(0.3)]).0, [1, 0]);
    assert_eq!(computed(&store, &[early, late]).0, [0, 1]);
    assert_eq!(kept_files(&store).len(), 1);
}

fn key(case: &Case) -> Key {
    case.key().unwrap()
}

#[test]
fn keys_are_readable_and_distinguish_settings_seeds_and_runs_alone() {
    let case = || short(1).set("profile", "rvo->sph").set("gas_constant", 100);
    let others = [
        short(1),
        case().seed(2),
        case().set("gas_constant", 101),
        case().set("obstacles", "[]"),
        case().alone(),
    ];
    assert_eq!(key(&case()), key(&case().snapshot(0.1).taking(9.0)));
    for other in &others {
        assert_ne!(key(&case()).to_string(), key(other).to_string());
    }
    let name = key(&case()).to_string();
    assert!(name.starts_with("evacuation-duration_secs-0.5-seed-1-profile-rvo-to-sph"));
    assert!(!name.contains(['/', ' ', '>', '=']), "{name}");
}

#[test]
fn an_invalid_case_is_refused_before_anything_runs() {
    let (_folder, store) = store();
    let wrong = [short(1), short(1).set("gas_constant", -1)];
    let error = run(&store, &wrong, &()).err().unwrap();
    assert!(matches!(error, ReproduceError::Scenario { .. }), "{error}");
    assert!(error.to_string().contains("gas_constant"), "{error}");
    assert!(kept_files(&store).is_empty());
}

#[test]
fn an_unwritable_result_is_named_and_earlier_results_are_kept() {
    let (_folder, store) = store();
    // The longest cases begin first, so that `first` is finished by then.
    let (first, last) = (short(1).taking(1.0), short(2));
    let place = store.case_path(&key(&last));
    fs::create_dir(&place).unwrap();
    let error = run(&store, &[last, first.clone()], &()).err().unwrap();
    assert!(
        matches!(error, ReproduceError::Unwritable { .. }),
        "{error}"
    );
    assert!(
        error.to_string().contains(place.to_str().unwrap()),
        "{error}"
    );
    assert_eq!(computed(&store, &[first]).0, [0, 1]);
}

#[test]
fn a_folder_that_cannot_be_created_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    for place in [file.clone(), file.join("below")] {
        let error = Store::open(&place).unwrap_err().to_string();
        assert!(error.contains(place.to_str().unwrap()), "{error}");
    }
}

#[test]
fn every_product_has_a_unique_name_and_valid_cases() {
    let mut names: Vec<&str> = PRODUCTS.iter().map(|product| product.name).collect();
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count);
    for product in PRODUCTS {
        assert!(!product.about.is_empty());
        for case in (product.cases)(&Plan { seeds: 1 }).unwrap() {
            case.key().unwrap();
            assert!(case.expected_secs() > 0.0);
        }
    }
}

/// The row of Table 1 with this profile and value.
fn row(profile: &str, value: f64) -> EvacuationRow {
    let rows = published().unwrap().table1.rows;
    let mut found = rows
        .into_iter()
        .filter(|row| row.profile == profile && row.value == value);
    found.next().unwrap()
}

#[test]
fn four_rows_of_table_1_stay_inside_their_bands() {
    let (_folder, store) = store();
    // RVO chooses among random candidates, so that results vary between seeds by more than the width of a band.
    let rows = [
        (row("sph", 3.0), 1),
        (row("sph", 5.0), 1),
        (row("sf+sph", 3.0), 1),
        (row("rvo->sph", 5.0), 3),
    ];
    let seeds = rows
        .iter()
        .flat_map(|(row, seeds)| (1..=*seeds).map(move |seed| (row, seed)));
    let cases: Vec<Case> = seeds.map(|(row, seed)| table1_case(row, seed)).collect();
    let results = run(&store, &cases, &()).unwrap();
    for (row, seeds) in &rows {
        let row = Row::new(row, 1..=*seeds, &results).unwrap();
        assert_eq!(row.missed(), Vec::<&str>::new(), "{row:#?}");
    }
}

#[test]
fn tables_are_written_in_three_formats_from_kept_results() {
    let (folder, store) = store();
    let table2 = PRODUCTS.iter().find(|p| p.name == "table2").unwrap();
    let plan = Plan { seeds: 1 };
    // Kept results as a run writes them, but with the numbers of the paper.
    let paper = published().unwrap().table2.rows;
    let cases = (table2.cases)(&plan).unwrap();
    for (case, row) in cases.iter().zip(&paper) {
        let metric = |name: &str, value: f64| (name.to_owned(), Some(value));
        let result = CaseResult {
            case: case.name(),
            computed_in_secs: 1.0,
            ended_at_secs: 60.0,
            metrics: [
                metric("density_mean_45s", row.density),
                metric("density_std_45s", row.deviation),
                metric("flow_first_60s_per_s", row.flow),
            ]
            .into(),
            arrivals: Vec::new(),
            uncounted: 0,
            remaining: 0,
            kept: Default::default(),
        };
        store.keep(&key(case), &result).unwrap();
    }
    let said = reproduce(&[table2], &plan, &store, &()).unwrap();
    assert!(
        said[0].contains("| RVO→SPH | 3.83 | 3.83 | +0.0 % |"),
        "{}",
        said[0]
    );
    assert!(!said[0].contains("broken"), "{}", said[0]);
    let read = |file: &str| fs::read_to_string(folder.path().join(file)).unwrap();
    assert_eq!(read("table2.md"), said[0]);
    assert_eq!(read("table2.csv").lines().count(), 1 + 7 * 3);
    let json: serde_json::Value = serde_json::from_str(&read("table2.json")).unwrap();
    assert_eq!(json["rows"].as_array().unwrap().len(), 7);
    assert!(
        json["rankings"]
            .as_array()
            .unwrap()
            .iter()
            .all(|r| r["kept"] == true)
    );
    assert!(Path::new(&folder.path().join("cases")).is_dir());
}
