//! Fits the formula's constants to the maps, by least squares.

use super::cell::Cell;
use super::condition::Condition;
use crate::analysis::stability::{Constants, FITTED, Scheme};

/// The smallest allowed ratio of `auto` to the largest stable step.
pub const LEAST: f64 = 0.7;
/// The largest ratio that the fit allows: other crowds, and points between those of the maps, may need shorter steps.
const MOST: f64 = 0.97;
/// Factors by which the search changes a constant, from coarse to fine.
const STEPS: [f64; 5] = [1.3, 1.1, 1.03, 1.01, 1.003];

/// The constants whose formula fits the maps best, by the squares of the logarithms of the step ratios. The margins
/// keep every step slightly below the largest stable one. The search is a coordinate descent from the engine's
/// constants.
pub fn fit(cells: &[Cell]) -> Constants {
    let mut best = FITTED;
    let mut least = misfit(cells, &best);
    for factor in STEPS {
        loop {
            let before = least;
            for constant in 0..3 {
                for factor in [factor, 1.0 / factor] {
                    let tried = scaled(best, constant, factor);
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

fn scaled(constants: Constants, which: usize, factor: f64) -> Constants {
    let mut scaled = constants;
    match which {
        0 => scaled.pressure *= factor,
        1 => scaled.contact *= factor,
        _ => scaled.drag *= factor,
    }
    scaled
}

/// The formula's step over the largest stable steps of a scheme.
fn ratios<'a>(
    cells: &'a [Cell],
    constants: &'a Constants,
    scheme: Scheme,
) -> impl Iterator<Item = f64> + 'a {
    cells.iter().flat_map(move |cell| {
        let step = cell.mode().largest_step(scheme, constants);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::{Detail, Limit, Rest};

    #[test]
    fn constants_are_found_again_from_steps_that_they_have_made() {
        let made = Constants {
            pressure: 3.1,
            contact: 4.4,
            drag: 1.3,
            ..FITTED
        };
        let cell = |crowd: Rest| Cell {
            crowd,
            limits: Condition::ALL.map(|condition| Limit {
                largest: crowd.mode().largest_step(condition.scheme, &made),
                auto: 0.01,
                auto_is_stable: true,
                fine_speed: 0.0,
                auto_speed: 0.0,
            }),
        };
        let cells: Vec<Cell> = Detail { quick: true }
            .crowds()
            .into_iter()
            .map(cell)
            .collect();
        let found = fit(&cells);
        assert!(
            (found.pressure / made.pressure - 1.0).abs() < 0.01,
            "{found:?}"
        );
        assert!(
            (found.contact / made.contact - 1.0).abs() < 0.02,
            "{found:?}"
        );
        assert!((found.drag / made.drag - 1.0).abs() < 0.02, "{found:?}");
        for margin in [found.margin, found.verlet_margin] {
            assert!((margin / MOST - 1.0).abs() < 0.02, "{found:?}");
        }
    }
}
