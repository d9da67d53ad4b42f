//! Scenarios of JuPedSim's web app: what they become, and the notes on what has no counterpart.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::common::program::{json, run, stderr};
use crate::common::zips::{Packing, zip};
use sandbox::scenario::Scenario;

/// A hall of 20 m by 10 m with a pillar.
pub const HALL: &str = "POLYGON ((0 0, 20 0, 20 10, 0 10, 0 0), (9 4, 11 4, 11 6, 9 6, 9 4))";

pub fn rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> Value {
    json!([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]])
}

/// A scenario with an exit at the end of the hall and 30 people.
pub fn simple() -> Value {
    json!({
        "project_version": "2.0",
        "config": {"simulation_settings": {"baseSeed": 7, "numberOfSimulations": 1, "simulationParams":
            {"max_simulation_time": 40, "model_type": "CollisionFreeSpeedModel"}}},
        "exits": {"jps-exits_0": {"type": "polygon", "coordinates": rectangle([18.0, 0.0], [20.0, 10.0])}},
        "distributions": {"jps-distributions_0": {"type": "polygon",
            "coordinates": rectangle([1.0, 1.0], [7.0, 9.0]), "parameters": {"number": 30, "radius": 0.2, "v0": 1.3}}},
    })
}

/// Writes a scenario as an archive.
fn archive(folder: &Path, config: &Value, packing: Packing) -> PathBuf {
    let text = config.to_string();
    let files: [(&str, &[u8]); 2] = [
        ("config.json", text.as_bytes()),
        ("geometry.wkt", HALL.as_bytes()),
    ];
    let path = folder.join("hall.zip");
    fs::write(&path, zip(&files, packing)).unwrap();
    path
}

/// The scenario in an archive.
fn read(config: &Value) -> Scenario {
    let folder = tempfile::tempdir().unwrap();
    Scenario::load(&archive(folder.path(), config, Packing::Deflated), &[]).unwrap()
}

fn is_noted(scenario: &Scenario, words: &[&str]) -> bool {
    let has_all = |note: &&String| words.iter().all(|word| note.contains(word));
    scenario.notes.iter().filter(has_all).count() == 1
}

fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap()
}

/// The ends of a line as sorted pairs of numbers.
fn ends(line: &Value) -> Vec<[f64; 2]> {
    let point = |p: &Value| [0, 1].map(|axis| (p[axis].as_f64().unwrap() * 1e6).round() / 1e6);
    let mut ends: Vec<[f64; 2]> = list(line).iter().map(point).collect();
    ends.sort_by(|a, b| a.partial_cmp(b).unwrap());
    ends
}

#[test]
fn archives_folders_and_single_files_are_the_same_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let stored = Scenario::load(&archive(folder, &simple(), Packing::Stored), &[]).unwrap();
    let packed = Scenario::load(&archive(folder, &simple(), Packing::Deflated), &[]).unwrap();
    let two = folder.join("two");
    fs::create_dir(&two).unwrap();
    fs::write(two.join("config.json"), simple().to_string()).unwrap();
    fs::write(two.join("geometry.wkt"), HALL).unwrap();
    let beside = Scenario::load(&two.join("config.json"), &[]).unwrap();
    let mut whole = simple();
    whole["walkable_area_wkt"] = HALL.into();
    fs::write(folder.join("one.json"), whole.to_string()).unwrap();
    let one = Scenario::load(&folder.join("one.json"), &[]).unwrap();
    for (other, name) in [(&packed, "hall"), (&beside, "two"), (&one, "one")] {
        assert_eq!(other.name, name);
        assert_eq!(other.notes, stored.notes);
        let without_name = |scenario: &Scenario| {
            let mut document = scenario.document.clone();
            document.as_object_mut().unwrap().remove("name");
            document
        };
        assert_eq!(without_name(other), without_name(&stored));
    }
    assert_eq!(stored.seed, 7);
    assert_eq!(stored.duration_secs, 40.0);
    assert_eq!(stored.profile_name, "steer+sph");
    assert_eq!(stored.scene.agents.len(), 30);
    assert!(stored.stop.when_empty);
    assert_eq!(
        ends(&stored.document["exits"][0]["line"]),
        [[18.0, 0.0], [18.0, 10.0]]
    );
}

