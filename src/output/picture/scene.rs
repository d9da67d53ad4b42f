//! The marks of a scene: ground, walls, places, zones, sources and goals.

use super::{Frame, NAME, Picture, dark, xy};
use crate::drawing;
use crate::labels::{self, AROUND, Labels, around, of_place};
use crate::scenery::{self, ZONE};
use engine::agents::Agents;
use engine::journeys::Kind;
use engine::math::Vector;
use engine::scene::{Region, Scene};
use figures::colors::{Rgb, light};
use figures::plot::{BLACK, Mark, Style};

const FLOOR: Rgb = [252, 252, 249];
const OUTSIDE: Rgb = [222, 222, 217];
const SOLID: Rgb = [176, 176, 172];
const WALL: Rgb = [52, 54, 60];
const GOAL: Rgb = [213, 94, 0];
const SOURCE: Rgb = [0, 150, 180];
const STEP: Rgb = [206, 206, 200];
const JOIN: Rgb = [110, 90, 160];
const CLOSED: Rgb = [190, 40, 40];
/// Far enough to cover the panel, meters.
const FAR: f64 = 1e7;
/// Half of a goal's cross, points.
const CROSS: f64 = 3.0;

/// Outside, floor and solid bodies.
pub fn ground(scene: &Scene) -> Vec<Mark> {
    let obstacles = scene.walls.obstacles();
    let is_enclosed = obstacles.iter().any(|obstacle| obstacle.is_unbounded());
    let around = if is_enclosed { OUTSIDE } else { FLOOR };
    let first = Mark::rectangle([-FAR, FAR], [-FAR, FAR], around);
    let outlines = obstacles.iter().flat_map(|obstacle| obstacle.rings());
    let mut rings: Vec<(f64, &[Vector])> = outlines.map(|ring| (signed_area(ring), ring)).collect();
    // The largest first: each ring lies on those around it.
    rings.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let areas = rings.into_iter().map(|(area, ring)| {
        let color = if area > 0.0 { SOLID } else { FLOOR };
        Mark::Area(ring.iter().map(|&p| xy(p)).collect(), color)
    });
    std::iter::once(first).chain(areas).collect()
}

/// Above 0 if the ring is counterclockwise: solid inside.
fn signed_area(ring: &[Vector]) -> f64 {
    let ends = ring.iter().cycle().skip(1);
    let pairs = ring.iter().zip(ends);
    pairs.map(|(a, b)| (a - ring[0]).perp(&(b - ring[0]))).sum()
}

/// Waiting areas and zones as tinted areas.
pub fn tints(scene: &Scene) -> Vec<Mark> {
    let journeys = &scene.journeys;
    let area = |corners: &[Vector], color| {
        Mark::Area(corners.iter().map(|&p| xy(p)).collect(), light(color, 0.22))
    };
    let all = journeys.zones.iter();
    let zones = all.map(|zone| area(zone.area.points(), ZONE));
    let waiting = journeys
        .places
        .iter()
        .filter_map(|place| match &place.kind {
            Kind::Waiting(waiting) => {
                Some(area(waiting.area.points(), scenery::color(&place.kind)))
            }
            _ => None,
        });
    zones.chain(waiting).collect()
}

/// The outlines of all walls.
pub fn walls(scene: &Scene) -> Vec<Mark> {
    let obstacles = scene.walls.obstacles();
    let rings = obstacles.iter().flat_map(|obstacle| obstacle.rings());
    let outlines = rings.map(|ring| {
        // The line begins and ends within an edge, where it needs no join.
        let middle = ring.first().zip(ring.last()).map(|(a, b)| (a + b) * 0.5);
        let corners = middle.iter().chain(ring).chain(&middle).map(|&p| xy(p));
        Mark::line(corners, Style::full(WALL, 1.2, ""))
    });
    outlines.collect()
}

/// Zones, hatched, with their names in the middle if `inside`, else around them.
pub fn zones(scene: &Scene, frame: &Frame, inside: bool, labels: &mut Labels) -> Vec<Mark> {
    let mut marks = Vec::new();
    for zone in &scene.journeys.zones {
        let style = |width| Style::full(light(ZONE, 0.7), width, "");
        let outline = scenery::closed(zone.area.points()).into_iter().map(xy);
        marks.push(Mark::line(outline, style(0.8)));
        let hatching = scenery::hatching(&zone.area, scenery::across_zones(), frame.meters(7.0));
        let lines = hatching.into_iter().map(|line| line.map(xy));
        marks.extend(lines.map(|line| Mark::line(line, style(0.4))));
        let name = scenery::zone_name(&scene.journeys, zone);
        labels.add(&name, ZONE, &around(zone.area.points(), inside));
    }
    marks
}

/// The steps of stairs.
pub fn steps(picture: &Picture, frame: &Frame) -> Vec<Mark> {
    let drawing = picture.drawing.iter();
    let steps = drawing.flat_map(|drawing| drawing.steps(frame.meters(3.0)));
    let style = Style::full(STEP, 0.5, "");
    steps
        .map(|line| Mark::line(line.map(xy), style.clone()))
        .collect()
}

