//! Pictures of studies: measurements over one or two settings.

use std::fs;

use sandbox::lab::sweep::{Drawing, DrawingError, Gathered, Shard, Study, run};
use sandbox::output::plot::{Cells, Mark, Panel, Point, Sheet};
use sandbox::runs::store::Store;
use tempfile::TempDir;

use crate::common::pictures;
use crate::common::sweep::folder;

const STUDY: &str = r#"{"scenario": "room.json", "seeds": 3,
    "grid": {"gas_constant": [200, 100, 400], "viscosity": [0, 5], "profile": ["sph", "sf->sph"]}}"#;

fn studied() -> (TempDir, Study, Store) {
    let (folder, path) = folder(STUDY);
    let study = Study::read(&path, None).unwrap();
    let store = Store::open(&folder.path().join("out")).unwrap();
    run(&study, Shard::WHOLE, &store, &()).unwrap();
    (folder, study, store)
}

fn drawing(measurements: &[&str], over: &[&str]) -> Drawing {
    let texts = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect();
    Drawing {
        measurements: texts(measurements),
        over: texts(over),
    }
}

/// The points of the lines of a panel, with their labels.
fn lines(panel: &Panel) -> Vec<(String, Vec<Point>)> {
    let points = panel.marks.iter().filter_map(|mark| match mark {
        Mark::Points(points, style) => Some((style.label.clone(), points.clone())),
        _ => None,
    });
    points.collect()
}

fn cells(panel: &Panel) -> &Cells {
    let cells = panel.marks.iter().find_map(|mark| match mark {
        Mark::Cells(cells) => Some(cells),
        _ => None,
    });
    cells.unwrap()
}

fn sheet(gathered: &Gathered, drawing: &Drawing) -> Sheet {
    gathered.sheet(drawing).unwrap().unwrap()
}

#[test]
fn lines_pass_through_the_means_over_seeds_in_ascending_order() {
    let (_folder, study, store) = studied();
    let gathered = Gathered::of(&study, &store);
    let sheet = sheet(&gathered, &drawing(&["density_mean_0.2s"], &[]));
    let [panel] = sheet.panels.as_slice() else {
        panic!("{} panels", sheet.panels.len());
    };
    assert_eq!(
        (panel.x.label.as_str(), panel.y.label.as_str()),
        ("gas_constant", "density_mean_0.2s")
    );
    let lines = lines(panel);
    let labels: Vec<&str> = lines.iter().map(|(label, _)| label.as_str()).collect();
    let expected = [
        "viscosity=0, sph",
        "viscosity=0, sf->sph",
        "viscosity=5, sph",
        "viscosity=5, sf->sph",
    ];
    assert_eq!(labels, expected);
    for (number, (label, points)) in lines.iter().enumerate() {
        let x: Vec<f64> = points.iter().map(|point| point.x).collect();
        assert_eq!(x, [100.0, 200.0, 400.0], "{label}");
        // The study lists 200, 100, 400; four combinations of the others follow each of them.
        let combinations = gathered.combinations();
        for (point, first) in points.iter().zip([4, 0, 8]) {
            let values = combinations[first + number].values("density_mean_0.2s");
            let mean = values.iter().flatten().sum::<f64>() / 3.0;
            assert!((point.y - mean).abs() < 1e-12, "{label}: {point:?}, {mean}");
            let [low, high] = panel.y.range;
            assert!(low < point.y && point.y < high);
        }
    }
}

#[test]
fn bands_reach_over_the_confidence_intervals() {
    let (_folder, study, store) = studied();
    let gathered = Gathered::of(&study, &store);
    let sheet = sheet(
        &gathered,
        &drawing(&["density_mean_0.2s"], &["gas_constant"]),
    );
    let marks = &sheet.panels[0].marks;
    let bands: Vec<&Vec<[f64; 2]>> = marks
        .iter()
        .filter_map(|mark| match mark {
            Mark::Area(corners, _) => Some(corners),
            _ => None,
        })
        .collect();
    assert_eq!(bands.len(), 4);
    for (band, (_, points)) in bands.iter().zip(lines(&sheet.panels[0])) {
        assert_eq!(band.len(), 6);
        for (k, point) in points.iter().enumerate() {
            let ([x, upper], [other, lower]) = (band[k], band[5 - k]);
            assert_eq!([x, other], [point.x; 2]);
            assert!((0.5 * (upper + lower) - point.y).abs() < 1e-12 && upper > lower);
        }
    }
}

