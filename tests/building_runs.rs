//! What runs of a building say and write, recomputed from the example in docs/guide/buildings.md alone.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::common::building_files::{People, house, in_all_formats, people, rows};
use crate::common::buildings::tower;
use crate::common::page::Page;
use crate::common::pictures;
use crate::common::program::{json, refused, run, text};

/// The levels of the example: their names, the ends of their floors along x, meters, and the heights there.
const LEVELS: [(&str, [f64; 2], [f64; 2]); 3] = [
    ("ground", [0.0, 10.0], [0.0, 0.0]),
    ("stairs", [10.0, 14.0], [0.0, 2.5]),
    ("upper", [14.0, 20.0], [2.5, 2.5]),
];

#[test]
fn files_and_results_have_the_levels_and_heights_of_the_building() {
    let folder = tempfile::tempdir().unwrap();
    let (house, file) = (house(&folder), folder.path().join("house.csv"));
    let output = run(&["run", &house, "--json", "--trajectory", text(&file)]);
    let results = json(&output);
    let (mut last, mut highest) = (BTreeMap::new(), (0.0, String::new()));
    for row in rows(&file) {
        let number = |name: &str| row[name].parse::<f64>().unwrap();
        let (x, y, z) = (number("pos_x"), number("pos_y"), number("z"));
        let level = LEVELS.iter().find(|(name, ..)| *name == row["level"]);
        let (name, [from, to], [low, high]) = level.unwrap();
        // Bodies of those who have left walk on behind the exit.
        assert!(x > from - 0.1 || *name == "ground", "{name}: {x}");
        assert!(x < to + 0.1 && y > 0.0, "{name}: ({x}, {y})");
        let expected = low + (high - low) * (x - from) / (to - from);
        assert!((z - expected).abs() < 1e-9, "{name}: {z} at {x}");
        let time = number("time");
        last.insert(row["id"].clone(), time);
        if number("density") > highest.0 {
            highest = (number("density"), (*name).to_owned());
        }
    }
    // All have left, the last one when the results say so.
    assert_eq!(last.len(), 40);
    let end = last.values().copied().fold(0.0, f64::max);
    let said = results["t100_secs"].as_f64().unwrap();
    assert!((said - end).abs() <= 0.1 + 1e-9, "{said}, {end}");
    assert_eq!(results["highest_density"]["level"], Value::from(highest.1));
    let most = results["highest_density"]["density_per_m2"]
        .as_f64()
        .unwrap();
    assert!((most - highest.0).abs() < 1e-9, "{most}, {}", highest.0);
    // The crowd waits at the head of the stairs.
    let queue = &results["longest_queues"][0];
    assert_eq!(queue["before"], "the opening at (14, 0.75) on `upper`");
    assert_eq!(queue["at"], serde_json::json!([14.0, 0.75]));
    assert_eq!(queue["level"], "upper");
    assert!(queue["agents"].as_u64().unwrap() > 10);
    assert_eq!(results["metrics"]["foot_passages"], 40);
}

