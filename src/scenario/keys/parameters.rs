//! The parameters of profiles, and the parts of the engine that they set.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use crate::engine::density::SphParameters;
use crate::engine::forces::goal::GoalForce;
use crate::engine::forces::rvo::Rvo;
use crate::engine::forces::social::SocialForce;
use crate::engine::forces::walking::{DensityAhead, Drag, Headway};
use crate::scenario::keys::limits::{HIGHEST_DENSITY, STRONGEST};

/// The longest range, meters.
const FARTHEST: f64 = 100.0;

/// The kind of navigation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NavigationKind {
    /// Straight to the goal.
    Goal,
    /// Social forces.
    Social,
    /// Velocity obstacles.
    Rvo,
}

/// The kind of walking law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WalkingLawKind {
    /// None: the paper's profiles.
    None,
    /// A time gap to the nearest agent ahead.
    Headway,
    /// Slower the denser the crowd ahead.
    DensityAhead,
    /// Friction by density.
    Drag,
}

/// Parameters of a profile; `None` means the paper's value (§5.5). Where a text says that the paper's time step is too
/// long, Δt = 0.02 s is beyond the formula of `docs/stability.md`, and agents shake; `time_step_secs` `auto` finds the
/// step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Parameters {
    /// K^goal (Eq. 17): the strength of the goal force. Higher: agents push harder toward their goals. Above about 40
    /// the paper's time step is too long.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = GoalForce::default().goal_scale))]
    pub goal_scale: Option<f64>,
    /// τ (Eq. 17), seconds: the time in which the goal force corrects the velocity. Longer: agents respond more slowly
    /// and push less. Below about 0.013 s the paper's time step is too long.
    #[schemars(range(min = 1e-6, max = 1e6), extend("default" = GoalForce::default().relaxation_time))]
    pub relaxation_time: Option<f64>,
    /// V₀ (Eq. 18), m²/s²: the strength of the social force between agents. Higher: they keep more distance; 0: none.
    /// V₀/σ² acts like a stiffness and limits the time step like `agent_stiffness`.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = SocialForce::default().agent_strength))]
    pub agent_strength: Option<f64>,
    /// σ (Eq. 18), meters: the range over which the social force between agents falls by a factor e. Longer: agents
    /// react from farther away, but less strongly when close.
    #[schemars(range(min = 0.01, max = FARTHEST), extend("default" = SocialForce::default().agent_range))]
    pub agent_range: Option<f64>,
    /// T (Eq. 18), seconds: how far ahead the social force looks. Longer: agents avoid collisions earlier; 0: they
    /// react to distances alone.
    #[schemars(range(min = 0, max = 1000), extend("default" = SocialForce::default().anticipation_time))]
    pub anticipation_time: Option<f64>,
    /// U₀ (Eq. 19), m²/s²: the strength of the social force of walls. Higher: agents keep more distance from walls;
    /// 0: none.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = SocialForce::default().wall_strength))]
    pub wall_strength: Option<f64>,
    /// R (Eq. 19), meters: the range over which the social force of walls falls by a factor e. Longer: agents react to
    /// walls from farther away, but less strongly when close.
    #[schemars(range(min = 0.01, max = FARTHEST), extend("default" = SocialForce::default().wall_range))]
    pub wall_range: Option<f64>,
    /// Social forces and RVO ignore agents and walls beyond this distance, meters. Longer: the cost grows with its
    /// square. If it is shorter than the distance walked in `anticipation_time`, agents notice others late.
    #[schemars(range(min = 0.01, max = FARTHEST), extend("default" = SocialForce::default().avoidance_radius))]
    pub avoidance_radius: Option<f64>,
    /// Leaves out social forces that are certainly smaller than this, for an agent of mass 1, m/s². Higher: cheaper
    /// and less exact. 1e-3 moves agents by up to 2 cm in a second and saves up to a third of the time in crowds of
    /// 10,000.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = SocialForce::default().avoidance_tolerance))]
    pub avoidance_tolerance: Option<f64>,
    /// What slows agents in a crowd, beside the paper's forces: `headway`, a time gap to the nearest agent ahead;
    /// `density-ahead`, Weidmann's speed at the density ahead; `drag`, a friction. A law replaces social forces;
    /// with both, agents brake twice.
    #[schemars(extend("default" = "none"))]
    pub walking_law: Option<WalkingLawKind>,
    /// T (`headway`), seconds: the time gap. An agent with d meters to the nearest agent ahead walks at (d - l)/T.
    /// Longer: slower crowds and smaller flows. Below about twice `relaxation_time` files stop and go.
    #[schemars(range(min = 0.01, max = 100), extend("default" = Headway::default().headway_time))]
    pub headway_time: Option<f64>,
    /// l (`headway`), meters: the distance to the nearest agent ahead at which an agent stands. Longer: sparser queues.
    #[schemars(range(min = 0, max = FARTHEST), extend("default" = Headway::default().headway_length))]
    pub headway_length: Option<f64>,
    /// t (`headway`), seconds: agents look at the distance to the nearest agent ahead that they expect after this time.
    /// Longer: faster behind agents that speed up, as before a door; no change in a crowd that moves as one.
    #[schemars(range(min = 0, max = 10), extend("default" = Headway::default().headway_anticipation))]
    pub headway_anticipation: Option<f64>,
    /// w (`headway`), meters: the half-width of the lane; its edges fade over another half of it. Wider: slower crowds.
    #[schemars(range(min = 0.01, max = FARTHEST), extend("default" = Headway::default().lane_half_width))]
    pub lane_half_width: Option<f64>,
    /// The jam density (`density-ahead`), P/m²: agents stand before a crowd of this density. Higher: faster crowds.
    #[schemars(range(min = 0.01, max = HIGHEST_DENSITY), extend("default" = DensityAhead::default().jam_density))]
    pub jam_density: Option<f64>,
    /// Weidmann's γ (`density-ahead`), P/m²: how soon agents slow down. Higher: faster at all densities below the jam.
    #[schemars(range(min = 0.01, max = HIGHEST_DENSITY), extend("default" = DensityAhead::default().slowing_density))]
    pub slowing_density: Option<f64>,
    /// γ₀ (`drag`), m²/s: the friction per density above `drag_from_density`. Higher: slower crowds.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = Drag::default().drag_per_density))]
    pub drag_per_density: Option<f64>,
    /// The density (`drag`), P/m², at which the friction begins. Below 1.55 it slows lone agents, too, whose density is
    /// that of their own mass.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY), extend("default" = Drag::default().drag_from_density))]
    pub drag_from_density: Option<f64>,
    /// w (Eq. 20), meters: the weight of the time to collision in RVO. Higher: agents avoid collisions earlier, with
    /// larger detours; 0: they do not avoid them.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = Rvo::default().collision_weight))]
    pub collision_weight: Option<f64>,
    /// The number of candidate velocities of RVO per agent and coarse frame. The cost grows with it. It is part of the
    /// model: 100 lower the density of the evacuation by 3.7 %, 5000 raise it by 1.6 %.
    #[schemars(range(min = 1, max = 1e6), extend("default" = Rvo::default().candidates))]
    pub candidates: Option<u32>,
    /// μ (Eq. 2), 1/s: the viscosity. Higher: neighbors move together, and a crowd calms down sooner after a push;
    /// 0: none. Above about 40 the paper's time step is too long.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = 0))]
    pub viscosity: Option<f64>,
    /// K^ag (Eq. 22), 1/s²: the stiffness of contacts between agents. Higher: agents overlap less; 0: no contact
    /// force. Above about 2000 the paper's time step is too long. Default: 1000; with SPH 50.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub agent_stiffness: Option<f64>,
    /// K^obs (Eq. 23), 1/s²: the stiffness of contacts with walls. Higher: agents enter walls less deeply; 0: no
    /// contact force. Above about 4000 the paper's time step is too long. Default: 1000; with SPH 200.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub wall_stiffness: Option<f64>,
    /// The part of D_i that counts in contacts between agents. Smaller: shoulders turn, crowds get denser before
    /// overlaps push. Masses, entrances and avoidance keep D_i.
    #[schemars(range(min = 0.1, max = 1), extend("default" = 1))]
    pub contact_scale: Option<f64>,
    /// The part of D_i that counts in contacts with walls. Smaller: more room in narrow doors and corridors.
    #[schemars(range(min = 0.1, max = 1), extend("default" = 1))]
    pub wall_contact_scale: Option<f64>,
    /// h (§5.2), meters: the support radius of the SPH kernels. Larger: smoother densities, at a cost that grows with
    /// its square. At 0.5 m an agent has four neighbors at 5 P/m², too few for a density.
    #[schemars(range(min = 0.01, max = FARTHEST), extend("default" = SphParameters::default().support_radius))]
    pub support_radius: Option<f64>,
    /// k (Eq. 5), m²/s²: the pressure per excess density; pressure alone carries waves at √(k/2). Higher: a stiffer
    /// crowd; 0: no pressure. From about 400 on, crowds between the paper's walls keep boiling at any time step.
    #[schemars(range(min = 0, max = STRONGEST), extend("default" = SphParameters::default().gas_constant))]
    pub gas_constant: Option<f64>,
    /// ρ⁰min, P/m²: the lowest personal rest density. Higher: sparser crowds feel no pressure. If it equals
    /// `rest_density_max`, the rest density is static, and crowds at rest move more.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY), extend("default" = SphParameters::default().rest_density_min))]
    pub rest_density_min: Option<f64>,
    /// ρ⁰max, P/m²: the highest personal rest density; above it, agents are always pushed apart. Higher: denser
    /// crowds. From about 5 on, discs of 0.24 m overlap in any packing.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY), extend("default" = SphParameters::default().rest_density_max))]
    pub rest_density_max: Option<f64>,
    /// T^ρ (Eq. 8), seconds: the time in which the personal rest density adapts. Longer: changes of density cause
    /// pressure for longer. Below Δt it adapts within one frame, and only densities beyond its limits cause pressure.
    #[schemars(range(min = 1e-6, max = 1e6), extend("default" = SphParameters::default().averaging_time))]
    pub averaging_time: Option<f64>,
}

