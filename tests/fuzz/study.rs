//! Any text: a study whose cells are scenarios, or an error. Nothing panics.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../common/reading_studies.rs"]
mod reading_studies;

fuzz_target!(|text: &str| {
    reading_studies::read(text);
});
