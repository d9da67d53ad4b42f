//! Which destinations can be reached through passages that are wide enough, and how long the ways there are.

use super::map::{Next, Way};
use super::mesh::side;
use super::route::{Destination, Ways};
use crate::engine::math::Vector;

/// A position from which ways are looked up.
struct Here {
    /// The position, meters.
    place: Vector,
    /// Its triangle, or the nearest one.
    triangle: u32,
    /// The ends of the passages in this triangle that are too narrow, meters.
    gaps: Vec<[Vector; 2]>,
}

impl Ways {
    /// The way from `p` to a destination, if it is nowhere narrower than the floor's least width.
    pub fn open_way(&self, p: Vector, to: Destination) -> Option<Way> {
        let map = self.map_to(to)?;
        let here = self.here(p)?;
        let way = self.way_from(&here, map)?;
        self.is_wide(&here, &way).then_some(way)
    }

    /// Does a way lead from `p` to a destination that is nowhere narrower than the floor's least width?
    pub fn is_open(&self, p: Vector, to: Destination) -> bool {
        self.open_way(p, to).is_some()
    }

    /// The lengths of the ways from `p` to some places, meters; infinite where every way is somewhere narrower than the
    /// floor's least width. Where this is so for all of them, as in a niche into which an agent was pushed, the lengths are
    /// those of the ways out, through any passage.
    pub fn lengths(&self, p: Vector, places: &[u16]) -> Vec<f64> {
        let Some(here) = self.here(p) else {
            return vec![f64::INFINITY; places.len()];
        };
        let ways = places.iter().map(|&place| {
            let map = self.map_to(Destination::Place(place))?;
            self.way_from(&here, map)
        });
        let ways: Vec<Option<Way>> = ways.collect();
        let is_wide = |way: &Option<Way>| way.is_some_and(|way| self.is_wide(&here, &way));
        let wide: Vec<bool> = ways.iter().map(is_wide).collect();
        let is_narrow_here = !wide.contains(&true);
        let known = ways.into_iter().zip(wide);
        let known = known.map(|(way, is_wide)| way.filter(|_| is_wide || is_narrow_here));
        known
            .map(|way| way.map_or(f64::INFINITY, |way| way.length))
            .collect()
    }

    /// The point that comes first on a way, meters.
    pub fn place(&self, next: Next) -> Vector {
        match next {
            Next::Goal(point) | Next::Out(point) => point,
            Next::Corner { bend, .. } => self.floor.place(bend),
        }
    }

    fn here(&self, p: Vector) -> Option<Here> {
        let floor = &self.floor;
        let triangle = floor.locate(p).or_else(|| floor.nearest(p))?;
        Some(Here {
            place: p,
            triangle,
            gaps: floor.mesh.gaps(triangle, floor.least_width).collect(),
        })
    }

    fn way_from(&self, here: &Here, map: u16) -> Option<Way> {
        self.maps[usize::from(map)].way(&self.floor, here.place, here.triangle, None)
    }

    /// Does a way from here lead through no passage narrower than the floor's least width?
    fn is_wide(&self, here: &Here, way: &Way) -> bool {
        if matches!(way.next, Next::Out(_)) {
            return false;
        }
        let (p, next) = (here.place, self.place(way.next));
        let crosses = |&[a, b]: &[Vector; 2]| {
            side(a, b, p) * side(a, b, next) < 0.0 && side(p, next, a) * side(p, next, b) < 0.0
        };
        !here.gaps.iter().any(crosses)
    }
}
