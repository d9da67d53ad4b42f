//! What `sandbox verify` and `sandbox validate` say of profiles in this version, after the values that were held out.

use super::held_out::HeldOut;
use crate::error::LabError;
use crate::suite::{Passed, Status, shipped};
use output::document::Block;
use scenario::catalog;
use scenario::quote::shown;

/// The results in this version: data beside the documents, which `--update` writes for the two suites.
struct Known {
    held_out: HeldOut,
    verified: Status,
    validated: Status,
}

impl Known {
    fn shipped() -> Result<Self, LabError> {
        Ok(Self {
            held_out: shipped(
                "docs/findings/held_out.json",
                include_str!("../../../docs/findings/held_out.json"),
            )?,
            verified: Status::verified()?,
            validated: Status::validated()?,
        })
    }
}

/// How far these profiles are verified and validated. `is_changed`: the run changes their parameters.
///
/// # Errors
/// A data file that ships with the program is invalid.
pub fn status(profiles: &[&str], is_changed: bool) -> Result<Vec<Block>, LabError> {
    let version = env!("CARGO_PKG_VERSION");
    let known = Known::shipped()?;
    let mut items = Vec::new();
    for profile in profiles {
        let name = shown(profile);
        let held_out = known.held_out.said_of(profile);
        items.extend(held_out.map(|said| format!("`{name}`, {said}")));
        let measured = match known.validated.profiles.get(*profile) {
            Some(one) => validated(one),
            None => unknown(profile).to_owned(),
        };
        items.push(format!("`{name}`, `sandbox validate`: {measured}."));
        let said = match known.verified.profiles.get(*profile) {
            Some(one) => {
                let missed = missed(&one.missed);
                format!("{} of {} cases pass{missed}", one.passed, one.cases)
            }
            None => unknown(profile).to_owned(),
        };
        items.push(format!("`{name}`, `sandbox verify`: {said}."));
    }
    if is_changed {
        items.push(
            "This run changes parameters of the profile (above): these numbers hold for it without these changes."
                .to_owned(),
        );
    }
    Ok(vec![
        Block::heading("Verification and validation"),
        Block::text(format!(
            "Values that were held out come first: nothing was fitted to them. `sandbox validate` compares flows, \
             densities and speeds with published experiments, to most of which the calibrated profiles were fitted. \
             Tolerances: 6 % for flows, 10 % for densities and speeds. `sandbox verify` runs small cases with known \
             answers. They follow tests of RiMEA, ISO 20414 and NIST on floors and stairs, but were not checked \
             against the texts of these guidelines. docs/findings/validation.md and docs/findings/verification.md list \
             all cases and the known misses. In version {version}:"
        )),
        Block::List(items),
    ])
}

/// What a profile passes of the scenes of experiments.
fn validated(one: &Passed) -> String {
    let ([inside, all], [of_fitted, fitted]) = (one.values, one.fitted);
    let of_fitted = match fitted {
        0 => "none of them fitted".to_owned(),
        _ => format!("{of_fitted} of them fitted"),
    };
    let (passed, cases, missed) = (one.passed, one.cases, missed(&one.missed));
    format!(
        "{inside} of {all} measured values are within the tolerances, {of_fitted}; all values of {passed} of {cases} \
         scenes{missed}"
    )
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_data_that_ship_with_the_program_are_valid() {
        let known = Known::shipped().unwrap();
        assert_eq!(known.validated.suite, "validation");
        assert_eq!(known.verified.suite, "verification");
    }

    #[test]
    fn invalid_data_are_an_error_with_the_file_and_the_place() {
        let said = |text| {
            let error = shipped::<Status>("docs/findings/validation.json", text).unwrap_err();
            error.to_string()
        };
        let cut = said("{\n  \"suite\": \"validation\",\n  \"profiles\": {");
        assert_eq!(
            cut,
            "docs/findings/validation.json: EOF while parsing an object at line 3 column 15"
        );
        let unknown = said("{\n  \"suit\": \"validation\"\n}");
        assert!(
            unknown.starts_with("docs/findings/validation.json: unknown field `suit`"),
            "{unknown}"
        );
        assert!(unknown.ends_with("at line 2 column 8"), "{unknown}");
    }
}
