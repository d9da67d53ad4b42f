//! Journeys: exits, waypoints, waiting areas, queues, choices and zones.

use rayon::ThreadPoolBuilder;
use sandbox::engine::journeys::Status;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::Scenario;
use sandbox::scenario::measurements::Left;
use serde_json::{Value, json};

use crate::common::simulated::{after, go_on, scenario, start};

/// A room of 20 × 10 m with exits `east` and `west` in its short walls, and 40 agents in the middle.
fn room() -> Value {
    json!({
        "walkable_area": [[[[0, 0], [20, 0], [20, 10], [0, 10]]]],
        "exits": [{"name": "east", "line": [[20, 4], [20, 6]]}, {"name": "west", "line": [[0, 4], [0, 6]]}],
        "grids": [{"min": [6, 2], "max": [14, 8], "columns": 8, "rows": 5}],
    })
}

fn with(change: impl Fn(&mut Value)) -> Value {
    let mut document = room();
    change(&mut document);
    document
}

/// The number of agents that have passed each place.
fn passed(simulation: &Simulation) -> Vec<u32> {
    let places = simulation.progress().places.iter();
    places.map(|place| place.passed).collect()
}

fn statuses(simulation: &Simulation) -> Vec<Status> {
    let trips = simulation.frame().agents.trip.iter().flatten();
    trips.map(|trip| trip.status).collect()
}

#[test]
fn agents_leave_at_the_nearest_exit_on_the_edge_of_the_walkable_area() {
    let simulation = after(&room(), &[], 20.0);
    assert_eq!(passed(&simulation), [20, 20]);
    for arrival in &simulation.outcome().arrivals {
        let exit = arrival.trip.unwrap().exit;
        let beyond = arrival.position.x - [20.0, 0.0][usize::from(exit)];
        assert!(beyond.abs() < 0.04, "{arrival:?} leaves on the line");
        assert!((4.0..6.0).contains(&arrival.position.y), "{arrival:?}");
    }
    let left = Left::of(&simulation, None);
    assert_eq!((left.started, left.finished), (40, 40));
    assert!(left.t50_secs < left.t95_secs && left.t95_secs <= left.t100_secs);
    assert_eq!(simulation.outcome().contained.count, 0);
}

#[test]
fn after_an_exit_closes_all_take_the_other_one() {
    let document = with(|room| room["events"] = json!([{"at_secs": 1, "close": "west"}]));
    let simulation = after(&document, &[], 30.0);
    assert_eq!(passed(&simulation), [40, 0]);
}

#[test]
fn nobody_passes_a_closed_exit_until_it_opens() {
    let closed = with(|room| {
        room["exits"][1]["closed_secs"] = json!([[0, 15]]);
        room["exits"][0]["closed_secs"] = json!([[0, 15]]);
    });
    let mut simulation = after(&closed, &[], 15.0);
    assert_eq!(passed(&simulation), [0, 0]);
    let inside = |x: f64| (0.0..=20.0).contains(&x);
    let positions = &simulation.frame().agents.position;
    assert!(positions.iter().all(|p| inside(p.x)), "{positions:?}");
    go_on(&mut simulation, 40.0);
    assert_eq!(passed(&simulation).iter().sum::<u32>(), 40);
}

#[test]
fn people_who_meet_on_the_line_of_an_exit_in_the_open_do_not_block_each_other() {
    let hall = json!({
        "walkable_area": [[[[0, 0], [25, 0], [25, 8], [0, 8]]]],
        "exits": [{"name": "e", "line": [[20, 3], [20, 5]]}],
        "crowds": [{"area": [[2, 1], [16, 1], [16, 7], [2, 7]], "number": 80}],
    });
    for profile in ["profile=sph", "profile=sf"] {
        let simulation = after(&hall, &[profile], 60.0);
        assert_eq!(passed(&simulation), [80], "{profile}");
    }
}

#[test]
fn an_exit_lets_at_most_the_given_flow_through() {
    let document = with(|room| {
        room["exits"] = json!([{"name": "east", "line": [[20, 4], [20, 6]], "most_per_sec": 2}]);
    });
    let simulation = after(&document, &[], 40.0);
    let times: Vec<f64> = simulation
        .outcome()
        .arrivals
        .iter()
        .map(|a| a.time)
        .collect();
    assert_eq!(times.len(), 40);
    for pair in times.windows(11) {
        // Ten gaps of half a second, and the length of a frame.
        assert!(pair[10] - pair[0] > 5.0 - 0.021, "{times:?}");
    }
}

