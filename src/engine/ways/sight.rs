//! The line of sight from a position to a corner.

use super::corner::Bend;
use super::expansion::{Eye, View};
use super::floor::Floor;
use crate::math::Vector;

impl Floor {
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
}
