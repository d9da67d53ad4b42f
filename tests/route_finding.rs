//! Crowds that find their routes around walls.

use sandbox::engine::math::Vector;
use sandbox::engine::routes::{Destination, Route, SLACK, Walker};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

use crate::common::simulated::{after, go_on, scenario};

/// A corridor of 2 m that turns by 90° twice and leads back, and a group of agents at its start.
fn around_the_corner(agents: u32) -> Value {
    json!({
        "duration_secs": 60, "profile": "sph",
        "walkable_area": [[[[0, 0], [12, 0], [12, 10], [0, 10], [0, 8], [10, 8], [10, 2], [0, 2]]]],
        "grids": [{"name": "crowd", "min": [0.3, 0.3], "max": [6, 1.7], "columns": agents / 2, "rows": 2,
                   "goal": [6, 9], "remove_within": 0.8}],
        "stop": {"when_empty": true}
    })
}

#[test]
fn a_crowd_walks_around_a_corner() {
    let paths = after(&around_the_corner(20), &[], 40.0);
    assert_eq!(paths.outcome().arrivals.len(), 20);
    assert_eq!(paths.outcome().displaced.len(), 0);
    let straight = after(&around_the_corner(20), &["navigation=straight"], 40.0);
    assert_eq!(straight.outcome().arrivals.len(), 0);
}

#[test]
fn all_avoidance_models_find_the_way() {
    for profile in ["sf", "rvo", "rvo->sph"] {
        let setting = format!("profile={profile}");
        let simulation = after(&around_the_corner(6), &[&setting], 40.0);
        assert_eq!(simulation.outcome().arrivals.len(), 6, "{profile}");
    }
}

#[test]
fn without_walls_between_paths_change_no_bit() {
    let open = json!({
        "obstacles": [[[-1, -1], [20, -1], [20, 0], [-1, 0]]],
        "grids": [{"min": [0, 1], "max": [5, 6], "columns": 5, "rows": 5, "jitter": 0.1, "goal": [30, 4]}]
    });
    let [paths, straight] = ["paths", "straight"].map(|way| {
        let setting = format!("navigation={way}");
        after(&open, &[&setting], 4.0).digest()
    });
    assert_eq!(paths, straight);
}

#[test]
fn where_no_wall_can_come_between_no_way_is_looked_up() {
    let room = json!({
        "walkable_area": [[[[0, 0], [20, 0], [20, 10], [0, 10]]]],
        "grids": [{"min": [1, 1], "max": [5, 6], "columns": 5, "rows": 5, "goal": [18, 4]}]
    });
    let scene = scenario(&room, &[]).unwrap().scene;
    assert!(!scene.walls.is_empty() && scene.routes.is_none());
    let mut with_pillar = room;
    with_pillar["obstacles"] = json!([[[10, 4], [11, 4], [11, 5], [10, 5]]]);
    assert!(scenario(&with_pillar, &[]).unwrap().scene.routes.is_some());
}

/// Between two searches an agent keeps its corner as long as it sees it. It may take a way that is longer than the
/// shortest by `SLACK`, and by 1.6 m more while it is pushed straight back by 0.8 m.
#[test]
fn agents_see_what_they_walk_to_and_take_nearly_the_shortest_way_wherever_they_are_pushed() {
    use rand::{Rng, SeedableRng};
    let doors = [[2.0, 2.0], [6.0, 4.0], [2.0, 6.0]];
    let walls = doors.map(|[x, y]| {
        let left = [[0.0, y], [x, y], [x, y + 0.2], [0.0, y + 0.2]];
        let right = [[x + 1.0, y], [9.0, y], [9.0, y + 0.2], [x + 1.0, y + 0.2]];
        [left, right]
    });
    let pillar = [[4.0, 4.8], [4.4, 4.8], [4.4, 5.2], [4.0, 5.2]];
    let obstacles: Vec<_> = walls.into_iter().flatten().chain([pillar]).collect();
    let document = json!({
        "walkable_area": [[[[0, 0], [10, 0], [10, 8], [0, 8]]]], "obstacles": obstacles,
        "agents": [{"position": [8, 7.5], "goal": [0.5, 0.5]}]
    });
    let routes = scenario(&document, &[]).unwrap().scene.routes.unwrap();
    let goal = Vector::new(0.5, 0.5);
    let is_free = |p: Vector, to: Vector| {
        let inside = (1..100).map(|k| p + (to - p) * (f64::from(k) / 100.0));
        inside.into_iter().all(|q| routes.floor.locate(q).is_some())
    };
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(5);
    let (mut p, mut held, mut aim) = (Vector::new(8.0, 7.5), None::<Route>, goal);
    let (mut kept, mut steps) = (0, 0);
    while steps < 20_000 {
        // Mostly a step on the way, sometimes a push anywhere.
        let push: f64 = [0.1, 0.1, 0.1, 0.6, 3.0][random.random_range(0..5)];
        let turn: f64 = random.random_range(0.0..std::f64::consts::TAU);
        let ahead = (aim - p).normalize() * 0.1;
        let next = p + ahead + push * random.random::<f64>() * Vector::new(turn.cos(), turn.sin());
        if routes.floor.locate(next).is_none() || (next - goal).norm() < 0.2 {
            continue;
        }
        (p, steps) = (next, steps + 1);
        if held.is_some_and(|route| route.holds(p)) {
            kept += 1;
        } else {
            let walker = Walker {
                id: 0,
                position: p,
                to: Destination::Goal(goal),
                radius: 0.2,
                detour: None,
            };
            aim = routes.aim(&walker, &mut held, 1);
        }
        let route = held.unwrap();
        assert!(
            is_free(p, routes.next(&route)),
            "{p} cannot see {}",
            routes.next(&route)
        );
        let mut course = routes.course_of(&route);
        course.insert(0, p);
        let length: f64 = course
            .windows(2)
            .map(|ends| (ends[1] - ends[0]).norm())
            .sum();
        let shortest = routes.way(p, Destination::Goal(goal)).unwrap().length;
        assert!(
            length < shortest + SLACK + 1.6,
            "{p}: {length}, not {shortest}"
        );
    }
    assert!(kept > steps / 10, "{kept}");
}

