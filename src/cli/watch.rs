//! Progress of runs and of long computations.

use std::fmt::Write;
use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::time::Duration;

use indicatif::{HumanDuration, ProgressBar, ProgressFinish, ProgressState, ProgressStyle};

use super::failure::Failure;
use super::terminal::talk;
use engine::simulation::Simulation;
use runs::drive::{End, Observer, Run};
use runs::job::Listener;
use scenario::quote::printable;

/// A progress bar on stderr, shown only if stderr is a terminal, until it is dropped.
pub fn bar(length: u64, template: &str) -> ProgressBar {
    let parsed = ProgressStyle::with_template(template);
    let style = parsed.unwrap_or_else(|_| ProgressStyle::default_bar());
    let style = style.with_key("left", |state: &ProgressState, out: &mut dyn Write| {
        let left = time_left(state.elapsed(), state.pos(), state.len());
        let _ = write!(out, "{:#}", HumanDuration(left));
    });
    let bar = ProgressBar::new(length).with_style(style);
    bar.with_finish(ProgressFinish::AndClear)
}

/// The time that the rest takes if it goes on as fast as what is done has gone so far: unlike an average of the latest
/// steps, it is right for steps of any size.
fn time_left(elapsed: Duration, done: u64, all: Option<u64>) -> Duration {
    let rest = all.unwrap_or_default().saturating_sub(done);
    elapsed.mul_f64(rest as f64 / done.max(1) as f64)
}

/// The progress of a run.
pub struct Progress(ProgressBar);

impl Progress {
    pub fn new(duration: f64) -> Self {
        let length = (duration * 10.0).ceil() as u64;
        Self(bar(length, "{bar:30} {msg}, {left} left"))
    }

    pub fn show(&self, simulation: &Simulation) {
        let frame = simulation.frame();
        if frame.clock.is_coarse() && !self.0.is_hidden() {
            let (time, agents) = (frame.clock.time(), frame.agents.count_present());
            self.0.set_position((time * 10.0) as u64);
            self.0
                .set_message(format!("t = {time:.1} s, {agents} agents"));
        }
    }
}

impl Observer<Failure> for Progress {
    fn observe(&mut self, run: &Run, _: f64, _: ControlFlow<End>) -> Result<(), Failure> {
        self.show(&run.simulation);
        Ok(())
    }
}

/// A progress bar on stderr. If stderr is not a terminal, a line for every finished case instead.
pub struct Watch {
    bar: ProgressBar,
    lines: bool,
}

impl Default for Watch {
    fn default() -> Self {
        Self::new()
    }
}

impl Watch {
    pub fn new() -> Self {
        let template = "{bar:30} {percent} % of the work, {left} left; {msg}";
        Self {
            bar: bar(0, template),
            lines: !std::io::stderr().is_terminal(),
        }
    }
}

/// Converts expected seconds to steps of the bar.
fn steps(seconds: f64) -> u64 {
    (seconds * 1e3).round() as u64
}

impl Listener for Watch {
    fn begins(&self, jobs: usize, kept: usize, seconds: f64) {
        self.notes(&format!("{jobs} case(s) to run, {kept} kept from before"));
        self.bar.reset(); // the computation may have several parts
        self.bar.set_length(steps(seconds));
        self.bar.enable_steady_tick(Duration::from_secs(1));
    }

    fn advances(&self, seconds: f64) {
        self.bar.inc(steps(seconds));
    }

    fn finishes(&self, job: &str, seconds: f64) {
        let text = format!("{job}: {seconds:.1} s");
        if self.lines {
            let (done, all) = (self.bar.position(), self.bar.length());
            let left = time_left(self.bar.elapsed(), done, all).as_secs();
            // Cases may take longer than expected.
            let percent = (100 * done / all.unwrap_or_default().max(1)).min(100);
            talk(&format!("{percent:>3} %, {left} s left; {text}"));
        } else {
            self.bar.set_message(printable(&text));
        }
    }

    fn fails(&self, job: &str, message: &str) {
        self.notes(&format!("{job} failed: {message}"));
    }

    fn notes(&self, text: &str) {
        self.bar.suspend(|| talk(&format!("note: {text}")));
    }
}
