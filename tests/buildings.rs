//! Buildings: scenario files with levels and joins. What is said is recomputed from the files and the positions alone.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;
use sandbox::engine::routes::Destination;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

use crate::common::vector;

/// A house of two floors with a flight of stairs, in which people upstairs walk to the street.
fn house() -> Value {
    json!({
        "profile": "steer+sph",
        "duration_secs": 120,
        "levels": [
            {"name": "ground", "elevation": 0, "walkable_area": [[[[0, 0], [10, 0], [10, 6], [0, 6]]]]},
            {"name": "stairs", "kind": "stairs", "walkable_area": [[[[10, 0], [14, 0], [14, 1.5], [10, 1.5]]]]},
            {"name": "upper", "elevation": 2.5, "walkable_area": [[[[14, 0], [20, 0], [20, 6], [14, 6]]]]},
        ],
        "joins": [
            {"levels": ["ground", "stairs"], "line": [[10, 0], [10, 1.5]]},
            {"levels": ["stairs", "upper"], "line": [[14, 0], [14, 1.5]]},
        ],
        "crowds": [{"name": "people", "level": "upper", "area": [[14, 0], [20, 0], [20, 6], [14, 6]], "number": 40}],
        "exits": [{"name": "street", "level": "ground", "line": [[0, 2], [0, 3.2]]}],
        "stop": {"when_empty": true},
    })
}

/// A house whose upper floor lies above the ground floor: the stairs turn back over it by a landing. The hall goes on
/// beside and behind the stairs.
fn folded() -> Value {
    json!({
        "profile": "sph",
        "duration_secs": 120,
        "levels": [
            {"name": "ground", "elevation": 0,
             "walkable_area": [[[[0, 0], [10, 0], [10, 6], [0, 6]], [[4, 2], [8, 2], [8, 3.5], [4, 3.5]]]]},
            {"name": "up", "kind": "stairs", "walkable_area": [[[[4, 2], [8, 2], [8, 3.5], [4, 3.5]]]]},
            {"name": "upper", "elevation": 3, "walkable_area": [[[[8, 0], [12, 0], [12, 6], [8, 6]]]]},
        ],
        "joins": [
            {"levels": ["ground", "up"], "line": [[4, 2], [4, 3.5]]},
            {"levels": ["up", "upper"], "line": [[8, 2], [8, 3.5]]},
        ],
        "crowds": [{"level": "upper", "area": [[8, 0], [12, 0], [12, 6], [8, 6]], "number": 30}],
        "exits": [{"name": "street", "level": "ground", "line": [[10, 4], [10, 5.2]]}],
        "stop": {"when_empty": true},
    })
}

fn read(document: &Value) -> Scenario {
    Scenario::parse(&document.to_string(), "house.json", &[]).unwrap()
}

fn refused(document: &Value) -> String {
    let problem = Scenario::parse(&document.to_string(), "house.json", &[]);
    problem.unwrap_err().to_string()
}

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

