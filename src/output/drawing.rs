//! What pictures, pages and recordings show of a scenario beside its people. The levels of a building, which the engine
//! keeps far apart, are drawn beside each other in rows, the lowest at the bottom.

use std::borrow::Cow;
use std::sync::Arc;

use crate::over_joins::on_levels;
use crate::scenery::{GoalOf, hatching};
use engine::agents::NewAgent;
use engine::geometry::{Area, Polygon, Walls};
use engine::journeys::{Kind, Zone};
use engine::levels::{Level, Levels};
use engine::math::{Vector, bounds, direction};
use engine::routes::Goal as WayGoal;
use engine::scene::{Goal, Region, Scene};
use scenario::floor_plan::Label;
use scenario::measurements::Observed;
use scenario::quote::shown;
use scenario::{Scenario, suggestion};

/// The distance between levels, as a part of the width of the widest, and at least, meters: room for their names.
const APART: f64 = 0.06;
const LEAST_APART: f64 = 3.0;
/// Drawings of buildings are about this many times as wide as high.
const ASPECT: f64 = 1.6;
/// Around a drawing, meters.
const MARGIN: f64 = 1.5;
/// Of a drawing of one level, the others are so far away, meters.
const AWAY: f64 = 1e5;
/// Places this near to the rectangle around a level are on it, meters.
const AT_EDGE: f64 = 1e-6;
/// The width of a step, meters.
const TREAD: f64 = 0.3;

/// Where the levels of a building are drawn.
#[derive(Debug, Clone)]
pub struct Drawing {
    levels: Arc<Levels>,
    /// From the place of each level in the building to that in the drawing, meters.
    ways: Vec<Vector>,
    /// What it shows.
    pub shown: Region,
    /// The number of the only level that it shows, at its place in the building.
    pub only: Option<usize>,
}

/// An edge of a level at which people walk to another one.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// Its ends, the level on the left, meters.
    pub line: [Vector; 2],
    /// The name of the level to which it leads.
    pub to: String,
}

impl Drawing {
    /// The drawing of all levels of a scene; `None` if it is no building.
    pub fn of(scene: &Scene) -> Option<Self> {
        let levels = scene.levels.clone()?;
        let ways = rows(levels.all());
        let places = levels.all().iter().zip(&ways);
        let corners = places.flat_map(|(level, way)| level.corners().map(|p| p + way));
        Some(Self {
            shown: around(corners),
            ways,
            levels,
            only: None,
        })
    }

    /// The drawing of all levels of a scenario, or of that of this name; `None` if it is no building.
    ///
    /// # Errors
    /// There is no such level.
    pub fn named(scenario: &Scenario, name: Option<&str>) -> Result<Option<Self>, String> {
        let Some(name) = name else {
            return Ok(Self::of(&scenario.scene));
        };
        let of_scene = scenario.scene.levels.as_ref();
        let levels = of_scene.ok_or("it is for buildings, and this scenario has no `levels`")?;
        let names = || levels.all().iter().map(|level| level.name.as_str());
        let number = names().position(|own| own == name).ok_or_else(|| {
            let near = suggestion(name, names());
            let all: Vec<String> = names().map(|name| format!("`{}`", shown(name))).collect();
            let (name, all) = (shown(name), all.join(", "));
            format!("there is no level named `{name}`{near}; there are {all}")
        })?;
        Ok(Some(Self::of_level(levels.clone(), number)))
    }

    /// The drawing of one level, by its number.
    pub fn of_level(levels: Arc<Levels>, number: usize) -> Self {
        let mut ways = vec![Vector::repeat(AWAY); levels.all().len()];
        ways[number] = Vector::zeros();
        Self {
            ways,
            shown: around(levels.all()[number].corners().into_iter()),
            levels,
            only: Some(number),
        }
    }

    /// Where a place of the engine's plane is drawn, meters.
    pub fn place(&self, p: Vector) -> Vector {
        self.levels.in_building(p) + self.ways[self.levels.level(p)]
    }

