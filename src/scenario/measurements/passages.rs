//! The passages on the way of an agent: openings of the floor, declared doors, and what it walks to.

use std::collections::BTreeMap;

use super::aim::Aim;
use engine::journeys::Kind;
use engine::math::Vector;
use engine::routes::{Destination, MapKey, Narrowings, Routes, WIDEST};
use engine::scene::Scene;
use engine::simulation::Simulation;

/// An opening of the floor, with its distance along a way, meters.
pub(super) type Crossing = (u32, f64);

/// The openings of a floor.
#[derive(Debug, Clone, Default)]
pub(super) struct Openings {
    /// Those that are declared doors come first.
    all: Narrowings,
    /// The numbers of the places of these doors.
    doors: Vec<u16>,
}

/// The openings on routes that are known from a corner on: by what the routes lead to, and the first two of their
/// points.
pub(super) type Known = BTreeMap<(u16, [u64; 4]), Vec<Crossing>>;

/// The way of an agent around walls.
pub(super) struct Way {
    /// The path map to its end.
    map: Option<u16>,
    /// Its points, meters.
    course: Vec<Vector>,
    /// The openings before the first of them.
    first: Vec<Crossing>,
    /// The distance to the first of them, and the length of the way, meters.
    distance: f64,
    pub(super) length: f64,
}

impl Openings {
    /// Those of a scene with routes: its declared doors, and its narrow places.
    pub(super) fn of(scene: &Scene) -> Self {
        let Some(routes) = &scene.routes else {
            return Self::default();
        };
        let doors = Self::doors(scene);
        Self {
            all: doors.all.and_openings(routes.floor.whole(), WIDEST),
            doors: doors.doors,
        }
    }

    /// The declared doors alone.
    pub(super) fn doors(scene: &Scene) -> Self {
        let places = scene.journeys.places.iter().zip(0..);
        let doors = places.filter_map(|(place, number)| match &place.kind {
            Kind::Door(door) => Some((number, door.line)),
            _ => None,
        });
        let (doors, lines): (Vec<u16>, Vec<[Vector; 2]>) = doors.unzip();
        Self {
            all: Narrowings::at(lines),
            doors,
        }
    }

    /// The declared doors on the way of agent `i` to its aim, in their order, each with a point of the way before it,
    /// meters.
    pub(super) fn doors_ahead(
        &self,
        simulation: &Simulation,
        (i, aim): (usize, Aim),
    ) -> Vec<(u16, Vector)> {
        let routes = simulation.scene().routes.as_ref();
        let Some((routes, to)) = routes
            .zip(aim.destination())
            .filter(|_| !self.doors.is_empty())
        else {
            return Vec::new();
        };
        let start = [simulation.frame().agents.position[i]];
        let points = start.into_iter().chain(course(simulation, routes, (i, to)));
        let course: Vec<Vector> = points.collect();
        let crossed = course.windows(2).flat_map(|pair| {
            let mut crossed = self.all.crossed(pair[0], pair[1]);
            crossed.sort_by(|(_, a), (_, b)| a.total_cmp(b));
            crossed.into_iter().map(|(k, _)| (k, pair[0]))
        });
        let door = |(k, before): (u32, Vector)| Some((self.door(k)?, before));
        crossed.filter_map(door).collect()
    }

    /// The number of the place of opening `k`, if it is a declared door.
    pub(super) fn door(&self, k: u32) -> Option<u16> {
        self.doors.get(k as usize).copied()
    }

    /// The middle of opening `k`, meters.
    pub(super) fn middle(&self, k: u32) -> Vector {
        self.all.middle(k)
    }

    /// The way of agent `i` to its aim; `None` without a way around walls.
    pub(super) fn way(&self, simulation: &Simulation, (i, aim): (usize, Aim)) -> Option<Way> {
        let p = simulation.frame().agents.position[i];
        let routes = simulation.scene().routes.as_ref()?;
        let to = aim.destination()?;
        let course = course(simulation, routes, (i, to));
        let &first = course.first()?;
        let distance = (first - p).norm();
        Some(Way {
            map: routes.map_to(to),
            first: self.all.crossed(p, first),
            distance,
            length: distance + self::length(&course),
            course,
        })
    }

    /// The openings on a way, in their order. `known` has those on other ways.
    pub(super) fn ahead(&self, way: Way, known: &mut Known) -> Vec<Crossing> {
        let mut found = way.first;
        if let (&[first, second, ..], Some(map)) = (&way.course[..], way.map) {
            let bits = [first.x, first.y, second.x, second.y].map(f64::to_bits);
            let entry = known.entry((map, bits));
            let rest = entry.or_insert_with(|| self.along(&way.course));
            for &(k, beyond) in &*rest {
                if found.iter().all(|&(other, _)| other != k) {
                    found.push((k, way.distance + beyond));
                }
            }
        }
        found.sort_by(|(k, a), (l, b)| a.total_cmp(b).then(l.cmp(k)));
        found
    }

    /// The openings on a way over these points, each with its distance along it, meters.
    fn along(&self, course: &[Vector]) -> Vec<Crossing> {
        let (mut found, mut before): (Vec<Crossing>, f64) = (Vec::new(), 0.0);
        for pair in course.windows(2) {
            for (k, distance) in self.all.crossed(pair[0], pair[1]) {
                if found.iter().all(|&(other, _)| other != k) {
                    found.push((k, before + distance));
                }
            }
            before += (pair[1] - pair[0]).norm();
        }
        found
    }
}

/// The points of the way of agent `i`, meters: of the way through another opening than that of the shortest one, if it
/// has chosen that.
fn course(simulation: &Simulation, routes: &Routes, (i, to): (usize, Destination)) -> Vec<Vector> {
    let agents = simulation.frame().agents;
    let p = agents.position[i];
    let plan = agents.plan.get(i).and_then(Option::as_ref);
    let detour = plan.and_then(|plan| match plan.detour(routes, to)? {
        MapKey::Opening(side) => Some((plan, side)),
        MapKey::Floor(_) | MapKey::Room(_) => None,
    });
    let through = detour.and_then(|(plan, side)| {
        if simulation.progress().places.iter().any(|place| !place.open) {
            return simulation.way_through(i, plan.goal, side);
        }
        let rooms = routes.rooms()?;
        let here = plan.located.triangle_at(rooms, p)?;
        // Points of the building, then as seen from `p`.
        let floor = &rooms.floor;
        let at = floor.in_building(p);
        let mut course = rooms.course((at, here), usize::from(plan.goal), Some(side));
        let behind = rooms.beyond(side, *course.last()?);
        let shift = floor.in_building(behind) - behind;
        course.push(behind + shift);
        let rest = routes.course(behind, to).into_iter();
        course.extend(rest.map(|point| point + shift));
        Some(course.into_iter().map(|point| point + (p - at)).collect())
    });
    through.unwrap_or_else(|| routes.course(p, to))
}

fn length(course: &[Vector]) -> f64 {
    let legs = course.windows(2).map(|pair| (pair[1] - pair[0]).norm());
    legs.sum()
}
