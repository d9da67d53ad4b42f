//! The drive loop: a scenario from its first frame to its end.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use engine::scene::Action;
use engine::simulation::{ActionError, Added, Fault, Simulation};
use scenario::measurements::Metrics;
use scenario::{Scenario, ScenarioError};

/// A run of a scenario, with its measurements.
pub struct Run {
    /// The scenario, with its initial agents; shared by its forks.
    pub scenario: Arc<Scenario>,
    /// Its simulation.
    pub simulation: Simulation,
    /// Its measurements.
    pub metrics: Metrics,
    /// The reason why it ended; `None` until then.
    pub end: Option<End>,
}

/// The reason why a run ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// No agents are left and none will enter: [`stop.when_empty`](scenario::Stop::when_empty).
    Empty,
    /// No agent has arrived for some time: [`stop.idle_secs`](scenario::Stop::idle_secs).
    Idle,
    /// The scenario's duration is reached.
    Duration,
    /// It was interrupted.
    Interrupted,
}

/// Why nothing is done to a run.
#[derive(Debug, thiserror::Error)]
pub enum InterventionError {
    /// The action is not possible.
    #[error(transparent)]
    Action(#[from] ActionError),
    /// The scenario's floor has no routes.
    #[error(transparent)]
    Floor(#[from] ScenarioError),
}

/// Observes every evaluated frame of a run: a progress bar, a recording, trajectories, checkpoints.
pub trait Observer<E> {
    /// Observes a frame: the previous one took `ms` milliseconds, and `then` says whether another frame follows or why
    /// the run ends.
    ///
    /// # Errors
    /// The run cannot continue.
    fn observe(&mut self, run: &Run, ms: f64, then: ControlFlow<End>) -> Result<(), E>;

    /// Completes the output after the last frame, or after an error.
    ///
    /// # Errors
    /// The output cannot be written.
    fn finish(self: Box<Self>) -> Result<(), E> {
        Ok(())
    }
}

impl Run {
    /// A run from the first frame.
    ///
    /// # Errors
    /// An initial agent cannot enter.
    pub fn new(mut scenario: Scenario) -> Result<Self, Fault> {
        scenario.scene.agents.shrink_to_fit();
        let mut simulation = Simulation::new(scenario.scene.clone())?;
        let metrics = Metrics::new(&scenario.measurements, &mut simulation);
        Ok(Self {
            scenario: Arc::new(scenario),
            simulation,
            metrics,
            end: None,
        })
    }

    /// An independent copy in the same frame, with all that was measured so far.
    ///
    /// # Errors
    /// A measurement cannot read what it has seen.
    pub fn fork(&self) -> Result<Self, String> {
        let mut simulation = self.simulation.fork();
        let mut metrics = Metrics::new(&self.scenario.measurements, &mut simulation);
        if let Some(frame) = self.metrics.observed() {
            metrics.resume(&self.metrics.seen(), frame)?;
        }
        Ok(Self {
            scenario: self.scenario.clone(),
            simulation,
            metrics,
            end: self.end,
        })
    }

    /// Does something at the beginning of the next frame that is computed.
    ///
    /// # Errors
    /// The action is not possible, or the scenario's floor has no routes. Nothing is done then.
    pub fn intervene(&mut self, action: Action) -> Result<Added, InterventionError> {
        let simulation = &mut self.simulation;
        let needs_routes = matches!(action, Action::Add(_) | Action::Goals(_));
        if needs_routes
            && simulation.lacks_later_routes()
            && let Some(floor) = self.scenario.floor()?
        {
            simulation.set_later_routes(floor);
        }
        match action {
            Action::Add(new) => Ok(simulation.add(&new)?),
            other => {
                simulation.intervene(other)?;
                Ok(Added::default())
            }
        }
    }

    /// The scenario up to the current frame with what was done: a run of it ends in the same state.
    pub fn played(&self) -> Value {
        self.scenario.played(&self.simulation)
    }

    /// Runs to the end of the scenario, or until `interrupted` returns true. Returns why the run ended.
    ///
    /// # Errors
    /// The simulation fails, or an observer does.
    pub fn drive<E: From<Fault>, O: Observer<E> + ?Sized>(
        &mut self,
        observers: &mut [Box<O>],
        interrupted: impl Fn() -> bool,
    ) -> Result<End, E> {
        let mut ms = 0.0;
        loop {
            let start = Instant::now();
            self.simulation.evaluate()?;
            let evaluated = start.elapsed();
            self.measure();
            self.end = self
                .end
                .or_else(|| interrupted().then_some(End::Interrupted));
            let then = self
                .end
                .map_or(ControlFlow::Continue(()), ControlFlow::Break);
            for observer in &mut *observers {
                observer.observe(self, ms, then)?;
            }
            if let ControlFlow::Break(end) = then {
                return Ok(end);
            }
            let start = Instant::now();
            self.simulation.integrate()?;
            ms = 1e3 * (evaluated + start.elapsed()).as_secs_f64();
        }
    }

    /// Lets the measurements observe the evaluated frame, once per frame, and notes why the run ends here, if it does.
    pub fn measure(&mut self) {
        self.metrics.observe(&self.simulation);
        let clock = self.simulation.frame().clock;
        let is_last = clock.frame() >= clock.frame_at(self.scenario.duration_secs);
        self.end = self.stops().or(is_last.then_some(End::Duration));
    }

    /// The reason why it ended, in words.
    pub fn reason(&self) -> String {
        match self.end {
            Some(End::Empty) => "no agents are left".to_owned(),
            Some(End::Idle) => {
                let secs = self.scenario.stop.idle_secs.unwrap_or_default();
                format!("no agent has arrived for {secs} s")
            }
            Some(End::Duration) => {
                format!("its duration of {} s is over", self.scenario.duration_secs)
            }
            Some(End::Interrupted) => "it was interrupted".to_owned(),
            None => "it has not ended".to_owned(),
        }
    }

    /// Which of the scenario's [`stop`](scenario::Scenario::stop) conditions holds, if any.
    fn stops(&self) -> Option<End> {
        let (frame, stop) = (self.simulation.frame(), &self.scenario.stop);
        let mut arrivals = self.simulation.outcome().arrivals.iter().rev();
        let last = arrivals.find(|arrival| arrival.counted);
        let idle = frame.clock.time() - last.map_or(0.0, |arrival| arrival.time);
        if stop.when_empty && frame.agents.count_present() == 0 && !self.simulation.expects_agents()
        {
            return Some(End::Empty);
        }
        let is_idle = stop.idle_secs.is_some_and(|most| idle > most);
        is_idle.then_some(End::Idle)
    }
}
