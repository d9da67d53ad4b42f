//! The times that agents expect for the ways through openings.

use super::bound;
use super::{Crowd, Progress, Simulation};
use crate::math::Vector;
use crate::scene::{Knowledge, Scene};
use crate::ways::{Destination, Known, Leaving, Rooms, Step};

/// Waiting before a closed door is expected to take this long, seconds.
const CLOSED: f64 = 3600.0;

/// Agents do not pass each other in narrower openings, meters.
pub(super) const SINGLE_FILE: f64 = 1.0;
/// Slower agents are expected to walk at this speed, m/s.
const SLOWEST: f64 = 0.05;

/// A way through an opening goes on from a point this far behind it, meters.
const BEYOND: f64 = 1e-3;

/// The times that agents expect.
pub(super) struct Times<'a> {
    pub rooms: &'a Rooms,
    pub scene: &'a Scene,
    pub progress: &'a Progress,
    /// The flow that follows from the width of an opening, P/(m s).
    pub per_meter: f64,
}

/// A way out of a room, or to a goal in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outlook {
    /// The step by which it leaves the room; `None`: the goal is there.
    pub step: Option<Step>,
    /// The length of the way to the opening, or to the goal, meters.
    pub length: f64,
    /// Agents that pass the opening before: those that are nearer to it, and those that come from the other side.
    pub ahead: u32,
    /// Its flow, P/s; infinite at the goal.
    pub flow: f64,
    /// The time until the agent has passed the opening, seconds.
    pub until_through: f64,
    /// The time to the goal, seconds.
    pub total: f64,
}

impl Times<'_> {
    /// The flow of a step, P/s.
    pub fn flow(&self, step: Step) -> f64 {
        let expected = self.per_meter * self.rooms.opening(step).width();
        let stream = self.progress.steps.get(step as usize);
        stream.map_or(expected, |stream| stream.flow(expected))
    }

    /// The time to walk `length` meters and pass the opening of a step (`None`: to arrive), seconds. `sees`: knowing
    /// who waits there.
    fn leg(&self, step: Option<Step>, length: f64, (speed, sees): (f64, bool)) -> f64 {
        let walking = length / speed;
        let Some(step) = step else {
            return walking;
        };
        let door = self.rooms.opening(step).door();
        let state = door.and_then(|door| self.progress.places.get(usize::from(door)));
        let closed = if state.is_some_and(|state| !state.open) {
            CLOSED
        } else {
            0.0
        };
        let waiting = match sees && self.scene.by_time() {
            true => self.waiting(step, length, speed),
            false => 0.0,
        };
        walking.max(waiting) + closed
    }

    /// The time until those have passed the opening of a step that pass it before an agent that is `length` meters away
    /// and walks at some speed, seconds.
    fn waiting(&self, step: Step, length: f64, speed: f64) -> f64 {
        let (speed, flow) = (speed.max(self.scene.preferred_speed), self.flow(step));
        let own = self.progress.steps.get(step as usize);
        let clear = own.map_or(0.0, |own| own.clear_after(length, speed, flow));
        clear + f64::from(self.oncoming(step, length)) / flow
    }

    /// The number of agents that pass the opening of a step before one that is `length` meters away: those bound for it
    /// that are nearer, and those that come from the other side.
    fn ahead(&self, step: Step, length: f64) -> u32 {
        let own = self.progress.steps.get(step as usize);
        own.map_or(0, |own| own.nearer_than(length)) + self.oncoming(step, length)
    }

    /// Of the agents that come from the other side of an opening, those that pass it before one that is `length` meters
    /// away. Where two cannot pass each other, all of these.
    fn oncoming(&self, step: Step, length: f64) -> u32 {
        let other = self.progress.steps.get((step ^ 1) as usize);
        other.map_or(0, |other| {
            match self.rooms.opening(step).width() < SINGLE_FILE {
                true => other.bound(),
                false => other.nearer_than(length.max(bound::BEFORE)),
            }
        })
    }

    /// The least times from each step to a goal, seconds, for agents that walk at the scene's speed.
    pub fn onward(&self, goal: usize) -> Vec<f64> {
        let sees = self.scene.routing.knowledge == Knowledge::Floor;
        let speed = self.scene.preferred_speed.max(SLOWEST);
        let leg = |step, length| self.leg(step, length, (speed, sees));
        self.rooms.onward(goal, leg)
    }

    /// The times of the ways that leave a room, for a speed, m/s; `onward` are the times beyond to their goal, for the
    /// scene's speed.
    ///
    /// Ways lead over the middles of openings, but the length of the shortest one is exact.
    pub fn outlooks(&self, leaving: &Leaving, onward: &[f64], speed: f64) -> Vec<Outlook> {
        let speed = speed.max(SLOWEST);
        let slower = 1.0 / speed - 1.0 / self.scene.preferred_speed.max(SLOWEST);
        let exact = leaving.shortest.filter(|_| !self.rooms.has_one_way());
        let direct = leaving.direct.map(|length| Outlook {
            step: None,
            length,
            ahead: 0,
            flow: f64::INFINITY,
            until_through: length / speed,
            total: length / speed,
        });
        let through = leaving.through.iter();
        let through = through.filter_map(|&(step, [length, aside])| {
            let onward = onward.get(step as usize).filter(|time| time.is_finite())?;
            let until_through = self.leg(Some(step), length, (speed, true));
            let from = self.rooms.length_from(step, usize::from(leaving.goal));
            let over = length + aside + from;
            let excess = exact
                .filter(|exact| exact.step == Some(step))
                .map_or(0.0, |exact| (over - exact.length).max(0.0));
            Some(Outlook {
                step: Some(step),
                length,
                ahead: self.ahead(step, length),
                flow: self.flow(step),
                until_through,
                total: until_through + onward + (aside - excess) / speed + from * slower,
            })
        });
        direct.into_iter().chain(through).collect()
    }
}

