//! The boundaries of hatches.

use super::curves::{Conic, Path, Piece, Vertex, to_after};
use super::map::Point;
use super::pairs::Pair;
use super::record::Record;
use super::spline::Spline;
use super::syntax;
use crate::floor_plan::error::FloorPlanError;
use libm::{atan2, sincos};

/// The flag of a boundary that is a polyline.
const POLYLINE: i64 = 2;

/// The pairs of a hatch, in order.
struct Reader<'a, 'b> {
    hatch: &'b Record<'a>,
    rest: &'b [Pair<'a>],
}

impl<'a> Reader<'a, '_> {
    /// The next pair, which must have this code.
    fn expect(&mut self, code: i32) -> Result<Pair<'a>, FloorPlanError> {
        match self.rest.split_first() {
            Some((pair, rest)) if pair.code == code => {
                self.rest = rest;
                Ok(*pair)
            }
            found => {
                let at = found.map_or(self.hatch.at, |(pair, _)| pair.at);
                Err(syntax(format!(
                    "{at}: the boundary of the HATCH at {} lacks group code {code}; save the drawing again",
                    self.hatch.at
                )))
            }
        }
    }

    fn number(&mut self, code: i32) -> Result<f64, FloorPlanError> {
        self.expect(code)?.number()
    }

    fn whole(&mut self, code: i32) -> Result<i64, FloorPlanError> {
        self.expect(code)?.whole()
    }

    /// A number of things that follow, each of at least one pair.
    fn count(&mut self, code: i32) -> Result<usize, FloorPlanError> {
        let pair = self.expect(code)?;
        let count = usize::try_from(pair.whole()?).ok();
        count.filter(|&count| count <= self.rest.len()).ok_or_else(|| {
            syntax(format!(
                "{}: the HATCH at {} is shorter than group code {code} says; save the drawing again",
                pair.at, self.hatch.at
            ))
        })
    }

    fn is_next(&self, code: i32) -> bool {
        self.rest.first().is_some_and(|pair| pair.code == code)
    }

    /// The number with this code, if it comes next.
    fn next_number(&mut self, code: i32, default: f64) -> Result<f64, FloorPlanError> {
        if self.is_next(code) {
            self.number(code)
        } else {
            Ok(default)
        }
    }

    fn point(&mut self, code: i32) -> Result<Point, FloorPlanError> {
        Ok([self.number(code)?, self.number(code + 10)?])
    }
}

/// The closed boundaries of a hatch.
pub fn boundaries(hatch: &Record) -> Result<Vec<Path>, FloorPlanError> {
    let start = hatch.pairs.iter().position(|pair| pair.code == 91);
    let rest = &hatch.pairs[start.unwrap_or(hatch.pairs.len())..];
    let mut reader = Reader { hatch, rest };
    if rest.is_empty() {
        return Ok(Vec::new());
    }
    let count = reader.count(91)?;
    (0..count).map(|_| boundary(&mut reader)).collect()
}

fn boundary(reader: &mut Reader) -> Result<Path, FloorPlanError> {
    let is_polyline = reader.whole(92)? & POLYLINE != 0;
    let pieces = if is_polyline {
        vec![polyline(reader)?]
    } else {
        let count = reader.count(93)?;
        let edges = (0..count).map(|_| edge(reader));
        edges.collect::<Result<_, _>>()?
    };
    // The handles of the entities from which the boundary was made.
    if reader.is_next(97) {
        for _ in 0..reader.count(97)? {
            reader.expect(330)?;
        }
    }
    Ok(Path {
        pieces,
        is_closed: true,
    })
}

fn polyline(reader: &mut Reader) -> Result<Piece, FloorPlanError> {
    reader.whole(72)?;
    reader.whole(73)?;
    let count = reader.count(93)?;
    let vertex = |_| {
        Ok(Vertex {
            at: reader.point(10)?,
            bulge: reader.next_number(42, 0.0)?,
        })
    };
    let vertices: Result<Vec<Vertex>, FloorPlanError> = (0..count).map(vertex).collect();
    Ok(Piece::Chain(vertices?))
}

fn edge(reader: &mut Reader) -> Result<Piece, FloorPlanError> {
    let kind = reader.expect(72)?;
    match kind.whole()? {
        1 => {
            let ends = [reader.point(10)?, reader.point(11)?];
            Ok(Piece::Chain(ends.map(Vertex::straight).to_vec()))
        }
        2 => {
            let center = reader.point(10)?;
            let radius = reader.number(40)?;
            let [from, to] = angles(reader)?.map(f64::to_radians);
            turned(Conic::arc(center, radius, [from, to]), reader)
        }
        3 => {
            let [center, major] = [reader.point(10)?, reader.point(11)?];
            let ratio = reader.number(40)?;
            // The angles are those of directions.
            let parameter = |angle: f64| {
                let (sine, cosine) = sincos(angle.to_radians());
                atan2(sine / ratio, cosine)
            };
            let [from, to] = angles(reader)?.map(parameter);
            let conic = Conic {
                center,
                major,
                minor: [-ratio * major[1], ratio * major[0]],
                from,
                to: to_after(from, to),
            };
            turned(conic, reader)
        }
        4 => spline(reader),
        other => Err(syntax(format!(
            "{}: the HATCH at {} has an edge of the kind {other}; it must be 1 to 4",
            kind.at, reader.hatch.at
        ))),
    }
}

fn angles(reader: &mut Reader) -> Result<[f64; 2], FloorPlanError> {
    Ok([reader.number(50)?, reader.number(51)?])
}

/// An arc in its direction: the angles of clockwise arcs count clockwise.
fn turned(arc: Conic, reader: &mut Reader) -> Result<Piece, FloorPlanError> {
    let is_clockwise = reader.whole(73)? == 0;
    let [from, to] = match is_clockwise {
        true => [-arc.from, -arc.to],
        false => [arc.from, arc.to],
    };
    Ok(Piece::Conic(Conic { from, to, ..arc }))
}

fn spline(reader: &mut Reader) -> Result<Piece, FloorPlanError> {
    let at = reader.rest.first().map_or(reader.hatch.at, |pair| pair.at);
    let degree = usize::try_from(reader.whole(94)?).unwrap_or_default();
    reader.whole(73)?;
    reader.whole(74)?;
    let [knots, controls] = [reader.count(95)?, reader.count(96)?];
    let knots: Result<Vec<f64>, _> = (0..knots).map(|_| reader.number(40)).collect();
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for _ in 0..controls {
        points.push(reader.point(10)?);
        weights.push(reader.next_number(42, 1.0)?);
    }
    // Older files do not have the points that the spline was drawn through. The pair 97 of the boundary itself is
    // followed by handles or by the next boundary.
    let is_of_spline =
        |pair: &[Pair]| pair[0].code == 97 && matches!(pair[1].code, 11 | 12 | 13 | 72 | 97);
    if reader.rest.windows(2).next().is_some_and(is_of_spline) {
        for _ in 0..reader.count(97)? {
            reader.point(11)?;
        }
        for code in [12, 13] {
            if reader.is_next(code) {
                reader.point(code)?;
            }
        }
    }
    let spline = Spline::new(degree, knots?, &points, &weights);
    spline.map(Piece::Spline).map_err(|reason| {
        syntax(format!(
            "{at}: a spline of the HATCH at {} {reason}",
            reader.hatch.at
        ))
    })
}
