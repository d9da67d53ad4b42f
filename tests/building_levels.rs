//! One level of a building: in pictures, pages, egress curves and starts from trajectories, and routes over all levels.

use std::collections::BTreeMap;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;
use sandbox::engine::routes::Destination;
use sandbox::output::drawing::Drawing;
use serde_json::json;

use crate::common::building_files::{house, in_all_formats, people, rows};
use crate::common::buildings::read;
use crate::common::page::Page;
use crate::common::pictures;
use crate::common::plans::margin;
use crate::common::program::{json, refused, run, text};
use crate::common::random_buildings::Building;

#[test]
fn the_people_of_one_level_begin_a_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let [csv, ..] = in_all_formats(&folder, &house(&folder), "12");
    let file = folder.path().join("start.json");
    let mut document = json!({
        "profile": "sph",
        "duration_secs": 1,
        "walkable_area": [[[[0, 0], [10, 0], [10, 6], [0, 6]]]],
        "from": {"trajectory": "a.csv", "at_secs": 12, "goal": [0, 3]},
    });
    let write = |document: &serde_json::Value| {
        std::fs::write(&file, document.to_string()).unwrap();
    };
    write(&document);
    let words = "from.trajectory: ";
    let choose = "choose one with `level`: `ground`, `stairs`, `upper`";
    refused(&["run", text(&file)], 2, &[words, choose]);
    document["from"]["level"] = json!("grund");
    write(&document);
    refused(&["run", text(&file)], 2, &["did you mean `ground`?"]);
    document["from"]["level"] = json!("ground");
    write(&document);
    let out = folder.path().join("start.csv");
    let output = run(&[
        "run",
        text(&file),
        "--until",
        "0",
        "--trajectory",
        text(&out),
    ]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let there = people(&csv, "120").into_values();
    let there = there.filter(|(level, _)| level == "ground");
    let mut expected: Vec<[f64; 2]> = there.map(|(_, [x, y, _])| [x, y]).collect();
    let started = rows(&out).into_iter().filter(|row| row["frame"] == "0");
    let place =
        |row: BTreeMap<String, String>| ["pos_x", "pos_y"].map(|name| row[name].parse().unwrap());
    let mut found: Vec<[f64; 2]> = started.map(place).collect();
    for places in [&mut expected, &mut found] {
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    assert!(expected.len() > 2);
    assert_eq!(found, expected);
}

#[test]
fn blanks_in_the_names_of_levels_may_be_typed_as_underscores() {
    let folder = tempfile::tempdir().unwrap();
    let house = house(&folder);
    let document = std::fs::read_to_string(&house).unwrap();
    std::fs::write(&house, document.replace("\"upper\"", "\"upper floor\"")).unwrap();
    for file in in_all_formats(&folder, &house, "9") {
        let mut results = Vec::new();
        for name in ["upper floor", "upper_floor"] {
            let typed = [
                "measure",
                text(&file),
                "--level",
                name,
                "--geometry",
                "none",
                "--json",
            ];
            let out = folder.path().join("measured");
            let more = ["--line", "15,0,15,6", "--force", "--out", text(&out)];
            let output = run(&[&typed[..], &more].concat());
            assert_eq!(output.status.code(), Some(0), "{output:?}");
            results.push(json(&output)["lines"].clone());
        }
        assert_eq!(results[0], results[1], "{}", file.display());
        assert!(
            results[0][0]["backward"]["passages"].as_u64().unwrap() > 3,
            "{results:?}"
        );
    }
}

#[test]
fn egress_of_one_level_shows_who_leaves_it() {
    let folder = tempfile::tempdir().unwrap();
    let house = house(&folder);
    let [csv, ..] = in_all_formats(&folder, &house, "40");
    let svg = folder.path().join("egress.svg");
    let typed = [
        "draw",
        text(&csv),
        "--egress",
        "--level",
        "upper",
        "--out",
        text(&svg),
        "--json",
    ];
    let output = run(&typed);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let mut last: BTreeMap<String, f64> = BTreeMap::new();
    let mut end: f64 = 0.0;
    for row in rows(&csv) {
        let time = row["time"].parse().unwrap();
        end = end.max(time);
        if row["level"] == "upper" {
            last.insert(row["id"].clone(), time);
        }
    }
    let mut times: Vec<f64> = last.into_values().filter(|time| *time < end).collect();
    times.sort_by(f64::total_cmp);
    let said = json(&output);
    let found: Vec<f64> = serde_json::from_value(said["exits"][0]["secs"].clone()).unwrap();
    assert_eq!(said["entered"], 40);
    assert_eq!(found.len(), times.len());
    assert!(times.len() > 20, "{times:?}");
    assert!(found.iter().zip(&times).all(|(a, b)| (a - b).abs() < 1e-9));
    let texts = pictures::texts(&std::fs::read_to_string(&svg).unwrap());
    assert!(
        texts
            .iter()
            .any(|text| text.contains("people who leave upper")),
        "{texts:?}"
    );
    let words = [
        "--egress of a scenario shows the people who leave the building",
        "--trajectory",
    ];
    refused(&["draw", &house, "--egress", "--level", "upper"], 2, &words);
}

#[test]
fn routes_are_drawn_on_all_levels_or_one() {
    let folder = tempfile::tempdir().unwrap();
    let house = house(&folder);
    let svg = folder.path().join("routes.svg");
    let draw = |more: &[&str]| {
        let typed = ["draw", &house, "--out", text(&svg), "--force", "--paths"];
        let output = run(&[&typed[..], more].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let drawn = std::fs::read_to_string(&svg).unwrap();
        (pictures::texts(&drawn), drawn)
    };
    let (texts, all) = draw(&["street"]);
    for name in [
        "Routes to exit street",
        "ground",
        "stairs",
        "upper",
        "to upper",
    ] {
        assert!(
            texts.iter().any(|text| text == name),
            "no {name} in {texts:?}"
        );
    }
    let (texts, one) = draw(&["street", "--level", "stairs"]);
    assert!(
        texts
            .iter()
            .any(|text| text == "Routes to exit street on stairs"),
        "{texts:?}"
    );
    // People start upstairs only: the routes of a dozen cross the three levels, and none begins on the stairs.
    let lines = |svg: &str| svg.matches("stroke=\"#000000\"").count();
    assert!(
        lines(&all) > lines(&one) + 12,
        "{} and {}",
        lines(&all),
        lines(&one)
    );
    let (texts, _) = draw(&["2,5", "--level", "ground"]);
    assert!(
        texts
            .iter()
            .any(|text| text == "Routes to (2, 5) on ground"),
        "{texts:?}"
    );
    let words = ["a point of a building lies on a level: add --level NAME"];
    refused(&["draw", &house, "--paths", "2,5"], 2, &words);
}

#[test]
fn a_page_of_a_recording_has_the_people_of_one_level() {
    let folder = tempfile::tempdir().unwrap();
    let house = house(&folder);
    let [csv, rrd, page] = ["a.csv", "a.rrd", "a.html"].map(|name| folder.path().join(name));
    run(&[
        "run",
        &house,
        "--until",
        "9",
        "--trajectory",
        text(&csv),
        "--save",
        text(&rrd),
    ]);
    let output = run(&[
        "draw",
        text(&rrd),
        "--level",
        "stairs",
        "--out",
        text(&page),
    ]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let read = Page::read(&page);
    let mut times = read.times.iter();
    let frame = times.position(|time| (time - 8.0).abs() < 1e-6).unwrap();
    let there = people(&csv, "80")
        .into_iter()
        .filter(|(_, (level, _))| level == "stairs");
    let expected: BTreeMap<u64, [f64; 3]> = there.map(|(id, (_, place))| (id, place)).collect();
    assert!(expected.len() > 2);
    assert_eq!(read.crowds[frame].len(), expected.len());
    for (&id, person) in &read.crowds[frame] {
        let [x, y] = read.position(person);
        let [own_x, own_y, _] = expected[&(id as u64)];
        assert!(
            (x - own_x).abs() < 0.02 && (y - own_y).abs() < 0.02,
            "{id}: ({x}, {y})"
        );
    }
    let words = ["there is no level named `roof`"];
    refused(
        &[
            "draw",
            text(&rrd),
            "--level",
            "roof",
            "--out",
            text(&page),
            "--force",
        ],
        2,
        &words,
    );
}

#[test]
fn routes_over_random_buildings_are_drawn_in_parts_on_one_level_each() {
    let mut count = 0;
    for seed in 0..200 {
        let building = Building::random(&mut ChaCha8Rng::seed_from_u64(seed));
        // Routes around the end of a thin wall between two flights are not drawn right.
        let ends = || building.joins.iter().flat_map(|(line, _)| *line);
        let meet = |p: Vector| ends().filter(|end| (end - p).norm() < 0.05).count() > 1;
        if ends().any(meet) {
            continue;
        }
        count += 1;
        let scene = read(&building.document()).scene;
        let (routes, levels) = (scene.routes.clone().unwrap(), scene.levels.clone().unwrap());
        let drawing = Drawing::of(&scene).unwrap();
        for agent in &scene.agents {
            let mut line = vec![agent.position];
            line.extend(routes.course(agent.position, Destination::Place(0)));
            let parts = drawing.parts(&line);
            let at = format!("{seed}: from {}: {parts:?}", agent.position);
            let mut length = 0.0;
            let mut last: Option<(Vector, usize)> = None;
            for part in &parts {
                let mut on = None;
                for pair in part.windows(2) {
                    length += (pair[1] - pair[0]).norm();
                    let p = drawing.in_plane((pair[0] + pair[1]) / 2.0).expect(&at);
                    let (level, p) = (levels.level(p), levels.in_building(p));
                    assert_eq!(*on.get_or_insert(level), level, "{at}");
                    let own = &building.levels[level];
                    assert!(
                        own.is_free(p, 0.0) || margin(&own.rings, p) < 1e-4,
                        "{at}: {p}"
                    );
                }
                let Some(level) = on else {
                    continue;
                };
                let way = drawing.way(level).unwrap();
                let ends = [part[0], part[part.len() - 1]].map(|p| p - way);
                if let Some((end, before)) = last {
                    assert!((end - ends[0]).norm() < 1e-4, "{at}");
                    let mut joins = building.joins.iter();
                    let between = [[before, level], [level, before]];
                    assert!(joins.any(|(_, joined)| between.contains(joined)), "{at}");
                }
                last = Some((ends[1], level));
            }
            let whole = routes.length(agent.position, Destination::Place(0));
            assert!((length - whole).abs() < 1e-3, "{at}: {length} and {whole}");
        }
    }
    assert!(count > 20, "{count} buildings");
}
