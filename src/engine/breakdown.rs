//! One agent, term by term: the engine's own force functions on the frozen frame, laid open.

mod text;

use serde::Serialize;

use crate::engine::boundary::WallShare;
use crate::engine::density::mean_density_before;
use crate::engine::math::Vector;
use crate::engine::profile::Terms;
use crate::engine::simulation::{Fault, Simulation};

/// Everything that acts on one agent in one frame. Accelerations in m/s², each term's own share
/// (already divided by mass or density, not yet weighted).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Breakdown {
    /// The agent.
    pub id: u32,
    /// r_i, metres.
    pub position: [f64; 2],
    /// v_i, m/s.
    pub velocity: [f64; 2],
    /// D_i, metres.
    pub radius: f64,
    /// m_i.
    pub mass: f64,
    /// g_i, metres.
    pub goal: [f64; 2],
    /// ρ_i, P/m².
    pub density: f64,
    /// The agents' part of ρ_i, P/m².
    pub density_from_agents: f64,
    /// The walls' part of ρ_i, P/m².
    pub density_from_walls: f64,
    /// ρ̂_i, P/m².
    pub mean_density: f64,
    /// ρ_i⁰, P/m².
    pub rest_density: f64,
    /// p_i.
    pub pressure: f64,
    /// a_i: the weighted sum of the profiles' terms.
    pub acceleration: [f64; 2],
    /// The profiles that act, with their weights.
    pub profiles: Vec<ProfileShare>,
    /// Agents within the support radius, the nearest first.
    pub neighbors: Vec<Neighbor>,
    /// Walls that hide a part of the kernel.
    pub walls: Vec<WallTerm>,
}

/// One profile's part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProfileShare {
    /// The profile.
    pub name: String,
    /// Its weight in the blend; all weights sum to 1.
    pub weight: f64,
    /// Its terms.
    #[serde(serialize_with = "serialize_terms")]
    pub accelerations: Terms,
}

/// A neighbour in SPH.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Neighbor {
    /// Its id.
    pub id: u32,
    /// |r_ij|, metres.
    pub distance: f64,
}

/// A wall in SPH.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WallTerm {
    /// The wall's number.
    pub wall: u32,
    /// r_k*, metres.
    pub nearest_point: [f64; 2],
    /// r_k^o, metres; `None` for the exact wall methods.
    pub representative_point: Option<[f64; 2]>,
    /// a(P_k), m².
    pub hidden_area: f64,
    /// ρ_k^wall, P/m².
    pub density: f64,
    /// Its part of the pressure acceleration, m/s².
    pub pressure_acceleration: [f64; 2],
}

impl Breakdown {
    /// Lays open agent `i` of an evaluated frame; `None` if the frame has no density (see
    /// [`Simulation::request_density_until`]).
    pub fn of(simulation: &Simulation, i: usize) -> Option<Self> {
        let frame = simulation.frame();
        let (agents, fields) = (frame.agents, frame.fields);
        let density = *fields.density.get(i)?;
        let blend = simulation.blend(i);
        let h = blend.sph.support_radius;
        let changed = simulation.change(i);
        let profiles = blend
            .acting(&frame, i)
            .map(|(profile, weight)| ProfileShare {
                name: profile.name.clone(),
                weight,
                accelerations: profile.terms(&frame, i, changed),
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
            neighbors,
            walls: wall_terms(simulation, i),
        })
    }

    /// Lays open the agent that a fault names, in the frame that cannot be left; `None` if the fault names
    /// nobody who is there.
    pub fn of_fault(simulation: &mut Simulation, fault: &Fault) -> Option<Self> {
        let &Fault::NotFinite { agent, .. } = fault else {
            return None;
        };
        simulation.evaluate_with_density().ok()?;
        let i = simulation.frame().agents.index_of(agent)?;
        Self::of(simulation, i)
    }

    /// Σ weight × term over all profiles: [`acceleration`](Self::acceleration) to rounding.
    pub fn weighted_sum(&self) -> Vector {
        self.profiles
            .iter()
            .map(|share| share.accelerations.sum() * share.weight)
            .sum()
    }
}

fn wall_terms(simulation: &Simulation, i: usize) -> Vec<WallTerm> {
    let frame = simulation.frame();
    let (fields, r_i) = (frame.fields, frame.agents.position[i]);
    let from_agents = fields.density[i] - fields.density_from_walls[i];
    let sph = &simulation.blend(i).sph;
    let rest_density_before = sph.rest_density(mean_density_before(&frame, i, from_agents));
    let feels_pressure = fields.density[i] >= fields.rest_density[i];
    let mut terms = Vec::new();
    let take = |share: WallShare| {
        let force = share.gradient * (-fields.pressure[i] / fields.density[i]);
        terms.push(WallTerm {
            wall: share.wall,
            nearest_point: frame.walls.wall(share.wall).nearest_point(r_i).point.into(),
            representative_point: share.representative_point.map(Into::into),
            hidden_area: share.hidden_area,
            density: rest_density_before * share.kernel,
            pressure_acceleration: if feels_pressure {
                force.into()
            } else {
                [0.0; 2]
            },
        });
    };
    let candidates = frame.neighbors.near_walls(i);
    let method = simulation.scene().wall_method;
    method.shares(frame.walls, candidates, r_i, sph.support_radius, take);
    terms
}

fn serialize_terms<S: serde::Serializer>(terms: &Terms, serializer: S) -> Result<S::Ok, S::Error> {
    let present = terms.listed().into_iter();
    serializer.collect_map(
        present.filter_map(|(term, value)| Some((term.name(), <[f64; 2]>::from(value?)))),
    )
}