    /// The place of the engine's plane that is drawn at `p`; `None` between the levels.
    pub fn in_plane(&self, p: Vector) -> Option<Vector> {
        self.shown_levels().find_map(|(number, level, way)| {
            let [low, high] = level.corners();
            let at = p - way;
            let outside = (low - at).sup(&(at - high)).max();
            let is_there = outside < AT_EDGE;
            is_there.then(|| at + self.levels.way(number as i32))
        })
    }

    /// The way from the building to the plane on the only level that it shows, meters.
    pub fn to_plane(&self) -> Option<Vector> {
        Some(self.levels.way(self.only? as i32))
    }

    /// Whether the level of a place of the plane is shown.
    pub fn shows(&self, p: Vector) -> bool {
        self.is_shown(self.levels.level(p))
    }

    /// The way from the building to the drawing on a level, by its number, meters.
    pub fn way(&self, level: usize) -> Option<Vector> {
        self.ways.get(level).copied()
    }

    /// Where a line of the plane is drawn that goes on over joins, as it is seen from its first point: its parts on the
    /// levels that are shown.
    pub fn parts(&self, line: &[Vector]) -> Vec<Vec<Vector>> {
        let parts = on_levels(&self.levels, line).into_iter();
        let shown = parts.filter(|part| part.first().is_some_and(|&p| self.shows(p)));
        shown
            .map(|part| part.into_iter().map(|p| self.place(p)).collect())
            .collect()
    }

    /// The way from the building to the drawing on the level of a place of the plane, meters.
    pub fn from_building(&self, p: Vector) -> Vector {
        self.ways[self.levels.level(p)]
    }

    /// The levels of the building.
    pub fn levels(&self) -> &Levels {
        &self.levels
    }

    /// The name of the level of a place of the plane.
    pub fn level(&self, p: Vector) -> &str {
        &self.levels.all()[self.levels.level(p)].name
    }

    /// The name of the only level that it shows.
    pub fn only_level(&self) -> Option<&str> {
        Some(&self.levels.all()[self.only?].name)
    }

    /// The names of the levels that are shown, each with the middles of the upper and the lower edge of its floor.
    pub fn names(&self) -> Vec<(&str, [Vector; 2])> {
        let named = self.rectangles().into_iter().map(|(name, [low, high])| {
            let middle = (low.x + high.x) * 0.5;
            (name, [high.y, low.y].map(|y| Vector::new(middle, y)))
        });
        named.collect()
    }

    /// The names of the levels that are shown, each with the lower left and the upper right corner of its floor.
    pub fn rectangles(&self) -> Vec<(&str, [Vector; 2])> {
        let shown = self.shown_levels();
        let named = shown.map(|(_, level, way)| {
            let corners = level.corners().map(|corner| corner + way);
            (level.name.as_str(), corners)
        });
        named.collect()
    }

    /// The joins of the levels that are shown.
    pub fn joins(&self) -> Vec<Way> {
        let joins = self.levels.joins().iter().map(|join| {
            let number = self.levels.level(join.line[0]);
            let to = (number as i32 + join.to) as usize;
            (number, join.line, self.levels.all()[to].name.clone())
        });
        let shown = joins.filter(|(number, ..)| self.only.is_none_or(|only| only == *number));
        let drawn = shown.map(|(_, line, to)| Way {
            line: line.map(|p| self.place(p)),
            to,
        });
        drawn.collect()
    }

    /// Lines across stairs and ramps, a step and at least `least` meters apart.
    pub fn steps(&self, least: f64) -> Vec<[Vector; 2]> {
        let lines = self.shown_levels().flat_map(|(_, level, way)| {
            let lines = steps(level, TREAD.max(least)).into_iter();
            lines.map(move |line| line.map(|p| p + way))
        });
        lines.collect()
    }

