//! Any text either is a valid floor plan or gives an error at a place in the text, without a panic.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../common/plan_reading.rs"]
mod plan_reading;

fuzz_target!(|text: &str| {
    plan_reading::read(text);
});
