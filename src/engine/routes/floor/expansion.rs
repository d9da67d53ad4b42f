//! Triangular expansion (Bungiu et al. 2014): everything that is visible from a point, or along one direction.

use super::mesh::Mesh;
use crate::math::Vector;

/// The viewpoint of a cone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Eye {
    /// A point, meters.
    Near(Vector),
    /// Infinitely far away, looking in this direction.
    Far(Vector),
}

impl Eye {
    /// Positive if `p` lies on the left of the ray from here through `through`.
    #[inline]
    pub fn side(&self, through: Vector, p: Vector) -> f64 {
        match *self {
            Self::Near(eye) => (through - eye).perp(&(p - eye)),
            Self::Far(way) => way.perp(&(p - through)),
        }
    }

    /// A vector along the ray through `through`. [`side`](Self::side) changes by its length per meter of distance from
    /// the ray.
    #[inline]
    pub fn ray(&self, through: Vector) -> Vector {
        match *self {
            Self::Near(eye) => through - eye,
            Self::Far(way) => way,
        }
    }
}

/// A point on an edge of a visible cone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Border {
    /// The point, meters.
    pub at: Vector,
    /// Its number: first come the points of the mesh, then those of [`Floor::border`](super::Floor::border),
    /// then those of a path map.
    pub number: u32,
}

impl Mesh {
    /// Corner k of triangle `t`, as an edge of a visible cone.
    pub fn border(&self, t: u32, k: usize) -> Border {
        let number = self.triangle(t).corners[k];
        Border {
            at: self.point(number),
            number,
        }
    }
}

/// A visible cone, or a strip if its eye is at infinity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The viewpoint.
    pub eye: Eye,
    /// A point on its right edge.
    pub right: Border,
    /// A point on its left edge.
    pub left: Border,
}

impl View {
    /// Whether `p` lies in the cone, edges included. Only for points in front of the eye.
    #[inline]
    pub fn holds(&self, p: Vector) -> bool {
        self.eye.side(self.right.at, p) >= 0.0 && self.eye.side(self.left.at, p) <= 0.0
    }

    /// The part of the cone that leaves a triangle through the portal from `r` to `l`, its right and left end as seen
    /// from inside; `None` if nothing is left of the cone.
    pub fn through(&self, [r, l]: [Border; 2]) -> Option<Self> {
        let Self { eye, right, left } = *self;
        let is_left_of = |a: Border, b: Border| eye.side(b.at, a.at) > 0.0;
        let new_right = if is_left_of(r, right) { r } else { right };
        let new_left = if is_left_of(left, l) { l } else { left };
        (is_left_of(l, r) && is_left_of(new_left, new_right)).then_some(Self {
            eye,
            right: new_right,
            left: new_left,
        })
    }
}

/// A visible cone that enters a triangle.
#[derive(Debug, Clone, Copy)]
pub struct Sight {
    /// The triangle.
    pub triangle: u32,
    /// The side through which the cone enters.
    pub side: usize,
    /// The part of the cone that enters.
    pub view: View,
}

impl Sight {
    /// The cone `view` of triangle `t`, where it enters the triangle beyond this side; `None` beyond a wall.
    pub fn beyond(mesh: &Mesh, (t, side): (u32, usize), view: View) -> Option<Self> {
        let triangle = mesh.triangle(t).across[side]?;
        Some(Self {
            triangle,
            side: mesh.side_along(triangle, t),
            view,
        })
    }
}

/// Expands `sights` from triangle to triangle. Calls `enter` for every visible triangle, and expands behind it if that
/// returns true. Calls `see` for every visible point that lies opposite to the side through which the cone enters its
/// triangle.
pub fn expand(
    mesh: &Mesh,
    mut sights: Vec<Sight>,
    mut enter: impl FnMut(&Sight) -> bool,
    mut see: impl FnMut(u32, usize, Vector),
) {
    while let Some(sight) = sights.pop() {
        let Sight {
            triangle: t,
            side,
            view,
        } = sight;
        if !enter(&sight) {
            continue;
        }
        let (right_end, top) = ((side + 1) % 3, (side + 2) % 3);
        let apex = mesh.border(t, top);
        let (a, b) = (
            view.eye.side(view.right.at, apex.at),
            view.eye.side(view.left.at, apex.at),
        );
        if a >= 0.0 && b <= 0.0 {
            see(t, top, apex.at);
        }
        let mut go_on = |exit: usize, view| sights.extend(Sight::beyond(mesh, (t, exit), view));
        if a > 0.0 {
            let left = if b <= 0.0 { apex } else { view.left };
            go_on(right_end, View { left, ..view });
        }
        if b < 0.0 {
            let right = if a >= 0.0 { apex } else { view.right };
            go_on(top, View { right, ..view });
        }
    }
}
