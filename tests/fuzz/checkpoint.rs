//! Any payload with a valid checksum either is resumed or gives an error, without a panic.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../common/reading_checkpoints.rs"]
mod reading_checkpoints;

fuzz_target!(|payload: &[u8]| {
    reading_checkpoints::read(payload);
    reading_checkpoints::read(&reading_checkpoints::sealed(payload));
});
