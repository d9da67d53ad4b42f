//! Floor plans as lists of rings, with queries that are independent of the code under test.

use sandbox::engine::math::Vector;

/// Corners in meters; the first is not repeated.
pub type Ring = Vec<[f64; 2]>;

/// The rings in well-known text: the contents of the innermost parentheses.
pub fn rings(wkt: &str) -> Vec<Ring> {
    let inner = wkt.split(')').filter_map(|part| part.rsplit_once('('));
    let ring = |(_, points): (&str, &str)| {
        let point = |text: &str| {
            let (x, y) = text.trim().split_once(' ').unwrap();
            [x, y].map(|number| number.parse().unwrap())
        };
        let mut ring: Ring = points.split(',').map(point).collect();
        assert_eq!(ring.pop().as_ref(), ring.first(), "{points}");
        ring
    };
    inner.map(ring).collect()
}

/// The well-known text of polygons, each given by its rings.
pub fn multipolygon(polygons: &[Vec<Ring>]) -> String {
    let point = |[x, y]: &[f64; 2]| format!("{x} {y}");
    let join = |parts: Vec<String>| format!("({})", parts.join(", "));
    let ring = |ring: &Ring| join(ring.iter().chain(ring.first()).map(point).collect());
    let polygon = |rings: &Vec<Ring>| join(rings.iter().map(ring).collect());
    format!(
        "MULTIPOLYGON {}",
        join(polygons.iter().map(polygon).collect())
    )
}

/// The edges of a ring.
pub fn edges(ring: &Ring) -> impl Iterator<Item = [Vector; 2]> {
    let ends = ring.iter().cycle().skip(1);
    ring.iter()
        .zip(ends)
        .map(|(&a, &b)| [a, b].map(Vector::from))
}

/// Whether `p` lies inside, by the parity of the number of edges above it.
pub fn contains(ring: &Ring, p: Vector) -> bool {
    let above = |[a, b]: &[Vector; 2]| {
        (a.x > p.x) != (b.x > p.x) && p.y < a.y + (b.y - a.y) * (p.x - a.x) / (b.x - a.x)
    };
    edges(ring).filter(above).count() % 2 == 1
}

/// The distance from `p` to the nearest edge, meters.
pub fn margin(rings: &[Ring], p: Vector) -> f64 {
    let distance = |[a, b]: [Vector; 2]| {
        let along = (b - a).dot(&(p - a)) / (b - a).norm_squared();
        (a + (b - a) * along.clamp(0.0, 1.0) - p).norm()
    };
    rings
        .iter()
        .flat_map(edges)
        .map(distance)
        .fold(f64::INFINITY, f64::min)
}
