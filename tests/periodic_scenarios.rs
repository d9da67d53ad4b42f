//! Periodic scenes from scenario files: walls, crowds, measurements and errors.

use crate::common::ring::{corridor, parsed};
use crate::common::simulated::measured;
use crate::common::vector;
use sandbox::runs::drive::Run;
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

fn message(document: &Value) -> String {
    let error = Scenario::parse(&document.to_string(), "f", &[]).unwrap_err();
    error.to_string()
}

#[test]
fn walls_go_on_without_a_joint() {
    let walls = |document: &Value| parsed(document).scene.walls;
    let area = |x: [f64; 2]| json!([[[[x[0], 0], [x[1], 0], [x[1], 3], [x[0], 3]]]]);
    for x in [[0.0, 20.0], [-1.0, 21.0], [3.0, 23.0]] {
        let document = json!({"periodic": {"axis": "x", "length": 20}, "walkable_area": area(x)});
        assert_eq!(walls(&document).len(), 4, "{x:?}");
    }
    // A wall as long as the period is one body; a pillar has copies.
    let bar = json!([[0, 3], [20, 3], [20, 3.2], [0, 3.2]]);
    let pillar = json!([[5, 1], [6, 1], [6, 2]]);
    let document = json!({"periodic": {"axis": "x", "length": 20}, "obstacles": [bar, pillar]});
    let walls = walls(&document);
    assert_eq!(walls.obstacles()[0].points().len(), 4);
    assert_eq!(walls.obstacles()[1].points().len(), 3);
    for x in [-20.0, 0.0, 20.0] {
        assert_eq!(walls.obstacle_at(vector(19.9, 3.1)), Some(0));
        assert!(walls.obstacle_at(vector(5.5 + x, 1.2)).is_some());
        assert!(walls.obstacle_at(vector(7.0 + x, 1.2)).is_none());
    }
}

#[test]
fn measurements_see_no_jump_and_walls_hold() {
    let mut document = corridor("sph", "x", true);
    document["duration_secs"] = json!(20);
    document["measurements"] =
        json!([{"integrity": {}}, {"walks": {"from_secs": 10, "region": [[0, 0], [11, 3]]}}]);
    document["agents"].as_array_mut().unwrap().truncate(25);
    let mut run = Run::new(parsed(&document)).unwrap();
    while run.simulation.frame().clock.time() < 20.0 {
        run.simulation.evaluate().unwrap();
        run.metrics.observe(&run.simulation);
        run.simulation.integrate().unwrap();
    }
    run.simulation.evaluate().unwrap();
    run.metrics.observe(&run.simulation);
    let results = run.metrics.results(&run.simulation);
    let value = |name: &str| {
        let found = results.iter().find(|metric| metric.name == name);
        found.unwrap().value.unwrap()
    };
    assert_eq!(value("agents_through_walls"), 0.0);
    // The pillar and the body across the end, with its copy, take 0.25 and 0.8 m² of the region.
    let density = 25.0 / (33.0 - 0.25 - 0.8);
    assert!((value("walks_density_per_m2") - density).abs() < 1e-12);
    let speed = value("walks_speed_m_per_s");
    assert!((0.8..1.4).contains(&speed), "{speed}");
    let flow = value("walks_flow_per_m_per_s");
    assert!((flow - speed * density).abs() < 1e-12);
}

#[test]
fn a_flow_across_a_line_counts_every_lap() {
    // One person each way at 1.4 m/s on a ring of 10 m: four laps take 28.6 s. Lines at the ends count as others do.
    for x in [0.0, 4.0, 10.0] {
        let summary = measured(json!({
            "duration_secs": 29, "profile": "sph", "periodic": {"axis": "x", "length": 10}, "navigation": "straight",
            "agents": [
                {"position": [2, 1], "velocity": [1.4, 0], "goal": {"direction": [1, 0]}},
                {"position": [7, 5], "velocity": [-1.4, 0], "goal": {"direction": [-1, 0]}},
            ],
            "measurements": [{"line_flow": {"line": [[x, 6], [x, 0]], "region": [[0, 0], [10, 6]]}}],
        }));
        assert_eq!(summary.metric("line_passages"), Some(8.0), "{x}");
        let speed = summary.metric("line_speed_m_per_s").unwrap();
        assert!((speed - 1.4).abs() < 0.01, "{x}: {speed}");
    }
}

