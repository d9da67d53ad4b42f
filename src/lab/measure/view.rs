//! What is visible from a point.

use analysis::site::{Kernel, Site};
use analysis::surroundings::MOST_HIDDEN;
use engine::math::Vector;

/// The visibility from a point outside obstacles.
#[derive(Debug, Clone, Default)]
pub struct View {
    /// The share of the kernel that walls hide.
    hidden: f64,
    /// The walls within reach.
    near: Box<[u32]>,
}

impl View {
    /// The visibility from `p`; `None` inside obstacles.
    pub fn new(site: &Site, kernel: &Kernel, p: Vector) -> Option<Self> {
        if site.is_inside(p) {
            return None;
        }
        let mut near = Vec::new();
        site.walls.near(p, kernel.support_radius, &mut near);
        Some(Self {
            hidden: kernel.share(&site.walls, p, &near),
            near: near.into_boxed_slice(),
        })
    }

    /// The share of the kernel that is visible.
    pub fn visible(&self) -> f64 {
        1.0 - self.hidden.min(MOST_HIDDEN)
    }

    /// Whether `eye` is visible from the point `p` of this view.
    pub fn sees(&self, site: &Site, p: Vector, eye: Vector) -> bool {
        self.near.is_empty() || site.sees(p, eye, &self.near)
    }
}