    /// A scene as it is drawn: floors end at their joins.
    fn scene(&self, scene: &Scene) -> Scene {
        let mut drawn = scene.clone();
        drawn.levels = None;
        drawn.routes = None;
        drawn.behind.clear();
        if let Some(walls) = self.walls() {
            drawn.walls = walls;
        }
        let place = |p: &mut Vector| *p = self.place(*p);
        let agent = |agent: &mut NewAgent| {
            place(&mut agent.position);
            place(&mut agent.goal);
        };
        drawn.agents.iter_mut().for_each(agent);
        let late = drawn.scheduled.iter_mut();
        late.for_each(|late| agent(&mut late.agent));
        for source in &mut drawn.sources {
            place(&mut source.grid.min);
            place(&mut source.grid.max);
            if let Goal::Point(goal) = &mut source.goal {
                place(goal);
            }
        }
        for entrance in &mut drawn.entrances {
            entrance.line.iter_mut().for_each(place);
            place(&mut entrance.goal);
        }
        for push in &mut drawn.pushes {
            push.region = self.region(push.region);
        }
        for of in &mut drawn.journeys.places {
            match &mut of.kind {
                Kind::Exit(exit) => exit.line.iter_mut().for_each(place),
                Kind::Line(line) => line.iter_mut().for_each(place),
                Kind::Door(door) => door.line.iter_mut().for_each(place),
                Kind::Disk { at, .. } => place(at),
                Kind::Queue(queue) => queue.path.iter_mut().for_each(place),
                Kind::Waiting(waiting) => {
                    waiting.spots.iter_mut().for_each(place);
                    let shift = self.shift(waiting.area.points());
                    waiting.area = waiting.area.clone().moved(shift);
                }
            }
            for goal in &mut of.goals {
                match goal {
                    WayGoal::Point(p) => place(p),
                    WayGoal::Line(line) => line.iter_mut().for_each(place),
                }
            }
        }
        for zone in &mut drawn.journeys.zones {
            zone.area = zone.area.clone().moved(self.shift(zone.area.points()));
        }
        let cabins = self.cabins(scene);
        drawn.journeys.zones.extend(cabins);
        drawn
    }

    /// The cabins of lifts on the levels that are shown, as zones that change nothing.
    fn cabins(&self, scene: &Scene) -> Vec<Zone> {
        let cabins = scene.journeys.lifts.iter().flat_map(|lift| {
            let levels = lift.stops.iter().map(|stop| usize::from(stop.level));
            let shown = levels.filter(|&level| self.is_shown(level));
            shown.map(|level| Zone {
                name: lift.name.clone(),
                area: lift.cabin.clone().moved(self.ways[level]),
                speed_factor: 1.0,
                motivation: 0.0,
                time: 0.0..f64::INFINITY,
            })
        });
        cabins.collect()
    }

    /// From the plane to the drawing for what lies on the level of the first of these points.
    fn shift(&self, points: &[Vector]) -> Vector {
        points
            .first()
            .map_or(Vector::zeros(), |&p| self.place(p) - p)
    }

    fn region(&self, Region { min, max }: Region) -> Region {
        let shift = self.shift(&[(min + max) * 0.5]);
        Region {
            min: min + shift,
            max: max + shift,
        }
    }

    fn observed(&self, observed: Observed) -> Observed {
        match observed {
            Observed::Region(region) => Observed::Region(self.region(region)),
            Observed::Line(ends) => Observed::Line(ends.map(|end| self.place(end))),
        }
    }

    /// Whether the level with this number is shown.
    fn is_shown(&self, number: usize) -> bool {
        self.only.is_none_or(|only| only == number)
    }

    /// The levels that are shown, with their numbers and their ways to the drawing.
    fn shown_levels(&self) -> impl Iterator<Item = (usize, &Level, Vector)> {
        let levels = self.levels.all().iter().zip(&self.ways).enumerate();
        let shown = levels.filter(|(number, _)| self.is_shown(*number));
        shown.map(|(number, (level, way))| (number, level, *way))
    }

    /// The walls around the floors that are shown.
    fn walls(&self) -> Option<Walls> {
        let areas = self.shown_levels().flat_map(|(_, level, way)| {
            let floor = level.floor.iter().cloned();
            floor.map(move |area| area.moved(way))
        });
        let walls = Polygon::enclosing(areas.collect::<Vec<Area>>()).ok()?;
        Some(Walls::new(vec![walls]))
    }
}

/// Lines across a slope, at its place in the building, this far apart, meters; none on a floor.
pub fn steps(level: &Level, apart: f64) -> Vec<[Vector; 2]> {
    if level.rise == Vector::zeros() {
        return Vec::new();
    }
    let outlines = level.floor.iter().map(|area| &area.exterior);
    let lines = outlines.flat_map(|ring| hatching(ring, direction(level.rise), apart));
    lines.collect()
}

