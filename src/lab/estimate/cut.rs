//! The limits of an estimate: how many runs are still allowed.

use rayon::current_num_threads;

use super::run::{Runs, StepRuns};

impl Runs<'_> {
    /// Reduces the numbers of runs to what the limits allow. Returns the limit that is then reached, if one is.
    pub(super) fn cut(&self, wanted: &mut [usize], elapsed: f64) -> Option<String> {
        let limits = self.question.request.limits;
        let done = self.counts();
        let sampled = self.sample.as_ref().map_or(0, |of| of.results.len());
        let made = done.iter().sum::<usize>() + sampled;
        let free = limits.runs.saturating_sub(made);
        let mut reached = None;
        if added(wanted, &done) > free {
            scale(wanted, &done, free);
            reached = Some(format!("at most {} runs were allowed", limits.runs));
        }
        let Some(secs) = limits.secs else {
            return reached;
        };
        let measured = self.measured_factor();
        let levels = self.levels.iter().zip(wanted.iter()).zip(&done);
        let secs_of = |((level, all), done): ((&StepRuns, &usize), &usize)| {
            (all - done) as f64 * level.expected_secs * measured
        };
        let due = levels.map(secs_of).sum::<f64>() / current_num_threads() as f64;
        if done.iter().any(|&runs| runs > 0) && elapsed + due > secs {
            let part = ((secs - elapsed) / due).clamp(0.0, 1.0);
            let room = added(wanted, &done) as f64 * part;
            scale(wanted, &done, room as usize);
            reached = Some(format!("at most {} minutes were allowed", secs / 60.0));
        }
        reached
    }
}

/// The number of runs that are wanted and not done.
fn added(wanted: &[usize], done: &[usize]) -> usize {
    wanted.iter().zip(done).map(|(all, done)| all - done).sum()
}

/// Reduces the added runs to the largest numbers within `room` in these proportions, then one more each while there is
/// room.
fn scale(wanted: &mut [usize], done: &[usize], room: usize) {
    let asked = added(wanted, done).max(1);
    let full = wanted.to_vec();
    for (all, done) in wanted.iter_mut().zip(done) {
        *all = done + (*all - done) * room / asked;
    }
    let mut left = room - added(wanted, done);
    for (all, full) in wanted.iter_mut().zip(full) {
        let added = usize::from(*all < full && left > 0);
        *all += added;
        left -= added;
    }
}
