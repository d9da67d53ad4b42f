//! The text document with scenario and legend, and the run's properties.

use std::sync::Arc;

use rerun::external::arrow::array::{ArrayRef, Float64Array, StringArray, UInt64Array};
use rerun::{AnyValues, ComponentIdentifier, RecordingStream, TextDocument};
use serde_json::Value;

use super::debug::DebugAgents;
use super::debug::arrows;
use super::error::Cause;
use super::options::RecordingOptions;
use crate::scenery;
use analysis::round::brief;
use engine::scene::Scene;
use figures::colors::WALL_FORCE_RANGE;

pub const DOCUMENT: &str = "info/scenario";
/// The results of the run, for people; and as JSON, which no view shows.
pub const RESULTS: &str = "info/results";
pub const REPORT: &str = "info/report";

/// The text document of a recording. Only one sentence of it, on the moment that the recording opens at, changes once
/// that moment is known.
pub struct Document {
    before: String,
    after: String,
    /// The sentence until then; `None`: never any.
    opening: Option<String>,
}

impl Document {
    /// A document with `mass` after the units, and `agents` on what a click shows.
    fn new(
        options: &RecordingOptions,
        [mass, agents]: [&str; 2],
        rest: &str,
        opening: Option<String>,
    ) -> Self {
        let [density, speed] = [options.density_range, options.speed_range];
        let at = |[first, last]: [f64; 2], part: f64| brief(first + (last - first) * part);
        let before = format!(
            "# {}\n\n{}\n\n\
             ## Legend\n\
             * Meters, seconds, y up{mass}. (The viewer's own *hover position* counts y down.)\n\
             * Density colors (viridis): dark purple {}, green {}, yellow {} P/m² and more.\n\
             * Speed colors (inferno): purple {}, orange {}, pale yellow {} m/s and more.\n\
             * Click an agent: {agents}\n",
            options.title,
            options.description,
            at(density, 0.0),
            at(density, 0.6),
            at(density, 1.0),
            at(speed, 0.0),
            at(speed, 0.6),
            at(speed, 1.0),
        );
        let after = format!("{rest}\n{}\n", options.document.trim_end());
        Self {
            before,
            after,
            opening,
        }
    }

    /// Logs it; `opens_at`: the moment that the recording opens at, seconds, once it is known.
    pub fn log(&self, stream: &RecordingStream, opens_at: Option<f64>) -> Result<(), Cause> {
        let opening = match (&self.opening, opens_at) {
            (Some(_), Some(time)) => {
                let time = (time * 100.0).round() / 100.0;
                format!("* Look first at t = {time} s, where the marked loop begins.\n")
            }
            (Some(until_then), None) => until_then.clone(),
            (None, _) => String::new(),
        };
        let text = format!("{}{opening}{}", self.before, self.after);
        Ok(stream.log_static(DOCUMENT, &TextDocument::from_markdown(text))?)
    }
}

/// Logs the properties that the viewer lists, with the program's version.
fn log_properties(
    stream: &RecordingStream,
    name: &str,
    properties: AnyValues,
) -> Result<(), Cause> {
    let version = text_array(env!("CARGO_PKG_VERSION"));
    let properties = properties.with_component_from_data("sandbox_version", version);
    Ok(stream.send_property(name, &properties)?)
}

fn text_array(text: &str) -> ArrayRef {
    Arc::new(StringArray::from(vec![text]))
}

/// The text document of a measurement; logs the properties that the viewer lists.
pub fn of_measurement(
    stream: &RecordingStream,
    options: &RecordingOptions,
) -> Result<Document, Cause> {
    log_properties(stream, "measurement", AnyValues::default())?;
    let agents =
        "`agent:id`, `agent:density` in P/m² and `agent:speed` in m/s (three digits each).\n";
    Ok(Document::new(options, ["", agents], "", None))
}

