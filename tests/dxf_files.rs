//! Drawings of ezdxf (`tests/data/dxf`), also damaged. The areas that are expected are computed by hand, or by shapely.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::dxf::{area, is_floor, is_near};
use sandbox::scenario::floor_plan::{self, FloorPlan, Reading};

/// A drawing of `tests/data/dxf`.
fn file(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/dxf");
    fs::read(folder.join(name)).unwrap()
}

fn plan(name: &str) -> FloorPlan {
    floor_plan::parse_bytes(&file(name), &Reading::default()).unwrap()
}

#[test]
fn rooms_of_an_office_with_double_walls_and_door_blocks_are_joined() {
    let plan = plan("office.dxf");
    let [rooms, openings, corridor] = [4.0 * 4.0 * 5.0, 4.0 * 1.0 * 0.2, 16.6 * 2.0];
    is_near(area(&plan), rooms + openings + corridor, 1e-6);
    // Not the hollow outer walls.
    assert!(!is_floor(&plan, -0.1, 3.0) && !is_floor(&plan, 4.1, 4.0));
    assert!(
        plan.notes[0].starts_with("taken as millimeters, 17.2 by "),
        "{:?}",
        plan.notes
    );
}

#[test]
fn a_round_hall_far_away_has_the_area_of_its_circles() {
    let plan = plan("arena.dxf");
    let hall = 0.75 * PI * 400.0 + 200.0 + 0.5 * 0.01 * 20.0;
    let stage = 8.0 * 4.0 + PI * 4.0;
    let columns = 8.0 * PI * 0.25;
    // Straight parts leave out two thirds of the tolerance on average.
    let arcs = PI * (30.0 + 4.0 + 8.0);
    is_near(area(&plan), hall - stage - columns, 0.005 * arcs);
    // Moved by 345 and 5,268 km: the lower left corner is the origin.
    let [x, y] = [20.0, 20.0];
    assert!(is_floor(&plan, x + 6.05, y) && !is_floor(&plan, x + 5.95, y));
    let angle = PI / 8.0 + 2.0 * PI / 4.0;
    assert!(!is_floor(
        &plan,
        x + 10.0 * angle.cos(),
        y + 10.0 * angle.sin()
    ));
    let expected = "moved by (-345000, -5268010) m, so that it begins near the origin";
    assert!(
        plan.notes.iter().any(|note| note == expected),
        "{:?}",
        plan.notes
    );
}

#[test]
fn a_station_of_blocks_has_all_its_mirrored_columns() {
    let plan = plan("station.dxf");
    let hall = 30.0 * 16.0 - 2.0 * 2.0;
    let group = 4.0 * 0.6 * 0.4 / 2.0;
    is_near(area(&plan), hall - 6.0 * group - 1.5 * 1.5 * group, 1e-6);
    // Within each of the four columns of the group at (14, 11).
    for [right, up] in [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]] {
        assert!(!is_floor(&plan, 14.0 + 0.3 * right, 11.0 + 0.3 * up));
        assert!(is_floor(&plan, 14.0 + 0.7 * right, 11.0 + 0.5 * up));
    }
}

#[test]
fn a_theater_has_the_area_that_ezdxf_gives() {
    let plan = plan("theater.dxf");
    // By `make.py`: shapely and ezdxf's curves within 0.1 mm.
    is_near(area(&plan), 415.6095, 0.005 * 80.0);
    assert!(
        !is_floor(&plan, 4.0, 4.0) && !is_floor(&plan, 10.0, 13.0) && !is_floor(&plan, 18.0, 9.0)
    );
}

#[test]
fn binary_files_give_the_same_plans_as_text() {
    for name in ["arena", "theater"] {
        let [text, binary] = [
            plan(&format!("{name}.dxf")),
            plan(&format!("{name}_binary.dxf")),
        ];
        assert!(!text.walkable.is_empty());
        assert_eq!(text, binary);
    }
}

#[test]
fn damaged_files_give_plans_or_errors() {
    let names = [
        "office",
        "arena",
        "station",
        "theater",
        "arena_binary",
        "theater_binary",
    ];
    let files = names.map(|name| file(&format!("{name}.dxf")));
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for k in 0..20_000 {
        let mut bytes = files[k % files.len()].clone();
        for _ in 0..random.random_range(1..6) {
            damage(&mut bytes, &mut random);
        }
        let reading = Reading::default();
        match floor_plan::parse_bytes(&bytes, &reading) {
            Ok(plan) => assert!(plan.solids().is_ok()),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}

/// Changes bytes at one place.
fn damage(bytes: &mut Vec<u8>, random: &mut ChaCha8Rng) {
    let values: [&[u8]; 8] = [
        b"-1",
        b"1e300",
        b"nan",
        b"0",
        b"99999999999",
        b"INSERT",
        b"LINE",
        b"floor",
    ];
    let from = random.random_range(0..bytes.len().max(1)).min(bytes.len());
    let line = bytes[from..]
        .iter()
        .position(|&byte| byte == b'\n')
        .unwrap_or(0);
    match random.random_range(0..5) {
        0 => bytes.truncate(from.max(1)),
        1 => bytes
            .iter_mut()
            .skip(from)
            .take(1)
            .for_each(|byte| *byte = random.random()),
        2 => drop(bytes.drain(from..from + line)),
        3 => {
            let end = bytes[from + line..]
                .iter()
                .skip(1)
                .position(|&byte| byte == b'\n');
            let to = from + line + end.unwrap_or(0);
            bytes.splice(
                from + line..to,
                [b"\n", values[random.random_range(0..8)]].concat(),
            );
        }
        _ => {
            let to = (from + random.random_range(0..200)).min(bytes.len());
            let copy = bytes[from..to].to_vec();
            bytes.splice(from..from, copy);
        }
    }
}
