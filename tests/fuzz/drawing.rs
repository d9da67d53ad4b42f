//! Any bytes either are a valid DXF, with a plan whose floor and obstacles are valid, or give an error, without a
//! panic.

#![no_main]

use libfuzzer_sys::fuzz_target;
use sandbox::scenario::floor_plan::{self, Reading};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(plan) = floor_plan::parse_bytes(bytes, &Reading::default()) {
        plan.solids().unwrap();
    }
});
