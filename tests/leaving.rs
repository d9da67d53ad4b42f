//! Notes on agents that cannot leave, leave at once, or have no room where they enter and wait.

use sandbox::engine::journeys::Kind;
use sandbox::engine::simulation::Simulation;
use sandbox::runs::notes;
use serde_json::{Value, json};

use crate::common::simulated::{driven, measured, scenario};

/// A room of 14 m × 8 m with an exit and people.
fn room(number: u32) -> Value {
    json!({
        "profile": "steer+sph", "duration_secs": 60,
        "walkable_area": [[[[0, 0], [14, 0], [14, 8], [0, 8]]]],
        "exits": [{"name": "ramp", "line": [[14, 3], [14, 5]]}],
        "stop": {"when_empty": true},
        "crowds": [{"name": "crowd", "area": [[1, 1], [6, 1], [6, 7], [1, 7]], "number": number}]
    })
}

fn said_before(document: &Value) -> Vec<String> {
    scenario(document, &[]).unwrap().notes
}

#[test]
fn a_run_that_waits_for_an_empty_floor_that_no_agent_can_leave_gets_a_note() {
    let mut document = room(20);
    assert_eq!(said_before(&document), [""; 0]);
    document["exits"] = json!([]);
    document["goal"] = json!([13, 4]);
    let said = said_before(&document);
    assert!(
        said.iter()
            .any(|note| note.starts_with("stop.when_empty: no agent can leave")),
        "{said:?}"
    );
    assert_eq!(measured(document.clone()).arrived, 0);
    document["crowds"][0]["remove_within"] = json!(0.5);
    let said = said_before(&document);
    assert!(
        !said.iter().any(|note| note.contains("no agent can leave")),
        "{said:?}"
    );
}

#[test]
fn agents_that_start_where_they_leave_get_a_note_with_their_number() {
    let mut document = room(20);
    document["exits"] = json!([]);
    document["goal"] = json!([6, 4]);
    document["crowds"][0]["remove_within"] = json!(2.5);
    let said = said_before(&document);
    let note = said
        .iter()
        .find(|note| note.contains("leave at once"))
        .unwrap();
    let count: usize = note
        .split([' ', ':'])
        .find_map(|word| word.parse().ok())
        .unwrap();
    let scene = scenario(&document, &[]).unwrap().scene;
    let near = scene
        .agents
        .iter()
        .filter(|one| (one.position - one.goal).norm() <= 2.5);
    assert_eq!(count, near.count());
    assert!((1..20).contains(&count));
}

#[test]
fn a_waiting_area_without_room_for_all_gets_a_note() {
    let small = |number| {
        let mut document = room(number);
        document["waiting_areas"] = json!([
            {"name": "pit", "area": [[10, 3], [12, 3], [12, 4], [10, 4]], "until_secs": 30}
        ]);
        document["journeys"] = json!([{"name": "j", "stages": ["pit", "ramp"]}]);
        document["crowds"][0]["journey"] = json!("j");
        said_before(&document)
    };
    assert_eq!(small(10), [""; 0]);
    let said = "waiting_areas: 11 agents are sent to `pit`, 2.0 m², where bodies touch from 10 on; give it more room, \
                or send fewer";
    assert_eq!(small(11), [said]);
}

#[test]
fn a_source_whose_agents_enter_on_top_of_each_other_gets_a_note() {
    let every = |secs: f64| {
        let mut document = room(1);
        document["sources"] = json!([{
            "name": "tap", "min": [2, 4], "max": [2, 4], "columns": 1, "rows": 1, "every_secs": secs, "times": 20
        }]);
        said_before(&document)
    };
    assert_eq!(every(1.0), [""; 0]);
    let said = every(0.05).join("\n");
    assert!(
        said.contains("sources[0].every_secs: agents walk 0.07 m in 0.05 s"),
        "{said}"
    );
}

#[test]
fn the_density_of_a_large_body_is_said_to_be_its_own() {
    let mut document = room(1);
    document["crowds"][0]["mass"] = json!(2.5);
    let highest = measured(document).highest_density.unwrap();
    assert_eq!(highest.mass, 2.5);
    let alone = 4.0 / std::f64::consts::PI * 2.5;
    assert!((highest.density_per_m2 - alone).abs() < 0.05 * alone);
    let said = format!("at a body of mass 2.50, which has {alone:.2} P/m² alone");
    assert_eq!(highest.of_large(), Some(said));
    assert_eq!(measured(room(1)).highest_density.unwrap().of_large(), None);
}

