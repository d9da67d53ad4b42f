//! Memory that runs share, and jobs that panic.

use std::sync::atomic::{AtomicU64, Ordering};

use sandbox::runs::identity::Identity;
use sandbox::runs::job::{self, Job};
use sandbox::runs::memory::Memory;
use sandbox::runs::store::Store;

/// The largest amount of memory that eight threads hold at the same time.
fn most(limit: Option<u64>, bytes: u64) -> u64 {
    let memory = Memory::new(limit);
    let (held, most) = (AtomicU64::new(0), AtomicU64::new(0));
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                for _ in 0..50 {
                    let _lent = memory.lend(bytes);
                    let now = bytes + held.fetch_add(bytes, Ordering::SeqCst);
                    most.fetch_max(now, Ordering::SeqCst);
                    std::thread::yield_now();
                    held.fetch_sub(bytes, Ordering::SeqCst);
                }
            });
        }
    });
    most.into_inner()
}

#[test]
fn what_is_lent_at_once_stays_within_the_limit() {
    assert!(most(Some(100), 30) <= 90);
    assert_eq!(most(Some(100), 51), 51);
}

#[test]
fn a_run_that_is_alone_gets_more() {
    assert_eq!(most(Some(100), 300), 300);
    let memory = Memory::new(None);
    let _both = [memory.lend(u64::MAX), memory.lend(1)];
}

#[test]
fn a_panic_is_a_failure_with_its_message_and_other_jobs_finish() {
    let job = |number: u32| {
        let work = move |_: job::Progress| match number {
            7 => panic!("cell {number}"),
            number => Ok::<u32, String>(number),
        };
        let key = Identity::of("test", number);
        Job::new(format!("job {number}"), key, f64::from(number), work)
    };
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path()).unwrap();
    let jobs = [job(7), job(1)];
    let tally = job::run(&jobs, &store, None, &()).unwrap();
    let failed = ("job 7".to_owned(), "panicked: cell 7".to_owned());
    assert_eq!((tally.finished, tally.failed), (1, vec![failed]));
    assert_eq!(store.result(&jobs[1].key), Ok(Some(1)));
}
