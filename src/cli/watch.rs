//! Progress of long computations.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use super::talk;
use crate::lab::job;
use crate::lab::reproduce::{self, CaseResult};
use crate::lab::sweep::{self, Cell};

/// A progress bar on stderr. If stderr is not a terminal, a line for every finished case instead.
pub struct Watch {
    bar: ProgressBar,
    lines: bool,
}

impl Watch {
    pub fn new() -> Self {
        let bar = ProgressBar::new(0);
        let template = "{bar:30} {percent} % of the work, {eta} left; {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self {
            bar,
            lines: !std::io::stderr().is_terminal(),
        }
    }

    /// Removes the bar.
    pub fn ends(&self) {
        self.bar.finish_and_clear();
    }

    fn begin(&self, cases: usize, kept: usize, seconds: f64) {
        self.note(&format!("{cases} case(s) to run, {kept} kept from before"));
        self.start(seconds);
    }

    fn start(&self, seconds: f64) {
        self.bar.set_length(steps(seconds));
        self.bar.enable_steady_tick(Duration::from_secs(1));
    }

    fn finish(&self, case: &str, seconds: f64) {
        let text = format!("{case}: {seconds:.1} s");
        if self.lines {
            let (done, all) = (self.bar.position(), self.bar.length().unwrap_or_default());
            let left = self.bar.eta().as_secs();
            let percent = 100 * done / all.max(1);
            talk(&format!("{percent:>3} %, {left} s left; {text}"));
        } else {
            self.bar.set_message(text);
        }
    }

    fn note(&self, text: &str) {
        self.bar.suspend(|| talk(&format!("note: {text}")));
    }
}

/// Converts expected seconds to steps of the bar.
fn steps(seconds: f64) -> u64 {
    (seconds * 1e3).round() as u64
}

impl reproduce::Listener for Watch {
    fn begins(&self, cases: usize, kept: usize, seconds: f64) {
        self.begin(cases, kept, seconds);
    }

    fn advances(&self, seconds: f64) {
        self.bar.inc(steps(seconds));
    }

    fn finishes(&self, result: &CaseResult) {
        self.finish(&result.case, result.computed_in_secs);
    }

    fn notes(&self, text: &str) {
        self.note(text);
    }
}

impl job::Listener for Watch {
    fn begins(&self, jobs: usize, kept: usize, seconds: f64) {
        self.begin(jobs, kept, seconds);
    }

    fn notes(&self, text: &str) {
        self.note(text);
    }

    fn finishes(&self, job: &str, expected: f64, seconds: f64) {
        self.bar.inc(steps(expected));
        self.finish(job, seconds);
    }
}

impl sweep::Listener for Watch {
    fn begins(&self, cells: usize, kept: usize, seconds: f64) {
        self.note(&format!("{cells} cell(s) to run, {kept} kept from before"));
        self.start(seconds);
    }

    fn advances(&self, seconds: f64) {
        self.bar.inc(steps(seconds));
    }

    fn finishes(&self, cell: &Cell, seconds: f64) {
        self.finish(&cell.to_string(), seconds);
    }

    fn fails(&self, cell: &Cell, message: &str) {
        self.note(&format!("{cell} failed: {message}"));
    }

    fn notes(&self, text: &str) {
        self.note(text);
    }
}
