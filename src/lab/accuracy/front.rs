//! The settings that no other setting beats (the Pareto front).

/// Costs and errors within this factor count as equal: costs vary by about as much between turns.
const SAME: f64 = 1.1;

/// The indices of the two points that beat point `k` of `points`, each (cost, error): the most accurate one at no
/// higher cost, and the cheapest one at no larger error.
pub fn better(points: &[(f64, f64)], k: usize) -> [Option<usize>; 2] {
    let (cost, error) = points[k];
    let all = || points.iter().enumerate();
    let affordable = all().filter(|(_, p)| p.0 <= SAME * cost && p.1 * SAME < error);
    let exact = all().filter(|(_, p)| p.1 <= error && p.0 * SAME < cost);
    let best_at_cost = affordable.min_by(|(_, a), (_, b)| a.1.total_cmp(&b.1));
    let cheapest_at_error = exact.min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0));
    [best_at_cost, cheapest_at_error].map(|found| found.map(|(other, _)| other))
}

/// Index of the cheapest of `points`, each (cost, error), with an error of at most `most`.
pub fn cheapest(points: &[(f64, f64)], most: f64) -> Option<usize> {
    let exact = points.iter().enumerate().filter(|(_, p)| p.1 <= most);
    let cheapest = exact.min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0));
    cheapest.map(|(k, _)| k)
}
