//! The whole crowd as one entity.
//!
//! Rows are in the order of the ids, so that radii and ids change only when agents enter or leave, and are logged
//! only then.

use std::sync::Arc;

use rerun::external::arrow::array::{ArrayRef, Float16Array, Float32Array, UInt32Array};
use rerun::external::arrow::datatypes::{ArrowPrimitiveType, Float16Type};
use rerun::{AsComponents, Color, DynamicArchetype, Points2D, Radius, RecordingStream};

use super::error::Cause;
use super::snapshot::Snapshot;
use crate::output::colors::{self, ColorMap};

type F16 = <Float16Type as ArrowPrimitiveType>::Native;

/// The entity of the crowd.
pub const ENTITY: &str = "world/agents";
/// Archetype of our own values; the viewer shows them as `agent:density`, and so on.
const ARCHETYPE: &str = "agent";
/// The component with the speed colors.
pub const SPEED_COLORS: &str = "agent:speed_colors";

/// The component with the colors by stage of the journey.
pub const STAGE_COLORS: &str = "agent:stage_colors";

/// Logs the crowd.
#[derive(Default)]
pub struct Crowd {
    logged_ids: Vec<u32>,
}

fn color(map: &ColorMap, value: f32) -> Color {
    let [r, g, b] = map.color(value);
    Color::from_rgb(r, g, b)
}

pub fn log_style(stream: &RecordingStream) -> Result<(), Cause> {
    let style = Points2D::update_fields().with_draw_order(1.0);
    Ok(stream.log_static(ENTITY, &style)?)
}

impl Crowd {
    pub fn log(&mut self, stream: &RecordingStream, snapshot: &Snapshot) -> Result<(), Cause> {
        let mut rows: Vec<usize> = (0..snapshot.ids.len()).collect();
        rows.sort_unstable_by_key(|&i| snapshot.ids[i]);
        self.log_bodies(stream, snapshot, &rows)?;
        let positions = rows.iter().map(|&i| snapshot.positions[i]);
        let mut points = Points2D::update_fields().with_positions(positions);
        let speed = |&i: &usize| {
            let [x, y] = snapshot.velocities[i];
            color(&colors::SPEED, x.hypot(y))
        };
        let mut values = DynamicArchetype::new(ARCHETYPE)
            .with_component::<rerun::components::Color>("speed_colors", rows.iter().map(speed));
        if snapshot.densities.is_empty() {
            points = points.with_colors([Color::from_rgb(128, 128, 128)]);
        } else {
            let density = |&i: &usize| color(&colors::DENSITY, snapshot.densities[i]);
            points = points.with_colors(rows.iter().map(density));
            values = values.with_component_from_data("density", halves(&rows, &snapshot.densities));
        }
        if !snapshot.pressures.is_empty() {
            let pressure = rows.iter().map(|&i| snapshot.pressures[i]);
            let pressure = Arc::new(Float32Array::from_iter_values(pressure)) as ArrayRef;
            values = values
                .with_component_from_data("rest_density", halves(&rows, &snapshot.rest_densities))
                .with_component_from_data("pressure", pressure);
        }
        if !snapshot.stages.is_empty() {
            let stage = |&i: &usize| {
                let [r, g, b] = snapshot.stages[i];
                Color::from_rgb(r, g, b)
            };
            let colors = rows.iter().map(stage);
            values = values.with_component::<rerun::components::Color>("stage_colors", colors);
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
        let ids: Vec<u32> = rows.iter().map(|&i| snapshot.ids[i]).collect();
        if ids == self.logged_ids {
            return Ok(());
        }
        let radii = rows.iter().map(|&i| snapshot.radii[i]);
        let points = Points2D::update_fields().with_radii(radii.map(Radius::new_scene_units));
        self.logged_ids.clone_from(&ids);
        let ids = Arc::new(UInt32Array::from(ids));
        let values = DynamicArchetype::new(ARCHETYPE).with_component_from_data("id", ids);
        stream.log(ENTITY, &[&points as &dyn AsComponents, &values])?;
        Ok(())
    }
}

/// Half precision: three significant digits of a density in half the bytes.
fn halves(rows: &[usize], values: &[f32]) -> ArrayRef {
    let halves = rows.iter().map(|&i| F16::from_f32(values[i]));
    Arc::new(Float16Array::from_iter_values(halves))
}
