//! The times that agents expect for the routes through openings.

use super::bound::FLOW_PER_METER_OF_OPENINGS;
use super::expected::{Expected, Line};
use super::stream::BEFORE;
use super::{Crowd, Progress, Simulation};
use crate::math::Vector;
use crate::routes::{Destination, Rooms, RoutesOut, Side};
use crate::scene::{Knowledge, Scene};

/// Waiting before a closed door is expected to take this long, seconds.
const CLOSED: f64 = 3600.0;

/// Agents do not pass each other in narrower openings, meters.
pub(super) const SINGLE_FILE: f64 = 1.0;
/// Slower agents are expected to walk at this speed, m/s.
const SLOWEST: f64 = 0.05;

/// The times that agents expect.
pub(super) struct Times<'a> {
    pub rooms: &'a Rooms,
    pub scene: &'a Scene,
    pub progress: &'a Progress,
    /// The flow that follows from the width of an opening, P/(m s).
    pub per_meter: f64,
}

/// A way out of a room, or to a goal in it, as an agent sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RouteProspect {
    /// The side of the opening by which it leaves the room; `None`: the goal is there.
    pub side: Option<Side>,
    /// The length of the way to the opening, or to the goal, meters.
    pub length: f64,
    /// The times that the agent expects for it.
    pub expected: Expected,
}

impl<'a> Times<'a> {
    /// The flow through the opening of a side, P/s.
    pub fn flow(&self, side: Side) -> f64 {
        let expected = self.per_meter * self.rooms.opening(side).width();
        let stream = self.progress.sides.get(side.index());
        stream.map_or(expected, |stream| stream.flow(expected))
    }

    /// The opening of a side, as an agent sees it that is `length` meters away.
    fn line(&self, side: Side, length: f64) -> Line<'a> {
        let of = |side: Side| self.progress.sides.get(side.index());
        let oncoming = of(side.other()).map_or(0, |other| {
            // Where two agents cannot pass each other, all from the other side go first.
            match self.rooms.opening(side).width() < SINGLE_FILE {
                true => other.bound(),
                false => other.nearer_than(length.max(BEFORE)),
            }
        });
        Line {
            length,
            stream: of(side),
            oncoming,
            flow: self.flow(side),
        }
    }

    /// The times to walk to an opening and to wait there, seconds; `None` for the line: without waits for others.
    fn passing(&self, side: Side, line: Option<&Line>, length: f64, speed: f64) -> [f64; 2] {
        let walking = length / speed;
        let of_others = speed.max(self.scene.preferred_speed);
        let waiting = line.map_or(0.0, |line| line.waiting(of_others));
        let door = self.rooms.opening(side).door();
        let state = door.and_then(|door| self.progress.places.get(usize::from(door)));
        match state.is_some_and(|state| !state.open) {
            true => [walking, walking.max(waiting) + CLOSED],
            false => [walking, waiting],
        }
    }

    /// The least times from each side to a goal, seconds, for agents that walk at the scene's speed.
    pub fn onward(&self, goal: usize) -> Vec<f64> {
        let sees = self.scene.by_time() && self.scene.routing.knowledge == Knowledge::Floor;
        let speed = self.scene.preferred_speed.max(SLOWEST);
        self.rooms.onward(goal, |side, length| match side {
            None => length / speed,
            Some(side) => {
                let line = sees.then(|| self.line(side, length));
                let [walking, waiting] = self.passing(side, line.as_ref(), length, speed);
                walking.max(waiting)
            }
        })
    }

    /// What an agent with this speed, m/s, expects of its routes out of a room; `onward` are the times beyond to their
    /// goal, for the scene's speed.
    ///
    /// Routes lead over the middles of openings, but the length of the shortest one is exact.
    pub fn prospects(&self, routes: &RoutesOut, onward: &[f64], speed: f64) -> Vec<RouteProspect> {
        let speed = speed.max(SLOWEST);
        let slower = 1.0 / speed - 1.0 / self.scene.preferred_speed.max(SLOWEST);
        let has_exact = !self.rooms.has_one_way() && !self.rooms.floor.has_levels();
        let exact = routes.shortest.filter(|_| has_exact);
        let direct = routes.direct.map(|length| RouteProspect {
            side: None,
            length,
            expected: GOAL.expected(length / speed, 0.0, &[]),
        });
        let through = routes.through.iter();
        let through = through.filter_map(|&(side, [length, aside])| {
            let beyond = onward.get(side.index()).filter(|time| time.is_finite())?;
            let from = self.rooms.length_from(side, usize::from(routes.goal));
            let over = length + aside + from;
            let excess = exact
                .filter(|exact| exact.side == Some(side))
                .map_or(0.0, |exact| (over - exact.length).max(0.0));
            let line = self.line(side, length);
            let waits = Some(&line).filter(|_| self.scene.by_time());
            let [walking, waiting] = self.passing(side, waits, length, speed);
            let beyond = [*beyond, (aside - excess) / speed, from * slower];
            Some(RouteProspect {
                side: Some(side),
                length,
                expected: line.expected(walking, waiting, &beyond),
            })
        });
        direct.into_iter().chain(through).collect()
    }
}

/// A goal: no line to wait at.
const GOAL: Line = Line {
    length: 0.0,
    stream: None,
    oncoming: 0,
    flow: f64::INFINITY,
};

