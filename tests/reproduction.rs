//! `sandbox reproduce`: studies of the paper's tables and figures, and four rows of Table 1 within their bands.

use std::collections::BTreeMap;
use std::fs;
use std::sync::Mutex;

use sandbox::lab::reproduce::{
    Band, Comparison, PRODUCTS, Product, PublishedRow, Ranked, published, rankings, reproduce,
    table1_rows,
};
use sandbox::lab::sweep::{Gathered, Study};
use sandbox::output::document::put_between;
use sandbox::output::plot::text_width;
use sandbox::runs::case::RunResult;
use sandbox::runs::job::{self, Job, Listener, Progress};
use sandbox::runs::store::Store;
use sandbox::scenario::measurements::Snapshot;
use serde_json::{Value, json};
use tempfile::TempDir;

fn store() -> (TempDir, Store) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path()).unwrap();
    (folder, store)
}

fn product(name: &str) -> &'static Product {
    PRODUCTS
        .iter()
        .find(|product| product.name == name)
        .unwrap()
}

#[test]
fn every_product_has_a_unique_name_and_valid_studies() {
    let mut names: Vec<&str> = PRODUCTS.iter().map(|product| product.name).collect();
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count);
    for product in PRODUCTS {
        assert!(!product.about.is_empty());
        for study in product.studies(1).unwrap() {
            assert!(!study.cells.is_empty(), "{}", study.name);
        }
    }
}

#[test]
fn the_studies_of_the_tables_have_the_rows_of_the_paper() {
    let published = published();
    assert!(published.source.contains("10.1016/j.cag.2021.06.005"));
    let [rows1, rows2] = [&published.table1, &published.table2].map(|table| table.rows.len());
    assert_eq!((rows1, rows2), (30, 7));
    let table1 = Study::built_in("table1", Some(1), None).unwrap();
    assert_eq!(table1.cells.len(), published.table1.rows.len());
    for (cell, row) in table1.cells.iter().zip(&published.table1.rows) {
        assert_eq!(cell.value("profile"), Some(&json!(row.profile)));
        let varied = row.varied.as_ref().unwrap();
        let value = cell.value(&varied.setting).and_then(Value::as_f64);
        assert_eq!(value, Some(varied.value));
        assert!(row.evacuated.is_some());
    }
    for (name, times) in [("table2", 1), ("questions_crossing", 3)] {
        let study = Study::built_in(name, Some(1), None).unwrap();
        let rows = published.table2.rows.iter().cycle();
        assert_eq!(study.cells.len(), times * published.table2.rows.len());
        for (cell, row) in study.cells.iter().zip(rows) {
            assert_eq!(cell.value("profile"), Some(&json!(row.profile)), "{name}");
        }
    }
}

#[test]
fn four_rows_of_table_1_stay_inside_their_bands() {
    let (_folder, store) = store();
    // RVO chooses among random candidates, so that results vary between seeds by more than the width of a band.
    let study = Study::built_in("table1", Some(3), None).unwrap();
    let rows = [
        ("sph", 3, 1),
        ("sph", 5, 1),
        ("sf->sph", 4, 1),
        ("rvo+sph", 3, 3),
    ];
    let wanted = |cell: &sandbox::lab::sweep::Cell| {
        rows.iter().any(|(profile, value, seeds)| {
            cell.value("profile") == Some(&json!(profile))
                && cell.value("rest_density_max") == Some(&json!(value))
                && cell.case.seed <= *seeds
        })
    };
    let tally = job::run(&study.jobs(wanted), &store, None, &()).unwrap();
    assert_eq!((tally.finished, tally.failed.len()), (6, 0));
    let gathered = Gathered::of(&study, &store);
    for (mut row, ours) in table1_rows(&gathered)
        .unwrap()
        .into_iter()
        .zip(gathered.combinations())
    {
        for quantity in [&mut row.density, &mut row.deviation, &mut row.flow] {
            quantity.seeds = ours.results.len();
        }
        if !ours.results.is_empty() {
            assert_eq!(row.missed(), Vec::<&str>::new(), "{row:#?}");
        }
    }
}

