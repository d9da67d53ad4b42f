//! The marks of a scene: ground, walls, places, zones, sources, goals and agents.

use super::labels::{AROUND, Labels};
use super::paths::BORDER;
use super::{Frame, dark, light, xy};
use crate::engine::journeys::{Kind, Place, Status};
use crate::engine::math::{Vector, bounds, direction, perpendicular};
use crate::engine::simulation::Simulation;
use crate::output::colors::Rgb;
use crate::output::plot::{BLACK, Disc, Mark, Style};
use crate::output::scenery::{self, WALKING, ZONE};

const FLOOR: Rgb = [252, 252, 249];
const OUTSIDE: Rgb = [222, 222, 217];
const SOLID: Rgb = [176, 176, 172];
const WALL: Rgb = [52, 54, 60];
const GOAL: Rgb = [213, 94, 0];
const SOURCE: Rgb = [0, 150, 180];
/// The color of agents in pictures of ways.
const FAINT: Rgb = [150, 154, 162];
/// Far enough to cover the panel, meters.
const FAR: f64 = 1e7;
/// Up to this many goals get labels.
const NAMED_GOALS: usize = 8;
/// Half of a goal's cross, points.
const CROSS: f64 = 3.0;
/// The names of exits narrower than this lie beside them, points.
const NARROW: f64 = 50.0;
/// How far behind an exit people need room: it may lie that far from walls, meters.
const BEHIND: f64 = 3.5;

