//! Where the floor is divided into rooms: narrow places and doors.

use std::sync::Arc;

use crate::geometry::Area;
use crate::levels::Levels;
use crate::math::{Vector, direction};
use crate::routes::WayError;
use crate::routes::floor::{
    Floor, Joins, Mesh, Narrow, Sheets, meets_join, narrow, side, to_segment,
};

/// Of two passages whose middles are nearer than this part of the width of the narrower one, such as the two sides of a
/// wall with a door, only the narrower one is an opening.
const APART: f64 = 0.45;
/// The most openings; wider ones are left out.
const MOST_OPENINGS: usize = 500;
/// Passages are too narrow for routes if they are narrower than the least width by more than this, meters.
const EXACT: f64 = 1e-6;
/// Doors reach this far into the walls at their ends, so that rounding leaves no gap, meters.
const INTO_WALLS: f64 = 0.01;
/// A side of a triangle this near to a passage is a part of it, meters.
const SAME: f64 = 1e-5;

/// A door of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Door {
    /// Its ends, meters.
    pub line: [Vector; 2],
    /// The number of its place.
    pub place: u16,
    /// Whether people pass it only from the left to the right of its line.
    pub one_way: bool,
}

/// A closed side of triangles, as it is found: the cut that it belongs to, its ends and the triangles beside it.
pub struct Closed {
    pub cut: usize,
    pub ends: [Vector; 2],
    pub beside: [u32; 2],
}

/// Passages and doors that divide a floor.
#[derive(Clone)]
pub struct Cuts {
    /// The passages that are too narrow for routes come first.
    passages: Vec<Narrow>,
    pub too_narrow: usize,
    /// Their ends, meters, then those of doors.
    lines: Vec<[Vector; 2]>,
    doors: Vec<Door>,
    /// Narrower joins are closed, meters.
    least_width: f64,
}

impl Cuts {
    /// The passages up to `widest` meters and the doors of a floor with this triangulation. Joins of `levels` are
    /// openings themselves.
    pub fn of(
        mesh: &Mesh,
        [least_width, widest]: [f64; 2],
        doors: &[Door],
        levels: Option<&Arc<Levels>>,
    ) -> Self {
        let width = |[a, b]: &[Vector; 2]| (b - a).norm();
        let mut found: Vec<(Narrow, [Vector; 2])> = narrow(mesh, widest.max(least_width))
            .into_iter()
            .map(|passage| (passage, passage.ends(mesh)))
            .filter(|(_, ends)| !levels.is_some_and(|levels| meets_join(*ends, levels)))
            .collect();
        found.sort_by(|a, b| width(&a.1).total_cmp(&width(&b.1)));
        let is_narrow = |line: &[Vector; 2]| width(line) < least_width - EXACT;
        let too_narrow = found.iter().filter(|(_, line)| is_narrow(line)).count();
        let long = doors.iter().map(|door| {
            let [a, b] = door.line;
            let more = direction(b - a) * INTO_WALLS;
            [a - more, b + more]
        });
        let long: Vec<[Vector; 2]> = long.collect();
        let mut kept: Vec<(Narrow, [Vector; 2])> = Vec::new();
        for (k, one) in found.into_iter().enumerate() {
            let is_near = |other: &(Narrow, [Vector; 2])| {
                let middle = |[a, b]: [Vector; 2]| 0.5 * (a + b);
                (middle(one.1) - middle(other.1)).norm() < APART * width(&other.1)
            };
            let is_free = || {
                kept.len() < too_narrow + MOST_OPENINGS
                    && !kept[too_narrow..].iter().any(is_near)
                    && !long
                        .iter()
                        .any(|&door| meet(door, one.1) || is_near(&(one.0, door)))
            };
            if k < too_narrow || is_free() {
                kept.push(one);
            }
        }
        let (passages, lines): (Vec<Narrow>, Vec<_>) = kept.into_iter().unzip();
        Self {
            passages,
            too_narrow,
            lines: lines.into_iter().chain(long).collect(),
            doors: doors.to_vec(),
            least_width,
        }
    }

    /// The door with the number of this cut.
    pub fn door(&self, cut: usize) -> Option<&Door> {
        self.doors.get(cut.checked_sub(self.passages.len())?)
    }

    /// The triangulation that they divide; of several levels with that in the plane.
    pub fn mesh(
        &self,
        areas: &[Area],
        levels: Option<&Arc<Levels>>,
    ) -> Result<(Mesh, Option<Sheets>), WayError> {
        let doors = &self.lines[self.passages.len()..];
        match levels {
            None => Ok((Mesh::divided(areas, &self.passages, doors)?, None)),
            Some(levels) => {
                let closed = (&self.passages[..], doors);
                let (mesh, sheets) =
                    Mesh::glued_with(areas, closed, levels.clone(), Joins::Closed)?;
                Ok((mesh, Some(sheets)))
            }
        }
    }

    /// The closed sides of a floor at their places in the building, those of joins with numbers behind all others.
    pub fn sides_of(&self, floor: &Floor) -> Vec<Closed> {
        let Some(sheets) = floor.sheets() else {
            return self.sides(&floor.mesh);
        };
        let mut sides = self.sides(&sheets.mesh);
        for side in &mut sides {
            let way = sheets.in_plane(side.beside[0], Vector::zeros());
            side.ends = side.ends.map(|p| p - way);
        }
        let joins = floor.mesh.closed_sides().filter_map(|(ends, mut beside)| {
            // Of both directions, one number.
            beside.sort_by_key(|&t| sheets.level[t as usize]);
            let join = sheets.join_between(beside, ends)?;
            let [a, b] = sheets.levels.joins()[join].line;
            if (b - a).norm() < self.least_width - EXACT {
                return None;
            }
            let cut = self.lines.len() + join;
            Some(Closed { cut, ends, beside })
        });
        sides.extend(joins);
        sides
    }

    /// The closed sides of a triangulation.
    pub fn sides(&self, mesh: &Mesh) -> Vec<Closed> {
        let of_cut = |(ends, beside): ([Vector; 2], [u32; 2])| {
            let is_near =
                |&end: &Vector, line: &[Vector; 2]| to_segment(end, line[0], line[1]) < SAME;
            let is_on = |line: &[Vector; 2]| ends.iter().all(|end| is_near(end, line));
            let cut = self.lines.iter().position(is_on)?;
            Some(Closed { cut, ends, beside })
        };
        mesh.closed_sides().filter_map(of_cut).collect()
    }

    /// Keeps only those cuts that lie between two rooms.
    pub fn keep_separating(&mut self, sides: &[Closed], room: &[u32]) {
        let mut separates = vec![false; self.lines.len()];
        separates[..self.too_narrow].fill(true);
        for side in sides {
            let [a, b] = side.beside.map(|t| room[t as usize]);
            separates[side.cut] |= a != b;
        }
        separates[self.passages.len()..].fill(true);
        let mut kept = separates.iter();
        self.lines.retain(|_| *kept.next().unwrap_or(&true));
        let mut kept = separates.iter();
        self.passages.retain(|_| *kept.next().unwrap_or(&true));
    }
}

/// Whether two segments cross or touch.
fn meet([a, b]: [Vector; 2], [c, d]: [Vector; 2]) -> bool {
    let apart = |a, b, p, q| {
        let [p, q] = [p, q].map(|p| side(a, b, p));
        (p > 0.0 && q > 0.0) || (p < 0.0 && q < 0.0)
    };
    !apart(a, b, c, d) && !apart(c, d, a, b)
}