#[test]
fn a_resumed_crowd_goes_on_to_the_same_bits_between_two_choices_of_routes() {
    let document = around_the_corner(20);
    let scene = scenario(&document, &[]).unwrap().scene;
    let mut simulation = Simulation::new(scene.clone()).unwrap();
    // 3.46 s is not a coarse frame.
    go_on(&mut simulation, 3.46);
    assert!(!simulation.frame().clock.is_coarse());
    simulation.evaluate().unwrap();
    let mut resumed = Simulation::resumed(scene, simulation.state()).unwrap();
    for simulation in [&mut simulation, &mut resumed] {
        go_on(simulation, 9.0);
    }
    assert_eq!(simulation.digest(), resumed.digest());
}

#[test]
fn an_agent_pushed_into_another_room_takes_the_new_shortest_way() {
    // Two doors lead from the left rooms to the right one.
    let rooms = json!({
        "walkable_area": [[
            [[0, 0], [20, 0], [20, 10], [0, 10]],
            [[0, 4.9], [10, 4.9], [10, 5.1], [0, 5.1]],
            [[10, 1], [10.2, 1], [10.2, 9], [10, 9]]
        ]],
        "agents": [{"position": [2, 4], "goal": [18, 5]}]
    });
    let scenario = scenario(&rooms, &[]).unwrap();
    let routes = scenario.scene.routes.as_ref().unwrap();
    let goal = Destination::Goal([18.0, 5.0].into());
    let length = |y: f64| routes.way([2.0, y].into(), goal).unwrap().length;
    assert!(
        (length(4.0) - length(6.0)).abs() < 1e-9,
        "both rooms have a door"
    );
    assert!(length(4.0) > 16.0);
}

#[test]
fn goals_that_cannot_be_reached_are_refused_with_their_place() {
    let refused = |change: &dyn Fn(&mut Value)| {
        let mut document = around_the_corner(4);
        change(&mut document);
        scenario(&document, &[]).unwrap_err()
    };
    let in_wall = refused(&|document| document["grids"][0]["goal"] = json!([5, 5]));
    assert!(
        in_wall.contains("(5, 5), the goal of crowd, lies in an obstacle"),
        "{in_wall}"
    );
    let closed = refused(&|document| {
        document["obstacles"] = json!([[[8, -1], [8.5, -1], [8.5, 3], [8, 3]]]);
    });
    assert!(closed.contains("agents of crowd start"), "{closed}");
    assert!(closed.contains("walls close it off"), "{closed}");
    let narrow = refused(&|document| {
        document["obstacles"] = json!([[[8, -1], [8.5, -1], [8.5, 1.64], [8, 1.64]]]);
    });
    assert!(
        narrow.contains("narrower than 0.53 m, too narrow for"),
        "{narrow}"
    );
    let mut document = around_the_corner(4);
    document["obstacles"] = json!([[[8, -1], [8.5, -1], [8.5, 1.64], [8, 1.64]]]);
    assert!(scenario(&document, &["min_passage_width=0.2"]).is_ok());
    assert!(scenario(&document, &["navigation=straight"]).is_ok());
}

