//! The regions and lines that measurements observe.

use super::labels::Labels;
use super::scene::around;
use super::xy;
use crate::output::colors::Rgb;
use crate::output::plot::{Mark, Style};
use crate::scenario::measurements::Observed;

/// Their color.
const OBSERVED: Rgb = [20, 120, 140];

/// Their marks; each place has one label with all names.
pub fn marks(observed: &[(String, Observed)], labels: &mut Labels) -> Vec<Mark> {
    let mut marks = Vec::new();
    for (k, (_, place)) in observed.iter().enumerate() {
        if observed[..k].iter().any(|(_, other)| other == place) {
            continue;
        }
        let outline = place.outline();
        let rim = outline.iter().map(|&p| xy(p)).collect();
        marks.push(Mark::Line(rim, Style::broken(OBSERVED, 0.8, "")));
        let names = observed[k..].iter().filter(|(_, other)| other == place);
        let mut names: Vec<&str> = names.map(|(name, _)| name.as_str()).collect();
        names.dedup();
        labels.add(&names.join(", "), OBSERVED, &around(&outline, false));
    }
    marks
}