#[test]
fn agents_wait_until_the_given_time_or_their_release() {
    let waiting = |keys: Value, events: Value| {
        with(|room| {
            let mut area = json!({"name": "hall", "area": [[5, 1], [15, 1], [15, 9], [5, 9]]});
            let added = keys.as_object().unwrap().clone();
            area.as_object_mut().unwrap().extend(added);
            room["waiting_areas"] = json!([area]);
            room["journeys"] =
                json!([{"name": "wait", "stages": ["hall", {"nearest": ["east", "west"]}]}]);
            room["grids"][0]["journey"] = json!("wait");
            room["events"] = events.clone();
        })
    };
    let endless = scenario(&waiting(json!({}), json!([])), &[]).unwrap_err();
    assert!(endless.contains("wait forever in `hall`"), "{endless}");
    for document in [
        waiting(json!({"until_secs": 10}), json!([])),
        waiting(json!({"for_secs": 10}), json!([])),
        waiting(json!({}), json!([{"at_secs": 10, "release": "hall"}])),
    ] {
        let mut simulation = after(&document, &[], 9.9);
        let waits = |status: &Status| matches!(status, Status::Waiting { .. });
        assert!(statuses(&simulation).iter().all(waits), "{document}");
        let speeds = simulation.frame().agents.velocity.iter().map(|v| v.norm());
        let fastest = speeds.fold(0.0, f64::max);
        assert!(fastest < 0.2, "{fastest} m/s");
        go_on(&mut simulation, 25.0);
        assert_eq!(passed(&simulation), [20, 20, 40]);
        let waited = Left::of(&simulation, None).waited_secs.unwrap();
        assert!((9.0..10.5).contains(&waited), "{waited} s");
    }
}

#[test]
fn shares_and_fewest_split_a_crowd_as_asked() {
    let split = |choice: Value| {
        let document = with(|room| {
            room["journeys"] = json!([{"name": "out", "stages": [choice]}]);
            room["grids"][0]["journey"] = json!("out");
            room["grids"][0]["columns"] = json!(20);
            room["grids"][0]["rows"] = json!(20);
        });
        let mut simulation = start(&document, &[]);
        simulation.evaluate().unwrap();
        let bound = simulation.progress().places.iter().map(|place| place.bound);
        bound.collect::<Vec<u32>>()
    };
    assert_eq!(split(json!({"fewest": ["east", "west"]})), [200, 200]);
    let [east, west] = split(json!({"shares": {"east": 3, "west": 1}}))[..] else {
        panic!("two exits");
    };
    assert_eq!(east + west, 400);
    // Four standard deviations of a binomial distribution are 35.
    assert!(east.abs_diff(300) < 35, "{east} of 400");
}

/// The line of one option lies on the way to the other.
#[test]
fn shares_hold_where_the_way_to_one_place_crosses_the_line_of_another() {
    let document = json!({
        "walkable_area": [[[[0, 0], [40, 0], [40, 10], [0, 10]]]],
        "exits": [{"name": "end", "line": [[40, 0], [40, 10]]}],
        "waypoints": [{"name": "near", "line": [[10, 0], [10, 10]]}, {"name": "far", "line": [[20, 0], [20, 10]]}],
        "journeys": [{"name": "walk", "stages": [{"shares": {"near": 1, "far": 1}}, "end"]}],
        "grids": [{"min": [1, 1], "max": [8, 9], "columns": 6, "rows": 6, "journey": "walk"}],
    });
    let drawn = |simulation: &Simulation| {
        let places = &simulation.progress().places;
        [1, 2].map(|place| places[place].bound)
    };
    let mut simulation = start(&document, &[]);
    simulation.evaluate().unwrap();
    let bound = drawn(&simulation);
    let simulation = after(&document, &[], 60.0);
    let places = &simulation.progress().places;
    assert_eq!([1, 2].map(|place| places[place].passed), bound);
    assert!(bound[0] > 5 && bound[1] > 5, "{bound:?}");
}

