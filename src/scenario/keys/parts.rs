//! The parts of the engine that the parameters of profiles set.

use super::parameters::{Parameters, finite};
use engine::density::SphParameters;
use engine::forces::goal::GoalForce;
use engine::forces::legs::Legs;
use engine::forces::rvo::Rvo;
use engine::forces::social::SocialForce;
use engine::forces::walking::headings::Gap;
use engine::forces::walking::{DensityAhead, Drag, Headings, Headway};

impl Parameters {
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

    /// The legs under a body.
    pub fn legs_law(&self) -> Legs {
        let paper = Legs::default();
        Legs {
            unbalancing_rate: finite(self.unbalancing_rate).unwrap_or(paper.unbalancing_rate),
            balancing_rate: finite(self.balancing_rate).unwrap_or(paper.balancing_rate),
            balance_speed: finite(self.balance_speed).unwrap_or(paper.balance_speed),
            legs_strength: finite(self.legs_strength).unwrap_or(paper.legs_strength),
            body_range: finite(self.body_range).unwrap_or(paper.body_range),
            leg_range: finite(self.leg_range).unwrap_or(paper.leg_range),
            legs_reach: finite(self.legs_reach).unwrap_or(paper.legs_reach),
            lean_limit: finite(self.lean_limit).unwrap_or(paper.lean_limit),
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

    /// The choice of headings.
    pub fn headings(&self) -> Headings {
        let of = Headings::default();
        Headings {
            headway: self.headway(),
            gap: self.gap(),
            heading_angle: finite(self.heading_angle).unwrap_or(of.heading_angle),
            heading_half_width: finite(self.heading_half_width).unwrap_or(of.heading_half_width),
            look_ahead: finite(self.look_ahead).unwrap_or(of.look_ahead),
            heading_persistence: finite(self.heading_persistence).unwrap_or(of.heading_persistence),
            side_preference: finite(self.side_preference).unwrap_or(of.side_preference),
            evasion_time: finite(self.evasion_time).unwrap_or(of.evasion_time),
        }
    }

    /// How the time gap depends on motivation, density and narrowings.
    fn gap(&self) -> Gap {
        let paper = Gap::default();
        Gap {
            hurry_share: finite(self.hurry_share).unwrap_or(paper.hurry_share),
            press_share: finite(self.press_share).unwrap_or(paper.press_share),
            press_density: finite(self.press_density).unwrap_or(paper.press_density),
            press_range: finite(self.press_range).unwrap_or(paper.press_range),
            queue_share: finite(self.queue_share).unwrap_or(paper.queue_share),
            queue_density: finite(self.queue_density).unwrap_or(paper.queue_density),
            narrowing_share: finite(self.narrowing_share).unwrap_or(paper.narrowing_share),
            narrowing_range: finite(self.narrowing_range).unwrap_or(paper.narrowing_range),
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