#[test]
fn all_formats_have_the_same_people_on_the_same_levels() {
    let folder = tempfile::tempdir().unwrap();
    let files = in_all_formats(&folder, &house(&folder), "9");
    let [csv, sqlite, plain] = &files;
    let expected = people(csv, "80");
    let connection = rusqlite::Connection::open(sqlite).unwrap();
    let query = "SELECT id, level, pos_x, pos_y, z FROM trajectory_data WHERE frame = 80";
    let mut query = connection.prepare(query).unwrap();
    let found = query.query_map([], |row| {
        let place = [row.get(2)?, row.get(3)?, row.get(4)?];
        Ok((row.get::<_, i64>(0)? as u64, (row.get(1)?, place)))
    });
    assert_eq!(
        found.unwrap().collect::<Result<People, _>>().unwrap(),
        expected
    );
    let lines = std::fs::read_to_string(plain).unwrap();
    assert!(lines.contains("# id frame x/m y/m z/m level\n"));
    let cells = lines
        .lines()
        .map(|line| line.split('\t').collect::<Vec<_>>());
    let found = cells
        .filter(|cells| cells.get(1) == Some(&"80"))
        .map(|cells| {
            let place = [2, 3, 4].map(|k| cells[k].parse().unwrap());
            (cells[0].parse().unwrap(), (cells[5].to_owned(), place))
        });
    assert_eq!(found.collect::<People>(), expected);
    // The floor of each level, and of all seen from above.
    let floors = "SELECT wkt FROM levels WHERE name = 'stairs' UNION ALL SELECT wkt FROM geometry";
    let mut query = connection.prepare(floors).unwrap();
    let areas = query.query_map([], |row| row.get::<_, String>(0)).unwrap();
    let sizes = areas.map(|wkt| {
        let plan = sandbox::scenario::floor_plan::parse_wkt(&wkt.unwrap()).unwrap();
        plan.walkable.iter().map(|area| area.area()).sum::<f64>()
    });
    let sizes: Vec<f64> = sizes.collect();
    assert!(
        (sizes[0] - 6.0).abs() < 1e-6 && (sizes[1] - 102.0).abs() < 1e-6,
        "{sizes:?}"
    );
}

#[test]
fn of_files_of_buildings_one_level_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    let files = in_all_formats(&folder, &house(&folder), "20");
    for file in &files {
        let all = "choose one with --level: `ground`, `stairs`, `upper`";
        refused(&["measure", text(file)], 2, &[all]);
        let typed = ["measure", text(file), "--level", "stair"];
        refused(
            &typed,
            2,
            &["no people are on a level named `stair`; did you mean `stairs`?"],
        );
    }
    let out = folder.path().join("out");
    let measured = files.each_ref().map(|file| {
        let typed = [
            "measure",
            text(file),
            "--level",
            "stairs",
            "--geometry",
            "none",
        ];
        let more = [
            "--line",
            "12,0,12,1.5",
            "--out",
            text(&out),
            "--force",
            "--json",
        ];
        let output = run(&[&typed[..], &more].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        json(&output)
    });
    // Those who cross the middle of the stairs, from the positions alone.
    let mut last: BTreeMap<String, f64> = BTreeMap::new();
    let mut crossed = 0;
    for row in rows(&files[0])
        .iter()
        .filter(|row| row["level"] == "stairs")
    {
        let x: f64 = row["pos_x"].parse().unwrap();
        let before = last.insert(row["id"].clone(), x);
        crossed += u64::from(before.is_some_and(|before| before > 12.0 && x <= 12.0));
    }
    assert!(crossed > 10);
    for result in &measured {
        let line = &result["lines"][0];
        assert_eq!(line["backward"]["passages"], crossed, "{line}");
        assert_eq!(line["forward"]["passages"], 0, "{line}");
    }
    // Files of one floor have no levels.
    let file = folder.path().join("flat.txt");
    std::fs::write(
        &file,
        "# framerate: 10\n# id frame x/m y/m\n1 0 0 0\n1 1 0.1 0\n",
    )
    .unwrap();
    let words = ["it has no column `level`: leave --level out"];
    refused(&["measure", text(&file), "--level", "ground"], 2, &words);
}

/// Where the people of each level are drawn beside each other: by how much their places are moved.
fn shifts(drawn: &[(String, [f64; 2], [f64; 2])]) -> BTreeMap<String, [f64; 2]> {
    let mut shifts: BTreeMap<String, [f64; 2]> = BTreeMap::new();
    for (level, place, at) in drawn {
        let shift = [0, 1].map(|k| at[k] - place[k]);
        let known = shifts.entry(level.clone()).or_insert(shift);
        let same = (0..2).all(|k| (known[k] - shift[k]).abs() < 0.01);
        assert!(same, "{level}: {known:?} and {shift:?}");
    }
    shifts
}

