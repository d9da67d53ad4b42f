//! Integrals of the kernels over what walls hide or over what is solid, by adaptive quadrature, ray by ray: a reference
//! for every method of including walls, also for the tests of the engine. It shares the kernels with
//! [`sandbox::engine::boundary`], but none of its closed forms.

use std::f64::consts::PI;
use std::ops::{Add, Mul, Sub};

use sandbox::engine::boundary::WallShare;
use sandbox::engine::geometry::Walls;
use sandbox::engine::kernel;
use sandbox::engine::math::Vector;
use serde::Serialize;

/// Maximum number of times a panel of angles is halved.
const MOST_HALVINGS: u32 = 48;
/// Abscissae and weights of Gauss–Legendre quadrature with 8 points on [−1, 1], for both signs
/// (Abramowitz and Stegun 1964, Table 25.4). It is exact for polynomials up to degree 15.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_5],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_3],
];

/// The points of the kernel's disc that count as wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Region {
    /// Points that the agent cannot see, each counted once: ⋃ P_k of §4.3.
    Hidden,
    /// Points inside an obstacle.
    Solid,
}

/// Integrals of an agent's kernel over a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Integrals {
    /// Its area in m².
    pub area: f64,
    /// ∫ W, dimensionless.
    pub kernel: f64,
    /// ∫ ∇W in 1/m.
    pub gradient: Vector,
}

impl Integrals {
    /// The integrals over nothing.
    pub fn none() -> Self {
        Self {
            area: 0.0,
            kernel: 0.0,
            gradient: Vector::zeros(),
        }
    }

    /// The integrals over a small piece of `area` m² at `offset` = x − r_i, meters.
    pub fn of_piece(offset: Vector, area: f64, h: f64) -> Self {
        Self {
            area,
            kernel: area * kernel::density(offset.norm_squared(), h),
            gradient: kernel::pressure_gradient(-offset, h) * area,
        }
    }

    /// The integrals over `region` for an agent at `r_i`, to about `tolerance`.
    ///
    /// Along a ray the kernels are polynomials, which Gaussian quadrature integrates exactly. Over the angle, the
    /// panels between corners, intersections with the rim and feet of perpendiculars are halved until the result
    /// converges. Obstacles must not overlap.
    pub fn over(region: Region, walls: &Walls, r_i: Vector, h: f64, tolerance: f64) -> Self {
        let edges = Edges::around(walls, r_i, h);
        let ray = |angle: f64| edges.along_ray(region, angle);
        let panels = edges.panels();
        let tolerance = tolerance / panels.len().max(1) as f64;
        let over = |[from, to]: [f64; 2]| {
            let whole = gauss(&ray, from, to);
            halved(&ray, [from, to], whole, tolerance, MOST_HALVINGS)
        };
        panels.into_iter().map(over).sum()
    }

    /// The largest of the differences.
    pub fn distance(&self, other: &Self) -> f64 {
        let difference = *self - *other;
        let numbers = difference.area.abs().max(difference.kernel.abs());
        numbers.max(difference.gradient.norm())
    }
}

impl From<&WallShare> for Integrals {
    fn from(share: &WallShare) -> Self {
        Self {
            area: share.hidden_area,
            kernel: share.kernel,
            gradient: share.gradient,
        }
    }
}

impl Add for Integrals {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            area: self.area + other.area,
            kernel: self.kernel + other.kernel,
            gradient: self.gradient + other.gradient,
        }
    }
}

impl Sub for Integrals {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul<f64> for Integrals {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self {
            area: self.area * factor,
            kernel: self.kernel * factor,
            gradient: self.gradient * factor,
        }
    }
}

impl std::iter::Sum for Integrals {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self::none(), Add::add)
    }
}

/// The edges within reach of an agent, relative to the agent.
struct Edges {
    ends: Vec<[Vector; 2]>,
    stands_in_solid: bool,
    h: f64,
}

impl Edges {
    fn around(walls: &Walls, r_i: Vector, h: f64) -> Self {
        let mut near = Vec::new();
        walls.near(r_i, h, &mut near);
        let ends = near.into_iter().map(|k| walls.wall(k));
        Self {
            ends: ends.map(|w| [w.start - r_i, w.end - r_i]).collect(),
            stands_in_solid: walls.obstacle_at(r_i).is_some(),
            h,
        }
    }

    /// Intervals of angles in which the integrand is smooth, radians.
    fn panels(&self) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        for &[a, b] in &self.ends {
            let foot = a - (b - a) * (a.dot(&(b - a)) / (b - a).norm_squared());
            let half_chord = (self.h * self.h - foot.norm_squared()).max(0.0).sqrt();
            let chord = (b - a).normalize() * half_chord;
            points.extend([a, b, foot, foot - chord, foot + chord]);
        }
        let mut angles: Vec<f64> = points.iter().map(|p| p.y.atan2(p.x)).collect();
        angles.extend([-PI, 0.0, PI]);
        angles.sort_by(f64::total_cmp);
        angles.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// The integrals along a ray, per radian.
    fn along_ray(&self, region: Region, angle: f64) -> Integrals {
        let ray = Vector::new(angle.cos(), angle.sin());
        let hits = self.ends.iter().filter_map(|&[a, b]| hit(a, b, ray));
        let hits = hits.filter(|hit| hit.distance < self.h);
        match region {
            Region::Hidden => hits
                .filter(|hit| hit.enters)
                .map(|hit| hit.distance)
                .reduce(f64::min)
                .map_or(Integrals::none(), |from| self.outwards(ray, from)),
            // Add the rest of the ray where it enters the region, and subtract the rest where it leaves.
            Region::Solid => {
                let first = self.stands_in_solid.then(|| self.outwards(ray, 0.0));
                let beyond = hits.map(|hit| {
                    self.outwards(ray, hit.distance) * if hit.enters { 1.0 } else { -1.0 }
                });
                first.into_iter().chain(beyond).sum()
            }
        }
    }

    /// The part of a ray from a distance to the rim.
    fn outwards(&self, ray: Vector, from: f64) -> Integrals {
        gauss(&|r| Integrals::of_piece(ray * r, r, self.h), from, self.h)
    }
}

/// An intersection of a ray from the agent with an edge.
struct Hit {
    distance: f64,
    enters: bool,
}

fn hit(a: Vector, b: Vector, ray: Vector) -> Option<Hit> {
    let turn = ray.perp(&(b - a));
    let (distance, fraction) = (a.perp(&(b - a)) / turn, a.perp(&ray) / turn);
    // The inside is to the left of an edge.
    let enters = turn < 0.0;
    (distance >= 0.0 && (0.0..=1.0).contains(&fraction)).then_some(Hit { distance, enters })
}

fn gauss(f: &impl Fn(f64) -> Integrals, from: f64, to: f64) -> Integrals {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let pair =
        |[x, weight]: [f64; 2]| (f(middle - half * x) + f(middle + half * x)) * (weight * half);
    GAUSS.into_iter().map(pair).sum()
}

fn halved(
    f: &impl Fn(f64) -> Integrals,
    [from, to]: [f64; 2],
    whole: Integrals,
    tolerance: f64,
    halvings: u32,
) -> Integrals {
    let middle = 0.5 * (from + to);
    let halves = [[from, middle], [middle, to]].map(|[a, b]| ([a, b], gauss(f, a, b)));
    let sum = halves[0].1 + halves[1].1;
    if halvings == 0 || sum.distance(&whole) <= tolerance {
        return sum;
    }
    let refined = halves.map(|(ends, half)| halved(f, ends, half, 0.5 * tolerance, halvings - 1));
    refined[0] + refined[1]
}
