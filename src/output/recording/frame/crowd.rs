//! The whole crowd as one entity.
//!
//! Rows are in the order of the ids, so that radii and ids change only when agents enter or leave, and are logged
//! only then.

use std::sync::Arc;

use rerun::external::arrow::array::{ArrayRef, Float16Array, UInt32Array};
use rerun::external::arrow::datatypes::{ArrowPrimitiveType, Float16Type};
use rerun::{AsComponents, Color, DynamicArchetype, Points2D, Radius, RecordingStream};

use super::Snapshot;
use crate::recording::draw::color;
use crate::recording::error::Cause;
use crate::recording::options::RecordingOptions;
use figures::colors::ColorMap;

type F16 = <Float16Type as ArrowPrimitiveType>::Native;

/// The entity of the crowd.
pub const ENTITY: &str = "world/agents";
/// Archetype of our own values; the viewer shows them as `agent:density`, and so on.
const ARCHETYPE: &str = "agent";
/// The component with the speed colors.
pub const SPEED_COLORS: &str = "agent:speed_colors";
/// The component with the colors by stage of the journey.
pub const STAGE_COLORS: &str = "agent:stage_colors";

/// The color maps of a recording.
#[derive(Clone)]
pub struct Maps {
    /// For densities in P/m².
    pub density: ColorMap,
    /// For speeds in m/s.
    pub speed: ColorMap,
}

impl Maps {
    pub fn new(options: &RecordingOptions) -> Self {
        let single = |range: [f64; 2]| range.map(|x| x as f32);
        Self {
            density: ColorMap::viridis(single(options.density_range)),
            speed: ColorMap::bright_inferno(single(options.speed_range)),
        }
    }
}

/// Logs the crowd.
pub struct Crowd {
    maps: Maps,
    logged_ids: Vec<u32>,
}

/// Logs the drawing order of agents.
pub fn log_style(stream: &RecordingStream) -> Result<(), Cause> {
    let style = Points2D::update_fields().with_draw_order(1.0);
    Ok(stream.log_static(ENTITY, &style)?)
}

impl Crowd {
    pub fn new(maps: Maps) -> Self {
        Self {
            maps,
            logged_ids: Vec::new(),
        }
    }

    pub fn log(&mut self, stream: &RecordingStream, snapshot: &Snapshot) -> Result<(), Cause> {
        let of = |map: &ColorMap, value| color(map.one_of_few(value));
        let mut rows: Vec<usize> = (0..snapshot.ids.len()).collect();
        rows.sort_unstable_by_key(|&i| snapshot.ids[i]);
        self.log_bodies(stream, snapshot, &rows)?;
        let positions = rows.iter().map(|&i| snapshot.positions[i]);
        let mut points = Points2D::update_fields().with_positions(positions);
        let norms = snapshot.velocities.iter().map(|[x, y]| x.hypot(*y));
        let speeds: Vec<f32> = norms.collect();
        let speed_colors = rows.iter().map(|&i| of(&self.maps.speed, speeds[i]));
        let mut values = DynamicArchetype::new(ARCHETYPE)
            .with_component::<Color>("speed_colors", speed_colors)
            .with_component_from_data("speed", halves(&rows, &speeds));
        if snapshot.densities.is_empty() {
            points = points.with_colors([color([128; 3])]);
        } else {
            let density = |&i: &usize| of(&self.maps.density, snapshot.densities[i]);
            points = points.with_colors(rows.iter().map(density));
            values = values.with_component_from_data("density", halves(&rows, &snapshot.densities));
        }
        if !snapshot.pressures.is_empty() {
            values = values
                .with_component_from_data("rest_density", halves(&rows, &snapshot.rest_densities))
                .with_component_from_data("pressure", halves(&rows, &snapshot.pressures));
        }
        if !snapshot.on_levels.is_empty() {
            let number = |&i: &usize| snapshot.on_levels[i].0 as u32;
            let levels = Arc::new(UInt32Array::from_iter_values(rows.iter().map(number)));
            values = values.with_component_from_data("level", levels);
        }
        if !snapshot.stages.is_empty() {
            let colors = rows.iter().map(|&i| color(snapshot.stages[i]));
            values = values.with_component::<Color>("stage_colors", colors);
        }
        stream.log(ENTITY, &[&points as &dyn AsComponents, &values])?;
        Ok(())
    }

    /// Logs the values that stay constant while an agent is present.
    fn log_bodies(
        &mut self,
        stream: &RecordingStream,
        snapshot: &Snapshot,
        rows: &[usize],
    ) -> Result<(), Cause> {
        let shown: Vec<u32> = rows.iter().map(|&i| snapshot.ids[i]).collect();
        if shown == self.logged_ids {
            return Ok(());
        }
        let radii = rows.iter().map(|&i| snapshot.radii[i]);
        let points = Points2D::update_fields().with_radii(radii.map(Radius::new_scene_units));
        self.logged_ids.clone_from(&shown);
        let ids = Arc::new(UInt32Array::from(shown));
        let values = DynamicArchetype::new(ARCHETYPE).with_component_from_data("id", ids);
        stream.log(ENTITY, &[&points as &dyn AsComponents, &values])?;
        Ok(())
    }
}

/// Half precision: three significant digits of a value in half the bytes, up to ±65504.
fn halves(rows: &[usize], values: &[f32]) -> ArrayRef {
    let most = F16::MAX.to_f32();
    let halves = rows
        .iter()
        .map(|&i| F16::from_f32(values[i].clamp(-most, most)));
    Arc::new(Float16Array::from_iter_values(halves))
}
