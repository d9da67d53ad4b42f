//! Any checkpoint file either can be resumed with finite numbers or gives an error, within bounded memory.
//!
//! 60,000 cases; more with `BAD_INPUT_TIMES=10 cargo test …`. The memory limit is 2 MB plus 300 bytes per byte of
//! the file.

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use crate::common::bounded::cases;
use crate::common::reading_checkpoints::{read, sealed};
use proptest::prelude::*;
use proptest::sample::Index;
use sandbox::engine::simulation::Simulation;
use sandbox::runs::checkpoint::Checkpoint;
use sandbox::scenario::Scenario;
use sandbox::scenario::measurements::Metrics;
use serde::Serialize;

/// A few people, a source, a push and a wall.
const SCENARIO: &str = r#"{
  "goal": [9, 1], "profile": "sf->sph", "obstacles": [[[3, 0], [4, 0], [4, 0.5]]], "duration_secs": 9,
  "agents": [{"position": [1, 1], "velocity": [1, 0]}, {"position": [1.5, 1]}, {"position": [1, 1.6]}],
  "sources": [{"min": [0, 3], "max": [0, 4], "columns": 1, "rows": 2, "every_secs": 0.1, "times": 3}],
  "events": [{"at_secs": 0.1, "for_secs": 1, "region": [[0, 0], [5, 5]], "goal_scale": 3}],
  "measurements": [{"density": {"at_secs": 0.1}}, {"density": {"at_secs": 5, "region": [[0, 0], [5, 5]]}}]
}"#;

/// The length of the header: a line, the version and the checksum.
const HEAD: usize = 19 + 4 + 32;

fn memory_limit(bytes: usize) -> u64 {
    (2 << 20) + 300 * bytes as u64
}

/// The first frames of a run.
fn begun() -> (Scenario, Simulation, Metrics) {
    let scenario = Scenario::parse(SCENARIO, "f.json", &[]).unwrap();
    let mut simulation = Simulation::new(scenario.scene.clone()).unwrap();
    let mut metrics = Metrics::new(&scenario.measurements, &mut simulation);
    for _ in 0..12 {
        simulation.step().unwrap();
        metrics.observe(&simulation);
    }
    simulation.evaluate().unwrap();
    (scenario, simulation, metrics)
}

/// A checkpoint taken during a run.
fn whole() -> Vec<u8> {
    let (scenario, simulation, metrics) = begun();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("c");
    Checkpoint::of(&scenario, &simulation, &metrics)
        .write(&path)
        .unwrap();
    fs::read(&path).unwrap()
}

fn changes() -> impl Strategy<Value = Vec<(Index, u8)>> {
    prop::collection::vec((any::<Index>(), any::<u8>()), 1..4)
}

#[test]
fn random_bytes_are_refused() {
    let bytes = || (prop::collection::vec(any::<u8>(), 0..200), 0..4_u8);
    cases(20_000, bytes, |(bytes, how)| {
        let head = &sealed(&[])[..[0, 19, 23, 23][usize::from(how)]];
        let bytes = if how == 3 {
            sealed(&bytes)
        } else {
            [head, &bytes].concat()
        };
        assert!(!read(&bytes));
        memory_limit(bytes.len())
    });
}

#[test]
fn a_damaged_checkpoint_is_refused() {
    let whole = whole();
    assert!(read(&whole));
    let input = || (changes(), prop::option::weighted(0.2, any::<Index>()));
    cases(20_000, input, |(changes, cut)| {
        let mut bytes = whole.clone();
        changes
            .iter()
            .for_each(|(place, by)| bytes[place.index(whole.len())] = *by);
        if let Some(cut) = cut {
            bytes.truncate(cut.index(whole.len()));
        }
        assert_eq!(read(&bytes), bytes == whole);
        memory_limit(bytes.len())
    });
}

#[test]
fn a_checkpoint_with_changed_values_is_resumed_or_refused() {
    let whole = whole();
    let payload = &whole[HEAD..];
    assert_eq!(sealed(payload), whole);
    // The state is between the text of the scenario, which `scenario_robustness.rs` tests, and what the measurements
    // have seen, which is tested below.
    let end = payload.len() - encoded(&begun().2.seen()).len();
    let text = payload[..end]
        .windows(2)
        .rposition(|pair| pair == b"}\n" || pair == b"]}")
        .unwrap();
    let state = end - text;
    let input = || (changes(), 0..8_u8, any::<[Index; 2]>());
    let resumed = AtomicU32::new(0);
    cases(20_000, input, |(changes, how, places)| {
        let mut bytes = payload.to_vec();
        changes
            .iter()
            .for_each(|(place, by)| bytes[text + place.index(state)] = *by);
        let [from, to] = places.map(|place| text + place.index(state));
        match how {
            0 => bytes.truncate(from),
            1 => drop(bytes.drain(from.min(to)..from.max(to))),
            2 => bytes[from..(from + 10).min(payload.len())].fill(0xff), // the largest possible length
            _ => {}
        }
        resumed.fetch_add(u32::from(read(&sealed(&bytes))), Relaxed);
        memory_limit(bytes.len())
    });
    let resumed = resumed.into_inner();
    assert!(resumed > 1_000, "{resumed} have values that make sense");
}

fn encoded<T: Serialize + ?Sized>(value: &T) -> Vec<u8> {
    postcard::to_stdvec(value).unwrap()
}

#[test]
fn what_measurements_have_seen_is_resumed_or_refused_with_their_number() {
    let seen = begun().2.seen();
    let whole = whole();
    let payload = &whole[HEAD..];
    // The last part of the payload.
    let mut end = payload.len();
    let names = [
        "measurements[0]",
        "measurements[1]",
        "agents that are stuck",
        "the overview",
    ];
    assert_eq!(seen.len(), names.len());
    for (seen, name) in seen.iter().zip(names).rev() {
        let start = end - seen.len();
        assert_eq!(&payload[start..end], seen.as_bytes());
        let mut changed = payload.to_vec();
        changed[start] = b'?';
        let checkpoint = Checkpoint::parse(&sealed(&changed), Path::new("c")).unwrap();
        let scenario = checkpoint.scenario(&[]).unwrap();
        let said = checkpoint
            .resume(scenario)
            .map(|_| ())
            .unwrap_err()
            .to_string();
        assert!(
            said.starts_with(&format!("the state of {name}: ")),
            "{said}"
        );
        end -= encoded(seen).len();
    }
}

#[test]
fn a_long_file_that_is_not_a_checkpoint_is_refused_in_little_memory() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("c");
    let mut file = File::create(&path).unwrap();
    file.write_all(b"PK").unwrap();
    file.set_len(1 << 40).unwrap(); // a sparse file
    let mut said = String::new();
    let held =
        allocation_counter::measure(|| said = Checkpoint::read(&path).unwrap_err().to_string());
    assert!(said.ends_with("is not a checkpoint"), "{said}");
    assert!(held.bytes_max < 1 << 20, "{}", held.bytes_max);
}
