//! Records → entities.

use std::f64::consts::TAU;

use super::curves::{Conic, Path, Piece, Vertex, to_after};
use super::hatch;
use super::letters::{Letters, plain};
use super::map::{Map, Point, cross, unit};
use super::pairs::Place;
use super::record::Record;
use super::spline::{self, Spline};
use super::syntax;
use crate::floor_plan::error::FloorPlanError;

/// What an entity is.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// A line or a closed line.
    Path(Path),
    /// An area between closed lines.
    Area(Vec<Path>),
    /// A point.
    Point(Point),
    /// A text.
    Text(Text),
    /// A block at a place.
    Insert(Box<Insert>),
    /// Something that is not read.
    Other,
    /// Something that is wrong.
    Wrong(FloorPlanError),
}

/// A text.
#[derive(Debug, Clone, PartialEq)]
pub struct Text {
    /// Where it is.
    pub at: Point,
    /// The height of its letters.
    pub height: f64,
    /// What it says.
    pub says: String,
}

/// A block at one or more places.
#[derive(Debug, Clone, PartialEq)]
pub struct Insert {
    /// The name of the block.
    pub block: String,
    /// Where its base point is.
    pub at: Point,
    /// The factors along its axes.
    pub scale: Point,
    /// Its turn, radians.
    pub turn: f64,
    /// The numbers of columns and rows.
    pub counts: [i64; 2],
    /// The distances between columns and between rows.
    pub distances: Point,
    /// Its name, from an attribute.
    pub name: Option<String>,
}

/// An entity.
#[derive(Debug, Clone, PartialEq)]
pub struct Entity {
    /// What the file calls it.
    pub kind: Box<str>,
    /// Where it begins in the file.
    pub at: Place,
    /// Its handle; may be empty.
    pub handle: Box<str>,
    /// The number of its layer.
    pub layer: usize,
    /// Where its coordinates lead.
    pub plane: Map,
    /// What it is.
    pub content: Content,
}

/// The text of a record, which may be divided.
fn text(record: &Record, letters: &Letters) -> String {
    let parts = record
        .pairs
        .iter()
        .filter(|pair| matches!(pair.code, 1 | 3));
    // The last part has code 1, all others code 3.
    let whole: String = parts.map(|pair| letters.text(pair.word())).collect();
    plain(&whole)
}

/// The content of a record that stands for itself.
pub fn content(record: &Record, letters: &Letters) -> Result<Content, FloorPlanError> {
    Ok(match record.kind.as_str() {
        "LINE" => Content::Path(Path::straight(
            [record.point(10)?, record.point(11)?],
            false,
        )),
        "LWPOLYLINE" => Content::Path(light_polyline(record)?),
        "CIRCLE" => {
            let arc = Conic::arc(record.point(10)?, radius(record)?, [0.0, TAU]);
            Content::Path(Path::conic(arc))
        }
        "ARC" => {
            let degrees = [record.number(50, 0.0)?, record.number(51, 360.0)?];
            let angles = degrees.map(f64::to_radians);
            let arc = Conic::arc(record.point(10)?, radius(record)?, angles);
            Content::Path(Path::conic(arc))
        }
        "ELLIPSE" => Content::Path(ellipse(record)?),
        "SPLINE" => Content::Path(spline(record)?),
        "POINT" => Content::Point(record.point(10)?),
        "HATCH" => Content::Area(hatch::boundaries(record)?),
        "SOLID" | "TRACE" => Content::Area(vec![quad(record, [10, 11, 13, 12])?]),
        "3DFACE" => Content::Area(vec![quad(record, [10, 11, 12, 13])?]),
        "TEXT" | "MTEXT" => {
            // Aligned texts have their place in the second point.
            let is_aligned = record.kind == "TEXT"
                && (record.whole(72, 0)? != 0 || record.whole(73, 0)? != 0)
                && record.find(11).is_some();
            Content::Text(Text {
                at: record.point(if is_aligned { 11 } else { 10 })?,
                height: record.number(40, 0.0)?,
                says: text(record, letters),
            })
        }
        "INSERT" => Content::Insert(Box::new(insert(record, letters)?)),
        _ => Content::Other,
    })
}

/// Where the coordinates of a record lead: those of some kinds are in the plane of the extrusion direction.
pub fn plane(record: &Record) -> Result<Map, FloorPlanError> {
    let height = match record.kind.as_str() {
        "LWPOLYLINE" => record.number(38, 0.0)?,
        "POLYLINE" if record.whole(70, 0)? & 8 != 0 => return Ok(Map::SAME),
        "ARC" | "CIRCLE" | "POLYLINE" | "TEXT" | "INSERT" | "SOLID" | "TRACE" | "HATCH" => {
            record.number(30, 0.0)?
        }
        _ => return Ok(Map::SAME),
    };
    match record.find(210) {
        Some(_) => Ok(Map::plane(record.space(210)?, height)),
        None => Ok(Map::SAME),
    }
}

