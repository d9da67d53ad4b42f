//! The wave that a push sends along x through a crowd: its speed, amplitude and reflection.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::{Measure, Observed, Quantity, is_due};
use crate::error::Problem;
use crate::keys::limits::LONGEST_TIME;
use analysis::evaluated::Evaluated;
use analysis::wave::{self, Run, SpaceTime, Strip};
use engine::simulation::Simulation;

/// The speed at which a wave arrives at an obstacle, m/s, its amplitude, m/s, and how much of it is reflected, found in
/// the space-time diagram of a strip along x (see `analysis::wave`); the diagram itself is its data.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// When the push begins, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    start_secs: f64,
    /// x of the push, meters.
    #[schemars(range(min = -1e6, max = 1e6))]
    source: f64,
    /// x of the obstacle, meters.
    #[schemars(range(min = -1e6, max = 1e6))]
    obstacle: f64,
    /// Ends of the strip, meters.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    x: [f64; 2],
    /// Maximum |y| in the strip, meters.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    half_width: f64,
    /// Length of a bin along x, meters.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    bin: f64,
    /// Start of the diagram, before the push, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    from_secs: f64,
    /// End of the diagram, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    until_secs: f64,
    /// Time between the columns of the diagram, seconds.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    #[serde(default = "often")]
    every_secs: f64,
}

fn often() -> f64 {
    0.04
}

impl Wave {
    fn run(&self) -> Run {
        Run {
            start: self.start_secs,
            source: self.source,
            obstacle: self.obstacle,
        }
    }

    fn strip(&self) -> Strip {
        Strip {
            x: self.x,
            half_width: self.half_width,
            bin: self.bin,
        }
    }
}

/// The data of a [`Wave`].
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct WaveData {
    /// The push and the obstacle.
    pub run: Run,
    /// Mean speeds over x and t.
    pub diagram: SpaceTime,
    /// The wave; `None` if none stands out.
    pub wave: Option<wave::Wave>,
}

impl WaveData {
    /// The name of these data.
    pub const NAME: &'static str = "wave";
}

impl Measure for Wave {
    type Seen = Option<SpaceTime>;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn check(&self) -> Result<(), Problem> {
        match self.strip().bins() {
            2..=100_000 => Ok(()),
            bins => Err(Problem::new(
                "wave.bin",
                format!("the strip must have from 2 to 100000 bins, not {bins}"),
            )),
        }
    }

    fn quantities(&self) -> Vec<Quantity> {
        vec![
            Quantity::new("wave_speed_m_per_s", "m/s", "speed of the crest along x"),
            Quantity::new(
                "wave_amplitude_m_per_s",
                "m/s",
                "amplitude of its velocity before the obstacle",
            ),
            Quantity::new(
                "wave_reflection",
                "",
                "amplitude after the reflection / amplitude before it",
            ),
        ]
    }

    fn observe(&self, seen: &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        if is_due(
            simulation,
            [self.from_secs, self.until_secs],
            self.every_secs,
        ) {
            let diagram = seen.get_or_insert_with(|| SpaceTime::new(self.strip()));
            diagram.observe(&simulation.frame());
        }
    }

    fn values(&self, seen: &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        let diagram = seen.as_ref();
        let wave = diagram.and_then(|diagram| wave::measure(diagram, &self.run()));
        let reflection = wave.as_ref().and_then(|wave| wave.reflection);
        vec![
            wave.as_ref().map(|wave| wave.arriving.speed.value),
            wave.as_ref().map(|wave| wave.amplitude.value),
            reflection.map(|reflection| reflection.value),
        ]
    }

    fn data(&self, seen: &Self::Seen) -> Option<(String, Value)> {
        let data = seen.clone().map(|diagram| WaveData {
            run: self.run(),
            wave: wave::measure(&diagram, &self.run()),
            diagram,
        });
        Some((WaveData::NAME.to_owned(), json!(data)))
    }
}
