//! The acceleration of one agent, term by term, computed with the engine's force functions on the frozen frame.

mod heading;
mod openings;
mod text;
mod visit;

pub use heading::{HeadingChoice, HeadingSeen};
pub use openings::{RouteOptions, RouteSeen};
pub use visit::{Alternative, Doing, Visit, Why};

use serde::Serialize;

use crate::boundary::WallShare;
use crate::density::mean_density_before;
use crate::forces::own::Force;
use crate::forces::pressure;
use crate::math::{Vector, direction};
use crate::profile::Terms;
use crate::simulation::{Fault, Simulation};

/// Everything that acts on one agent in one frame. Accelerations are in m/s², divided by mass or density; the
/// terms of a profile are not weighted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Breakdown {
    /// The agent.
    pub id: u32,
    /// r_i, meters.
    pub position: [f64; 2],
    /// v_i, m/s.
    pub velocity: [f64; 2],
    /// D_i, meters.
    pub radius: f64,
    /// m_i.
    pub mass: f64,
    /// g_i, meters; the start of an agent that walks in a direction.
    pub goal: [f64; 2],
    /// ρ_i, P/m².
    pub density: f64,
    /// The part of ρ_i from agents, P/m².
    pub density_from_agents: f64,
    /// The part of ρ_i from walls, P/m².
    pub density_from_walls: f64,
    /// ρ̂_i, P/m².
    pub mean_density: f64,
    /// ρ_i⁰, P/m².
    pub rest_density: f64,
    /// p_i, 1/s².
    pub pressure: f64,
    /// a_i: the weighted sum of the terms of all profiles, plus the forces on all agents.
    pub acceleration: [f64; 2],
    /// The active profiles with their weights.
    pub profiles: Vec<ProfileShare>,
    /// Its way around walls; `None` if it walks straight toward its goal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub way: Option<RouteLeft>,
    /// The routes between which it chooses; `None` if it takes the shortest one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub route_choice: Option<RouteOptions>,
    /// When it begins to walk, seconds; `None` if it already walks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub walks_from_secs: Option<f64>,
    /// The place that it visits; `None` without a journey.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub visit: Option<Visit>,
    /// The headings between which it chooses; `None` without the walking law `headings`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub choice: Option<HeadingChoice>,
    /// The states that forces keep for it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub states: Vec<ForceState>,
    /// The forces on all agents that are no forces of a profile.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub own_forces: Vec<OwnForce>,
    /// Agents within the support radius, nearest first.
    pub neighbors: Vec<Neighbor>,
    /// Walls that hide a part of the kernel.
    pub walls: Vec<WallTerm>,
}

/// The contribution of one profile.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProfileShare {
    /// Name of the profile.
    pub name: String,
    /// Weight in the blend. All weights sum to 1.
    pub weight: f64,
    /// Its terms, not weighted.
    #[serde(serialize_with = "serialize_terms")]
    pub accelerations: Terms,
}

/// The rest of an agent's way.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RouteLeft {
    /// Its length, meters; `None` if the agent has no path map and walks straight.
    pub length: Option<f64>,
    /// The next corner, or the end, meters.
    pub next: [f64; 2],
    /// The direction in which the agent wants to walk.
    pub heading: [f64; 2],
    /// The corners on the way in order, then its end, meters.
    pub corners: Vec<[f64; 2]>,
}

/// A force on all agents.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OwnForce {
    /// Its name.
    pub name: String,
    /// Its acceleration, m/s².
    pub acceleration: [f64; 2],
}

/// The state that a force keeps for an agent.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ForceState {
    /// The name of the force.
    pub force: String,
    /// Its numbers, and what follows from them, by name; units are those of trajectories.
    pub values: Vec<(&'static str, f64)>,
    /// What explains them, such as the accelerations of legs, m/s².
    pub vectors: Vec<(String, [f64; 2])>,
}

/// An SPH neighbor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Neighbor {
    /// Its id.
    pub id: u32,
    /// |r_ij|, meters.
    pub distance: f64,
}

/// A wall that contributes to SPH.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WallTerm {
    /// Index of the wall.
    pub wall: u32,
    /// r_k*, meters.
    pub nearest_point: [f64; 2],
    /// r_k^o, meters; `None` for the exact wall methods.
    pub representative_point: Option<[f64; 2]>,
    /// a(P_k), m².
    pub hidden_area: f64,
    /// ρ_k^wall, P/m².
    pub density: f64,
    /// Pressure acceleration by the wall, m/s².
    pub pressure_acceleration: [f64; 2],
}

