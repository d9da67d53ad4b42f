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
    let [note] = notes(document).try_into().unwrap();
    note
}

#[test]
fn an_ordinary_room_gets_no_note() {
    assert_eq!(notes(&room()), [""; 0]);
}

#[test]
fn doors_that_never_open_get_a_note() {
    let with_door = |closed: Value| {
        let mut room = room();
        let closed = json!({"name": "gate", "line": [[6, 0], [6, 10]], "closed_secs": closed});
        (room["doors"], room["route_choice"]) = (json!([closed]), json!("quickest"));
        room
    };
    for closed in [json!([[0, 120]]), json!([[0, 50], [30, 500]])] {
        let said = note(&with_door(closed));
        assert!(said.starts_with("doors[0]: `gate` is closed"), "{said}");
    }
    for closed in [json!([]), json!([[0, 119]]), json!([[1, 500]])] {
        assert_eq!(notes(&with_door(closed)), [""; 0]);
    }
    let mut opened = with_door(json!([[0, 500]]));
    assert!(note(&opened).contains("wait before it"));
    opened["events"] = json!([{"at_secs": 40, "open": "gate"}]);
    assert_eq!(notes(&opened), [""; 0]);
}

#[test]
fn crowds_with_several_routes_are_told_how_they_choose() {
    let mut crowded = room();
    crowded["crowds"][0]["number"] = json!(120);
    assert_eq!(notes(&crowded), [""; 0], "there is one way");
    let exit = crowded["exits"][0].clone();
    crowded["obstacles"] = json!([[[6, 4], [7, 4], [7, 6], [6, 6]]]);
    assert!(note(&crowded).contains("take the shortest way"));
    for choice in ["shortest", "quickest"] {
        crowded["route_choice"] = json!(choice);
        assert_eq!(notes(&crowded), [""; 0]);
    }
    let mut exits = room();
    exits["exits"] = json!([exit, {"name": "west", "line": [[0, 4], [0, 6]]}]);
    assert_eq!(notes(&exits), [""; 0], "they are few");
    exits["crowds"][0]["number"] = json!(120);
    assert!(note(&exits).contains("take the shortest way"));
    // Journeys that choose by time say how their agents choose.
    exits["obstacles"] = crowded["obstacles"].clone();
    assert!(note(&exits).contains("take the shortest way"));
    exits["journeys"] = json!([{"name": "j", "stages": [{"quickest": ["east", "west"]}]}]);
    exits["crowds"][0]["journey"] = json!("j");
    assert_eq!(notes(&exits), [""; 0]);
}

