//! Valid scenarios that are probably a mistake get a note that names the place.

use serde_json::{Value, json};

use crate::common::simulated::{measured, scenario};

/// A room of 12 × 10 m with an exit and 20 people.
fn room() -> Value {
    json!({
        "walkable_area": [[[[0, 0], [12, 0], [12, 10], [0, 10]]]],
        "exits": [{"name": "east", "line": [[12, 4], [12, 6]]}],
        "crowds": [{"area": [[0, 0], [11, 0], [11, 10], [0, 10]], "number": 20}],
        "duration_secs": 120,
    })
}

fn with(key: &str, value: Value) -> Value {
    let mut room = room();
    room[key] = value;
    room
}

fn notes(document: &Value) -> Vec<String> {
    scenario(document, &[]).unwrap().notes
}

/// The only note of a document.
fn note(document: &Value) -> String {
    let notes = notes(document);
    assert_eq!(notes.len(), 1, "{notes:?}");
    notes[0].clone()
}

#[test]
fn an_ordinary_room_gets_no_note() {
    assert_eq!(notes(&room()), [""; 0]);
}

#[test]
fn a_plan_in_centimeters_is_noted() {
    let mut room = room();
    room["walkable_area"] = json!([[[[0, 0], [2000, 0], [2000, 1000], [0, 1000]]]]);
    room["exits"] = json!([{"name": "east", "line": [[2000, 400], [2000, 600]]}]);
    let text = note(&room);
    assert!(text.starts_with("walkable_area: 2"), "{text}");
    assert!(
        text.ends_with("for 20 agent(s): check that the unit is meters"),
        "{text}"
    );
}

#[test]
fn speeds_of_no_crowd_are_noted_with_their_place() {
    let text = note(&with("preferred_speed", json!(13.4)));
    assert!(
        text.starts_with("preferred_speed: 13.4 m/s is faster than crowds run"),
        "{text}"
    );
    let mut own = room();
    own["crowds"][0]["preferred_speed"] = json!({"normal": {"mean": 5, "std": 0.1}});
    let text = note(&own);
    assert!(text.contains("is faster than crowds run"), "{text}");
}

#[test]
fn journeys_that_end_on_the_floor_are_noted() {
    let mut room = room();
    room["waypoints"] = json!([{"name": "kiosk", "at": [5, 5], "within": 1}]);
    room["journeys"] = json!([{"name": "guest", "stages": ["kiosk"]}]);
    room["crowds"][0]["journey"] = json!("guest");
    let notes = notes(&room);
    let is_it =
        |text: &String| text.starts_with("journey `guest`: agents that have passed its last place");
    assert!(notes.iter().any(is_it), "{notes:?}");
}

#[test]
fn agents_that_never_start_walking_are_counted() {
    let mut late = room();
    late["crowds"][0]["premovement_secs"] = json!(600);
    let text = note(&late);
    assert!(text.contains("20 of the 20 at the start"), "{text}");
    late["crowds"][0]["premovement_secs"] = json!({"uniform": [0, 100]});
    assert_eq!(notes(&late), [""; 0]);
}

#[test]
fn crowds_across_a_wall_are_noted_with_the_numbers_on_both_sides() {
    let mut room = room();
    room["walkable_area"] = json!([[[[0, 0], [12, 0], [12, 10], [0, 10]]]]);
    room["obstacles"] = json!([[[5, 0], [5.2, 0], [5.2, 10], [5, 10]]]);
    room["exits"] = json!([
        {"name": "east", "line": [[12, 4], [12, 6]]}, {"name": "west", "line": [[0, 4], [0, 6]]},
    ]);
    let text = note(&room);
    assert!(
        text.starts_with("crowds[0].area: walls divide it into 2 parts, with "),
        "{text}"
    );
}

#[test]
fn scenes_without_people_are_noted() {
    let mut room = room();
    room["crowds"] = json!([]);
    let notes = notes(&room);
    assert!(
        notes.iter().any(|text| text.starts_with("no agents enter")),
        "{notes:?}"
    );
}

#[test]
fn a_line_without_region_has_no_density_and_speed() {
    let line = |region: bool| {
        let mut room = room();
        let mut flow = json!({"name": "door", "line": [[11, 0], [11, 10]]});
        if region {
            flow["region"] = json!([[8, 4], [11, 6]]);
        }
        room["measurements"] = json!([{"line_flow": flow}]);
        room["duration_secs"] = json!(5);
        measured(room).metrics.len()
    };
    assert_eq!([line(false), line(true)], [2, 4]);
}
