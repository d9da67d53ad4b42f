//! The two colourings of Fig. 3 by perceptually uniform maps that colour-blind people can read.

use std::sync::LazyLock;

use colorgrad::{Gradient, preset};
use rerun::Color;

/// Density that has the last colour, P/m².
pub const DENSITY_RANGE: f32 = 8.0;
/// Speed that has the last colour, m/s.
pub const SPEED_RANGE: f32 = 1.8;

/// Few enough that equal colours repeat in the file, more than an eye tells apart.
const STEPS: usize = 64;

/// Colours for values from 0 to some limit.
pub struct ColorMap {
    colors: [Color; STEPS],
    range: f32,
}

impl ColorMap {
    fn new(gradient: &impl Gradient, range: f32) -> Self {
        let color = |step: usize| {
            let [r, g, b, _] = gradient.at(step as f32 / (STEPS - 1) as f32).to_rgba8();
            Color::from_rgb(r, g, b)
        };
        Self {
            colors: std::array::from_fn(color),
            range,
        }
    }

    /// The colour of `value`; beyond the range that of its end.
    pub fn color(&self, value: f32) -> Color {
        let last = (STEPS - 1) as f32;
        // `as` saturates, and takes NaN to the first colour.
        self.colors[((value / self.range * last + 0.5) as usize).min(STEPS - 1)]
    }
}

/// Viridis for densities.
pub static DENSITY: LazyLock<ColorMap> =
    LazyLock::new(|| ColorMap::new(&preset::viridis(), DENSITY_RANGE));
/// Inferno for speeds.
pub static SPEED: LazyLock<ColorMap> =
    LazyLock::new(|| ColorMap::new(&preset::inferno(), SPEED_RANGE));

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_beyond_the_range_have_the_colours_of_its_ends() {
        assert_eq!(DENSITY.color(-1.0), DENSITY.color(0.0));
        assert_eq!(DENSITY.color(1e9), DENSITY.color(8.0));
        assert_eq!(SPEED.color(f32::NAN), SPEED.color(0.0));
        assert_ne!(SPEED.color(0.9), SPEED.color(1.8));
    }
}
