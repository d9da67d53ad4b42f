//! `sandbox measure` on the command line.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Output;

use crate::common::recording::Recording;
use crate::common::tracks::file;
use crate::common::{pictures, program};
use sandbox::output::recording::Recorded;
use serde_json::Value;

fn measure(arguments: &[&str]) -> Output {
    program::run(&[&["measure"], arguments].concat())
}

fn refused(arguments: &[&str], words: &str) {
    program::refused(&[&["measure"], arguments].concat(), 2, &[words]);
}

/// Five people walk to the right at 1 m/s for 4 s, between two walls.
fn walkers() -> (tempfile::TempDir, [String; 3]) {
    let rows = (0..40).flat_map(|frame| (0..5).map(move |id| (id, frame)));
    let rows = rows.map(|(id, frame)| {
        let x = -0.5 * f64::from(id) + 0.1 * f64::from(frame);
        format!("{id} {frame} {x} 1\n")
    });
    let text = "# framerate: 10\n# id frame x/m y/m\n".to_owned() + &rows.collect::<String>();
    let (folder, path) = file("walkers.txt", &text);
    let plan = folder.path().join("corridor.wkt");
    fs::write(&plan, "POLYGON ((-9 0, 9 0, 9 2, -9 2, -9 0))").unwrap();
    let out = folder.path().join("results");
    let paths = [path, plan, out].map(|path| path.to_str().unwrap().to_owned());
    (folder, paths)
}

/// The columns of a CSV file, by name; empty cells are NaN.
fn columns(path: &Path) -> BTreeMap<String, Vec<f64>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let head = reader.headers().unwrap().clone();
    let mut columns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for row in reader.records() {
        for (name, cell) in head.iter().zip(&row.unwrap()) {
            let number = cell.parse().unwrap_or(f64::NAN);
            columns.entry(name.to_owned()).or_default().push(number);
        }
    }
    columns
}

#[test]
fn a_corridor_is_measured_into_a_folder() {
    let (_folder, [trajectory, plan, out]) = walkers();
    let arguments = [
        &trajectory,
        "--geometry",
        &plan,
        "--out",
        &out,
        "--line",
        "1.02,0,1.02,2",
        "--line",
        "9,0,9,2",
        "--region",
        "0,0,1,2",
        "--cell",
        "0.5",
        "--json",
    ];
    let output = measure(&arguments);
    let stderr = program::stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    // Every file is named, and no other.
    let start = format!("note: written to {out}: ");
    let named = stderr
        .lines()
        .flat_map(|line| line.strip_prefix(&start).unwrap().split(", "));
    let named: BTreeSet<String> = named.map(str::to_owned).collect();
    let there = fs::read_dir(&out)
        .unwrap()
        .map(|entry| entry.unwrap().file_name());
    let there: BTreeSet<String> = there.map(|name| name.into_string().unwrap()).collect();
    assert_eq!(named, there);
    let report = program::json(&output);
    assert_eq!(
        (&report["people"], &report["rows"]),
        (&5.into(), &200.into())
    );
    let [first, second] = [0, 1].map(|k| &report["lines"][k]);
    assert_eq!(
        (&first["forward"]["passages"], &first["length"]),
        (&5.into(), &2.0.into())
    );
    let flow = first["forward"]["flow_per_s"].as_f64().unwrap();
    assert!((flow - 2.0).abs() < 1e-9);
    let specific = first["forward"]["specific_flow_per_m_s"].as_f64().unwrap();
    assert!((specific - 1.0).abs() < 1e-9);
    assert_eq!(second["forward"]["flow_per_s"], Value::Null);

    let folder = Path::new(&out);
    let agents = columns(&folder.join("agents.csv"));
    assert_eq!(agents["id"].len(), 200);
    assert!(
        agents["speed"]
            .iter()
            .all(|speed| (speed - 1.0).abs() < 1e-9)
    );
    let walls = &agents["density_from_walls"];
    assert!(
        walls.iter().all(|density| density.abs() < 1e-12),
        "1 m away: out of reach"
    );
    let fields = columns(&folder.join("fields.csv"));
    assert!(
        fields["y"].iter().all(|y| (0.0..2.0).contains(y)),
        "only where people can walk"
    );
    assert_eq!(columns(&folder.join("flow.csv"))["net"].last(), Some(&5.0));
    let diagram = columns(&folder.join("fundamental_diagram.csv"));
    assert!(
        diagram["people"]
            .iter()
            .all(|&people| (0.0..=3.0).contains(&people))
    );
    for (classic, people) in diagram["classic"].iter().zip(&diagram["people"]) {
        assert!((2.0 * classic - people).abs() < 1e-6, "2 m²");
    }
    let classes = columns(&folder.join("fundamental_classes.csv"));
    let pairs: f64 = classes["count"].iter().sum();
    let people: f64 = diagram["people"].iter().sum();
    let known = ["sph_at_people", "voronoi"].len() as f64 * people;
    let frames = |kind: &str, speed: &str| {
        let pairs = diagram[kind].iter().zip(&diagram[speed]);
        pairs
            .filter(|(density, speed)| !(*density + *speed).is_nan())
            .count() as f64
    };
    let by_speed = ["sph_at_people", "sph_field", "classic"].map(|kind| frames(kind, "speed"));
    let by_voronoi = frames("voronoi", "voronoi_speed");
    assert_eq!(pairs, known + by_speed.iter().sum::<f64>() + by_voronoi);
    let regions = columns(&folder.join("regions.csv"));
    assert_eq!(regions["walkable_m2"].len(), 4);
    for (name, texts) in [
        (
            "fields",
            &[
                "mean density",
                "density [P/m²]",
                "region 1",
                "line 1",
                "x [m]",
            ][..],
        ),
        (
            "fundamental_diagram",
            &["speed [m/s]", "SPH at people", "Voronoi"],
        ),
        ("flow", &["t [s]", "crossings so far", "line 1 forward"]),
        (
            "regions",
            &["region 1: density", "region 1: speed", "classic"],
        ),
        ("safety", &["above 4 P/m²", "crowd pressure"]),
    ] {
        pictures::assert_has(&folder.join(name), texts);
    }

    // Existing files are replaced only with `--force`.
    let agents = format!("{}", folder.join("agents.csv").display());
    refused(
        &arguments,
        &format!("--out {agents}: already exists; use --force to replace it"),
    );
    let again = measure(&[&arguments[..], &["--force"]].concat());
    assert_eq!(again.stdout, output.stdout);
}

