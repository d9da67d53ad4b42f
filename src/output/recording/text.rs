//! The text document with scenario and legend, and the run's properties.

use std::sync::Arc;

use rerun::external::arrow::array::{ArrayRef, Float64Array, StringArray, UInt64Array};
use rerun::{AnyValues, RecordingStream, TextDocument};

use super::error::Cause;
use super::layers::{METERS_PER_ACCELERATION, force_colors};
use super::{DebugAgents, RecordingOptions};
use crate::engine::scene::Scene;
use crate::output::colors::{DENSITY_RANGE, SPEED_RANGE};

pub const DOCUMENT: &str = "info/scenario";

/// Logs the text document of a measurement and the properties that the viewer lists.
pub fn log_measurement(stream: &RecordingStream, options: &RecordingOptions) -> Result<(), Cause> {
    let text = format!(
        "# {}\n\n{}\n\n\
         ## Legend\n\
         * Meters, seconds, y up. (The viewer's own *hover position* counts y down.)\n{}\
         * Click an agent: `agent:id`, `agent:density` in P/m² (three digits).\n\n{}\n",
        options.title,
        options.description,
        color_legend(),
        options.document.trim_end(),
    );
    stream.log_static(DOCUMENT, &TextDocument::from_markdown(text))?;
    let version = Arc::new(StringArray::from(vec![env!("CARGO_PKG_VERSION")])) as ArrayRef;
    let properties = AnyValues::default().with_component_from_data("sandbox_version", version);
    Ok(stream.send_property("measurement", &properties)?)
}

/// The legend of the density and speed colors.
fn color_legend() -> String {
    format!(
        "* Density colors (viridis): dark purple 0, green {:.0}, yellow {DENSITY_RANGE} P/m² and more.\n\
         * Speed colors (inferno): black 0, red {:.1}, pale yellow {SPEED_RANGE} m/s and more.\n",
        0.6 * DENSITY_RANGE,
        0.5 * SPEED_RANGE,
    )
}

/// Logs the text document of a run and the properties that the viewer lists.
pub fn log_document(
    stream: &RecordingStream,
    scene: &Scene,
    options: &RecordingOptions,
) -> Result<(), Cause> {
    let text = format!(
        "# {}\n\n{}\n\n{}\n{}\n",
        options.title,
        options.description,
        legend(options),
        options.document.trim_end(),
    );
    stream.log_static(DOCUMENT, &TextDocument::from_markdown(text))?;
    let profiles: Vec<&str> = scene
        .groups
        .iter()
        .map(|group| group.blend.name.as_str())
        .collect();
    let text = |text: &str| Arc::new(StringArray::from(vec![text])) as ArrayRef;
    let number = |x: f64| Arc::new(Float64Array::from(vec![x])) as ArrayRef;
    let seed = Arc::new(UInt64Array::from(vec![scene.seed])) as ArrayRef;
    let properties = AnyValues::default()
        .with_component_from_data("seed", seed)
        .with_component_from_data("profiles", text(&profiles.join(", ")))
        .with_component_from_data("sandbox_version", text(env!("CARGO_PKG_VERSION")))
        .with_component_from_data("time_step_secs", number(scene.clock.time_step()))
        .with_component_from_data("opens_at_secs", number(options.opens_at));
    Ok(stream.send_property("run", &properties)?)
}

fn legend(options: &RecordingOptions) -> String {
    let mut legend = format!(
        "## Legend\n\
         * Meters, seconds, y up; mass 1 = an average person. (The viewer's own *hover position* counts \
         y down.)\n{}\
         * Click an agent: `agent:id`, `agent:density` ρ and `agent:rest_density` ρ⁰ in P/m² (three \
         digits), `agent:pressure` p = k (ρ − ρ⁰).\n\
         * Look first at t = {} s, where the marked loop begins.\n",
        color_legend(),
        options.opens_at,
    );
    if options.debug != DebugAgents::None {
        legend += &format!(
            "* Agents laid open (`world/debug`): circle = kernel of radius h; tinted outline = hidden \
             region P_k behind a wall; dots at walls = nearest point r*, between = representative point \
             r°. Arrows: each force's weighted acceleration, {METERS_PER_ACCELERATION} m long per m/s²; \
             white = their sum.\n"
        );
        for (name, color) in force_colors() {
            legend += &format!("  * `{name}`: {color}\n");
        }
    }
    legend
}