#[test]
fn maps_have_each_mean_in_the_cell_of_its_two_values() {
    let (_folder, study, store) = studied();
    let gathered = Gathered::of(&study, &store);
    let sheet = sheet(
        &gathered,
        &drawing(&["density_mean_0.2s"], &["gas_constant", "viscosity"]),
    );
    let titles: Vec<&str> = sheet
        .panels
        .iter()
        .map(|panel| panel.title.as_str())
        .collect();
    assert_eq!(titles, ["sph", "sf->sph"]);
    let combinations = gathered.combinations();
    for (profile, panel) in sheet.panels.iter().enumerate() {
        let cells = cells(panel);
        assert_eq!((cells.columns, cells.values.len()), (3, 6));
        for (column, first) in [4, 0, 8].into_iter().enumerate() {
            for row in 0..2 {
                let values = combinations[first + 2 * row + profile].values("density_mean_0.2s");
                let mean = values.iter().flatten().sum::<f64>() / 3.0;
                let drawn = cells.values[3 * row + column].unwrap();
                assert!((drawn - mean).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn settings_that_are_objects_have_labels_without_json() {
    let speeds =
        r#"[1.3, {"normal": {"mean": 1.3, "std": 0.2}}, {"normal": {"mean": 1.1, "std": 0.2}}]"#;
    let grid = format!(r#"{{"grids.0.preferred_speed": {speeds}, "viscosity": [0, 5]}}"#);
    let (folder, path) = folder(&format!(r#"{{"scenario": "room.json", "grid": {grid}}}"#));
    let study = Study::read(&path, None).unwrap();
    let store = Store::open(&folder.path().join("out")).unwrap();
    run(&study, Shard::WHOLE, &store, &()).unwrap();
    let gathered = Gathered::of(&study, &store);
    let over = sheet(&gathered, &drawing(&[], &["grids.0.preferred_speed"]));
    let ticks = over.panels[0].x.ticks.iter();
    let ticks: Vec<&str> = ticks.map(|(_, name)| name.as_str()).collect();
    let expected = [
        "1.3",
        "normal(mean=1.3, std=0.2)",
        "normal(mean=1.1, std=0.2)",
    ];
    assert_eq!(ticks, expected);
    let other = sheet(&gathered, &drawing(&["density_mean_0.2s"], &["viscosity"]));
    let lines = lines(&other.panels[0]).into_iter();
    let names: Vec<String> = lines.map(|(name, _)| name).collect();
    let expected = expected.map(|value| format!("grids.0.preferred_speed={value}"));
    assert_eq!(names, expected);
}

#[test]
fn what_cannot_be_drawn_is_refused_with_what_can() {
    let (_folder, study, store) = studied();
    let unknown = drawing(&[], &["pressure"]).check(&study).unwrap_err();
    assert!(
        unknown
            .to_string()
            .ends_with("it varies gas_constant, viscosity, profile"),
        "{unknown}"
    );
    let three = drawing(&[], &["gas_constant", "viscosity", "profile"]).check(&study);
    assert_eq!(three, Err(DrawingError::Settings(3)));
    let gathered = Gathered::of(&study, &store);
    let unknown = gathered.sheet(&drawing(&["flow"], &[])).unwrap_err();
    assert!(
        unknown
            .to_string()
            .contains("density_mean_0.2s, density_std_0.2s"),
        "{unknown}"
    );
}

#[test]
fn pictures_are_written_beside_the_tables_and_without_numbers_the_axis_has_names() {
    let (folder, path) =
        folder(r#"{"scenario": "room.json", "grid": {"profile": ["sph", "sf->sph"]}}"#);
    let study = Study::read(&path, None).unwrap();
    let store = Store::open(&folder.path().join("out")).unwrap();
    run(&study, Shard::WHOLE, &store, &()).unwrap();
    let gathered = Gathered::of(&study, &store);
    let sheet = sheet(&gathered, &Drawing::default());
    let names: Vec<&str> = sheet.panels[0]
        .x
        .ticks
        .iter()
        .map(|(_, name)| name.as_str())
        .collect();
    assert_eq!(names, ["sph", "sf->sph"]);
    let findings = gathered.findings(Some(sheet.clone())).unwrap();
    let written = findings.write(store.folder()).unwrap();
    let known = study.names().in_folder();
    let names = written.iter().map(|path| path.file_name().unwrap());
    assert!(
        names
            .clone()
            .all(|name| known.contains(&name.to_str().unwrap().to_owned()))
    );
    // Every result is in the files.
    let read = |ending: &str| {
        let path = written
            .iter()
            .find(|path| path.extension().unwrap() == ending);
        fs::read_to_string(path.unwrap()).unwrap()
    };
    let (rows, texts) = (read("csv"), read("svg"));
    for combination in gathered.combinations() {
        for value in combination
            .values("density_mean_0.2s")
            .into_iter()
            .flatten()
        {
            assert!(rows.contains(&value.to_string()), "no {value} in {rows}");
        }
    }
    let texts = pictures::texts(&texts);
    for name in ["sph", "sf->sph", "profile"] {
        let name = name.replace('>', "&gt;");
        assert!(texts.contains(&name), "no {name} in {texts:?}");
    }
}
