//! Any bytes, read as text and as CSV, either are trajectories with finite numbers or give an error, without a
//! panic.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../common/reading_trajectories.rs"]
mod reading_trajectories;

fuzz_target!(|bytes: &[u8]| {
    reading_trajectories::read("a.txt", bytes);
    reading_trajectories::read("a.csv", bytes);
});