impl Breakdown {
    /// The breakdown of agent `i` of an evaluated frame; `None` if the frame has no density (see
    /// [`Simulation::request_density_until`]).
    pub fn of(simulation: &Simulation, i: usize) -> Option<Self> {
        let frame = simulation.frame();
        let (agents, fields) = (frame.agents, frame.fields);
        let density = *fields.density.get(i)?;
        let blend = simulation.blend(i);
        let h = blend.sph.support_radius;
        let changed = simulation.change(i);
        let is_replaced = simulation.scene().is_replaced();
        let profiles = blend
            .acting(&frame, i)
            .filter(|_| !is_replaced)
            .map(|(profile, weight)| ProfileShare {
                name: profile.name.clone(),
                weight,
                accelerations: profile.terms(&frame, i, changed),
            });
        let own_forces = simulation.scene().own_forces.iter();
        let own_forces = own_forces.map(|force| OwnForce {
            name: force.name().to_owned(),
            acceleration: force.acceleration(&frame, i).into(),
        });
        let mut neighbors: Vec<Neighbor> = frame
            .near(i, h)
            .map(|(j, r_ij)| Neighbor {
                id: agents.id[j],
                distance: r_ij.norm(),
            })
            .collect();
        neighbors.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.id.cmp(&b.id)));
        Some(Self {
            id: agents.id[i],
            position: agents.position[i].into(),
            velocity: agents.velocity[i].into(),
            radius: agents.radius[i],
            mass: agents.mass[i],
            goal: agents.goal[i].into(),
            density,
            density_from_agents: density - fields.density_from_walls[i],
            density_from_walls: fields.density_from_walls[i],
            mean_density: fields.mean_density[i],
            rest_density: fields.rest_density[i],
            pressure: fields.pressure[i],
            acceleration: fields.acceleration[i].into(),
            profiles: profiles.collect(),
            way: route_left(simulation, i),
            route_choice: RouteOptions::of(simulation, i),
            walks_from_secs: (agents.walks_from.get(i).copied())
                .filter(|&from| frame.clock.time() < from),
            visit: Visit::of(simulation, i),
            choice: HeadingChoice::of(simulation, i),
            states: states(simulation, i),
            own_forces: own_forces.collect(),
            neighbors,
            walls: wall_terms(simulation, i),
        })
    }

    /// The breakdown of the agent that a fault names, in the frame of the fault; `None` if the fault names no agent
    /// of that frame.
    pub fn of_fault(simulation: &mut Simulation, fault: &Fault) -> Option<Self> {
        let &Fault::NotFinite { agent, .. } = fault else {
            return None;
        };
        simulation.evaluate_with_density().ok()?;
        let i = simulation.frame().agents.index_of(agent)?;
        Self::of(simulation, i)
    }

    /// Σ weight × term over all profiles, plus the forces on all agents. Equals
    /// [`acceleration`](Self::acceleration) up to rounding.
    pub fn weighted_sum(&self) -> Vector {
        let own_forces = self.own_forces.iter();
        let profiles = self.profiles.iter();
        let profiles = profiles.map(|share| share.accelerations.sum() * share.weight);
        profiles.sum::<Vector>()
            + own_forces
                .map(|force| Vector::from(force.acceleration))
                .sum::<Vector>()
    }
}

/// The rest of the way of agent `i`, if the scene has path maps: to its spot if it stands in a queue or waits, else to
/// its place or goal.
fn route_left(simulation: &Simulation, i: usize) -> Option<RouteLeft> {
    let (agents, routes) = (
        simulation.frame().agents,
        simulation.scene().routes.as_ref()?,
    );
    let route = agents.route.get(i)?.as_ref()?;
    let position = agents.position[i];
    let trip = agents.trip.get(i).and_then(Option::as_ref);
    if let Some(spot) = trip.and_then(|trip| trip.hold) {
        return Some(RouteLeft {
            length: Some((spot - position).norm()),
            next: spot.into(),
            heading: direction(spot - position).into(),
            corners: vec![spot.into()],
        });
    }
    let corners = routes.course_of(route);
    // The route has the length from where the agent last looked for it.
    let from = std::iter::once(&position).chain(&corners);
    let legs = from.zip(&corners).map(|(from, to)| (to - from).norm());
    Some(RouteLeft {
        length: route.length().is_finite().then(|| legs.sum()),
        next: routes.next(route).into(),
        heading: direction(agents.aim[i] - position).into(),
        corners: corners.into_iter().map(Into::into).collect(),
    })
}

fn states(simulation: &Simulation, i: usize) -> Vec<ForceState> {
    let frame = simulation.frame();
    let agents = frame.agents;
    let of_force = |force: &dyn Force| {
        let values = force.values(agents.position[i], agents.state(force.name(), i)?);
        let names = force.shown().iter().map(|shown| shown.name);
        let vectors = force.explained(&frame, i).into_iter();
        Some(ForceState {
            force: force.name().to_owned(),
            values: names.zip(values).collect(),
            vectors: vectors
                .map(|(name, v)| (name.to_owned(), v.into()))
                .collect(),
        })
    };
    simulation.forces(i).filter_map(of_force).collect()
}

fn wall_terms(simulation: &Simulation, i: usize) -> Vec<WallTerm> {
    let frame = simulation.frame();
    let (agents, fields) = (frame.agents, frame.fields);
    let r_i = agents.position[i];
    let from_agents = fields.density[i] - fields.density_from_walls[i];
    let sph = &simulation.blend(i).sph;
    let before = mean_density_before(agents.kept_mean_density(i), from_agents);
    let mut terms = Vec::new();
    let take = |share: WallShare| {
        terms.push(WallTerm {
            wall: share.wall,
            nearest_point: frame.walls.wall(share.wall).nearest_point(r_i).point.into(),
            representative_point: share.representative_point.map(Into::into),
            hidden_area: share.hidden_area,
            density: sph.rest_density(before) * share.kernel,
            pressure_acceleration: pressure::from_walls(&frame, i, share.gradient).into(),
        });
    };
    let candidates = frame.neighbors.near_walls(i);
    let method = simulation.scene().wall_method;
    method.shares(frame.walls, candidates, r_i, sph.support_radius, take);
    terms
}

fn serialize_terms<S: serde::Serializer>(terms: &Terms, serializer: S) -> Result<S::Ok, S::Error> {
    let listed = terms.listed();
    serializer.collect_map(listed.map(|(name, value)| (name, <[f64; 2]>::from(value))))
}
