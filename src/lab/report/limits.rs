//! The assumptions and limits of the model.

use output::document::Block;
use scenario::calibrated;
use scenario::quote::shown;

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
        let name = shown(profile);
        items.push(match calibrated::named(profile) {
            Some(_) => format!(
                "`{name}` is fitted to experiments; the status below counts the measured values that it reproduces, \
                 first those to which nothing was fitted. Exits of about 1 m pass up to \
                 a fifth more people than measured, which is the unsafe side, and pushes die out."
            ),
            None => format!(
                "`{name}` is a profile of the paper or one of the scenario's own. It is not fitted to experiments: \
                 with the paper's profiles dense crowds walk two to five times as fast as people do, which is the \
                 unsafe side. Do not size exits with it; take `steer+sph` for questions about real people."
            ),
        });
    }
    vec![Block::heading("Assumptions and limits"), Block::List(items)]
}
