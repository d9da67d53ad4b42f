//! Everything about a floor that does not depend on goals: triangles, corners, and what each corner sees.

mod corner;
mod edges;
mod expansion;
mod grid;
mod lines;
mod mesh;
mod narrow;
mod narrowings;
mod passage;
mod sheets;
mod triangulation;

pub use corner::{Bend, Corner, Turn};
pub use expansion::{Border, Eye, Sight, View, expand};
pub use lines::{nearest_on, part, side, to_segment};
pub use mesh::{Mesh, Triangle};
pub use narrow::{Narrow, narrow};
pub use narrowings::{Narrowing, Narrowings};
pub use passage::{Passage, Passages};
pub use sheets::{Joins, Sheets, meets_join};

use std::sync::Arc;

use rayon::prelude::*;

use super::WayError;
use crate::geometry::Area;
use crate::levels::Levels;
use crate::math::{Vector, bytes_of};
use grid::Grid;

/// A floor with its corners and the routes between them.
#[derive(Debug, Clone)]
pub struct Floor {
    /// The triangles; those of several levels at their places in the building.
    pub mesh: Mesh,
    /// The triangles of several levels in the plane.
    sheets: Option<Sheets>,
    /// Cells over the triangles in the plane.
    pub grid: Grid,
    /// The corners that shortest routes bend around.
    pub corners: Vec<Corner>,
    /// The places of the corners again, contiguous in memory, meters.
    places: Vec<Vector>,
    /// For each corner of each triangle, the number of the [`Corner`] there and the index of the triangle in its fan.
    pub at: Vec<[Option<(u32, u32)>; 3]>,
    /// The straight routes to bend b come from the bends with the numbers `routes[starts[b]..starts[b + 1]]`.
    routes: Vec<u32>,
    starts: Vec<u32>,
}

/// A search walks over at most this many triangles before it uses the grid.
const STEPS: usize = 3;

/// A straight way between two corners, each with the turn there of routes that end at the other corner.
type StraightWay = [Bend; 2];