/// A parameter by name.
type Field = (&'static str, fn(&mut Parameters) -> &mut Option<f64>);

/// The parameters of SPH.
pub const SPH: [Field; 5] = [
    ("support_radius", |all| &mut all.support_radius),
    ("gas_constant", |all| &mut all.gas_constant),
    ("rest_density_min", |all| &mut all.rest_density_min),
    ("rest_density_max", |all| &mut all.rest_density_max),
    ("averaging_time", |all| &mut all.averaging_time),
];

impl Parameters {
    /// The values that are given, by name. Those that are not finite count as not given.
    pub fn given(&self) -> Map<String, Value> {
        let Value::Object(mut values) = json!(self) else {
            return Map::new();
        };
        values.retain(|_, value| !value.is_null());
        values
    }

    /// These values, and those of `fallback` where these are `None`.
    pub fn or(&self, fallback: &Self) -> Self {
        let Self {
            goal_scale,
            relaxation_time,
            agent_strength,
            agent_range,
            anticipation_time,
            wall_strength,
            wall_range,
            avoidance_radius,
            avoidance_tolerance,
            walking_law,
            headway_time,
            headway_length,
            headway_anticipation,
            lane_half_width,
            jam_density,
            slowing_density,
            drag_per_density,
            drag_from_density,
            collision_weight,
            candidates,
            viscosity,
            agent_stiffness,
            wall_stiffness,
            contact_scale,
            wall_contact_scale,
            support_radius,
            gas_constant,
            rest_density_min,
            rest_density_max,
            averaging_time,
        } = *self;
        Self {
            goal_scale: finite(goal_scale).or(fallback.goal_scale),
            relaxation_time: finite(relaxation_time).or(fallback.relaxation_time),
            agent_strength: finite(agent_strength).or(fallback.agent_strength),
            agent_range: finite(agent_range).or(fallback.agent_range),
            anticipation_time: finite(anticipation_time).or(fallback.anticipation_time),
            wall_strength: finite(wall_strength).or(fallback.wall_strength),
            wall_range: finite(wall_range).or(fallback.wall_range),
            avoidance_radius: finite(avoidance_radius).or(fallback.avoidance_radius),
            avoidance_tolerance: finite(avoidance_tolerance).or(fallback.avoidance_tolerance),
            walking_law: walking_law.or(fallback.walking_law),
            headway_time: finite(headway_time).or(fallback.headway_time),
            headway_length: finite(headway_length).or(fallback.headway_length),
            headway_anticipation: finite(headway_anticipation).or(fallback.headway_anticipation),
            lane_half_width: finite(lane_half_width).or(fallback.lane_half_width),
            jam_density: finite(jam_density).or(fallback.jam_density),
            slowing_density: finite(slowing_density).or(fallback.slowing_density),
            drag_per_density: finite(drag_per_density).or(fallback.drag_per_density),
            drag_from_density: finite(drag_from_density).or(fallback.drag_from_density),
            collision_weight: finite(collision_weight).or(fallback.collision_weight),
            candidates: candidates.or(fallback.candidates),
            viscosity: finite(viscosity).or(fallback.viscosity),
            agent_stiffness: finite(agent_stiffness).or(fallback.agent_stiffness),
            wall_stiffness: finite(wall_stiffness).or(fallback.wall_stiffness),
            contact_scale: finite(contact_scale).or(fallback.contact_scale),
            wall_contact_scale: finite(wall_contact_scale).or(fallback.wall_contact_scale),
            support_radius: finite(support_radius).or(fallback.support_radius),
            gas_constant: finite(gas_constant).or(fallback.gas_constant),
            rest_density_min: finite(rest_density_min).or(fallback.rest_density_min),
            rest_density_max: finite(rest_density_max).or(fallback.rest_density_max),
            averaging_time: finite(averaging_time).or(fallback.averaging_time),
        }
    }

    /// The SPH parameters that all profiles of a blend share.
    pub fn sph(&self) -> SphParameters {
        let paper = SphParameters::default();
        SphParameters {
            support_radius: finite(self.support_radius).unwrap_or(paper.support_radius),
            gas_constant: finite(self.gas_constant).unwrap_or(paper.gas_constant),
            rest_density_min: finite(self.rest_density_min).unwrap_or(paper.rest_density_min),
            rest_density_max: finite(self.rest_density_max).unwrap_or(paper.rest_density_max),
            averaging_time: finite(self.averaging_time).unwrap_or(paper.averaging_time),
        }
    }

    /// The goal force.
    pub fn goal(&self) -> GoalForce {
        let paper = GoalForce::default();
        GoalForce {
            goal_scale: finite(self.goal_scale).unwrap_or(paper.goal_scale),
            relaxation_time: finite(self.relaxation_time).unwrap_or(paper.relaxation_time),
        }
    }

    /// Social forces.
    pub fn social(&self) -> SocialForce {
        let paper = SocialForce::default();
        SocialForce {
            agent_strength: finite(self.agent_strength).unwrap_or(paper.agent_strength),
            agent_range: finite(self.agent_range).unwrap_or(paper.agent_range),
            anticipation_time: finite(self.anticipation_time).unwrap_or(paper.anticipation_time),
            wall_strength: finite(self.wall_strength).unwrap_or(paper.wall_strength),
            wall_range: finite(self.wall_range).unwrap_or(paper.wall_range),
            avoidance_radius: finite(self.avoidance_radius).unwrap_or(paper.avoidance_radius),
            avoidance_tolerance: finite(self.avoidance_tolerance)
                .unwrap_or(paper.avoidance_tolerance),
        }
    }

    /// RVO.
    pub fn rvo(&self) -> Rvo {
        let paper = Rvo::default();
        Rvo {
            collision_weight: finite(self.collision_weight).unwrap_or(paper.collision_weight),
            candidates: self.candidates.unwrap_or(paper.candidates),
            avoidance_radius: finite(self.avoidance_radius).unwrap_or(paper.avoidance_radius),
        }
    }

    /// The time gap.
    pub fn headway(&self) -> Headway {
        let paper = Headway::default();
        Headway {
            headway_time: finite(self.headway_time).unwrap_or(paper.headway_time),
            headway_length: finite(self.headway_length).unwrap_or(paper.headway_length),
            lane_half_width: finite(self.lane_half_width).unwrap_or(paper.lane_half_width),
            headway_anticipation: finite(self.headway_anticipation)
                .unwrap_or(paper.headway_anticipation),
        }
    }

    /// The law of the density ahead.
    pub fn density_ahead(&self) -> DensityAhead {
        let paper = DensityAhead::default();
        DensityAhead {
            jam_density: finite(self.jam_density).unwrap_or(paper.jam_density),
            slowing_density: finite(self.slowing_density).unwrap_or(paper.slowing_density),
        }
    }

    /// The drag.
    pub fn drag(&self) -> Drag {
        let paper = Drag::default();
        Drag {
            drag_per_density: finite(self.drag_per_density).unwrap_or(paper.drag_per_density),
            drag_from_density: finite(self.drag_from_density).unwrap_or(paper.drag_from_density),
        }
    }
}

/// A value, if it is a finite number: others count as not given.
fn finite(given: Option<f64>) -> Option<f64> {
    given.filter(|value| value.is_finite())
}
