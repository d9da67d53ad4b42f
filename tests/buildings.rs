//! Buildings: scenario files with levels and joins. What people do is recomputed from files and positions alone.

use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Fault;
use sandbox::runs::drive::{Observer, Run};
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

use crate::common::buildings::{each, folded, house, read};
use crate::common::vector;

/// The height at a place of a level, from the document alone: `slopes` has, for each sloping level, the x and heights
/// of its ends.
fn height(level: &str, x: f64, document: &Value, slopes: &[(&str, [f64; 4])]) -> f64 {
    let slope = slopes.iter().find(|(name, _)| *name == level);
    if let Some((_, [x0, z0, x1, z1])) = slope {
        return z0 + (z1 - z0) * (x - x0) / (x1 - x0);
    }
    let levels = document["levels"].as_array().unwrap();
    let own = levels.iter().find(|own| own["name"] == level).unwrap();
    own["elevation"].as_f64().unwrap()
}

#[test]
fn everybody_walks_down_without_a_jump_in_place_or_height() {
    let houses = [
        (house(), 40, ("stairs", [10.0, 0.0, 14.0, 2.5]), 0.025),
        (folded(), 30, ("up", [4.0, 0.0, 8.0, 3.0]), 0.04),
    ];
    for (document, people, slope, _) in houses {
        let mut last: Vec<Option<(Vector, f64, String)>> = vec![None; people];
        let left = each(&read(&document), |id, p, level| {
            let z = height(level, p.x, &document, &[slope]);
            let here = (p, z, level.to_owned());
            let Some((before, before_z, on)) = last[id as usize].replace(here) else {
                return;
            };
            let (way, rise) = ((p - before).norm(), (z - before_z).abs());
            assert!(way < 0.045, "{id} jumps from {before} to {p}");
            assert!(rise < 0.04, "{id} jumps from {before_z} to {z} m at {p}");
            let joins = document["joins"].as_array().unwrap().iter();
            let at_join = joins.clone().any(|join| {
                let names = join["levels"].as_array().unwrap();
                let x = join["line"][0][0].as_f64().unwrap();
                names.iter().any(|name| *name == *on)
                    && names.iter().any(|name| *name == *level)
                    && (p.x - x).abs() < 0.05
            });
            assert!(
                on == level || at_join,
                "{id} changes from {on} to {level} at {p}"
            );
        });
        assert_eq!(left, people);
    }
}

#[test]
fn people_on_stairs_and_below_them_do_not_meet() {
    // The same hall with and without people on the flight that leads over it.
    let alone = {
        let mut document = folded();
        let area = json!([[5, 3.6], [9.5, 3.6], [9.5, 6], [5, 6]]);
        document["crowds"] = json!([{"level": "ground", "area": area, "number": 20}]);
        document
    };
    let mut both = alone.clone();
    let crowds = both["crowds"].as_array_mut().unwrap();
    crowds.push(
        json!({"level": "up", "area": [[5.2, 2], [8, 2], [8, 3.5], [5.2, 3.5]], "number": 12,
                       "goal": [7.9, 2.7]}),
    );
    let mut seen = [Vec::new(), Vec::new()];
    for (document, seen) in [alone, both].iter().zip(&mut seen) {
        let scenario = read(document);
        let mut frames = [0; 40];
        each(&scenario, |id, p, level| {
            let frame = &mut frames[id as usize];
            *frame += 1;
            if id < 20 && *frame <= 100 {
                seen.push((id, *frame, [p.x, p.y].map(f64::to_bits), level.to_owned()));
            }
        });
        seen.sort();
    }
    assert!(seen[0].len() > 1500);
    assert!(seen[0] == seen[1], "people in the hall walk differently");
}

#[test]
fn speeds_on_slopes_are_those_of_their_set() {
    // Weidmann (1993): 0.610 m/s up and 0.694 m/s down, seen from above, for 1.34 m/s on a floor.
    for (from, to, speed) in [("ground", "upper", 0.610), ("upper", "ground", 0.694)] {
        let mut document = house();
        let x = |level: &str| if level == "ground" { 0.5 } else { 19.5 };
        document["crowds"] = json!([]);
        document["preferred_speed"] = json!(1.34);
        document["agents"] = json!([{"level": from, "position": [x(from), 0.75]}]);
        let line = if to == "ground" {
            [[0, 0], [0, 2]]
        } else {
            [[20, 0], [20, 2]]
        };
        document["exits"] = json!([{"name": "out", "level": to, "line": line}]);
        let mut frames = 0;
        let left = each(&read(&document), |_, p, _| {
            frames += u32::from((11.0..13.0).contains(&p.x))
        });
        let measured = 2.0 / (f64::from(frames) * 0.02);
        assert_eq!(left, 1);
        assert!((measured - speed).abs() < 0.01, "{from}: {measured} m/s");
    }
}

/// Two flights side by side, without a gap between them, that meet at a landing.
fn touching() -> Value {
    let floor = |x: [f64; 2], y: [f64; 2]| {
        json!([[[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]]])
    };
    let (left, right) = ([0.0, 1.5], [1.5, 3.0]);
    json!({
        "profile": "sph",
        "duration_secs": 60,
        "levels": [
            {"name": "upper", "elevation": 3, "walkable_area": floor(left, [-8.0, -4.0])},
            {"name": "from above", "kind": "stairs", "walkable_area": floor(left, [-4.0, 0.0])},
            {"name": "landing", "elevation": 1.5, "walkable_area": floor([0.0, 3.0], [0.0, 1.5])},
            {"name": "down", "kind": "stairs", "walkable_area": floor(right, [-4.0, 0.0])},
            {"name": "lower", "elevation": 0, "walkable_area": floor(right, [-8.0, -4.0])},
        ],
        "joins": [
            {"levels": ["upper", "from above"], "line": [[0, -4], [1.5, -4]]},
            {"levels": ["from above", "landing"], "line": [[0, 0], [1.5, 0]]},
            {"levels": ["landing", "down"], "line": [[1.5, 0], [3, 0]]},
            {"levels": ["down", "lower"], "line": [[1.5, -4], [3, -4]]},
        ],
        "exits": [{"name": "end", "level": "lower", "line": [[1.5, -8], [3, -8]]}],
        "crowds": [{"level": "upper", "area": [[0, -8], [1.5, -8], [1.5, -4], [0, -4]], "number": 12}],
        "stop": {"when_empty": true},
    })
}

