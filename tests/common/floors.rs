//! Random floor plans: rooms of several shapes with blocks that touch, columns, thin walls, concave bodies and slits.

use nalgebra::Rotation2;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use sandbox::engine::geometry::Area;
use sandbox::engine::math::Vector;
use sandbox::scenario::floor_plan::FloorPlan;

use super::plans::{Ring, contains, edges, margin};

/// The outline of a room, then the bodies in it. Bodies do not overlap, but may touch each other and the outline.
#[derive(Debug, Clone)]
pub struct Plan {
    pub rings: Vec<Ring>,
}

/// Bodies in scattered plans are at least this far from others and from the outline, meters.
const LEAST_GAP: f64 = 0.01;

impl Plan {
    /// A plan of any kind.
    pub fn random(rng: &mut ChaCha8Rng) -> Self {
        let mut plan = match rng.random_range(0..6) {
            0 => blocks(rng),
            1 => slits(rng),
            _ => {
                let most = rng.random_range(0..12);
                scattered(rng, most, LEAST_GAP, any_body)
            }
        };
        plan.turn(rng);
        plan
    }

    /// A plan as it is drawn for buildings: walls with doors, steps, rebates, notches, slits, niches and pillars.
    pub fn drawn(rng: &mut ChaCha8Rng) -> Self {
        let mut plan = drawn(rng);
        plan.turn(rng);
        plan
    }

    /// A plan of a room with up to `most` convex bodies, in which every gap is wider than `gap` meters.
    pub fn with_gaps(rng: &mut ChaCha8Rng, most: usize, gap: f64) -> Self {
        let mut plan = scattered(rng, most, gap, convex_body);
        plan.turn(rng);
        plan
    }

    /// Turns most plans around the origin, and moves some far away.
    fn turn(&mut self, rng: &mut ChaCha8Rng) {
        if rng.random_bool(0.4) {
            return;
        }
        let angle = Rotation2::new(rng.random_range(0.0..6.3));
        let far = rng.random_bool(0.2);
        let shift = if far {
            Vector::new(431.7, -1234.5)
        } else {
            Vector::zeros()
        };
        for p in self.rings.iter_mut().flatten() {
            *p = (angle * Vector::from(*p) + shift).into();
        }
    }

    /// The areas to walk in.
    pub fn areas(&self) -> Vec<Area> {
        let plan = FloorPlan::walkable(std::slice::from_ref(&self.rings));
        plan.unwrap_or_else(|error| panic!("{self:?}: {error}"))
            .walkable
    }

    /// Whether `p` lies on the floor, at least `gap` meters from all walls.
    pub fn is_free(&self, p: Vector, gap: f64) -> bool {
        let (outline, bodies) = (&self.rings[0], &self.rings[1..]);
        let is_inside = contains(outline, p) && !bodies.iter().any(|body| contains(body, p));
        is_inside && margin(&self.rings, p) >= gap
    }

    /// A random point of the floor at least `gap` meters from all walls; `None` if many tries find none.
    pub fn free(&self, rng: &mut ChaCha8Rng, gap: f64) -> Option<Vector> {
        let points = || self.rings[0].iter().map(|&p| Vector::from(p));
        let low = points().fold(Vector::repeat(f64::INFINITY), |low, p| low.inf(&p));
        let high = points().fold(Vector::repeat(-f64::INFINITY), |high, p| high.sup(&p));
        let mut tries = (0..1000).map(|_| {
            let parts = Vector::new(rng.random(), rng.random());
            low + (high - low).component_mul(&parts)
        });
        tries.find(|&p| self.is_free(p, gap))
    }
}

fn rectangle(low: [f64; 2], high: [f64; 2]) -> Ring {
    vec![low, [high[0], low[1]], high, [low[0], high[1]]]
}