#[test]
fn exits_are_the_sides_of_their_polygons_that_border_on_floor() {
    let mut config = simple();
    config["exits"] = json!({
        "jps-exits_0": {"coordinates": rectangle([4.0, 8.0], [6.0, 10.0])},
        "jps-exits_1": {"coordinates": rectangle([14.0, 2.0], [15.0, 4.0])},
        "jps-exits_2": {"coordinates": rectangle([16.0, 9.8], [19.0, 12.0]),
                        "enable_throughput_throttling": true, "max_throughput": 1.5},
        "jps-exits_3": {"coordinates": rectangle([19.0, 4.0], [20.0, 5.0]),
                        "enable_throughput_throttling": true, "max_throughput": 2},
    });
    let scenario = read(&config);
    let exits = list(&scenario.document["exits"]);
    let lines = |name: &str| {
        let own = exits
            .iter()
            .filter(|exit| exit["name"].as_str().unwrap().starts_with(name));
        let mut lines: Vec<_> = own.map(|exit| ends(&exit["line"])).collect();
        lines.sort_by(|a, b| a.partial_cmp(b).unwrap());
        lines
    };
    let at_wall = [
        [[4.0, 8.0], [4.0, 10.0]],
        [[4.0, 8.0], [6.0, 8.0]],
        [[6.0, 8.0], [6.0, 10.0]],
    ];
    assert_eq!(lines("jps-exits_0"), at_wall);
    let inside = [
        [[14.0, 2.0], [14.0, 4.0]],
        [[14.0, 2.0], [15.0, 2.0]],
        [[14.0, 4.0], [15.0, 4.0]],
        [[15.0, 2.0], [15.0, 4.0]],
    ];
    assert_eq!(lines("jps-exits_1"), inside);
    assert!(exits[3]["name"] == "jps-exits_1 side 1" && ends(&exits[3]["line"]).len() == 2);
    // Sides of less than 0.3 m are no exits.
    assert_eq!(lines("jps-exits_2"), [[[16.0, 9.8], [19.0, 9.8]]]);
    assert_eq!(exits[7]["most_per_sec"], 1.5);
    assert_eq!(lines("jps-exits_3").len(), 1);
    assert!(is_noted(
        &scenario,
        &["exits.jps-exits_3", "the longest of its 3 open sides"]
    ));
}

#[test]
fn people_get_their_numbers_traits_and_times() {
    let mut config = simple();
    let area = |x: f64| rectangle([x, 1.0], [x + 3.0, 3.0]);
    let person =
        |x: f64, parameters: Value| json!({"coordinates": area(x), "parameters": parameters});
    config["distributions"] = json!({
        "jps-distributions_0": person(0.5, json!({"number": 4, "radius": 0.15, "radius_distribution": "gaussian",
            "radius_std": 0.02, "v0": 1.3, "v0_distribution": "gaussian", "v0_std": 0.2, "use_premovement": true,
            "premovement_distribution": "uniform", "premovement_param_a": 10, "premovement_param_b": 20})),
        "jps-distributions_1": person(4.0, json!({"distribution_mode": "by_percentage", "percentage": 30})),
        "jps-distributions_2": person(12.0, json!({"number": 12, "desired_speed": 1.1, "use_flow_spawning": true,
            "flow_start_time": 5, "flow_end_time": 11})),
        "jps-distributions_3": {"coordinates": area(12.0), "parameters": json!({"initial_number": 2, "flow_schedule":
            [{"flow_start_time": 0, "flow_end_time": 4, "number": 8},
             {"start_time_s": 6, "end_time_s": 7, "sim_count": 3}]}).to_string()},
        "jps-distributions_4": person(30.0, json!({"number": 5})),
    });
    let scenario = read(&config);
    let document = &scenario.document;
    let (crowds, entrances) = (&document["crowds"], &document["entrances"]);
    assert_eq!(crowds[0]["number"], 4);
    assert_eq!(
        crowds[0]["radius"]["normal"],
        json!({"mean": 0.15, "std": 0.02, "min": 0.1, "max": 1.0})
    );
    assert_eq!(crowds[0]["preferred_speed"]["normal"]["std"], 0.2);
    assert_eq!(
        crowds[0]["premovement_secs"],
        json!({"uniform": [10.0, 20.0]})
    );
    // Half of the area is the most that bodies cover: 23 disks of 0.2 m in 6 m²; 30 % of them.
    let most = (0.5 * (6.0 / (std::f64::consts::PI * 0.04)).floor()).floor();
    assert_eq!(crowds[1]["number"], (0.3 * most).floor() as u64);
    assert_eq!(crowds[1]["preferred_speed"], 1.2);
    assert_eq!(crowds[2]["number"], 2);
    assert_eq!(list(crowds).len(), 3);
    let times = |k: usize| {
        ["from_secs", "per_sec", "number"].map(|key| entrances[k][key].as_f64().unwrap())
    };
    assert_eq!(
        [times(0), times(1), times(2)],
        [[5.0, 2.0, 12.0], [0.0, 2.0, 8.0], [6.0, 3.0, 3.0]]
    );
    assert_eq!(entrances[0]["preferred_speed"], 1.1);
    let line = ends(&entrances[0]["line"]);
    assert!(line[0][0] < 12.1 && line[1][0] > 14.9 && (line[0][1] - 2.0).abs() < 1e-6);
    assert!(is_noted(
        &scenario,
        &[
            "distributions.jps-distributions_4",
            "outside of the walkable area"
        ]
    ));
}