impl Floor {
    /// Prepares areas that share at most points; passages narrower than `least_width` meters are closed.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn new(areas: &[Area], least_width: f64) -> Result<Self, WayError> {
        Ok(Self::of(Mesh::new(areas, least_width)?, least_width))
    }

    /// Prepares the floors of some levels, which lie side by side in the plane and go on for a while behind their
    /// joins.
    ///
    /// # Errors
    /// As [`new`](Self::new), or the floors on both sides of a join differ along it.
    pub fn on_levels(
        areas: &[Area],
        least_width: f64,
        levels: Arc<Levels>,
    ) -> Result<Self, WayError> {
        let (mesh, sheets) = Mesh::glued(areas, least_width, levels)?;
        Ok(Self::prepared(mesh, Some(sheets), least_width))
    }

    /// Prepares a triangulation whose narrower passages are closed already.
    pub fn of(mesh: Mesh, least_width: f64) -> Self {
        Self::prepared(mesh, None, least_width)
    }

    /// Prepares triangles, of several levels with those in the plane, whose narrower passages are closed already.
    pub fn prepared(mesh: Mesh, sheets: Option<Sheets>, least_width: f64) -> Self {
        let corners = Corner::all(&mesh, least_width);
        let mut at = vec![[None; 3]; mesh.triangles().len()];
        for (c, corner) in corners.iter().enumerate() {
            for (i, &(t, k)) in corner.fan.iter().enumerate() {
                at[t as usize][k] = Some((c as u32, i as u32));
            }
        }
        let mut floor = Self {
            routes: Vec::new(),
            starts: vec![0],
            grid: Grid::over(sheets.as_ref().map_or(&mesh, |sheets| &sheets.mesh)),
            mesh,
            sheets,
            places: corners.iter().map(|corner| corner.place).collect(),
            corners,
            at,
        };
        floor.find_routes();
        floor
    }

    /// Finds the straight routes between all corners.
    fn find_routes(&mut self) {
        let all = (0..self.corners.len() as u32).into_par_iter();
        let found: Vec<Vec<StraightWay>> = all.map(|c| self.look_around(c)).collect();
        // A way that continues from a to b reached a from the other side.
        let before = |bend: Bend| Bend {
            turn: bend.turn.other(),
            ..bend
        };
        let both = |&[a, b]: &StraightWay| [[b, before(a)], [a, before(b)]];
        let routes = found.iter().flatten().flat_map(both);
        let mut routes: Vec<[u32; 2]> = routes.map(|way| way.map(|b| b.index() as u32)).collect();
        drop(found);
        routes.sort_unstable();
        routes.dedup();
        for bend in 0..2 * self.corners.len() as u32 {
            let before = routes.partition_point(|&[to, _]| to <= bend);
            self.starts.push(before as u32);
        }
        self.routes = routes.into_iter().map(|[_, from]| from).collect();
    }

    /// The bends from which a straight way leads to `bend` and can bend there.
    pub fn before(&self, bend: usize) -> impl Iterator<Item = usize> {
        let [from, to] = [bend, bend + 1].map(|b| self.starts[b] as usize);
        self.routes[from..to].iter().map(|&before| before as usize)
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        let corners = self.corners.iter().map(Corner::bytes).sum::<usize>();
        let lists = bytes_of(&self.routes) + bytes_of(&self.starts) + bytes_of(&self.places);
        let whole = |sheets: &Sheets| sheets.whole.as_ref().map_or(0, Mesh::bytes);
        let plane = |sheets: &Sheets| sheets.mesh.bytes() + whole(sheets);
        let plane = self.sheets.as_ref().map_or(0, plane);
        lists + bytes_of(&self.at) + self.grid.bytes() + self.mesh.bytes() + plane + corners
    }

    /// The number of borders that do not belong to a path map: the points of the mesh, and a ray for each bend.
    pub fn borders(&self) -> usize {
        self.mesh.points().len() + 2 * self.corners.len()
    }

    /// A point on border `number`, meters.
    pub fn border(&self, number: u32) -> Vector {
        let points = self.mesh.points();
        match points.get(number as usize) {
            Some(&point) => point,
            None => {
                let bend = number as usize - points.len();
                self.corners[bend / 2].rays[bend % 2]
            }
        }
    }

    /// The place of a bend's corner, meters.
    #[inline]
    pub fn place(&self, bend: Bend) -> Vector {
        self.places[bend.corner as usize]
    }

    /// The triangles in the plane in which people are.
    pub fn plane(&self) -> &Mesh {
        self.sheets
            .as_ref()
            .map_or(&self.mesh, |sheets| &sheets.mesh)
    }

    /// The triangles in the plane, of several levels as their floors go on behind joins, but for those of rooms.
    pub fn whole(&self) -> &Mesh {
        let sheets = self.sheets.as_ref();
        let whole = sheets.and_then(|sheets| sheets.whole.as_ref());
        whole.unwrap_or_else(|| self.plane())
    }

    /// The place in the building of somebody at `p` in the plane, meters: of one level, `p` itself.
    #[inline]
    pub fn in_building(&self, p: Vector) -> Vector {
        let sheets = self.sheets.as_ref();
        sheets.map_or(p, |sheets| sheets.levels.in_building(p))
    }

    /// Where somebody at `p` in the plane sees a `point` of the building, meters.
    #[inline]
    pub fn seen_from(&self, p: Vector, point: Vector) -> Vector {
        match self.has_levels() {
            true => point + (p - self.in_building(p)),
            false => point,
        }
    }

    /// Where a point of triangle `t` in the building lies in the plane, meters.
    pub fn in_plane(&self, t: u32, p: Vector) -> Vector {
        let sheets = self.sheets.as_ref();
        sheets.map_or(p, |sheets| sheets.in_plane(t, p))
    }

    /// The triangles of several levels in the plane.
    pub fn sheets(&self) -> Option<&Sheets> {
        self.sheets.as_ref()
    }

    /// Whether two points in the plane lie on the same level.
    pub fn is_one_level(&self, p: Vector, other: Vector) -> bool {
        let sheets = self.sheets.as_ref();
        sheets.is_none_or(|sheets| sheets.levels.level(p) == sheets.levels.level(other))
    }

    /// Whether it has several levels.
    pub fn has_levels(&self) -> bool {
        self.sheets.is_some()
    }

    /// The triangles of the level at `p`, a point in the plane.
    pub fn triangles_at(&self, p: Vector) -> impl Iterator<Item = u32> + '_ {
        let level = self.sheets.as_ref().map(|sheets| sheets.levels.level(p));
        let all = 0..self.mesh.triangles().len() as u32;
        all.filter(move |&t| match (&self.sheets, level) {
            (Some(sheets), Some(level)) => sheets.level[t as usize] == level,
            _ => true,
        })
    }

    /// A triangle that contains `p`, a point in the plane; `None` outside of the floor.
    pub fn locate(&self, p: Vector) -> Option<u32> {
        let mut near = self.grid.triangles(p).iter().copied();
        near.find(|&t| self.plane().contains(t, p))
    }

    /// As [`locate`](Self::locate), but looks near triangle `before` first.
    pub fn locate_from(&self, before: u32, p: Vector) -> Option<u32> {
        let plane = self.plane();
        let mut here = before;
        for _ in 0..STEPS {
            let corners = plane.corners(here);
            let is_beyond = |&k: &usize| side(corners[k], corners[(k + 1) % 3], p) < 0.0;
            let Some(k) = (0..3).find(is_beyond) else {
                return Some(here);
            };
            let Some(next) = plane.triangle(here).across[k] else {
                break;
            };
            here = next;
        }
        self.locate(p)
    }

    /// The triangle that contains `p`, looked for near triangle `before` first, or the one nearest to `p` in a wall.
    pub fn locate_or_nearest(&self, before: Option<u32>, p: Vector) -> Option<u32> {
        let here = match before {
            Some(before) => self.locate_from(before, p),
            None => self.locate(p),
        };
        here.or_else(|| self.nearest(p))
    }

    /// The triangle nearest to a point in the plane, such as one in a wall.
    pub fn nearest(&self, p: Vector) -> Option<u32> {
        self.grid.nearest(self.plane(), p)
    }

    /// The straight routes from corner `c` to corners with higher numbers.
    fn look_around(&self, c: u32) -> Vec<StraightWay> {
        let (mesh, corner) = (&self.mesh, &self.corners[c as usize]);
        let mut routes = Vec::new();
        for i in 0..corner.fan.len() {
            self.see_neighbor(c, i, &mut routes);
        }
        for turn in Turn::BOTH {
            let bend = Bend { corner: c, turn };
            let see = |t: u32, k: usize, _: Vector| {
                if let Some((other, i)) = self.at[t as usize][k]
                    && other > c
                    && let away = &self.corners[other as usize]
                    && let Some(turn) = away.turn(mesh, i as usize, corner.place)
                {
                    let corner = other;
                    routes.push([bend, Bend { corner, turn }]);
                }
            };
            self.look_from(bend, |_, _| true, see);
        }
        routes
    }

    /// Expands the view of a bend. Calls `enter` for every triangle from which a way can go straight to `bend`, with
    /// the visible cone in it, and expands behind the triangle if that returns true. Calls `see` for every visible
    /// point of the mesh that lies opposite to the side through which the cone enters its triangle.
    pub fn look_from(
        &self,
        bend: Bend,
        mut enter: impl FnMut(u32, &View) -> bool,
        see: impl FnMut(u32, usize, Vector),
    ) {
        let (mesh, corner) = (&self.mesh, &self.corners[bend.corner as usize]);
        let mut sights = Vec::new();
        for (i, &(t, k)) in corner.fan.iter().enumerate() {
            let Some([right, left]) = corner.view(mesh, i, bend) else {
                continue;
            };
            let view = View {
                eye: Eye::Near(corner.place),
                right,
                left,
            };
            if enter(t, &view) {
                sights.extend(Sight::beyond(mesh, (t, (k + 1) % 3), view));
            }
        }
        let enter = |sight: &Sight| enter(sight.triangle, &sight.view);
        expand(mesh, sights, enter, see);
    }

    /// The visible cone of `bend` toward `p`, which lies in triangle `t`; `None` if no way goes straight from `p` to
    /// `bend`.
    pub fn sight(&self, p: Vector, t: u32, bend: Bend) -> Option<View> {
        let (mesh, corner) = (&self.mesh, &self.corners[bend.corner as usize]);
        let mut portals = Vec::new();
        let (mut here, mut entrance) = (t, None);
        let ahead = corner.place - p;
        // A straight line crosses each triangle at most once.
        for _ in 0..mesh.triangles().len() {
            let corners = self.at[here as usize];
            let at = |spot: &Option<(u32, u32)>| spot.filter(|&(c, _)| c == bend.corner);
            if let Some((_, i)) = corners.iter().find_map(at) {
                let i = i as usize;
                let [right, left] = corner.view(mesh, i, bend)?;
                let eye = Eye::Near(corner.place);
                let mut whole = Some(View { eye, right, left });
                for portal in portals {
                    whole = whole?.through(portal);
                }
                return whole.filter(|view| view.holds(p));
            }
            let is_left = |k: usize| ahead.perp(&(mesh.corners(here)[k] - p)) >= 0.0;
            let exit = match entrance {
                // The line leaves through the side from a corner on its right to a corner on its left.
                None => (0..3).find(|&k| !is_left(k) && is_left((k + 1) % 3))?,
                Some(side) => {
                    let (right, top) = ((side + 1) % 3, (side + 2) % 3);
                    if is_left(top) { right } else { top }
                }
            };
            // Seen from the corner, right and left are swapped.
            portals.push([mesh.border(here, (exit + 1) % 3), mesh.border(here, exit)]);
            let next = mesh.triangle(here).across[exit]?;
            entrance = Some(mesh.side_along(next, here));
            here = next;
        }
        None
    }

    /// Adds the routes along the sides of triangle `i` in the fan of corner `c`.
    fn see_neighbor(&self, c: u32, i: usize, found: &mut Vec<StraightWay>) {
        let corner = &self.corners[c as usize];
        let (t, k) = corner.fan[i];
        for (end, turn) in [(1, Turn::First), (2, Turn::Last)] {
            let end = (k + end) % 3;
            let Some((other, j)) = self.at[t as usize][end].filter(|(other, _)| *other > c) else {
                continue;
            };
            let (away, j) = (&self.corners[other as usize], j as usize);
            let [here, there] = [
                corner.turn(&self.mesh, i, away.place),
                away.turn(&self.mesh, j, corner.place),
            ];
            // The walls of the two corners lie on opposite sides of the way, or both on the side away from this
            // triangle.
            if let (Some(here), Some(there)) = (here, there)
                && (here == there || here == turn)
            {
                found.push([(c, here), (other, there)].map(|(corner, turn)| Bend { corner, turn }));
            }
        }
    }
}
