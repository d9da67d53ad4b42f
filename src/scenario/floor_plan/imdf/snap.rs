//! Corners that nearly meet: units that share an edge, and the openings on it, are rounded each on its own.

use std::collections::BTreeMap;

use engine::math::Vector;

/// Corners, by the squares of a grid in which they lie.
#[derive(Default)]
struct Corners {
    points: Vec<Vector>,
    squares: BTreeMap<[i64; 2], Vec<usize>>,
}

impl Corners {
    /// The corner that stands for a point: one nearer than `gap`, or the point itself.
    fn of(&mut self, p: Vector, gap: f64) -> Vector {
        let own = [p.x, p.y].map(|x| (x / gap).floor() as i64);
        let near = (-1..=1).flat_map(|x| {
            (-1..=1).map(move |y| [own[0].saturating_add(x), own[1].saturating_add(y)])
        });
        let known = near
            .filter_map(|square| self.squares.get(&square))
            .flatten();
        let distance = |k: &usize| (self.points[*k] - p).norm();
        let nearest = known.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        match nearest.filter(|k| distance(k) < gap) {
            Some(&k) => self.points[k],
            None => {
                self.squares.entry(own).or_default().push(self.points.len());
                self.points.push(p);
                p
            }
        }
    }
}

/// Makes corners of `paths` that are nearer than `gap` to each other one, and leads their edges through the corners
/// that are nearer than that to them. Paths that meet exactly stay as they are.
pub fn snap(paths: &mut [&mut Vec<[f64; 2]>], gap: f64) {
    let mut corners = Corners::default();
    for path in &mut *paths {
        for p in path.iter_mut() {
            *p = corners.of((*p).into(), gap).into();
        }
        path.dedup();
    }
    let mut sorted = corners.points;
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x));
    for path in paths {
        let mut through = Vec::with_capacity(path.len());
        for pair in path.windows(2) {
            through.push(pair[0]);
            through.extend(between(pair[0].into(), pair[1].into(), &sorted, gap));
        }
        through.extend(path.last());
        **path = through;
    }
}

/// The corners between the ends of an edge that are nearer than `gap` to it, in order.
fn between(a: Vector, b: Vector, sorted: &[Vector], gap: f64) -> Vec<[f64; 2]> {
    let (low, high) = (a.inf(&b), a.sup(&b));
    let first = sorted.partition_point(|p| p.x < low.x - gap);
    let near = sorted[first..].iter().take_while(|p| p.x <= high.x + gap);
    let length = (b - a).norm();
    let along = (b - a) / length;
    let mut found: Vec<(f64, Vector)> = near
        .filter(|p| **p != a && **p != b)
        .map(|&p| ((p - a).dot(&along), p))
        .filter(|&(part, p)| part > 0.0 && part < length && along.perp(&(p - a)).abs() < gap)
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, p)| p.into()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_lead_through_corners_of_others_and_exact_ones_stay() {
        let mut long = vec![[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [0.0, 0.0]];
        let mut door = vec![[4.0, 0.004], [5.0, -0.003]];
        let mut near = vec![[10.0, 0.007], [12.0, 0.0]];
        snap(&mut [&mut long, &mut door, &mut near], 0.02);
        let through = [[0.0, 0.0], [4.0, 0.004], [5.0, -0.003], [10.0, 0.0]];
        assert_eq!(long[..4], through);
        assert_eq!(door, [[4.0, 0.004], [5.0, -0.003]]);
        assert_eq!(near[0], [10.0, 0.0]);
        let mut square = vec![[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 0.0]];
        let before = square.clone();
        snap(&mut [&mut square], 0.02);
        assert_eq!(square, before);
    }
}
