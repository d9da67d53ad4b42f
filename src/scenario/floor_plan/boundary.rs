//! Walks along the boundary of an area on an integer grid, without rounding.

use std::cmp::Ordering;

/// A point of the grid; its coordinates are at most 2³⁰.
pub type Point = [i64; 2];

/// An edge with the area on its left.
#[derive(Clone, Copy)]
pub struct Edge {
    pub from: Point,
    pub to: Point,
}

impl Edge {
    fn direction(self) -> Point {
        between(self.from, self.to)
    }

    /// Its end with the smaller x, then y, and the direction from there.
    fn rising(self) -> (Point, Point) {
        let [low, high] = [self.from.min(self.to), self.from.max(self.to)];
        (low, between(low, high))
    }
}

/// The closed paths along `edges` with the area on their left: outlines counterclockwise, holes clockwise. No path
/// meets a point twice or has a corner in a straight line. Edges may meet only at their ends. The paths are sorted by
/// their left ends, but holes that touch no outline come last.
///
/// # Errors
/// The beginning of a path that does not close.
pub fn rings(mut edges: Vec<Edge>) -> Result<Vec<Vec<Point>>, Point> {
    // By their left ends, those with the same left end from top to bottom.
    edges.sort_by(|one, other| {
        let [(a, u), (b, v)] = [one, other].map(|edge| edge.rising());
        a.cmp(&b).then_with(|| turn(u, v))
    });
    let mut loops = loops(&edges)?;
    for (_, path) in &mut loops {
        let first = (0..path.len()).min_by_key(|&i| path[i]).unwrap_or(0);
        path.rotate_left(first);
    }
    loops.sort_by_key(|(is_apart, path)| (*is_apart, path[0]));
    let corners = |(_, path): (bool, Vec<usize>)| {
        let before = path.iter().cycle().skip(path.len() - 1);
        let turns = path.iter().zip(before).filter(|&(&k, &last)| {
            let [along, ahead] = [last, k].map(|k| edges[k].direction());
            turn(along, ahead).is_ne()
        });
        turns.map(|(&k, _)| edges[k].from).collect()
    };
    Ok(loops.into_iter().map(corners).collect())
}

/// Closed paths that meet no point twice, by the numbers of their edges; and whether they are holes that touch no
/// outline.
fn loops(edges: &[Edge]) -> Result<Vec<(bool, Vec<usize>)>, Point> {
    let mut leaving: Vec<usize> = (0..edges.len()).collect();
    leaving.sort_by_key(|&k| edges[k].from);
    let node = |p: Point| leaving.partition_point(|&k| edges[k].from < p);
    // The edge that continues along the same area: the next one clockwise.
    let after = |edge: Edge| {
        let here = leaving[node(edge.to)..]
            .iter()
            .copied()
            .take_while(|&k| edges[k].from == edge.to);
        let back = between(edge.to, edge.from);
        here.min_by(|&a, &b| {
            let [a, b] = [a, b].map(|k| edges[k].direction());
            turn(back, a).cmp(&turn(back, b)).then(turn(a, b))
        })
    };
    let mut walked = vec![false; edges.len()];
    // For each point, the position on the path of the edge that leaves it.
    let mut places: Vec<Option<usize>> = vec![None; edges.len() + 1];
    let (mut path, mut found) = (Vec::new(), Vec::new());
    for (first, edge) in edges.iter().enumerate() {
        // The highest edge at the left end of an outline comes from the right.
        let is_apart = edge.from < edge.to;
        let mut next = Some(first);
        while let Some(k) = next.filter(|&k| !std::mem::replace(&mut walked[k], true)) {
            places[node(edges[k].from)] = Some(path.len());
            path.push(k);
            if let Some(back) = places[node(edges[k].to)] {
                let closed = path.split_off(back);
                for &k in &closed {
                    places[node(edges[k].from)] = None;
                }
                found.push((is_apart, closed));
            }
            next = after(edges[k]);
        }
        if let Some(&k) = path.first() {
            return Err(edges[k].from);
        }
    }
    Ok(found)
}

fn between(a: Point, b: Point) -> Point {
    [b[0] - a[0], b[1] - a[1]]
}

/// `Less` if `v` is clockwise of `u` by less than half a turn, `Equal` if it is parallel. The products are at most
/// 2⁶² in size; their difference could overflow.
fn turn(u: Point, v: Point) -> Ordering {
    (u[0] * v[1]).cmp(&(u[1] * v[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The edges between successive points.
    fn path(points: &[Point]) -> Vec<Edge> {
        let edge = |pair: &[Point]| Edge {
            from: pair[0],
            to: pair[1],
        };
        points.windows(2).map(edge).collect()
    }

    #[test]
    fn squares_that_touch_are_two_rings_without_corners_in_straight_lines() {
        let low = path(&[[0, 0], [1, 0], [2, 0], [2, 2], [0, 2], [0, 0]]);
        let high = path(&[[2, 2], [4, 2], [4, 4], [2, 4], [2, 2]]);
        let found = rings([low, high].concat()).unwrap();
        let low = vec![[0, 2], [0, 0], [2, 0], [2, 2]];
        assert_eq!(found, [low, vec![[2, 4], [2, 2], [4, 2], [4, 4]]]);
    }

    #[test]
    fn a_hole_that_touches_its_outline_is_a_ring_of_its_own() {
        let outline = path(&[[0, 0], [4, 0], [4, 2], [4, 4], [0, 4], [0, 0]]);
        let hole = path(&[[4, 2], [3, 1], [2, 2], [3, 3], [4, 2]]);
        let found = rings([hole, outline].concat()).unwrap();
        let outline = vec![[0, 4], [0, 0], [4, 0], [4, 4]];
        assert_eq!(found, [outline, vec![[2, 2], [3, 3], [4, 2], [3, 1]]]);
    }

    #[test]
    fn a_path_that_does_not_close_is_an_error() {
        let open = path(&[[0, 0], [1, 0], [1, 1], [2, 1]]);
        assert_eq!(rings(open), Err([0, 0]));
    }
}
