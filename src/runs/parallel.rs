//! Calls on several threads, each call on a single one.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::error::StoreError;

/// Calls `work` with 0, 1, … below `count`, on as many threads as rayon has, each call on a single thread. Calls begin
/// in this order, as threads become free.
///
/// # Errors
/// The first call that fails; no call begins after it.
pub fn side_by_side<E: From<StoreError> + Send>(
    count: usize,
    work: impl Fn(usize) -> Result<(), E> + Sync,
) -> Result<(), E> {
    let next = AtomicUsize::new(0);
    let work = || {
        let built = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let pool = built.map_err(|error| StoreError::Threads(error.to_string()))?;
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= count {
                return Ok(());
            }
            if let Err(error) = pool.install(|| work(k)) {
                next.store(count, Ordering::Relaxed);
                return Err(error);
            }
        }
    };
    // These are separate threads: a thread of rayon's pool would start a second call while it waits for the first.
    std::thread::scope(|scope| {
        let threads = rayon::current_num_threads().min(count);
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|worker| {
            let crashed = |_| StoreError::Threads("a thread crashed".to_owned());
            worker.join().map_err(crashed)?
        })
    })
}