/// The names of levels, and their joins with the names of those to which they lead.
pub fn levels(picture: &Picture, labels: &mut Labels) -> Vec<Mark> {
    let Some(drawing) = picture.drawing else {
        return Vec::new();
    };
    for (name, [top, bottom]) in drawing.names() {
        labels.add(name, NAME, &[(top, [0, 1]), (bottom, [0, -1])]);
    }
    let mut marks = Vec::new();
    let joins = drawing.joins();
    for way in &joins {
        let line = way.line.map(xy);
        marks.push(Mark::line(line, Style::full(FLOOR, 1.8, "")));
        marks.push(Mark::line(line, Style::broken(JOIN, 1.8, "")));
        let name = format!("to {}", way.to);
        labels.add_of(joins.len(), &name, (JOIN, &around(&way.line, false)));
    }
    marks
}

/// Where agents enter later.
pub fn sources(scene: &Scene, labels: &mut Labels) -> Vec<Mark> {
    let mut marks = Vec::new();
    for source in &scene.sources {
        let (min, max) = (source.grid.min, source.grid.max);
        let corners = Region { min, max }.corners();
        let outline = scenery::closed(&corners).into_iter().map(xy);
        marks.push(Mark::line(outline, Style::broken(SOURCE, 1.2, "")));
        let name = scenery::named("source", &source.name);
        labels.add(&name, SOURCE, &around(&corners, false));
    }
    for entrance in &scene.entrances {
        let [a, b] = entrance.line;
        marks.push(Mark::line([a, b].map(xy), Style::broken(SOURCE, 2.6, "")));
        let name = scenery::named("entrance", &entrance.name);
        let around = AROUND.map(|side| ((a + b) * 0.5, side));
        labels.add_of(scene.entrances.len(), &name, (SOURCE, &around));
    }
    marks
}

/// Exits, waypoints, waiting areas and queues with their names.
pub fn places(picture: &Picture, frame: &Frame, labels: &mut Labels) -> Vec<Mark> {
    let mut marks = Vec::new();
    let all = &picture.scene.journeys.places;
    let screen = frame.screen();
    for (k, place) in all.iter().enumerate() {
        let usual = scenery::color(&place.kind);
        let lines: Vec<Vector> = scenery::lines(place);
        let simulation = picture.simulation;
        let is_closed = picture.closed.contains(&k)
            || simulation.is_some_and(|simulation| scenery::is_closed(simulation, k));
        let style = match &place.kind {
            Kind::Exit(_) | Kind::Door(_) if is_closed => Style::full(CLOSED, 3.4, ""),
            Kind::Exit(_) => Style::full(usual, 3.4, ""),
            Kind::Door(_) => Style::full(usual, 2.2, ""),
            Kind::Line(_) | Kind::Disk { .. } => Style::broken(usual, 1.6, ""),
            Kind::Waiting(_) => Style::full(usual, 1.2, ""),
            Kind::Queue(_) => Style::full(usual, 1.0, ""),
        };
        marks.push(Mark::line(lines.iter().map(|&p| xy(p)), style));
        if let Kind::Queue(queue) = &place.kind {
            let spots = scenery::spots(queue).into_iter().map(xy);
            marks.push(Mark::dots(spots, Style::broken(usual, 2.0, "")));
            marks.push(Mark::dots([xy(queue.path[0])], Style::full(usual, 3.2, "")));
        }
        let closed = if is_closed { " (closed)" } else { "" };
        let text = scenery::named(place.kind.name(), &place.name) + closed;
        let color = if is_closed { CLOSED } else { usual };
        let similar = scenery::alike(picture.scene, place);
        let spots = of_place(&picture.scene.walls, place, &lines, &screen);
        labels.add_of(similar, &text, (color, &spots));
    }
    marks
}

/// The goals and groups of the initial agents.
fn initial(scene: &Scene) -> Agents {
    let mut agents = Agents::default();
    agents.goal = scene.agents.iter().map(|agent| agent.goal).collect();
    agents.group = scene.agents.iter().map(|agent| agent.group).collect();
    agents
}

/// Goals of agents without journeys, as crosses.
pub fn goals(picture: &Picture, frame: &Frame, names: &mut Labels) -> Vec<Mark> {
    let scene = picture.scene;
    let goals = match picture.simulation {
        Some(simulation) => {
            let goals = scenery::goals(simulation.scene(), simulation.frame().agents);
            drawing::goals(goals, picture.drawing)
        }
        None => scenery::goals(scene, &initial(scene)),
    };
    for (name, spots) in labels::of_goals(scene, &goals) {
        names.add(&name, GOAL, &spots);
    }
    let half = frame.meters(CROSS);
    let mut marks = Vec::new();
    for (goal, _) in &goals {
        for across in [Vector::new(half, half), Vector::new(half, -half)] {
            let ends = [goal - across, goal + across].map(xy);
            marks.push(Mark::line(ends, Style::full(GOAL, 1.6, "")));
        }
    }
    marks
}

/// A bar of this length, meters, that begins at a place.
pub fn scale_bar([x, y]: [f64; 2], length: f64, frame: &Frame) -> Vec<Mark> {
    let tick = frame.meters(2.5);
    let line = |ends: [[f64; 2]; 2]| Mark::line(ends, Style::full(dark(BLACK), 1.2, ""));
    vec![
        line([[x, y], [x + length, y]]),
        line([[x, y - tick], [x, y + tick]]),
        line([[x + length, y - tick], [x + length, y + tick]]),
    ]
}