/// A rectangular, L-shaped or U-shaped room. Its arms are at least 2 m wide.
fn room(rng: &mut ChaCha8Rng) -> Ring {
    let [w, h] = [rng.random_range(8.0..20.0), rng.random_range(8.0..14.0)];
    let [x, y] = [w, h].map(|size| rng.random_range(2.0..size - 4.0));
    match rng.random_range(0..4) {
        0 => vec![[0.0, 0.0], [w, 0.0], [w, y], [x, y], [x, h], [0.0, h]],
        1 => {
            let right = rng.random_range(x + 0.5..w - 2.0);
            vec![
                [0.0, 0.0],
                [w, 0.0],
                [w, h],
                [right, h],
                [right, y],
                [x, y],
                [x, h],
                [0.0, h],
            ]
        }
        _ => rectangle([0.0, 0.0], [w, h]),
    }
}

/// Square blocks on a grid, which touch at corners, along edges, and the outline.
fn blocks(rng: &mut ChaCha8Rng) -> Plan {
    let [columns, rows] = [rng.random_range(3..8), rng.random_range(3..6)];
    let side = [1.0, 1.5, 0.7][rng.random_range(0..3)];
    let place = |x: i32, y: i32| [x, y].map(|c| side * f64::from(c));
    let mut rings = vec![rectangle([0.0, 0.0], place(columns, rows))];
    for (x, y) in (0..columns).flat_map(|x| (0..rows).map(move |y| (x, y))) {
        if rng.random_bool(0.3) {
            rings.push(rectangle(place(x, y), place(x + 1, y + 1)));
        }
    }
    Plan { rings }
}

/// Walls of blocks with slits between them, from 1 cm to 1 m wide.
fn slits(rng: &mut ChaCha8Rng) -> Plan {
    let [w, h] = [12.0, 8.0];
    let mut rings = vec![rectangle([0.0, 0.0], [w, h])];
    for x in [3.0, 8.0] {
        let thick = [0.05, 0.3, 2.0][rng.random_range(0..3)];
        let mut y = 0.5;
        while y < h - 1.5 {
            let end = (y + rng.random_range(0.3..3.0)).min(h - 0.2);
            rings.push(rectangle([x, y], [x + thick, end]));
            y = end + [0.01, 0.1, 0.39, 1.0][rng.random_range(0..4)];
        }
    }
    Plan { rings }
}

/// The width of a small part of a building, meters: of slits, steps and walls.
fn small(rng: &mut ChaCha8Rng) -> f64 {
    match rng.random_range(0..3) {
        0 => rng.random_range(0.01..0.1),
        1 => rng.random_range(0.1..0.39),
        _ => [0.01, 0.05, 0.1, 0.2, 0.3][rng.random_range(0..5)],
    }
}

/// Rooms side by side. Each wall between them has parts of several thicknesses with doors and slits between; other
/// walls meet them in Ts, some with a notch. Pillars stand anywhere, also at and in walls.
fn drawn(rng: &mut ChaCha8Rng) -> Plan {
    let [w, h] = [rng.random_range(8.0..14.0), rng.random_range(5.0..9.0)];
    let mut rings = vec![rectangle([0.0, 0.0], [w, h])];
    for x in [0.35 * w, 0.7 * w] {
        let mut y = 0.0;
        while y < h {
            let end = y + rng.random_range(0.3..3.0);
            let end = if end > h - 0.6 { h } else { end };
            let [back, front] = [small(rng), small(rng)];
            rings.push(rectangle([x - back, y], [x + front, end]));
            if rng.random_bool(0.5) {
                // A wall that ends at this one, or just before it.
                let foot = if rng.random_bool(0.5) {
                    0.0
                } else {
                    small(rng)
                };
                let thick = small(rng);
                let low = (end - rng.random_range(-0.3..0.6)).clamp(0.0, h - thick);
                let long = rng.random_range(0.3..2.5);
                rings.push(rectangle(
                    [x - back - foot - long, low],
                    [x - back - foot, low + thick],
                ));
            }
            y = end
                + if rng.random_bool(0.4) {
                    small(rng)
                } else {
                    rng.random_range(0.5..1.2)
                };
        }
    }
    for _ in 0..rng.random_range(0..5) {
        let [x, y] = [
            rng.random_range(0.3..w - 0.3),
            rng.random_range(0.3..h - 0.3),
        ];
        let ring = convex_body(rng).into_iter();
        let scale = rng.random_range(0.1..0.5);
        let ring: Ring = ring.map(|[a, b]| [x + scale * a, y + scale * b]).collect();
        if ring.iter().all(|&p| contains(&rings[0], p.into())) {
            rings.push(ring);
        }
    }
    Plan { rings }
}