/// A scene as it is drawn.
pub fn drawn<'a>(scene: &'a Scene, drawing: Option<&Drawing>) -> Cow<'a, Scene> {
    match drawing {
        Some(drawing) => Cow::Owned(drawing.scene(scene)),
        None => Cow::Borrowed(scene),
    }
}

/// Goals where they are drawn.
pub fn goals(mut goals: Vec<GoalOf>, drawing: Option<&Drawing>) -> Vec<GoalOf> {
    for (goal, _) in &mut goals {
        *goal = drawing.map_or(*goal, |drawing| drawing.place(*goal));
    }
    goals
}

/// A region with a margin around some points.
fn around(points: impl Iterator<Item = Vector>) -> Region {
    let [low, high] = bounds(points).unwrap_or_default();
    let margin = Vector::repeat(MARGIN);
    Region {
        min: low - margin,
        max: high + margin,
    }
}

/// The way from the building to the drawing for each level: rows of levels from the lowest up.
fn rows(levels: &[Level]) -> Vec<Vector> {
    let corners: Vec<[Vector; 2]> = levels.iter().map(Level::corners).collect();
    let size = |k: usize| corners[k][1] - corners[k][0];
    let widest = (0..levels.len()).map(|k| size(k).x).fold(0.0, f64::max);
    let apart = LEAST_APART.max(APART * widest);
    let area = |k: usize| (size(k).x + apart) * (size(k).y + apart);
    let all: f64 = (0..levels.len()).map(area).sum();
    let width = widest.max((ASPECT * all).sqrt());
    let height = |k: usize| levels[k].height((corners[k][0] + corners[k][1]) * 0.5);
    let mut order: Vec<usize> = (0..levels.len()).collect();
    order.sort_by(|&a, &b| height(a).total_cmp(&height(b)));
    let mut ways = vec![Vector::zeros(); levels.len()];
    let mut at = Vector::zeros();
    let mut highest: f64 = 0.0;
    for k in order {
        if at.x > 0.0 && at.x + size(k).x > width {
            at = Vector::new(0.0, at.y + highest + apart);
            highest = 0.0;
        }
        ways[k] = at - corners[k][0];
        at.x += size(k).x + apart;
        highest = highest.max(size(k).y);
    }
    ways
}

/// What is shown of a scenario beside its people.
#[derive(Debug)]
pub struct Drawn<'a> {
    /// How the levels of a building lie.
    pub drawing: Option<Drawing>,
    /// Walls and places.
    pub scene: Cow<'a, Scene>,
    /// The part of the plane.
    pub view: Region,
    /// Texts.
    pub labels: Vec<Label>,
    /// The places that measurements observe, with their names.
    pub observed: Vec<(String, Observed)>,
}

impl<'a> Drawn<'a> {
    /// All of a scenario.
    pub fn of(scenario: &'a Scenario) -> Self {
        Self::with(scenario, Drawing::of(&scenario.scene))
    }

    /// Where a place of the engine's plane is drawn, meters.
    pub fn place(&self, p: Vector) -> Vector {
        self.drawing.as_ref().map_or(p, |drawing| drawing.place(p))
    }

    /// A scenario whose levels lie as in a drawing.
    pub fn with(scenario: &'a Scenario, drawing: Option<Drawing>) -> Self {
        let measurements = scenario.measurements.iter();
        let mut observed: Vec<_> = measurements.flat_map(|one| one.observed()).collect();
        let mut labels = scenario.labels.clone();
        let Some(drawing) = drawing else {
            return Self {
                drawing,
                scene: drawn(&scenario.scene, None),
                view: scenario.view.region,
                labels,
                observed,
            };
        };
        for label in &mut labels {
            label.at = drawing.place(label.at);
        }
        for (_, place) in &mut observed {
            *place = drawing.observed(*place);
        }
        Self {
            scene: drawn(&scenario.scene, Some(&drawing)),
            view: drawing.shown,
            labels,
            observed,
            drawing: Some(drawing),
        }
    }
}
