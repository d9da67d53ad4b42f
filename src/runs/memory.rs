//! Main memory that runs share.

use std::sync::{Condvar, Mutex, PoisonError};

/// Lends memory to as many runs at a time as fit.
pub struct Memory {
    /// Bytes; `None` without a limit.
    limit: Option<u64>,
    lent: Mutex<u64>,
    returned: Condvar,
}

/// Memory lent to a run, until it is dropped.
pub struct Lent<'a> {
    memory: &'a Memory,
    bytes: u64,
}

impl Memory {
    /// Memory of `limit` bytes; `None` without a limit.
    pub fn new(limit: Option<u64>) -> Self {
        Self {
            limit,
            lent: Mutex::new(0),
            returned: Condvar::new(),
        }
    }

    /// Waits until `bytes` bytes are free. A run that needs more than the limit waits until no other run has memory.
    pub fn lend(&self, bytes: u64) -> Lent<'_> {
        let limit = self.limit.unwrap_or(u64::MAX);
        let full = |lent: &mut u64| *lent > 0 && lent.saturating_add(bytes) > limit;
        let lent = self.lent.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.returned.wait_while(lent, full);
        let mut lent = waited.unwrap_or_else(PoisonError::into_inner);
        let bytes = bytes.min(u64::MAX - *lent);
        *lent += bytes;
        Lent {
            memory: self,
            bytes,
        }
    }

    /// The limit, bytes.
    pub fn limit(&self) -> Option<u64> {
        self.limit
    }
}

impl Drop for Lent<'_> {
    fn drop(&mut self) {
        let lent = self.memory.lent.lock();
        *lent.unwrap_or_else(PoisonError::into_inner) -= self.bytes;
        self.memory.returned.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

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
}
