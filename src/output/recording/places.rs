//! Places and zones, the lengths of ways, and what happens at places.

use rerun::components::ImageFormat;
use rerun::{
    AnnotationContext, AsComponents, ChannelDatatype, Color, ColorModel, EntityPath, LineStrips2D,
    Points2D, Radius, RecordingStream, Rgba32, SegmentationImage, SeriesLines, Transform3D,
    entity_path,
};

use super::error::Cause;
use super::geometry::xy;
use super::names::Names;
use crate::analysis::round;
use crate::analysis::way_field::{Grid, WayField};
use crate::engine::journeys::{Kind, Place, Status};
use crate::engine::math::bounds;
use crate::engine::scene::Scene;
use crate::engine::simulation::Simulation;
use crate::engine::ways::Destination;
use crate::output::colors::{ColorMap, Rgb};
use crate::output::{labels, scenery};

/// The time series of places: agents in queues and waiting areas, and agents that have passed exits.
pub const PRESENT: &str = "present";
pub const PASSED: &str = "passed";
/// The color of entrances.
const ENTRANCE: Rgb = [0, 170, 200];

/// The distance between the lines of a hatched zone, meters.
const HATCHING: f64 = 0.8;
/// The longest side of a picture of ways, pixels, and the smallest pixel, meters.
const SIDE: f64 = 480.0;
const PIXEL: f64 = 0.1;
/// The most destinations with a picture of ways.
const MOST_FIELDS: usize = 16;

type IsKind = fn(&Kind) -> bool;

/// The kinds of places, and the entities that hold them.
const KINDS: [(&str, IsKind); 4] = [
    ("exits", |kind| matches!(kind, Kind::Exit(_))),
    ("waypoints", |kind| {
        matches!(kind, Kind::Line(_) | Kind::Disk { .. })
    }),
    ("waiting_areas", |kind| matches!(kind, Kind::Waiting(_))),
    ("queues", |kind| matches!(kind, Kind::Queue(_))),
];

fn colored([r, g, b]: Rgb) -> Color {
    Color::from_rgb(r, g, b)
}

fn strips(lines: Vec<Vec<[f32; 2]>>, color: Rgb, width: f32) -> LineStrips2D {
    LineStrips2D::new(lines)
        .with_radii([Radius::new_ui_points(width)])
        .with_colors([colored(color)])
        .with_draw_order(4.0)
}

/// Logs the places and zones of a scene, and adds their names.
pub fn log(stream: &RecordingStream, scene: &Scene, names: &mut Names) -> Result<(), Cause> {
    let places = &scene.journeys.places;
    for (name, is_kind) in KINDS {
        let own = places.iter().filter(|place| is_kind(&place.kind));
        let own: Vec<_> = own.collect();
        if let Some(first) = own.first() {
            let lines = own.iter().map(|place| scenery::lines(place));
            let lines = lines.map(|line| line.into_iter().map(xy).collect());
            let width = if first.is_exit() { 2.5 } else { 1.0 };
            let strips = strips(lines.collect(), scenery::color(&first.kind), width);
            stream.log_static(format!("world/geometry/{name}"), &strips)?;
        }
    }
    let entrances = scene.entrances.iter();
    let lines: Vec<_> = entrances
        .map(|entrance| entrance.line.map(xy).to_vec())
        .collect();
    if !lines.is_empty() {
        let strips = strips(lines, ENTRANCE, 2.0);
        stream.log_static("world/geometry/entrances", &strips)?;
    }
    log_spots(stream, scene)?;
    log_zones(stream, scene)?;
    add_names(scene, names);
    Ok(())
}

