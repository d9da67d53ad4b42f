//! The first lines of a run's text say what is in its results.

use std::fs;

use serde_json::{Value, json};

use crate::common::program::{json as results, run_in};

/// The results of a run of a document, and the lines of its text that begin with this name.
fn said(document: &Value, name: &str) -> (Value, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("s.json"), document.to_string()).unwrap();
    let found = results(&run_in(folder.path(), &["run", "s.json", "--json"]));
    let text = run_in(folder.path(), &["run", "s.json"]).stdout;
    let text = String::from_utf8(text).unwrap();
    let mut lines = text.lines().map(str::trim);
    let line = lines.find_map(|line| line.strip_prefix(name));
    (found, line.unwrap().trim().to_owned())
}

#[test]
fn the_text_names_the_opening_before_which_people_wait() {
    let document = json!({
        "profile": "steer+sph", "seed": 1, "duration_secs": 14,
        "walkable_area": [[[[0, 0], [10, 0], [10, 4.4], [10.2, 4.4], [10.2, 0], [16.2, 0], [16.2, 10], [10.2, 10],
                            [10.2, 5.6], [10, 5.6], [10, 10], [0, 10]]]],
        "exits": [{"name": "e", "line": [[16.2, 1], [16.2, 9]]}],
        "crowds": [{"area": [[0.5, 0.5], [9, 0.5], [9, 9.5], [0.5, 9.5]], "number": 150}],
    });
    let (found, line) = said(&document, "longest queue");
    let queue = &found["longest_queues"][0];
    let (agents, secs) = (
        queue["agents"].as_u64().unwrap(),
        queue["at_secs"].as_f64().unwrap(),
    );
    assert!((115..=135).contains(&agents), "{found}");
    assert_eq!(queue["at"], json!([10.0, 5.0]));
    let expected = format!("{agents} before the opening at (10, 5) after {secs:.0} s");
    assert!(line.starts_with(&expected), "{line}, not {expected}");
}

#[test]
fn the_text_says_how_many_stand_outside_of_the_line_of_a_queue() {
    let document = json!({
        "profile": "steer+sph", "seed": 2, "duration_secs": 40,
        "walkable_area": [[[[0, 0], [12, 0], [12, 10], [0, 10]]]],
        "exits": [{"name": "e", "line": [[12, 8], [12, 9]]}],
        "queues": [{"name": "counter", "path": [[10, 5], [7, 5]], "service_secs": 3}],
        "journeys": [{"name": "j", "stages": ["counter", "e"]}],
        "crowds": [{"area": [[0.5, 0.5], [6, 0.5], [6, 9.5], [0.5, 9.5]], "number": 60, "journey": "j"}],
    });
    let (found, line) = said(&document, "longest queue");
    let mut queues = found["longest_queues"].as_array().unwrap().iter();
    let queue = queues.find(|queue| queue["before"] == "counter").unwrap();
    let outside = &queue["outside"];
    let number = |value: &Value| value.as_f64().unwrap();
    assert!(
        number(&outside["agents"]) > 5.0 && number(&outside["mean_secs"]) > 3.0,
        "{found}"
    );
    assert!(number(&outside["longest_secs"]) <= 40.0 && number(&outside["people"]) <= 60.0);
    let expected = format!(
        "{} before counter after {:.0} s (up to {} outside of its line, at {:.0} s, at up to {:.1} P/m²; {:.0} s \
         each on average)",
        queue["agents"],
        number(&queue["at_secs"]),
        outside["agents"],
        number(&outside["at_secs"]),
        number(&queue["density_per_m2"]),
        number(&outside["mean_secs"]),
    );
    assert!(line.contains(&expected), "{line}, not {expected}");
}

#[test]
fn the_text_has_a_table_of_values_and_below_it_the_names_of_those_that_are_zero() {
    let document = json!({
        "profile": "sph", "seed": 1, "duration_secs": 1,
        "agents": [{"position": [0, 0], "goal": [9, 0]}, {"position": [0, 3], "goal": [9, 3]}],
        "measurements": [{"integrity": {}}, {"exposure": {}}],
    });
    let (found, line) = said(&document, "highest_speed_m_per_s");
    let speed = found["metrics"]["highest_speed_m_per_s"].as_f64().unwrap();
    assert_eq!(line, format!("{speed:.3}  m/s"));
    let (found, line) = said(&document, "0: agents_through_walls, ");
    assert_eq!(line, "non_finite_frames");
    let (_, line) = said(&document, "exposure_slow_agents");
    assert_eq!(
        line,
        format!("{}  agents", found["metrics"]["exposure_slow_agents"])
    );
    let (_, line) = said(&document, "0: exposure_above_4_agents, ");
    assert!(line.starts_with("exposure_above_4_person_secs, "), "{line}");
}
