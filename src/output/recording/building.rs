//! A building in three dimensions: the outlines of its levels at their heights, and the people on them.
//!
//! Each level has an entity of its own, so that the viewer can hide it.

use std::sync::Arc;

use rerun::{
    AsComponents, EntityPath, LineStrips3D, Points3D, Radius, RecordingStream, ViewCoordinates,
    entity_path,
};

use super::draw::{Place, color, px, xyz};
use super::error::Cause;
use super::frame::Snapshot;
use super::frame::crowd::Maps;
use crate::drawing::steps;
use crate::scenery::closed;
use engine::geometry::Area;
use engine::levels::{Level, Levels};
use engine::math::Vector;
use figures::colors::Rgb;

/// The entity above all levels.
pub const ENTITY: &str = "building";
const EDGE: Rgb = [190, 192, 205];
const STEP: Rgb = [96, 98, 112];
/// The distance between two lines on stairs, meters.
const APART: f64 = 0.6;

/// People on levels.
pub struct Building {
    levels: Arc<Levels>,
    maps: Maps,
    /// Whether people are shown on each level.
    has_people: Vec<bool>,
}

fn entity(level: &Level, what: &str) -> EntityPath {
    entity_path![ENTITY, level.name.as_str(), what]
}

impl Building {
    /// Logs the outlines of all levels, and lines across stairs.
    pub fn begin(stream: &RecordingStream, levels: Arc<Levels>, maps: Maps) -> Result<Self, Cause> {
        stream.log_static(ENTITY, &ViewCoordinates::RIGHT_HAND_Z_UP())?;
        for level in levels.all() {
            let rings = level.floor.iter().flat_map(Area::rings);
            let outlines: Vec<Vec<Vector>> = rings.map(|ring| closed(ring.points())).collect();
            let across = steps(level, APART).into_iter();
            let steps: Vec<Vec<Vector>> = across.map(|line| line.to_vec()).collect();
            for (what, lines, rgb, width) in [
                ("outline", outlines, EDGE, 1.0),
                ("steps", steps, STEP, 0.5),
            ] {
                if lines.is_empty() {
                    continue;
                }
                let placed = lines
                    .iter()
                    .map(|line| line.iter().map(|&p| xyz(level, p)).collect::<Vec<_>>());
                let strips = LineStrips3D::new(placed)
                    .with_colors([color(rgb)])
                    .with_radii(px(width));
                stream.log_static(entity(level, what), &strips)?;
            }
        }
        Ok(Self {
            has_people: vec![false; levels.all().len()],
            levels,
            maps,
        })
    }

    /// Logs the people of one frame.
    pub fn log(&mut self, stream: &RecordingStream, snapshot: &Snapshot) -> Result<(), Cause> {
        for (number, level) in self.levels.all().iter().enumerate() {
            let all = snapshot.on_levels.iter().enumerate();
            let own: Vec<(usize, Place)> = all
                .filter(|(_, (on, _))| *on == number)
                .map(|(i, (_, place))| (i, *place))
                .collect();
            let had_people = std::mem::replace(&mut self.has_people[number], !own.is_empty());
            if own.is_empty() && !had_people {
                continue;
            }
            let radius = |&(i, _): &(usize, Place)| snapshot.radii[i];
            let colors = own.iter().map(|&(i, _)| match snapshot.densities.get(i) {
                Some(&density) => color(self.maps.density.one_of_few(density)),
                None => color([128; 3]),
            });
            let places = own.iter().map(|one| {
                let [x, y, z] = one.1;
                [x, y, z + radius(one)]
            });
            let people = Points3D::new(places)
                .with_radii(own.iter().map(|one| Radius::new_scene_units(radius(one))))
                .with_colors(colors);
            let parts: [&dyn AsComponents; 1] = [&people];
            stream.log(entity(level, "people"), &parts)?;
        }
        Ok(())
    }
}