#[test]
fn journeys_have_their_stages_and_shares() {
    let mut config = simple();
    let checkpoint = |x: f64, more: Value| {
        let mut keys = json!({"coordinates": rectangle([x, 1.0], [x + 2.0, 3.0])});
        keys.as_object_mut()
            .unwrap()
            .extend(more.as_object().unwrap().clone());
        keys
    };
    config["checkpoints"] = json!({
        "jps-checkpoints_0": checkpoint(11.0, json!({})),
        "jps-checkpoints_1": checkpoint(14.0, json!({"waiting_time": 5, "waiting_time_distribution": "gaussian",
                                                     "waiting_time_std": 2})),
        "jps-checkpoints_2": {"coordinates": rectangle([12.0, 7.0], [17.0, 8.0]), "speed_factor": 0.5},
    });
    config["zones"] = json!({"jps-zones_0": {"coordinates": rectangle([8.0, 0.0], [12.0, 3.0]), "speed_factor": 0.7},
                             "jps-zones_1": {"coordinates": rectangle([8.0, 7.0], [12.0, 9.0]), "speed_factor": 1}});
    config["journeys_v2"] = json!([
        {"id": "a", "name": "Route 1", "color": "#888", "sequence": ["jps-checkpoints_0", "jps-checkpoints_1",
                                                                         "jps-exits_0"]},
        {"id": "b", "name": "Route 1", "color": "#888", "sequence": ["jps-checkpoints_2", "nowhere", "jps-exits_0"]},
    ]);
    config["distributions"]["jps-distributions_0"]["journey_weights"] =
        json!([{"journey_id": "a", "weight": 80}, {"journey_id": "b", "weight": 20}]);
    let scenario = read(&config);
    let document = &scenario.document;
    let disk = json!({"name": "jps-checkpoints_0", "at": [12.0, 2.0], "within": 1.0});
    assert_eq!(document["waypoints"][0], disk);
    let line = ends(&document["waypoints"][1]["line"]);
    assert!(line[0][0] < 12.05 && line[1][0] > 16.95 && line[0][1] == 7.5);
    let wait = json!({"normal": {"mean": 5.0, "std": 2.0, "min": 0.1}});
    assert_eq!(document["waiting_areas"][0]["for_secs"], wait);
    let zones: Vec<f64> = list(&document["zones"])
        .iter()
        .map(|zone| zone["speed_factor"].as_f64().unwrap())
        .collect();
    assert_eq!(zones, [0.5, 0.7]);
    let journeys = json!([
        {"name": "Route 1", "stages": ["jps-checkpoints_0", "jps-checkpoints_1", "jps-exits_0"]},
        {"name": "b", "stages": ["jps-checkpoints_2", "jps-exits_0"]},
    ]);
    assert_eq!(document["journeys"], journeys);
    let crowds = list(&document["crowds"]);
    let shares: Vec<(u64, &str)> = crowds
        .iter()
        .map(|crowd| {
            (
                crowd["number"].as_u64().unwrap(),
                crowd["journey"].as_str().unwrap(),
            )
        })
        .collect();
    assert_eq!(shares, [(24, "Route 1"), (6, "b")]);
    assert!(is_noted(
        &scenario,
        &["journey b", "no checkpoint or exit nowhere"]
    ));
}

#[test]
fn former_journeys_split_by_their_percentages() {
    let mut config = simple();
    let square = |x: f64, y: f64| json!({"coordinates": rectangle([x, y], [x + 1.0, y + 1.0])});
    config["waiting_polygons"] = json!({"jps-checkpoints_0": square(8.0, 1.0), "jps-checkpoints_1": square(12.0, 1.0),
                                        "jps-checkpoints_2": square(12.0, 8.0)});
    let ids = [
        "jps-distributions_0",
        "jps-checkpoints_0",
        "jps-checkpoints_1",
        "jps-checkpoints_2",
        "jps-exits_0",
    ];
    config["journeys"] = json!([{"id": "j", "stages": ids}]);
    let connections = [(0, 1), (1, 2), (1, 3), (2, 4), (3, 4)];
    let transition =
        |&(from, to): &(usize, usize)| json!({"journey_id": "j", "from": ids[from], "to": ids[to]});
    config["transitions"] = connections.iter().map(transition).collect();
    config["waypoint_routing"] = json!({ids[1]: {"j": {"destinations":
        [{"target": ids[2], "percentage": 10}, {"target": ids[3], "percentage": 90}]}}});
    let scenario = read(&config);
    let document = &scenario.document;
    let crowds = list(&document["crowds"]);
    let shares: Vec<(u64, &Value)> = crowds
        .iter()
        .map(|crowd| {
            let mut journeys = list(&document["journeys"]).iter();
            let journey = journeys
                .find(|journey| journey["name"] == crowd["journey"])
                .unwrap();
            (crowd["number"].as_u64().unwrap(), &journey["stages"])
        })
        .collect();
    let stages = [2, 3].map(|k| json!([ids[1], ids[k], ids[4]]));
    assert_eq!(shares, [(3, &stages[0]), (27, &stages[1])]);
}

