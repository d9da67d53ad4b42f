//! Places, entrances and zones.

use std::collections::BTreeMap;

use rerun::{Points2D, Radius, RecordingStream};

use super::names::Names;
use crate::recording::draw::{color, log_lines, xy};
use crate::recording::error::Cause;
use crate::{labels, scenery};
use engine::journeys::Kind;
use engine::math::Vector;
use engine::scene::Scene;
use figures::colors::Rgb;

/// The color of entrances.
const ENTRANCE: Rgb = [0, 170, 200];
/// The distance between the lines of a hatched zone, meters.
const HATCHING: f64 = 0.8;

/// The entity that holds all places of a kind, and half the width of their lines, pixels.
fn entity(kind: &Kind) -> (&'static str, f32) {
    match kind {
        Kind::Exit(_) => ("exits", 2.5),
        Kind::Line(_) | Kind::Disk { .. } => ("waypoints", 1.0),
        Kind::Waiting(_) => ("waiting_areas", 1.0),
        Kind::Queue(_) => ("queues", 1.0),
        Kind::Door(_) => ("doors", 2.0),
    }
}

/// Logs the places and zones of a scene, and adds their names.
pub fn log(stream: &RecordingStream, scene: &Scene, names: &mut Names) -> Result<(), Cause> {
    let mut kinds: BTreeMap<&str, (f32, Rgb, Vec<Vec<Vector>>)> = BTreeMap::new();
    for place in &scene.journeys.places {
        let (entity, width) = entity(&place.kind);
        let entry = kinds.entry(entity);
        let own = entry.or_insert((width, scenery::color(&place.kind), Vec::new()));
        own.2.push(scenery::lines(place));
    }
    for (entity, (width, color, lines)) in kinds {
        log_lines(stream, entity, (color, width, 4.0), lines)?;
    }
    let entrances = scene.entrances.iter().map(|one| one.line.to_vec());
    log_lines(stream, "entrances", (ENTRANCE, 2.0, 4.0), entrances)?;
    log_spots(stream, scene)?;
    let zones = scene.journeys.zones.iter().flat_map(|zone| {
        let lines = scenery::hatching(&zone.area, scenery::across_zones(), HATCHING);
        let hatching = lines.into_iter().map(|line| line.to_vec());
        std::iter::once(scenery::closed(zone.area.points())).chain(hatching)
    });
    let dark = scenery::ZONE.map(|x| x / 2);
    log_lines(stream, "zones", (dark, 0.5, -1.0), zones)?;
    add_names(scene, names);
    Ok(())
}

/// Logs the spots of queues.
fn log_spots(stream: &RecordingStream, scene: &Scene) -> Result<(), Cause> {
    let places = scene.journeys.places.iter();
    let spots = places.flat_map(|place| {
        let spots = match &place.kind {
            Kind::Queue(queue) => scenery::spots(queue),
            _ => Vec::new(),
        };
        let color = color(scenery::color(&place.kind));
        spots.into_iter().map(move |spot| (xy(spot), color))
    });
    let (spots, colors): (Vec<_>, Vec<_>) = spots.unzip();
    if !spots.is_empty() {
        let points = Points2D::new(spots)
            .with_colors(colors)
            .with_radii([Radius::new_scene_units(0.08)])
            .with_draw_order(0.5);
        stream.log_static("world/geometry/queue_spots", &points)?;
    }
    Ok(())
}

/// Adds the names of places, zones and entrances.
fn add_names(scene: &Scene, names: &mut Names) {
    const ENTITY: &str = "names";
    let journeys = &scene.journeys;
    for place in &journeys.places {
        let text = scenery::named(place.kind.name(), &place.name);
        let lines = scenery::lines(place);
        let spots = labels::of_place(&scene.walls, place, &lines, names.screen());
        let (count, color) = (scenery::alike(scene, place), scenery::color(&place.kind));
        names.add(ENTITY, count, &text, (color, &spots));
    }
    for zone in &journeys.zones {
        let text = scenery::zone_name(journeys, zone);
        let spots = labels::around(zone.area.points(), true);
        names.add(ENTITY, journeys.zones.len(), &text, (scenery::ZONE, &spots));
    }
    for entrance in &scene.entrances {
        let text = scenery::named("entrance", &entrance.name);
        let spots = labels::around(&entrance.line, false);
        names.add(ENTITY, scene.entrances.len(), &text, (ENTRANCE, &spots));
    }
}