/// Logs the spots of queues.
fn log_spots(stream: &RecordingStream, scene: &Scene) -> Result<(), Cause> {
    let queues = scene
        .journeys
        .places
        .iter()
        .filter_map(|place| match &place.kind {
            Kind::Queue(queue) => Some((queue, scenery::color(&place.kind))),
            _ => None,
        });
    let spots = queues.flat_map(|(queue, color)| {
        let spots = scenery::spots(queue).into_iter();
        spots.map(move |spot| (xy(spot), colored(color)))
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

fn log_zones(stream: &RecordingStream, scene: &Scene) -> Result<(), Cause> {
    let zones = &scene.journeys.zones;
    if zones.is_empty() {
        return Ok(());
    }
    let lines = zones.iter().flat_map(|zone| {
        let hatching = scenery::hatching(&zone.area, HATCHING);
        let hatching = hatching.into_iter().map(|line| line.to_vec());
        std::iter::once(scenery::closed(&zone.area)).chain(hatching)
    });
    let lines = lines.map(|line| line.into_iter().map(xy).collect());
    let strips = strips(lines.collect(), scenery::ZONE.map(|x| x / 2), 0.5);
    Ok(stream.log_static("world/geometry/zones", &strips.with_draw_order(-1.0))?)
}

/// Adds the names of places, entrances and zones.
fn add_names(scene: &Scene, names: &mut Names) {
    const ENTITY: &str = "names";
    let journeys = &scene.journeys;
    let places = &journeys.places;
    for place in places {
        let kind = place.kind.name();
        let text = scenery::named(kind, &place.name);
        let similar = places.iter().filter(|other| other.kind.name() == kind);
        let lines = scenery::lines(place);
        let spots = labels::of_place(&scene.walls, place, &lines, names.screen());
        let color = scenery::color(&place.kind);
        names.add(ENTITY, similar.count(), &text, (color, &spots));
    }
    for zone in &journeys.zones {
        let text = scenery::named("zone", &scenery::zone_name(zone));
        let spots = labels::around(zone.area.points(), true);
        names.add(ENTITY, journeys.zones.len(), &text, (scenery::ZONE, &spots));
    }
    for entrance in &scene.entrances {
        let text = scenery::named("entrance", &entrance.name);
        let spots = labels::around(&entrance.line, false);
        names.add(ENTITY, scene.entrances.len(), &text, (ENTRANCE, &spots));
    }
}

/// The destinations with a path map, and the entities of their pictures.
fn destinations(scene: &Scene) -> Vec<(EntityPath, Destination)> {
    let Some(ways) = &scene.ways else {
        return Vec::new();
    };
    let places = (0..).zip(&scene.journeys.places).map(|(k, place)| {
        let name = entity_path!["world", "ways", place.name];
        (name, Destination::Place(k))
    });
    let goals = ways.goals().iter().map(|goal| {
        let name = entity_path!["world", "ways", format!("goal {}, {}", goal.x, goal.y)];
        (name, Destination::Goal(*goal))
    });
    let all = places.filter(|(_, to)| ways.leads_to(*to)).chain(goals);
    all.take(MOST_FIELDS).collect()
}

/// The entities that [`log_ways`] logs.
pub fn fields(scene: &Scene) -> Vec<EntityPath> {
    destinations(scene)
        .into_iter()
        .map(|(entity, _)| entity)
        .collect()
}

/// Logs a picture of the lengths of the ways to each destination.
pub fn log_ways(stream: &RecordingStream, scene: &Scene) -> Result<(), Cause> {
    let Some(ways) = &scene.ways else {
        return Ok(());
    };
    let corners = ways.floor.mesh.triangles().iter().flat_map(|t| t.corners);
    let corners = corners.map(|k| ways.floor.mesh.point(k));
    let [low, high] = bounds(corners).unwrap_or_default();
    let pixel = PIXEL.max((high - low).max() / SIDE);
    let grid = Grid::over([low, high], pixel);
    for (entity, to) in destinations(scene) {
        log_field(stream, entity, &WayField::new(ways, to, grid))?;
    }
    Ok(())
}

fn log_field(stream: &RecordingStream, entity: EntityPath, field: &WayField) -> Result<(), Cause> {
    let (grid, bands) = (field.grid, field.bands());
    let border = bands.count as u8 + 1;
    let class = |(k, length): (usize, &Option<f64>)| match length {
        None => 0,
        Some(_) if field.is_border(k) => border,
        Some(length) => 1 + (length / bands.width).min(f64::from(bands.count) - 1.0) as u8,
    };
    let pixels: Vec<u8> = field.lengths.iter().enumerate().map(class).collect();
    let map = ColorMap::pale([0.0, bands.end() as f32], bands.count);
    let of_band = |band: u32| {
        let [from, to] = [band, band + 1].map(|band| f64::from(band) * bands.width);
        let [r, g, b] = map.color((0.5 * (from + to)) as f32);
        let color = Rgba32::from_rgb(r, g, b);
        (
            band as u16 + 1,
            format!("{} to {} m", round::text(from), round::text(to)),
            color,
        )
    };
    let others = [
        (0, "no way".to_owned(), Rgba32::TRANSPARENT),
        (
            u16::from(border),
            "another next corner".to_owned(),
            Rgba32::from_rgb(120, 60, 130),
        ),
    ];
    let classes: Vec<_> = others
        .into_iter()
        .chain((0..bands.count).map(of_band))
        .collect();
    let classes = classes
        .iter()
        .map(|(id, label, color)| (*id, label.as_str(), *color));
    let classes = AnnotationContext::new(classes);
    let format = ImageFormat::from_color_model(
        [grid.columns as u32, grid.rows as u32],
        ColorModel::L,
        ChannelDatatype::U8,
    );
    let image = SegmentationImage::new(pixels, format)
        .with_opacity(1.0)
        .with_draw_order(-4.0);
    let place = Transform3D::from_translation_scale(
        [grid.min.x as f32, grid.min.y as f32, 0.0],
        [grid.cell as f32; 3],
    );
    let parts: [&dyn AsComponents; 3] = [&place, &classes, &image];
    Ok(stream.log_static(entity, &parts)?)
}

/// Whether there are places with time series of the agents that are present.
pub fn has_waiting(scene: &Scene) -> bool {
    let mut places = scene.journeys.places.iter();
    places.any(|place| series_of(&place.kind) == Some(PRESENT))
}

/// The entity of a time series of a place.
fn series(what: &str, name: &str) -> EntityPath {
    entity_path!["stats", "places", what, name]
}

/// Logs the names and colors of the time series of places.
pub fn log_series(stream: &RecordingStream, scene: &Scene) -> Result<(), Cause> {
    let places = &scene.journeys.places;
    let palette = scenery::STAGES.iter().cycle();
    for (place, (_, other)) in places.iter().zip(palette) {
        let kind = place.kind.name();
        let is_only = places
            .iter()
            .filter(|place| place.kind.name() == kind)
            .count()
            == 1;
        // The color of the place, or different colors for several places of a kind.
        let color = if is_only {
            scenery::color(&place.kind)
        } else {
            *other
        };
        let Some(what) = series_of(&place.kind) else {
            continue;
        };
        let style = SeriesLines::new()
            .with_names([format!("{} {}", place.kind.name(), place.name)])
            .with_colors([colored(color)])
            .with_widths([1.5]);
        stream.log_static(series(what, &place.name), &style)?;
    }
    Ok(())
}

fn series_of(kind: &Kind) -> Option<&'static str> {
    match kind {
        Kind::Exit(_) => Some(PASSED),
        Kind::Queue(_) | Kind::Waiting(_) => Some(PRESENT),
        Kind::Line(_) | Kind::Disk { .. } => None,
    }
}

/// The current values of the time series of places.
pub fn values(simulation: &Simulation) -> Vec<(EntityPath, f64)> {
    let places = &simulation.scene().journeys.places;
    let mut present = vec![0_u32; places.len()];
    for trip in simulation.frame().agents.trip.iter().flatten() {
        if matches!(trip.status, Status::Waiting { .. } | Status::Queued { .. }) {
            present[usize::from(trip.place)] += 1;
        }
    }
    let states = &simulation.progress().places;
    let value = |(k, place): (usize, &Place)| {
        let what = series_of(&place.kind)?;
        let count = match what {
            PASSED => states.get(k).map_or(0, |state| state.passed),
            _ => present[k],
        };
        Some((series(what, &place.name), f64::from(count)))
    };
    places.iter().enumerate().filter_map(value).collect()
}
