//! JuPedSim's former geometry format: XML with rooms, subrooms and obstacles. The only file that names roxmltree.
//!
//! The walls of a subroom are polygons, which are open where doors (transitions and crossings) are. Walls and doors
//! joined end to end are its outline. The walkable area is the union of all subrooms without their obstacles.

use roxmltree::{Document, Node, ParsingOptions};

use super::error::FloorPlanError;
use super::kind::Kind;
use super::shape::Shape;

/// The most nodes of a document.
const MOST_NODES: u32 = 10_000_000;
/// Ends of walls and doors this far apart meet, meters.
const GAP: f64 = 0.01;

/// A wall or door: an open path.
type Path = Vec<[f64; 2]>;

/// The polygons of `text`.
pub fn shapes(text: &str) -> Result<Vec<Shape>, FloorPlanError> {
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
    let mut shapes = Vec::new();
    for room in elements(root, "room") {
        for subroom in room.children().filter(|node| node.has_tag_name("subroom")) {
            let place = format!("room {}, subroom {}", id(room), id(subroom));
            let side = [id(room), id(subroom)];
            let doors_of_room = doors.iter().filter(|door| door.sides.contains(&side));
            let own: Vec<Path> = doors_of_room.map(|door| door.path.clone()).collect();
            let parts = subroom.children();
            let polygons = parts.filter(|node| node.has_tag_name("polygon"));
            let outlines = polygons.map(|wall| vertices(wall, &place, meters));
            let walls: Vec<Path> = outlines.collect::<Result<_, _>>()?;
            let rings = vec![outline(walls, own, &place)?];
            shapes.push(Shape {
                name: caption(room),
                ..Shape::new(place.clone(), rings, Kind::Floor)
            });
            for obstacle in elements(subroom, "obstacle") {
                for polygon in elements(obstacle, "polygon") {
                    let place = format!("{place}, obstacle {}", id(obstacle));
                    let rings = vec![vertices(polygon, &place, meters)?];
                    shapes.push(Shape {
                        name: caption(obstacle),
                        ..Shape::new(place, rings, Kind::Obstacle)
                    });
                }
            }
        }
    }
    let all = elements(root, "subroom").count();
    if shapes.is_empty() && all > 0 {
        let reason = format!("has {all} <subroom>, none of them directly in a <room>");
        return Err(wrong("geometry", reason));
    }
    Ok(shapes)
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
    path: Path,
    /// The room and the subroom on each side.
    sides: [[&'a str; 2]; 2],
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
            sides: [
                [room("room1_id"), value("subroom1_id")],
                [room("room2_id"), value("subroom2_id")],
            ],
        })
    };
    all.map(door).collect()
}

/// The outline of a subroom: walls joined end to end, and doors where no wall continues.
fn outline(walls: Vec<Path>, doors: Vec<Path>, place: &str) -> Result<Path, FloorPlanError> {
    let is_long = |path: &Path| path.len() > 1;
    let mut walls: Vec<Path> = walls.into_iter().filter(is_long).collect();
    let mut doors: Vec<Path> = doors.into_iter().filter(is_long).collect();
    if walls.is_empty() {
        let reason = "it has no walls; write <polygon> with <vertex px=\"…\" py=\"…\"/>";
        return Err(wrong(place, reason.to_owned()));
    }
    let mut outline = walls.remove(0);
    loop {
        let (first, last) = (outline[0], outline[outline.len() - 1]);
        if outline.len() > 2 && distance(first, last) <= GAP {
            break;
        }
        let found = next(&mut walls, last).or_else(|| next(&mut doors, last));
        let Some(path) = found else {
            break;
        };
        outline.extend(path.into_iter().skip(1));
    }
    if let Some(&[x, y]) = walls.first().and_then(|path| path.first()) {
        let [end_x, end_y] = outline[outline.len() - 1];
        let reason = format!(
            "the walls do not join: no wall or door leads from ({end_x}, {end_y}) to the wall that begins at ({x}, \
             {y}); close the gap, or write the outline as one polygon"
        );
        return Err(wrong(place, reason));
    }
    Ok(outline)
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
    (a[0] - b[0]).hypot(a[1] - b[1])
}
