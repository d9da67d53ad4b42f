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
        let now = self.lent.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.returned.wait_while(now, full);
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
