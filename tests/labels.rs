//! Labels, titles and layout of recordings: names do not cover each other, nothing has two names, numbers are short.

use std::fs;

use serde_json::json;

use crate::common::program::{run_json, text};
use crate::common::recording::Recording;
use sandbox::engine::math::Vector;
use sandbox::output::labels::{AROUND, Labels, Placed, Screen};

/// The names in a recording: texts and the points above which they are centered.
fn names(recording: &Recording) -> Vec<(String, [f64; 2])> {
    let entities = recording.entities().into_iter();
    let own =
        entities.filter(|name| name.starts_with("/world/geometry") && name.ends_with("names"));
    let named = own.flat_map(|entity| {
        let texts = recording.static_texts(&entity, "Points2D:labels");
        let places = recording.static_pairs(&entity, "Points2D:positions");
        assert_eq!(texts.len(), places.len());
        texts.into_iter().zip(places)
    });
    named.collect()
}

/// Records the beginning of a scenario; the recording, and the titles of its views.
fn recorded(scenario: &str, options: &[&str]) -> (Recording, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.rrd");
    let until = ["--until", "0.1", "--save", text(&path), "--json"];
    run_json(&[&["run", scenario], &until[..], options].concat());
    let titles = Recording::layout(&path).into_iter().collect();
    (Recording::read(&path), titles)
}

/// Asserts that no two names overlap in a view of this part of the plane, of this size in pixels.
fn assert_apart(names: &[(String, [f64; 2])], [low, high]: [[f64; 2]; 2], panel: [f64; 2]) {
    let extent = [0, 1].map(|k: usize| high[k] - low[k]);
    let with_bar = extent[0] + 0.1 * extent[0].max(extent[1]);
    let scale = (panel[0] / with_bar).min(panel[1] / extent[1]);
    // Letters are at least 5.4 pixels wide, labels 20 pixels high.
    let half = |text: &str| 0.5 * 5.4 * text.chars().count() as f64 / scale;
    for (k, (text, at)) in names.iter().enumerate() {
        for (other, place) in &names[..k] {
            let apart = (at[0] - place[0]).abs() >= half(text) + half(other)
                || (at[1] - place[1]).abs() >= 20.0 / scale;
            assert!(apart, "{text} at {at:?}, {other} at {place:?}");
        }
    }
}

#[test]
fn names_in_recordings_do_not_cover_each_other() {
    for (name, view, panel, least) in [
        ("office", [[-3.0, -6.0], [43.0, 26.0]], [650.0, 395.0], 8),
        ("station", [[-9.0, -1.0], [49.0, 25.0]], [650.0, 395.0], 9),
        (
            "platforms",
            [[-42.0, -14.0], [114.0, 32.0]],
            [1300.0, 220.0],
            10,
        ),
    ] {
        let region = format!("view.region={}", json!(view));
        let (recording, _) = recorded(&format!("scenarios/{name}.json"), &["--set", &region]);
        let names = names(&recording);
        assert!(names.len() >= least, "{name}: {names:?}");
        assert_apart(&names, view, panel);
    }
}

/// A hall with two doors and measurements of the flow through them, one named as its door.
fn hall(stages: serde_json::Value) -> String {
    let flow = |y: f64, name: &str| {
        json!({"line_flow": {"name": name, "line": [[10, y], [10, y + 1.0]],
            "region": [[7, y], [10, y + 1.0]]}})
    };
    let document = json!({
        "name": "hall", "profile": "walk+sph", "duration_secs": 1,
        "parameters": {"rest_density_max": 5.53},
        "walkable_area": [[[[0, 0], [10, 0], [10, 5], [0, 5]]]],
        "exits": [{"name": "main_door", "line": [[10, 1], [10, 2]]}, {"name": "side", "line": [[10, 3], [10, 4]]}],
        "waypoints": [{"name": "desk", "at": [5, 2], "within": 1}],
        "journeys": [{"name": "out", "stages": stages}],
        "crowds": [{"area": [[0, 0], [4, 0], [4, 4], [0, 4]], "number": 4, "journey": "out"}],
        "measurements": [flow(1.0, "main_door"), flow(3.0, "flow_aside")],
    });
    document.to_string()
}

#[test]
fn a_place_and_its_measurement_have_one_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hall.json");
    fs::write(&path, hall(json!(["main_door"]))).unwrap();
    let (recording, _) = recorded(text(&path), &[]);
    let names = names(&recording);
    let with = |word: &str| names.iter().filter(|(name, _)| name.contains(word)).count();
    assert_eq!(
        (with("door"), with("side"), with("aside")),
        (1, 2, 1),
        "{names:?}"
    );
    assert!(
        with("main door") == 0 && with("exit main_door") == 1,
        "{names:?}"
    );
}

#[test]
fn the_stage_has_a_view_if_there_are_two_and_titles_have_round_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hall.json");
    for (stages, has_view) in [
        (json!(["main_door"]), false),
        (json!(["desk", "main_door"]), true),
    ] {
        fs::write(&path, hall(stages)).unwrap();
        let (recording, titles) = recorded(text(&path), &[]);
        let has = |title: &str| titles.iter().any(|other| other == title);
        assert_eq!(has("Stage of the journey"), has_view, "{titles:?}");
        assert!(has("Density 0–7 P/m²"), "{titles:?}");
        let legend = &recording.static_texts("/info/scenario", "TextDocument:text")[0];
        assert_eq!(legend.contains("Colors by stage"), has_view);
        assert!(legend.contains("green 4.2, yellow 7 P/m²"), "{legend}");
    }
    let given = ["--set", "view.density_range=[0.12345,6.636]"];
    let (_, titles) = recorded(text(&path), &given);
    let has = |title: &str| titles.iter().any(|other| other == title);
    assert!(has("Density 0.123–6.64 P/m²"), "{titles:?}");
}

#[test]
fn labels_of_one_point_never_overlap_and_stay_inside() {
    let [least, most] = [Vector::zeros(), Vector::new(10.0, 10.0)];
    let screen = Screen {
        inside: [least, most],
        scale: 40.0,
        height: 9.6,
        width: |text| 5.0 * text.len() as f64,
    };
    let mut labels = Labels::new(screen, Vec::new());
    let spots = AROUND.map(|side| (Vector::new(5.0, 5.0), side));
    for k in 0..60 {
        labels.add(&format!("label {k}"), [0; 3], &spots);
    }
    let placed = labels.into_placed();
    assert!(placed.len() > 12, "{}", placed.len());
    for (k, Placed { around, .. }) in placed.iter().enumerate() {
        let [low, high] = around;
        assert!(low.x >= least.x && low.y >= least.y && high.x <= most.x && high.y <= most.y);
        for other in &placed[..k] {
            let [l, h] = other.around;
            let apart = h.x <= low.x || high.x <= l.x || h.y <= low.y || high.y <= l.y;
            assert!(apart);
        }
    }
}