#[test]
fn the_quickest_exit_relieves_the_nearest_one() {
    let out = |choice: &str| {
        let document = json!({
            "walkable_area": [[[[0, 0], [20, 0], [20, 10], [0, 10]]]],
            "exits": [{"name": "near", "line": [[12, 0], [13, 0]]}, {"name": "far", "line": [[17, 0], [18, 0]]}],
            "journeys": [{"name": "out", "stages": [{choice: ["near", "far"]}]}],
            "grids": [{"min": [1, 1], "max": [11, 9], "columns": 16, "rows": 13, "journey": "out"}],
        });
        let simulation = after(&document, &[], 60.0);
        (
            passed(&simulation),
            Left::of(&simulation, None).t100_secs.unwrap(),
        )
    };
    let (nearest, quickest) = (out("nearest"), out("quickest"));
    assert_eq!(nearest.0.iter().sum::<u32>(), 208);
    assert_eq!(quickest.0.iter().sum::<u32>(), 208);
    // A crowd before the near exit pushes some people so far aside that the other one is nearer.
    assert!(2 * nearest.0[1] < quickest.0[1], "{nearest:?}");
    assert!(
        quickest.0[1] > 50 && quickest.0[0] > quickest.0[1],
        "{quickest:?}"
    );
    assert!(
        quickest.1 < 0.8 * nearest.1,
        "{quickest:?} against {nearest:?}"
    );
}

#[test]
fn a_zone_slows_down_those_in_it() {
    let corridor = json!({
        "walkable_area": [[[[0, 0], [40, 0], [40, 2], [0, 2]]]], "profile": "sph",
        "exits": [{"name": "end", "line": [[30, 0], [30, 2]]}],
        "zones": [{"area": [[10, 0], [20, 0], [20, 2], [10, 2]], "speed_factor": 0.5}],
        "agents": [{"position": [1, 1], "velocity": [1.4, 0]}],
    });
    let simulation = after(&corridor, &[], 60.0);
    let time = simulation.outcome().arrivals[0].time;
    // It adapts its speed within the relaxation time of 0.5 s: 0.35 m at the higher speed on each side.
    let expected = 19.0 / 1.4 + 10.0 / 0.7 - 0.35 / 0.7 + 0.35 / 1.4;
    assert!(
        (time - expected).abs() < 0.1,
        "{time} s, {expected} s expected"
    );
}

/// All kinds of places.
fn everything() -> Value {
    with(|room| {
        room["waypoints"] = json!([{"name": "gate", "line": [[10, 0], [10, 10]]}, {"name": "kiosk", "at": [15, 3]}]);
        room["queues"] = json!([{"name": "till", "path": [[17, 8], [12, 8]], "service_secs": 1.5, "servers": 2}]);
        room["waiting_areas"] = json!([{"name": "hall", "area": [[1, 1], [7, 1], [7, 9], [1, 9]],
                                        "facing": [0, 5], "for_secs": 4}]);
        room["zones"] =
            json!([{"area": [[8, 0], [12, 0], [12, 10], [8, 10]], "speed_factor": 0.7}]);
        room["exits"][0]["most_per_sec"] = json!(3);
        room["journeys"] = json!([{"name": "visit", "stages": [
            "hall", "gate", {"shares": {"kiosk": 1, "till": 2}}, {"quickest": ["east", "west"]}]}]);
        room["grids"][0]["journey"] = json!("visit");
    })
}

#[test]
fn a_journey_over_all_kinds_of_places_ends_at_an_exit() {
    let mut simulation = after(&everything(), &[], 90.0);
    assert_eq!(simulation.outcome().arrivals.len(), 40);
    let [east, west, gate, kiosk, hall, till] = passed(&simulation)[..] else {
        panic!("six places");
    };
    assert_eq!([east + west, gate, kiosk + till, hall], [40; 4]);
    simulation.evaluate().unwrap();
    let bound = simulation.progress().places.iter().map(|place| place.bound);
    assert_eq!(bound.sum::<u32>(), 0, "no agent is bound for a place");
}

#[test]
fn a_journey_is_the_same_to_the_last_bit_on_any_number_of_threads_and_after_a_checkpoint() {
    let digest = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| after(&everything(), &[], 25.0).digest())
    };
    let whole = digest(1);
    assert_eq!(digest(3), whole);
    let scene = scenario(&everything(), &[]).unwrap().scene;
    for secs in [3.06, 9.0, 17.54] {
        let mut first = after(&everything(), &[], secs);
        first.evaluate().unwrap();
        let mut resumed = Simulation::resumed(scene.clone(), first.state()).unwrap();
        go_on(&mut resumed, 25.0);
        assert_eq!(resumed.digest(), whole, "resumed at {secs} s");
    }
}

