//! Measurements of arrivals, and the independent observer of walls.

use crate::common::simulated::measured;
use crate::common::{blend, person, polygon, scene, vector};
use sandbox::engine::geometry::Polygon;
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::{Fault, Simulation};
use sandbox::runs::drive::{Observer, Run};
use sandbox::runs::summary::Summary;
use sandbox::scenario::Scenario;
use sandbox::scenario::measurements::{Integrity, Measure as _, Walk, Watched};
use serde::Deserialize as _;
use serde_json::{Value, json};

/// The times of four arrivals with gaps of about 1, 4 and 1 s, and the measurements that count `arrivals`.
fn arrivals(arrivals: u32) -> (Vec<f64>, Summary) {
    let walk = |(k, length): (usize, f64)| {
        let y = 9.0 * k as f64;
        json!({"position": [0, y], "goal": [length, y], "remove_within": 0.5})
    };
    let lengths = [3.0, 4.3, 9.5, 10.8].into_iter().enumerate();
    let document = json!({
        "profile": "sf", "duration_secs": 20, "agents": lengths.map(walk).collect::<Vec<_>>(),
        "measurements": [
            {"flow_of_first": {"arrivals": arrivals}}, {"locked": {"arrivals": arrivals}},
            {"pauses": {"arrivals": arrivals, "longer_than_secs": 2}},
        ],
    });
    let scenario = Scenario::parse(&document.to_string(), "f.json", &[]).unwrap();
    let mut run = Run::new(scenario).unwrap();
    run.drive::<Fault, dyn Observer<Fault>>(&mut [], || false)
        .unwrap();
    let arrived = run.simulation.outcome().arrivals.iter();
    (arrived.map(|one| one.time).collect(), Summary::of(&run))
}

#[test]
fn flow_counts_the_gaps_between_arrivals_and_pauses_are_left_out_between_them() {
    let (times, summary) = arrivals(4);
    let &[first, second, third, last] = times.as_slice() else {
        panic!("{times:?}");
    };
    assert!(third - second > 3.0 && last - third < 2.0 && second - first < 2.0);
    let metric = |name: &str, expected: f64| {
        let found = summary.metric(name).unwrap();
        assert!((found - expected).abs() < 1e-12, "{name}: {found}");
    };
    metric("flow_per_s", 3.0 / (last - first));
    metric("pauses_secs", third - second);
    let between = 3.0 / (last - first - (third - second));
    metric("flow_between_pauses_per_s", between);
    metric("locked", 0.0);
}

#[test]
fn without_enough_arrivals_there_is_no_flow() {
    let (_, summary) = arrivals(5);
    for name in ["flow_per_s", "pauses_secs", "flow_between_pauses_per_s"] {
        assert_eq!(summary.metric(name), None, "{name}");
    }
    assert_eq!(summary.metric("locked"), Some(1.0));
}

fn with_person(solids: Vec<Polygon>, place: Option<Vector>) -> Simulation {
    let mut scene = scene(solids, blend("sph"));
    scene.agents = place.into_iter().map(|p| person(p, p)).collect();
    Simulation::new(scene).unwrap()
}

/// Whether the observer sees an agent cross a wall between `from` (if it is given) and `to`. The second simulation has
/// no walls, so that the person can be anywhere.
fn is_seen(corners: &[[f64; 2]], from: Option<Vector>, to: Vector) -> bool {
    let mut watched = Watched::default();
    watched.observe(&with_person(vec![polygon(corners)], from));
    let after = with_person(Vec::new(), Some(to));
    watched.observe(&after);
    watched.agents_through_walls(&after) == 1
}

#[test]
fn a_path_through_a_thin_wall_is_seen_and_one_around_it_is_not() {
    let wall = [[0.0, -5.0], [0.01, -5.0], [0.01, 5.0], [0.0, 5.0]];
    for (from, to, seen) in [
        ([-1.0, 0.0], [1.0, 0.1], true),
        ([1.0, 0.0], [-1.0, 0.1], true),
        ([-1e-6, 0.0], [0.005, 0.0], true),
        ([-1.0, 5.1], [1.0, 5.1], false),
        ([-1e-6, 0.0], [-1e-6, 3.0], false),
        ([-90.0, 0.0], [-80.0, 0.0], false),
    ] {
        let found = is_seen(&wall, Some(from.into()), to.into());
        assert_eq!(found, seen, "{from:?} {to:?}");
    }
}

#[test]
fn a_path_into_the_corner_between_two_edges_is_seen() {
    let corner = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    for k in 1..100 {
        let from = vector(-0.01 * f64::from(k), -0.3);
        assert!(is_seen(&corner, Some(from), -from), "{from:?}");
    }
}

