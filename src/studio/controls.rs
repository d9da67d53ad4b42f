//! What can be changed in a run while it is played, by name.

use engine::journeys::Kind;
use engine::scene::Scene;
use serde_json::{Value, json};

/// The names of groups, journeys, places, entrances and zones.
pub fn of(scene: &Scene) -> Value {
    let journeys = &scene.journeys;
    let places = |is: fn(&Kind) -> bool| -> Vec<&str> {
        let found = journeys.places.iter().filter(move |place| is(&place.kind));
        found.map(|place| &*place.name).collect()
    };
    let groups = scene.groups.iter();
    let directed = groups
        .clone()
        .map(|group| group.journey.is_some() || group.direction.is_some());
    let zones = journeys.zones.iter();
    let capacity = |place: &engine::journeys::Place| match &place.kind {
        Kind::Exit(exit) => Some(json!({"name": place.name, "most_per_sec": exit.most_per_sec})),
        _ => None,
    };
    json!({
        "groups": groups.map(|group| &*group.name).collect::<Vec<_>>(),
        "directed": directed.collect::<Vec<_>>(),
        "journeys": journeys.journeys.iter().map(|journey| &*journey.name).collect::<Vec<_>>(),
        "exits": places(|kind| matches!(kind, Kind::Exit(_))),
        "capacities": journeys.places.iter().filter_map(capacity).collect::<Vec<_>>(),
        "doors": places(|kind| matches!(kind, Kind::Door(_))),
        "areas": places(|kind| matches!(kind, Kind::Waiting(_))),
        "entrances": scene.entrances.iter().map(|entrance| &*entrance.name).collect::<Vec<_>>(),
        "zones": zones.map(|zone| json!({"name": zone.name, "speed_factor": zone.speed_factor})).collect::<Vec<_>>(),
    })
}
