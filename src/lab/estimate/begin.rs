//! How an estimate begins, and what it says to the rows after it.

use super::plan::{Hope, first_round, pilot};
use super::prior::{Known, Prior};
use super::run::Runs;
use super::wanted::Wanted;
use analysis::round;
use runs::job::Listener;

impl Runs<'_> {
    /// The wanted results before their first runs.
    pub(super) fn hopes(&self) -> Vec<Hope> {
        let wanted = self.question.request.wanted.iter().zip(&self.priors);
        let hope = |(wanted, prior): (&Wanted, &Prior)| Hope {
            prior: prior.clone(),
            tolerance: wanted.error,
        };
        wanted.map(hope).collect()
    }

    /// The numbers of runs of the first round. The listener is told what they are based on.
    pub(super) fn first_round(&self, listener: Option<&dyn Listener>) -> Vec<usize> {
        let question = self.question;
        let confidence = question.request.confidence;
        let Some(runs) = first_round(&self.hopes(), &self.offers(), confidence) else {
            return pilot(&self.offers(), question.start);
        };
        let similar: usize = self.priors.iter().map(|prior| prior.similar).sum();
        let at = runs.iter().zip(&self.levels).find(|(count, _)| **count > 0);
        if let Some((listener, (count, level))) = listener.zip(at) {
            let step = round::brief(level.rung.step);
            listener.notes(&format!(
                "begins with {count} runs with a step of {step} s, as {similar} similar results suggest"
            ));
        }
        runs
    }

    /// What the wanted results say to rows of the same study.
    pub(super) fn known(&self) -> Vec<Known> {
        let known = self.named_goals();
        known
            .filter_map(|(name, goal)| Known::of(&self.question.title, name, &goal.means))
            .collect()
    }
}
