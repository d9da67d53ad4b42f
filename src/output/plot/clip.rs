//! Clips shapes to a panel. Coordinates are in the unit square.

type Place = [f64; 2];

/// The part of a simple polygon inside the unit square (Sutherland and Hodgman 1974).
pub fn polygon(corners: &[Place]) -> Vec<Place> {
    let mut kept = corners.to_vec();
    for axis in 0..2 {
        for (limit, sign) in [(0.0, 1.0), (1.0, -1.0)] {
            let inside = |p: &Place| (p[axis] - limit) * sign >= 0.0;
            let mut next = Vec::with_capacity(kept.len() + 2);
            for (k, p) in kept.iter().enumerate() {
                let before = &kept[(k + kept.len() - 1) % kept.len()];
                if inside(p) != inside(before) {
                    let part = (limit - before[axis]) / (p[axis] - before[axis]);
                    next.push([0, 1].map(|k| before[k] + part * (p[k] - before[k])));
                }
                if inside(p) {
                    next.push(*p);
                }
            }
            kept = next;
        }
    }
    kept
}

/// The part of a segment inside the unit square (Liang and Barsky 1984).
pub fn segment(from: Place, to: Place) -> Option<[Place; 2]> {
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let d = to[axis] - from[axis];
        if d == 0.0 && !(0.0..=1.0).contains(&from[axis]) {
            return None;
        }
        if d != 0.0 {
            let (a, b) = ((0.0 - from[axis]) / d, (1.0 - from[axis]) / d);
            (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
        }
    }
    let at = |part: f64| [0, 1].map(|k| from[k] + part * (to[k] - from[k]));
    (first < last).then(|| [at(first), at(last)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_round_the_square_becomes_the_square() {
        let kept = polygon(&[[-1.0, -1.0], [2.0, -1.0], [2.0, 2.0], [-1.0, 2.0]]);
        assert_eq!(kept.len(), 4);
        assert!(kept.iter().flatten().all(|v| *v == 0.0 || *v == 1.0));
        assert!(polygon(&[[2.0, 2.0], [3.0, 2.0], [3.0, 3.0]]).is_empty());
    }

    #[test]
    fn a_segment_ends_at_the_rim() {
        let kept = segment([-1.0, 0.5], [0.5, 0.5]);
        assert_eq!(kept, Some([[0.0, 0.5], [0.5, 0.5]]));
        assert_eq!(segment([-1.0, 0.5], [-0.5, 0.5]), None);
        assert_eq!(segment([0.5, 2.0], [0.6, 3.0]), None);
    }
}