#[test]
fn a_run_that_ends_before_the_last_exit_opens_or_the_last_agents_enter_says_so() {
    let early = |change: &dyn Fn(&mut Value)| {
        let mut document = room(20);
        document["stop"] = json!({"idle_secs": 10});
        change(&mut document);
        let said = notes::of(&driven(&document));
        said.into_iter()
            .find(|note| note.starts_with("stop.idle_secs"))
    };
    assert_eq!(early(&|_| ()), None);
    let opens = early(&|document| document["exits"][0]["closed_secs"] = json!([[0, 20]]));
    let said = "stop.idle_secs, 10 s, ended the run, but `ramp` opens at 20 s: give a longer time";
    assert_eq!(opens.as_deref(), Some(said));
    let enter = early(&|document| {
        document["entrances"] = json!([
            {"name": "west", "line": [[0, 3], [0, 5]], "per_sec": 1, "number": 5, "from_secs": 40}
        ]);
    });
    let said =
        "stop.idle_secs, 10 s, ended the run, but more agents enter later: give a longer time";
    assert_eq!(enter.as_deref(), Some(said));
}

#[test]
fn closures_that_overlap_are_one_and_their_order_does_not_count() {
    let times = |closed: Value| {
        let mut document = room(20);
        document["exits"][0]["closed_secs"] = closed;
        let scene = scenario(&document, &[]).unwrap().scene;
        let changes = scene.journeys.changes.iter();
        changes.map(|change| change.at).collect::<Vec<f64>>()
    };
    assert_eq!(times(json!([[0, 10], [5, 15]])), [0.0, 15.0]);
    assert_eq!(times(json!([[10, 20], [0, 10]])), [0.0, 20.0]);
    assert_eq!(times(json!([[30, 40], [0, 10]])), [0.0, 10.0, 30.0, 40.0]);
}

#[test]
fn shares_of_exits_are_of_all_agents_that_leave_also_at_goals() {
    let mut document = room(20);
    let area = document["crowds"][0]["area"].clone();
    document["crowds"] = json!([
        {"name": "out", "area": area, "number": 10},
        {"name": "stage", "area": area, "number": 10, "goal": [3, 4], "remove_within": 1}
    ]);
    let summary = measured(document);
    let exit = &summary.places[0];
    assert_eq!(
        (summary.arrived, exit.passed, exit.share),
        (20, 10, Some(0.5))
    );
}

#[test]
fn a_run_that_is_empty_before_an_exit_closes_says_so() {
    let early = |closed: Value| {
        let mut document = room(20);
        document["exits"][0]["closed_secs"] = closed;
        let said = notes::of(&driven(&document));
        said.into_iter()
            .find(|note| note.starts_with("all have left"))
    };
    assert_eq!(early(json!([[0, 10]])), None);
    let said = early(json!([[40, 45], [50, 55]])).unwrap();
    assert!(
        said.ends_with(
            "s, before `ramp` closes at 40 s, and 3 later change(s) of exits and doors do not happen either"
        ),
        "{said}"
    );
}

#[test]
fn the_line_of_a_queue_ends_at_an_exit() {
    let length = |path: Value| {
        let mut document = room(20);
        document["queues"] = json!([{"name": "q", "path": path, "service_secs": 1}]);
        let scene = scenario(&document, &[]).unwrap().scene;
        let places = scene.journeys.places.into_iter();
        let mut lengths = places.filter_map(|place| match place.kind {
            Kind::Queue(queue) => Some(queue.length),
            _ => None,
        });
        lengths.next().unwrap()
    };
    // Up to the exit at x = 14, and up to the wall there.
    let [at_exit, at_wall] = [4.0, 1.0].map(|y| length(json!([[3, y], [9, y]])));
    assert!((at_exit - at_wall).abs() < 1e-9, "{at_exit}, {at_wall}");
    assert!((10.0..11.0).contains(&at_exit), "{at_exit}");
}

#[test]
fn moves_of_those_who_have_left_do_not_count() {
    let document = room(20);
    let scenario = scenario(&document, &[]).unwrap();
    let mut simulation = Simulation::new(scenario.scene).unwrap();
    let mut present = 0;
    while simulation.frame().agents.count_present() > 0 {
        simulation.evaluate().unwrap();
        present += simulation.frame().agents.present().count() as u64;
        simulation.integrate().unwrap();
    }
    assert_eq!(simulation.outcome().moves, present);
    assert!(present > 1000);
}
