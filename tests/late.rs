//! A note names what begins after the end of a run.

use sandbox::scenario::{Scenario, Setting};
use serde_json::{Value, json};

/// The notes on a run of 120 s with more keys and settings.
fn notes(more: &Value, settings: &[&str]) -> Vec<String> {
    let mut document = json!({
        "duration_secs": 120, "agents": [{"position": [2, 2]}],
        "exits": [{"name": "east", "line": [[9, 4], [9, 6]]}],
    });
    let keys = more.as_object().unwrap().clone();
    document.as_object_mut().unwrap().extend(keys);
    let settings = settings.iter().map(|text| text.parse().unwrap());
    let settings: Vec<Setting> = settings.collect();
    let scenario = Scenario::parse(&document.to_string(), "f.json", &settings);
    scenario.unwrap().notes
}

#[test]
fn what_begins_after_the_end_is_noted_with_its_place() {
    let close = |at: f64| json!({"events": [{"at_secs": at, "close": "east"}]});
    let exit = |from: f64| {
        json!({"exits": [{"name": "east", "line": [[9, 4], [9, 6]],
                          "closed_secs": [[0, 0.1], [from, 900]]}]})
    };
    let source = |start: f64| {
        json!({"sources": [{"min": [0, 5], "max": [0, 9], "columns": 1, "rows": 4, "every_secs": 1,
                            "start_secs": start}]})
    };
    let measured = |kind: &str, key: &str, at: f64| json!({"measurements": [{"closest": {}}, {kind: {key: at}}]});
    for (at, is_late) in [(500.0, true), (120.5, true), (120.0, false), (0.5, false)] {
        for (more, place) in [
            (close(at), "events[0].at_secs"),
            (exit(at), "exits[0].closed_secs[1]"),
            (source(at), "sources[0].start_secs"),
            (
                measured("density", "at_secs", at),
                "measurements[1].density.at_secs",
            ),
            (
                measured("exposure", "from_secs", at),
                "measurements[1].exposure.from_secs",
            ),
            (
                measured("flow_until", "until_secs", at),
                "measurements[1].flow_until.until_secs",
            ),
            (
                measured("snapshot", "at_secs", at),
                "measurements[1].snapshot.at_secs",
            ),
        ] {
            let note = format!("{place}: {at} s is after the end of the run, 120 s");
            let expected = if is_late { vec![note] } else { vec![] };
            assert_eq!(notes(&more, &[]), expected, "{more}");
        }
    }
}

#[test]
fn several_late_times_give_one_note() {
    let events = [300, 30, 301, 302, 303, 304].map(|at| json!({"at_secs": at, "close": "east"}));
    let note = "events[0].at_secs: 300 s is after the end of the run, 120 s; so are events[2].at_secs, \
                events[3].at_secs, events[4].at_secs, 1 more";
    assert_eq!(notes(&json!({"events": events}), &[]), [note]);
}

#[test]
fn a_run_that_settings_shorten_has_a_note_on_what_is_late_in_its_file_too() {
    let events = [30, 300].map(|at| json!({"at_secs": at, "close": "east"}));
    let events = json!({"events": events});
    let late = "events[1].at_secs: 300 s is after the end of the run";
    assert_eq!(
        notes(&events, &["duration_secs=20"]),
        [format!("{late}, 20 s")]
    );
    assert_eq!(notes(&events, &[]), [format!("{late}, 120 s")]);
    assert_eq!(notes(&events, &["duration_secs=301"]), Vec::<String>::new());
}