impl Simulation {
    /// The points of the way from `p` that takes the least time now, meters: its corners, the places where it crosses
    /// openings, and its end. The shortest way if agents do not choose by time.
    pub fn course(&self, p: Vector, to: Destination) -> Vec<Vector> {
        let (scene, crowd) = (&self.fixed.scene, &self.crowd);
        let Some(ways) = &scene.ways else {
            return Vec::new();
        };
        let known = (crowd.times(scene), ways.map_to(to));
        let (Some(times), Some(goal)) = known else {
            return ways.course(p, to);
        };
        let (rooms, onward) = (times.rooms, times.onward(usize::from(goal)));
        let (mut points, mut here, mut back) = (Vec::new(), p, None);
        for _ in 0..=rooms.steps() {
            let Some(t) = rooms.floor.locate_or_nearest(None, here) else {
                break;
            };
            let Some(leaving) = ways.leaving((here, t), goal, Known::default()) else {
                break;
            };
            let mut all = times.outlooks(&leaving, &onward, scene.preferred_speed);
            all.retain(|outlook| outlook.step.is_none() || outlook.step != back);
            let Some(best) = all.into_iter().min_by(|a, b| a.total.total_cmp(&b.total)) else {
                break;
            };
            // As agents do: the shortest way as long as it leads through the chosen opening.
            let mut course = ways.course(here, to);
            let crossing = rooms.first_crossing(here, t, course.iter().copied());
            if crossing.map(|crossing| crossing.step) != best.step {
                course = rooms.course((here, t), usize::from(goal), best.step);
            } else if let Some(crossing) = crossing {
                course.truncate(crossing.after);
                course.push(crossing.at);
            }
            points.extend(course);
            let Some((step, &end)) = best.step.zip(points.last()) else {
                break;
            };
            here = end + rooms.ahead(step) * BEYOND;
            back = Some(step ^ 1);
        }
        points
    }

    /// The waiting time before each opening, seconds: that of an agent that comes last, beyond its walk. One for each
    /// opening of the scene's rooms, the longer one of both directions.
    pub fn waits(&self) -> Vec<f64> {
        let (scene, crowd) = (&self.fixed.scene, &self.crowd);
        let Some(times) = crowd.times(scene) else {
            return Vec::new();
        };
        let wait = |step: Step| {
            let stream = crowd.progress.steps.get(step as usize);
            stream.map_or(0.0, |stream| f64::from(stream.bound()) / times.flow(step))
        };
        let openings = 0..times.rooms.openings().len() as Step;
        openings.map(|k| wait(2 * k).max(wait(2 * k + 1))).collect()
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
            per_meter: self.flow_per_meter().max(bound::FLOW_PER_METER_OF_OPENINGS),
        })
    }

    /// The times that agent `i` expects for the ways out of its room to a goal.
    pub(super) fn outlooks_of(&self, scene: &Scene, i: usize, leaving: &Leaving) -> Vec<Outlook> {
        let onward = self.progress.onward.get(usize::from(leaving.goal));
        let (Some(times), Some(onward)) = (self.times(scene), onward) else {
            return Vec::new();
        };
        let own = self.agents.preferred_speed.get(i).copied();
        let speed = own.unwrap_or(scene.preferred_speed);
        times.outlooks(leaving, onward, speed)
    }

    /// The ways out of the room of agent `i` that lead to a goal, if agents choose by time. The shortest way is
    /// `length` meters long; `known`: the same for another goal.
    pub(super) fn leaving_to(
        &self,
        scene: &Scene,
        (i, goal, length): (usize, u16, f64),
        known: Option<&Leaving>,
    ) -> Option<Leaving> {
        let rooms = scene.rooms().filter(|_| scene.by_time())?;
        let p = self.agents.position[i];
        let locate = || {
            let plan = self.agents.plan.get(i).copied().flatten();
            let before = plan.map(|plan| plan.triangle);
            rooms.floor.locate_or_nearest(before, p)
        };
        let here = known.map(|known| known.triangle).or_else(locate)?;
        let known = Known {
            leaving: known,
            length: Some(length),
        };
        scene.ways.as_ref()?.leaving((p, here), goal, known)
    }

    /// The time that agent `i` expects for the way to a goal, seconds, whose length is `length` meters; `None` if it is
    /// not known. Keeps the ways out of its room in `known`: other goals share their lengths.
    pub(super) fn time_to(
        &self,
        scene: &Scene,
        (i, goal, length): (usize, u16, f64),
        known: &mut Option<Leaving>,
    ) -> Option<f64> {
        if known.as_ref().is_none_or(|known| known.goal != goal) {
            *known = Some(self.leaving_to(scene, (i, goal, length), known.as_ref())?);
        }
        let all = self.outlooks_of(scene, i, known.as_ref()?);
        all.into_iter()
            .map(|outlook| outlook.total)
            .reduce(f64::min)
    }
}
