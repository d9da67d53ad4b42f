//! JuPedSim's former geometry format: XML with rooms, subrooms and obstacles. The only file that names roxmltree.
//!
//! The walls of a subroom are polygons, which are open where doors (transitions and crossings) are. Walls and doors
//! joined end to end are its outline. The walkable area is the union of all subrooms without their obstacles. The wall
//! between two rooms is written for each of them, as a line: where both sides are floor it stays a wall.

mod levels;
mod storeys;

use libm::hypot;
use roxmltree::{Document, Node, ParsingOptions};

use super::error::FloorPlanError;
use super::kind::Kind;
use super::reading::{Drawn, Reading};
use super::shape::Shape;
use super::thin::encloses_nothing;
use engine::math::{Vector, sides};
pub use levels::levels;
use storeys::Room;

/// The most nodes of a document.
const MOST_NODES: u32 = 10_000_000;
/// Ends of walls and doors this far apart meet, meters.
const GAP: f64 = 0.01;

/// The number of the room on the other side of doors that lead outside.
const OUTSIDE: &str = "-1";

/// A wall or door: an open path.
type Path = Vec<[f64; 2]>;

/// The rooms, obstacles, walls and doors of `text`.
pub fn drawn(text: &str, reading: &Reading) -> Result<Drawn, FloorPlanError> {
    read(text, |mut site| {
        let rooms = storeys::choose(site.rooms, reading, &mut site.drawn)?;
        let is_there = |door: &Door| {
            rooms
                .iter()
                .any(|room| door.sides.iter().any(|side| room.side == *side))
        };
        let kept = site.doors.into_iter().filter(is_there);
        site.drawn.shapes.extend(kept.map(Door::shape));
        Ok(site.drawn)
    })
}

/// What a file has.
struct Site<'a> {
    /// The shapes of all rooms.
    drawn: Drawn,
    rooms: Vec<Room>,
    doors: Vec<Door<'a>>,
    /// The unit of its coordinates, meters.
    meters: f64,
}

/// Reads `text`, and applies `take` to what it has.
fn read<T>(
    text: &str,
    take: impl FnOnce(Site) -> Result<T, FloorPlanError>,
) -> Result<T, FloorPlanError> {
    let options = ParsingOptions {
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(text, options).map_err(|error| syntax(&error))?;
    let root = document.root_element();
    if !root.has_tag_name("geometry") {
        let found = format!(
            "its first element is <{}>; JuPedSim's geometry begins with <geometry>",
            root.tag_name().name()
        );
        return Err(syntax(&found));
    }
    let meters = unit(root)?;
    let doors = doors(root, meters)?;
    let mut drawn = Drawn::default();
    let mut rooms = Vec::new();
    for room in elements(root, "room") {
        for subroom in room.children().filter(|node| node.has_tag_name("subroom")) {
            let first = drawn.shapes.len();
            subroom_of(room, subroom, &doors, meters, &mut drawn.shapes)?;
            let shapes = first..drawn.shapes.len();
            rooms.push(Room::of(room, subroom, shapes));
        }
    }
    let all = elements(root, "subroom").count();
    if drawn.shapes.is_empty() && all > 0 {
        let reason = format!("has {all} <subroom>, none of them directly in a <room>");
        return Err(wrong("geometry", reason));
    }
    take(Site {
        drawn,
        rooms,
        doors,
        meters,
    })
}

/// Adds the floor, the walls and the obstacles of a subroom.
fn subroom_of(
    room: Node,
    subroom: Node,
    doors: &[Door],
    meters: f64,
    shapes: &mut Vec<Shape>,
) -> Result<(), FloorPlanError> {
    let place = format!("room {}, subroom {}", id(room), id(subroom));
    let side = [id(room), id(subroom)];
    let doors_of_room = doors.iter().filter(|door| door.sides.contains(&side));
    let own: Vec<Path> = doors_of_room.map(|door| door.path.clone()).collect();
    let parts = subroom.children();
    let polygons = parts.filter(|node| node.has_tag_name("polygon"));
    let outlines = polygons.map(|wall| vertices(wall, &place, meters));
    let walls: Vec<Path> = outlines.collect::<Result<_, _>>()?;
    let rings = vec![outline(&walls, &own, &place)?];
    shapes.push(Shape {
        name: caption(room),
        ..Shape::new(place.clone(), rings, Kind::Floor)
    });
    let lines = walls.into_iter();
    shapes.extend(lines.map(|wall| Shape::line(format!("{place}, wall"), wall, Kind::Wall)));
    for obstacle in elements(subroom, "obstacle") {
        for polygon in elements(obstacle, "polygon") {
            let place = format!("{place}, obstacle {}", id(obstacle));
            let points = vertices(polygon, &place, meters)?;
            let is_screen = encloses_nothing(&points);
            let shape = match is_screen {
                true => Shape::line(place, points, Kind::Wall),
                false => Shape::new(place, vec![points], Kind::Obstacle),
            };
            shapes.push(Shape {
                name: caption(obstacle).filter(|_| !is_screen),
                ..shape
            });
        }
    }
    Ok(())
}

fn syntax(error: &impl ToString) -> FloorPlanError {
    FloorPlanError::Syntax {
        format: "XML of JuPedSim",
        reason: error.to_string(),
    }
}

fn wrong(place: &str, reason: String) -> FloorPlanError {
    FloorPlanError::Geometry {
        place: place.to_owned(),
        reason,
    }
}

/// The unit of the coordinates, meters.
fn unit(root: Node) -> Result<f64, FloorPlanError> {
    match root.attribute("unit").unwrap_or("m") {
        "m" => Ok(1.0),
        "cm" => Ok(0.01),
        other => Err(wrong(
            "geometry",
            format!("the unit is \"{other}\"; write unit=\"m\" or unit=\"cm\""),
        )),
    }
}

/// The elements called `name` within another one.
fn elements<'a>(node: Node<'a, 'a>, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    node.descendants()
        .filter(move |node| node.has_tag_name(name))
}