#[test]
fn places_and_journeys_that_cannot_work_are_refused_with_place_and_fix() {
    let base = || {
        with(|room| {
            room["journeys"] = json!([{"name": "out", "stages": ["east"]}]);
            room["grids"][0]["journey"] = json!("out");
        })
    };
    let refused = |pointer: &str, put: Value, message: &str| {
        let mut document = base();
        *document.pointer_mut(pointer).unwrap() = put;
        let error = scenario(&document, &[]).unwrap_err();
        assert!(error.contains(message), "{error}");
    };
    refused(
        "/journeys/0/stages/0",
        json!("eest"),
        "journeys[0].stages[0]: there is no place named `eest`; did you mean `east`?",
    );
    refused(
        "/journeys/0/stages/0",
        json!({"nearest": ["east", "east"]}),
        "nearest[1]: `east` is listed twice",
    );
    refused(
        "/journeys/0/stages/0",
        json!({"shares": {"east": 0}}),
        "the weights must have a sum above 0",
    );
    refused(
        "/journeys/0/stages/0",
        json!({"shares": {"east": 2, "west": -1}}),
        "shares.west: must be at least 0 and at most 1e9, not -1",
    );
    refused(
        "/journeys/0/stages/0",
        json!({"nearest": ["east"], "fewest": ["west"]}),
        "give one of `nearest`",
    );
    refused(
        "/journeys/0/stages",
        json!(["east", "west"]),
        "stages[0]: people leave at an exit, so it must be in the last stage",
    );
    refused(
        "/grids/0/journey",
        json!("aut"),
        "there is no journey named `aut`; did you mean `out`?",
    );
    refused(
        "/exits/1/name",
        json!("east"),
        "exits[1].name: there are two places named `east`",
    );
    refused(
        "/exits/0/line",
        json!([[20, 4], [20, 4.1]]),
        "no person fits through",
    );
    refused(
        "/exits/0/line",
        json!([[40, 4], [40, 6]]),
        "`east` lies in an obstacle or outside of the walkable area",
    );
    refused(
        "/exits/0",
        json!({"name": "east", "line": [[20, 4], [20, 6]], "closed_secs": [[9, 3]]}),
        "exits[0].closed_secs[0]: it ends at 3 s",
    );
    let with_wall = |gap: f64| {
        let mut document = base();
        document["obstacles"] = json!([[[16, 0], [17, 0], [17, 10.0 - gap], [16, 10.0 - gap]]]);
        scenario(&document, &[]).map(drop)
    };
    assert_eq!(with_wall(1.0), Ok(()));
    let closed = with_wall(0.0).unwrap_err();
    let expected = "journeys: of `out`: no way leads from (6.5, 2.6), where agents of grids[0] start, to `east`: \
                    walls close it off";
    assert!(closed.contains(expected), "{closed}");
    let narrow = with_wall(0.3).unwrap_err();
    assert!(
        narrow.contains("narrower than 0.53 m, too narrow for"),
        "{narrow}"
    );
    let straight = scenario(&base(), &["navigation=straight"]).unwrap_err();
    assert!(
        straight.contains("journeys and exits need `paths`"),
        "{straight}"
    );
}

#[test]
fn sixty_people_leave_a_corridor_drawn_as_wkt_that_leads_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let outline = "POLYGON ((0 0, 12 0, 12 10, 0 10, 0 8, 10 8, 10 2, 0 2, 0 0))";
    file("corridor.wkt", outline);
    let document = json!({
        "walkable_area": "corridor.wkt",
        "exits": [{"name": "end", "line": [[0, 8], [0, 10]]}],
        "crowds": [{"area": [[0, 0], [12, 0], [12, 2], [0, 2]], "number": 60}],
    });
    let path = file("corridor.json", &document.to_string());
    for profile in ["sph", "rvo->sph"] {
        let setting = format!("profile={profile}").parse().unwrap();
        let scenario = Scenario::load(&path, &[setting]).unwrap();
        let mut simulation = Simulation::new(scenario.scene).unwrap();
        go_on(&mut simulation, 40.0);
        assert_eq!(simulation.outcome().arrivals.len(), 60, "{profile}");
    }
}
