//! What `sandbox verify` and `sandbox validate` say of profiles in this version.

use std::sync::LazyLock;

use crate::lab::suite::Status;
use crate::output::document::Block;
use crate::scenario::catalog;
use crate::scenario::quote::shown;

/// The results of the two suites in this version, which `--update` writes beside their documents.
static STATUS: LazyLock<Vec<Option<Status>>> = LazyLock::new(|| {
    let texts = [
        include_str!("../../../docs/verification.json"),
        include_str!("../../../docs/validation.json"),
    ];
    // A test reads them.
    texts.map(|text| serde_json::from_str(text).ok()).into()
});

/// How far these profiles are verified and validated. `is_changed`: the run changes their parameters.
pub fn status(profiles: &[&str], is_changed: bool) -> Vec<Block> {
    let version = env!("CARGO_PKG_VERSION");
    let mut items = Vec::new();
    for profile in profiles {
        let [verified, validated] = [0, 1].map(|k| {
            let status = STATUS.get(k).and_then(Option::as_ref)?;
            status.profiles.get(*profile)
        });
        let name = shown(profile);
        items.push(match verified {
            Some(one) => format!(
                "`{name}`, `sandbox verify`: {} of {} cases pass{}.",
                one.passed,
                one.cases,
                missed(&one.missed)
            ),
            None => format!("`{name}`, `sandbox verify`: {}.", unknown(profile)),
        });
        items.push(match validated {
            Some(one) => format!(
                "`{name}`, `sandbox validate`: {} of {} measured values are within the tolerance of the field; all \
                 values of {} of {} scenes{}.",
                one.values[0],
                one.values[1],
                one.passed,
                one.cases,
                missed(&one.missed)
            ),
            None => format!("`{name}`, `sandbox validate`: {}.", unknown(profile)),
        });
    }
    if is_changed {
        items.push(
            "This run changes parameters of the profile (above): these numbers hold for it without these changes."
                .to_owned(),
        );
    }
    vec![
        Block::heading("Verification and validation"),
        Block::text(format!(
            "`sandbox verify` runs small cases with known answers. They follow the tests of RiMEA, ISO 20414 and NIST \
             that a flat plan allows, but were not checked against the texts of these guidelines. `sandbox validate` \
             compares flows, densities and speeds with published experiments. docs/verification.md and \
             docs/validation.md list all cases and the known misses. In version {version}:"
        )),
        Block::List(items),
    ]
}

fn missed(cases: &[String]) -> String {
    match cases {
        [] => String::new(),
        cases => format!("; missed: {}", cases.join(", ")),
    }
}

/// Why nothing is known of a profile.
fn unknown(profile: &str) -> &'static str {
    match catalog::names().contains(&profile) {
        true => "this version has no result of this profile",
        false => "not run with the scenario's own profile",
    }
}