/// The id of an element, for messages and doors.
fn id<'a>(node: Node<'a, 'a>) -> &'a str {
    node.attribute("id").unwrap_or("?").trim()
}

/// The caption of an element; JuPedSim's editor gives those without one the name of their kind.
fn caption(node: Node) -> Option<String> {
    let caption = node.attribute("caption")?.trim();
    let is_own = !caption.is_empty() && caption != node.tag_name().name();
    is_own.then(|| caption.to_owned())
}

/// The vertices of an element, meters.
fn vertices(node: Node, place: &str, meters: f64) -> Result<Path, FloorPlanError> {
    let vertices = node.children().filter(|child| child.has_tag_name("vertex"));
    let point = |(k, vertex): (usize, Node)| {
        let coordinate = |name: &str| {
            let text = vertex.attribute(name).unwrap_or_default();
            let number = text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
            number.map(|x| x * meters).ok_or_else(|| {
                let reason = format!("vertex {} has no number {name}; write px and py", k + 1);
                wrong(place, reason)
            })
        };
        Ok([coordinate("px")?, coordinate("py")?])
    };
    vertices.enumerate().map(point).collect()
}

/// A transition between rooms, or a crossing between subrooms.
struct Door<'a> {
    /// Its name in messages.
    place: String,
    /// Its caption, or its kind and number.
    name: String,
    path: Path,
    /// The room and the subroom on each side.
    sides: [[&'a str; 2]; 2],
}

impl Door<'_> {
    /// It as a line: an exit if one side of it is outside.
    fn shape(self) -> Shape {
        let is_exit = self.sides.iter().any(|[room, _]| *room == OUTSIDE);
        let kind = if is_exit { Kind::Exit } else { Kind::Door };
        Shape {
            name: Some(self.name),
            ..Shape::line(self.place, self.path, kind)
        }
    }
}

