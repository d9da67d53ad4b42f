//! A bounded queue to a thread that may stop taking items.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Maximum number of queued items; the sender waits when the queue is full.
const CAPACITY: usize = 100;

/// The patience of an interrupted sender; shorter pauses of a receiver that works are common.
const HURRY: Duration = Duration::from_millis(200);
/// How often a waiting sender looks whether it was interrupted.
const LOOK: Duration = Duration::from_millis(20);

/// The queue. If the receiver takes nothing for `patience` while a sender waits, the receiver is given up: later
/// items are dropped without waiting.
pub struct Relay<T> {
    patience: Duration,
    /// Set once the sender is to wait no longer than [`HURRY`].
    interrupted: Arc<AtomicBool>,
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

/// The receiver took nothing for this time.
#[derive(Debug, PartialEq, Eq)]
pub struct GivenUp(pub Duration);

impl<T> Relay<T> {
    pub fn new(patience: Duration, interrupted: Arc<AtomicBool>) -> Self {
        Self {
            patience,
            interrupted,
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

    /// Waits while `blocked`, unless the receiver ends. Gives the receiver up after the sender's patience.
    fn wait_while<'a>(
        &'a self,
        mut state: MutexGuard<'a, State<T>>,
        blocked: impl Fn(&State<T>) -> bool,
    ) -> Result<MutexGuard<'a, State<T>>, GivenUp> {
        let start = Instant::now();
        loop {
            let waiting = |state: &mut State<T>| !state.ended && blocked(state);
            let slice = LOOK.min(self.patience);
            let waited = self.changed.wait_timeout_while(state, slice, waiting);
            let waited = waited.unwrap_or_else(PoisonError::into_inner);
            state = waited.0;
            if !waited.1.timed_out() {
                return Ok(state);
            }
            let patience = match self.interrupted.load(Ordering::Relaxed) {
                true => HURRY.min(self.patience),
                false => self.patience,
            };
            if start.elapsed() >= patience {
                state.finish();
                self.changed.notify_all();
                return Err(GivenUp(patience));
            }
        }
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
        let relay = Relay::new(LONG, Arc::default());
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
        let relay = Relay::new(SHORT, Arc::default());
        for item in 0..CAPACITY {
            assert_eq!(relay.send(item), Ok(()));
        }
        assert_eq!(relay.send(0), Err(GivenUp(SHORT)));
        assert_eq!(relay.send(0), Ok(()));
        assert_eq!(relay.close(), Ok(()));
        assert_eq!(relay.take(), None);
    }

    #[test]
    fn a_receiver_that_stops_before_the_end_is_given_up_at_the_end() {
        let relay = Relay::new(SHORT, Arc::default());
        relay.send(1).unwrap();
        relay.send(2).unwrap();
        assert_eq!(relay.take(), Some(1));
        assert_eq!(relay.close(), Err(GivenUp(SHORT)));
        assert_eq!(relay.take(), None);
    }

    #[test]
    fn no_one_waits_for_a_receiver_that_has_ended() {
        let relay = Relay::new(LONG, Arc::default());
        relay.end();
        for item in 0..=CAPACITY {
            assert_eq!(relay.send(item), Ok(()));
        }
        assert_eq!(relay.close(), Ok(()));
    }

    #[test]
    fn an_interrupted_sender_waits_no_longer_for_a_silent_receiver() {
        let relay = Relay::new(LONG, Arc::new(AtomicBool::new(true)));
        relay.send(1).unwrap();
        assert_eq!(relay.close(), Err(GivenUp(HURRY)));
    }
}
