//! Voronoi cells of people: the part of the plane that is nearer to a person than to any other.
//!
//! A cell is the intersection of the half-planes nearer to a person than to each of its Delaunay neighbors, within a
//! convex polygon around the person (Steffen and Seyfried, Physica A 389, 2010). All outlines are counterclockwise, in
//! meters. The only file of this crate that names spade.

use libm::{cos, sin};
use spade::{DelaunayTriangulation, Point2, Triangulation, mitigate_underflow};

use engine::math::Vector;

/// The cell of a person.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Its outline, convex.
    pub outline: Vec<Vector>,
    /// The number of people who share it, because they are at the same place; usually 1.
    pub people: u32,
}

/// The cells of people at these places, in their order, each within the convex polygon that `limit` returns for the
/// place.
pub fn cells(people: &[Vector], limit: impl Fn(Vector) -> Vec<Vector>) -> Vec<Cell> {
    let (places, own) = distinct(people);
    let around = neighbors(&places);
    let mut shared = vec![0; places.len()];
    own.iter().for_each(|&place| shared[place] += 1);
    let cell = |(&p, &place): (&Vector, &usize)| {
        let mut outline = limit(p);
        for &other in &around[place] {
            let way = places[other] - places[place];
            // Points nearer to p are on the inner side of the bisector.
            let beyond = |q: Vector| (q - p).dot(&way) - 0.5 * way.norm_squared();
            outline = half(&outline, beyond);
        }
        Cell {
            outline,
            people: shared[place],
        }
    };
    people.iter().zip(&own).map(cell).collect()
}

/// The different places relative to the first one, and the number of each person's place.
fn distinct(people: &[Vector]) -> (Vec<Vector>, Vec<usize>) {
    let origin = people.first().copied().unwrap_or_default();
    let near = |p: &Vector| {
        let p = p - origin;
        // spade accepts zero, but not numbers next to it.
        let p = mitigate_underflow(Point2::new(p.x, p.y));
        Vector::new(p.x, p.y)
    };
    let near: Vec<Vector> = people.iter().map(near).collect();
    let mut order: Vec<usize> = (0..people.len()).collect();
    let key = |k: usize| near[k] + Vector::zeros(); // −0 is 0
    order.sort_by(|&a, &b| {
        let (a, b) = (key(a), key(b));
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
    });
    let (mut places, mut own) = (Vec::<Vector>::new(), vec![0; people.len()]);
    for k in order {
        if places.last() != Some(&near[k]) {
            places.push(near[k]);
        }
        own[k] = places.len() - 1;
    }
    (places, own)
}

/// The Delaunay neighbors of each of these different places.
fn neighbors(places: &[Vector]) -> Vec<Vec<usize>> {
    let points = places.iter().map(|p| Point2::new(p.x, p.y)).collect();
    let Ok(triangulation) = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(points) else {
        // Never the case for finite coordinates; with all others, the cells are the same.
        let others = |k: usize| (0..places.len()).filter(move |&other| other != k).collect();
        return (0..places.len()).map(others).collect();
    };
    let mut around = vec![Vec::new(); places.len()];
    for edge in triangulation.undirected_edges() {
        let [a, b] = edge.vertices().map(|vertex| vertex.index());
        around[a].push(b);
        around[b].push(a);
    }
    around
}

/// A regular polygon of `4 * segments` corners on a circle, one of them to the right of the center.
pub fn disk(center: Vector, radius: f64, segments: u32) -> Vec<Vector> {
    let corners = 4 * segments.max(1);
    let corner = |k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(corners);
        center + Vector::new(cos(angle), sin(angle)) * radius
    };
    (0..corners).map(corner).collect()
}

/// The part of any ring inside a convex polygon (Sutherland and Hodgman 1974). If it falls into pieces, edges along the
/// polygon join them, there and back: areas and winding numbers are right.
pub fn within(ring: &[Vector], convex: &[Vector]) -> Vec<Vector> {
    let ends = convex.iter().cycle().skip(1);
    let sides = convex.iter().zip(ends);
    sides.fold(ring.to_vec(), |left, (&start, &end)| {
        half(&left, |p| (p - start).perp(&(end - start)))
    })
}

/// The part of a ring where `beyond`, a linear function, is not above 0.
fn half(ring: &[Vector], beyond: impl Fn(Vector) -> f64) -> Vec<Vector> {
    let outside: Vec<f64> = ring.iter().map(|&p| beyond(p)).collect();
    if outside.iter().all(|&outside| outside <= 0.0) {
        return ring.to_vec();
    }
    let mut kept = Vec::with_capacity(ring.len() + 1);
    for k in 0..ring.len() {
        let next = (k + 1) % ring.len();
        let (here, there) = (outside[k], outside[next]);
        if here <= 0.0 {
            kept.push(ring[k]);
        }
        if (here <= 0.0) != (there <= 0.0) {
            kept.push(ring[k] + (ring[next] - ring[k]) * (here / (here - there)));
        }
    }
    kept
}

/// The area of a ring, m²; negative if it is clockwise.
pub fn area(ring: &[Vector]) -> f64 {
    let Some(&first) = ring.first() else {
        return 0.0;
    };
    let pairs = ring.windows(2);
    0.5 * pairs
        .map(|pair| (pair[0] - first).perp(&(pair[1] - first)))
        .sum::<f64>()
}