/// A result with these metrics.
fn result(metrics: &Value) -> RunResult {
    let result = json!({
        "scenario": "crossing", "profile": "sph", "seed": 1, "behaviour_seed": 1, "state_sha256": "",
        "frames": 3000, "time_secs": 60.0, "agents": 0, "metrics": metrics, "contained_moves": 0,
        "clamped_speeds": 0, "displaced_agents": 0, "evacuated": 0, "remaining": 0, "wall_secs": 1.0,
    });
    serde_json::from_value(result).unwrap()
}

/// A rectangle: left, top, right and bottom.
type Extent = [f64; 4];

fn overlap(a: Extent, b: Extent) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let (_, value) = tag.split_once(&format!(" {name}=\"")).unwrap_or_default();
    value.split('"').next().unwrap()
}

/// The texts of an SVG with their extents: from the ascenders to the descenders of the font.
fn texts(svg: &str) -> Vec<(String, Extent)> {
    let tags = svg.split("<text").skip(1);
    let texts = tags.map(|tag| {
        let (tag, content) = tag.split_once('>').unwrap();
        let content = content.split("</text>").next().unwrap().trim().to_owned();
        let [x, y, em] =
            ["x", "y", "font-size"].map(|name| attribute(tag, name).parse::<f64>().unwrap());
        let width = text_width(&content, em);
        let begin = match attribute(tag, "text-anchor") {
            "middle" => -0.5 * width,
            "end" => -width,
            _ => 0.0,
        };
        let baseline = match attribute(tag, "dy") {
            "0.76em" => 0.76 * em,
            "0.5ex" => 0.27 * em,
            other => panic!("{other}"),
        };
        let [left, right] = [begin, begin + width];
        let [top, bottom] = [baseline - 0.76 * em, baseline + 0.24 * em];
        let extent = match attribute(tag, "transform") {
            "" => [x + left, y + top, x + right, y + bottom],
            turned => {
                assert!(turned.starts_with("rotate(270"), "{turned}");
                [x + top, y - right, x + bottom, y - left]
            }
        };
        (content, extent)
    });
    texts.filter(|(content, _)| !content.is_empty()).collect()
}

/// The frames of panels and of color bars: closed black lines of four corners.
fn frames(svg: &str) -> Vec<Extent> {
    let tags = svg.split("<polyline").skip(1);
    let tags = tags.filter(|tag| attribute(tag, "stroke") == "#000000");
    let points = tags.map(|tag| attribute(tag.split('>').next().unwrap(), "points"));
    let corners = points.map(|points| -> Vec<[f64; 2]> {
        let pairs = points
            .split_whitespace()
            .map(|pair| pair.split_once(',').unwrap());
        pairs
            .map(|(x, y)| [x, y].map(|one| one.parse().unwrap()))
            .collect()
    });
    let closed = corners.filter(|corners| corners.len() == 5 && corners[0] == corners[4]);
    let extents = closed.map(|c| {
        [
            c[0][0].min(c[2][0]),
            c[0][1].min(c[2][1]),
            c[0][0].max(c[2][0]),
            c[0][1].max(c[2][1]),
        ]
    });
    extents.collect()
}

/// The SVG of a figure of snapshots, with one agent in each of them.
fn figure_of_one_agent(name: &str) -> String {
    let (folder, store) = store();
    let product = product(name);
    let studies = product.studies(1).unwrap();
    let one = json!({"time_secs": 15.0, "x": [15.0], "y": [10.0], "radius": [0.24], "speed": [1.0], "density": [4.0]});
    let times = [15.0, 45.0, 150.0, 150.3, 151.0, 152.0, 153.0, 154.0, 156.0];
    let data: BTreeMap<String, Value> = times
        .map(|time| (Snapshot::name(time), one.clone()))
        .into_iter()
        .collect();
    let jobs: Vec<Job> = studies[0]
        .cells
        .iter()
        .map(|cell| {
            let mut kept = result(&json!({}));
            kept.summary.data = data.clone();
            let work = move |_: Progress| Ok::<_, String>(kept.clone());
            Job::new(cell.to_string(), cell.case.key.clone(), 1.0, work)
        })
        .collect();
    job::run(&jobs, &store, None, &()).unwrap();
    let found = reproduce(&[product], 1, &store, &()).unwrap();
    found[0].write(folder.path()).unwrap();
    fs::read_to_string(folder.path().join(format!("{name}.svg"))).unwrap()
}

