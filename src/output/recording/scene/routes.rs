//! The lengths of the routes to each destination, as images.

use rerun::{EntityPath, RecordingStream, Rgba32, entity_path};

use crate::recording::draw::{Class, log_classes};
use crate::recording::error::Cause;
use analysis::round;
use analysis::way_field::{Grid, WayField};
use engine::math::bounds;
use engine::routes::Destination;
use engine::scene::Scene;
use figures::colors::ColorMap;

/// The longest side of an image, pixels, and the smallest pixel, meters.
const SIDE: f64 = 480.0;
const PIXEL: f64 = 0.1;
/// The most destinations with an image.
const MOST: usize = 16;

/// The destinations with a path map, and the entities of their images.
fn destinations(scene: &Scene) -> Vec<(EntityPath, Destination)> {
    let Some(routes) = &scene.routes else {
        return Vec::new();
    };
    let places = (0..).zip(&scene.journeys.places).map(|(k, place)| {
        let name = entity_path!["world", "routes", place.name];
        (name, Destination::Place(k))
    });
    let goals = routes.goals().iter().map(|goal| {
        let name = entity_path!["world", "routes", format!("goal {}, {}", goal.x, goal.y)];
        (name, Destination::Goal(*goal))
    });
    let all = places.filter(|(_, to)| routes.leads_to(*to)).chain(goals);
    all.take(MOST).collect()
}

/// The entities of the images.
pub fn entities(scene: &Scene) -> Vec<EntityPath> {
    let destinations = destinations(scene).into_iter();
    destinations.map(|(entity, _)| entity).collect()
}

/// Logs the images.
pub fn log(stream: &RecordingStream, scene: &Scene) -> Result<(), Cause> {
    let Some(routes) = &scene.routes else {
        return Ok(());
    };
    let mesh = routes.floor.plane();
    let numbers = mesh.triangles().iter().flat_map(|t| t.corners);
    let [low, high] = bounds(numbers.map(|k| mesh.point(k))).unwrap_or_default();
    let grid = Grid::over([low, high], PIXEL.max((high - low).max() / SIDE));
    for (entity, to) in destinations(scene) {
        log_field(stream, entity, &WayField::new(routes, to, grid))?;
    }
    Ok(())
}

fn log_field(stream: &RecordingStream, entity: EntityPath, field: &WayField) -> Result<(), Cause> {
    let bands = field.bands();
    let border = bands.count as u8 + 1;
    let class = |(k, length): (usize, &Option<f64>)| match length {
        None => 0,
        Some(_) if field.is_border(k) => border,
        Some(length) => 1 + (length / bands.width).min(f64::from(bands.count) - 1.0) as u8,
    };
    let pixels = field.lengths.iter().enumerate().map(class).collect();
    let map = ColorMap::pale([0.0, bands.end() as f32], bands.count);
    let of_band = |band: u32| -> Class {
        let [from, to] = [band, band + 1].map(|band| f64::from(band) * bands.width);
        let [r, g, b] = map.color((0.5 * (from + to)) as f32);
        let name = format!("{} to {} m", round::text(from), round::text(to));
        (band as u8 + 1, name, Rgba32::from_rgb(r, g, b))
    };
    let purple = Rgba32::from_rgb(120, 60, 130);
    let classes: Vec<Class> = [
        (0, "no way".to_owned(), Rgba32::TRANSPARENT),
        (border, "another next corner".to_owned(), purple),
    ]
    .into_iter()
    .chain((0..bands.count).map(of_band))
    .collect();
    log_classes(stream, entity, (&field.grid, pixels), &classes, -4.0)
}
