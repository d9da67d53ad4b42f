//! Any bytes, as text or as a table: trajectories whose numbers are finite, or an error. Nothing panics.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../common/reading_trajectories.rs"]
mod reading_trajectories;

fuzz_target!(|bytes: &[u8]| {
    reading_trajectories::read("a.txt", bytes);
    reading_trajectories::read("a.csv", bytes);
});