#[test]
fn inside_is_what_the_polygon_says_wherever_it_is_not_the_rim() {
    let horseshoe = [
        [0.0, 0.0],
        [9.0, 0.0],
        [9.0, 9.0],
        [6.0, 9.0],
        [6.0, 3.0],
        [3.0, 3.0],
        [3.0, 9.0],
        [0.0, 9.0],
    ];
    let solid = polygon(&horseshoe);
    for k in 0..400 {
        let p = vector(f64::from(k % 20), f64::from(k / 20)) * 0.53 - vector(0.3, 0.7);
        assert_eq!(is_seen(&horseshoe, None, p), solid.contains(p), "{p:?}");
    }
    assert!(!is_seen(&horseshoe, None, vector(0.0, 4.0)));
}

#[test]
fn agents_in_walls_are_named_at_most_ten_of_them() {
    let mut scene = scene(Vec::new(), blend("sph"));
    let at = |k: u32| vector(f64::from(k), 0.0);
    scene.agents = (0..14).map(|k| person(at(k), at(k))).collect();
    let crowd = Simulation::new(scene).unwrap();
    // The observer keeps the walls of the first simulation, in which nobody is.
    let named = |right: f64| {
        let wall = polygon(&[[2.5, -1.0], [right, -1.0], [right, 1.0], [2.5, 1.0]]);
        let mut watched = Watched::default();
        watched.observe(&with_person(vec![wall], None));
        watched.observe(&crowd);
        let data = Integrity {}.data(&watched);
        let ids = data.map(|(_, ids)| Vec::<u32>::deserialize(ids).unwrap());
        (watched.agents_through_walls(&crowd), ids)
    };
    assert_eq!(named(2.6), (0, None));
    assert_eq!(named(4.5), (2, Some(vec![3, 4])));
    assert_eq!(named(13.5), (11, Some((3..13).collect())));
}

#[test]
fn a_person_between_walls_whose_corners_are_at_the_same_height_is_not_inside() {
    // The observer computed the ends of edges anew: by rounding, a ray to the right passed between two of them.
    let y = 12.493022060221938;
    let room = json!([
        [0, 0],
        [17.2, 0],
        [17.2, y],
        [12.2, y],
        [12.2, 3.5],
        [5.3, 3.5],
        [5.3, y],
        [0, y]
    ]);
    let summary = measured(json!({
        "walkable_area": [[room]], "duration_secs": 4, "seed": 207,
        "entrances": [{"line": [[4.123497529578993, y], [3.019413915502604, y]], "per_sec": 1, "goal": [3, 6]}],
        "measurements": [{"integrity": {}}],
    }));
    assert!(summary.agents > 2);
    assert_eq!(summary.metric("agents_through_walls"), Some(0.0));
}

#[test]
fn walks_of_people_at_a_steady_speed_give_their_density_speed_and_flow() {
    // Five people 3 m apart cross a region of 10 m × 2 m at 1.4 m/s: each is there for 10 / 1.4 s.
    let agents = (0..5).map(|k| {
        let x = -3.0 * f64::from(k) - 1.0;
        json!({"position": [x, 0], "velocity": [1.4, 0], "goal": [100, 0]})
    });
    let summary = measured(json!({
        "duration_secs": 20, "profile": "sph", "agents": agents.collect::<Vec<_>>(),
        "measurements": [{"walks": {"region": [[0, -1], [10, 1]], "until_secs": 18}}, {"walks": {"name": "all"}}],
    }));
    let metric = |name: &str| summary.metric(name).unwrap();
    assert_eq!(metric("walks_agents"), 5.0);
    let near = |name: &str, expected: f64| {
        let found = metric(name);
        assert!(
            (found / expected - 1.0).abs() < 0.005,
            "{name}: {found}, expected {expected}"
        );
    };
    near("walks_speed_m_per_s", 1.4);
    near("walks_density_per_m2", 5.0 * (10.0 / 1.4) / (18.0 * 20.0));
    near("walks_flow_per_m_per_s", 5.0 * 10.0 / (18.0 * 20.0));
    assert_eq!(summary.metric("all_density_per_m2"), None);
    let walks: Vec<Walk> = summary.data("all").unwrap();
    assert!(walks.iter().all(|walk| (walk.secs - 20.0).abs() < 1e-9));
    assert!(walks.iter().all(|walk| (walk.meters - 28.0).abs() < 0.1));
}

