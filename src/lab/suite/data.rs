//! The measurements in data: in the trajectory files from which runs begin.

use crate::error::LabError;
use runs::case::Case;
use runs::summary::Summary;
use scenario::Scenario;
use scenario::measurements::Measurement;
use scenario::trajectories::Tracks;

/// The measurements of a scenario's lines and pushes for the people of the data from which it begins, from its start
/// on. People are measured as in a run, at their positions in its frames.
pub(super) fn measured(label: &str, case: &Case) -> Result<Summary, LabError> {
    let failed = |error| LabError::of(label, error);
    let draft = case.draft().map_err(failed)?;
    let data = draft.trajectories().map_err(failed)?;
    let scenario = draft.scenario().map_err(failed)?;
    let name = scenario.name.clone();
    let mut summary = data.map_or_else(Summary::default, |(tracks, at)| {
        of_tracks(&tracks, at, &scenario)
    });
    summary.scenario = name;
    Ok(summary)
}

/// The measurements of a scenario's lines and pushes for people in `tracks` from the time `at` in them, seconds, on.
pub(super) fn of_tracks(tracks: &Tracks, at: f64, scenario: &Scenario) -> Summary {
    let mut summary = Summary::default();
    for measurement in &scenario.measurements {
        let (values, data) = match measurement {
            Measurement::LineFlow(line) => {
                let (values, passages) = line.of_tracks(tracks, at, &scenario.scene);
                (values, Some(passages))
            }
            Measurement::Push(push) => (push.of_tracks(tracks, at, &scenario.scene), None),
            _ => continue,
        };
        let number = |(name, value): (String, Option<f64>)| (name, value.into());
        summary.metrics.extend(values.into_iter().map(number));
        summary.data.extend(data);
    }
    summary
}

/// Whether people in tracks have this result of a scenario.
pub(super) fn has_result(scenario: &Scenario, name: &str) -> bool {
    let is_of_tracks =
        |one: &&Measurement| matches!(one, Measurement::LineFlow(_) | Measurement::Push(_));
    let mut measured = scenario.measurements.iter().filter(is_of_tracks);
    measured.any(|one| one.names().iter().any(|own| own == name))
}
