//! Any text: a scenario that runs, or an error. Nothing panics.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../common/reading.rs"]
mod reading;

fuzz_target!(|text: &str| {
    reading::read(text, &[]);
});
