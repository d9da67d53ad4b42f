//! Notes on social forces that act through thin walls: the paper's law does not see walls between people.

use crate::error::numbers::brief;
use crate::error::quote::{shown, to_centimeters};
use engine::geometry::{Wall, Walls};
use engine::profile::Navigation;
use engine::scene::Scene;

/// People behind thinner walls are pushed aside by some centimeters and more, meters.
const THIN: f64 = 0.5;
/// The distance of the points that are looked at behind a wall, meters.
const STEP: f64 = 0.02;
/// Shorter walls are the sides of pillars, around which people pass anyway, meters.
const SHORTEST: f64 = 1.0;
/// This many walls are looked at.
const MOST_WALLS: usize = 20_000;

/// A note on a floor with thin walls and people with social forces.
pub fn note(scene: &Scene) -> Option<String> {
    let has_social = |navigation: &Navigation| matches!(navigation, Navigation::Social(..));
    let mut groups = scene.groups.iter();
    let group = groups.find(|group| {
        let steps = group.blend.steps();
        steps
            .iter()
            .any(|step| has_social(&step.profile.navigation))
    })?;
    let walls = &scene.walls;
    let all = (0..walls.len().min(MOST_WALLS) as u32).map(|k| walls.wall(k));
    let thin = all.filter_map(|wall| Some((thickness(walls, wall)?, wall)));
    let (thickness, wall) = thin.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let middle = 0.5 * (wall.start + wall.end);
    let [x, y] = [middle.x, middle.y].map(to_centimeters);
    Some(format!(
        "social forces of profile `{}` act through walls, as in the paper: people on both sides of a wall of {} m, at \
         ({x}, {y}), push each other; `steer+sph` and `rvo` hardly do (docs/reference/profiles.md)",
        shown(&group.blend.name),
        brief(to_centimeters(thickness)),
    ))
}

/// The thickness of a long wall behind whose middle there is floor again, meters; `None` if it is not thin.
fn thickness(walls: &Walls, wall: &Wall) -> Option<f64> {
    if wall.length() < SHORTEST {
        return None;
    }
    let middle = 0.5 * (wall.start + wall.end);
    let steps = (1..=(THIN / STEP) as u32).map(|k| STEP * f64::from(k));
    let mut depths =
        steps.filter(|depth| walls.obstacle_at(middle - wall.normal * *depth).is_none());
    depths.next()
}
