//! The cases of ISO 20414 and NIST TN 1822 that RiMEA lacks and a flat plan allows.

use crate::analysis::statistics::{MeanStd, uniform_probability};
use crate::engine::distribution::{Distribution, Family};
use crate::lab::error::LabError;
use crate::lab::suite::{Case, Check, Runs};

type Checks = Result<Vec<Check>, LabError>;

/// The reason why ten people do not always slow a hundred with RVO.
const FEW_AGAINST: &str = "ten people against a hundred change their time by less than chance does: by -1 to 3 % over \
     three seeds";

/// All cases, by number of ISO 20414.
pub const CASES: [Case; 9] = [
    Case {
        id: "iso1",
        about: "times before walking follow four distributions (NIST 1.1)",
        runs: &["premovement times"],
        judge: premovement_times,
        misses: &[],
        picture: ("premovement times", 60.0),
    },
    Case {
        id: "iso2",
        about: "one person of 1 m/s, from 10 m on (NIST 2.1)",
        runs: &["speed 1 m/s"],
        judge: |runs| {
            let speed = runs.metric("speed 1 m/s", "walks_speed_m_per_s")?;
            Ok(vec![Check::between("speed [m/s]", speed, 0.95, 1.05)])
        },
        misses: &[],
        picture: ("speed 1 m/s", 20.0),
    },
    Case {
        id: "iso5",
        about: "100 people with speeds of 1.2 ± 0.2 m/s (NIST 2.4)",
        runs: &["speeds"],
        judge: |runs| {
            let walks = runs.walks("speeds")?;
            let speeds: Vec<f64> = walks.iter().map(|walk| walk.meters / walk.secs).collect();
            let found = MeanStd::of(&speeds);
            let mean = found.map(|found| found.mean);
            let std = found.and_then(|found| found.std());
            Ok(vec![
                Check::between("mean [m/s]", mean, 1.15, 1.25),
                Check::between("standard deviation [m/s]", std, 0.15, 0.25),
            ])
        },
        misses: &[],
        picture: ("speeds", 15.0),
    },
    Case {
        id: "iso6",
        about: "100 people walk to another room against 0, 10, 50 and 100 others, through 10 m × 2 m (NIST 2.8)",
        runs: &COUNTERFLOW,
        judge: counterflow,
        misses: &[("rvo->sph", FEW_AGAINST)],
        picture: ("against 100", 20.0),
    },
    Case {
        id: "iso7",
        about: "24 people, with and without a slow and wide person before them (NIST 2.10)",
        runs: &["slow person", "no slow person"],
        judge: |runs| {
            let ratio = runs.ratio("t100_secs_fast", "slow person", "no slow person")?;
            let finished = runs.metric("slow person", "finished_fast")?;
            Ok(vec![
                Check::reported(
                    "time without [s]",
                    runs.metric("no slow person", "t100_secs_fast")?,
                ),
                Check::at_least("with, over without", ratio, 1.0),
                Check::exactly("people out", finished, 24.0),
            ])
        },
        misses: &[],
        picture: ("slow person", 10.0),
    },
    Case {
        id: "iso9",
        about: "the nearer exit closes after 1 s (NIST 4.1)",
        runs: &["closing"],
        judge: |runs| {
            Ok(vec![Check::exactly(
                "of 50, out by the other",
                runs.passed("closing", "exit 2")?,
                50.0,
            )])
        },
        misses: &[],
        picture: ("closing", 8.0),
    },
    Case {
        id: "iso10",
        about: "a corridor of 2 m narrows to 1 m: the jam is at the neck (NIST 5.1)",
        runs: &["neck"],
        judge: |runs| {
            let density = |at: &str| runs.metric("neck", &format!("{at}_density_per_m2"));
            let (neck, corridor) = (density("neck")?, density("corridor")?);
            let ratio = neck.zip(corridor).map(|(neck, corridor)| neck / corridor);
            Ok(vec![
                Check::reported("density before the neck [P/m²]", neck),
                Check::reported("density in the corridor [P/m²]", corridor),
                Check::at_least("ratio", ratio, 1.0),
            ])
        },
        misses: &[],
        picture: ("neck", 12.0),
    },
    Case {
        id: "iso11",
        about: "100 people, a door of 1 m: free, and with `most_per_sec` 1.33 (NIST 5.2)",
        runs: &["exit flow", "exit flow limited"],
        judge: |runs| {
            Ok(vec![
                Check::reported("flow [P/s]", runs.flow("exit flow", "door")?),
                Check::at_most(
                    "flow with the limit [P/s]",
                    runs.flow("exit flow limited", "door")?,
                    1.33 + 1e-3,
                ),
            ])
        },
        misses: &[],
        picture: ("exit flow", 8.0),
    },
    Case {
        id: "iso13",
        about: "60 to 480 people in a corridor of 60 m × 2 m: mean speed between 20 and 40 m",
        runs: &CORRIDORS,
        judge: |runs| {
            let check = |run: &str| {
                let speed = runs.metric(run, "walks_speed_m_per_s")?;
                let people = run.trim_start_matches("long corridor ");
                Ok(Check::at_most(format!("{people} people [m/s]"), speed, 1.4))
            };
            CORRIDORS.into_iter().map(check).collect()
        },
        misses: &[],
        picture: ("long corridor 240", 10.0),
    },
];

