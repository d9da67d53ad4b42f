//! Any text: a floor plan, or an error at a place that is in the text. Nothing panics.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../common/plan_reading.rs"]
mod plan_reading;

fuzz_target!(|text: &str| {
    plan_reading::read(text);
});
