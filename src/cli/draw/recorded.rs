//! Frames of a recording.

use std::path::Path;

use super::frames::{ALWAYS, Frames, Run, around, densities, kernel, speeds};
use crate::cli::failure::Failure;
use crate::cli::terminal::talk;
use crate::engine::agents::REFERENCE_RADIUS;
use crate::engine::geometry::{Polygon, assemble};
use crate::engine::math::Vector;
use crate::engine::scene::Scene;
use crate::lab::measure::Site;
use crate::output::colors::{DENSITY_RANGE, SPEED_RANGE};
use crate::output::picture::Crowd;
use crate::output::recording::Recorded;
use crate::scenario::Scenario;

/// Corners that are nearer to each other are one, meters: recordings have single precision.
const TOLERANCE: f64 = 1e-4;
/// Margin around walls and people, meters.
const MARGIN: f64 = 1.0;

struct Read {
    recorded: Recorded,
    scene: Scene,
    site: Site,
    support_radius: f64,
    /// The number of the current frame.
    current: usize,
    crowd: Crowd,
}

/// The run that a recording holds. Walls, places and ranges are those of the scenario in it; a recording of a
/// measurement has only walls.
pub fn open(path: &Path) -> Result<Run, Failure> {
    let recorded = Recorded::read(path).map_err(|error| Failure::Input(error.to_string()))?;
    let scenario = recorded.scenario().and_then(|text| {
        let parsed = Scenario::parse(text, &path.display().to_string(), &[]);
        let lost = |error| talk(&format!("note: places are not shown: {error}"));
        parsed.map_err(lost).ok()
    });
    let scene = match &scenario {
        Some(scenario) => scenario.scene.clone(),
        None => Scene::with_obstacles(bodies(recorded.walls())),
    };
    let view = match &scenario {
        Some(scenario) => scenario.view.region,
        None => {
            let corners = recorded.walls().iter().flatten().copied();
            let people = recorded.crowd(0).positions.into_iter();
            around(corners.chain(people), MARGIN)
        }
    };
    let title = recorded.title().unwrap_or_default().to_owned();
    let [first, last] = [recorded.times().next(), recorded.times().last()];
    let support = scene
        .groups
        .iter()
        .map(|group| group.blend.sph.support_radius);
    let support_radius = support.reduce(f64::max).unwrap_or(1.0);
    let mut read = Read {
        site: Site::new(scene.walls.obstacles().to_vec()),
        scene,
        support_radius,
        current: 0,
        crowd: Crowd::default(),
        recorded,
    };
    read.take();
    let scenario = scenario.as_ref();
    let density_range = scenario.map(|scenario| scenario.view.density_range);
    let speed_range = scenario.map(|scenario| scenario.view.speed_range);
    let observed = scenario.iter().flat_map(|scenario| &scenario.measurements);
    Ok(Run {
        frames: Box::new(read),
        title,
        view,
        density_range: density_range.unwrap_or([0.0, DENSITY_RANGE.into()]),
        speed_range: speed_range.unwrap_or([0.0, SPEED_RANGE.into()]),
        support_radius,
        observed: observed.flat_map(|one| one.observed()).collect(),
        labels: scenario.map_or(Vec::new(), |scenario| scenario.labels.clone()),
        body_mass: None,
        times: first.zip(last).map(Into::into),
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

impl Read {
    /// Takes the crowd of the current frame. Velocities are differences between the frames before and after.
    fn take(&mut self) {
        let crowd = self.recorded.crowd(self.current);
        let times: Vec<f64> = self.recorded.times().collect();
        let near = [
            self.current.saturating_sub(1),
            (self.current + 1).min(times.len() - 1),
        ];
        let others = near.map(|k| {
            let other = self.recorded.crowd(k);
            let places = other.ids.into_iter().zip(other.positions);
            (
                times[k],
                places.collect::<std::collections::HashMap<_, _>>(),
            )
        });
        let here = times[self.current];
        let velocity = |(id, &place): (&i64, &Vector)| {
            let [from, to] = [&others[0], &others[1]].map(|(time, places)| {
                let other = places.get(id).map(|&other| (*time, other));
                other.unwrap_or((here, place))
            });
            (to.0 > from.0).then(|| (to.1 - from.1) / (to.0 - from.0))
        };
        let radius = |radius: &f64| {
            if *radius > 0.0 {
                *radius
            } else {
                REFERENCE_RADIUS
            }
        };
        let radius: Vec<f64> = crowd.radii.iter().map(radius).collect();
        self.crowd = Crowd {
            time: here,
            velocity: crowd
                .ids
                .iter()
                .zip(&crowd.positions)
                .map(velocity)
                .collect(),
            id: crowd.ids,
            position: crowd.positions,
            mass: radius
                .iter()
                .map(|radius| (radius / REFERENCE_RADIUS).powi(2))
                .collect(),
            radius,
        };
    }
}

impl Frames for Read {
    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn go_to(&mut self, time: f64) -> Result<(), Failure> {
        let away = |(_, at): &(usize, f64)| (at - time).abs();
        let times = self.recorded.times().enumerate();
        let nearest = times.min_by(|a, b| away(a).total_cmp(&away(b)));
        self.current = nearest.map_or(0, |(k, _)| k);
        self.take();
        Ok(())
    }

    fn crowd(&self) -> &Crowd {
        &self.crowd
    }

    fn columns(&self) -> Vec<String> {
        let own = self.recorded.names().filter(|name| !ALWAYS.contains(name));
        ALWAYS.into_iter().chain(own).map(str::to_owned).collect()
    }

    fn column(&self, name: &str) -> Result<Option<Vec<f64>>, Failure> {
        let own = self.recorded.values(self.current, name);
        let own = own.filter(|values| values.len() == self.crowd.len());
        Ok(own.or_else(|| match name {
            "density" => Some(densities(
                &self.crowd,
                &self.site,
                &kernel(self.support_radius),
            )),
            "speed" => Some(speeds(&self.crowd)),
            "radius" => Some(self.crowd.radius.clone()),
            _ => None,
        }))
    }
}
