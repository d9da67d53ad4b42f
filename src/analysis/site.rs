//! The measurement site: the parts of a kernel that walls hide from people and from grid cells.

use engine::boundary::WallMethod;
use engine::geometry::{Polygon, Walls};
use engine::math::{Vector, bounds};

/// Obstacles, with a fast test for points inside them.
#[derive(Debug, Clone)]
pub struct Site {
    /// The obstacles and their walls.
    pub walls: Walls,
    /// The corners of each obstacle's bounding box, infinite for an unbounded obstacle.
    bounds: Vec<[Vector; 2]>,
}

/// The kernel, and its treatment of walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kernel {
    /// h, meters.
    pub support_radius: f64,
    /// The method for the integral over hidden regions.
    pub walls: WallMethod,
}

impl Kernel {
    /// The share of the kernel at `p`, outside obstacles, that the walls in `near` hide.
    pub fn share(&self, walls: &Walls, p: Vector, near: &[u32]) -> f64 {
        let (method, h) = (self.walls, self.support_radius);
        method.hidden_kernel(walls, near, p, h)
    }
}

/// The part of the kernel that walls hide from a person.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hidden {
    /// Σ_k ∫ W over P_k, the part of the kernel behind walls.
    pub share: f64,
    /// The point from which the person sees and is seen, meters: the person's position or, inside an obstacle, the
    /// nearest free point, because recorded heads lean over walls. A person farther inside than h sees no walls.
    pub eye: Vector,
    /// Depth inside an obstacle, meters.
    pub inside: Option<f64>,
}

impl Site {
    /// A site with these obstacles.
    pub fn new(obstacles: Vec<Polygon>) -> Self {
        let bounds = obstacles.iter().map(|obstacle| {
            if obstacle.is_unbounded() {
                return [f64::NEG_INFINITY, f64::INFINITY].map(Vector::repeat);
            }
            bounds(obstacle.points().iter().copied()).unwrap_or_default()
        });
        Self {
            bounds: bounds.collect(),
            walls: Walls::new(obstacles),
        }
    }

    /// Whether `p` is inside an obstacle.
    pub fn is_inside(&self, p: Vector) -> bool {
        let mut obstacles = self.bounds.iter().zip(self.walls.obstacles());
        let may = |[low, high]: &[Vector; 2]| p == p.sup(low) && p == p.inf(high);
        obstacles.any(|(bounds, obstacle)| may(bounds) && obstacle.contains(p))
    }

    /// Whether no wall in `near` is between `p`, outside obstacles, and `q`. Walls that hide `q` also hide that part of
    /// the kernel.
    pub fn sees(&self, p: Vector, q: Vector, near: &[u32]) -> bool {
        Self::is_clear(&self.walls, p, q, near)
    }

    /// As [`sees`](Self::sees), for any walls.
    pub fn is_clear(walls: &Walls, p: Vector, q: Vector, near: &[u32]) -> bool {
        !near.iter().any(|&k| walls.wall(k).crossing(p, q).is_some())
    }

    /// The part of the kernel that walls hide from a person at `p`. `near` holds the walls within h of `p`, then those
    /// within h of the eye.
    pub fn hidden(&self, p: Vector, near: &mut Vec<u32>, kernel: &Kernel) -> Hidden {
        let h = kernel.support_radius;
        if !self.is_inside(p) {
            return Hidden {
                share: kernel.share(&self.walls, p, near),
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
            share: kernel.share(&self.walls, eye, near),
            eye,
            inside: Some(depth),
        }
    }
}
