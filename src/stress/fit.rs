//! The formula's constants from the maps, by least squares.

use super::cell::Cell;
use crate::stability::{Constants, FITTED};

/// The least that `auto` may be of the largest stable step.
pub const LEAST: f64 = 0.7;
/// The most that the fit lets it be: other people, and places between those of the maps, may allow less.
const MOST: f64 = 0.97;
/// Steps of the search, as factors of a constant: coarse, then ever finer.
const STEPS: [f64; 5] = [1.3, 1.1, 1.03, 1.01, 1.003];

/// The constants whose formula is nearest to the maps, by the squares of the logarithms of step over step;
/// the margin keeps every step a little below the largest stable one. The search goes down one constant after the
/// other from those of the engine.
pub fn fit(cells: &[Cell]) -> Constants {
    let mut best = Constants {
        margin: 1.0,
        ..FITTED
    };
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
    let widest = ratios(cells, &best).fold(f64::MIN_POSITIVE, f64::max);
    best.margin = MOST / widest;
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

/// The formula's step in parts of the largest stable ones, with both kinds of walls.
fn ratios(cells: &[Cell], constants: &Constants) -> impl Iterator<Item = f64> {
    cells.iter().flat_map(|cell| {
        let step = cell.mode().largest_step(constants);
        cell.limits.map(|limit| step / limit.largest)
    })
}

/// The sum of the squares of all ratios' logarithms.
fn misfit(cells: &[Cell], constants: &Constants) -> f64 {
    ratios(cells, constants).map(|r| r.ln().powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::{Detail, Limit, Rest};

    #[test]
    fn constants_are_found_again_from_steps_that_they_have_made() {
        let made = Constants {
            pressure: 3.1,
            contact: 4.4,
            drag: 1.3,
            margin: 1.0,
        };
        let cell = |crowd: Rest| {
            let limit = Limit {
                largest: crowd.mode().largest_step(&made),
                fine: 0.0,
                auto: 0.0,
                auto_is_stable: true,
            };
            Cell {
                crowd,
                auto: 0.01,
                limits: [limit; 2],
            }
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
        assert!((found.margin / MOST - 1.0).abs() < 0.01, "{found:?}");
    }
}
