//! The settings that no other setting beats (the Pareto front).

/// Costs and errors within this factor count as equal: costs vary by about as much between turns.
const SAME: f64 = 1.1;

/// The two points that beat a given point: the most accurate one at no higher cost, and the cheapest one at no larger
/// error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Front {
    /// Index and error of the most accurate point at no higher cost.
    pub best_at_cost: Option<(usize, f64)>,
    /// Index and cost of the cheapest point at no larger error.
    pub cheapest_at_error: Option<(usize, f64)>,
}

impl Front {
    /// For point `k` of `points`, each (cost, error).
    pub fn of(points: &[(f64, f64)], k: usize) -> Self {
        let (cost, error) = points[k];
        let others = || points.iter().enumerate().filter(|&(other, _)| other != k);
        let least = |best: Option<(usize, f64)>, (other, value): (usize, f64)| match best {
            Some((_, least)) if least <= value => best,
            _ => Some((other, value)),
        };
        let affordable = others().filter(|(_, p)| p.0 <= SAME * cost && p.1 * SAME < error);
        let exact = others().filter(|(_, p)| p.1 <= error && p.0 * SAME < cost);
        Self {
            best_at_cost: affordable.map(|(other, p)| (other, p.1)).fold(None, least),
            cheapest_at_error: exact.map(|(other, p)| (other, p.0)).fold(None, least),
        }
    }
}

/// Index of the cheapest of `points`, each (cost, error), with an error of at most `most`.
pub fn cheapest(points: &[(f64, f64)], most: f64) -> Option<usize> {
    let exact = points.iter().enumerate().filter(|(_, p)| p.1 <= most);
    exact
        .min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0))
        .map(|(k, _)| k)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_on_the_front_is_beaten_by_nobody() {
        let points = [(1.0, 1.0), (2.0, 0.5), (4.0, 0.6), (2.1, 0.1)];
        let front = Front::of(&points, 0);
        assert_eq!((front.best_at_cost, front.cheapest_at_error), (None, None));
        let beaten = Front::of(&points, 2);
        assert_eq!(beaten.best_at_cost, Some((3, 0.1)));
        assert_eq!(beaten.cheapest_at_error, Some((1, 2.0)));
        // Its cost counts as equal: it is within a tenth.
        assert_eq!(Front::of(&points, 1).best_at_cost, Some((3, 0.1)));
        assert_eq!(cheapest(&points, 0.5), Some(1));
        assert_eq!(cheapest(&points, 0.01), None);
    }
}
