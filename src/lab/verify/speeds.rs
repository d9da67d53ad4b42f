//! Cases about speeds: by density, by age, in single file.

use crate::lab::error::LabError;
use crate::lab::suite::{Check, Runs};
use crate::scenario::measurements::Walk;

type Checks = Result<Vec<Check>, LabError>;

/// The runs of the fundamental diagram.
pub const DENSITIES: [&str; 7] = [
    "density 0.5",
    "density 1",
    "density 2",
    "density 3",
    "density 4",
    "density 5",
    "density 6",
];

/// Mean speed at three places 10 m apart, for each density.
pub fn fundamental_diagram(runs: &Runs) -> Checks {
    let mean = |run: &str, what: &str| -> Result<Option<f64>, LabError> {
        let at = |place: &str| runs.metric(run, &format!("{place}_{what}"));
        let places = [at("west")?, at("middle")?, at("east")?];
        let places: Option<Vec<f64>> = places.into_iter().collect();
        Ok(places.map(|places| places.iter().sum::<f64>() / 3.0))
    };
    let mut checks = Vec::new();
    let mut ends = [None; 2];
    for (k, run) in DENSITIES.into_iter().enumerate() {
        let speed = mean(run, "speed_m_per_s")?;
        ends[usize::from(k > 0)] = speed;
        let density = run.trim_start_matches("density ");
        checks.push(Check::reported(
            format!("speed at about {density} P/m² [m/s]"),
            speed,
        ));
        if matches!(k, 0 | 6) {
            checks.push(Check::reported(
                "density there [P/m²]",
                mean(run, "density_per_m2")?,
            ));
        }
    }
    let [free, dense] = ends;
    let ratio = dense.zip(free).map(|(dense, free)| dense / free);
    checks.push(Check::at_most(
        "speed at 6, over speed at 0.5 P/m²",
        ratio,
        0.5,
    ));
    Ok(checks)
}

/// The ages, each with the range of its speeds, m/s.
const AGES: [(&str, [f64; 2]); 6] = [
    ("20", [1.60, 1.64]),
    ("30", [1.52, 1.56]),
    ("40", [1.46, 1.50]),
    ("50", [1.39, 1.43]),
    ("60", [1.24, 1.30]),
    ("70", [1.04, 1.10]),
];

/// Assigned and walked speeds by age.
pub fn ages(runs: &Runs) -> Checks {
    let walks = runs.walks("ages")?;
    let mut checks = Vec::new();
    for (age, [low, high]) in AGES {
        let own: Vec<&Walk> = walks.iter().filter(|walk| walk.group == age).collect();
        let mean = own.iter().map(|walk| walk.preferred_speed).sum::<f64>() / own.len() as f64;
        checks.push(Check::between(
            format!("speed at {age} years [m/s]"),
            Some(mean),
            low,
            high,
        ));
    }
    let off = walks
        .iter()
        .map(|walk| (walk.meters / walk.secs - walk.preferred_speed).abs());
    let largest = off.reduce(f64::max);
    checks.push(Check::at_most(
        "largest deviation while walking [m/s]",
        largest,
        0.03,
    ));
    Ok(checks)
}

/// The runs with their densities, 1/m, and the 10 and 90 % quantiles of measured speeds there, m/s.
pub const BANDS: [(&str, &str, [f64; 2]); 4] = [
    ("single file 13", "0.5", [0.71, 1.39]),
    ("single file 24", "0.9", [0.45, 1.10]),
    ("single file 30", "1.1", [0.32, 0.84]),
    ("single file 40", "1.5", [0.11, 0.49]),
];

/// Mean speeds in single file.
pub fn single_file(runs: &Runs) -> Checks {
    let check = |(run, density, [low, high]): (&str, &str, [f64; 2])| {
        let speed = runs.metric(run, "ring_speed_m_per_s")?;
        Ok(Check::between(
            format!("speed at {density} P/m [m/s]"),
            speed,
            low,
            high,
        ))
    };
    BANDS.into_iter().map(check).collect()
}
