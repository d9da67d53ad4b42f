//! The routes out of the room of an agent, and why it takes the one that it does.

use serde::Serialize;

use crate::simulation::{Closed, RouteProspect, Simulation};

/// The choice of an agent between routes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RouteOptions {
    /// The routes out of its room, and to its goal if that is in the room, the quickest first.
    pub routes: Vec<RouteSeen>,
    /// Whether it compares times; else it takes the shortest way that is open.
    pub by_time: bool,
    /// Why it takes its way.
    pub reason: &'static str,
    /// When it compares them again if it has a choice, seconds.
    pub again_at_secs: f64,
    /// How often it has changed its mind.
    pub changes: u32,
}

/// A way, as an agent sees it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RouteSeen {
    /// What it leads through: a door, an opening, or nothing.
    pub through: String,
    /// The length up to there, meters.
    pub length: f64,
    /// Agents that pass the opening before: those that are nearer to it, and those that come from the other side.
    pub ahead: u32,
    /// Its flow, P/s; `None` at the goal, and if no times are compared.
    pub flow_per_sec: Option<f64>,
    /// The time until the agent has passed it, seconds; `None` if the way is closed.
    pub through_secs: Option<f64>,
    /// The time to the goal, seconds; `None` if the way is closed.
    pub total_secs: Option<f64>,
    /// Until when the way is closed, by a door here or beyond.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closed: Option<Closed>,
    /// Whether the shortest way leads there.
    pub shortest: bool,
    /// Whether the agent takes it.
    pub taken: bool,
}

impl RouteOptions {
    /// The choice of agent `i`; `None` if it does not choose between routes.
    pub fn of(simulation: &Simulation, i: usize) -> Option<Self> {
        let decision = simulation.route_decision(i)?;
        let plan = decision.plan;
        let scene = simulation.scene();
        let rooms = scene.rooms()?;
        let name = |way: &RouteProspect| {
            let Some(side) = way.side else {
                return "its goal in this room".to_owned();
            };
            let opening = rooms.opening(side);
            match opening.door() {
                Some(door) => format!("door `{}`", scene.journeys.places[usize::from(door)].name),
                None => {
                    let (width, at) = (opening.width(), opening.middle());
                    format!("opening of {width:.2} m at ({:.2}, {:.2})", at.x, at.y)
                }
            }
        };
        let by_time = scene.by_time();
        let mut prospects = decision.prospects;
        prospects.sort_by(|a, b| a.expected.total_secs.total_cmp(&b.expected.total_secs));
        let is_quickest = prospects
            .first()
            .is_some_and(|best| best.side == plan.toward);
        let routes = prospects.iter().map(|way| {
            let closed = way
                .side
                .and_then(|side| simulation.closed_way(i, plan.goal, Some(side)));
            let (expected, has_times) = (way.expected, by_time && closed.is_none());
            RouteSeen {
                through: name(way),
                length: way.length,
                ahead: expected.ahead,
                flow_per_sec: expected.flow_per_sec.filter(|_| by_time),
                through_secs: Some(expected.through_secs()).filter(|_| has_times),
                total_secs: Some(expected.total_secs).filter(|_| has_times),
                closed,
                shortest: way.side == decision.shortest,
                taken: way.side == plan.toward,
            }
        });
        Some(Self {
            by_time,
            reason: match (prospects.len(), is_quickest) {
                (0 | 1, _) => "there is no other",
                _ if !by_time && plan.toward == decision.shortest => "it is the shortest",
                _ if !by_time => "the shortest is closed",
                (_, true) => "it takes the least time",
                (_, false) => "no other was clearly quicker when the agent last compared them",
            },
            routes: routes.collect(),
            again_at_secs: simulation.frame().clock.time_at(plan.decides_at),
            changes: plan.changes,
        })
    }
}