#[test]
fn flights_may_touch_and_people_turn_at_the_landing_between_them() {
    let scenario = read(&touching());
    let mut places = vec![Vec::new(); 12];
    let left = each(&scenario, |id, p, level| {
        // The wall between the two flights has no thickness.
        let x = match level {
            "upper" | "from above" => 0.0..1.5,
            "down" | "lower" => 1.5..3.0,
            _ => 0.0..3.0,
        };
        assert!(x.contains(&p.x), "{id} is at {p} on {level}");
        places[id as usize].push(level.to_owned());
    });
    assert_eq!(left, 12);
    for mut levels in places {
        levels.dedup();
        assert_eq!(levels, ["upper", "from above", "landing", "down", "lower"]);
    }
    // The landing has a wall between what is seen of both flights.
    let walls = scenario.scene.walls.iter();
    let levels = scenario.scene.levels.unwrap();
    let between = walls.filter(|wall| {
        let ends = [wall.start, wall.end].map(|p| levels.in_building(p));
        levels.level(wall.start) == 2 && ends.iter().all(|p| (p.x - 1.5).abs() < 0.02 && p.y <= 0.0)
    });
    let between: Vec<_> = between.collect();
    let lengths = between.iter().map(|wall| (wall.end - wall.start).norm());
    assert!(lengths.fold(0.0, f64::max) > 3.9);
    // It reaches the point at which both joins end: no line of sight leads from one flight to the other.
    let ends = between.iter().flat_map(|wall| [wall.start, wall.end]);
    let mut distances = ends.map(|p| (levels.in_building(p) - vector(1.5, 0.0)).norm());
    assert!(distances.any(|distance| distance < 1e-6));
}

#[test]
fn a_building_written_and_read_again_is_the_same() {
    let scenario = read(&house());
    let again = Scenario::parse(&scenario.to_text(), "house.json", &[]).unwrap();
    assert_eq!(scenario.scene.levels, again.scene.levels);
    assert_eq!(scenario.scene.agents, again.scene.agents);
    let heights = scenario.scene.levels.unwrap();
    let stairs = heights.way(1);
    assert!((heights.height(stairs + vector(12.0, 1.0)) - 1.25).abs() < 1e-9);
}

/// A corridor, and a flight up to a hall with an exit of this width.
fn flight(kind: &Value, exit: f64) -> Value {
    let mut document = json!({
        "profile": "steer+sph",
        "duration_secs": 60,
        "levels": [
            {"name": "ground", "elevation": 0, "walkable_area": [[[[0, 0], [24, 0], [24, 1.5], [0, 1.5]]]]},
            {"name": "flight", "walkable_area": [[[[24, 0], [32, 0], [32, 1.5], [24, 1.5]]]]},
            {"name": "hall", "elevation": 4, "walkable_area": [[[[32, 0], [38, 0], [38, 1.5], [32, 1.5]]]]},
        ],
        "joins": [
            {"levels": ["ground", "flight"], "line": [[24, 0], [24, 1.5]]},
            {"levels": ["flight", "hall"], "line": [[32, 0], [32, 1.5]]},
        ],
        "exits": [{"name": "out", "level": "hall", "line": [[38, 0.75 - exit / 2.0], [38, 0.75 + exit / 2.0]]}],
        "stop": {"when_empty": true},
    });
    for (key, value) in kind.as_object().unwrap() {
        document["levels"][1][key] = value.clone();
    }
    document
}

/// The lengths of the longest queues of a run.
fn queues(document: &Value) -> Vec<u32> {
    let mut run = Run::new(read(document)).unwrap();
    run.drive::<Fault, dyn Observer<Fault>>(&mut [], || false)
        .unwrap();
    let queues = run.metrics.longest_queues(&run.simulation);
    queues.iter().map(|queue| queue.agents).collect()
}

#[test]
fn only_those_who_are_held_up_on_stairs_stand_in_a_queue() {
    let stairs = json!({"kind": "stairs", "speeds": "weidmann"});
    let escalator = json!({"kind": "escalator", "runs": "up", "belt_speed": 0.5});
    for kind in [&stairs, &escalator] {
        let mut document = flight(kind, 1.5);
        let people = (0..7)
            .map(|k| json!({"level": "ground", "position": [2.0 + 2.5 * f64::from(k), 0.75]}));
        document["agents"] = people.collect();
        // They walk up behind each other, slower than half of their speed on a floor.
        assert_eq!(queues(&document), [0_u32; 0], "{kind}");
        let mut document = flight(kind, 0.7);
        document["exits"][0]["most_per_sec"] = json!(0.3);
        document["crowds"] = json!([{"level": "ground", "area": [[2, 0], [23, 0], [23, 1.5], [2, 1.5]], "number": 60}]);
        assert!(
            queues(&document).first().is_some_and(|&most| most >= 8),
            "{kind}"
        );
    }
}
