//! Frames of a recording.

use std::collections::HashMap;
use std::path::Path;

use super::{Over, Run, of_level};
use crate::cli::failure::Failure;
use crate::cli::terminal::talk;
use engine::agents::REFERENCE_RADIUS;
use engine::geometry::{Polygon, assemble};
use engine::math::Vector;
use engine::scene::Scene;
use output::drawing::{Drawing, Drawn};
use output::picture::Crowd;
use output::recording::Recorded;
use scenario::Scenario;

/// Corners that are nearer to each other are one, meters: recordings have single precision.
const TOLERANCE: f64 = 1e-4;

/// The quantity with the numbers of the levels of people in a building.
const LEVEL: &str = "level";

/// A recording as it is drawn.
struct Film {
    recorded: Recorded,
    /// How it was drawn when it was recorded, if it is one of a building.
    drawing: Option<Drawing>,
    /// The number of the only level that is shown.
    only: Option<usize>,
}

/// The run that a recording holds, of a building on all levels or on that of this name. Walls, places and ranges are
/// those of the scenario in it; a recording of a measurement has only walls.
pub fn open(path: &Path, level: Option<&str>) -> Result<Run, Failure> {
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
            let drawing = Drawing::named(scenario, level).map_err(of_level)?;
            let only = drawing.as_ref().and_then(|drawing| drawing.only);
            let film = Film::of(recorded, Drawing::of(&scenario.scene), only)?;
            let drawn = Drawn::with(scenario, drawing);
            let frames = Over::new(film, times, drawn.scene.clone().into_owned());
            Run::of(scenario, drawn, Box::new(frames))
        }
        None if level.is_some() => {
            let problem = "the recording has no scenario, and no levels".to_owned();
            return Err(of_level(problem));
        }
        None => {
            let corners = recorded.walls().concat().into_iter();
            let people = recorded.crowd(0).positions;
            let scene = Scene::with_obstacles(bodies(recorded.walls()));
            let frames = Over::new(Film::of(recorded, None, None)?, times, scene);
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

impl Film {
    fn of(
        recorded: Recorded,
        drawing: Option<Drawing>,
        only: Option<usize>,
    ) -> Result<Self, Failure> {
        let has_levels = recorded.names().any(|name| name == LEVEL);
        if only.is_some() && !has_levels {
            let problem =
                "the recording does not say on which levels its people are: record it again";
            return Err(of_level(problem.to_owned()));
        }
        Ok(Self {
            recorded,
            drawing: drawing.filter(|_| has_levels),
            only,
        })
    }

    /// The numbers of the levels of the people in frame `k`; empty without levels.
    fn levels(&self, k: usize) -> Vec<usize> {
        let numbers = self
            .drawing
            .as_ref()
            .and_then(|_| self.recorded.values(k, LEVEL));
        let all = numbers.into_iter().flatten();
        all.map(|number| number as usize).collect()
    }

    /// Whether people are shown, given their levels.
    fn shows(&self, levels: &[usize], i: usize) -> bool {
        self.only.is_none_or(|only| levels.get(i) == Some(&only))
    }

    /// The way from the drawing to the building for person `i`, meters.
    fn to_building(&self, levels: &[usize], i: usize) -> Vector {
        let drawing = self.drawing.as_ref().zip(levels.get(i));
        let way = drawing.and_then(|(drawing, &level)| drawing.way(level));
        way.map_or_else(Vector::zeros, |way| -way)
    }

    /// The people in frame `k`, at their places in the building.
    fn places(&self, k: usize) -> HashMap<i64, Vector> {
        let (crowd, levels) = (self.recorded.crowd(k), self.levels(k));
        let people = crowd.ids.into_iter().zip(crowd.positions).enumerate();
        people
            .map(|(i, (id, p))| (id, p + self.to_building(&levels, i)))
            .collect()
    }
}

impl super::Film for Film {
    /// Velocities are differences between the frames before and after.
    fn crowd(&self, k: usize) -> Crowd {
        let (crowd, levels) = (self.recorded.crowd(k), self.levels(k));
        let times: Vec<f64> = self.recorded.times().collect();
        let beside = [k.saturating_sub(1), (k + 1).min(times.len() - 1)];
        let others = beside.map(|k| (times[k], self.places(k)));
        let velocity = |id: i64, place: Vector| {
            let [from, to] = others.each_ref().map(|(time, places)| {
                let other = places.get(&id).map(|&other| (*time, other));
                other.unwrap_or((times[k], place))
            });
            (to.0 > from.0).then(|| (to.1 - from.1) / (to.0 - from.0))
        };
        let mut shown = Crowd {
            time: times[k],
            ..Crowd::default()
        };
        for (i, (&id, &p)) in crowd.ids.iter().zip(&crowd.positions).enumerate() {
            if !self.shows(&levels, i) {
                continue;
            }
            let place = p + self.to_building(&levels, i);
            let radius = match crowd.radii[i] {
                radius if radius > 0.0 => radius,
                _ => REFERENCE_RADIUS,
            };
            shown.id.push(id);
            shown
                .position
                .push(if self.only.is_some() { place } else { p });
            shown.radius.push(radius);
            shown.mass.push((radius / REFERENCE_RADIUS).powi(2));
            shown.velocity.push(velocity(id, place));
        }
        shown
    }

    fn names(&self) -> Vec<&str> {
        self.recorded.names().collect()
    }

    fn values(&self, k: usize, name: &str) -> Result<Option<Vec<f64>>, Failure> {
        let Some(values) = self.recorded.values(k, name) else {
            return Ok(None);
        };
        let levels = self.levels(k);
        let numbered = values.into_iter().enumerate();
        let shown = numbered.filter(|(i, _)| self.shows(&levels, *i));
        Ok(Some(shown.map(|(_, value)| value).collect()))
    }
}
