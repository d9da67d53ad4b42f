//! Property tests in which each case has a memory limit.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

/// `count` cases, times `BAD_INPUT_TIMES` if that is set.
pub fn config(count: u32) -> Config {
    let times = std::env::var("BAD_INPUT_TIMES").map_or(1, |times| times.parse().unwrap());
    Config {
        failure_persistence: None,
        ..Config::with_cases(count * times)
    }
}

/// Runs `count` cases, times `BAD_INPUT_TIMES` if that is set, on a single thread.
///
/// `case` returns its memory limit: the number of bytes that it may have allocated at once.
pub fn cases<S: Strategy>(
    count: u32,
    input: impl FnOnce() -> S + Send,
    case: impl Fn(S::Value) -> u64 + Sync,
) {
    let config = config(count);
    // Allocations on other threads would not be counted.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| {
        TestRunner::new(config)
            .run(&input(), |value| {
                // A panic must not unwind through `measure`, or the counter would keep counting.
                let mut result = Ok(0);
                let counted = || result = catch_unwind(AssertUnwindSafe(|| case(value)));
                let held = allocation_counter::measure(counted).bytes_max;
                let limit = result.unwrap_or_else(|panic| resume_unwind(panic));
                prop_assert!(held <= limit, "{held} bytes held at once, {limit} at most");
                Ok(())
            })
            .unwrap();
    });
}