#[test]
fn titles_in_figures_overlap_neither_each_other_nor_a_panel() {
    for (name, panels) in [
        ("fig5", 24),
        ("fig6", 6),
        ("fig7", 36),
        ("fig8", 2),
        ("fig9", 12),
        ("fig10", 2),
    ] {
        let svg = figure_of_one_agent(name);
        let (texts, frames) = (texts(&svg), frames(&svg));
        assert_eq!(frames.len(), panels + 1, "{name}");
        for (k, (content, extent)) in texts.iter().enumerate() {
            for (other, covered) in &texts[..k] {
                assert!(
                    !overlap(*extent, *covered),
                    "{name}: {content:?}, {other:?}"
                );
            }
            for &frame in &frames {
                assert!(
                    !overlap(*extent, frame),
                    "{name}: {content:?} {extent:?} {frame:?}"
                );
            }
        }
        // A title above a panel is nearer to it than to the panel above it.
        let titles = texts.iter().filter(|(content, _)| content.starts_with('('));
        for (title, [left, top, right, bottom]) in titles {
            let middle = 0.5 * (left + right);
            let column = frames
                .iter()
                .filter(|frame| frame[0] < middle && middle < frame[2]);
            let gaps = column.map(|frame| [top - frame[3], frame[1] - bottom]);
            let gaps: Vec<[f64; 2]> = gaps.collect();
            if gaps.is_empty() {
                continue; // a title beside a row
            }
            let least = |k: usize| {
                gaps.iter()
                    .map(|gap| gap[k])
                    .filter(|gap| *gap >= 0.0)
                    .fold(f64::INFINITY, f64::min)
            };
            assert!(least(1) < least(0), "{name}: {title}: {gaps:?}");
        }
    }
}

/// Counts the runs that begin and that are kept.
#[derive(Default)]
struct Begun(Mutex<Vec<[usize; 2]>>);

impl Listener for Begun {
    fn begins(&self, jobs: usize, kept: usize, _: f64) {
        self.0.lock().unwrap().push([jobs, kept]);
    }
}

#[test]
fn tables_are_written_in_three_formats_from_kept_results() {
    let (folder, store) = store();
    let table2 = product("table2");
    let studies = table2.studies(1).unwrap();
    // Kept results as runs write them, but with the numbers of the paper.
    let paper = published().table2.rows;
    let job = |(cell, row): (&sandbox::lab::sweep::Cell, &PublishedRow)| {
        let metrics = json!({
            "density_mean_45s": row.density,
            "density_std_45s": row.deviation,
            "flow_first_60s_per_s": row.flow,
        });
        let work = move |_: Progress| Ok::<_, String>(result(&metrics));
        Job::new(cell.to_string(), cell.case.key.clone(), 1.0, work)
    };
    let jobs: Vec<Job> = studies[0].cells.iter().zip(&paper).map(job).collect();
    assert_eq!(job::run(&jobs, &store, None, &()).unwrap().finished, 7);
    let begun = Begun::default();
    let found = reproduce(&[table2], 1, &store, &begun).unwrap();
    found[0].write(folder.path()).unwrap();
    let (_, said) = found[0].document.parts("table2").remove(0);
    assert_eq!(begun.0.into_inner().unwrap(), [[0, 7]]);
    assert!(
        said.contains("| RVO→SPH | 3.83 | 3.83 | +0.0 % |"),
        "{said}"
    );
    assert!(!said.contains("broken"), "{said}");
    let read = |file: &str| fs::read_to_string(folder.path().join(file)).unwrap();
    assert!(read("table2.md").ends_with(&said));
    assert_eq!(read("table2.csv").lines().count(), 1 + 7 * 3);
    let json: Value = serde_json::from_str(&read("table2.json")).unwrap();
    assert_eq!(json["rows"].as_array().unwrap().len(), 7);
    let rankings = json["rankings"].as_array().unwrap();
    assert!(rankings.iter().all(|ranking| ranking["kept"] == true));
    assert!(store.is_begun());
}