/// Outside, floor and solid bodies.
pub fn ground(simulation: &Simulation) -> Vec<Mark> {
    let obstacles = simulation.scene().walls.obstacles();
    let is_enclosed = obstacles.iter().any(|obstacle| obstacle.is_unbounded());
    let whole = vec![[-FAR, -FAR], [FAR, -FAR], [FAR, FAR], [-FAR, FAR]];
    let first = Mark::Area(whole, if is_enclosed { OUTSIDE } else { FLOOR });
    let rings = obstacles.iter().flat_map(|obstacle| obstacle.rings());
    let mut rings: Vec<(f64, &[Vector])> = rings.map(|ring| (signed_area(ring), ring)).collect();
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
pub fn tints(simulation: &Simulation) -> Vec<Mark> {
    let journeys = &simulation.scene().journeys;
    let area = |corners: &[Vector], color| {
        Mark::Area(corners.iter().map(|&p| xy(p)).collect(), light(color, 0.22))
    };
    let zones = journeys.zones.iter();
    let zones = zones.map(|zone| area(zone.area.points(), ZONE));
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
pub fn walls(simulation: &Simulation) -> Vec<Mark> {
    let obstacles = simulation.scene().walls.obstacles();
    let rings = obstacles.iter().flat_map(|obstacle| obstacle.rings());
    let outlines = rings.map(|ring| {
        let corners = ring.iter().chain(ring.first()).map(|&p| xy(p));
        Mark::Line(corners.collect(), Style::full(WALL, 1.2, ""))
    });
    outlines.collect()
}

/// Zones, hatched, with their names in the middle if `inside`, else around them.
pub fn zones(
    simulation: &Simulation,
    frame: &Frame,
    inside: bool,
    labels: &mut Labels,
) -> Vec<Mark> {
    let mut marks = Vec::new();
    for zone in &simulation.scene().journeys.zones {
        let style = |width| Style::full(light(ZONE, 0.7), width, "");
        let outline = scenery::closed(&zone.area).into_iter().map(xy);
        marks.push(Mark::Line(outline.collect(), style(0.8)));
        let hatching = scenery::hatching(&zone.area, frame.meters(7.0));
        let lines = hatching.into_iter().map(|line| line.map(xy).to_vec());
        marks.extend(lines.map(|line| Mark::Line(line, style(0.4))));
        let name = format!("zone {}", scenery::zone_name(zone));
        labels.add(&name, ZONE, &around(zone.area.points(), inside));
    }
    marks
}

/// Where agents enter later.
pub fn sources(simulation: &Simulation, labels: &mut Labels) -> Vec<Mark> {
    let mut marks = Vec::new();
    for source in &simulation.scene().sources {
        let (low, high) = (source.grid.min, source.grid.max);
        let corners = [
            low,
            Vector::new(high.x, low.y),
            high,
            Vector::new(low.x, high.y),
        ];
        let outline = corners.iter().chain(&corners[..1]).map(|&p| xy(p));
        marks.push(Mark::Line(
            outline.collect(),
            Style::broken(SOURCE, 1.2, ""),
        ));
        labels.add(
            &format!("source {}", source.name),
            SOURCE,
            &around(&corners, false),
        );
    }
    for entrance in &simulation.scene().entrances {
        let [a, b] = entrance.line;
        marks.push(Mark::Line(
            [a, b].map(xy).to_vec(),
            Style::broken(SOURCE, 2.6, ""),
        ));
        let name = format!("entrance {}", entrance.name);
        labels.add(&name, SOURCE, &AROUND.map(|side| ((a + b) * 0.5, side)));
    }
    marks
}

/// Places for the label of an area: above, below, beside, and if `inside` first in the middle.
fn around(corners: &[Vector], inside: bool) -> Vec<(Vector, [i8; 2])> {
    let [low, high] = bounds(corners.iter().copied()).unwrap_or_default();
    let middle = (low + high) * 0.5;
    let at = |[x, y]: [i8; 2]| {
        let half = (high - low) * 0.5;
        let side = Vector::new(f64::from(x), f64::from(y));
        (middle + half.component_mul(&side), [x, y])
    };
    let mut places: Vec<_> = AROUND.into_iter().map(at).collect();
    if inside {
        places.rotate_right(1);
    }
    places
}

/// Exits, waypoints, waiting areas and queues with their names.
pub fn places(simulation: &Simulation, frame: &Frame, labels: &mut Labels) -> Vec<Mark> {
    let mut marks = Vec::new();
    for (k, place) in simulation.scene().journeys.places.iter().enumerate() {
        let color = scenery::color(&place.kind);
        let lines: Vec<Vector> = scenery::lines(place);
        let points = || lines.iter().map(|&p| xy(p)).collect();
        let state = simulation.progress().places.get(k);
        let is_closed = place.is_exit() && state.is_some_and(|state| !state.open);
        match &place.kind {
            Kind::Exit(_) if is_closed => {
                marks.push(Mark::Line(points(), Style::full([190, 40, 40], 3.4, "")));
            }
            Kind::Exit(_) => marks.push(Mark::Line(points(), Style::full(color, 3.4, ""))),
            Kind::Line(_) | Kind::Disk { .. } => {
                marks.push(Mark::Line(points(), Style::broken(color, 1.6, "")));
            }
            Kind::Waiting(_) => marks.push(Mark::Line(points(), Style::full(color, 1.2, ""))),
            Kind::Queue(queue) => {
                marks.push(Mark::Line(points(), Style::full(color, 1.0, "")));
                let spots = scenery::spots(queue).into_iter().map(xy);
                marks.push(Mark::dots(spots, Style::broken(color, 2.0, "")));
                let front = [xy(queue.path[0])];
                marks.push(Mark::dots(front, Style::full(color, 3.2, "")));
            }
        }
        let closed = if is_closed { " (closed)" } else { "" };
        let text = format!("{} {}{closed}", place.kind.name(), place.name);
        let color = if is_closed { [190, 40, 40] } else { color };
        labels.add(
            &text,
            color,
            &label_places(simulation, place, &lines, frame),
        );
    }
    marks
}

/// Where the name of a place can be.
fn label_places(
    simulation: &Simulation,
    place: &Place,
    lines: &[Vector],
    frame: &Frame,
) -> Vec<(Vector, [i8; 2])> {
    match &place.kind {
        Kind::Exit(_) | Kind::Line(_) => {
            let [a, b] = [lines[0], lines[1]];
            let (middle, aside) = ((a + b) * 0.5, perpendicular(direction(b - a)));
            let walls = &simulation.scene().walls;
            let is_out = |way: &Vector| walls.obstacle_at(middle + way * BEHIND).is_some();
            let out = [aside, -aside].into_iter().find(is_out).unwrap_or(aside);
            let side = |way: Vector| {
                let part = |x: f64| (x * 1.4).round().clamp(-1.0, 1.0) as i8;
                (middle + way * frame.meters(2.0), [part(way.x), part(way.y)])
            };
            // Beside the floor behind a narrow exit, where it covers no walls.
            let beside = |end: Vector| {
                let (_, side) = side(direction(end - middle) + out);
                (end + out * frame.meters(2.0), side)
            };
            let is_narrow = (b - a).norm() * frame.scale < NARROW && place.is_exit();
            let narrow = [b, a].map(beside).into_iter().filter(|_| is_narrow);
            let others = AROUND.map(|side| (middle, side));
            narrow
                .chain([side(out), side(-out)])
                .chain(others)
                .collect()
        }
        Kind::Disk { .. } | Kind::Waiting(_) => around(lines, false),
        Kind::Queue(queue) => {
            let front = queue.path[0];
            let back = queue.path.get(1).copied().unwrap_or(front);
            let away = direction(front - back);
            let first = [away.x, away.y].map(|x| (x * 1.4).round() as i8);
            let sides = std::iter::once(first).chain(AROUND);
            sides.map(|side| (front, side)).collect()
        }
    }
}

/// Goals of agents without journeys, as crosses.
pub fn goals(simulation: &Simulation, frame: &Frame, labels: &mut Labels) -> Vec<Mark> {
    let (scene, agents) = (simulation.scene(), simulation.frame().agents);
    let goals = scenery::goals(scene, agents);
    let names = scenery::goal_labels(scene, &goals);
    let half = frame.meters(CROSS);
    let mut marks = Vec::new();
    for ((goal, _), name) in goals.iter().zip(names) {
        for across in [Vector::new(half, half), Vector::new(half, -half)] {
            let ends = [goal - across, goal + across].map(xy).to_vec();
            marks.push(Mark::Line(ends, Style::full(GOAL, 1.6, "")));
        }
        if goals.len() <= NAMED_GOALS && !name.is_empty() {
            labels.add(
                &name,
                GOAL,
                &AROUND[..8]
                    .iter()
                    .map(|&side| (*goal, side))
                    .collect::<Vec<_>>(),
            );
        }
    }
    marks
}

/// What agent `i` does, as far as pictures show it.
fn doing(simulation: &Simulation, i: usize) -> (&'static str, Rgb) {
    let (agents, clock) = (simulation.frame().agents, simulation.frame().clock);
    if agents
        .walks_from
        .get(i)
        .is_some_and(|&from| clock.time() < from)
    {
        return ("does not walk yet", [120, 150, 190]);
    }
    let trip = agents.trip.get(i).and_then(Option::as_ref);
    match trip.map(|trip| trip.status) {
        Some(Status::Waiting { .. }) => ("waiting", [200, 130, 0]),
        Some(Status::Queued { .. }) => ("in a queue", [170, 80, 140]),
        Some(Status::Finished) => ("has ended its journey", FAINT),
        Some(Status::Walking) | None => ("walking", WALKING),
    }
}

/// The agents.
pub fn agents(simulation: &Simulation, faint: bool) -> Option<Mark> {
    let agents = simulation.frame().agents;
    let disc = |i: usize| Disc {
        center: xy(agents.position[i]),
        radius: agents.radius[i],
        color: match faint {
            true => FAINT,
            false => doing(simulation, i).1,
        },
    };
    let discs: Vec<Disc> = (0..agents.len()).map(disc).collect();
    (!discs.is_empty()).then_some(Mark::Discs(discs))
}

/// The time, and how many agents and places there are.
pub fn summary(simulation: &Simulation) -> String {
    let frame = simulation.frame();
    let count = frame.agents.len();
    format!(
        "{:.2} s, {count} agent{}",
        frame.clock.time(),
        if count == 1 { "" } else { "s" }
    )
}

/// An entry of the legend.
pub struct Entry {
    pub text: String,
    look: Look,
}

enum Look {
    Agent(Rgb),
    Dot(Rgb),
    Line(Style),
}

impl Entry {
    /// Its sample, which begins at a place.
    pub fn sample(&self, [x, y]: [f64; 2], frame: &Frame) -> Vec<Mark> {
        let at = |points: f64| [x + frame.meters(points), y];
        match &self.look {
            Look::Agent(color) => vec![Mark::dots([at(8.0)], Style::full(*color, 3.0, ""))],
            Look::Dot(color) => vec![Mark::dots([at(8.0)], Style::full(*color, 1.7, ""))],
            Look::Line(style) => vec![Mark::Line(vec![at(0.0), at(11.0)], style.clone())],
        }
    }
}

/// The entries of the legend.
pub fn legend(simulation: &Simulation, has_paths: bool) -> Vec<Entry> {
    let entry = |text: &str, look| Entry {
        text: text.to_owned(),
        look,
    };
    if has_paths {
        return vec![
            entry("agent", Look::Agent(FAINT)),
            entry("shortest way", Look::Line(Style::full(BLACK, 0.9, ""))),
            entry(
                "border of cells with the same next corner",
                Look::Line(Style::full(BORDER, 0.6, "")),
            ),
            entry("corner", Look::Dot(BORDER)),
        ];
    }
    let agents = simulation.frame().agents;
    let mut shown = Vec::new();
    for i in 0..agents.len() {
        let seen = doing(simulation, i);
        if !shown.contains(&seen) {
            shown.push(seen);
        }
    }
    shown.sort_by_key(|(text, _)| std::cmp::Reverse(*text));
    if let [(_, color)] = shown[..]
        && simulation.scene().journeys.places.is_empty()
    {
        return vec![entry("agent", Look::Agent(color))];
    }
    shown
        .into_iter()
        .map(|(text, color)| entry(text, Look::Agent(color)))
        .collect()
}

/// A bar of this length, meters, that begins at a place.
pub fn scale_bar([x, y]: [f64; 2], length: f64, frame: &Frame) -> Vec<Mark> {
    let tick = frame.meters(2.5);
    let line = |ends: [[f64; 2]; 2]| Mark::Line(ends.to_vec(), Style::full(dark(BLACK), 1.2, ""));
    vec![
        line([[x, y], [x + length, y]]),
        line([[x, y - tick], [x, y + tick]]),
        line([[x + length, y - tick], [x + length, y + tick]]),
    ]
}
