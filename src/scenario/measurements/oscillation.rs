//! Collective oscillations: the spectrum of the mean velocities in boxes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::window::{Samples, Window};
use super::{About, Measure, Observed, Quantity};
use crate::error::Problem;
use crate::keys::limits::LONGEST_TIME;
use crate::keys::shapes::{Corners, wide_region};
use analysis::evaluated::Evaluated;
use analysis::oscillation::{Oscillation as Analyzed, correlation_lengths, speed};
use engine::scene::Region;
use engine::simulation::Simulation;

/// The name of the values if none is given.
const NAME: &str = "oscillation";
/// The most boxes.
const MOST_BOXES: usize = 10_000;

/// The mean velocities of the agents in boxes, sampled at equal times, and their spectrum averaged over the boxes: the
/// angular frequency of its peak, the parts of the power around the peak and in a band, the root mean square velocity,
/// the sense of rotation (spin) in each box, and the distance over which boxes move together.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Oscillation {
    /// The beginning of the names of its values. Default: `oscillation`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    /// The region that is divided into boxes: lower left and upper right corner, meters.
    pub(super) region: Corners,
    /// Side of a box, meters; it is adapted to divide the region.
    #[schemars(range(max = 1e6), extend("exclusiveMinimum" = 0))]
    #[serde(default = "side")]
    box_size: f64,
    /// The start, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    #[serde(default)]
    from_secs: f64,
    /// The end, seconds. Default: the end of the run.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    until_secs: Option<f64>,
    /// Time between two samples, seconds.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    #[serde(default = "often")]
    every_secs: f64,
    /// The band of angular frequencies whose part of the power is given, rad/s. Default: 0.30 to 0.40, as measured in a
    /// crowd (Gu et al. 2025).
    #[schemars(inner(range(min = 0, max = 1e6)))]
    #[serde(default = "band")]
    band: [f64; 2],
}

fn side() -> f64 {
    2.0
}

fn often() -> f64 {
    0.4
}

fn band() -> [f64; 2] {
    [0.3, 0.4]
}

/// What was seen so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Seen {
    /// Mean velocities, m/s: of all boxes at the first time, then of all boxes at the second, and so on.
    velocities: Vec<Option<[f64; 2]>>,
    /// The time between two samples, seconds.
    every: f64,
}

impl Oscillation {
    fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(NAME)
    }

    fn window(&self) -> Window {
        Window {
            region: Some(self.region),
            samples: Samples {
                from_secs: self.from_secs,
                until_secs: self.until_secs,
                every_secs: self.every_secs,
            },
        }
    }

    /// The numbers of boxes along x and y.
    fn boxes(&self, region: &Region) -> [usize; 2] {
        let size = region.max - region.min;
        [size.x, size.y].map(|length| (length / self.box_size).round().max(1.0) as usize)
    }

    /// The velocities of each box; `None` if it was empty at some time.
    fn series(&self, seen: &Seen) -> Vec<Option<Vec<[f64; 2]>>> {
        let [columns, rows] = self.boxes(&self.region.into());
        let boxes = columns * rows;
        let series = |k: usize| -> Option<Vec<[f64; 2]>> {
            let of_box = seen.velocities.iter().skip(k).step_by(boxes);
            of_box.copied().collect()
        };
        (0..boxes).map(series).collect()
    }

    /// The distances over which boxes move together along x and along y, meters.
    fn correlation_lengths(&self, series: &[Option<Vec<[f64; 2]>>]) -> [Option<f64>; 2] {
        let region: Region = self.region.into();
        let [columns, rows] = self.boxes(&region);
        let size = region.max - region.min;
        let sides = [size.x / columns as f64, size.y / rows as f64];
        correlation_lengths(series, columns, sides)
    }
}