/// Runs to the end; calls `see` with the id, the place in the building and the name of the level of everybody.
fn each(scenario: &Scenario, mut see: impl FnMut(u32, Vector, &str)) -> usize {
    let levels = scenario.scene.levels.clone().unwrap();
    let mut simulation = Simulation::new(scenario.scene.clone()).unwrap();
    for _ in 0..15_000 {
        simulation.evaluate().unwrap();
        let agents = simulation.frame().agents;
        for (&id, &p) in agents.id.iter().zip(&agents.position) {
            see(
                id,
                levels.in_building(p),
                &levels.all()[levels.level(p)].name,
            );
        }
        if agents.is_empty() {
            break;
        }
        simulation.integrate().unwrap();
    }
    simulation.outcome().arrivals.len()
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

#[test]
fn ways_lead_to_the_nearer_exit_over_levels() {
    let mut document = house();
    document["exits"] = json!([
        {"name": "street", "level": "ground", "line": [[0, 2], [0, 3.2]]},
        {"name": "balcony", "level": "upper", "line": [[20, 4], [20, 5.2]]},
    ]);
    document["crowds"] = json!([
        {"level": "upper", "area": [[17, 3], [19, 3], [19, 6], [17, 6]], "number": 5},
        {"level": "stairs", "area": [[11, 0], [13, 0], [13, 1.5], [11, 1.5]], "number": 3},
        {"level": "ground", "area": [[7, 0], [9, 0], [9, 1.5], [7, 1.5]], "number": 3},
    ]);
    let scenario = read(&document);
    let mut simulation = Simulation::new(scenario.scene).unwrap();
    crate::common::run(&mut simulation, 3000);
    let exits = simulation
        .outcome()
        .arrivals
        .iter()
        .map(|arrival| (arrival.id, arrival.trip.unwrap().exit));
    let mut exits: Vec<_> = exits.collect();
    exits.sort_unstable();
    // From the stairs, 9 to 10 m lead to the balcony and 11 m or more to the street.
    let expected = (0..8).map(|id| (id, 1)).chain((8..11).map(|id| (id, 0)));
    assert_eq!(exits, expected.collect::<Vec<_>>());
}

#[test]
fn wrong_buildings_are_refused_with_their_place() {
    let with = |path: &str, value: Value| {
        let mut document = house();
        match document.pointer_mut(path) {
            Some(place) => *place = value,
            None => {
                let (parent, key) = path.rsplit_once('/').unwrap();
                document.pointer_mut(parent).unwrap()[key] = value;
            }
        }
        document
    };
    let cases = [
        (
            with("/exits/0/level", json!("grund")),
            "exits[0].level: there is no level named `grund`; did you mean `ground`?",
        ),
        (
            with("/exits/0/level", Value::Null),
            "exits[0]: missing key `level`: one of `ground`, `stairs`, `upper`",
        ),
        (
            with("/levels/0/elevation", Value::Null),
            "levels[0]: `ground`: a floor needs an `elevation`",
        ),
        (
            with("/levels/1/elevation", json!(1)),
            "levels[1]: `stairs`: stairs and ramps have the heights of the floors that they join",
        ),
        (
            with("/levels/2/name", json!("ground")),
            "levels[2].name: there are two levels named `ground`",
        ),
        (
            with("/joins/1/line", json!([[15, 0], [15, 1.5]])),
            "joins[1].line: must be an edge of both levels, from end to end: `stairs` lies on neither side of it",
        ),
        (
            with("/joins/0/line", json!([[10, 0], [10, 3]])),
            "joins[0].line: must be an edge of both levels, from end to end: `stairs` lies on neither side of it",
        ),
        (
            with("/joins/0/levels", json!(["ground", "ground"])),
            "joins[0].levels: a join needs two different levels",
        ),
        (
            with("/joins/0/levels", json!(["ground", "stair"])),
            "joins[0].levels[1]: there is no level named `stair`; did you mean `stairs`?",
        ),
        (
            with("/levels/2/elevation", json!(0)),
            "levels[1]: `stairs`: it needs joins with floors of two heights, one at its lower and one at its",
        ),
        (
            with("/walkable_area", json!([[[[0, 0], [1, 0], [1, 1]]]])),
            "walkable_area: cannot be with `levels`: the levels have their own",
        ),
        (
            with("/doors", json!([{"name": "d", "line": [[1, 1], [1, 2]]}])),
            "doors: cannot be with `levels`: doors in buildings are not known yet; leave gaps in the walls",
        ),
        (
            with("/levels", json!([])),
            "joins: there are no `levels` to join",
        ),
        (
            with("/route_choice", json!("quickest")),
            "route_choice: `quickest` routes are not known in buildings yet; remove it",
        ),
        (
            with(
                "/crowds/0/area",
                json!([[24, 0], [30, 0], [30, 6], [24, 6]]),
            ),
            "crowds[0].area: lies in obstacles or outside of the walkable area",
        ),
        (with("/levels/0/kind", json!("stair")), "levels[0].kind"),
        (with("/levels/0/height", json!(3)), "levels[0]"),
    ];
    for (document, expected) in cases {
        let said = refused(&document);
        assert!(said.contains(expected), "{said}\ninstead of: {expected}");
    }
}

#[test]
fn messages_name_places_of_the_building() {
    let mut document = house();
    document["agents"] = json!([{"level": "upper", "position": [25, 3]}]);
    let said = refused(&document);
    assert!(said.contains("(25, 3) on `upper`"), "{said}");
    // Without the stairs, no way leads down.
    let mut document = house();
    document["joins"] = json!([{"levels": ["ground", "stairs"], "line": [[10, 0], [10, 1.5]]}]);
    let floor = document["levels"][1]["walkable_area"].clone();
    document["levels"][1] = json!({"name": "stairs", "elevation": 0, "walkable_area": floor});
    let said = refused(&document);
    assert!(
        said.contains("no way leads from") && said.contains("on `upper`"),
        "{said}"
    );
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

/// A tower of random storeys, all above each other, with a staircase at its east side: from each storey a flight leads
/// up to a landing and another one back to the next storey, above the first.
fn tower(random: &mut ChaCha8Rng) -> (Value, usize, f64) {
    let storeys = random.random_range(2..=5);
    let width = random.random_range(6.0..14.0);
    let depth = random.random_range(4.0..9.0);
    let rectangle = |x: [f64; 2], y: [f64; 2]| {
        json!([[[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]]])
    };
    let (up, back) = ([0.0, 1.6], [2.0, 3.6]);
    let (flight, landing) = ([width, width + 4.0], [width + 4.0, width + 5.6]);
    let (mut levels, mut joins) = (Vec::new(), Vec::new());
    let mut join = |a: &str, b: &str, x: f64, y: [f64; 2]| {
        joins.push(json!({"levels": [a, b], "line": [[x, y[0]], [x, y[1]]]}));
    };
    for k in 0..storeys {
        let floor = rectangle([0.0, width], [0.0, depth]);
        levels.push(json!({"name": format!("{k}"), "elevation": 3 * k, "walkable_area": floor}));
        if k + 1 == storeys {
            break;
        }
        let [one, half, two] = ["up", "landing", "back"].map(|part| format!("{k} {part}"));
        levels.push(json!({"name": one, "kind": "stairs", "walkable_area": rectangle(flight, up)}));
        let area = rectangle(landing, [0.0, 3.6]);
        let elevation = 3.0 * k as f64 + 1.5;
        levels.push(json!({"name": half, "elevation": elevation, "walkable_area": area}));
        levels
            .push(json!({"name": two, "kind": "stairs", "walkable_area": rectangle(flight, back)}));
        join(&format!("{k}"), &one, flight[0], up);
        join(&one, &half, flight[1], up);
        join(&half, &two, flight[1], back);
        join(&two, &format!("{}", k + 1), flight[0], back);
    }
    let crowds = (0..storeys).map(|k| {
        let area = [[0.0, 0.0], [width, 0.0], [width, depth], [0.0, depth]];
        json!({"level": format!("{k}"), "area": area, "number": 6})
    });
    let profile = ["sph", "sf->sph", "steer+sph"][random.random_range(0..3)];
    let document = json!({
        "profile": profile,
        "duration_secs": 300,
        "levels": levels,
        "joins": joins,
        "crowds": crowds.collect::<Vec<_>>(),
        "exits": [{"name": "street", "level": "0", "line": [[0, 0.8], [0, 2.4]]}],
        "stop": {"when_empty": true},
    });
    (document, storeys, width)
}

#[test]
fn ways_down_random_towers_are_as_long_as_taut_strings_and_everybody_arrives() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    for number in 0..60 {
        let (document, storeys, width) = tower(&mut random);
        let scenario = read(&document);
        let levels = scenario.scene.levels.clone().unwrap();
        let routes = scenario.scene.routes.clone().unwrap();
        let distance = |a: Vector, b: Vector| (a - b).norm();
        for agent in &scenario.scene.agents {
            let p = levels.in_building(agent.position);
            let storey: usize = levels.all()[levels.level(agent.position)]
                .name
                .parse()
                .unwrap();
            let [well, below] = [2.0, 1.6].map(|y| vector(width + 4.0, y));
            let taut = if storey == 0 {
                distance(p, vector(0.0, p.y.clamp(0.81, 2.39)))
            } else {
                let at_edge = p.y + (2.0 - p.y) * (width - p.x) / (width + 4.0 - p.x);
                let corner = vector(width, if at_edge < 2.0 { 2.0 } else { 3.6 });
                let to_well = match (2.0..=3.6).contains(&at_edge) {
                    true => distance(p, well),
                    false => distance(p, corner) + distance(corner, well),
                };
                // Down to the landing, around the well, down to the next storey, and around again.
                to_well + distance(well, below) + 4.0 + 8.8 * (storey as f64 - 1.0) + width
            };
            let own = routes.length(agent.position, Destination::Place(0));
            assert!(
                (own - taut).abs() < 1e-6,
                "tower {number}, storey {storey}, {p}: {own}, {taut}"
            );
        }
        if number % 5 == 0 {
            let left = each(&scenario, |_, _, _| {});
            assert_eq!(left, 6 * storeys, "tower {number}");
        }
    }
}
