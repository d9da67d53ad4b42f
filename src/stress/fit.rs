//! The formula's constants from the maps, by least squares.

use super::map::Cell;
use crate::stability::{Constants, FITTED};

/// The least that `auto` may be of the largest stable step.
pub const LEAST: f64 = 0.7;
/// Steps of the search, as factors of a constant: coarse, then ever finer.
const STEPS: [f64; 5] = [1.3, 1.1, 1.03, 1.01, 1.003];

/// The constants whose formula is nearest to the maps, by the squares of the logarithms of step over step;
/// the margin keeps every step a hair below the largest stable one. The search goes down one constant after the
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
    let widest = cells.iter().map(|cell| ratio(cell, &best));
    best.margin = 1.0 / widest.fold(f64::MIN_POSITIVE, f64::max);
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

/// The formula's step in parts of the largest stable one.
fn ratio(cell: &Cell, constants: &Constants) -> f64 {
    cell.mode().largest_step(constants) / cell.largest
}

/// The mean square of the logarithms of all ratios.
fn misfit(cells: &[Cell], constants: &Constants) -> f64 {
    let logarithms = cells.iter().map(|cell| ratio(cell, constants).ln());
    logarithms.map(|l| l * l).sum::<f64>() / cells.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::{Detail, Rest};

    #[test]
    fn constants_are_found_again_from_steps_that_they_have_made() {
        let made = Constants {
            pressure: 3.1,
            contact: 4.4,
            drag: 1.3,
            margin: 1.0,
        };
        let cell = |crowd: Rest| Cell {
            crowd,
            unrest: [0.0; 2],
            largest: crowd.mode().largest_step(&made),
            auto: 0.01,
            auto_is_stable: true,
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
        assert!((found.margin - 1.0).abs() < 0.01, "{found:?}");
    }
}