fn doors<'a>(root: Node<'a, 'a>, meters: f64) -> Result<Vec<Door<'a>>, FloorPlanError> {
    let all = elements(root, "transition").chain(elements(root, "crossing"));
    let door = |node: Node<'a, 'a>| {
        let value = |name: &str| node.attribute(name).unwrap_or_default().trim();
        let place = format!("{} {}", node.tag_name().name(), id(node));
        let around = node.ancestors().find(|node| node.has_tag_name("room"));
        // Crossings are inside of a room.
        let room = |name: &str| match (value(name), value("room_id"), around) {
            ("", "", Some(room)) => id(room),
            ("", room, _) => room,
            (room, ..) => room,
        };
        Ok(Door {
            path: vertices(node, &place, meters)?,
            name: caption(node).unwrap_or_else(|| place.clone()),
            place,
            sides: [
                [room("room1_id"), value("subroom1_id")],
                [room("room2_id"), value("subroom2_id")],
            ],
        })
    };
    all.map(door).collect()
}

/// The outline of a subroom: walls joined end to end, and doors where no wall continues. Walls that do not join stand
/// within the outline if that is closed.
fn outline(walls: &[Path], doors: &[Path], place: &str) -> Result<Path, FloorPlanError> {
    let is_long = |path: &&Path| path.len() > 1;
    let walls: Vec<Path> = walls.iter().filter(is_long).cloned().collect();
    let doors: Vec<Path> = doors.iter().filter(is_long).cloned().collect();
    if walls.is_empty() {
        let reason = "it has no walls; write <polygon> with <vertex px=\"…\" py=\"…\"/>";
        return Err(wrong(place, reason.to_owned()));
    }
    let (outline, left) = joined(walls, doors.clone());
    let Some(&[x, y]) = left.first().and_then(|path| path.first()) else {
        return Ok(outline);
    };
    let mut found = vec![outline];
    let mut left = left;
    while !left.is_empty() {
        let (next, others) = joined(left, doors.clone());
        found.push(next);
        left = others;
    }
    let closed = found.iter().filter(|path| is_closed(path));
    let largest = closed.max_by(|a, b| enclosed(a).total_cmp(&enclosed(b)));
    largest.cloned().ok_or_else(|| {
        let [end_x, end_y] = found[0][found[0].len() - 1];
        let reason = format!(
            "the walls do not join: no wall or door leads from ({end_x}, {end_y}) to the wall that begins at ({x}, \
             {y}); close the gap, or write the outline as one polygon"
        );
        wrong(place, reason)
    })
}

/// Whether a path ends where it begins.
fn is_closed(path: &Path) -> bool {
    path.len() > 2 && distance(path[0], path[path.len() - 1]) <= GAP
}

/// The area that a path encloses, m².
fn enclosed(path: &Path) -> f64 {
    let points: Vec<Vector> = path.iter().map(|&p| p.into()).collect();
    let turned = sides(&points).map(|(a, b)| (a - points[0]).perp(&(b - points[0])));
    0.5 * turned.sum::<f64>().abs()
}

/// The first wall with the walls that go on from its end, and doors where no wall does, until it is closed; and the
/// walls that are left.
fn joined(mut walls: Vec<Path>, mut doors: Vec<Path>) -> (Path, Vec<Path>) {
    let mut outline = walls.remove(0);
    while !is_closed(&outline) {
        let last = outline[outline.len() - 1];
        let found = next(&mut walls, last).or_else(|| next(&mut doors, last));
        let Some(path) = found else {
            break;
        };
        outline.extend(path.into_iter().skip(1));
    }
    (outline, walls)
}

/// Takes the path that begins or ends at a point, in the direction away from it.
fn next(paths: &mut Vec<Path>, from: [f64; 2]) -> Option<Path> {
    let is_near = |end: Option<&[f64; 2]>| end.is_some_and(|&end| distance(end, from) <= GAP);
    let mut ends = paths.iter();
    let k = ends.position(|path| is_near(path.first()) || is_near(path.last()))?;
    let mut path = paths.remove(k);
    if !is_near(path.first()) {
        path.reverse();
    }
    Some(path)
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    hypot(a[0] - b[0], a[1] - b[1])
}