#[test]
fn a_plan_in_centimeters_is_noted() {
    let mut room = room();
    room["walkable_area"] = json!([[[[0, 0], [2000, 0], [2000, 1000], [0, 1000]]]]);
    room["exits"] = json!([{"name": "east", "line": [[2000, 400], [2000, 600]]}]);
    room["duration_secs"] = json!(2000);
    let text = note(&room);
    assert!(text.starts_with("walkable_area: 2"), "{text}");
    assert!(text.ends_with("check that the unit is meters"), "{text}");
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
fn motivations_that_no_law_reads_and_idle_zones_are_noted() {
    let mut hurried = room();
    hurried["crowds"][0]["motivation"] = json!(1);
    assert!(note(&hurried).starts_with("`motivation` has no effect"));
    hurried["profile"] = json!("steer+sph");
    assert_eq!(notes(&hurried), [""; 0]);
    let mut zone = room();
    zone["zones"] = json!([{"name": "hall", "area": [[1, 1], [3, 1], [3, 3], [1, 3]]}]);
    assert!(note(&zone).starts_with("zone `hall`: changes nothing"));
    zone["zones"][0]["motivation"] = json!(0.5);
    assert!(note(&zone).starts_with("`motivation` has no effect"));
    zone["profile"] = json!("steer+sph");
    assert_eq!(notes(&zone), [""; 0]);
    // That of the whole scenario describes its people, whatever their profile.
    let mut all = room();
    all["motivation"] = json!(1);
    assert_eq!(notes(&all), [""; 0]);
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

#[test]
fn the_size_in_the_note_is_that_of_the_plan_without_the_floor_behind_exits() {
    let mut room = room();
    room["walkable_area"] = json!([[[[0, 0], [1200, 0], [1200, 10], [0, 10]]]]);
    room["exits"] = json!([{"name": "east", "line": [[1200, 4], [1200, 6]]}]);
    room["duration_secs"] = json!(2000);
    let text = note(&room);
    assert!(
        text.starts_with("walkable_area: 1200 m × 10 m for 20 agent(s)"),
        "{text}"
    );
    room["walkable_area"] = json!([[[[0, 0], [299, 0], [299, 10], [0, 10]]]]);
    room["exits"] = json!([{"name": "east", "line": [[299, 4], [299, 6]]}]);
    room["crowds"][0]["number"] = json!(60);
    assert_eq!(notes(&room), [""; 0]);
}

#[test]
fn people_who_come_too_late_to_start_walking_are_named() {
    let waits = |from: f64, premovement: Value| {
        let mut late = room();
        late["entrances"] = json!([{"name": "gate", "line": [[0, 4], [0, 6]], "per_sec": 0.5, "from_secs": from,
                                    "premovement_secs": premovement}]);
        notes(&late)
    };
    let expected = "premovement_secs: agents that never start walking before the end of the run, 120 s: all of gate";
    assert_eq!(waits(80.0, json!(60)), [expected]);
    assert_eq!(waits(80.0, json!({"uniform": [50, 70]})), [expected]);
    assert_eq!(waits(50.0, json!(60)), [""; 0]);
    assert_eq!(waits(80.0, json!({"uniform": [0, 70]})), [""; 0]);
}

#[test]
fn exits_of_whose_lines_much_lies_off_the_floor_are_noted() {
    let with_line = |line: Value| {
        let mut room = room();
        room["exits"] = json!([{"name": "east", "line": line}]);
        notes(&room)
    };
    for (line, percent) in [
        // Across a corner; from the floor out through a wall; past the end of an edge.
        (json!([[13, 8.5], [10.5, 11]]), 79),
        (json!([[11, 5], [13.5, 5.1]]), 60),
        (json!([[12, 8], [12, 11]]), 33),
    ] {
        let expected = format!(
            "exits[0].line: {percent} % of `east` lies in obstacles or outside of the walkable area, where agents \
             cannot pass; draw the line on the floor, or on its edge"
        );
        assert_eq!(with_line(line.clone()), [expected], "{line}");
    }
    // On an edge, on two edges at a corner as its chord, inside, and a little too long.
    for line in [
        json!([[12, 4], [12, 6]]),
        json!([[12, 8], [10, 10]]),
        json!([[9, 0.5], [9, 9]]),
        json!([[12, 8], [12, 10.1]]),
    ] {
        assert_eq!(with_line(line.clone()), [""; 0], "{line}");
    }
}

#[test]
fn rooms_that_nearly_touch_are_noted() {
    let rooms = |gap: f64| {
        with(
            "walkable_area",
            json!([
                [[[0, 0], [12, 0], [12, 10], [0, 10]]],
                [[[-10, 2], [-gap, 2], [-gap, 8], [-10, 8]]],
            ]),
        )
    };
    for (gap, text) in [(0.001, "1 mm apart at (0.00, 5.00)"), (0.015, "15 mm")] {
        let found = note(&rooms(gap));
        assert!(
            found.contains(text) && found.contains("agents cannot pass"),
            "{found}"
        );
    }
    for gap in [0.0, 0.1] {
        assert_eq!(notes(&rooms(gap)), [""; 0], "{gap}");
    }
}

#[test]
fn agents_at_the_same_point_are_noted() {
    let agents = json!([{"position": [2, 3]}, {"position": [2, 3]}, {"position": [4, 3]}]);
    let found = note(&with("agents", agents));
    assert!(
        found.contains("1 agent(s)") && found.contains("(2, 3)"),
        "{found}"
    );
}

#[test]
fn an_exit_just_behind_an_entrance_lies_on_the_floor() {
    let entrance =
        json!([{"name": "in", "line": [[11.9, 4], [11.9, 6]], "per_sec": 1, "number": 2}]);
    let found = notes(&with("entrances", entrance));
    assert!(
        !found.iter().any(|note| note.contains("lies in obstacles")),
        "{found:?}"
    );
}

#[test]
fn agents_and_grids_off_the_floor_are_refused() {
    let behind = json!([{"position": [14, 5]}]);
    let far = json!([{"position": [500, 5]}]);
    let grid = json!([{"min": [10, 4], "max": [15, 6], "columns": 6, "rows": 3}]);
    // In the wall beside the floor behind the exit, which is nearer than that of the room.
    let source =
        json!([{"min": [14, 3.2], "max": [14.4, 3.6], "columns": 1, "rows": 1, "every_secs": 1}]);
    for (key, value, place) in [
        ("agents", behind, "agents[0].position"),
        ("agents", far, "agents[0].position"),
        ("grids", grid, "grids[0]"),
        ("sources", source, "sources[0]"),
    ] {
        let refused = scenario(&with(key, value), &[]).err().unwrap();
        assert!(refused.contains(place), "{refused}");
    }
}

#[test]
fn peaks_of_forces_that_count_the_random_start_are_noted() {
    let measured = |key: &str, from: f64, spacing: &str| {
        let mut room = with(
            "measurements",
            json!([{"egress": {}}, {key: {"from_secs": from}}]),
        );
        room["crowds"][0]["spacing"] = json!(spacing);
        notes(&room)
    };
    for key in ["body_forces", "wall_forces"] {
        let [found] = measured(key, 0.0, "random").try_into().unwrap();
        assert!(
            found.starts_with(&format!("measurements[1].{key}: ")),
            "{found}"
        );
        assert_eq!(measured(key, 3.0, "random"), [""; 0]);
        assert_eq!(measured(key, 0.0, "grid"), [""; 0]);
    }
}

#[test]
fn obstacles_off_the_floor_and_floors_in_floors_are_noted() {
    let off = json!([[[3, 3], [4, 3], [4, 4]], [[20, 2], [21, 2], [21, 3]]]);
    let found = note(&with("obstacles", off));
    assert!(
        found.starts_with("obstacles[1]: obstacles wholly off the floor"),
        "{found}"
    );
    let mut floors = room();
    let inner = json!([[[2, 2], [3, 2], [3, 3]]]);
    floors["walkable_area"].as_array_mut().unwrap().push(inner);
    let found = note(&floors);
    assert!(
        found.starts_with("walkable_area[1]: floor wholly inside"),
        "{found}"
    );
}

#[test]
fn crowds_mostly_off_the_floor_are_noted() {
    let area = |right: f64| {
        let mut room = room();
        room["crowds"][0]["area"] = json!([[0, 0], [right, 0], [right, 10], [0, 10]]);
        notes(&room)
    };
    let [found] = area(40.0).try_into().unwrap();
    assert!(found.contains("it reaches 28 m beyond the plan"), "{found}");
    let [found] = area(60.0).try_into().unwrap();
    assert!(found.contains("120.0 m² of its 600.0 m²"), "{found}");
}

#[test]
fn entrances_on_the_line_of_their_own_exit_are_noted() {
    let entrance = |line: Value| {
        let entrance = json!([{"name": "in", "line": line, "per_sec": 1, "number": 2}]);
        notes(&with("entrances", entrance))
    };
    let [found] = entrance(json!([[12, 4], [12, 6]])).try_into().unwrap();
    assert!(
        found.starts_with("entrances[0].line: agents enter on the line of the exit `east`"),
        "{found}"
    );
    assert_eq!(entrance(json!([[0, 4], [0, 6]])), [""; 0]);
}

#[test]
fn places_and_journeys_without_agents_are_noted() {
    let mut room = room();
    room["waypoints"] = json!([{"name": "a", "at": [4, 5]}, {"name": "b", "at": [6, 5]}]);
    room["journeys"] = json!([{"name": "long", "stages": ["a", "b", "east"]}, {"name": "short", "stages": ["east"]}]);
    for (used, said) in [
        (
            "short",
            "no agents use the journey `long`, the waypoint `a`, the waypoint `b`;",
        ),
        ("long", "no agents use the journey `short`;"),
    ] {
        room["crowds"][0]["journey"] = json!(used);
        let found = note(&room);
        assert!(found.starts_with(said), "{found}");
    }
}