#[test]
fn pages_draw_levels_beside_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let house = house(&folder);
    let [page, csv] = ["a.html", "a.csv"].map(|name| folder.path().join(name));
    run(&[
        "run",
        &house,
        "--until",
        "9",
        "--save",
        text(&page),
        "--trajectory",
        text(&csv),
    ]);
    let read = Page::read(&page);
    let frame = read
        .times
        .iter()
        .position(|time| (time - 8.0).abs() < 1e-6)
        .unwrap();
    let expected = people(&csv, "80");
    assert_eq!(read.crowds[frame].len(), expected.len());
    let drawn = read.crowds[frame].iter().map(|(&id, person)| {
        let (level, [x, y, _]) = &expected[&(id as u64)];
        (level.clone(), [*x, *y], read.position(person))
    });
    let shifts = shifts(&drawn.collect::<Vec<_>>());
    assert!(shifts.len() > 1, "{shifts:?}");
    // The floors do not overlap where they are drawn.
    let floor = |level: &str| -> [[f64; 2]; 2] {
        match level {
            "ground" => [[0.0, 10.0], [0.0, 6.0]],
            "stairs" => [[10.0, 14.0], [0.0, 1.5]],
            _ => [[14.0, 20.0], [0.0, 6.0]],
        }
    };
    let boxes: Vec<[[f64; 2]; 2]> = shifts
        .iter()
        .map(|(level, shift)| {
            let sides = floor(level);
            [0, 1].map(|k| sides[k].map(|x| x + shift[k]))
        })
        .collect();
    for (k, one) in boxes.iter().enumerate() {
        for other in &boxes[..k] {
            let apart = (0..2).any(|k| one[k][0] > other[k][1] || other[k][0] > one[k][1]);
            assert!(apart, "{one:?} and {other:?}");
        }
    }
    for name in [
        "ground",
        "stairs",
        "upper",
        "to stairs",
        "to upper",
        "to ground",
    ] {
        assert!(
            read.scene.to_string().contains(&format!("\"{name}\"")),
            "no {name}"
        );
    }
}