#[test]
fn people_at_a_steady_speed_have_the_flow_density_and_speed_of_their_distances() {
    // 41 people 3 m apart walk 1.4 m/s through a region 12 m × 2 m and leave at its end, where a second line is.
    let agents = (0..41).map(|k| {
        json!({"position": [-3.0 * f64::from(k), 0], "velocity": [1.4, 0], "goal": [12.3, 0],
                                        "remove_within": 0.3})
    });
    let summary = measured(json!({
        "duration_secs": 110, "profile": "sph", "agents": agents.collect::<Vec<_>>(), "stop": {"when_empty": true},
        "measurements": [{"line_flow": {"line": [[6, 1], [6, -1]], "region": [[0, -1], [12, 1]]}},
                         {"line_flow": {"name": "end", "line": [[11.99, 1], [11.99, -1]], "part": [0, 1]}},
                         {"line_flow": {"name": "beside", "line": [[6, 1], [6, 3]]}}],
    }));
    let metric = |name: &str| summary.metric(name).unwrap();
    for (name, expected) in [
        ("line_flow_per_s", 1.4 / 3.0),
        ("end_flow_per_s", 1.4 / 3.0),
        ("line_density_per_m2", 4.0 / 24.0),
        ("line_speed_m_per_s", 1.4),
        ("line_passages", 41.0),
        ("end_passages", 41.0),
    ] {
        let found = metric(name);
        let off = (found / expected - 1.0).abs();
        assert!(off < 0.02, "{name}: {found}, expected {expected}");
    }
    assert_eq!(metric("beside_passages"), 0.0);
    assert_eq!(summary.metric("beside_flow_per_s"), None);
    let times: Vec<f64> = summary.data("end").unwrap();
    for (k, time) in times.iter().enumerate() {
        let expected = (11.99 + 3.0 * k as f64) / 1.4;
        assert!(
            (time - expected).abs() < 0.03,
            "{time}, expected {expected}"
        );
    }
}

#[test]
fn a_walk_starts_after_the_time_before_it_and_not_with_a_shove() {
    let summary = measured(json!({
        "duration_secs": 12, "profile": "sph",
        "agents": [{"position": [0, 0], "goal": [100, 0], "premovement_secs": 6, "radius": 0.25},
                   {"position": [-4, 0.3], "velocity": [1.4, 0], "goal": [100, 0.3], "radius": 0.25}],
        "measurements": [{"walks": {}}],
    }));
    let walks: Vec<Walk> = summary.data("walks").unwrap();
    assert_eq!(walks[1].started_secs, Some(0.0));
    let off = walks[0].started_secs.unwrap() - 6.0;
    assert!((0.0..0.5).contains(&off), "{off}");
    let shoved = summary.metric("walks_start_delay_secs").unwrap();
    assert!((shoved - off).abs() < 1e-12);
}

/// The keys of all measurements, from the schema.
fn all_measurements() -> Vec<String> {
    let schema = sandbox::scenario::schema();
    let routes = schema["$defs"]["Measurement"]["oneOf"].as_array().unwrap();
    let keys = routes
        .iter()
        .map(|way| way["required"][0].as_str().unwrap().to_owned());
    keys.collect()
}

#[test]
fn one_page_defines_every_measurement() {
    let page = include_str!("../docs/reference/measurements.md");
    let table = page.split("## All measurements").nth(1).unwrap();
    let first_cells: String = table
        .lines()
        .filter_map(|line| line.split('|').nth(1))
        .collect();
    let measurements = all_measurements();
    assert!(measurements.len() >= 25, "{measurements:?}");
    for key in measurements {
        assert!(first_cells.contains(&format!("`{key}`")), "{key}");
    }
}

#[test]
fn densities_count_the_walkable_part_of_a_region() {
    let densities = |region: Value| {
        let summary = measured(json!({
            "walkable_area": [[[[0, 0], [12, 0], [12, 2], [0, 2]]]], "goal": [11, 1], "duration_secs": 8,
            "crowds": [{"area": [[0, 0], [4, 0], [4, 2], [0, 2]], "number": 12}],
            "measurements": [{"walks": {"name": "walks", "region": region}},
                             {"line_flow": {"name": "line", "line": [[7, 0], [7, 2]], "region": region}}],
        }));
        ["walks_density_per_m2", "line_density_per_m2"].map(|name| summary.metric(name).unwrap())
    };
    let inside = densities(json!([[4, 0], [7, 2]]));
    let across_the_walls = densities(json!([[4, -1], [7, 4]]));
    for (inside, across) in inside.into_iter().zip(across_the_walls) {
        assert!(
            inside > 0.1 && (inside - across).abs() < 1e-12 * inside,
            "{inside} {across}"
        );
    }
}

