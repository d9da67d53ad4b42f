//! Any text either runs as a scenario or gives an error, without a panic.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../common/reading.rs"]
mod reading;

fuzz_target!(|text: &str| {
    reading::read(text, &[]);
});