/// The groups of the case, and the distributions of their times, seconds.
const TIMES: [(&str, Family); 4] = [
    ("uniform", Family::Uniform([10.0, 100.0])),
    ("gamma", Family::Gamma([1.291, 103.901])),
    ("lognormal", Family::LogNormal([4.586, 0.967])),
    ("weibull", Family::Weibull([139.285, 1.195])),
];

/// Probabilities of the Kolmogorov–Smirnov test of the times of the starts. With 1 % for each of four distributions, 4
/// of 100 seeds fail by chance.
fn premovement_times(runs: &Runs) -> Checks {
    let walks = runs.walks("premovement times")?;
    let check = |(name, family): (&str, Family)| {
        let invalid = |error| LabError::Data(format!("{name}: {error}"));
        let distribution = Distribution::new(&family, [f64::NEG_INFINITY, f64::INFINITY]);
        let distribution = distribution.map_err(invalid)?;
        let own = walks.iter().filter(|walk| walk.group == name);
        let shares = own.map(|walk| Some(distribution.share_up_to(walk.started_secs?)));
        let shares: Option<Vec<f64>> = shares.collect();
        let probability = shares.and_then(|shares| uniform_probability(&shares));
        Ok(Check::at_least(
            format!("{name}: probability"),
            probability,
            0.01,
        ))
    };
    TIMES.into_iter().map(check).collect()
}

const COUNTERFLOW: [&str; 4] = ["against 0", "against 10", "against 50", "against 100"];
const CORRIDORS: [&str; 4] = [
    "long corridor 60",
    "long corridor 120",
    "long corridor 240",
    "long corridor 480",
];

/// The more people walk west, the longer the others take to walk east; all arrive.
fn counterflow(runs: &Runs) -> Checks {
    let name = "t100_secs_eastward";
    let mut checks = vec![Check::reported(
        "time against 0 [s]",
        runs.metric(COUNTERFLOW[0], name)?,
    )];
    for pair in COUNTERFLOW.windows(2) {
        let ratio = runs.ratio(name, pair[1], pair[0])?;
        let quantity = format!("{}, over {}", pair[1], pair[0]);
        checks.push(Check::at_least(quantity, ratio, 1.0));
    }
    let left: usize = COUNTERFLOW
        .iter()
        .try_fold(0, |sum, run| -> Result<usize, LabError> {
            let journeys = runs.of(run)?.journeys.iter();
            let left = journeys.map(|own| (own.left.started - own.left.finished) as usize);
            Ok(sum + left.sum::<usize>())
        })?;
    checks.push(Check::exactly(
        "people who do not arrive",
        Some(left as f64),
        0.0,
    ));
    Ok(checks)
}
