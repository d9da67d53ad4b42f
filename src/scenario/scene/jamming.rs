//! Notes on narrow openings before which the time step decides whether a crowd jams.

use crate::error::numbers::brief;
use crate::error::quote::{shown, to_centimeters};
use engine::profile::Navigation;
use engine::routes::Narrowings;
use engine::scene::Scene;

/// Wider openings do not jam, meters.
const NARROW: f64 = 1.0;
/// At shorter steps openings jam as in the limit, seconds.
const SHORT_STEP: f64 = 0.003;
/// Fewer agents do not jam.
const FEWEST: u64 = 20;

/// A note on a narrow opening and people who are led by social forces alone.
pub fn note(scene: &Scene, entering: u64) -> Option<String> {
    let is_social = |navigation: &Navigation| matches!(navigation, Navigation::Social(..));
    let mut groups = scene.groups.iter();
    let group = groups.find(|group| {
        let mut steps = group.blend.steps().iter().map(|step| &step.profile);
        steps.all(|profile| is_social(&profile.navigation) && !profile.pressure)
    })?;
    let step = scene.clock.time_step();
    if step < SHORT_STEP || entering < FEWEST {
        return None;
    }
    let mesh = scene.routes.as_ref()?.floor.whole();
    let [a, b] = Narrowings::default()
        .and_openings(mesh, NARROW)
        .narrowest()?;
    let (middle, width) = (0.5 * (a + b), (b - a).norm());
    let [x, y, width] = [middle.x, middle.y, width].map(to_centimeters);
    Some(format!(
        "with profile `{}` the time step decides whether people jam in the opening of {} m at ({x}, {y}): 60 people \
         before one of 0.74 m hardly do at the paper's step of 0.02 s, and in most runs at 0.005 s; this step is {} s \
         (docs/findings/accuracy.md)",
        shown(&group.blend.name),
        brief(width),
        brief(step),
    ))
}
