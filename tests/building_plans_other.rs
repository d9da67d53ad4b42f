//! Buildings in JuPedSim's XML, and drawings of storeys. Areas, joins and heights are recomputed from the numbers that
//! the files are made of.

use std::fs;

use sandbox::scenario::Scenario;
use serde_json::json;
use tempfile::TempDir;

use crate::common::buildings::each;
use crate::common::plan_files::{
    drawing, geometry, height, is_near, joins, load, rectangle, room, size, transition,
};

/// A hall, and a gallery 2.5 m above its end, with a stair of A_x = 0.5 between them.
fn halls() -> String {
    let stair = "class=\"stair\" A_x=\"0.5\" B_y=\"0\" C_z=\"-5\"";
    geometry(
        &[
            room(
                0,
                ["caption=\"hall\" zpos=\"0\"", "class=\"subroom\""],
                [0.0, 10.0],
                [0.0, 6.0],
            ),
            room(
                1,
                ["caption=\"stair\" zpos=\"0\"", stair],
                [10.0, 15.0],
                [0.0, 1.5],
            ),
            room(
                2,
                ["caption=\"gallery\" zpos=\"2.5\"", "class=\"subroom\""],
                [9.0, 20.0],
                [1.5, 8.0],
            ),
            room(
                3,
                ["zpos=\"2.5\"", "class=\"subroom\""],
                [15.0, 20.0],
                [0.0, 1.5],
            ),
        ],
        &[
            transition(0, "foot", [0, 1], [[10.0, 0.0], [10.0, 1.5]]),
            transition(1, "head", [1, 3], [[15.0, 0.0], [15.0, 1.5]]),
            transition(2, "gate", [2, 3], [[16.0, 1.5], [18.0, 1.5]]),
            transition(3, "out", [0, -1], [[0.0, 2.0], [0.0, 3.0]]),
        ],
    )
}

#[test]
fn storeys_and_stairs_of_jupedsim_are_levels() {
    let base = json!({
        "profile": "steer+sph", "duration_secs": 200, "stop": {"when_empty": true},
        "crowds": [{"level": "2.5 m", "area": "gallery", "number": 25}],
        "exits": [{"name": "out", "level": "hall"}],
        "measurements": [{"line_flow": {"name": "gate", "level": "2.5 m", "line": "gate"}}],
    });
    let scenario = load("halls.xml", &halls(), &base).unwrap();
    is_near(size(&scenario, "hall"), 60.0, 1e-9);
    is_near(size(&scenario, "stair"), 7.5, 1e-9);
    // The wall between the two rooms, 5 m without the gate of 2 m, is 1 cm thick.
    is_near(
        size(&scenario, "2.5 m"),
        11.0 * 6.5 + 5.0 * 1.5 - 0.03,
        1e-3,
    );
    for [x, y] in [[10.0, 0.3], [12.0, 1.0], [15.0, 1.4]] {
        is_near(height(&scenario, "stair", [x, y]), 0.5 * x - 5.0, 1e-9);
    }
    let lines: Vec<[[f64; 2]; 2]> = joins(&scenario).into_iter().map(|(_, line)| line).collect();
    // The upper one ends before the wall between the two rooms.
    assert_eq!(
        lines,
        [[[10.0, 0.0], [10.0, 1.5]], [[15.0, 0.0], [15.0, 1.48]]]
    );
    assert!(
        !scenario.notes.iter().any(|note| note.contains("plane")),
        "{:?}",
        scenario.notes
    );
    assert_eq!(each(&scenario, |_, _, _| {}), 25);
    // As one floor, the hall lies below the gallery.
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("halls.xml"), halls()).unwrap();
    let document = json!({"walkable_area": "halls.xml", "agents": []});
    let path = folder.path().join("floor.json");
    fs::write(&path, document.to_string()).unwrap();
    let said = Scenario::load(&path, &[]).unwrap_err().to_string();
    assert!(
        said.contains("storeys overlap in plan") && said.contains("`\"levels\": \"FILE.xml\"`"),
        "{said}"
    );
}

