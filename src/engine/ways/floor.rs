//! Everything about a floor that does not depend on goals: triangles, corners, and what each corner sees.

use rayon::prelude::*;

use super::WayError;
use super::corner::{Bend, Corner, Turn};
use super::expansion::{Eye, Sight, View, expand};
use super::grid::Grid;
use super::mesh::Mesh;
use crate::engine::geometry::Area;
use crate::engine::math::Vector;

/// A floor with its corners and the ways between them.
#[derive(Debug, Clone)]
pub struct Floor {
    /// The triangles.
    pub mesh: Mesh,
    /// Cells over them.
    pub grid: Grid,
    /// The corners that shortest ways bend around.
    pub corners: Vec<Corner>,
    /// Ways narrower than this are closed, meters.
    pub least_width: f64,
    /// The corner at each corner of each triangle, with the triangle's place in the corner's fan.
    pub at: Vec<[Option<(u32, u32)>; 3]>,
    /// The straight ways to each bend: the bends that they come from, with the distances in meters.
    pub ways: Vec<Vec<(Bend, f64)>>,
}

/// A straight way between two corners. The turn of each is that of a way that ends at the other.
struct StraightWay {
    ends: [Bend; 2],
    length: f64,
}

impl Floor {
    /// Prepares areas that touch at points at most; ways narrower than `least_width` meters are closed.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn new(areas: &[Area], least_width: f64) -> Result<Self, WayError> {
        let mesh = Mesh::new(areas)?;
        let corners = Corner::all(&mesh, least_width);
        let mut at = vec![[None; 3]; mesh.triangles().len()];
        for (c, corner) in corners.iter().enumerate() {
            for (i, &(t, k)) in corner.fan.iter().enumerate() {
                at[t as usize][k] = Some((c as u32, i as u32));
            }
        }
        let mut floor = Self {
            ways: vec![Vec::new(); 2 * corners.len()],
            grid: Grid::over(&mesh),
            mesh,
            corners,
            least_width,
            at,
        };
        let all = (0..floor.corners.len() as u32).into_par_iter();
        let seen: Vec<Vec<StraightWay>> = all.map(|c| floor.look_around(c)).collect();
        for StraightWay {
            ends: [a, b],
            length,
        } in seen.into_iter().flatten()
        {
            // A way that goes on to b came to a from the other side.
            let before = |bend: Bend| Bend {
                turn: bend.turn.other(),
                ..bend
            };
            floor.ways[b.index()].push((before(a), length));
            floor.ways[a.index()].push((before(b), length));
        }
        for ways in &mut floor.ways {
            ways.sort_by_key(|(bend, _)| bend.index());
            ways.dedup_by_key(|(bend, _)| *bend);
        }
        Ok(floor)
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        let ways = self.ways.iter().map(Vec::capacity).sum::<usize>();
        let fan = |corner: &Corner| 40 * corner.fan.capacity() + size_of::<Corner>();
        ways * size_of::<(Bend, f64)>()
            + self.ways.len() * size_of::<Vec<u32>>()
            + self.grid.bytes()
            + size_of_val(self.mesh.triangles())
            + self.at.capacity() * size_of::<[Option<(u32, u32)>; 3]>()
            + self.corners.iter().map(fan).sum::<usize>()
    }

    /// The place of a bend's corner, meters.
    pub fn place(&self, bend: Bend) -> Vector {
        self.corners[bend.corner as usize].place
    }

    /// A triangle that contains `p`; `None` outside of the floor.
    pub fn locate(&self, p: Vector) -> Option<u32> {
        let mut near = self.grid.triangles(self.grid.cell(p)).iter().copied();
        near.find(|&t| self.mesh.contains(t, p))
    }

    /// The triangle nearest to a point, such as one in a wall.
    pub fn nearest(&self, p: Vector) -> Option<u32> {
        let all = 0..self.mesh.triangles().len() as u32;
        let distance = |t: u32| self.mesh.distance(t, p);
        all.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
    }

    /// The straight ways from corner `c` to corners with higher numbers.
    fn look_around(&self, c: u32) -> Vec<StraightWay> {
        let (mesh, corner) = (&self.mesh, &self.corners[c as usize]);
        let mut ways = Vec::new();
        for i in 0..corner.fan.len() {
            self.see_neighbor(c, i, &mut ways);
        }
        for turn in Turn::BOTH {
            let bend = Bend { corner: c, turn };
            let see = |t: u32, k: usize, apex: Vector| {
                if let Some((other, i)) = self.at[t as usize][k]
                    && other > c
                    && let away = &self.corners[other as usize]
                    && let Some(turn) = away.admits(mesh, i as usize, corner.place, true)
                {
                    let ends = [
                        bend,
                        Bend {
                            corner: other,
                            turn,
                        },
                    ];
                    ways.push(StraightWay {
                        ends,
                        length: (apex - corner.place).norm(),
                    });
                }
            };
            self.look_from(bend, |_, _| true, see);
        }
        ways
    }

    /// Calls `enter` for every triangle from which a way can go straight to `bend`, with the part of it from which that
    /// is so, and goes on behind the triangle if that returns true. Calls `see` as [`expand`] does.
    pub fn look_from(
        &self,
        bend: Bend,
        mut enter: impl FnMut(u32, &View) -> bool,
        see: impl FnMut(u32, usize, Vector),
    ) {
        let (mesh, corner) = (&self.mesh, &self.corners[bend.corner as usize]);
        let mut sights = Vec::new();
        for (i, &(t, k)) in corner.fan.iter().enumerate() {
            let Some([right, left]) = corner.view(mesh, i, bend.turn) else {
                continue;
            };
            let view = View {
                eye: Eye::Near(corner.place),
                right,
                left,
            };
            let side = (k + 1) % 3;
            if enter(t, &view)
                && corner.is_open(i)
                && let Some(next) = mesh.triangle(t).across[side]
            {
                let side = mesh.side_along(next, t);
                sights.push(Sight {
                    triangle: next,
                    side,
                    view,
                });
            }
        }
        let enter = |sight: &Sight| enter(sight.triangle, &sight.view);
        expand(mesh, self.least_width, sights, enter, see);
    }

    /// Adds the ways along the sides of triangle `i` in the fan of corner `c`.
    fn see_neighbor(&self, c: u32, i: usize, found: &mut Vec<StraightWay>) {
        let corner = &self.corners[c as usize];
        let (t, k) = corner.fan[i];
        for (end, third, turn) in [(1, 2, Turn::First), (2, 1, Turn::Last)] {
            let (end, third) = ((k + end) % 3, (k + third) % 3);
            let Some((other, j)) = self.at[t as usize][end].filter(|(other, _)| *other > c) else {
                continue;
            };
            let (away, j) = (&self.corners[other as usize], j as usize);
            let [here, there] = [
                corner.turn(&self.mesh, i, away.place),
                away.turn(&self.mesh, j, corner.place),
            ];
            let (Some(here), Some(there)) = (here, there) else {
                continue;
            };
            let is_passable = if here == there {
                // The way crosses this side: it comes around one corner and leaves around the other.
                let [own, others] = if turn == Turn::First {
                    [i, j + 1]
                } else {
                    [i + 1, j]
                };
                corner.is_clear_from_side(own) && away.is_clear_from_side(others)
            } else {
                // The walls of both corners lie on the side of the way where this triangle is not.
                here == turn
                    && self.mesh.triangle(t).width[third] >= self.least_width
                    && corner.is_clear(i, here)
                    && away.is_clear(j, there)
            };
            if is_passable {
                found.push(StraightWay {
                    ends: [
                        Bend {
                            corner: c,
                            turn: here,
                        },
                        Bend {
                            corner: other,
                            turn: there,
                        },
                    ],
                    length: (away.place - corner.place).norm(),
                });
            }
        }
    }
}
