//! Well-known text. The only file that names the wkt crate.

use std::str::FromStr;

use wkt::Wkt;
use wkt::types::{Coord, Dimension, LineString, MultiPolygon, Point, Polygon};

use super::error::FloorPlanError;
use super::kind::Kind;
use super::reading::Drawn;
use super::shape::{Form, Geometry};
use super::units::{Coordinates, of_system};
use engine::geometry::Area;
use engine::math::Vector;

/// Deepest nesting of parentheses: the parser recurses. Three levels suffice without collections.
const DEEPEST: usize = 64;

/// What `text` has: one or more geometries.
pub fn drawn(text: &str) -> Result<Drawn, FloorPlanError> {
    let pieces = pieces(text)?;
    let several = pieces.len() > 1;
    let mut drawn = Drawn::default();
    for (line, piece) in pieces {
        let piece = without_srid(piece, &mut drawn)?;
        let shapes = &mut drawn.shapes;
        let wkt = Wkt::<f64>::from_str(piece).map_err(|reason| FloorPlanError::Syntax {
            format: "WKT",
            reason: format!("line {line}: {reason}{}", formats(piece)),
        })?;
        let place = match several {
            true => format!("line {line}"),
            false => String::new(),
        };
        let first = shapes.len();
        geometry(&wkt).shapes(&place, Kind::Floor, shapes)?;
        for shape in &mut shapes[first..] {
            match shape.form {
                Form::Area => {}
                Form::Line => shape.kind = Kind::Wall,
                Form::Point => return Err(FloorPlanError::no_area(&shape.place, "POINT")),
            }
        }
    }
    Ok(drawn)
}

/// What is probably wrong in a piece that cannot be read: numbers and points that are separated in another way, or
/// another format of plans.
fn formats(piece: &str) -> &'static str {
    let found = piece.split(|c: char| !c.is_ascii_alphabetic()).next();
    let word = found.unwrap_or_default().to_ascii_uppercase();
    match ["POLYGON", "POINT", "LINE", "GEOMETRYCOLLECTION"]
        .iter()
        .any(|name| word.contains(name))
    {
        true if piece.contains(';') => {
            "; a comma separates two points, not a semicolon: (0 0, 12 0, …)"
        }
        true if has_single_numbers(piece) => {
            "; a space separates x and y, a comma two points, and decimals have points: (0.5 0, 12 0, …)"
        }
        true => "",
        false => "; plans are DXF, GeoJSON, WKT or JuPedSim's XML",
    }
}

/// Whether a number stands alone between two commas.
fn has_single_numbers(piece: &str) -> bool {
    let between = piece.split([',', '(', ')']).map(str::trim);
    let mut numbers = between.filter(|part| part.starts_with(|c: char| c.is_ascii_digit()));
    numbers.any(|part| !part.contains(char::is_whitespace))
}

/// Splits a text into its geometries, each with the line that it begins on, from 1.
fn pieces(text: &str) -> Result<Vec<(usize, &str)>, FloorPlanError> {
    let between = |c: char| c.is_whitespace() || c == ';';
    let (mut depth, mut found) = (0_usize, Vec::new());
    // The number of the current line, and where it begins.
    let (mut line, mut line_start) = (1, 0);
    // Line and offset where the current piece begins.
    let mut begun: Option<(usize, usize)> = None;
    for (at, c) in text.char_indices() {
        if begun.is_none() && !between(c) {
            begun = Some((line, at));
        }
        match c {
            '\n' => (line, line_start) = (line + 1, at + 1),
            '(' if depth == DEEPEST => {
                let column = 1 + text[line_start..at].chars().count();
                let reason = format!(
                    "line {line}, column {column}: more than {DEEPEST} parentheses are open"
                );
                return Err(FloorPlanError::Syntax {
                    format: "WKT",
                    reason,
                });
            }
            '(' => depth += 1,
            ')' => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    found.extend(begun.take().map(|(line, start)| (line, &text[start..=at])));
                }
            }
            _ => {}
        }
    }
    found.extend(begun.map(|(line, start)| (line, text[start..].trim_end_matches(between))));
    Ok(found)
}

/// Removes a prefix as in `SRID=25832;POLYGON …`, which PostGIS writes, and takes its unit.
fn without_srid<'a>(piece: &'a str, drawn: &mut Drawn) -> Result<&'a str, FloorPlanError> {
    let Some((srid, geometry)) = piece.split_once(';') else {
        return Ok(piece);
    };
    let code = srid.trim().to_ascii_uppercase();
    let Some(code) = code.strip_prefix("SRID=") else {
        return Ok(piece);
    };
    match of_system(code) {
        Coordinates::Degrees => return Err(FloorPlanError::Degrees(srid.trim().to_owned())),
        Coordinates::Other(unit, meters) => {
            drawn.unit = Some((format!("the unit of {}, the {unit},", srid.trim()), meters));
        }
        Coordinates::Meters | Coordinates::Unknown => {}
    }
    Ok(geometry.trim())
}

fn geometry(wkt: &Wkt<f64>) -> Geometry {
    let points = |line: &LineString<f64>| line.coords().iter().map(|c| [c.x, c.y]).collect();
    let area =
        |polygon: &Polygon<f64>| Geometry::Area(polygon.rings().iter().map(points).collect());
    let point = |point: &Point<f64>| {
        let coordinates = point.coord().map(|c| Geometry::Point([c.x, c.y]));
        coordinates.unwrap_or(Geometry::Line(Vec::new()))
    };
    let (kind, parts): (_, Vec<Geometry>) = match wkt {
        Wkt::Polygon(polygon) => return area(polygon),
        Wkt::LineString(line) => return Geometry::Line(points(line)),
        Wkt::Point(one) => return point(one),
        Wkt::MultiPolygon(several) => ("polygon", several.polygons().iter().map(area).collect()),
        Wkt::MultiLineString(several) => {
            let lines = several.line_strings().iter();
            (
                "line",
                lines.map(|line| Geometry::Line(points(line))).collect(),
            )
        }
        Wkt::MultiPoint(several) => ("point", several.points().iter().map(point).collect()),
        Wkt::GeometryCollection(collection) => (
            "geometry",
            collection.geometries().iter().map(geometry).collect(),
        ),
    };
    Geometry::Several(kind, parts)
}

/// Areas as a `POLYGON`, or as a `MULTIPOLYGON` unless there is exactly one; holes are clockwise.
pub fn to_wkt(areas: &[Area]) -> String {
    let ring = |points: &mut dyn Iterator<Item = &Vector>| {
        let coord = |p: &Vector| Coord {
            x: p.x,
            y: p.y,
            z: None,
            m: None,
        };
        let mut coords: Vec<Coord<f64>> = points.map(coord).collect();
        coords.extend(coords.first().cloned());
        LineString::new(coords, Dimension::XY)
    };
    let polygon = |area: &Area| {
        let mut rings = vec![ring(&mut area.exterior.points().iter())];
        let holes = area.holes.iter();
        rings.extend(holes.map(|hole| ring(&mut hole.points().iter().rev())));
        Polygon::new(rings, Dimension::XY)
    };
    let polygons: Vec<Polygon<f64>> = areas.iter().map(polygon).collect();
    match polygons.as_slice() {
        [polygon] => polygon.to_string(),
        _ => MultiPolygon::new(polygons, Dimension::XY).to_string(),
    }
}
