//! Which settings nothing else beats.

/// Costs and errors within this factor are taken for the same: costs vary by as much from turn to turn.
const SAME: f64 = 1.1;

/// What stands above a point: the best that costs no more, and the cheapest that is no worse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Front {
    /// The least error at no more than the same cost, and whose it is.
    pub best_at_cost: Option<(usize, f64)>,
    /// The least cost at no more than the same error, and whose it is.
    pub cheapest_at_error: Option<(usize, f64)>,
}

impl Front {
    /// Of point `k` among points (cost, error).
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

/// The cheapest of points (cost, error) whose error is at most `most`.
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
        // At the same cost, to a tenth.
        assert_eq!(Front::of(&points, 1).best_at_cost, Some((3, 0.1)));
        assert_eq!(cheapest(&points, 0.5), Some(1));
        assert_eq!(cheapest(&points, 0.01), None);
    }
}
