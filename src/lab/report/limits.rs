//! The assumptions and limits of the model, and its status in this version.

use crate::output::document::Block;
use crate::scenario::calibrated;

/// The results of `sandbox verify` and `sandbox validate` in this version, as its documents have them.
const VERIFICATION: &str = include_str!("../../../docs/verification.md");
const VALIDATION: &str = include_str!("../../../docs/validation.md");
/// The line of these documents that counts what passed.
const COUNTS: &str = "Passed by ";

/// Assumptions and limits, for these profiles.
pub fn limits(profiles: &[&str]) -> Vec<Block> {
    let mut items: Vec<String> = [
        "People are discs on one flat floor. They know the floor plan, and walk to their places by the shortest or, \
         where the scenario says so, the quickest way. There are no groups, no smoke, no falls and no lifts; stairs \
         are zones of lower speed.",
        "Densities, pressures and forces are those of a model. Thresholds are from the literature: they help to \
         compare runs and are no safety limits. The model says nothing about injuries or deaths.",
        "A single run has chance in it: another seed gives other numbers. `sandbox estimate` gives results with their \
         errors, a study with several seeds their spread.",
        "Before decisions about people's safety, the model must be compared with measurements of a crowd like this \
         one.",
    ]
    .map(str::to_owned)
    .into();
    for profile in profiles {
        items.push(match calibrated::named(profile) {
            Some(_) => format!(
                "`{profile}` is fitted to experiments. The status below says how many values of experiments it \
                 reproduces; flows through openings can be too high where people hurry, and pushes die out."
            ),
            None => format!(
                "`{profile}` is a profile of the paper or one of the scenario's own. It is not fitted to experiments: \
                 with the paper's profiles dense crowds walk two to five times as fast as people do, which is the \
                 unsafe side. Do not size exits with it; take `steer+sph` for questions about real people."
            ),
        });
    }
    vec![Block::heading("Assumptions and limits"), Block::List(items)]
}

/// How far this version is verified and validated.
pub fn status() -> Vec<Block> {
    let counts = |text: &str| {
        let line = text.lines().find(|line| line.starts_with(COUNTS));
        line.unwrap_or("not known")
            .replace("Bold: not as expected. ", "")
    };
    let version = env!("CARGO_PKG_VERSION");
    vec![
        Block::heading("Verification and validation"),
        Block::text(format!(
            "Version {version} was checked by the cases of RiMEA, ISO 20414 and NIST that a flat plan allows (`sandbox \
             verify`), and compared with experiments (`sandbox validate`: a value counts if it is within the tolerance \
             of the field). docs/verification.md and docs/validation.md have all cases and the known misses."
        )),
        Block::List(vec![
            format!("Verification. {}", counts(VERIFICATION)),
            format!("Validation. {}", counts(VALIDATION)),
        ]),
    ]
}
