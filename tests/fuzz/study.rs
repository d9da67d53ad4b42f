//! Any text either is a study with valid cells or gives an error, without a panic.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../common/reading_studies.rs"]
mod reading_studies;

fuzz_target!(|text: &str| {
    reading_studies::read(text);
});
