//! The measurements in data: in the trajectory files from which runs begin.

use crate::error::LabError;
use runs::case::Case;
use runs::summary::Summary;
use scenario::measurements::Measurement;

/// The measurements of a scenario's lines and pushes for the people of the data from which it begins, from its start
/// on. People are measured as in a run, at their positions in its frames.
pub(super) fn measured(label: &str, case: &Case) -> Result<Summary, LabError> {
    let failed = |error| LabError::of(label, error);
    let draft = case.draft().map_err(failed)?;
    let data = draft.trajectories().map_err(failed)?;
    let scenario = draft.scenario().map_err(failed)?;
    let mut summary = Summary {
        scenario: scenario.name,
        ..Summary::default()
    };
    let Some((tracks, at)) = data else {
        return Ok(summary);
    };
    for measurement in &scenario.measurements {
        let (values, data) = match measurement {
            Measurement::LineFlow(line) => {
                let (values, passages) = line.of_tracks(&tracks, at, &scenario.scene);
                (values, Some(passages))
            }
            Measurement::Push(push) => (push.of_tracks(&tracks, at, &scenario.scene), None),
            _ => continue,
        };
        let number = |(name, value): (String, Option<f64>)| (name, value.into());
        summary.metrics.extend(values.into_iter().map(number));
        summary.data.extend(data);
    }
    Ok(summary)
}
