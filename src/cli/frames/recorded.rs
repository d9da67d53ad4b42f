//! Frames of a recording.

use std::collections::HashMap;
use std::path::Path;

use super::{Film, Over, Run};
use crate::cli::failure::Failure;
use crate::cli::terminal::talk;
use engine::agents::REFERENCE_RADIUS;
use engine::geometry::{Polygon, assemble};
use engine::math::Vector;
use engine::scene::Scene;
use output::drawing::Drawn;
use output::picture::Crowd;
use output::recording::Recorded;
use scenario::Scenario;

/// Corners that are nearer to each other are one, meters: recordings have single precision.
const TOLERANCE: f64 = 1e-4;

/// The run that a recording holds. Walls, places and ranges are those of the scenario in it; a recording of a
/// measurement has only walls.
pub fn open(path: &Path) -> Result<Run, Failure> {
    let recorded = Recorded::read(path).map_err(|error| Failure::Input(error.to_string()))?;
    let scenario = recorded.scenario().and_then(|text| {
        let parsed = Scenario::parse(text, &path.display().to_string(), &[]);
        let lost = |error| talk(&format!("note: places are not shown: {error}"));
        parsed.map_err(lost).ok()
    });
    let times: Vec<f64> = recorded.times().collect();
    let ends = times.first().copied().zip(times.last().copied());
    let report = recorded.report().map(str::to_owned);
    let title = recorded.title().unwrap_or_default().to_owned();
    let run = match &scenario {
        Some(scenario) => {
            let drawn = Drawn::of(scenario);
            let frames = Over::new(recorded, times, drawn.scene.clone().into_owned());
            Run::of(scenario, drawn, Box::new(frames))
        }
        None => {
            let corners = recorded.walls().concat().into_iter();
            let people = recorded.crowd(0).positions;
            let scene = Scene::with_obstacles(bodies(recorded.walls()));
            let frames = Over::new(recorded, times, scene);
            Run::around(corners.chain(people), Box::new(frames))
        }
    };
    Ok(Run {
        title,
        times: ends.map(Into::into),
        report,
        scenario,
        ..run
    })
}

/// The bodies with these outlines: those around a floor if the largest outline has its solid outside.
fn bodies(walls: &[Vec<Vector>]) -> Vec<Polygon> {
    let area = |ring: &[Vector]| -> f64 {
        let ends = ring.iter().cycle().skip(1);
        ring.iter().zip(ends).map(|(a, b)| a.perp(b)).sum()
    };
    let areas = walls.iter().map(|ring| area(ring));
    let largest = areas.max_by(|a, b| a.abs().total_cmp(&b.abs()));
    let is_floor = largest.is_some_and(|area| area < 0.0);
    let turned = |ring: &Vec<Vector>| match is_floor {
        true => ring.iter().rev().copied().collect(),
        false => ring.clone(),
    };
    let rings: Vec<Vec<Vector>> = walls.iter().map(turned).collect();
    let Ok(areas) = assemble(&rings, std::iter::empty(), TOLERANCE) else {
        return Vec::new();
    };
    match is_floor {
        true => Polygon::enclosing(areas).into_iter().collect(),
        false => areas
            .into_iter()
            .filter_map(|area| Polygon::filling(area).ok())
            .collect(),
    }
}

impl Film for Recorded {
    /// Velocities are differences between the frames before and after.
    fn crowd(&self, k: usize) -> Crowd {
        let crowd = self.crowd(k);
        let times: Vec<f64> = self.times().collect();
        let others = [k.saturating_sub(1), (k + 1).min(times.len() - 1)].map(|k| {
            let other = self.crowd(k);
            let places = other.ids.into_iter().zip(other.positions);
            (times[k], places.collect::<HashMap<_, _>>())
        });
        let velocity = |(id, &place): (&i64, &Vector)| {
            let [from, to] = others.each_ref().map(|(time, places)| {
                let other = places.get(id).map(|&other| (*time, other));
                other.unwrap_or((times[k], place))
            });
            (to.0 > from.0).then(|| (to.1 - from.1) / (to.0 - from.0))
        };
        let is_known = |radius: &f64| *radius > 0.0;
        let known = crowd.radii.into_iter();
        let radii = known.map(|radius| Some(radius).filter(is_known).unwrap_or(REFERENCE_RADIUS));
        let radius: Vec<f64> = radii.collect();
        let mass = |radius: &f64| (radius / REFERENCE_RADIUS).powi(2);
        let velocities = crowd.ids.iter().zip(&crowd.positions).map(velocity);
        Crowd {
            time: times[k],
            velocity: velocities.collect(),
            id: crowd.ids,
            position: crowd.positions,
            mass: radius.iter().map(mass).collect(),
            radius,
        }
    }

    fn names(&self) -> Vec<&str> {
        self.names().collect()
    }

    fn values(&self, k: usize, name: &str) -> Result<Option<Vec<f64>>, Failure> {
        Ok(self.values(k, name))
    }
}