#[test]
fn a_row_is_kept_up_to_the_border_of_its_band() {
    let kept = |paper, ours, band| Comparison::new(paper, &[Some(ours)], Some(band)).is_kept();
    assert_eq!(kept(4.0, 4.06, Band::Relative(0.015)), Some(true));
    assert_eq!(kept(4.0, 3.94, Band::Relative(0.015)), Some(true));
    assert_eq!(kept(4.0, 4.061, Band::Relative(0.015)), Some(false));
    assert_eq!(kept(0.27, 0.39, Band::Absolute(0.12)), Some(true));
    assert_eq!(kept(0.27, 0.14, Band::Absolute(0.12)), Some(false));
    assert_eq!(Comparison::new(4.0, &[Some(4.0)], None).is_kept(), None);
}

#[test]
fn a_seed_without_a_value_misses_the_band_and_is_told() {
    let values = [Some(1.0), None, Some(3.0)];
    let flow = Comparison::new(2.0, &values, Some(Band::Relative(0.25)));
    assert_eq!(flow.relative(), Some(0.0));
    assert_eq!(flow.is_kept(), Some(false));
    assert_eq!(flow.ours_written(), "2.00 ± 1.41 (2 of 3)");
    let nothing = Comparison::new(2.0, &[None], Some(Band::Relative(0.25)));
    assert_eq!(nothing.is_kept(), Some(false));
    assert_eq!(nothing.ours_written(), "–");
    assert_eq!(nothing.difference_written(), "–");
}

fn ranked(name: &str, paper: f64, ours: &[f64]) -> Ranked {
    Ranked {
        name: name.to_owned(),
        paper,
        ours: ours.iter().copied().map(Some).collect(),
    }
}

#[test]
fn only_rows_more_than_a_tenth_apart_are_ranked() {
    let rows = [
        ranked("a", 1.0, &[1.0, 3.0]),
        ranked("b", 1.1, &[1.0, 1.0]),
        ranked("c", 1.2, &[1.5, 0.5]),
    ];
    let found = rankings("flow", &rows);
    assert_eq!(found.len(), 1);
    let ranking = &found[0];
    assert_eq!([&*ranking.higher, &*ranking.lower], ["c", "a"]);
    assert_eq!(ranking.ours, Some([1.0, 2.0]));
    assert_eq!(ranking.seeds, [1, 2]);
    assert!(!ranking.is_kept());
}

#[test]
fn a_row_without_a_value_keeps_no_ranking() {
    let mut lost = ranked("high", 2.0, &[2.0, 2.0]);
    lost.ours[1] = None;
    let found = rankings("flow", &[lost, ranked("low", 1.0, &[1.0, 1.0])]);
    assert_eq!(found[0].ours, None);
    assert_eq!(found[0].seeds, [1, 2]);
    assert!(!found[0].is_kept());
}

#[test]
fn a_text_takes_the_place_of_the_one_before_it() {
    let document = "a\n<!-- t -->\nold\n<!-- /t -->\nb\n";
    let once = put_between(document, "t", "new\n").unwrap();
    assert_eq!(once, "a\n<!-- t -->\n\nnew\n\n<!-- /t -->\nb\n");
    assert_eq!(put_between(&once, "t", "new").unwrap(), once);
    assert_eq!(put_between(document, "u", "new"), None);
}
