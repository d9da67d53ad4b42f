//! Gaps, a door and corridors.

use crate::lab::error::LabError;
use crate::lab::suite::{Case, Check, NOTHING_SLOWS, Runs};

/// Tolerances of calibrations at Jülich: of flows, densities and speeds, as parts of the measured value.
const TOLERANCES: [f64; 3] = [0.06, 0.10, 0.10];

/// Why crowds before a door are not dense.
const DISTANCE: &str = "avoidance keeps people before the door farther apart than pupils stand";

/// Why crowds of `walk+sph` are too loose before wide gaps.
const WIDE: &str = "people speed up before a wide gap at densities at which they hardly move in corridors; one time \
                    gap gives the one or the other";

/// The profiles of the paper, which miss nearly all of these scenes.
const MISSES: &[(&str, &str)] = &[
    ("sph", NOTHING_SLOWS),
    ("sf->sph", NOTHING_SLOWS),
    ("rvo->sph", NOTHING_SLOWS),
];

/// The calibrated profile, at wide gaps.
const ALL_MISS: &[(&str, &str)] = &[MISSES[0], MISSES[1], MISSES[2], ("walk+sph", WIDE)];

/// The measured values at a line.
#[derive(Debug, Clone, Copy)]
pub struct Measured {
    /// The run.
    pub run: &'static str,
    /// The name of the line.
    pub line: &'static str,
    /// P/s.
    pub flow: f64,
    /// P/m².
    pub density: f64,
    /// m/s.
    pub speed: f64,
}

/// At all lines.
pub const MEASURED: [Measured; 7] = [
    Measured::at("gap 2.4 m", "gap", [6.07, 5.57, 0.320]),
    Measured::at("gap 3.6 m", "gap", [8.96, 4.83, 0.445]),
    Measured::at("gap 5 m", "gap", [13.82, 4.09, 0.631]),
    Measured::at("door 0.8 m", "door", [2.60, 6.1, 0.335]),
    Measured::at("corridor 1", "corridor", [2.48, 1.14, 1.21]),
    Measured::at("corridor 2", "corridor", [2.89, 1.68, 0.96]),
    Measured::at("corridor 3", "corridor", [1.71, 3.06, 0.34]),
];

/// All scenes.
pub const CASES: [Case; 7] = [
    Case {
        id: "gap-2.4",
        about: "350 people, about 3 P/m² before it, pass a gap of 2.4 m between walls 1 m thick (Hermes project, 2009)",
        runs: &[MEASURED[0].run],
        judge: |runs| MEASURED[0].checks(runs),
        misses: MISSES,
        picture: (MEASURED[0].run, 10.0),
    },
    Case {
        id: "gap-3.6",
        about: "the gap is 3.6 m wide",
        runs: &[MEASURED[1].run],
        judge: |runs| MEASURED[1].checks(runs),
        misses: ALL_MISS,
        picture: (MEASURED[1].run, 10.0),
    },
    Case {
        id: "gap-5",
        about: "the gap is 5 m wide",
        runs: &[MEASURED[2].run],
        judge: |runs| MEASURED[2].checks(runs),
        misses: ALL_MISS,
        picture: (MEASURED[2].run, 8.0),
    },
    Case {
        id: "door",
        about: "46 pupils leave by a door of 0.8 m (doi:10.34735/ped.2014.1)",
        runs: &[MEASURED[3].run],
        judge: |runs| MEASURED[3].checks(runs),
        misses: &[
            ("sph", NOTHING_SLOWS),
            ("sf->sph", DISTANCE),
            ("rvo->sph", DISTANCE),
            (
                "walk+sph",
                "pupils press closer and faster through a door than the adults whose figures were fitted",
            ),
        ],
        picture: (MEASURED[3].run, 5.0),
    },
    Case {
        id: "corridor-1",
        about: "2.48 P/s enter a corridor of 1.8 m (run uo-100-180-180)",
        runs: &[MEASURED[4].run],
        judge: |runs| MEASURED[4].checks(runs),
        misses: &[(
            "walk+sph",
            "a slow person holds up all behind it: no force leads people around each other",
        )],
        picture: (MEASURED[4].run, 30.0),
    },
    Case {
        id: "corridor-2",
        about: "2.89 P/s enter it (run uo-180-180-180)",
        runs: &[MEASURED[5].run],
        judge: |runs| MEASURED[5].checks(runs),
        misses: MISSES,
        picture: (MEASURED[5].run, 30.0),
    },
    Case {
        id: "corridor-3",
        about: "2.89 P/s enter it, and its end is 0.7 m wide (run uo-180-180-070)",
        runs: &[MEASURED[6].run],
        judge: |runs| MEASURED[6].checks(runs),
        misses: MISSES,
        picture: (MEASURED[6].run, 30.0),
    },
];

impl Measured {
    const fn at(run: &'static str, line: &'static str, [flow, density, speed]: [f64; 3]) -> Self {
        Self {
            run,
            line,
            flow,
            density,
            speed,
        }
    }

    /// Flow, density and speed at the line, compared with the measured ones.
    pub fn checks(&self, runs: &Runs) -> Result<Vec<Check>, LabError> {
        let quantities = [
            ("flow [P/s]", "flow_per_s", self.flow),
            ("density [P/m²]", "density_per_m2", self.density),
            ("speed [m/s]", "speed_m_per_s", self.speed),
        ];
        let all = quantities.into_iter().zip(TOLERANCES);
        all.map(|((quantity, name, measured), tolerance)| {
            let value = runs.metric(self.run, &format!("{}_{name}", self.line))?;
            let check = Check::near(quantity, value, (measured, tolerance));
            Ok(check.of_run(self.run))
        })
        .collect()
    }
}
