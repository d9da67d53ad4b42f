//! `from`: scenes that begin with the people of a trajectory file.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::go_to;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use sandbox::runs::case::{Case, Source};
use sandbox::runs::checkpoint::Checkpoint;
use sandbox::runs::memory::Memory;
use sandbox::scenario::measurements::Metrics;
use sandbox::scenario::{Scenario, Setting};
use serde_json::{Value, json};
use tempfile::TempDir;

/// A person who walks on a straight line: id, first and last frame, place at time 0 in meters, velocity in m/s.
type Walker = (i64, [i64; 2], [f64; 2], [f64; 2]);

/// Two people who are there early, one who comes, and one who has left.
const WALKERS: [Walker; 4] = [
    (7, [0, 400], [0.3, 1.0], [1.1, 0.2]),
    (2, [0, 400], [2.0, -3.0], [-0.4, 0.9]),
    (31, [240, 400], [-9.0, 0.5], [1.3, -0.1]),
    (5, [0, 60], [0.0, 5.0], [0.2, 0.2]),
];

fn place(walker: &Walker, time: f64) -> Vector {
    Vector::from(walker.2) + Vector::from(walker.3) * time
}

/// Lines of a text file: coordinates in meters times `scale`.
fn lines(walkers: &[Walker], fps: f64, scale: f64) -> String {
    let mut text = String::new();
    for walker in walkers {
        for frame in walker.1[0]..=walker.1[1] {
            let at = place(walker, frame as f64 / fps) * scale;
            text += &format!("{} {frame} {:?} {:?}\n", walker.0, at.x, at.y);
        }
    }
    text
}

/// A folder with `people.txt` and `scene.json`, which has `from` and further keys.
fn folder(text: &str, from: Value, more: Value) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("people.txt"), text).unwrap();
    let mut document = match from {
        Value::Null => json!({"goal": [50, 0]}),
        from => json!({"goal": [50, 0], "from": from}),
    };
    let own = document.as_object_mut().unwrap();
    own.extend(more.as_object().unwrap().clone());
    let path = folder.path().join("scene.json");
    fs::write(&path, document.to_string()).unwrap();
    (folder, path)
}

