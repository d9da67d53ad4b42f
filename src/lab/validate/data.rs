//! Scenes that begin with the people of an experiment, where and when they were in its trajectories. The files are not
//! part of the program: `docs/validation.md` says how to get them.

use super::bottlenecks::Measured;
use crate::lab::error::LabError;
use crate::lab::suite::{Case, Check, DataFile, NOTHING_SLOWS, Runs};

/// The runs, with the names of their lines.
const LINES: [(&str, &str); 2] = [
    ("data bottleneck", "entrance"),
    ("data corridor", "corridor"),
];

/// Their files.
pub const FILES: [DataFile; 2] = [
    DataFile {
        run: LINES[0].0,
        name: "040_c_56_h-.txt",
        source: "doi:10.34735/ped.2018.1, or notebooks/demo-data/bottleneck of github.com/PedestrianDynamics/PedPy",
    },
    DataFile {
        run: LINES[1].0,
        name: "uo-180-180-180.txt",
        source: "https://ped.fz-juelich.de/da, or notebooks/demo-data/uni-directional of \
                 github.com/PedestrianDynamics/PedPy",
    },
];

/// Why crowds of the paper's profiles are too fast at the entrance.
const MISSES: &[(&str, &str)] = &[
    ("sph", NOTHING_SLOWS),
    ("sf->sph", NOTHING_SLOWS),
    ("rvo->sph", NOTHING_SLOWS),
    (
        "walk+sph",
        "the agents keep more distance than these people at the entrance, and less in the corridor",
    ),
];

/// All scenes.
pub const CASES: [Case; 2] = [
    Case {
        id: "data-bottleneck",
        about: "75 people pass an entrance 0.5 m wide, from where they stood (University of Wuppertal, 2018)",
        runs: &[LINES[0].0],
        judge: |runs| checks(runs, LINES[0]),
        misses: MISSES,
        picture: (LINES[0].0, 10.0),
    },
    Case {
        id: "data-corridor",
        about: "220 people enter a corridor of 1.8 m where and when they did (Hermes project, 2009, run \
                uo-180-180-180)",
        runs: &[LINES[1].0],
        judge: |runs| checks(runs, LINES[1]),
        misses: MISSES,
        picture: (LINES[1].0, 30.0),
    },
];

/// The measurements in the data of the runs with data.
pub fn measured<'a>(runs: &'a Runs<'a>) -> impl Iterator<Item = Measured> + 'a {
    LINES.into_iter().filter_map(|line| at(runs, line))
}

/// The measurements in the data of a run; `None` without data.
fn at(runs: &Runs, (run, line): (&'static str, &'static str)) -> Option<Measured> {
    let data = runs.data(run)?;
    let value = |what: &str| data.metric(&format!("{line}_{what}")).unwrap_or(f64::NAN);
    Some(Measured {
        run,
        line,
        flow: value("flow_per_s"),
        density: value("density_per_m2"),
        speed: value("speed_m_per_s"),
    })
}

fn checks(runs: &Runs, line: (&'static str, &'static str)) -> Result<Vec<Check>, LabError> {
    let measured = at(runs, line).ok_or_else(|| LabError::missing(line.0, "data"))?;
    let values = [measured.flow, measured.density, measured.speed];
    if values.iter().any(|value| value.is_nan()) {
        let what = format!("flow, density or speed at the line {} in the data", line.1);
        return Err(LabError::missing(line.0, what));
    }
    measured.checks(runs)
}