#[test]
fn the_recording_has_the_crowd_and_its_walls() {
    use crate::common::recording::Recording;

    let (_folder, [trajectory, plan, out]) = walkers();
    let output = measure(&[
        &trajectory,
        "--geometry",
        &plan,
        "--out",
        &out,
        "--from",
        "1",
    ]);
    assert_eq!(output.status.code(), Some(0));
    let recording = Recording::read(&Path::new(&out).join("measured.rrd"));
    let entities = recording.entities();
    for entity in [
        "/world/agents",
        "/world/geometry/walls",
        "/stats/density/mean",
        "/info/scenario",
    ] {
        assert!(entities.contains(entity), "{entities:?}");
    }
    for entity in ["/stats/energy/kinetic", "/stats/crowd/evacuated"] {
        let values = recording.pairs(entity, "Scalars:scalars");
        assert!(values.is_empty(), "nobody knows {entity}");
    }
    let positions = recording.pairs("/world/agents", "Points2D:positions");
    assert_eq!((positions.len(), positions[0].0), (30, 10));
    assert_eq!(positions[0].1.len(), 5);
    assert!((positions[0].1[0][0] - 1.0).abs() < 1e-6);
}

#[test]
fn invalid_arguments_are_refused_with_the_fix() {
    let (_folder, [trajectory, plan, out]) = walkers();
    for (arguments, words) in [
        (vec!["no.txt"], "no.txt: cannot be read"),
        (
            vec![&*trajectory, "--line", "1,2,3"],
            "expected four numbers x0,y0,x1,y1",
        ),
        (
            vec![&*trajectory, "--region", "1,0,0,1"],
            "x0 < x1 and y0 < y1",
        ),
        (
            vec![&*trajectory, "--fps", "0"],
            "not a number of frames per second above 0",
        ),
        (
            vec![&*trajectory, "--from", "99"],
            "no agents from 99 s to inf s; there are agents from 0 s",
        ),
        (
            vec![&*trajectory, "--region", "90,0,91,1", "--geometry", &*plan],
            "region 1 is outside of the walkable area",
        ),
        (
            vec![&*trajectory, "--voronoi-cutoff", "none"],
            "nothing limits the Voronoi cells",
        ),
        (
            vec![&*trajectory, "--flow-of", "90..10"],
            "expected two parts of all passages such as 10%..90%",
        ),
        (
            vec![&*trajectory, "--cell", "0.001"],
            "give a larger --cell",
        ),
        (
            vec![&*trajectory, "--geometry", "no.wkt"],
            "--geometry no.wkt: cannot be read",
        ),
        (
            vec![&*trajectory, "--geometry", &*trajectory],
            "--geometry ",
        ),
    ] {
        refused(&[&arguments[..], &["--out", &out]].concat(), words);
    }
    assert!(
        fs::metadata(&plan).is_ok() && !Path::new(&out).exists(),
        "nothing is begun"
    );
}

