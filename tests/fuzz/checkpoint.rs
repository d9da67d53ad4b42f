//! Any payload under a checksum that belongs to it: a run that goes on, or an error. Nothing panics.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../common/reading_checkpoints.rs"]
mod reading_checkpoints;

fuzz_target!(|payload: &[u8]| {
    reading_checkpoints::read(payload);
    reading_checkpoints::read(&reading_checkpoints::sealed(payload));
});
