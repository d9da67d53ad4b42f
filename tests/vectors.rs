//! The same bits with all SIMD vectors: the program runs with each kind that this processor has, and the states must be
//! those of `data/digests.json`, on any processor.

use std::process::Command;

use sandbox::engine::pairs::{VARIABLE, Vectors};
use serde_json::Value;

use crate::common::program::{PROGRAM, stderr};

const DIGESTS: &str = include_str!("data/digests.json");

/// The runs, each the arguments of `sandbox` and the digest of its final state.
fn digests() -> Vec<(Vec<String>, String)> {
    let runs: serde_json::Map<String, Value> = serde_json::from_str(DIGESTS).unwrap();
    let run = |(typed, digest): (String, Value)| {
        let arguments = typed.split(' ').map(str::to_owned).collect();
        (arguments, digest.as_str().unwrap().to_owned())
    };
    runs.into_iter().map(run).collect()
}

/// The result of a run with these vectors, without the times that it took.
fn result(arguments: &[String], vectors: &str) -> Value {
    let output = Command::new(PROGRAM)
        .args(arguments)
        .arg("--json")
        .env(VARIABLE, vectors)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{arguments:?}: {}",
        stderr(&output)
    );
    let mut result: Value = serde_json::from_slice(&output.stdout).unwrap();
    let fields = result.as_object_mut().unwrap();
    fields.retain(|name, _| {
        let is_time = name.contains("ms_") || name.ends_with("_ms") || name.contains("wall");
        !(is_time || name.contains("real_time") || name == "memory")
    });
    result
}

#[test]
fn results_are_the_same_to_the_last_bit_with_all_vectors() {
    let all = Vectors::all();
    for (arguments, digest) in digests() {
        let best = result(&arguments, all.last().unwrap());
        let shown = arguments.join(" ");
        assert_eq!(best["state_sha256"], digest.as_str(), "{shown}");
        for vectors in &all[..all.len() - 1] {
            assert_eq!(result(&arguments, vectors), best, "{shown} with {vectors}");
        }
    }
}

#[test]
fn vectors_that_the_processor_lacks_are_refused() {
    let output = Command::new(PROGRAM)
        .args(["evacuation", "--until", "0.1"])
        .env(VARIABLE, "AVX1024")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(message.contains("AVX1024"), "{message}");
    for vectors in Vectors::all() {
        assert!(message.contains(&vectors), "{message}");
    }
}
