//! Speeds by density in an endless corridor, and in single file.

use crate::lab::error::LabError;
use crate::lab::suite::{Case, Check, NOTHING_SLOWS, Runs};
use crate::lab::verify::rimea::RVO_SINGLE_FILE;
use crate::lab::verify::speeds::{BANDS, single_file};

/// The tolerance of calibrations at Jülich for speeds, as a fraction of the measured value.
const TOLERANCE: f64 = 0.10;

/// The runs, with their densities, P/m², and the mean speeds that were measured there, m/s.
pub const SPEEDS: [(&str, f64, f64); 7] = [
    ("density 0.75", 0.75, 1.14),
    ("density 1.25", 1.25, 1.11),
    ("density 1.75", 1.75, 0.89),
    ("density 2.25", 2.25, 0.55),
    ("density 2.75", 2.75, 0.38),
    ("density 3.25", 3.25, 0.33),
    ("density 3.75", 3.75, 0.28),
];

/// All scenes.
pub const CASES: [Case; 2] = [
    Case {
        id: "speeds",
        about: "people of 1.34 m/s in an endless corridor of 1.8 m, beside runs in corridors of 1.8 to 3 m (Hermes \
                project)",
        runs: &[
            SPEEDS[0].0,
            SPEEDS[1].0,
            SPEEDS[2].0,
            SPEEDS[3].0,
            SPEEDS[4].0,
            SPEEDS[5].0,
            SPEEDS[6].0,
        ],
        judge: speeds,
        misses: &[
            ("sph", NOTHING_SLOWS),
            ("sf->sph", NOTHING_SLOWS),
            ("rvo->sph", NOTHING_SLOWS),
            (
                "walk+sph",
                "at 3.25 P/m² people stay in the three files in which they start, each as slow as a single file",
            ),
        ],
        picture: ("density 2.25", 60.0),
    },
    Case {
        id: "single-file",
        about: "single file around an oval of 26.8 m: mean speeds within the 10 to 90 % band of measured ones (RiMEA \
                16)",
        runs: &[BANDS[0].0, BANDS[1].0, BANDS[2].0, BANDS[3].0],
        judge: single_file,
        misses: &[
            ("sph", NOTHING_SLOWS),
            ("sf->sph", NOTHING_SLOWS),
            ("rvo->sph", RVO_SINGLE_FILE),
            (
                "walk+sph",
                "in a corridor of 0.8 m people walk left and right of each other, outside of each other's lanes",
            ),
        ],
        picture: ("single file 30", 45.0),
    },
];

fn speeds(runs: &Runs) -> Result<Vec<Check>, LabError> {
    let check = |(run, density, measured): (&'static str, f64, f64)| {
        let value = runs.metric(run, "ring_speed_m_per_s")?;
        let quantity = format!("speed at {density} P/m² [m/s]");
        Ok(Check::near(quantity, value, (measured, TOLERANCE)).of_run(run))
    };
    SPEEDS.into_iter().map(check).collect()
}
