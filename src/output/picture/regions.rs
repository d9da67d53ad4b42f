//! The regions and lines that measurements observe.

use super::xy;
use crate::labels::{Labels, around};
use crate::scenery;
use engine::scene::Scene;
use figures::colors::Rgb;
use figures::plot::{Mark, Style};
use scenario::measurements::Observed;

/// Their color.
const OBSERVED: Rgb = [20, 120, 140];

/// Their marks; each place has one label with all names.
pub fn marks(scene: &Scene, observed: &[(String, Observed)], labels: &mut Labels) -> Vec<Mark> {
    let mut marks = Vec::new();
    for (name, place) in scenery::observed_once(scene, observed) {
        let outline = place.outline();
        let rim = outline.iter().map(|&p| xy(p));
        marks.push(Mark::line(rim, Style::broken(OBSERVED, 0.8, "")));
        if !name.is_empty() {
            labels.add(&name, OBSERVED, &around(&outline, false));
        }
    }
    marks
}
