//! Where people walk: what walls hide of a kernel, for people and for places.

use crate::engine::boundary::WallMethod;
use crate::engine::geometry::{Polygon, Walls};
use crate::engine::math::Vector;

/// Obstacles, with a quick answer to who is inside one.
#[derive(Debug, Clone)]
pub struct Site {
    walls: Walls,
    /// The corners of each obstacle's bounding box, which may be the whole plane.
    bounds: Vec<[Vector; 2]>,
}

/// The kernel that measures, and how walls enter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kernel {
    /// h, metres.
    pub support_radius: f64,
    /// How the integral over what walls hide is taken.
    pub walls: WallMethod,
}

/// What walls hide from somebody.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hidden {
    /// Σ_k ∫ W over P_k, the part of the kernel behind walls.
    pub share: f64,
    /// Where the person looks from and is seen, metres: where he stands or, inside an obstacle, the nearest
    /// free point, for recorded heads lean over walls. Who is farther inside than h sees no walls.
    pub eye: Vector,
    /// How far inside an obstacle the person is, metres.
    pub inside: Option<f64>,
}

impl Site {
    /// Round these obstacles.
    pub fn new(obstacles: Vec<Polygon>) -> Self {
        let bounds = obstacles.iter().map(|obstacle| {
            if obstacle.is_unbounded() {
                return [f64::NEG_INFINITY, f64::INFINITY].map(Vector::repeat);
            }
            let corners = obstacle.points();
            let first = [corners[0]; 2];
            corners
                .iter()
                .fold(first, |[low, high], p| [low.inf(p), high.sup(p)])
        });
        Self {
            bounds: bounds.collect(),
            walls: Walls::new(obstacles),
        }
    }

    /// The obstacles and their walls.
    pub fn walls(&self) -> &Walls {
        &self.walls
    }

    /// Is `p` inside an obstacle?
    pub fn is_inside(&self, p: Vector) -> bool {
        let obstacles = self.bounds.iter().zip(self.walls.obstacles());
        let may = |[low, high]: &[Vector; 2]| p == p.sup(low) && p == p.inf(high);
        obstacles
            .filter(|(bounds, _)| may(bounds))
            .any(|(_, obstacle)| obstacle.contains(p))
    }

    /// What the walls `near` a free place hide of the kernel there.
    pub fn share(&self, p: Vector, near: &[u32], kernel: &Kernel) -> f64 {
        let mut share = 0.0;
        let h = kernel.support_radius;
        kernel
            .walls
            .shares(&self.walls, near, p, h, |wall| share += wall.kernel);
        share
    }

    /// Does no wall `near` a free place stand between it and another? The same walls hide `q` that hide that
    /// part of the kernel.
    pub fn sees(&self, p: Vector, q: Vector, near: &[u32]) -> bool {
        let hides = |&k: &u32| self.walls.wall(k).crossing(p, q).is_some();
        !near.iter().any(hides)
    }

    /// What walls hide from somebody at `p`; `near` are the walls within h, and will be those of the eye.
    pub fn hidden(&self, p: Vector, near: &mut Vec<u32>, kernel: &Kernel) -> Hidden {
        let h = kernel.support_radius;
        if !self.is_inside(p) {
            return Hidden {
                share: self.share(p, near, kernel),
                eye: p,
                inside: None,
            };
        }
        near.clear();
        let free = self.walls.free_point_near(p);
        let depth = free.map_or(f64::INFINITY, |free| (free - p).norm());
        let eye = free.filter(|_| depth < h).unwrap_or(p);
        if depth < h {
            self.walls.near(eye, h, near);
        }
        Hidden {
            share: self.share(eye, near, kernel),
            eye,
            inside: Some(depth),
        }
    }
}