#[test]
fn crowds_do_not_overlap_across_the_ends() {
    for (spacing, density) in [("random", 2.5), ("grid", 3.5)] {
        let document = json!({"periodic": {"axis": "x", "length": 10, "from": 1}, "profile": "sph",
            "crowds": [{"area": [[-5, 0], [20, 0], [20, 3], [-5, 3]], "density": density, "spacing": spacing}],
            "walkable_area": [[[[0, -0.5], [12, -0.5], [12, 3.5], [0, 3.5]]]]});
        let scene = parsed(&document).scene;
        let period = scene.period.unwrap();
        assert_eq!(scene.agents.len(), (30.0 * density) as usize);
        for (k, one) in scene.agents.iter().enumerate() {
            assert!(period.contains(one.position));
            for other in &scene.agents[..k] {
                let offset = period.shortest(one.position - other.position);
                let touching = one.radius.unwrap() + other.radius.unwrap();
                assert!(offset.norm() > touching, "{spacing}");
            }
        }
    }
}

#[test]
fn what_a_periodic_scene_cannot_have_is_refused_by_name() {
    let agent = json!([{"position": [1, 1]}]);
    let area = |corners: Value| json!([[corners]]);
    let line = json!([[5, 0], [5, 3]]);
    for (changes, expected) in [
        (
            json!({"exits": [{"name": "e", "line": line}]}),
            "f: exits: in a periodic scene agents walk",
        ),
        (
            json!({"entrances": [{"line": line, "per_sec": 1}]}),
            "f: entrances: in a periodic scene",
        ),
        (
            json!({"goal": [1, 1]}),
            "f: agents[0].goal: in a periodic scene agents walk in a direction, not to a point",
        ),
        (
            json!({"goal": {"direction": [0, 0]}}),
            "f: agents[0].goal.direction: must not be [0, 0]",
        ),
        (json!({"goal": {"way": [0, 0]}}), "f: goal"),
        (
            json!({"agents": [{"position": [1, 1], "remove_within": 1}]}),
            "f: agents[0].remove_within: agents that walk in a direction reach no goal",
        ),
        (
            json!({"grids": [{"min": [0, 0], "max": [1, 1], "columns": 1, "rows": 1, "goal_offset": [1, 0]}]}),
            "f: grids[0].goal_offset: in a periodic scene",
        ),
        (
            json!({"profile": "sf", "periodic": {"axis": "x", "length": 9}}),
            "f: periodic.length: must be at least 10 m, not 9",
        ),
        (
            json!({"periodic": {"axis": "x", "length": 1.9}}),
            "f: periodic.length: must be at least 2 m, not 1.9",
        ),
        (
            json!({"zones": [{"name": "mat", "area": [[18, 0], [22, 0], [22, 3], [18, 3]], "speed_factor": 0.5}]}),
            "f: zones: `mat`: area: reaches out of the period from 0 to 20 m",
        ),
        (
            json!({"measurements": [{"line_flow": {"line": [[25, 0], [25, 3]]}}]}),
            "f: measurements[0].line_flow.line: reaches out of the period from 0 to 20 m",
        ),
        (
            json!({"periodic": {"axis": "x", "length": 5e-324}, "obstacles": [[[1, 1], [2, 1], [2, 2]]]}),
            "f: obstacles[0]: reaches over more than 1000 periods; lengthen `periodic.length`",
        ),
        (
            json!({"periodic": {"axis": "x", "length": 0.01},
                   "walkable_area": area(json!([[0, 0], [20, 0], [20, 3], [0, 3]]))}),
            "f: walkable_area[0]: reaches over more than 1000 periods; lengthen `periodic.length`",
        ),
        (
            json!({"periodic": {"axis": "z", "length": 9}}),
            "f: periodic.axis: unknown value `z`",
        ),
        (
            json!({"walkable_area": area(json!([[0, 0], [20, 0], [20, 2], [10, 3], [0, 3]]))}),
            "f: walkable_area: the two ends of the period do not fit together: at x = 20 a wall remains from",
        ),
        (
            json!({"walkable_area": area(json!([[0, 0], [19, 0], [19, 3], [0, 3]]))}),
            "f: walkable_area: ",
        ),
        (
            json!({"walkable_area": area(json!([[1, 0], [19, 0], [19, 3], [1, 3]]))}),
            "f: walkable_area: there is no floor at x = 20, where the period ends",
        ),
        (
            json!({"measurements": [{"walks": {"region": [[15, 0], [25, 1]]}}]}),
            "f: measurements[0].walks.region: reaches out of the period from 0 to 20 m",
        ),
    ] {
        let mut document = json!({"periodic": {"axis": "x", "length": 20}, "agents": agent});
        for (key, value) in changes.as_object().unwrap() {
            document[key] = value.clone();
        }
        let message = message(&document);
        assert!(message.starts_with(expected), "{message}\n{expected}");
    }
}
