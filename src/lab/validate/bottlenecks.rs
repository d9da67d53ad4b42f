//! Gaps, a door and corridors.

use crate::lab::error::LabError;
use crate::lab::suite::{Case, Check, Runs};

/// Tolerances of calibrations at Jülich: of flows, densities and speeds, as parts of the measured value.
const TOLERANCES: [f64; 3] = [0.06, 0.10, 0.10];

/// Why crowds are too fast.
pub const NOTHING_SLOWS: &str = "nothing slows a crowd whose agents all walk at the same velocity: pressure, contact and \
     avoidance act on differences of velocity or on overlaps only";

/// Why crowds before a door are not dense.
const DISTANCE: &str = "avoidance keeps people before the door farther apart than pupils stand";

/// The profiles of the paper, which miss nearly all of these scenes.
const MISSES: &[(&str, &str)] = &[
    ("sph", NOTHING_SLOWS),
    ("sf->sph", NOTHING_SLOWS),
    ("rvo->sph", NOTHING_SLOWS),
];

/// All scenes.
pub const CASES: [Case; 7] = [
    Case {
        id: "gap-2.4",
        about: "350 people, about 3 P/m² before it, pass a gap of 2.4 m between walls 1 m thick (Hermes project, 2009)",
        runs: &["gap 2.4 m"],
        judge: |runs| checks(runs, "gap 2.4 m", "gap", [6.07, 5.57, 0.320]),
        misses: MISSES,
        picture: ("gap 2.4 m", 10.0),
    },
    Case {
        id: "gap-3.6",
        about: "the gap is 3.6 m wide",
        runs: &["gap 3.6 m"],
        judge: |runs| checks(runs, "gap 3.6 m", "gap", [8.96, 4.83, 0.445]),
        misses: MISSES,
        picture: ("gap 3.6 m", 10.0),
    },
    Case {
        id: "gap-5",
        about: "the gap is 5 m wide",
        runs: &["gap 5 m"],
        judge: |runs| checks(runs, "gap 5 m", "gap", [13.82, 4.09, 0.631]),
        misses: MISSES,
        picture: ("gap 5 m", 8.0),
    },
    Case {
        id: "door",
        about: "46 pupils leave by a door of 0.8 m (doi:10.34735/ped.2014.1)",
        runs: &["door 0.8 m"],
        judge: |runs| checks(runs, "door 0.8 m", "door", [2.60, 6.1, 0.335]),
        misses: &[
            ("sph", NOTHING_SLOWS),
            ("sf->sph", DISTANCE),
            ("rvo->sph", DISTANCE),
        ],
        picture: ("door 0.8 m", 5.0),
    },
    Case {
        id: "corridor-1",
        about: "2.48 P/s enter a corridor of 1.8 m (run uo-100-180-180)",
        runs: &["corridor 1"],
        judge: |runs| checks(runs, "corridor 1", "corridor", [2.48, 1.14, 1.21]),
        misses: &[("sph", NOTHING_SLOWS), ("rvo->sph", NOTHING_SLOWS)],
        picture: ("corridor 1", 30.0),
    },
    Case {
        id: "corridor-2",
        about: "2.89 P/s enter it (run uo-180-180-180)",
        runs: &["corridor 2"],
        judge: |runs| checks(runs, "corridor 2", "corridor", [2.89, 1.68, 0.96]),
        misses: MISSES,
        picture: ("corridor 2", 30.0),
    },
    Case {
        id: "corridor-3",
        about: "2.89 P/s enter it, and its end is 0.7 m wide (run uo-180-180-070)",
        runs: &["corridor 3"],
        judge: |runs| checks(runs, "corridor 3", "corridor", [1.71, 3.06, 0.34]),
        misses: MISSES,
        picture: ("corridor 3", 30.0),
    },
];

/// Flow, density and speed at a line, beside the measured ones.
fn checks(
    runs: &Runs,
    label: &str,
    line: &str,
    measured: [f64; 3],
) -> Result<Vec<Check>, LabError> {
    let quantities = [
        ("flow [P/s]", "flow_per_s"),
        ("density [P/m²]", "density_per_m2"),
        ("speed [m/s]", "speed_m_per_s"),
    ];
    let all = quantities.into_iter().zip(measured).zip(TOLERANCES);
    all.map(|(((quantity, name), measured), tolerance)| {
        let value = runs.metric(label, &format!("{line}_{name}"))?;
        Ok(Check::near(quantity, value, (measured, tolerance)))
    })
    .collect()
}
