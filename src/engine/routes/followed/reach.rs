//! Which destinations can be reached through passages that are wide enough, and how long the routes there are.

use std::collections::BTreeSet;

use super::routes::{Destination, Routes};
use crate::math::Vector;
use crate::routes::floor::Floor;
use crate::routes::paths::{Next, Way};

impl Routes {
    /// The way from `p` to a destination, if it is nowhere narrower than the floor's least width.
    pub fn open_way(&self, p: Vector, to: Destination) -> Option<Way> {
        self.way(p, to).filter(Way::is_wide)
    }

    /// Whether a way from `p` to a destination is nowhere narrower than the floor's least width.
    pub fn is_open(&self, p: Vector, to: Destination) -> bool {
        let is_allowed = || match (&self.rooms, self.map_to(to)) {
            (Some(rooms), Some(goal)) if rooms.has_one_way() => {
                rooms.length(p, usize::from(goal)).is_finite()
            }
            _ => true,
        };
        self.open_way(p, to).is_some() && is_allowed()
    }

    /// The lengths of the routes from `p` to some places, meters; infinite if every way is somewhere narrower than the
    /// floor's least width. If this holds for all places, as in a niche that an agent was pushed into, the lengths are
    /// those of the routes out through any passage.
    pub fn lengths(&self, p: Vector, places: &[u16]) -> Vec<f64> {
        let (here, at) = (
            self.floor.locate_or_nearest(None, p),
            self.floor.in_building(p),
        );
        let routes = places.iter().map(|&place| {
            let map = self.map_to(Destination::Place(place))?;
            self.maps[usize::from(map)].way(&self.floor, at, here?, None)
        });
        let routes: Vec<Option<Way>> = routes.collect();
        let is_narrow_here = !routes.iter().flatten().any(Way::is_wide);
        let rooms = self.rooms.as_ref().filter(|rooms| rooms.has_one_way());
        let known = routes.into_iter().zip(places);
        let length = |(way, &place): (Option<Way>, &u16)| {
            let way = way.filter(|way| is_narrow_here || way.is_wide())?;
            Some(match rooms {
                Some(rooms) => rooms.length(p, usize::from(place)),
                None => way.length,
            })
        };
        known
            .map(|known| length(known).unwrap_or(f64::INFINITY))
            .collect()
    }
}

impl Way {
    /// Whether the way crosses no closed passage.
    fn is_wide(&self) -> bool {
        !matches!(self.next, Next::Out(_))
    }
}

/// The regions of a floor: from everywhere in one, routes lead to the same places.
pub struct Regions<'a> {
    routes: &'a Routes,
    /// The region of each triangle of a floor that is not divided into rooms.
    of_triangle: Vec<u32>,
}

impl<'a> Regions<'a> {
    /// The regions of the floor of `routes`: its rooms, or what is connected without closed passages.
    pub fn of(routes: &'a Routes) -> Self {
        let of_triangle = match routes.rooms {
            Some(_) => Vec::new(),
            None => routes.floor.mesh.parts(),
        };
        Self {
            routes,
            of_triangle,
        }
    }

    /// The region of a point; `None` off the floor.
    pub fn at(&self, p: Vector) -> Option<u32> {
        self.of_located(|floor| floor.locate(p))
    }

    /// The region of a point, or the one nearest to a point in a wall.
    pub fn nearest(&self, p: Vector) -> Option<u32> {
        self.of_located(|floor| floor.locate_or_nearest(None, p))
    }

    fn of_located(&self, locate: impl Fn(&Floor) -> Option<u32>) -> Option<u32> {
        match &self.routes.rooms {
            Some(rooms) => Some(rooms.room(locate(&rooms.floor)?)),
            None => Some(self.of_triangle[locate(&self.routes.floor)? as usize]),
        }
    }

    /// The regions to which routes lead from one, itself among them.
    pub fn reached_from(&self, region: u32) -> BTreeSet<u32> {
        let mut reached = BTreeSet::from([region]);
        let mut waiting = vec![region];
        while let (Some(rooms), Some(region)) = (&self.routes.rooms, waiting.pop()) {
            let sides = rooms.sides_in(region).iter();
            let beyond = sides.map(|&side| rooms.room_beyond(side));
            waiting.extend(beyond.filter(|&region| reached.insert(region)));
        }
        reached
    }

    /// Whether a way there is no way back, because of one-way doors.
    pub fn has_one_way(&self) -> bool {
        let mut rooms = self.routes.rooms.iter();
        rooms.any(|rooms| rooms.has_one_way())
    }
}