#[test]
fn pictures_show_all_levels_or_one() {
    let folder = tempfile::tempdir().unwrap();
    let house = house(&folder);
    let [csv, svg, rrd] = ["a.csv", "a.svg", "a.rrd"].map(|name| folder.path().join(name));
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
    let expected = people(&csv, "80");
    let draw = |what: &str, more: &[&str]| {
        let typed = ["draw", what, "--at", "8", "--out", text(&svg), "--force"];
        let output = run(&[&typed[..], more].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let drawn = std::fs::read_to_string(&svg).unwrap();
        (
            pictures::different(&pictures::circles(&drawn)),
            pictures::texts(&drawn),
        )
    };
    let count = format!("8.00 s, {} agents", expected.len());
    for what in [&house, text(&rrd)] {
        let (circles, texts) = draw(what, &[]);
        assert_eq!(circles.len(), expected.len(), "{what}");
        for name in ["ground", "stairs", "upper", "to upper", &count] {
            assert!(
                texts.iter().any(|text| text == name),
                "{what}: no {name} in {texts:?}"
            );
        }
    }
    for level in ["ground", "stairs", "upper"] {
        let own = expected.values().filter(|(on, _)| on == level);
        let places: Vec<[f64; 2]> = own.map(|(_, [x, y, _])| [*x, *y]).collect();
        for what in [&house[..], text(&csv), text(&rrd)] {
            let (circles, texts) = draw(what, &["--level", level]);
            match places.len() {
                0 => assert!(circles.is_empty()),
                _ => pictures::assert_drawn(&circles, &places, &format!("{what}, {level}")),
            }
            assert!(
                what.ends_with("csv")
                    || texts.contains(&format!("8.00 s, {} agents on {level}", places.len())),
                "{texts:?}"
            );
        }
    }
    refused(
        &["draw", &house, "--level", "roof"],
        2,
        &["there is no level named `roof`"],
    );
    refused(
        &["draw", "evacuation", "--level", "roof"],
        2,
        &["has no `levels`"],
    );
}

#[test]
fn reports_count_the_people_on_each_level() {
    let folder = tempfile::tempdir().unwrap();
    let house = house(&folder);
    let [csv, html] = ["a.csv", "a.html"].map(|name| folder.path().join(name));
    // Every frame of the run.
    let run_it = ["run", &house, "--trajectory", text(&csv)];
    run(&[&run_it[..], &["--trajectory-fps", "50"]].concat());
    let output = run(&["report", &house, "--out", text(&html)]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let mut counts: BTreeMap<String, BTreeMap<u64, u64>> = BTreeMap::new();
    for row in rows(&csv) {
        let level = counts.entry(row["level"].clone()).or_default();
        let frame = row["frame"].parse().unwrap();
        *level.entry(frame).or_default() += 1;
    }
    let secs = |frame: u64| format!("{:.1}", frame as f64 / 50.0);
    let report = std::fs::read_to_string(&html).unwrap();
    let said = crate::common::html::rows(&report, "Levels");
    for (level, of) in &counts {
        let row = said.iter().find(|row| row[0] == *level).unwrap();
        let most = of.values().max().unwrap();
        let at = of.iter().find(|(_, count)| *count == most).unwrap().0;
        let start = of.get(&0).copied().unwrap_or_default();
        let last = of.keys().last().unwrap();
        let [start, most] = [start, *most].map(|count| count.to_string());
        let expected = [start, most, secs(*at), secs(last + 1), "0".to_owned()];
        assert_eq!(row[1..], expected, "{level}");
    }
    assert_eq!(said.len(), counts.len(), "{said:?}");
    // The curves are steps.
    let mut figures = pictures::figures(&report).into_iter();
    let found = figures.find(|(_, caption)| caption.starts_with("People on each level"));
    let (svg, _) = found.unwrap();
    for line in svg.split("<polyline").skip(1) {
        let (_, points) = line.split_once("points=\"").unwrap();
        let points = points.split_once('"').unwrap().0.split_whitespace();
        let points: Vec<_> = points.map(|point| point.split_once(',').unwrap()).collect();
        for ends in points.windows(2) {
            let [(x, y), (u, v)] = [ends[0], ends[1]];
            assert!(x == u || y == v, "{ends:?}");
        }
    }
    // A run that ends between two seconds: the last frame counts.
    let document = std::fs::read_to_string(&house).unwrap();
    let short = document.replace("\"duration_secs\": 120", "\"duration_secs\": 12.4");
    std::fs::write(&house, short).unwrap();
    run(&["run", &house, "--trajectory", text(&csv), "--force"]);
    run(&["report", &house, "--out", text(&html), "--force"]);
    let last = people(&csv, "124");
    let report = std::fs::read_to_string(&html).unwrap();
    let said = crate::common::html::rows(&report, "Levels");
    for level in ["ground", "stairs", "upper"] {
        let count = last.values().filter(|(on, _)| on == level).count();
        let row = said.iter().find(|row| row[0] == level).unwrap();
        assert_eq!(row[5], count.to_string(), "{row:?}");
        assert!(count > 0, "{level}");
    }
}

#[test]
fn reports_name_the_limits_of_levels_stairs_and_lifts() {
    let folder = tempfile::tempdir().unwrap();
    let [lifts, html] = ["lifts.json", "a.html"].map(|name| folder.path().join(name));
    std::fs::write(&lifts, tower().to_string()).unwrap();
    let report = |scenario: &str| {
        let output = run(&["report", scenario, "--out", text(&html), "--force"]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        std::fs::read_to_string(&html).unwrap()
    };
    let limits = |report: &str| {
        let (_, rest) = report.split_once("Assumptions and limits</h2>").unwrap();
        rest.split_once("</ul>").unwrap().0.to_owned()
    };
    let slopes =
        "seen from above: 0.61 m/s up and 0.69 m/s down on <code>stairs</code>. No experiment";
    let of_house = limits(&report(&house(&folder)));
    assert!(of_house.contains(slopes), "{of_house}");
    let report = report(text(&lifts));
    let of_tower = limits(&report);
    for said in [&of_house, &of_tower] {
        assert!(said.contains("discs on the levels of a building"), "{said}");
        assert!(!said.contains("flat floor"), "{said}");
    }
    assert!(of_house.contains("no lifts") && !of_house.contains("Lifts"));
    assert!(of_tower.contains("Lifts take") && !of_tower.contains("no lifts"));
    assert!(!of_tower.contains("m/s"), "{of_tower}");
    // People wait at the stops until a lift comes.
    for row in crate::common::html::rows(&report, "Waiting areas and queues") {
        assert!(row[0].starts_with("lift, "), "{row:?}");
        assert_eq!(row[2], "until a lift takes them");
    }
}

#[test]
fn inspect_names_the_lift_for_which_a_person_waits() {
    let folder = tempfile::tempdir().unwrap();
    let lifts = folder.path().join("lifts.json");
    std::fs::write(&lifts, tower().to_string()).unwrap();
    let typed = ["inspect", text(&lifts), "--all", "--at", "12"];
    let output = run(&typed);
    let said = String::from_utf8(output.stdout).unwrap();
    let waits = "waits for the lift `lift` in `lift, second` since ";
    assert!(said.contains(waits), "{said}");
    assert!(!said.contains("is released"), "{said}");
    let all = json(&run(&[&typed[..], &["--json"]].concat()));
    let visits = all["agents"].as_array().unwrap().iter();
    let mut waiting = visits.filter(|one| one["visit"]["status"] == "waiting");
    assert!(waiting.all(|one| one["visit"]["lift"] == "lift"));
}

#[test]
fn one_person_is_inspected_on_their_level() {
    let folder = tempfile::tempdir().unwrap();
    let house = house(&folder);
    let output = run(&["inspect", &house, "--agent", "3", "--at", "5"]);
    let said = String::from_utf8(output.stdout).unwrap();
    let line = said.lines().find(|line| line.starts_with("on `")).unwrap();
    let (name, rest) = line[4..].split_once("` at (").unwrap();
    let (place, rest) = rest.split_once("), ").unwrap();
    let x: f64 = place.split_once(", ").unwrap().0.parse().unwrap();
    let height: f64 = rest.split_once(" m high").unwrap().0.parse().unwrap();
    let level = LEVELS.iter().find(|(own, ..)| *own == name);
    let (_, [from, to], [low, high]) = level.unwrap();
    let expected = low + (high - low) * (x - from) / (to - from);
    assert!(
        (from - 0.1..to + 0.1).contains(&x) && (height - expected).abs() < 0.006,
        "{line}"
    );
    // The JSON has the points of the building: the body, its goal, its way up to the stairs, and walls near it.
    let csv = folder.path().join("a.csv");
    run(&["run", &house, "--until", "6", "--trajectory", text(&csv)]);
    let output = run(&["inspect", &house, "--agent", "3", "--at", "5", "--json"]);
    let agent = &json(&output)["agents"][0];
    let (level, [x, y, _]) = &people(&csv, "50")[&3];
    assert_eq!(agent["level"], Value::from(level.as_str()));
    assert_eq!(agent["position"], serde_json::json!([x, y]));
    let corners = agent["way"]["corners"].as_array().unwrap();
    let [end, next] = [corners.last().unwrap(), &agent["way"]["next"]];
    assert_eq!(level, "upper");
    assert!((end[0].as_f64().unwrap() - 14.0).abs() < 1e-9, "{end}");
    assert!((0.0..1.5).contains(&end[1].as_f64().unwrap()), "{end}");
    assert!(next[0].as_f64().unwrap() <= 20.0, "{next}");
    for wall in agent["walls"].as_array().unwrap() {
        let at = [0, 1].map(|k| wall["nearest_point"][k].as_f64().unwrap());
        assert!((at[0] - x).hypot(at[1] - y) < 1.0, "{wall}");
    }
}