/// A room with up to `most` bodies, at least `gap` meters from each other and from the outline.
fn scattered(
    rng: &mut ChaCha8Rng,
    most: usize,
    gap: f64,
    body: fn(&mut ChaCha8Rng) -> Ring,
) -> Plan {
    let mut plan = Plan {
        rings: vec![room(rng)],
    };
    for _ in 0..4 * most {
        let Some(center) = plan.free(rng, gap) else {
            break;
        };
        let shape = body(rng).into_iter();
        let ring: Ring = shape.map(|p| (center + Vector::from(p)).into()).collect();
        let is_apart = |other: &Ring| distance(&ring, other) >= gap && !holds(&ring, other);
        if plan.rings.len() <= most && plan.rings.iter().all(is_apart) {
            plan.rings.push(ring);
        }
    }
    plan
}

/// Whether the first ring contains the second.
fn holds(ring: &Ring, other: &Ring) -> bool {
    contains(ring, other[0].into())
}

/// The distance between two rings, 0 where they cross, meters.
fn distance(ring: &Ring, other: &Ring) -> f64 {
    let pairs = edges(ring).flat_map(|a| edges(other).map(move |b| (a, b)));
    let crosses = |([a, b], [c, d]): ([Vector; 2], [Vector; 2])| {
        let side = |a: Vector, b: Vector, p: Vector| (b - a).perp(&(p - a));
        side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
    };
    if pairs.into_iter().any(crosses) {
        return 0.0;
    }
    let to = |ring: &Ring, other: &Ring| {
        let distances = other
            .iter()
            .map(|&p| margin(std::slice::from_ref(ring), p.into()));
        distances.fold(f64::INFINITY, f64::min)
    };
    to(ring, other).min(to(other, ring))
}

fn turned(rng: &mut ChaCha8Rng, ring: Ring) -> Ring {
    let angle = Rotation2::new(if rng.random_bool(0.4) {
        0.0
    } else {
        rng.random_range(0.0..6.3)
    });
    ring.into_iter()
        .map(|p| (angle * Vector::from(p)).into())
        .collect()
}

/// A box, a thin wall, or a column of up to 40 corners.
fn convex_body(rng: &mut ChaCha8Rng) -> Ring {
    let ring = match rng.random_range(0..3) {
        0 => {
            let high = [rng.random_range(0.1..2.0), rng.random_range(0.1..1.0)];
            rectangle(high.map(|x| -x), high)
        }
        1 => {
            let high = [rng.random_range(0.5..3.0), rng.random_range(0.005..0.05)];
            rectangle(high.map(|x| -x), high)
        }
        _ => {
            let corners = [3, 4, 5, 6, 8, 40][rng.random_range(0..6)];
            let radius = rng.random_range(0.1..0.8);
            let corner = |k| (std::f64::consts::TAU * f64::from(k) / f64::from(corners)).sin_cos();
            (0..corners)
                .map(corner)
                .map(|(sine, cosine)| [radius * cosine, radius * sine])
                .collect()
        }
    };
    turned(rng, ring)
}

/// A convex body, or one with a notch, an angle or a U.
fn any_body(rng: &mut ChaCha8Rng) -> Ring {
    let [x, y] = [rng.random_range(0.3..2.0), rng.random_range(0.3..1.5)];
    let thick = rng.random_range(0.05..0.25);
    let ring = match rng.random_range(0..7) {
        0 => vec![[-x, -y], [x, -y], [x, y], [0.0, 0.2 * y], [-x, y]],
        1 => vec![
            [-x, -y],
            [x, -y],
            [x, thick - y],
            [thick - x, thick - y],
            [thick - x, y],
            [-x, y],
        ],
        2 => vec![
            [-x, -y],
            [x, -y],
            [x, y],
            [x - thick, y],
            [x - thick, thick - y],
            [thick - x, thick - y],
            [thick - x, y],
            [-x, y],
        ],
        _ => return convex_body(rng),
    };
    turned(rng, ring)
}
