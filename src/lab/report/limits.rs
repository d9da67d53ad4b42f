//! The assumptions and limits of the model.

use crate::gallery::distinct;
use engine::levels::{Level, Levels};
use engine::math::{Vector, direction};
use engine::scene::Scene;
use output::document::Block;
use scenario::calibrated;
use scenario::quote::shown;

/// The speed on a floor of people whose speeds on slopes are named, m/s.
const ON_FLOOR: f64 = 1.34;
/// The most levels that are named for each speed.
const NAMED: usize = 3;

/// Assumptions and limits, for these scenes and profiles.
pub fn limits(scenes: &[&Scene], profiles: &[&str]) -> Vec<Block> {
    let mut items = distinct(scenes.iter().flat_map(|scene| of_floors(scene)));
    let of_all = [
        "Densities, pressures and forces are those of a model. Thresholds are from the literature: they help to \
         compare runs and are no safety limits. The model says nothing about injuries or deaths.",
        "A single run has chance in it: another seed gives other numbers. `sandbox estimate` gives results with their \
         errors, a study with several seeds their spread.",
        "Before decisions about people's safety, the model must be compared with measurements of a crowd like this \
         one.",
    ];
    items.extend(of_all.map(str::to_owned));
    for profile in profiles {
        let name = shown(profile);
        items.push(match calibrated::named(profile) {
            Some(_) => format!(
                "`{name}` is fitted to experiments; the status below counts the measured values that it reproduces, \
                 first those to which nothing was fitted. Exits of about 1 m pass up to \
                 a fifth more people than measured, which is the unsafe side, and pushes die out."
            ),
            None => format!(
                "`{name}` is a profile of the paper or one of the scenario's own. It is not fitted to experiments: \
                 with the paper's profiles dense crowds walk two to five times as fast as people do, which is the \
                 unsafe side. Do not size exits with it; take `steer+sph` for questions about real people."
            ),
        });
    }
    vec![Block::heading("Assumptions and limits"), Block::List(items)]
}

/// What holds on the floor or on the levels of a scene.
fn of_floors(scene: &Scene) -> Vec<String> {
    let know = "They know the floor plan, and walk to their places by the shortest or, where the scenario says so, the \
                quickest way.";
    let Some(levels) = &scene.levels else {
        return vec![format!(
            "People are discs on one flat floor. {know} There are no groups, no smoke, no falls and no lifts; stairs \
             are zones of lower speed."
        )];
    };
    let lifts = match scene.journeys.lifts.is_empty() {
        true => "no smoke, no falls and no lifts.",
        false => {
            "no smoke and no falls. Lifts take people who cannot walk to an exit, and those whose journey says so; \
             others do not choose a lift by themselves."
        }
    };
    let first = format!(
        "People are discs on the levels of a building. {know} There are no groups, {lifts}"
    );
    [first].into_iter().chain(of_slopes(levels)).collect()
}

/// The speeds on stairs, ramps and escalators, and how little is known about them; `None` on flat levels.
fn of_slopes(levels: &Levels) -> Option<String> {
    let mut speeds: Vec<(String, Vec<String>)> = Vec::new();
    let sloping = levels.all().iter();
    for level in sloping.filter(|level| level.rise != Vector::zeros()) {
        let (speed, name) = (speed(level), format!("`{}`", shown(&level.name)));
        match speeds.iter_mut().find(|(known, _)| *known == speed) {
            Some((_, names)) => names.push(name),
            None => speeds.push((speed, vec![name])),
        }
    }
    let parts = speeds.iter().map(|(speed, names)| {
        let first = names[..names.len().min(NAMED)].join(", ");
        match names.len().saturating_sub(NAMED) {
            0 => format!("{speed} on {first}"),
            more => format!("{speed} on {first} and {more} more"),
        }
    });
    let listed = parts.collect::<Vec<_>>().join("; ");
    (!speeds.is_empty()).then(|| {
        format!(
            "Stairs, ramps and escalators are planes. People who want {ON_FLOOR} m/s on a floor have these speeds \
             there, seen from above: {listed}. No experiment with a dense crowd on stairs, ramps or escalators is \
             compared here: flows and densities there at more than some 2 P/m² are the model's, not measured ones."
        )
    })
}

/// The speed on a level that slopes, seen from above.
fn speed(level: &Level) -> String {
    let toward = |way: Vector| ON_FLOOR * level.progress(direction(way));
    match level.carries == Vector::zeros() {
        true => {
            let [up, down] = [level.rise, -level.rise].map(toward);
            format!("{up:.2} m/s up and {down:.2} m/s down")
        }
        false => format!("{:.2} m/s", toward(level.carries)),
    }
}
