//! Colours for numbers: perceptually uniform maps that colour-blind people can read too, for the two
//! colourings of Fig. 3 and whatever else is shown.

use std::sync::LazyLock;

use colorgrad::{Gradient, preset};

/// Red, green, blue.
pub type Rgb = [u8; 3];

/// Density that has the last colour, P/m².
pub const DENSITY_RANGE: f32 = 8.0;
/// Speed that has the last colour, m/s.
pub const SPEED_RANGE: f32 = 1.8;

/// Few enough that equal colours repeat in a file, more than an eye tells apart.
const STEPS: usize = 64;

/// Colours for values in a range.
#[derive(Debug, Clone)]
pub struct ColorMap {
    colors: [Rgb; STEPS],
    range: [f32; 2],
}

impl ColorMap {
    fn new(gradient: &impl Gradient, range: [f32; 2]) -> Self {
        let color = |step: usize| {
            let [r, g, b, _] = gradient.at(step as f32 / (STEPS - 1) as f32).to_rgba8();
            [r, g, b]
        };
        Self {
            colors: std::array::from_fn(color),
            range,
        }
    }

    /// Viridis, dark to light.
    pub fn viridis(range: [f32; 2]) -> Self {
        Self::new(&preset::viridis(), range)
    }

    /// Inferno, dark to light.
    pub fn inferno(range: [f32; 2]) -> Self {
        Self::new(&preset::inferno(), range)
    }

    /// The colour of `value`; beyond the range that of its end.
    pub fn color(&self, value: f32) -> Rgb {
        let [first, last] = self.range;
        let part = (value - first) / (last - first);
        // `as` saturates, and takes NaN to the first colour.
        self.colors[((part * (STEPS - 1) as f32 + 0.5) as usize).min(STEPS - 1)]
    }

    /// The values of the first and the last colour.
    pub fn range(&self) -> [f32; 2] {
        self.range
    }
}

/// Viridis for densities.
pub static DENSITY: LazyLock<ColorMap> = LazyLock::new(|| ColorMap::viridis([0.0, DENSITY_RANGE]));
/// Inferno for speeds.
pub static SPEED: LazyLock<ColorMap> = LazyLock::new(|| ColorMap::inferno([0.0, SPEED_RANGE]));

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
