//! The text document with scenario and legend, and the run's properties.

use std::sync::Arc;

use rerun::external::arrow::array::{ArrayRef, Float64Array, StringArray, UInt64Array};
use rerun::{AnyValues, RecordingStream, TextDocument};

use super::error::Cause;
use super::layers::{METERS_PER_ACCELERATION, color};
use super::{DebugAgents, RecordingOptions};
use crate::engine::profile::Term;
use crate::engine::scene::Scene;
use crate::output::colors::{DENSITY_RANGE, SPEED_RANGE, WALL_FORCE_RANGE};
use crate::output::scenery;

pub const DOCUMENT: &str = "info/scenario";

/// Logs the text document, with `mass` after the units and `agents` as the rest of the legend, and the program's
/// version among the properties that the viewer lists.
fn log(
    stream: &RecordingStream,
    options: &RecordingOptions,
    [mass, agents]: [&str; 2],
    (name, properties): (&str, AnyValues),
) -> Result<(), Cause> {
    let text = format!(
        "# {}\n\n{}\n\n\
         ## Legend\n\
         * Meters, seconds, y up{mass}. (The viewer's own *hover position* counts y down.)\n\
         * Density colors (viridis): dark purple 0, green {:.0}, yellow {DENSITY_RANGE} P/m² and more.\n\
         * Speed colors (inferno): black 0, red {:.1}, pale yellow {SPEED_RANGE} m/s and more.\n\
         * Click an agent: {agents}\n{}\n",
        options.title,
        options.description,
        0.6 * DENSITY_RANGE,
        0.5 * SPEED_RANGE,
        options.document.trim_end(),
    );
    stream.log_static(DOCUMENT, &TextDocument::from_markdown(text))?;
    let version = text_array(env!("CARGO_PKG_VERSION"));
    let properties = properties.with_component_from_data("sandbox_version", version);
    Ok(stream.send_property(name, &properties)?)
}

fn text_array(text: &str) -> ArrayRef {
    Arc::new(StringArray::from(vec![text]))
}

/// Logs the text document of a measurement and the properties that the viewer lists.
pub fn log_measurement(stream: &RecordingStream, options: &RecordingOptions) -> Result<(), Cause> {
    let agents = "`agent:id`, `agent:density` in P/m² (three digits).\n";
    log(
        stream,
        options,
        ["", agents],
        ("measurement", AnyValues::default()),
    )
}

/// Logs the text document of a run and the properties that the viewer lists.
pub fn log_run(
    stream: &RecordingStream,
    scene: &Scene,
    options: &RecordingOptions,
) -> Result<(), Cause> {
    let mut agents = format!(
        "`agent:id`, `agent:density` ρ and `agent:rest_density` ρ⁰ in P/m² (three digits), `agent:pressure` \
         p = k (ρ − ρ⁰).\n\
         * Look first at t = {} s, where the marked loop begins.\n",
        options.opens_at,
    );
    if !scene.journeys.places.is_empty() {
        let names = scenery::STAGES.map(|(name, _)| name).join(", ");
        agents +=
            &format!("* Colors by stage of the journey, from stage 1: {names}; gray: ended.\n");
    }
    if let Some(mass) = options.body_mass {
        agents += &format!(
            "* Force on walls (`world/wall_forces`), the mean over 1 m for people of {mass} kg: yellow 0, orange {:.0}, \
             dark red {WALL_FORCE_RANGE} N/m and more. Not a safety limit.\n",
            0.5 * WALL_FORCE_RANGE,
        );
    }
    if scene.ways.is_some() {
        agents += "* Lengths of ways (`world/ways`), hidden at first: click the eye beside a place in the list of \
                   the view's entities.\n";
    }
    if options.debug != DebugAgents::None {
        agents += &format!(
            "* Agents laid open (`world/debug`): circle = kernel of radius h; tinted outline = hidden \
             region P_k behind a wall; dots at walls = nearest point r*, between = representative point \
             r°. Arrows: each force's weighted acceleration, {METERS_PER_ACCELERATION} m long per m/s²; \
             white = their sum.\n"
        );
        for term in Term::all() {
            agents += &format!("  * `{}`: {}\n", term.name(), color(term).0);
        }
    }
    let blends = scene.groups.iter().map(|group| group.blend.name.as_str());
    let profiles = blends.collect::<Vec<_>>().join(", ");
    let number = |x: f64| Arc::new(Float64Array::from(vec![x])) as ArrayRef;
    let properties = AnyValues::default()
        .with_component_from_data("seed", Arc::new(UInt64Array::from(vec![scene.seed])))
        .with_component_from_data("profiles", text_array(&profiles))
        .with_component_from_data("time_step_secs", number(scene.clock.time_step()))
        .with_component_from_data("opens_at_secs", number(options.opens_at));
    let mass = "; mass 1 = an average person";
    log(stream, options, [mass, &agents], ("run", properties))
}
