//! The drive loop: a scenario from its first frame to its end.

use std::ops::ControlFlow;
use std::time::Instant;

use crate::engine::simulation::{Fault, Simulation};
use crate::scenario::Scenario;
use crate::scenario::measurements::Metrics;

/// A run of a scenario, with its measurements.
pub struct Run {
    /// The scenario.
    pub scenario: Scenario,
    /// Its simulation.
    pub simulation: Simulation,
    /// Its measurements.
    pub metrics: Metrics,
}

/// Why a run ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The scenario's duration is reached, or one of its [`stop`](Scenario::stop) conditions holds.
    Over,
    /// It was interrupted.
    Interrupted,
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
    pub fn new(scenario: Scenario) -> Result<Self, Fault> {
        let mut simulation = Simulation::new(scenario.scene.clone())?;
        let metrics = Metrics::new(&scenario.measurements, &mut simulation);
        Ok(Self {
            scenario,
            simulation,
            metrics,
        })
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
        let clock = self.simulation.frame().clock;
        let last_frame = clock.frame_at(self.scenario.duration_secs);
        let mut ms = 0.0;
        loop {
            let start = Instant::now();
            self.simulation.evaluate()?;
            let evaluated = start.elapsed();
            self.metrics.observe(&self.simulation);
            let is_last = self.simulation.frame().clock.frame() >= last_frame;
            let then = match is_last || self.is_over() {
                true => ControlFlow::Break(End::Over),
                false if interrupted() => ControlFlow::Break(End::Interrupted),
                false => ControlFlow::Continue(()),
            };
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

    /// Does one of the scenario's [`stop`](Scenario::stop) conditions hold?
    fn is_over(&self) -> bool {
        let (frame, stop) = (self.simulation.frame(), &self.scenario.stop);
        let mut arrivals = self.simulation.outcome().arrivals.iter().rev();
        let last = arrivals.find(|arrival| arrival.counted);
        let idle = frame.clock.time() - last.map_or(0.0, |arrival| arrival.time);
        let empty = frame.agents.is_empty() && !self.simulation.expects_agents();
        stop.when_empty && empty || stop.idle_secs.is_some_and(|most| idle > most)
    }
}
