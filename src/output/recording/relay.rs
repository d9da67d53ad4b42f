//! A bounded queue to a thread that may stop taking items.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Maximum number of queued items; the sender waits when the queue is full.
const CAPACITY: usize = 100;

/// The queue. If the receiver takes nothing for `patience` while a sender waits, the receiver is given up: later
/// items are dropped without waiting.
pub struct Relay<T> {
    patience: Duration,
    state: Mutex<State<T>>,
    changed: Condvar,
}

struct State<T> {
    items: VecDeque<T>,
    /// Items taken so far.
    taken: u64,
    /// The sender has sent everything.
    closed: bool,
    /// The receiver has ended or was given up.
    ended: bool,
}

/// The receiver took nothing for too long.
#[derive(Debug, PartialEq, Eq)]
pub struct GivenUp;

impl<T> Relay<T> {
    pub fn new(patience: Duration) -> Self {
        Self {
            patience,
            state: Mutex::new(State {
                items: VecDeque::new(),
                taken: 0,
                closed: false,
                ended: false,
            }),
            changed: Condvar::new(),
        }
    }

    /// Queues an item, or drops it if the receiver has ended.
    ///
    /// # Errors
    /// The receiver has just been given up.
    pub fn send(&self, item: T) -> Result<(), GivenUp> {
        let mut state = self.lock();
        if !state.ended && state.items.len() >= CAPACITY {
            state = self.wait_while(state, |state| state.items.len() >= CAPACITY)?;
        }
        if !state.ended {
            state.items.push_back(item);
            self.changed.notify_all();
        }
        Ok(())
    }

    /// Waits for the next item; `None` at the end.
    pub fn take(&self) -> Option<T> {
        let waiting =
            |state: &mut State<T>| state.items.is_empty() && !state.closed && !state.ended;
        let guard = self.changed.wait_while(self.lock(), waiting);
        let mut state = guard.unwrap_or_else(PoisonError::into_inner);
        let item = state.items.pop_front()?;
        state.taken += 1;
        self.changed.notify_all();
        Some(item)
    }

    /// Marks the receiver as ended.
    pub fn end(&self) {
        self.lock().finish();
        self.changed.notify_all();
    }

    /// Closes the queue and waits until the receiver has ended.
    ///
    /// # Errors
    /// The receiver has just been given up.
    pub fn close(&self) -> Result<(), GivenUp> {
        let mut state = self.lock();
        state.closed = true;
        self.changed.notify_all();
        while !state.ended {
            let taken = state.taken;
            state = self.wait_while(state, |state| state.taken == taken)?;
        }
        Ok(())
    }

    /// Waits while `blocked`, unless the receiver ends. Gives the receiver up after `patience`.
    fn wait_while<'a>(
        &'a self,
        state: MutexGuard<'a, State<T>>,
        blocked: impl Fn(&State<T>) -> bool,
    ) -> Result<MutexGuard<'a, State<T>>, GivenUp> {
        let waiting = |state: &mut State<T>| !state.ended && blocked(state);
        let waited = self
            .changed
            .wait_timeout_while(state, self.patience, waiting);
        let (mut state, waited) = waited.unwrap_or_else(PoisonError::into_inner);
        if waited.timed_out() {
            state.finish();
            self.changed.notify_all();
            return Err(GivenUp);
        }
        Ok(state)
    }

    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T> State<T> {
    fn finish(&mut self) {
        self.ended = true;
        self.items.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Far longer than a test takes.
    const LONG: Duration = Duration::from_secs(3600);
    const SHORT: Duration = Duration::from_millis(1);

    #[test]
    fn a_receiver_gets_everything_in_order() {
        let relay = Relay::new(LONG);
        let count = 10 * CAPACITY;
        let received = std::thread::scope(|scope| {
            let receiver = scope.spawn(|| {
                let received: Vec<usize> = std::iter::from_fn(|| relay.take()).collect();
                relay.end();
                received
            });
            for item in 0..count {
                relay.send(item).unwrap();
            }
            relay.close().unwrap();
            receiver.join().unwrap()
        });
        assert!(received.into_iter().eq(0..count));
    }

    #[test]
    fn a_receiver_that_takes_nothing_is_given_up_once() {
        let relay = Relay::new(SHORT);
        for item in 0..CAPACITY {
            assert_eq!(relay.send(item), Ok(()));
        }
        assert_eq!(relay.send(0), Err(GivenUp));
        assert_eq!(relay.send(0), Ok(()));
        assert_eq!(relay.close(), Ok(()));
        assert_eq!(relay.take(), None);
    }

    #[test]
    fn a_receiver_that_stops_before_the_end_is_given_up_at_the_end() {
        let relay = Relay::new(SHORT);
        relay.send(1).unwrap();
        relay.send(2).unwrap();
        assert_eq!(relay.take(), Some(1));
        assert_eq!(relay.close(), Err(GivenUp));
        assert_eq!(relay.take(), None);
    }

    #[test]
    fn no_one_waits_for_a_receiver_that_has_ended() {
        let relay = Relay::new(LONG);
        relay.end();
        for item in 0..=CAPACITY {
            assert_eq!(relay.send(item), Ok(()));
        }
        assert_eq!(relay.close(), Ok(()));
    }
}
