//! A scenario's floor and places as GeoJSON, and a scenario of a plan's floor and places.

use std::path::Path;

use serde_json::{Value, json};

use crate::error::ScenarioError;
use crate::floor_plan::{Form, Kind, Place, encloses_nothing};
use crate::keys::shapes::{Point, Ring};
use crate::read::draft::Draft;
use crate::read::setting::Setting;

/// The density of crowds in areas of a plan that say no number of people, P/m².
const DENSITY: f64 = 1.0;

/// A scenario of what a plan names, as a beginning: people leave its crowds by its exits. Elements of lists are names
/// of its places.
fn beginning(plan: &str, places: &[Place]) -> Value {
    let of_kind = |kind: Kind| places.iter().filter(move |place| place.kind == kind);
    let exits: Vec<&str> = of_kind(Kind::Exit)
        .map(|place| place.name.as_str())
        .collect();
    let mut document = json!({"profile": "steer+sph", "duration_secs": 600, "walkable_area": plan});
    if exits.is_empty() {
        return document;
    }
    document["exits"] = json!(exits);
    let areas = of_kind(Kind::Crowd).filter(|place| place.form == Form::Area);
    let crowd = |place: &Place| json!({"name": place.name, "area": place.name, "density": DENSITY});
    let crowds: Vec<Value> = areas.map(crowd).collect();
    if !crowds.is_empty() {
        document["crowds"] = json!(crowds);
        document["stop"] = json!({"when_empty": true});
    }
    document
}

/// A scenario with the exits and crowds of the plan at a path, which a draft has read.
///
/// # Errors
/// What the plan names makes no scenario.
pub fn begun(plan: &Path, draft: &Draft, settings: &[Setting]) -> Result<Draft, ScenarioError> {
    let name = plan.file_name().unwrap_or_default().to_string_lossy();
    let document = beginning(&name, draft.places());
    let file = plan.with_extension("json");
    Draft::read(&document.to_string(), &file.display().to_string(), settings)
}

impl Draft {
    /// What its floor plans name.
    pub fn places(&self) -> &[Place] {
        &self.places
    }

    /// Its floor and places as GeoJSON in meters; each feature has its `kind` and its `name`.
    pub fn to_geojson(&self) -> Value {
        let keys = &self.keys;
        let mut all = Features::default();
        for polygon in keys.walkable_area.iter().flatten() {
            all.add(Kind::Floor, None, area(polygon));
        }
        for obstacle in &keys.obstacles {
            let rings = obstacle.rings();
            let points = rings
                .iter()
                .flat_map(|ring| ring.0.iter().map(|&Point(point)| point));
            let is_line = encloses_nothing(&points.collect::<Vec<_>>());
            let of_line = || line(rings.iter().flat_map(|ring| ring.0.iter().copied()));
            match is_line {
                true => all.add(Kind::Wall, None, of_line()),
                false => all.add(Kind::Obstacle, None, area(rings)),
            }
        }
        for exit in &keys.exits {
            all.add(Kind::Exit, Some(&exit.name), line(exit.line));
        }
        for door in &keys.doors {
            all.add(Kind::Door, Some(&door.name), line(door.line));
        }
        for entrance in &keys.entrances {
            all.add(
                Kind::Entrance,
                entrance.name.as_deref(),
                line(entrance.line.0),
            );
        }
        for waypoint in &keys.waypoints {
            let geometry = waypoint.line.map(line).or(waypoint.at.map(point));
            geometry
                .into_iter()
                .for_each(|one| all.add(Kind::Waypoint, Some(&waypoint.name), one));
        }
        for waiting in &keys.waiting_areas {
            all.add(
                Kind::WaitingArea,
                Some(&waiting.name),
                area(std::slice::from_ref(&waiting.area)),
            );
        }
        for queue in &keys.queues {
            all.add(
                Kind::Queue,
                Some(&queue.name),
                line(queue.path.iter().copied()),
            );
        }
        for zone in &keys.zones {
            all.add(
                Kind::Zone,
                zone.name.as_deref(),
                area(std::slice::from_ref(&zone.area)),
            );
        }
        for crowd in &keys.crowds {
            all.add(Kind::Crowd, crowd.name.as_deref(), area(crowd.area.rings()));
        }
        for place in self.places.iter().filter(|place| !place.kind.is_built()) {
            if !all.have(&place.name) {
                all.add(place.kind, Some(&place.name), geometry(place));
            }
        }
        for label in &keys.labels {
            all.add(Kind::Place, Some(&label.text), point(label.at));
        }
        json!({"type": "FeatureCollection", "features": all.features})
    }
}

#[derive(Default)]
struct Features {
    features: Vec<Value>,
}

impl Features {
    fn have(&self, name: &str) -> bool {
        self.features
            .iter()
            .any(|feature| feature["properties"]["name"] == name)
    }

    fn add(&mut self, kind: Kind, name: Option<&str>, geometry: Value) {
        let mut properties = json!({"kind": kind.word()});
        if let Some(name) = name {
            properties["name"] = json!(name);
        }
        self.features
            .push(json!({"type": "Feature", "properties": properties, "geometry": geometry}));
    }
}

/// Rings as a polygon, each with its first point at its end.
fn area(rings: &[Ring]) -> Value {
    let closed = |ring: &Ring| -> Vec<Point> {
        let first = ring.0.first().copied();
        ring.0.iter().copied().chain(first).collect()
    };
    let rings: Vec<Vec<Point>> = rings.iter().map(closed).collect();
    json!({"type": "Polygon", "coordinates": rings})
}

/// The geometry of a place as the plan has it.
fn geometry(place: &Place) -> Value {
    let points = |ring: &Vec<[f64; 2]>| ring.iter().map(|&p| Point(p)).collect::<Vec<_>>();
    let first = place.rings.first().map(points).unwrap_or_default();
    match (place.form, first.first()) {
        (Form::Area, _) => area(
            &place
                .rings
                .iter()
                .map(|ring| Ring(points(ring)))
                .collect::<Vec<_>>(),
        ),
        (Form::Point, Some(&at)) => point(at),
        _ => line(first),
    }
}

fn line(points: impl IntoIterator<Item = Point>) -> Value {
    let points: Vec<Point> = points.into_iter().collect();
    json!({"type": "LineString", "coordinates": points})
}

fn point(at: Point) -> Value {
    json!({"type": "Point", "coordinates": at})
}
