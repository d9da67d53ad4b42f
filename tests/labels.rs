//! Labels, titles and layout of recordings: names do not cover each other, nothing has two names, numbers are short.

use std::fs;

use serde_json::json;

use crate::common::program::{run, run_json, stderr, text};
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

/// The box of a text or an outline in an SVG, pixels.
type Corners = [[f64; 2]; 2];

/// The area of what two boxes have in common, square pixels.
fn shared([low, high]: Corners, [l, h]: Corners) -> f64 {
    let side = |k: usize| (high[k].min(h[k]) - low[k].max(l[k])).max(0.0);
    side(0) * side(1)
}

/// The value of an attribute in the text of an element.
fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    let (_, rest) = element.split_once(&format!(" {name}=\"")).unwrap();
    rest.split('"').next().unwrap()
}

/// The polylines of an SVG that have this color.
fn lines(svg: &str, color: &str) -> Vec<Vec<[f64; 2]>> {
    let lines = svg
        .lines()
        .filter(|line| line.starts_with("<polyline") && line.contains(color));
    let point = |pair: &str| {
        let (x, y) = pair.split_once(',').unwrap();
        [x, y].map(|number| number.parse().unwrap())
    };
    let points = |line: &str| {
        attribute(line, "points")
            .split_whitespace()
            .map(point)
            .collect()
    };
    lines.map(points).collect()
}

/// The texts of an SVG that begin with `begin`: each with the point at which it is written, and its box.
fn written(svg: &str, begin: &str) -> Vec<(String, [f64; 2], Corners)> {
    let texts = svg
        .split("<text ")
        .skip(1)
        .filter(|text| !text.contains("#FFFFFF"));
    let texts = texts.filter_map(|element| {
        let element = format!(" {element}");
        let (_, text) = element.split_once('>').unwrap();
        let text = text.split("</text>").next().unwrap().trim().to_owned();
        let number = |name: &str| attribute(&element, name).parse::<f64>().unwrap();
        let (at, size) = ([number("x"), number("y")], number("font-size"));
        let width = 0.5 * size * text.chars().count() as f64;
        let left = match attribute(&element, "text-anchor") {
            "start" => at[0],
            "middle" => at[0] - 0.5 * width,
            _ => at[0] - width,
        };
        let low = match attribute(&element, "dy") {
            "0.76em" => at[1],               // below the point
            "-0.5ex" => at[1] - 0.76 * size, // above it
            _ => at[1] - 0.38 * size,
        };
        let corners = [[left, low], [left + width, low + 0.76 * size]];
        text.starts_with(begin).then_some((text, at, corners))
    });
    texts.collect()
}

/// A plan with rows of equal waiting areas, and their names.
fn school(columns: u32, rows: u32) -> (serde_json::Value, Vec<String>) {
    let names: Vec<String> = (1..=columns * rows).map(|k| format!("class {k}")).collect();
    let rooms = (0..columns * rows).zip(&names).map(|(k, name)| {
        let [x, y] = [k % columns, k / columns].map(|k| 1.0 + 8.0 * f64::from(k));
        let area = [[x, y], [x + 6.0, y], [x + 6.0, y + 6.0], [x, y + 6.0]];
        json!({"name": name, "area": area, "until_secs": 2})
    });
    let [width, height] = [columns, rows].map(|count| 8.0 * f64::from(count));
    let floor = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    let shares = names.iter().map(|name| (name.clone(), json!(1)));
    let shares: serde_json::Map<String, serde_json::Value> = shares.collect();
    let scene = json!({
        "name": "school", "profile": "steer+sph", "duration_secs": 5, "walkable_area": [[floor]],
        "exits": [{"name": "e", "line": [[0, 4], [0, 5]]}], "waiting_areas": rooms.collect::<Vec<_>>(),
        "journeys": [{"name": "j", "stages": [{"shares": shares}, "e"]}],
        "crowds": [{"area": floor, "number": 20, "journey": "j"}]
    });
    (scene, names)
}

/// Asserts that each label in a picture of areas is beside its own area, or has a line to it. Returns the number of
/// lines.
fn assert_beside(svg: &str, names: &[String], about: &str) -> usize {
    let all = lines(svg, "#E69F00");
    let (areas, leaders): (Vec<_>, Vec<_>) = all.into_iter().partition(|line| line.len() > 2);
    let corners = |ring: &Vec<[f64; 2]>| -> Corners {
        let end =
            |of: fn(f64, f64) -> f64| [0, 1].map(|k| ring.iter().map(|p| p[k]).reduce(of).unwrap());
        [end(f64::min), end(f64::max)]
    };
    let areas: Vec<Corners> = areas.iter().map(corners).collect();
    assert_eq!(areas.len(), names.len());
    let mut count = 0;
    for (text, at, around) in written(svg, "waiting area class") {
        let number: usize = text.rsplit(' ').next().unwrap().parse().unwrap();
        let own = areas[number - 1];
        let distance = |p: &[f64; 2]| (p[0] - at[0]).abs().max((p[1] - at[1]).abs());
        let mut leaders = leaders.iter();
        if let Some(leader) = leaders.find(|line| line.iter().any(|end| distance(end) < 2.0)) {
            let end = leader
                .iter()
                .max_by(|p, q| distance(p).total_cmp(&distance(q)));
            let point = end.unwrap();
            let is_in = |k: usize| (own[0][k] - 3.0..=own[1][k] + 3.0).contains(&point[k]);
            assert!(is_in(0) && is_in(1), "{about}: {text}: {leader:?}, {own:?}");
            count += 1;
            continue;
        }
        let middle = [0, 1].map(|k| 0.5 * (around[0][k] + around[1][k]));
        if (0..2).all(|k| own[0][k] < middle[k] && middle[k] < own[1][k]) {
            continue; // in the middle of it
        }
        // Labels are about half of their height from their areas.
        let reach = around[1][1] - around[0][1];
        let wide = [around[0].map(|x| x - reach), around[1].map(|x| x + reach)];
        let beside = shared(wide, own);
        for (k, other) in areas.iter().enumerate().filter(|(k, _)| k + 1 != number) {
            let is_right = beside > shared(wide, *other);
            assert!(is_right, "{about}: {text} beside class {}", k + 1);
        }
    }
    count
}

#[test]
fn the_label_of_an_area_is_beside_it_or_has_a_line_to_it() {
    let folder = tempfile::tempdir().unwrap();
    let [from, out] = ["school.json", "school.svg"].map(|name| folder.path().join(name));
    let mut lines_to_areas = 0;
    for (columns, rows) in [(3, 1), (1, 4), (4, 1), (3, 2)] {
        let (scene, names) = school(columns, rows);
        fs::write(&from, scene.to_string()).unwrap();
        for width in ["600px", "900px", "1200px", "2400px"] {
            let typed = [
                "draw",
                text(&from),
                "--width",
                width,
                "--force",
                "-o",
                text(&out),
            ];
            let output = run(&typed);
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
            let svg = fs::read_to_string(&out).unwrap();
            let about = format!("{columns} × {rows}, {width}");
            lines_to_areas += assert_beside(&svg, &names, &about);
        }
    }
    assert!(lines_to_areas > 0);
}