#[test]
fn a_gap_of_exactly_the_limit_is_a_pause_whatever_its_rounding() {
    // Gaps of 3.0, 3.5 and 4.0 s after different times: as differences of floats, some are below their limit.
    for limit in [3.0, 3.5, 4.0] {
        for delay in 0..25 {
            let start = f64::from(delay) * 0.1;
            let walk = |(k, from): (usize, f64)| {
                let y = 9.0 * k as f64;
                json!({"position": [0, y], "goal": [1, y], "remove_within": 0.5, "premovement_secs": from})
            };
            let starts = [start, start + limit].into_iter().enumerate();
            let document = json!({
                "profile": "sf", "duration_secs": 12, "agents": starts.map(walk).collect::<Vec<_>>(),
                "measurements": [{"pauses": {"arrivals": 2, "longer_than_secs": limit}}],
            });
            let scenario = Scenario::parse(&document.to_string(), "f.json", &[]).unwrap();
            let mut run = Run::new(scenario).unwrap();
            run.drive::<Fault, dyn Observer<Fault>>(&mut [], || false)
                .unwrap();
            let arrived = run.simulation.outcome().arrivals.iter();
            let frames: Vec<i64> = arrived
                .map(|one| (one.time / 0.02).round() as i64)
                .collect();
            let gap = frames[1] - frames[0];
            let is_pause = gap >= (limit * 50.0).round() as i64;
            let expected = if is_pause { gap as f64 * 0.02 } else { 0.0 };
            let found = Summary::of(&run).metric("pauses_secs").unwrap();
            assert!(
                (found - expected).abs() < 1e-9,
                "{limit} s after {start} s: {found}, {frames:?}"
            );
        }
    }
}

#[test]
fn the_floor_behind_an_exit_is_no_part_of_a_region() {
    let measure = |region: Value| {
        let flow = json!({"line": [[4, 0], [4, 4]], "region": region, "part": [0, 1], "name": "l"});
        json!([{"walks": {"region": region, "until_secs": 2}}, {"line_flow": flow}])
    };
    let summary = |region: Value| {
        measured(json!({
            "duration_secs": 6, "profile": "sph", "walkable_area": [[[[0, 0], [6, 0], [6, 4], [0, 4]]]],
            "exits": [{"name": "door", "line": [[6, 1], [6, 3]]}],
            "agents": [{"position": [0.5, 2]}, {"position": [1, 1]}],
            "measurements": measure(region),
        }))
    };
    let inside = summary(json!([[0, 0], [6, 4]]));
    let beyond = summary(json!([[-3, -3], [15, 7]]));
    for name in [
        "walks_density_per_m2",
        "walks_flow_per_m_per_s",
        "l_density_per_m2",
        "l_speed_m_per_s",
    ] {
        let [a, b] = [&inside, &beyond].map(|one| one.metric(name).unwrap());
        assert!((a - b).abs() < 1e-9 * a, "{name}: {a}, {b}");
    }
    // Two people on 24 m² for two seconds.
    let density = beyond.metric("walks_density_per_m2").unwrap();
    assert!((density - 2.0 / 24.0).abs() < 1e-9, "{density}");
}

#[test]
fn a_person_who_walks_around_the_end_of_a_line_passes_it_once_and_around_a_ring_each_time() {
    let passages = |obstacles: Value, line: Value| {
        let summary = measured(json!({
            "duration_secs": 90, "profile": "sph", "walkable_area": [[[[0, 0], [16, 0], [16, 8], [0, 8]]]],
            "obstacles": obstacles, "exits": [{"name": "door", "line": [[16, 1], [16, 3]]}],
            "waypoints": [{"name": "a", "at": [2, 2], "within": 0.3}, {"name": "b", "at": [12, 2], "within": 0.3},
                          {"name": "c", "at": [12, 7], "within": 0.3}, {"name": "d", "at": [2, 7], "within": 0.3}],
            "journeys": [{"name": "j", "stages": ["a", "b", "c", "d", "a", "b", "c", "d", "a", "b", "door"]}],
            "agents": [{"position": [1, 2], "journey": "j"}],
            "measurements": [{"line_flow": {"line": line}}],
            "stop": {"when_empty": true},
        }));
        assert_eq!(summary.arrived, 1);
        summary.metric("line_passages").unwrap()
    };
    for line in [
        json!([[7, 0], [7, 4]]),
        json!([[7, 4], [7, 0]]),
        json!([[7, 1], [7, 3]]),
    ] {
        assert_eq!(passages(json!([]), line), 1.0);
    }
    // Around a block in the middle of the room.
    let block = json!([[[4, 3.5], [10, 3.5], [10, 5], [4, 5]]]);
    for line in [json!([[7, 0], [7, 3.5]]), json!([[7, 1], [7, 3]])] {
        assert_eq!(passages(block.clone(), line), 3.0);
    }
}
