//! The walkable area as WKT: a rectangle without the obstacles, or the scenario's own walkable area.
//!
//! The rectangle covers the view, everything in the scene and a margin, and grows with the crowd. If obstacles divide
//! the area, only the parts in which agents enter are kept, because agents cannot pass through walls. If there are
//! several such parts, the text is a `MULTIPOLYGON`; PedPy takes a single polygon, so its user must choose one.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::Row;
use super::error::Cause;
use engine::geometry::{Area, AreaIndex};
use engine::levels::Levels;
use engine::math::{Vector, bounds};
use engine::period::Period;
use engine::scene::{Goal, Region};
use engine::simulation::Simulation;
use scenario::floor_plan::{Rings, free, outlines, rings, to_wkt};

/// Margin around everything, meters.
const MARGIN: f64 = 5.0;

/// The rectangle, floors and obstacles that define the walkable area.
pub struct WalkableArea {
    /// The corners of the rectangle with the lowest and the highest x and y.
    bounds: [Vector; 2],
    /// The rings of each unbounded obstacle, reversed, so that they enclose the floor.
    floors: Vec<Rings>,
    /// The rings of the bounded obstacles.
    obstacles: Rings,
    entries: Vec<Vector>,
    /// The area ends where the period does.
    period: Option<Period>,
    /// That of a building has the floors of all levels, seen from above.
    levels: Option<Arc<Levels>>,
}

impl WalkableArea {
    /// The area of the scene in its current state.
    pub fn new(simulation: &Simulation, view: Region) -> Self {
        let scene = simulation.scene();
        let agents = simulation.frame().agents;
        let mut entries: Vec<Vector> = agents.present().map(|i| agents.position[i]).collect();
        let mut goals: Vec<Vector> = agents.present().map(|i| agents.goal[i]).collect();
        for source in &scene.sources {
            let entry = |p| entrance(simulation, p);
            let positions: Vec<Vector> = source.grid.positions(scene.seed, 0).collect();
            goals.extend(positions.iter().map(|&p| match source.goal {
                Goal::Point(goal) => goal,
                Goal::Offset(offset) => p + offset,
            }));
            entries.extend(positions.into_iter().map(entry));
        }
        for late in &scene.scheduled {
            goals.extend([late.agent.position, late.agent.goal]);
        }
        for entrance in &scene.entrances {
            goals.push(entrance.goal);
            goals.extend(entrance.line);
        }
        let obstacles = scene.walls.obstacles();
        let corners = obstacles.iter().flat_map(|obstacle| obstacle.points());
        let inside = entries.iter().chain(&goals).chain(corners);
        let everything = inside.chain([&view.min, &view.max]);
        let [min, max] = bounds(everything.copied()).unwrap_or_default();
        let margin = Vector::new(MARGIN, MARGIN);
        let (floors, obstacles) = outlines(obstacles);
        Self {
            bounds: [min - margin, max + margin],
            floors,
            obstacles,
            entries,
            period: scene.period,
            levels: scene.levels.clone(),
        }
    }

    /// Extends the rectangle to include all agents. Returns whether it grew.
    pub fn reach(&mut self, rows: &[Row<'_>]) -> bool {
        let mut grown = false;
        if self.levels.is_some() {
            return grown;
        }
        for row in rows {
            let place = row.place();
            let [low, high] = self.bounds;
            if (place - low).min() <= 0.0 || (high - place).min() <= 0.0 {
                let margin = Vector::new(MARGIN, MARGIN);
                self.bounds = [low.inf(&(place - margin)), high.sup(&(place + margin))];
                grown = true;
            }
        }
        grown
    }

    /// The area as WKT, and its lowest and highest x and y.
    ///
    /// # Errors
    /// As [`free`].
    pub fn cut_out(&self) -> Result<(String, [f64; 4]), Cause> {
        let described = |areas: &[Area], otherwise| {
            let corners = areas.iter().flat_map(|area| area.exterior.points());
            let [min, max] = bounds(corners.copied()).unwrap_or(otherwise);
            (to_wkt(areas), [min.x, min.y, max.x, max.y])
        };
        if let Some(levels) = &self.levels {
            let floors = levels.all().iter().flat_map(|level| &level.floor);
            let areas = free(&[rings(floors)], &Rings::new())?;
            return Ok(described(&areas, self.bounds));
        }
        let clipped = |period: Period| period.clipped(self.bounds);
        let [min, max] = self.period.map_or(self.bounds, clipped);
        let mut floors = self.floors.clone();
        // Without period, the rectangle contains all floors.
        if floors.is_empty() || self.period.is_some() {
            floors.push(vec![Region { min, max }.corners().to_vec()]);
        }
        let mut areas = free(&floors, &self.obstacles)?;
        let index = AreaIndex::new(&areas);
        let walked: BTreeSet<usize> = self.entries.iter().flat_map(|&p| index.around(p)).collect();
        if !walked.is_empty() {
            let numbered = areas.into_iter().enumerate();
            areas = numbered
                .filter(|(k, _)| walked.contains(k))
                .map(|(_, area)| area)
                .collect();
        }
        Ok(described(&areas, self.bounds))
    }
}

/// The position at which an agent that enters at `p` is placed.
fn entrance(simulation: &Simulation, p: Vector) -> Vector {
    let walls = &simulation.scene().walls;
    let inside = walls.obstacle_at(p).is_some();
    let exit = inside.then(|| walls.free_point_near(p)).flatten();
    exit.unwrap_or(p)
}