impl Measure for Oscillation {
    type Seen = Seen;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Observed::region("oscillation.region", Some(self.region))
    }

    fn about(&self) -> About {
        About {
            spectrum: Some((self.window().samples, self.band[0])),
            ..About::default()
        }
    }

    fn check(&self) -> Result<(), Problem> {
        self.window().check(NAME)?;
        let [low, high] = self.band;
        if high <= low {
            let reason = format!("its end, {high}, must be above its start, {low}");
            return Err(Problem::new("oscillation.band", reason));
        }
        let [columns, rows] = self.boxes(&wide_region("oscillation.region", self.region)?);
        match columns.saturating_mul(rows) {
            ..=MOST_BOXES => Ok(()),
            boxes => Err(Problem::new(
                "oscillation.box_size",
                format!("the region has {boxes} boxes; at most {MOST_BOXES} are allowed"),
            )),
        }
    }

    fn quantities(&self) -> Vec<Quantity> {
        let [low, high] = self.band;
        let band = format!("part of the power from {low} to {high} rad/s");
        let values = [
            (
                "peak_rad_per_s",
                "rad/s",
                "angular frequency with the most power density",
            ),
            (
                "peak_share",
                "",
                "part of the power within twice the resolution of the peak",
            ),
            ("band_share", "", band.as_str()),
            (
                "speed_m_per_s",
                "m/s",
                "root mean square, over times and boxes, of the mean velocities minus their means over time",
            ),
            (
                "spin",
                "",
                "mean over the boxes of (P₊ − P₋)/(P₊ + P₋) around the peak: counterclockwise 1, clockwise −1",
            ),
            (
                "spin_rms",
                "",
                "root mean square of the spin over the boxes",
            ),
            (
                "correlation_m",
                "m",
                "distance at which the correlation of the boxes' velocities falls below 1/e, the longer of x and y",
            ),
            ("correlation_x_m", "m", "the same along x"),
            ("correlation_y_m", "m", "the same along y"),
            (
                "boxes",
                "",
                "boxes that were never empty: all others are left out",
            ),
        ];
        Quantity::all(self.name(), &values)
    }

    fn observe(&self, seen: &mut Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let window = self.window();
        let (true, Some(region)) = (window.samples.is_due(simulation), window.region()) else {
            return;
        };
        seen.every = window.samples.secs(simulation);
        let [columns, rows] = self.boxes(&region);
        let size = region.max - region.min;
        let mut sums = vec![(0_u32, [0.0; 2]); columns * rows];
        let agents = simulation.frame().agents;
        for i in agents.present() {
            let (r, v) = (agents.position[i], agents.velocity[i]);
            if !region.contains(r) {
                continue;
            }
            let part = (r - region.min).component_div(&size);
            let place = |part: f64, count: usize| ((part * count as f64) as usize).min(count - 1);
            let (count, sum) = &mut sums[place(part.y, rows) * columns + place(part.x, columns)];
            *count += 1;
            *sum = [sum[0] + v.x, sum[1] + v.y];
        }
        let means = sums.into_iter().map(|(count, sum)| {
            (count > 0).then(|| sum.map(|component| component / f64::from(count)))
        });
        seen.velocities.extend(means);
    }

    fn values(&self, seen: &Seen, _: &Simulation) -> Vec<Option<f64>> {
        let series = self.series(seen);
        let Some(found) = Analyzed::of(&series, seen.every) else {
            return vec![None; self.quantities().len()];
        };
        let spins: Vec<f64> = found.spins.iter().copied().flatten().collect();
        let mean = |of: fn(&f64) -> f64| {
            let sum: f64 = spins.iter().map(of).sum();
            (!spins.is_empty()).then(|| sum / spins.len() as f64)
        };
        let [x, y] = self.correlation_lengths(&series);
        vec![
            found.peak,
            found.peak_share(),
            found.spectrum.share(self.band),
            speed(&series),
            mean(|spin| *spin),
            mean(|spin| spin * spin).map(f64::sqrt),
            [x, y].into_iter().flatten().reduce(f64::max),
            x,
            y,
            Some(series.iter().flatten().count() as f64),
        ]
    }

    fn data(&self, seen: &Seen) -> Option<(String, Value)> {
        let found = Analyzed::of(&self.series(seen), seen.every);
        Some((self.name().to_owned(), json!(found)))
    }
}