/// A radius; 0 gives a point, which is left out later.
fn radius(record: &Record) -> Result<f64, FloorPlanError> {
    Ok(record.number(40, 0.0)?.abs())
}

fn light_polyline(record: &Record) -> Result<Path, FloorPlanError> {
    let mut vertices: Vec<Vertex> = record
        .points(10)?
        .into_iter()
        .map(Vertex::straight)
        .collect();
    let mut count = 0;
    for pair in &record.pairs {
        match pair.code {
            10 => count += 1,
            42 if (1..=vertices.len()).contains(&count) => {
                vertices[count - 1].bulge = pair.number()?
            }
            _ => {}
        }
    }
    Ok(Path {
        pieces: vec![Piece::Chain(vertices)],
        is_closed: record.whole(70, 0)? & 1 != 0,
    })
}

/// The content of a POLYLINE with its vertices.
pub fn polyline(record: &Record, vertices: &[Record]) -> Result<Content, FloorPlanError> {
    let flags = record.whole(70, 0)?;
    // Meshes.
    if flags & (16 | 64) != 0 {
        return Ok(Content::Other);
    }
    let mut chain = Vec::new();
    for vertex in vertices {
        // The control points of a spline that was fitted to them.
        let is_control = vertex.whole(70, 0)? & 16 != 0;
        if !is_control {
            chain.push(Vertex {
                at: vertex.point(10)?,
                bulge: vertex.number(42, 0.0)?,
            });
        }
    }
    Ok(Content::Path(Path {
        pieces: vec![Piece::Chain(chain)],
        is_closed: flags & 1 != 0,
    }))
}

fn ellipse(record: &Record) -> Result<Path, FloorPlanError> {
    let major = record.space(11)?;
    let normal = match record.find(210) {
        Some(_) => unit(record.space(210)?).unwrap_or([0.0, 0.0, 1.0]),
        None => [0.0, 0.0, 1.0],
    };
    let ratio = record.number(40, 1.0)?;
    let minor = cross(normal, major).map(|x| ratio * x);
    let [from, to] = [record.number(41, 0.0)?, record.number(42, TAU)?];
    Ok(Path::conic(Conic {
        center: record.point(10)?,
        major: [major[0], major[1]],
        minor: [minor[0], minor[1]],
        from,
        to: to_after(from, to),
    }))
}

fn spline(record: &Record) -> Result<Path, FloorPlanError> {
    let controls = record.points(10)?;
    let is_closed = record.whole(70, 0)? & 1 != 0;
    if controls.is_empty() {
        let points = spline::through(&record.points(11)?);
        return Ok(Path::straight(points, is_closed));
    }
    let degree = usize::try_from(record.whole(71, 3)?).unwrap_or_default();
    let [knots, weights] = [record.numbers(40)?, record.numbers(41)?];
    let spline = Spline::new(degree, knots, &controls, &weights)
        .map_err(|reason| syntax(format!("{}: the SPLINE {reason}", record.at)))?;
    Ok(Path {
        pieces: vec![Piece::Spline(spline)],
        is_closed,
    })
}

/// The quadrilateral, or triangle, through the points with these codes in this order.
fn quad(record: &Record, codes: [i32; 4]) -> Result<Path, FloorPlanError> {
    let given = codes
        .into_iter()
        .filter(|&code| record.find(code).is_some());
    let points: Result<Vec<Point>, _> = given.map(|code| record.point(code)).collect();
    Ok(Path::straight(points?, true))
}

fn insert(record: &Record, letters: &Letters) -> Result<Insert, FloorPlanError> {
    let counts = [record.whole(70, 1)?, record.whole(71, 1)?];
    Ok(Insert {
        block: letters.text(record.word(2)).to_lowercase(),
        at: record.point(10)?,
        scale: [record.number(41, 1.0)?, record.number(42, 1.0)?],
        turn: record.number(50, 0.0)?.to_radians(),
        counts: counts.map(|count| count.max(1)),
        distances: [record.number(44, 0.0)?, record.number(45, 0.0)?],
        name: None,
    })
}

/// The name that the attributes of a block give it: that of the tag NAME, else the first with a letter.
pub fn name(attributes: &[Record], letters: &Letters) -> Option<String> {
    let said = attributes.iter().map(|record| {
        let tag = letters.text(record.word(2)).to_uppercase();
        (tag, text(record, letters))
    });
    let named: Vec<(String, String)> = said.filter(|(_, name)| is_name(name)).collect();
    let best = named.iter().find(|(tag, _)| tag.contains("NAME"));
    best.or(named.first()).map(|(_, name)| name.clone())
}

/// Whether a text can be a name: it has letters, and is not long, a length in feet and inches, or a parameter.
pub fn is_name(text: &str) -> bool {
    let length = text.chars().count();
    let pairs = text.chars().zip(text.chars().skip(1));
    let is_in_feet = text.contains('"')
        || pairs
            .into_iter()
            .any(|(a, b)| a.is_ascii_digit() && b == '\'');
    text.chars().any(char::is_alphabetic) && length <= 60 && !text.contains('=') && !is_in_feet
}