/// The text document of a run; logs the properties that the viewer lists.
pub fn of_run(
    stream: &RecordingStream,
    scene: &Scene,
    options: &RecordingOptions,
) -> Result<Document, Cause> {
    let agents = "`agent:id`, `agent:density` ρ and `agent:rest_density` ρ⁰ in P/m², `agent:pressure` \
                  p = k (ρ − ρ⁰) in 1/s², `agent:speed` in m/s (three digits each).";
    let mut rest = String::new();
    if scenery::has_stages(scene) {
        let names = scenery::STAGES.map(|(name, _)| name).join(", ");
        rest += &format!("* Colors by stage of the journey, from stage 1: {names}; gray: ended.\n");
    }
    if let Some(mass) = options.body_mass {
        rest += &format!(
            "* Force on walls (`world/wall_forces`), the mean over 1 m for people of {mass} kg: yellow 0, orange \
             {:.0}, dark red {WALL_FORCE_RANGE} N/m and more. Not a safety limit.\n",
            0.5 * WALL_FORCE_RANGE,
        );
    }
    if scene.routes.is_some() {
        rest += "* Lengths of routes (`world/routes`), hidden at first: click the eye beside a place in the list of \
                 the view's entities.\n";
    }
    if options.debug != DebugAgents::None {
        rest += &on_debug_agents(&options.debug, scene);
    }
    let opening = match options.opens_at {
        Some(time) => format!("* Look first at t = {time} s.\n"),
        None => "* Look first at the moment of the highest density.\n".to_owned(),
    };
    log_run(stream, scene)?;
    let mass = "; mass 1 = an average person";
    Ok(Document::new(options, [mass, agents], &rest, Some(opening)))
}

/// The legend of the debug agents.
fn on_debug_agents(debug: &DebugAgents, scene: &Scene) -> String {
    let followed = match debug {
        DebugAgents::Ids(_) => "each of these agents has a tab",
        _ => "the densest of these agents at the moment that the recording opens at is followed",
    };
    let mut text = format!(
        "* Agents inspected (`world/debug`): circle = kernel of radius h; tinted outline = hidden \
         region P_k behind a wall; dots at walls = nearest point r*, between = representative point \
         r°; yellow line = way; green lines (followed agents with the walking law `headings`) = headings, as long as \
         the agent can walk there in 1 s, the followed one bright.\n\
         * Followed agents (`focus`): {followed}. The agent is bright and stays in the middle; its neighbors are \
         dark. Beside it: the magnitudes of its accelerations over time.\n\
         * Arrows: the weighted acceleration a of each force; white = their sum. Length: {}.\n",
        arrows::law(),
    );
    for term in arrows::acting(scene) {
        text += &format!("  * `{}`: {}\n", term.name, term.color.0);
    }
    text
}

/// Logs the properties of a run.
fn log_run(stream: &RecordingStream, scene: &Scene) -> Result<(), Cause> {
    let blends = scene.groups.iter().map(|group| group.blend.name.as_str());
    let profiles = blends.collect::<Vec<_>>().join(", ");
    let number = |x: f64| Arc::new(Float64Array::from(vec![x])) as ArrayRef;
    let properties = AnyValues::default()
        .with_component_from_data("seed", Arc::new(UInt64Array::from(vec![scene.seed])))
        .with_component_from_data("profiles", text_array(&profiles))
        .with_component_from_data("time_step_secs", number(scene.clock.time_step()));
    log_properties(stream, "run", properties)
}

/// Logs the results of a run, as text and as JSON, and the measurements as properties, which tables of recordings show.
pub fn log_results(stream: &RecordingStream, text: &str, json: &str) -> Result<(), Cause> {
    let text = TextDocument::from_markdown(format!("```text\n{text}```\n"));
    stream.log_static(RESULTS, &text)?;
    let document = TextDocument::new(json).with_media_type("application/json");
    stream.log_static(REPORT, &document)?;
    let report: Value = serde_json::from_str(json)?;
    let metrics = report["metrics"].as_object().into_iter().flatten();
    let numbers = metrics.filter_map(|(name, value)| Some((name, value.as_f64()?)));
    let mut properties = None;
    for (name, value) in numbers {
        let value = Arc::new(Float64Array::from(vec![value]));
        let name = ComponentIdentifier::try_new(name.as_str())?;
        let others = properties.unwrap_or_else(AnyValues::default);
        properties = Some(others.with_component_from_data(name, value));
    }
    let Some(properties) = properties else {
        return Ok(());
    };
    Ok(stream.send_property("results", &properties)?)
}

/// Adds the moment that a recording opens at to the properties of its run.
pub fn log_opening(stream: &RecordingStream, time: f64) -> Result<(), Cause> {
    let time = Arc::new(Float64Array::from(vec![time])) as ArrayRef;
    let property = AnyValues::default().with_component_from_data("opens_at_secs", time);
    Ok(stream.send_property("run", &property)?)
}