impl Simulation {
    /// The points of the way from `p` that takes the least time now, meters: its corners, the places where it crosses
    /// openings, and its end. The shortest way if agents do not choose by time.
    pub fn course(&self, p: Vector, to: Destination) -> Vec<Vector> {
        let (scene, crowd) = (&self.fixed.scene, &self.crowd);
        let Some(routes) = &scene.routes else {
            return Vec::new();
        };
        let known = (crowd.times(scene), routes.map_to(to));
        let (Some(times), Some(goal)) = known else {
            return routes.course(p, to);
        };
        let (rooms, onward) = (times.rooms, times.onward(usize::from(goal)));
        let (mut points, mut here, mut back) = (Vec::new(), p, None);
        for _ in 0..=rooms.sides().len() {
            let located = rooms.floor.locate_or_nearest(None, here);
            let best = located.and_then(|t| {
                let routes_out = routes.routes_out((here, t), goal, None, None)?;
                let all = times.prospects(&routes_out, &onward, scene.preferred_speed);
                let leads_on = |way: &&RouteProspect| way.side.is_none() || way.side != back;
                Some((t, quickest(all.iter().filter(leads_on))?))
            });
            let Some((t, best)) = best else {
                break;
            };
            // As agents do: the shortest way as long as it leads through the chosen opening.
            let at = rooms.floor.in_building(here);
            let mut course: Vec<Vector> = routes.course(here, to);
            for point in &mut course {
                *point += at - here;
            }
            let crossing = rooms.first_crossing(at, t, course.iter().copied());
            if crossing.map(|crossing| crossing.side) != best.side {
                course = rooms.course((at, t), usize::from(goal), best.side);
            } else if let Some(crossing) = crossing {
                course.truncate(crossing.after);
                course.push(crossing.at);
            }
            points.extend(course);
            let Some((side, &end)) = best.side.zip(points.last()) else {
                break;
            };
            here = rooms.beyond(side, end);
            back = Some(side.other());
        }
        let seen = points
            .into_iter()
            .map(|point| rooms.floor.seen_from(p, point));
        seen.collect()
    }

    /// The waiting time before each opening, seconds: that of an agent that comes last, beyond its walk. One for each
    /// opening of the scene's rooms, the longer one of both directions.
    pub fn waits(&self) -> Vec<f64> {
        let (scene, crowd) = (&self.fixed.scene, &self.crowd);
        let Some(times) = crowd.times(scene) else {
            return Vec::new();
        };
        let wait = |side: &Side| {
            let stream = crowd.progress.sides.get(side.index());
            stream.map_or(0.0, |stream| f64::from(stream.bound()) / times.flow(*side))
        };
        let sides: Vec<Side> = times.rooms.sides().collect();
        let openings = sides.chunks(2);
        let waits = openings.map(|sides| sides.iter().map(wait).fold(0.0, f64::max));
        waits.collect()
    }
}

impl Crowd {
    /// The times that agents expect now.
    pub(super) fn times<'a>(&'a self, scene: &'a Scene) -> Option<Times<'a>> {
        let rooms = scene.rooms()?;
        Some(Times {
            rooms,
            scene,
            progress: &self.progress,
            per_meter: self.flow_per_meter().max(FLOW_PER_METER_OF_OPENINGS),
        })
    }

    /// What agent `i` expects of its routes out of a room.
    pub(super) fn prospects_of(
        &self,
        scene: &Scene,
        i: usize,
        routes: &RoutesOut,
    ) -> Vec<RouteProspect> {
        let onward = self.progress.onward.get(usize::from(routes.goal));
        let (Some(times), Some(onward)) = (self.times(scene), onward) else {
            return Vec::new();
        };
        let own = self.agents.preferred_speed.get(i).copied();
        let speed = own.unwrap_or(scene.preferred_speed);
        times.prospects(routes, onward, speed)
    }

    /// The routes out of the room of agent `i` that lead to a goal, if agents choose by time. The shortest way is
    /// `length` meters long; `others`: the routes to another goal.
    pub(super) fn routes_out_to(
        &self,
        scene: &Scene,
        (i, goal, length): (usize, u16, f64),
        others: Option<&RoutesOut>,
    ) -> Option<RoutesOut> {
        let rooms = scene.rooms().filter(|_| scene.by_time())?;
        let p = self.agents.position[i];
        let locate = || {
            let plan = self.agents.plan.get(i).copied().flatten();
            match plan {
                Some(plan) => plan.located.triangle_at(rooms, p),
                None => rooms.floor.locate_or_nearest(None, p),
            }
        };
        let here = others.map(|others| others.triangle).or_else(locate)?;
        let routes = scene.routes.as_ref()?;
        routes.routes_out((p, here), goal, others, Some(length))
    }

    /// The time that agent `i` expects for the way to a goal, seconds, whose length is `length` meters; `None` if it is
    /// not known. Keeps the routes out of its room in `known`: other goals share their lengths.
    pub(super) fn time_to(
        &self,
        scene: &Scene,
        (i, goal, length): (usize, u16, f64),
        known: &mut Option<RoutesOut>,
    ) -> Option<f64> {
        if known.as_ref().is_none_or(|known| known.goal != goal) {
            *known = Some(self.routes_out_to(scene, (i, goal, length), known.as_ref())?);
        }
        let all = self.prospects_of(scene, i, known.as_ref()?);
        quickest(&all).map(|way| way.expected.total_secs)
    }
}

/// The way that takes the least time.
pub(super) fn quickest<'a>(
    routes: impl IntoIterator<Item = &'a RouteProspect>,
) -> Option<RouteProspect> {
    let routes = routes.into_iter().copied();
    routes.min_by(|a, b| a.expected.total_secs.total_cmp(&b.expected.total_secs))
}