fn loaded(path: &Path) -> Scenario {
    Scenario::load(path, &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn message(text: &str, from: Value, more: Value) -> String {
    let (_folder, path) = folder(text, from, more);
    let error = Scenario::load(&path, &[]).unwrap_err().to_string();
    let file = path.parent().unwrap().join("people.txt");
    let error = error.replace(file.to_str().unwrap(), "people.txt");
    error.replace(path.to_str().unwrap(), "scene.json")
}

fn is_at(agent: &NewAgent, walker: &Walker, time: f64) -> bool {
    let off = (agent.position - place(walker, time)).norm();
    let velocity = Vector::from(walker.3);
    off < 1e-9 && (agent.velocity - velocity).norm() < 1e-9
}

#[test]
fn places_and_velocities_of_people_on_straight_lines_are_exact_at_any_rate() {
    for (fps, scale, unit) in [
        (16.0, 1.0, "m"),
        (25.0, 100.0, "cm"),
        (29.97, 1.0, "m"),
        (3.0, 1.0, "m"),
    ] {
        for at in [70.0, 100.5, 123.456, 239.0].map(|frame| frame / fps) {
            let from = json!({"trajectory": "people.txt", "at_secs": at, "unit": unit, "fps": fps});
            let (_folder, path) = folder(&lines(&WALKERS, fps, scale), from, json!({}));
            let scene = loaded(&path).scene;
            assert_eq!(scene.agents.len(), 2);
            // By id.
            assert!(is_at(&scene.agents[0], &WALKERS[1], at), "{fps} {at}");
            assert!(is_at(&scene.agents[1], &WALKERS[0], at), "{fps} {at}");
            let [late] = &scene.scheduled[..] else {
                panic!("{:?}", scene.scheduled)
            };
            let appears = 240.0 / fps;
            assert!((late.at - (appears - at)).abs() < 1e-9);
            assert!(is_at(&late.agent, &WALKERS[2], appears), "{fps} {at}");
        }
    }
}

#[test]
fn the_scene_begins_with_the_first_frame_and_ends_its_entries_at_the_given_time() {
    let text = lines(&WALKERS, 25.0, 1.0);
    let from = |more: Value| {
        let mut from = json!({"trajectory": "people.txt", "unit": "m", "fps": 25});
        let own = from.as_object_mut().unwrap();
        own.extend(more.as_object().unwrap().clone());
        let (_folder, path) = folder(&text, from, json!({}));
        let scene = loaded(&path).scene;
        [scene.agents.len(), scene.scheduled.len()]
    };
    assert_eq!(from(json!({})), [3, 1]);
    assert_eq!(from(json!({"until_secs": 9.6})), [3, 1]);
    assert_eq!(from(json!({"until_secs": 9.59})), [3, 0]);
    assert_eq!(from(json!({"at_secs": 9.6})), [3, 0]);
    assert_eq!(from(json!({"at_secs": 16})), [3, 0]);
}

#[test]
fn a_time_before_the_data_is_that_of_their_first_frame_and_a_note_says_so() {
    let late = WALKERS.map(|(id, frames, at, v)| (id, frames.map(|frame| frame + 50), at, v));
    let load = |at: Value| {
        let from = json!({"trajectory": "people.txt", "unit": "m", "fps": 25, "at_secs": at});
        let (_folder, path) = folder(&lines(&late, 25.0, 1.0), from, json!({}));
        loaded(&path)
    };
    let first = load(Value::Null);
    assert!(first.notes.is_empty());
    for (at, is_noted) in [(-7.0, true), (0.0, true), (1.9, true), (2.0, false)] {
        let scenario = load(json!(at));
        assert_eq!(scenario.scene.agents, first.scene.agents, "{at}");
        assert_eq!(scenario.scene.scheduled, first.scene.scheduled, "{at}");
        let note = format!(
            "from.at_secs: {at} s is before the data: the scenario begins with their first frame, at 2 s"
        );
        assert_eq!(scenario.notes, if is_noted { vec![note] } else { vec![] });
    }
    assert_ne!(load(json!(2.1)).scene.agents, first.scene.agents);
}

#[test]
fn latecomers_enter_in_the_next_coarse_frame_at_their_place_with_their_velocity() {
    let from = json!({"trajectory": "people.txt", "at_secs": 5.03, "unit": "m", "fps": 25, "name": "data"});
    let (_folder, path) = folder(&lines(&WALKERS, 25.0, 1.0), from, json!({}));
    let scenario = loaded(&path);
    let mut simulation = Simulation::new(scenario.scene).unwrap();
    // 9.6 s in the file are 4.57 s here; the coarse step is 0.1 s.
    go_to(&mut simulation, 229);
    assert_eq!(simulation.frame().agents.len(), 2);
    assert!(simulation.expects_agents());
    go_to(&mut simulation, 230);
    simulation.evaluate().unwrap();
    let agents = simulation.frame().agents;
    let k = agents.id.iter().position(|&id| id == 2).unwrap();
    assert!((agents.position[k] - place(&WALKERS[2], 9.6)).norm() < 1e-9);
    assert!((agents.velocity[k] - Vector::new(1.3, -0.1)).norm() < 1e-9);
    assert!(!simulation.expects_agents());
    let backlog = simulation.backlogs().next().unwrap();
    assert_eq!((backlog.name, backlog.largest), ("data", 0));
}

/// Two people of radius 0.3 m: one stands at the place where the other appears after 1 s, and leaves it after 3 s.
fn taken() -> Value {
    json!({"navigation": "straight", "goal": [9, 0], "max_speed": 0.25, "from": {"radius": 0.3, "people": [
        [1, 0, 0, 0, 0, 0], [2, 1, 0.2, 0, 0.5, 0], [3, 1, 5, 5, 0, 0]
    ]}})
}

#[test]
fn latecomers_wait_until_there_is_room_and_hold_up_no_one_else() {
    let scenario = Scenario::parse(&taken().to_string(), "f", &[]).unwrap();
    let mut simulation = Simulation::new(scenario.scene).unwrap();
    let mut entered = Vec::new();
    for frame in 0..1000 {
        simulation.evaluate().unwrap();
        let agents = simulation.frame().agents;
        let now = agents.entered() as usize;
        if now > entered.len() {
            entered.resize(now, frame);
            let k = agents.id.iter().position(|&id| id as usize == now - 1);
            let new = agents.position[k.unwrap()];
            let near = agents.position.iter().filter(|p| (*p - new).norm() < 0.6);
            assert_eq!(near.count(), 1); // itself
        }
        simulation.integrate().unwrap();
    }
    // The third is not held up; the second has a speed above the largest.
    assert_eq!(entered[..2], [0, 50]);
    assert!(entered[2] > 100 && entered[2] % 5 == 0, "{entered:?}");
    let backlog = simulation.backlogs().next().unwrap();
    assert_eq!((backlog.largest, backlog.largest_frame), (1, 50));
    assert_eq!(backlog.waiting, 0);
}

#[test]
fn speeds_above_the_largest_are_clamped_and_counted() {
    let people = json!([
        [1, 0, 0, 0, 3, 4],
        [2, 0, 5, 0, 1, 0],
        [3, 1e-9, 20, 0, -9, 0]
    ]);
    let document = json!({"goal": [9, 0], "max_speed": 2, "from": {"people": people}});
    let scenario = Scenario::parse(&document.to_string(), "f", &[]).unwrap();
    let note = "1 of 2 people of `from` are faster at the start than `max_speed` allows, and are slowed to it";
    assert_eq!(scenario.notes, [note]);
    let mut simulation = Simulation::new(scenario.scene).unwrap();
    let agents = simulation.frame().agents;
    assert!((agents.velocity[0] - Vector::new(1.2, 1.6)).norm() < 1e-12);
    assert_eq!(agents.velocity[1], Vector::new(1.0, 0.0));
    simulation.evaluate().unwrap();
    let agents = simulation.frame().agents;
    let late = agents.id.iter().position(|&id| id == 2).unwrap();
    assert!((agents.velocity[late] - Vector::new(-2.0, 0.0)).norm() < 1e-12);
    assert_eq!(simulation.outcome().clamped.count, 1);
}

#[test]
fn the_document_has_the_people_in_place_of_the_file() {
    let from = json!({"trajectory": "people.txt", "at_secs": 4.567, "unit": "m", "fps": 25, "remove_within": 2});
    let (folder, path) = folder(&lines(&WALKERS, 25.0, 1.0), from, json!({}));
    let scenario = loaded(&path);
    assert_eq!(scenario.files.len(), 1);
    drop(folder);
    let again = Scenario::parse(&scenario.to_text(), "f", &[]).unwrap();
    assert_eq!(again.scene.agents, scenario.scene.agents);
    assert_eq!(again.scene.scheduled, scenario.scene.scheduled);
    assert_eq!(again.document, scenario.document);
    assert_eq!(again.document["from"]["at_secs"], Value::Null);
    assert!(again.files.is_empty());
}

#[test]
fn the_identity_of_a_run_changes_with_the_data_not_with_their_name() {
    let from = |name: &str| json!({"trajectory": name, "unit": "m", "fps": 25});
    let (folder, path) = folder(&lines(&WALKERS, 25.0, 1.0), from("people.txt"), json!({}));
    let memory = Memory::new(None);
    let key = |settings: &[&str]| {
        let settings = settings.iter().map(|text| text.parse().unwrap());
        let case = Case::new(Source::File(path.clone()), settings.collect(), &memory).unwrap();
        assert_eq!(case.files().count(), 2);
        case.key
    };
    let first = key(&[]);
    let file = folder.path().join("people.txt");
    fs::rename(&file, folder.path().join("others.txt")).unwrap();
    assert_eq!(key(&["from.trajectory=others.txt"]), first);
    assert_ne!(
        key(&["from.trajectory=others.txt", "from.at_secs=1"]),
        first
    );
    let mut moved = WALKERS;
    moved[1].2[0] += 1e-6;
    fs::write(&file, lines(&moved, 25.0, 1.0)).unwrap();
    assert_ne!(key(&[]), first);
}

#[test]
fn a_run_with_waiting_latecomers_resumes_to_the_same_bits_without_the_file() {
    let scenario = Scenario::parse(&taken().to_string(), "f", &[]).unwrap();
    let mut whole = Simulation::new(scenario.scene.clone()).unwrap();
    go_to(&mut whole, 60);
    whole.evaluate().unwrap();
    assert_eq!(whole.backlogs().next().unwrap().waiting, 1);
    let metrics = Metrics::new(&scenario.measurements, &mut whole);
    let checkpoint = Checkpoint::of(&scenario, &whole, &metrics);
    let own = checkpoint.scenario(&[]).unwrap();
    let mut resumed = checkpoint.resume(own).unwrap().simulation;
    for simulation in [&mut whole, &mut resumed] {
        go_to(simulation, 400);
    }
    assert_eq!(whole.frame().agents.entered(), 3);
    assert_eq!(resumed.digest(), whole.digest());
}

#[test]
fn problems_with_the_data_name_their_place_and_the_fix() {
    let text = lines(&WALKERS, 25.0, 1.0);
    let from = |more: Value| {
        let mut from = json!({"trajectory": "people.txt", "unit": "m", "fps": 25});
        let own = from.as_object_mut().unwrap();
        own.extend(more.as_object().unwrap().clone());
        from
    };
    let floor =
        json!({"walkable_area": [[[[-20, -20], [50, -20], [50, 4], [-20, 4]]]], "goal": [40, 0]});
    for (text, from, more, expected) in [
        (
            &text[..],
            from(json!({"trajectory": "nobody.txt"})),
            json!({}),
            "from.trajectory: ",
        ),
        (
            &text,
            from(json!({"at_secs": 17})),
            json!({}),
            "from.at_secs: 17 s is outside of the data: people.txt has 0 to 16 s",
        ),
        (
            &text,
            from(json!({"at_secs": 5, "until_secs": 4})),
            json!({}),
            "from.until_secs: 4 is before the start at 5 s; raise it",
        ),
        (
            "1 0 0 0\n2 50 1 1\n",
            from(json!({"at_secs": 1, "until_secs": 1.5})),
            json!({}),
            "from.at_secs: no one is in people.txt at 1 s, or appears in it later until 1.5 s",
        ),
        (
            &text,
            json!({"trajectory": "people.txt", "unit": "m"}),
            json!({}),
            "from.trajectory: people.txt: it has no frame rate (a line like `# framerate: 25`); give `fps`",
        ),
        (
            &text,
            json!({"trajectory": "people.txt", "fps": 25}),
            json!({}),
            "from.unit: missing, and people.txt names none (x/m or x/cm); set it to \"m\" or \"cm\"",
        ),
        (
            &lines(&WALKERS, 25.0, 100.0),
            from(json!({})),
            json!({}),
            "from.trajectory: half of all steps in people.txt are faster than 5 m/s; set `unit` (m, cm, mm, ft) and \
             `fps` to those of the file",
        ),
        (
            "1 0 0 zero\n",
            from(json!({})),
            json!({}),
            "from.trajectory: people.txt:1: y is \"zero\", not a finite number",
        ),
        (
            &text,
            from(json!({})),
            floor,
            "from: person 5 at (0.00, 5.00) m is in an obstacle or outside of the walkable area, as 1 of 4 people are; \
             mend the walls, or choose `unit`, the origin and `until_secs` to fit them",
        ),
        (
            &text,
            from(json!({"at_secs": 4})),
            json!({"goal": null, "periodic": {"axis": "x", "length": 30}}),
            "from: in a periodic scene none come in, and 1 people appear after the start; set `until_secs` to \
             `at_secs`",
        ),
    ] {
        let said = message(text, from, more);
        assert!(
            said.starts_with(&format!("scene.json: {expected}")),
            "{said}"
        );
    }
}

#[test]
fn settings_can_choose_file_and_time() {
    let (_folder, path) = folder(&lines(&WALKERS, 25.0, 1.0), Value::Null, json!({}));
    let settings = [
        "from.trajectory=people.txt",
        "from.unit=m",
        "from.fps=25",
        "from.at_secs=2",
    ];
    let settings: Vec<Setting> = settings.iter().map(|text| text.parse().unwrap()).collect();
    let scene = Scenario::load(&path, &settings).unwrap().scene;
    assert!(is_at(&scene.agents[0], &WALKERS[1], 2.0));
    let wrong = [settings, vec!["from.at_secs=99".parse().unwrap()]].concat();
    let said = Scenario::load(&path, &wrong).unwrap_err().to_string();
    assert!(
        said.starts_with("--set from.at_secs=99: 99 s is outside"),
        "{said}"
    );
}

#[test]
fn a_unit_or_frame_rate_that_is_not_the_files_own_is_noted() {
    let text = "# framerate: 16\n# id frame x/m y/m\n".to_owned() + &lines(&WALKERS, 16.0, 1.0);
    let notes = |from: Value| {
        let (_folder, path) = folder(&text, from, json!({}));
        loaded(&path).notes
    };
    let from = |unit: &str, fps: f64| json!({"trajectory": "people.txt", "at_secs": 5, "unit": unit, "fps": fps});
    assert_eq!(notes(from("m", 16.0)), Vec::<String>::new());
    let found = notes(from("cm", 16.0));
    assert_eq!(found[0], "from: `unit` cm is taken, not the file's own m");
    let found = notes(from("m", 8.0));
    assert_eq!(found, ["from: `fps` 8 is taken, not the file's own 16"]);
}
