//! Fits the formula's constants to the maps, by least squares.

use super::cell::Cell;
use super::condition::Condition;
use engine::stability::{Constants, FITTED, Scheme};

/// The smallest allowed ratio of `auto` to the largest stable step.
pub const LEAST: f64 = 0.7;
/// The largest ratio that the fit allows: other crowds, and points between those of the maps, may need shorter steps.
const MOST: f64 = 0.97;
/// Factors by which the search changes a constant, from coarse to fine.
const STEPS: [f64; 5] = [1.3, 1.1, 1.03, 1.01, 1.003];
/// The constants that the search changes.
const CONSTANTS: [fn(&mut Constants) -> &mut f64; 3] = [
    |constants| &mut constants.pressure,
    |constants| &mut constants.contact,
    |constants| &mut constants.drag,
];

/// The constants whose formula fits the maps best, by the squares of the logarithms of the step ratios. The margins
/// keep every step slightly below the largest stable one. The search is a coordinate descent from the engine's
/// constants.
pub fn fit(cells: &[Cell]) -> Constants {
    let mut best = FITTED;
    let mut least = misfit(cells, &best);
    for factor in STEPS {
        loop {
            let before = least;
            for constant in CONSTANTS {
                for factor in [factor, 1.0 / factor] {
                    let mut tried = best;
                    *constant(&mut tried) *= factor;
                    let misfit = misfit(cells, &tried);
                    if misfit < least {
                        (best, least) = (tried, misfit);
                    }
                }
            }
            if least >= before {
                break;
            }
        }
    }
    let margin = |scheme| MOST / ratios(cells, &best, scheme).fold(f64::MIN_POSITIVE, f64::max);
    (best.margin, best.verlet_margin) =
        (margin(Scheme::SemiImplicit), margin(Scheme::VelocityVerlet));
    best
}

/// The formula's step over the largest stable steps of a scheme.
fn ratios<'a>(
    cells: &'a [Cell],
    constants: &'a Constants,
    scheme: Scheme,
) -> impl Iterator<Item = f64> + 'a {
    cells.iter().flat_map(move |cell| {
        let step = cell.crowd.mode().largest_step(scheme, constants);
        let limits = Condition::ALL.into_iter().zip(cell.limits);
        let of_scheme = limits.filter(move |(condition, _)| condition.scheme == scheme);
        of_scheme.map(move |(_, limit)| step / limit.largest)
    })
}

/// The sum of the squares of the logarithms of all ratios. Velocity Verlet is left out: its limits test whether the
/// same constants hold for it.
fn misfit(cells: &[Cell], constants: &Constants) -> f64 {
    let ratios = ratios(cells, constants, Scheme::SemiImplicit);
    ratios.map(|r| r.ln().powi(2)).sum()
}
