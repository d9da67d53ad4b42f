//! Plots: both formats of a sheet are complete and have the same size.

use sandbox::output::colors;
use sandbox::output::plot::{
    Axis, BLACK, Cells, ColorBar, Corner, Disc, GRAY, LINES, Mark, Panel, Point, Sheet, Style,
};

/// A sheet with `count` people on a grid and every other kind of mark.
fn sheet(count: usize) -> Sheet {
    let disc = |k: usize| Disc {
        center: [0.1 + 0.2 * (k % 50) as f64, 0.1 + 0.2 * (k / 50) as f64],
        radius: 0.08,
        color: colors::DENSITY.color((k % 8) as f32),
    };
    let people = Panel {
        title: "people".to_owned(),
        x: Axis::linear("x [m]", [0.0, 10.0]),
        y: Axis::linear("y [m]", [0.0, 10.0]),
        marks: vec![
            Mark::Discs((0..count).map(disc).collect()),
            Mark::Area(vec![[8.0, -5.0], [30.0, -5.0], [30.0, 30.0]], GRAY),
        ],
        bar: None,
        legend: None,
    };
    let dots = [1.0, 10.0, 100.0].map(|x| Point {
        x,
        y: x,
        error: 0.2 * x,
    });
    let lines = Panel {
        x: Axis::log("agents", [1.0, 100.0]),
        y: Axis::log("time [ms]", [1.0, 100.0]),
        marks: vec![
            Mark::Line(
                vec![[0.1, 1.0], [1e3, 50.0]],
                Style::broken(LINES[0], 1.0, "theory"),
            ),
            Mark::Points(dots.to_vec(), Style::broken(LINES[1], 2.0, "measured")),
            Mark::Text([10.0, 50.0], "ρ⁰ ± Kᵃᵍ √(k/2)".to_owned(), BLACK),
        ],
        legend: Some(Corner::LowerRight),
        ..people.clone()
    };
    let field = Panel {
        x: Axis::names("k", ["50".to_owned(), "100".to_owned()]),
        y: Axis::linear("t [s]", [0.0, 2.0]),
        marks: vec![Mark::Cells(Cells {
            extent: [[0.0, 0.0], [2.0, 2.0]],
            columns: 2,
            values: vec![Some(0.0), Some(1.0), None, Some(1.8)],
            map: colors::SPEED.clone(),
        })],
        bar: Some(ColorBar {
            label: "speed [m/s]".to_owned(),
            map: colors::SPEED.clone(),
        }),
        ..people.clone()
    };
    Sheet {
        title: "All marks".to_owned(),
        columns: 3,
        panel_size: [150.0, 150.0],
        shared_axes: false,
        row_titles: vec!["row".to_owned()],
        bar: None,
        panels: vec![people, lines, field],
    }
}

fn saved(sheet: &Sheet) -> (String, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let stem = folder.path().join("sheet");
    sheet.save(&stem).unwrap();
    let read = |extension: &str| std::fs::read(stem.with_extension(extension)).unwrap();
    (String::from_utf8(read("svg")).unwrap(), read("png"))
}

/// Width and height from the header of a PNG.
fn png_size(png: &[u8]) -> [u32; 2] {
    [16, 20].map(|at| u32::from_be_bytes(png[at..at + 4].try_into().unwrap()))
}

fn attribute(svg: &str, name: &str) -> u32 {
    let from = svg.find(&format!("{name}=\"")).unwrap() + name.len() + 2;
    let length = svg[from..].find('"').unwrap();
    svg[from..from + length].parse().unwrap()
}

#[test]
fn an_svg_has_all_texts_and_both_formats_have_the_same_size() {
    let (svg, png) = saved(&sheet(100));
    for word in [
        "All marks",
        "x [m]",
        "time [ms]",
        "theory",
        "ρ⁰ ± Kᵃᵍ √(k/2)",
        "speed [m/s]",
    ] {
        assert!(svg.contains(word), "{word}");
    }
    let points = ["width", "height"].map(|name| attribute(&svg, name));
    assert_eq!(png_size(&png), points.map(|size| 2 * size));
}

#[test]
fn few_people_are_drawn_as_circles_and_a_crowd_as_an_image() {
    let (few, _) = saved(&sheet(1000));
    assert!(few.matches("<circle").count() >= 1000 && !few.contains("<image"));
    let (crowd, _) = saved(&sheet(2500));
    assert!(crowd.matches("<circle").count() < 100 && crowd.contains("<image"));
}

#[test]
fn the_same_sheet_gives_the_same_bytes() {
    assert_eq!(saved(&sheet(100)), saved(&sheet(100)));
}