#[test]
fn lines_off_the_floor_are_refused_unless_someone_crosses_them() {
    let (_folder, [trajectory, plan, out]) = walkers();
    let with = |line| {
        [
            &trajectory,
            "--geometry",
            &plan,
            "--out",
            &out,
            "--line",
            "0,0,0,2",
            "--line",
            line,
        ]
    };
    let off = "line 2 is in an obstacle or outside of the walkable area, and no one crosses it";
    refused(&with("100,100,105,105"), off);
    refused(&with("0,-1,9,-1"), off);
    let shorter = plan.replace("corridor", "shorter");
    fs::write(&shorter, "POLYGON ((-9 0, 0.5 0, 0.5 2, -9 2, -9 0))").unwrap();
    let mut beyond = with("1,0,1,2");
    beyond[2] = &shorter;
    let output = measure(&beyond);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        program::stderr(&output)
    );
}

/// Measures two people of a survey, 0.35 m apart, whose y begins at `north`, and checks the recording.
fn assert_recorded_finely(north: f64, more: &[&str]) {
    let place = |id: i32, frame: i32| {
        let across = f64::from(id) * 0.35;
        [395_131.0 + 0.05 * f64::from(frame), north + 47.2 + across]
    };
    let rows = (0..20).flat_map(|frame| (1..=2).map(move |id| (id, frame)));
    let rows = rows.map(|(id, frame)| {
        let [x, y] = place(id, frame);
        format!("{id} {frame} {x:.2} {y:.2}\n")
    });
    let text = "# framerate: 25\n# id frame x/m y/m\n".to_owned() + &rows.collect::<String>();
    let (folder, path) = file("utm.txt", &text);
    let out = folder.path().join("m");
    let places = [path.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let output = measure(&[&places[..], more].concat());
    let said = program::stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let origin = format!("less (395100, {north}) m");
    assert!(
        said.contains(&format!(
            "in the recording places are those of the file {origin}"
        )),
        "{said}"
    );
    let recording = Recording::read(&out.join("measured.rrd"));
    let crowd = recording.pairs("world/agents", "Points2D:positions");
    assert_eq!(crowd.len(), 20);
    for (frame, people) in crowd {
        for (k, [x, y]) in people.into_iter().enumerate() {
            let there = place(k as i32 + 1, frame as i32);
            let off = (x + 395_100.0 - there[0]).hypot(y + north - there[1]);
            assert!(off < 0.001, "{frame}: {x} {y} {there:?}");
        }
    }
    let document: rerun::components::Text =
        recording.of_static("info/scenario", "TextDocument:text");
    assert!(document.contains(&origin), "{document:?}");
    if more.is_empty() {
        return;
    }
    let recorded = Recorded::read(&out.join("measured.rrd")).unwrap();
    let walls = recorded.walls().concat();
    let corner = |x: f64, y: f64| walls.iter().any(|p| (p.x - x).hypot(p.y - y) < 0.001);
    assert!(corner(20.0, 40.0) && corner(40.0, 50.0), "{walls:?}");
}

#[test]
fn recordings_far_from_the_origin_are_as_fine_as_the_file_and_say_their_own_origin() {
    // Single precision has steps of 0.5 m there.
    assert_recorded_finely(5_268_300.0, &[]);
    let (folder, plan) = file(
        "plan.wkt",
        "POLYGON ((395120 368340, 395140 368340, 395140 368350, 395120 368350, 395120 368340))",
    );
    let line = ["--line", "395131.5,368346,395131.5,368349"];
    let region = ["--region", "395131,368347,395132,368348"];
    let geometry = ["--geometry", plan.to_str().unwrap()];
    assert_recorded_finely(368_300.0, &[geometry, line, region].concat());
    drop(folder);
}
