//! Runs on threads of their own, and how others ask them for something.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

use output::page::Live;
use output::recording::Address;
use scenario::Scenario;
use serde_json::Value;

use crate::answer::Refusal;
use crate::controls;
use crate::feed::Feed;
use crate::player::Player;

/// What is done with a run between two frames.
type Task = Box<dyn FnOnce(&mut Player) + Send>;

/// A run that is played on a thread of its own. When all copies are dropped, the thread ends.
#[derive(Clone)]
pub struct Play {
    /// The name of the scenario.
    pub name: String,
    /// The scenario as it was given.
    pub document: Arc<Value>,
    /// What can be changed while it runs.
    pub controls: Arc<Value>,
    /// Its latest frames.
    pub feed: Arc<Feed>,
    /// What does not move.
    pub live: Arc<Live>,
    tasks: Sender<Task>,
}

impl Play {
    /// Begins a run of a scenario, stopped in its first frame; `viewer` shows it, too.
    ///
    /// # Errors
    /// An agent cannot enter, or there is no thread.
    pub fn begin(
        scenario: Scenario,
        document: Value,
        viewer: Option<Address>,
    ) -> Result<Self, Refusal> {
        let feed = Arc::new(Feed::default());
        let player = rayon::scope(|_| Player::new(scenario, feed.clone(), viewer))?;
        Self::of(player, feed, Arc::new(document))
    }

    /// A run that begins in the current frame of this one.
    ///
    /// # Errors
    /// The run cannot be copied.
    pub fn fork(&self) -> Result<Self, Refusal> {
        let feed = Arc::new(Feed::default());
        let own = feed.clone();
        let player = self.ask(move |player| player.fork(own))??;
        Self::of(player, feed, self.document.clone())
    }

    fn of(player: Player, feed: Arc<Feed>, document: Arc<Value>) -> Result<Self, Refusal> {
        let (tasks, queue) = channel();
        let play = Self {
            name: player.run().scenario.name.clone(),
            document,
            controls: Arc::new(controls::of(player.run().simulation.scene())),
            feed,
            live: player.live(),
            tasks,
        };
        let thread = std::thread::Builder::new().name("run".to_owned());
        let started = thread.spawn(move || follow(player, &queue));
        started.map_err(Refusal::failed)?;
        Ok(play)
    }

    /// Lets the thread of the run do something between two frames, and waits for its answer.
    ///
    /// # Errors
    /// The run has ended with a failure of the program.
    pub fn ask<T: Send + 'static>(
        &self,
        what: impl FnOnce(&mut Player) -> T + Send + 'static,
    ) -> Result<T, Refusal> {
        let gone = || Refusal::with(500, "the run has failed; begin it again");
        let (answer, answered) = channel();
        let task: Task = Box::new(move |player| {
            answer.send(what(player)).ok();
        });
        self.tasks.send(task).map_err(|_| gone())?;
        answered.recv().map_err(|_| gone())
    }
}

/// Plays a run until all handles to it are dropped.
fn follow(mut player: Player, tasks: &Receiver<Task>) {
    const FOREVER: Duration = Duration::from_secs(3600);
    loop {
        let task = tasks.recv_timeout(player.idle().unwrap_or(FOREVER));
        // On a thread of the pool, parallel work starts without handing it over to the pool first.
        match task {
            Ok(task) => rayon::scope(|_| task(&mut player)),
            Err(RecvTimeoutError::Timeout) => rayon::scope(|_| player.play()),
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}
