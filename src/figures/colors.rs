//! Maps from numbers to colors: perceptually uniform and safe for color-blind readers. They include the density
//! and speed colors of Fig. 3.

use std::sync::LazyLock;

use colorgrad::{Gradient, preset};

/// Red, green, blue.
pub type Rgb = [u8; 3];

/// Density mapped to the last color, P/m².
pub const DENSITY_RANGE: f32 = 8.0;
/// Speed mapped to the last color, m/s.
pub const SPEED_RANGE: f32 = 1.8;

/// Force on walls mapped to the last color, N/m.
pub const WALL_FORCE_RANGE: f32 = 3000.0;

/// The colors of the terms of an acceleration, those of the paper first, in words and as RGB; white is for their sum.
/// Any two of these colors differ by at least 20 (CIE76, ΔE*ab), for normal vision and for simulated protanopia and
/// deuteranopia (Machado, Oliveira and Fernandes 2009, severity 1.0).
pub const TERMS: [(&str, Rgb); 13] = [
    ("pale green", [201, 255, 181]),
    ("yellow", [251, 252, 3]),
    ("azure", [8, 164, 255]),
    ("slate blue", [74, 109, 172]),
    ("cyan", [66, 220, 244]),
    ("sand", [220, 175, 73]),
    ("brown", [176, 99, 16]),
    ("gray violet", [151, 140, 168]),
    ("salmon", [230, 159, 157]),
    ("sea green", [47, 123, 92]),
    ("blue", [0, 80, 240]),
    ("cobalt", [0, 96, 208]),
    ("khaki", [176, 144, 88]),
];

/// The number of colors of a map: more than the eye can distinguish on a smooth field.
const STEPS: usize = FEW * EACH - EACH + 1;
/// The number of colors of a map in recordings: few, so that equal colors repeat in the file.
const FEW: usize = 64;
/// The steps of a map from one of these few to the next.
const EACH: usize = 4;

/// A color map for a range of values.
#[derive(Debug, Clone)]
pub struct ColorMap {
    colors: Box<[Rgb; STEPS]>,
    range: [f32; 2],
    /// The number of bands of equal color.
    bands: Option<u32>,
}

impl ColorMap {
    fn new(gradient: &impl Gradient, range: [f32; 2]) -> Self {
        let color = |step: usize| {
            let [r, g, b, _] = gradient.at(step as f32 / (STEPS - 1) as f32).to_rgba8();
            [r, g, b]
        };
        Self {
            colors: Box::new(std::array::from_fn(color)),
            range,
            bands: None,
        }
    }

    /// The colors at these places of a gradient, evenly spread.
    fn part<const N: usize>(
        whole: &(impl Gradient + 'static),
        places: [f32; N],
        range: [f32; 2],
    ) -> Self {
        let part = colorgrad::GradientBuilder::new()
            .colors(&places.map(|at| whole.at(at)))
            .build::<colorgrad::LinearGradient>();
        part.map_or_else(|_| Self::new(whole, range), |part| Self::new(&part, range))
    }

    /// Light yellow to blue, in this many bands of equal color: for pictures with dark lines and text on them.
    pub fn pale(range: [f32; 2], bands: u32) -> Self {
        Self {
            bands: Some(bands.max(1)),
            ..Self::part(&preset::yl_gn_bu(), [0.0, 0.15, 0.3, 0.45, 0.6], range)
        }
    }

    /// Yellow to dark red.
    fn heat(range: [f32; 2]) -> Self {
        Self::part(&preset::yl_or_rd(), [0.15, 0.35, 0.55, 0.7, 0.85], range)
    }

    /// One color for all values.
    pub fn plain(color: Rgb) -> Self {
        Self {
            colors: Box::new([color; STEPS]),
            range: [0.0, 1.0],
            bands: None,
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

    /// Inferno without its darkest quarter, from purple to pale yellow: for marks on dark ground.
    pub fn bright_inferno(range: [f32; 2]) -> Self {
        let places = std::array::from_fn::<f32, 16, _>(|k| 0.25 + 0.05 * k as f32);
        Self::part(&preset::inferno(), places, range)
    }

    /// The color of `value`, clamped to the range.
    pub fn color(&self, value: f32) -> Rgb {
        self.nearest(value, 1)
    }

    /// The color of `value`, clamped to the range, in 64 steps.
    pub fn one_of_few(&self, value: f32) -> Rgb {
        self.nearest(value, EACH)
    }

    /// The nearest of every `each`-th color.
    fn nearest(&self, value: f32, each: usize) -> Rgb {
        let [first, last] = self.range;
        let at = (value - first) / (last - first);
        let part = match self.bands {
            Some(bands) => {
                let band = (at * bands as f32).floor().clamp(0.0, bands as f32 - 1.0);
                (band + 0.5) / bands as f32
            }
            None => at,
        };
        // `as` saturates and maps NaN to the first color.
        let last = (STEPS - 1) / each;
        self.colors[((part * last as f32 + 0.5) as usize).min(last) * each]
    }

    /// The number of bands of equal color, if it has bands.
    pub fn bands(&self) -> Option<u32> {
        self.bands
    }

    /// The values of the first and the last color.
    pub fn range(&self) -> [f32; 2] {
        self.range
    }
}

/// A lighter color: only this part of its distance from white.
pub fn light(color: Rgb, part: f64) -> Rgb {
    color.map(|value| (255.0 - part * (255.0 - f64::from(value))) as u8)
}

/// Viridis for densities.
pub static DENSITY: LazyLock<ColorMap> = LazyLock::new(|| ColorMap::viridis([0.0, DENSITY_RANGE]));
/// Yellow to dark red for forces on walls.
pub static WALL_FORCE: LazyLock<ColorMap> =
    LazyLock::new(|| ColorMap::heat([0.0, WALL_FORCE_RANGE]));
/// Yellow to red for waits, seconds.
pub static WAIT: LazyLock<ColorMap> = LazyLock::new(|| ColorMap::heat([0.0, 60.0]));
/// Yellow to red for leans, meters.
pub static LEAN: LazyLock<ColorMap> = LazyLock::new(|| ColorMap::heat([0.0, 0.55]));
/// Inferno for speeds.
pub static SPEED: LazyLock<ColorMap> = LazyLock::new(|| ColorMap::inferno([0.0, SPEED_RANGE]));