#[test]
fn wrong_stairs_of_jupedsim_are_refused_and_other_slopes_noted() {
    let base = json!({"profile": "sph", "duration_secs": 1, "agents": []});
    let said = |xml: &str| load("halls.xml", xml, &base).map(|scenario| scenario.notes.join("\n"));
    let lone = halls().replace(
        "room1_id=\"1\" subroom1_id=\"0\" room2_id=\"3\"",
        "room1_id=\"2\" subroom1_id=\"0\" room2_id=\"3\"",
    );
    let lone = said(&lone).unwrap_err().to_string();
    assert!(
        lone.contains("room 1 (stair), subroom 0: `stair`: it joins only `hall`, at 0 m"),
        "{lone}"
    );
    let steeper = said(&halls().replace("A_x=\"0.5\"", "A_x=\"0.7\"")).unwrap();
    assert!(
        steeper.contains("rises 3.5 m between its ends, the floors there 2.5 m, which count"),
        "{steeper}"
    );
    let escalator = said(&halls().replace("class=\"stair\"", "class=\"escalator_up\"")).unwrap();
    assert!(
        escalator.contains("escalators are left out: room 1 (stair), subroom 0"),
        "{escalator}"
    );
    assert!(
        escalator.contains("transition 0: joins nothing"),
        "{escalator}"
    );
    assert!(
        escalator.contains("level `2.5 m`: no stairs or ramp leads to it"),
        "{escalator}"
    );
    let mut taken = base.clone();
    taken["plan"] = json!({"storey": "hall"});
    let taken = load("halls.xml", &halls(), &taken).unwrap_err().to_string();
    assert!(
        taken.contains("plan.storey: takes one storey, and `levels` takes all: remove it"),
        "{taken}"
    );
}

#[test]
fn drawings_of_storeys_have_options_of_their_own_and_a_common_point() {
    let folder = TempDir::new().unwrap();
    // The point (0, 0) of the building is (2, 1) m in one drawing and (-300, -40) m in the other.
    let ground = drawing(
        4,
        (1000.0, [-2.0, -1.0]),
        &[
            ("floor", rectangle([0.0, 10.0], [0.0, 6.0])),
            ("exits", vec![[0.0, 2.0], [0.0, 3.2]]),
        ],
    );
    let upper = drawing(
        6,
        (1.0, [300.0, 40.0]),
        &[
            ("X1", rectangle([14.0, 20.0], [0.0, 6.0])),
            ("X2", rectangle([16.0, 16.5], [2.0, 4.0])),
        ],
    );
    fs::write(folder.path().join("ground.dxf"), ground).unwrap();
    fs::write(folder.path().join("upper.dxf"), upper).unwrap();
    let stairs = [rectangle([10.0, 14.0], [0.0, 1.5])];
    let document = json!({
        "profile": "steer+sph", "duration_secs": 120, "stop": {"when_empty": true},
        "plan": {"origin": [2, 1], "layers": {"X1": "none"}},
        "levels": [
            {"name": "ground", "elevation": 0, "walkable_area": "ground.dxf"},
            {"name": "stairs", "kind": "stairs", "walkable_area": [stairs]},
            {"name": "upper", "elevation": 2.5, "walkable_area": "upper.dxf",
             "plan": {"origin": [-300, -40], "layers": {"X1": "floor", "X2": "obstacle"}}},
        ],
        "joins": [
            {"levels": ["ground", "stairs"], "line": [[10, 0], [10, 1.5]]},
            {"levels": ["stairs", "upper"], "line": [[14, 0], [14, 1.5]]},
        ],
        "crowds": [{"level": "upper", "area": [[17, 0], [20, 0], [20, 6], [17, 6]], "number": 20}],
        "exits": [{"name": "exit 1", "level": "ground"}],
    });
    let path = folder.path().join("house.json");
    fs::write(&path, document.to_string()).unwrap();
    let scenario = Scenario::load(&path, &[]).unwrap();
    is_near(size(&scenario, "ground"), 60.0, 1e-6);
    is_near(size(&scenario, "upper"), 36.0 - 0.5 * 2.0, 1e-6);
    let line: [[f64; 2]; 2] =
        serde_json::from_value(scenario.document["exits"][0]["line"].clone()).unwrap();
    for (found, expected) in line.iter().flatten().zip([0.0, 2.0, 0.0, 3.2]) {
        is_near(*found, expected, 1e-9);
    }
    assert_eq!(each(&scenario, |_, _, _| {}), 20);
    // Wrong options have the place of their level.
    let mut wrong = document.clone();
    wrong["levels"][2]["plan"]["unit"] = json!("miles");
    fs::write(&path, wrong.to_string()).unwrap();
    let said = Scenario::load(&path, &[]).unwrap_err().to_string();
    assert!(
        said.contains("levels[2]") && said.contains("`miles` is no unit of plans"),
        "{said}"
    );
    wrong["levels"][2]["plan"] = json!({"origins": [0, 0]});
    fs::write(&path, wrong.to_string()).unwrap();
    let said = Scenario::load(&path, &[]).unwrap_err().to_string();
    assert!(said.contains("levels[2].plan"), "{said}");
    let mut idle = document;
    idle["levels"][1]["plan"] = json!({"unit": "cm"});
    fs::write(&path, idle.to_string()).unwrap();
    let notes = Scenario::load(&path, &[]).unwrap().notes.join("\n");
    assert!(
        notes.contains("levels[1].plan: has no effect: the level names no file"),
        "{notes}"
    );
}
