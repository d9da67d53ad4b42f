//! The region of an agent's kernel behind one wall (P_k, §4.3), in closed form.
//!
//! Plain form: `hidden_region` in `examples/paper.rs`.

use super::Wall;
use crate::math::{Vector, perpendicular};
use libm::{atan2, cos, sin, tan};

/// Rounding error of an angle after a full turn and back, radians. A part that ends within this of the whole
/// region's end takes that end, which is known exactly (tan is steep close to a wall).
const ANGLE_ROUNDING: f64 = 1e-12;

/// Smallest distance between an agent and a wall, meters; smaller distances are clamped to it. At 0 all
/// directions meet the wall at one point, so its parts cannot be distinguished; at −0 the directions are reversed.
const LEAST_DISTANCE: f64 = 1e-9;

/// The part of the disc of radius h around an agent that one wall, or a part of it, hides.
///
/// In the agent's frame the wall lies on the line at `distance` along `towards`. The region lies behind the
/// stretch `from..to` of this line, measured along `along` from the foot of the perpendicular.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HiddenRegion {
    /// Unit normal from the agent toward the wall.
    pub towards: Vector,
    /// Unit vector along the wall: `towards` turned counterclockwise by a right angle.
    pub along: Vector,
    /// Distance d from the agent to the wall's line, 0 < d < h.
    pub distance: f64,
    /// Start of the stretch, meters along `along`.
    pub from: f64,
    /// End of the stretch, meters along `along`; `from` < `to`.
    pub to: f64,
    /// Support radius h of the kernel, meters.
    pub support_radius: f64,
    /// See [`angles`](Self::angles): an arctangent costs as much as all the rest.
    angles: [f64; 2],
}

/// The angles of a stretch of a line `distance` meters away; the line of a long wall crosses the disc from rim to rim,
/// and takes only one arctangent.
fn angles_of([from, to]: [f64; 2], distance: f64) -> [f64; 2] {
    let last = atan2(to, distance);
    let first = match from == -to {
        true => -last,
        false => atan2(from, distance),
    };
    [first, last]
}

impl HiddenRegion {
    /// The region that `wall` hides from an agent at `r_i`; `None` if the agent is behind the wall or out of
    /// reach.
    pub fn behind(wall: &Wall, r_i: Vector, support_radius: f64) -> Option<Self> {
        let distance = wall.signed_distance(r_i);
        if !(0.0..support_radius).contains(&distance) {
            return None;
        }
        let distance = distance.max(LEAST_DISTANCE);
        let towards = -wall.normal;
        let along = perpendicular(towards);
        let half_chord = (support_radius * support_radius - distance * distance).sqrt();
        let from = (wall.end - r_i).dot(&along).max(-half_chord);
        let to = (wall.start - r_i).dot(&along).min(half_chord);
        if from >= to {
            return None;
        }
        let region = Self {
            towards,
            along,
            distance,
            from,
            to,
            support_radius,
            angles: angles_of([from, to], distance),
        };
        (region.angle() > 0.0).then_some(region)
    }

    /// The angles [t1, t2] of the stretch, counterclockwise from `towards`, radians.
    pub fn angles(&self) -> [f64; 2] {
        self.angles
    }

    /// r_k* − r_i, meters. Not computed as the difference of two points: when the agent stands on the wall,
    /// rounding would decide its direction.
    pub fn to_nearest(&self) -> Vector {
        self.towards * self.distance + self.along * 0.0_f64.clamp(self.from, self.to)
    }

    fn angle(&self) -> f64 {
        let [t1, t2] = self.angles();
        t2 - t1
    }

    /// The part of this region between two angles, which must lie within [`angles`](Self::angles).
    pub fn between(&self, t1: f64, t2: f64) -> Self {
        let [own_t1, own_t2] = self.angles();
        let mut part = *self;
        if t1 > own_t1 + ANGLE_ROUNDING {
            part.from = (self.distance * tan(t1)).max(self.from);
        }
        if t2 < own_t2 - ANGLE_ROUNDING {
            part.to = (self.distance * tan(t2)).min(self.to);
        }
        part.angles = angles_of([part.from, part.to], self.distance);
        part
    }

    /// a(P_k) = ½ [h²(t2 − t1) − d²(tan t2 − tan t1)] in m²: sector minus triangle.
    pub fn area(&self) -> f64 {
        let h = self.support_radius;
        0.5 * (h * h * self.angle() - self.distance * (self.to - self.from))
    }

    /// The region's outline, closed, for an agent at `r_i`: along the wall, then back along the arc.
    pub fn outline(&self, r_i: Vector, arc_steps: usize) -> Vec<Vector> {
        let [t1, t2] = self.angles();
        let wall = [self.from, self.to].map(|s| self.towards * self.distance + self.along * s);
        let arc = (0..=arc_steps).map(|step| {
            let t = t2 + (t1 - t2) * step as f64 / arc_steps as f64;
            (self.towards * cos(t) + self.along * sin(t)) * self.support_radius
        });
        let mut outline: Vec<Vector> = wall.into_iter().chain(arc).map(|p| r_i + p).collect();
        outline.push(outline[0]);
        outline
    }
}
