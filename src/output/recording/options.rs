//! What a recording is to show.

use super::debug::DebugAgents;
use crate::drawing::Drawn;
use engine::math::Vector;
use engine::scene::Region;
use runs::identity::Identity;
use scenario::Scenario;
use scenario::floor_plan::Label;

/// The texts and views of a recording, in addition to the simulation itself.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingOptions {
    /// Its identity: the viewer merges recordings with the same one.
    pub id: String,
    /// Its subject, for example the scenario's name: the viewer keeps one layout for all recordings with the same name.
    /// Not empty.
    pub application: String,
    /// Its title in the viewer, for example the scenario's name and the settings that differ from its file.
    pub title: String,
    /// A one-line description; may be empty.
    pub description: String,
    /// The scenario as text, in Markdown.
    pub document: String,
    /// The part of the plane that the crowd views show.
    pub view: Region,
    /// The densities with the first and the last color, P/m².
    pub density_range: [f64; 2],
    /// The speeds with the first and the last color, m/s.
    pub speed_range: [f64; 2],
    /// The time that the viewer shows first, seconds; `None`: the time of the highest density. At a measurement: the
    /// beginning.
    pub opens_at: Option<f64>,
    /// The time of the first frame, seconds.
    pub begins_at: f64,
    /// The end of the run as far as it is known; the loop that plays first does not go beyond it.
    pub ends_at: f64,
    /// The debug agents.
    pub debug: DebugAgents,
    /// The mass of an average person, kg, if walls are colored by the force on them.
    pub body_mass: Option<f64>,
    /// The outlines of what is measured, meters, each with its name.
    pub measured: Vec<(String, Vec<Vector>)>,
    /// Texts.
    pub labels: Vec<Label>,
    /// Upper bound on the agents that enter: with many, fewer arrivals are in the log of events.
    pub entering: u64,
}

impl RecordingOptions {
    /// Those of a recording of a scenario that begins at the time `from`.
    pub fn of(scenario: &Scenario, debug: DebugAgents, from: f64) -> Self {
        let (view, recorded) = (scenario.view, from..scenario.duration_secs);
        let drawn = Drawn::of(scenario);
        let measured = drawn.observed.into_iter();
        Self {
            id: Identity::of_run(scenario).to_string(),
            application: format!("sandbox {}", scenario.name),
            title: title(scenario),
            description: scenario.description.clone(),
            document: format!("## Scenario\n```json\n{}\n```\n", scenario.to_text()),
            view: drawn.view,
            density_range: view.density_range,
            speed_range: view.speed_range,
            opens_at: view.opens_at_secs.filter(|at| recorded.contains(at)),
            begins_at: from,
            ends_at: scenario.duration_secs,
            debug,
            body_mass: scenario.mass_on_walls(),
            measured: measured
                .map(|(name, place)| (name, place.outline()))
                .collect(),
            labels: drawn.labels,
            entering: scenario.entering,
        }
    }
}

/// The name of a recording: the scenario with its profile and seed, and what differs from its file.
fn title(scenario: &Scenario) -> String {
    let own = format!("{} {}", scenario.name, scenario.profile_name);
    let changes = scenario.changes.iter();
    let others =
        changes.filter(|change| !change.starts_with("profile") && !change.starts_with("seed "));
    let changes: String = others.map(|change| format!(", {change}")).collect();
    format!("{own} seed {}{changes}", scenario.seed)
}
