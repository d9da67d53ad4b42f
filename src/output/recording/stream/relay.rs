//! A bounded queue to a thread that may stop taking items.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, TrySendError};
use std::sync::mpsc::{channel, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Maximum number of queued items; the sender waits when the queue is full.
const CAPACITY: usize = 100;

/// The time that an interrupted sender waits. A working receiver often pauses for less.
const HURRY: Duration = Duration::from_millis(200);
/// Interval at which a waiting sender checks whether it was interrupted.
const LOOK: Duration = Duration::from_millis(20);

/// The sender's side. If the receiver takes nothing for `patience` while a sender waits, the receiver is given up:
/// later items are dropped without waiting.
pub struct Relay<T> {
    patience: Duration,
    /// Once set, the sender waits no longer than [`HURRY`].
    interrupted: Arc<AtomicBool>,
    /// The queue, and a channel that reports every item taken from it. `None` once closed or given up.
    ends: Mutex<Option<(SyncSender<T>, Receiver<()>)>>,
}

/// The receiver's side. Dropping it ends the receiver.
pub struct Items<T> {
    queue: Receiver<T>,
    taken: Sender<()>,
}

impl<T> Iterator for Items<T> {
    type Item = T;

    /// Waits for the next item; `None` at the end.
    fn next(&mut self) -> Option<T> {
        let item = self.queue.recv().ok()?;
        self.taken.send(()).ok();
        Some(item)
    }
}

/// The receiver took nothing for this time.
#[derive(Debug, PartialEq, Eq)]
pub struct GivenUp(pub Duration);

impl<T> Relay<T> {
    pub fn new(patience: Duration, interrupted: Arc<AtomicBool>) -> (Self, Items<T>) {
        let (sender, queue) = sync_channel(CAPACITY);
        let (taken, word) = channel();
        let relay = Self {
            patience,
            interrupted,
            ends: Mutex::new(Some((sender, word))),
        };
        (relay, Items { queue, taken })
    }

    /// Queues an item, or drops it if the receiver has ended.
    ///
    /// # Errors
    /// The receiver has just been given up.
    pub fn send(&self, mut item: T) -> Result<(), GivenUp> {
        let mut ends = self.lock();
        while let Some((queue, taken)) = &*ends {
            taken.try_iter().for_each(drop);
            match queue.try_send(item) {
                Err(TrySendError::Full(back)) => item = back,
                Ok(()) | Err(TrySendError::Disconnected(_)) => break,
            }
            if let Err(given_up) = self.wait(taken) {
                *ends = None;
                return Err(given_up);
            }
        }
        Ok(())
    }

    /// Closes the queue and waits until the receiver has ended.
    ///
    /// # Errors
    /// The receiver has just been given up.
    pub fn close(&self) -> Result<(), GivenUp> {
        let Some((queue, taken)) = self.lock().take() else {
            return Ok(());
        };
        drop(queue);
        while self.wait(&taken)? {}
        Ok(())
    }

    /// Waits until the receiver takes an item, for as long as the sender has patience. `false` if the receiver has
    /// ended.
    fn wait(&self, taken: &Receiver<()>) -> Result<bool, GivenUp> {
        let start = Instant::now();
        loop {
            match taken.recv_timeout(LOOK.min(self.patience)) {
                Ok(()) => return Ok(true),
                Err(RecvTimeoutError::Disconnected) => return Ok(false),
                Err(RecvTimeoutError::Timeout) => {}
            }
            let patience = match self.interrupted.load(Ordering::Relaxed) {
                true => HURRY.min(self.patience),
                false => self.patience,
            };
            if start.elapsed() >= patience {
                return Err(GivenUp(patience));
            }
        }
    }

    fn lock(&self) -> MutexGuard<'_, Option<(SyncSender<T>, Receiver<()>)>> {
        self.ends.lock().unwrap_or_else(PoisonError::into_inner)
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
        let (relay, items) = Relay::new(LONG, Arc::default());
        let receiver = std::thread::spawn(|| items.collect::<Vec<usize>>());
        (0..10 * CAPACITY).for_each(|item| relay.send(item).unwrap());
        relay.close().unwrap();
        assert!(receiver.join().unwrap().into_iter().eq(0..10 * CAPACITY));
    }

    #[test]
    fn a_receiver_that_takes_nothing_is_given_up_once() {
        let (relay, items) = Relay::new(SHORT, Arc::default());
        (0..CAPACITY).for_each(|item| relay.send(item).unwrap());
        assert_eq!(relay.send(0), Err(GivenUp(SHORT)));
        assert_eq!((relay.send(0), relay.close()), (Ok(()), Ok(())));
        assert_eq!(items.count(), CAPACITY);
    }

    #[test]
    fn a_receiver_that_stops_before_the_end_is_given_up_at_the_end() {
        let (relay, mut items) = Relay::new(SHORT, Arc::default());
        (1..3).for_each(|item| relay.send(item).unwrap());
        assert_eq!(items.next(), Some(1));
        assert_eq!(relay.close(), Err(GivenUp(SHORT)));
    }

    #[test]
    fn no_one_waits_for_a_receiver_that_has_ended() {
        let (relay, items) = Relay::new(LONG, Arc::default());
        drop(items);
        (0..=CAPACITY).for_each(|item| relay.send(item).unwrap());
        assert_eq!(relay.close(), Ok(()));
    }

    #[test]
    fn an_interrupted_sender_waits_no_longer_for_a_silent_receiver() {
        let (relay, _items) = Relay::new(LONG, Arc::new(AtomicBool::new(true)));
        relay.send(1).unwrap();
        assert_eq!(relay.close(), Err(GivenUp(HURRY)));
    }
}
