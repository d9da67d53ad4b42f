//! The forces of walls on an agent, wall by wall.

use super::{Blend, Override, feels_contact, feels_sph};
use crate::boundary::WallMethod;
use crate::forces::{contact, pressure};
use crate::frame::Frame;
use crate::math::Vector;

impl Blend {
    /// Passes `take` each wall that presses on agent `i` of a frozen frame and the acceleration by it, m/s²: pressure
    /// (Eq. 12) and contact (Eq. 23) of all active profiles, weighted. A wall may come several times.
    pub fn each_wall_push(
        &self,
        frame: &Frame,
        i: usize,
        (changed, method): (Option<&Override>, WallMethod),
        mut take: impl FnMut(u32, Vector),
    ) {
        let near = frame.neighbors.near_walls(i);
        if near.is_empty() {
            return;
        }
        let (r_i, h) = (frame.agents.position[i], self.sph.support_radius);
        for (profile, weight) in self.acting(frame, i) {
            if profile.pressure && feels_sph(changed) {
                method.shares(frame.walls, near, r_i, h, |share| {
                    let push = pressure::from_walls(frame, i, share.gradient);
                    take(share.wall, push * weight);
                });
            }
            if profile.contact.wall_stiffness.is_some() && feels_contact(changed) {
                for &wall in near {
                    let push = contact::from_walls(frame, i, &[wall], &profile.contact);
                    if push != Vector::zeros() {
                        take(wall, push * weight);
                    }
                }
            }
        }
    }
}