#[test]
fn errors_about_goals_name_the_key_that_gives_the_goal_and_the_agents() {
    let base = json!({
        "walkable_area": [[[[0, 0], [10, 0], [10, 10], [0, 10]]]],
        "agents": [{"position": [2, 5], "goal": [5, 5]}, {"position": [2, 6], "goal": [5, 5]}],
        "grids": [{"min": [3, 1], "max": [4, 2], "columns": 2, "rows": 2, "goal": [5, 5]}],
        "crowds": [{"name": "all", "area": [[6, 1], [9, 1], [9, 4]], "number": 2, "goal": [5, 5]}],
        "sources": [{"min": [1, 8], "max": [2, 9], "columns": 2, "rows": 1, "every_secs": 1, "times": 1,
                     "goal": [5, 5]}],
        "entrances": [{"line": [[4, 8], [5, 8]], "at_secs": [1], "goal": [5, 5]}],
    });
    let error = |change: &dyn Fn(&mut Value)| {
        let mut document = base.clone();
        change(&mut document);
        Scenario::parse(&document.to_string(), "f.json", &[])
            .unwrap_err()
            .to_string()
    };
    for (list, k, name) in [
        ("agents", 1, "agents[1]"),
        ("grids", 0, "grids[0]"),
        ("crowds", 0, "all"),
        ("sources", 0, "sources[0]"),
        ("entrances", 0, "entrances[0]"),
    ] {
        // Two agents with one goal in a wall, or alone behind it.
        let outside = error(&|document| document[list][k]["goal"] = json!([55, 5]));
        let said =
            format!("f.json: {list}[{k}].goal: (55, 5), the goal of {name}, lies in an obstacle");
        assert!(outside.starts_with(&said), "{outside}");
        let top = error(&|document| {
            document[list][k]["goal"] = Value::Null;
            document["goal"] = json!([55, 5]);
        });
        let said = format!("f.json: goal: (55, 5), the goal of {name}, lies in an obstacle");
        assert!(top.starts_with(&said), "{top}");
        let closed = error(&|document| {
            let room = |x: i32| json!([[[x, 0], [x + 10, 0], [x + 10, 10], [x, 10]]]);
            document["walkable_area"] = json!([room(0), room(20)]);
            document[list][k]["goal"] = json!([25, 5]);
        });
        let who = if list == "agents" {
            format!("{name} starts")
        } else {
            format!("agents of {name} start")
        };
        let said = format!("f.json: {list}[{k}].goal: no way leads from (");
        assert!(
            closed.starts_with(&said) && closed.contains(&who),
            "{closed}"
        );
    }
    let offset = error(&|document| {
        document["grids"][0]["goal"] = Value::Null;
        document["grids"][0]["goal_offset"] = json!([50, 0]);
    });
    assert!(
        offset.starts_with("f.json: grids[0].goal_offset: ("),
        "{offset}"
    );
}

#[test]
fn routes_lead_over_rotated_plans_whose_holes_touch() {
    use rand::{Rng, SeedableRng};
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    for _ in 0..300 {
        let turn: f64 = random.random_range(0.0..1.5);
        let (sine, cosine) = turn.sin_cos();
        let place = |x: i32, y: i32| {
            let [x, y] = [x, y].map(|c| 1.5 * f64::from(c));
            [cosine * x - sine * y, sine * x + cosine * y]
        };
        let ring = |corners: [[i32; 2]; 4]| corners.map(|[x, y]| place(x, y));
        let mut rings = vec![ring([[0, 0], [6, 0], [6, 6], [0, 6]])];
        for (x, y) in (0..6).flat_map(|x| (1..5).map(move |y| (x, y))) {
            if random.random_range(0..3) == 0 {
                rings.push(ring([[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]]));
            }
        }
        let middle = |x: f64, y: f64| [cosine * x - sine * y, sine * x + cosine * y];
        let document = json!({
            "walkable_area": [rings],
            "agents": [{"position": middle(0.7, 0.7), "goal": middle(8.3, 8.3)}],
        });
        match scenario(&document, &[]) {
            Ok(_) => {}
            // A row of holes from wall to wall.
            Err(error) => assert!(error.contains("walls close it off"), "{error}"),
        }
    }
}

#[test]
fn exits_that_no_agent_walks_to_are_refused() {
    let document = json!({
        "goal": [5, 5],
        "exits": [{"name": "east", "line": [[10, 4], [10, 6]]}],
        "agents": [{"position": [0, 0]}],
    });
    let error = scenario(&document, &[]).unwrap_err();
    assert!(
        error.contains("exits: no agent walks to an exit"),
        "{error}"
    );
}