#[test]
fn people_without_a_journey_pass_all_checkpoints() {
    let mut config = simple();
    let square = |x: f64| json!({"coordinates": rectangle([x, 1.0], [x + 1.0, 2.0])});
    config["checkpoints"] =
        json!({"jps-checkpoints_10": square(14.0), "jps-checkpoints_9": square(12.0)});
    let scenario = read(&config);
    let stages = json!(["jps-checkpoints_9", "jps-checkpoints_10", "jps-exits_0"]);
    assert_eq!(scenario.document["journeys"][0]["stages"], stages);
    assert_eq!(
        scenario.document["crowds"][0]["journey"],
        scenario.document["journeys"][0]["name"]
    );
    assert!(is_noted(
        &scenario,
        &["without a journey", "jps-distributions_0"]
    ));
}

#[test]
fn what_has_no_counterpart_is_named_once() {
    let mut config = simple();
    config["project_version"] = "3.1".into();
    let settings = &mut config["config"]["simulation_settings"];
    settings["numberOfSimulations"] = 10.into();
    settings["simulationParams"]["dt"] = json!(0.05);
    settings["simulationParams"]["relaxation_time"] = json!(0.3);
    settings["simulationParams"]["mass"] = json!(80);
    settings["simulationParams"]["gravity"] = json!(9.81);
    config["exits"]["jps-exits_0"]["sign"] = json!({"x": 1});
    config["exits"]["jps-exits_1"] =
        json!({"coordinates": rectangle([14.0, 2.0], [15.0, 4.0]), "sign": 1});
    config["checkpoints"] = json!({"jps-checkpoints_0": {"coordinates": rectangle([12.0, 1.0], [13.0, 2.0]),
        "enable_throughput_throttling": true, "max_throughput": 1}});
    config["obstacles"] = json!({"jps-obstacles_0": {"height": 3}});
    let parameters = &mut config["distributions"]["jps-distributions_0"]["parameters"];
    parameters["use_premovement"] = "true".into();
    parameters["premovement_seed"] = 5.into();
    let scenario = read(&config);
    for words in [
        &["model_type CollisionFreeSpeedModel", "`steer+sph`"][..],
        &["project_version 3.1"],
        &["numberOfSimulations 10", "sandbox estimate"],
        &["dt 0.05", "time_step_secs"],
        &["relaxation_time 0.3"],
        &["checkpoints.jps-checkpoints_0", "throughput"],
        &["premovement_seed", "population_seed"],
        &[
            "unknown keys have no effect",
            "exits.*.sign",
            "config.simulation_settings.simulationParams.gravity",
        ],
    ] {
        assert!(
            is_noted(&scenario, words),
            "{words:?} in {:#?}",
            scenario.notes
        );
    }
    assert!(!scenario.notes.iter().any(|note| note.contains("mass")));
}

#[test]
fn the_program_runs_an_archive_and_says_its_notes() {
    let folder = tempfile::tempdir().unwrap();
    let path = archive(folder.path(), &simple(), Packing::Deflated);
    let path = path.to_str().unwrap();
    let output = run(&["run", path, "--json"]);
    let said = stderr(&output);
    assert!(output.status.success(), "{said}");
    assert_eq!(
        said.matches("note: model_type CollisionFreeSpeedModel")
            .count(),
        1
    );
    let result = json(&output);
    assert_eq!([&result["agents"], &result["remaining"]], [30, 0]);
    let other = json(&run(&[
        "run",
        path,
        "--json",
        "--profile",
        "sf",
        "--until",
        "1",
    ]));
    assert_eq!(other["settings"]["profile"], "sf");
    assert_ne!(other["state_sha256"], result["state_sha256"]);
    let folder = folder.path().join("hall");
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("config.json"), simple().to_string()).unwrap();
    fs::write(folder.join("geometry.wkt"), HALL).unwrap();
    for path in [folder.clone(), folder.join("config.json")] {
        let again = json(&run(&["run", path.to_str().unwrap(), "--json"]));
        assert_eq!(again["state_sha256"], result["state_sha256"]);
    }
}
