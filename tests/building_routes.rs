//! Routes over the levels of buildings, over several stairs, and through doors on them.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;
use sandbox::engine::routes::Destination;
use sandbox::engine::simulation::Simulation;
use serde_json::{Value, json};

use crate::common::buildings::{each, house, read, refused};
use crate::common::vector;

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

/// Two floors with two flights of stairs, and people upstairs nearer to the first one.
fn two_stairs() -> Value {
    let flight = |name: &str, y: f64| {
        let area = json!([[[[10, y], [14, y], [14, y + 1.5], [10, y + 1.5]]]]);
        json!({"name": name, "kind": "stairs", "walkable_area": area})
    };
    let joins = |name: &str, y: f64| {
        let line = |x: f64| json!([[x, y], [x, y + 1.5]]);
        [
            json!({"levels": ["ground", name], "line": line(10.0)}),
            json!({"levels": [name, "upper"], "line": line(14.0)}),
        ]
    };
    let both = [joins("a", 1.0), joins("b", 7.5)].concat();
    json!({
        "profile": "steer+sph",
        "duration_secs": 240,
        "levels": [
            {"name": "ground", "elevation": 0, "walkable_area": [[[[0, 0], [10, 0], [10, 10], [0, 10]]]]},
            flight("a", 1.0),
            flight("b", 7.5),
            {"name": "upper", "elevation": 2.5, "walkable_area": [[[[14, 0], [24, 0], [24, 10], [14, 10]]]]},
        ],
        "joins": both,
        "crowds": [{"level": "upper", "area": [[15, 0], [24, 0], [24, 5], [15, 5]], "number": 80}],
        "exits": [{"name": "street", "level": "ground", "line": [[0, 1], [0, 4]]}],
        "stop": {"when_empty": true},
    })
}

/// How many people walk over each of both flights, and the time until all are out, seconds.
fn by_flight(document: &Value) -> ([usize; 2], f64) {
    let mut on = [
        std::collections::BTreeSet::new(),
        std::collections::BTreeSet::new(),
    ];
    let mut frames = std::collections::BTreeMap::new();
    let left = each(&read(document), |id, _, level| {
        *frames.entry(id).or_insert(0) += 1;
        match level {
            "a" => on[0].insert(id),
            "b" => on[1].insert(id),
            _ => false,
        };
    });
    assert_eq!(left, frames.len(), "all people leave");
    (
        on.map(|ids| ids.len()),
        f64::from(*frames.values().max().unwrap()) * 0.02,
    )
}

#[test]
fn a_crowd_takes_both_stairs_if_it_looks_for_the_quickest_route() {
    let mut document = two_stairs();
    let (shortest, slow) = by_flight(&document);
    assert_eq!(shortest, [80, 0]);
    document["route_choice"] = json!("quickest");
    let (quickest, fast) = by_flight(&document);
    assert_eq!(quickest[0] + quickest[1], 80, "{quickest:?}");
    assert!(quickest[1] > 15, "{quickest:?}");
    assert!(fast < 0.9 * slow, "{fast} s and {slow} s");
}

#[test]
fn slow_stairs_are_worth_a_detour() {
    // Alone, 14 m over the first flight at a tenth of the speed, or 30 m over the second one.
    let mut document = two_stairs();
    document["crowds"] = json!([]);
    document["agents"] = json!([{"level": "upper", "position": [16, 2]}]);
    document["levels"][1]["speed_factors"] = json!([0.1, 0.1]);
    document["levels"][2]["speeds"] = json!("same");
    assert_eq!(by_flight(&document).0, [1, 0]);
    document["route_choice"] = json!("quickest");
    assert_eq!(by_flight(&document).0, [0, 1]);
}

#[test]
fn doors_close_flights_and_let_people_pass_one_way() {
    let mut document = two_stairs();
    document["crowds"][0]["number"] = json!(20);
    let line = json!([[12, 1], [12, 2.5]]);
    for (one_way, expected) in [([-1, 0], [20, 0]), ([1, 0], [0, 20])] {
        let gate = json!({"name": "gate", "level": "a", "line": line, "one_way": one_way});
        document["doors"] = json!([gate]);
        assert_eq!(by_flight(&document).0, expected, "{one_way:?}");
    }
    // Closed all the time: all walk over the other flight.
    let gate = json!({"name": "gate", "level": "a", "line": line, "closed_secs": [[0, 1000]]});
    document["doors"] = json!([gate]);
    assert_eq!(by_flight(&document).0, [0, 20]);
    document["doors"][0]["line"] = json!([[14, 1], [14, 2.5]]);
    let said = refused(&document);
    assert!(
        said.contains("doors[0].line: lies on the join of `a` and `upper`: draw it 10 cm"),
        "{said}"
    );
}

#[test]
fn routes_turn_around_the_end_of_the_wall_between_two_flights_that_touch() {
    // From the end of this wall, the shortest way leads along it, and straight on to the exit.
    let floor = |x: [f64; 2], y: [f64; 2]| {
        json!([[[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]]])
    };
    let (left, right) = ([0.0, 1.5], [1.5, 3.0]);
    let places = [
        ("down", 0.75, -2.0),
        ("down", 1.1, -0.7),
        ("upper", 0.4, -6.0),
        ("upper", 1.2, -4.5),
    ];
    let agents = places.map(|(level, x, y)| json!({"level": level, "position": [x, y]}));
    let scenario = read(&json!({
        "profile": "sph",
        "duration_secs": 60,
        "levels": [
            {"name": "upper", "elevation": 3, "walkable_area": floor(left, [-8.0, -4.0])},
            {"name": "down", "kind": "stairs", "walkable_area": floor(left, [-4.0, 0.0])},
            {"name": "landing", "elevation": 1.5, "walkable_area": floor([0.0, 3.0], [0.0, 1.5])},
            {"name": "back", "kind": "stairs", "walkable_area": floor(right, [-4.0, 0.0])},
            {"name": "lower", "elevation": 0, "walkable_area": floor([-3.0, 3.0], [-8.0, -4.0])},
        ],
        "joins": [
            {"levels": ["upper", "down"], "line": [[0, -4], [1.5, -4]]},
            {"levels": ["down", "landing"], "line": [[0, 0], [1.5, 0]]},
            {"levels": ["landing", "back"], "line": [[1.5, 0], [3, 0]]},
            {"levels": ["back", "lower"], "line": [[1.5, -4], [3, -4]]},
        ],
        "exits": [{"name": "end", "level": "lower", "line": [[-1, -8], [2.5, -8]]}],
        "agents": agents,
        "stop": {"when_empty": true},
    }));
    let routes = scenario.scene.routes.clone().unwrap();
    for (agent, (level, x, y)) in scenario.scene.agents.iter().zip(places) {
        let own = routes.length(agent.position, Destination::Place(0));
        let expected = (vector(1.5, 0.0) - vector(x, y)).norm() + 8.0;
        assert!(
            (own - expected).abs() < 1e-6,
            "({x}, {y}) on {level}: {own}, {expected}"
        );
    }
    assert_eq!(each(&scenario, |_, _, _| {}), 4);
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
