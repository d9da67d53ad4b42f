//! Changes to the room (§6.1), one at a time.

use serde_json::json;

use super::geometry::Room;
use crate::lab::reproduce::case::Case;

/// A change to the room.
#[derive(Debug, Clone, Copy)]
pub struct Variant {
    /// Its name in tables.
    pub name: &'static str,
    /// Another wall, if it changes.
    room: Option<Room>,
    /// Other settings.
    settings: &'static [(&'static str, &'static str)],
}

/// No change.
pub const SHIPPED: Variant = set("as in Table 1", &[]);
/// Approximates a repulsion by both edges of a corner: twice the wall strength.
pub const TWICE: Variant = set("walls repel twice as much (U₀ = 4.2)", &[U0_TWICE]);
const U0_TWICE: (&str, &str) = ("wall_strength", "4.2");
/// Three times the wall strength.
pub const THRICE: Variant = set("three times (U₀ = 6.3)", &[("wall_strength", "6.3")]);
/// Twice the wall strength, and a doorway too short to stand in.
pub const THIN_TWICE: Variant = Variant {
    settings: &[U0_TWICE],
    ..room("wall 0.1 m thick and U₀ = 4.2", 0.1, 0.0)
};
/// Start positions off the grid.
pub const JITTER: Variant = set(
    "starts ± 0.25 m off the grid",
    &[("grids.0.jitter", "0.25")],
);
/// Forward Euler, as the paper's text says.
pub const EULER: Variant = set("forward Euler", &[("integrator", "forward-euler")]);
/// Half the time step.
pub const FINE: Variant = set("Δt = 0.01 s", &[("time_step_secs", "0.01")]);
/// Weaker contact with walls.
pub const SOFT_WALLS: Variant = set("K^obs = 250", &[("wall_stiffness", "250")]);
/// Rounded jambs.
pub const ROUND: Variant = room("jambs rounded with 0.5 m", 1.0, 0.5);
/// Walls of other thickness.
pub const WALLS: [Variant; 4] = [
    room("wall 0.1 m thick", 0.1, 0.0),
    room("wall 0.3 m thick", 0.3, 0.0),
    room("wall 1.5 m thick", 1.5, 0.0),
    room("wall 2 m thick", 2.0, 0.0),
];

const fn set(name: &'static str, settings: &'static [(&'static str, &'static str)]) -> Variant {
    Variant {
        name,
        room: None,
        settings,
    }
}

const fn room(name: &'static str, thickness: f64, rounding: f64) -> Variant {
    Variant {
        name,
        room: Some(Room {
            thickness,
            rounding,
        }),
        settings: &[],
    }
}

impl Variant {
    /// `case` with the changes.
    pub fn of(&self, mut case: Case) -> Case {
        if let Some(room) = self.room {
            case = case
                .set("obstacles", json!(room.obstacles()))
                .set("goal", json!(room.goal()));
        }
        let changes = self.settings.iter();
        changes.fold(case, |case, (key, value)| case.set(key, value))
    }
}

/// Changes that might affect the density with RVO.
pub const AVOIDING: [Variant; 9] = [
    SHIPPED,
    set("1000 candidates", &[("candidates", "1000")]),
    set("50 candidates", &[("candidates", "50")]),
    set("w = 0.5", &[("collision_weight", "0.5")]),
    set("neighbors within 2.5 m", &[("avoidance_radius", "2.5")]),
    set("RVO in every fine frame", &[("coarse_every", "1")]),
    EULER,
    WALLS[0],
    JITTER,
];

/// Changes that might make the density of the blend of SF and SPH more even.
pub const BLENDING: [Variant; 9] = [
    SHIPPED,
    set("K^ag = 100", &[("agent_stiffness", "100")]),
    set("K^ag = 200", &[("agent_stiffness", "200")]),
    set("SF alone up to 1 P/m², not 2", &[("profile", SF_TO_1)]),
    set("SPH alone from 3 P/m², not 4", &[("profile", SPH_FROM_3)]),
    set("looks 1 s ahead, not 2", &[("anticipation_time", "1")]),
    set("T^ρ = 0.5 s", &[("averaging_time", "0.5")]),
    set("exact walls", &[("wall_method", "exact")]),
    EULER,
];
const SF_TO_1: &str =
    r#"{"blend": [{"at_density": 1, "profile": "sf"}, {"at_density": 4, "profile": "sph"}]}"#;
const SPH_FROM_3: &str =
    r#"{"blend": [{"at_density": 2, "profile": "sf"}, {"at_density": 3, "profile": "sph"}]}"#;
