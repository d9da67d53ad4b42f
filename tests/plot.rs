//! Plots: both formats of a sheet are complete and have the same size, ticks are round numbers, and nothing is drawn
//! outside of its panel.

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

/// A length; those of an SVG itself are in points.
fn attribute(svg: &str, name: &str) -> f64 {
    let from = svg.find(&format!("{name}=\"")).unwrap() + name.len() + 2;
    let length = svg[from..].find('"').unwrap();
    svg[from..from + length]
        .trim_end_matches("pt")
        .parse()
        .unwrap()
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
    // 150 pixels per inch.
    let pixels = points.map(|size| size * 150.0 / 72.0);
    let differ = [0, 1].map(|k| (f64::from(png_size(&png)[k]) - pixels[k]).abs());
    assert!(differ[0] < 1.0 && differ[1] < 1.0, "{differ:?}");
}

#[test]
fn few_people_are_drawn_as_circles_and_a_crowd_as_an_image() {
    let (few, _) = saved(&sheet(1000));
    assert!(few.matches("<circle").count() >= 1000 && !few.contains("<image"));
    let (crowd, _) = saved(&sheet(2500));
    assert!(crowd.matches("<circle").count() < 100 && crowd.contains("<image"));
    assert!(crowd.len() < 500_000, "{}", crowd.len());
}

#[test]
fn values_beyond_the_range_have_the_colors_of_its_ends() {
    assert_eq!(colors::DENSITY.color(-1.0), colors::DENSITY.color(0.0));
    assert_eq!(colors::DENSITY.color(1e9), colors::DENSITY.color(8.0));
    assert_eq!(colors::SPEED.color(f32::NAN), colors::SPEED.color(0.0));
    assert_ne!(colors::SPEED.color(0.9), colors::SPEED.color(1.8));
}

#[test]
fn the_same_sheet_gives_the_same_bytes() {
    assert_eq!(saved(&sheet(100)), saved(&sheet(100)));
}

/// The SVG and the PNG of a sheet with a single panel without labels.
fn single(x: Axis, y: Axis, marks: Vec<Mark>) -> (String, Vec<u8>) {
    let panel = Panel {
        x,
        y,
        marks,
        ..Panel::default()
    };
    saved(&Sheet {
        title: String::new(),
        row_titles: Vec::new(),
        panels: vec![panel],
        ..sheet(0)
    })
}

fn svg_of(x: Axis, y: Axis, marks: Vec<Mark>) -> String {
    single(x, y, marks).0
}

/// The labels of a horizontal axis.
fn labels(axis: Axis) -> Vec<String> {
    let svg = svg_of(axis, Axis::names("", []), Vec::new());
    let texts = svg.split("<text").skip(1);
    let text = |element: &str| element.lines().nth(1).unwrap().to_owned();
    texts.map(text).filter(|text| !text.is_empty()).collect()
}

#[test]
fn ticks_are_round_numbers_inside_the_range() {
    let linear = |range| labels(Axis::linear("", range));
    assert_eq!(linear([0.0, 8.0]), ["0", "2", "4", "6", "8"]);
    assert_eq!(linear([-25.0, 25.0]), ["\u{2212}20", "0", "20"]);
    assert_eq!(linear([0.0, 0.3 - 1e-9]), ["0", "0.1", "0.2", "0.3"]);
    assert_eq!(linear([-0.3, 0.3]), ["\u{2212}0.2", "0", "0.2"]);
    assert_eq!(
        linear([0.0, 2e6]),
        ["0", "1,000,000", "2,000,000"] // numbers do not cover each other
    );
    assert!(linear([f64::NAN, 1.0]).is_empty());
    let log = |range| labels(Axis::log("", range));
    assert_eq!(log([3.0, 8.0]), ["5"]);
    assert_eq!(log([2_500.0, 100_000.0]), ["10,000", "100,000"]);
    let small = ["1e\u{2212}5", "1e\u{2212}4", "0.001", "0.01", "0.1"];
    assert_eq!(log([1e-5, 0.1]), small);
}

/// The corners of the last shape of this kind and color, in fractions of the panel, right and up.
fn shape(svg: &str, kind: &str, color: [u8; 3]) -> Vec<[f64; 2]> {
    let hex = |[r, g, b]: [u8; 3]| format!("#{r:02X}{g:02X}{b:02X}");
    let points = |kind: &str, color| -> Vec<[f64; 2]> {
        let elements = svg.lines().filter(|line| line.starts_with(kind));
        let mut elements = elements.filter(|line| line.contains(&hex(color)));
        let text = elements
            .next_back()
            .unwrap()
            .split("points=\"")
            .nth(1)
            .unwrap();
        let pairs = text.split('"').next().unwrap().split_whitespace();
        let pair = |pair: &str| {
            let (x, y) = pair.split_once(',').unwrap();
            [x.parse().unwrap(), y.parse().unwrap()]
        };
        pairs.map(pair).collect()
    };
    // The rim of the panel is the last line, from its lower left corner to the right.
    let rim = points("<polyline", BLACK);
    let (low, high) = (rim[0], rim[2]);
    let part = |at: [f64; 2]| [0, 1].map(|k| (at[k] - low[k]) / (high[k] - low[k]));
    points(kind, color).into_iter().map(part).collect()
}

fn ten() -> Axis {
    Axis::linear("", [0.0, 10.0])
}

#[test]
fn a_line_that_leaves_the_panel_stays_straight_and_ends_at_the_rim() {
    for style in [Style::full, Style::broken].map(|style| style(LINES[0], 1.0, "")) {
        let line = Mark::Line(vec![[-5.0, 0.0], [15.0, 10.0]], style);
        let drawn = shape(&svg_of(ten(), ten(), vec![line]), "<polyline", LINES[0]);
        for [x, y] in &drawn {
            assert!((-0.01..=1.01).contains(x), "{drawn:?}");
            assert!((y - (0.25 + 0.5 * x)).abs() < 0.01, "{drawn:?}");
        }
    }
    let log = || Axis::log("", [1.0, 100.0]);
    let line = Mark::Line(vec![[0.1, 0.1], [1e3, 1e3]], Style::full(LINES[0], 1.0, ""));
    let drawn = shape(&svg_of(log(), log(), vec![line]), "<polyline", LINES[0]);
    let off = drawn.iter().zip([0.0, 1.0]);
    let off = off.flat_map(|(at, end)| at.map(|x| (x - end).abs()));
    assert!(
        drawn.len() == 2 && off.fold(0.0, f64::max) < 0.005,
        "{drawn:?}"
    );
}

#[test]
fn an_area_that_leaves_the_panel_is_cut_at_the_rim() {
    let triangle = vec![[0.0, -5.0], [15.0, 10.0], [15.0, -5.0]];
    let svg = svg_of(ten(), ten(), vec![Mark::Area(triangle, GRAY)]);
    let corners = shape(&svg, "<polygon", GRAY);
    let next = corners.iter().cycle().skip(1);
    let twice = corners
        .iter()
        .zip(next)
        .map(|(a, b)| a[0] * b[1] - a[1] * b[0]);
    let area = 0.5 * twice.sum::<f64>().abs();
    // The part inside is half a square with sides of 5.
    assert!((area - 0.125).abs() < 0.004, "{area}");
}

#[test]
fn the_first_row_of_cells_is_at_the_bottom() {
    let map = colors::SPEED.clone();
    let (first, second) = (map.color(0.0), map.color(1.8));
    let cells = Mark::Cells(Cells {
        extent: [[0.0, 0.0], [10.0, 10.0]],
        columns: 1,
        values: vec![Some(0.0), Some(1.8), None],
        map,
    });
    let svg = svg_of(ten(), ten(), vec![cells]);
    let top = |[r, g, b]: [u8; 3]| {
        let color = format!("fill=\"#{r:02X}{g:02X}{b:02X}\"");
        let mut shapes = svg.lines().filter(|line| line.starts_with("<rect"));
        let cell = shapes.rfind(|line| line.contains(&color));
        attribute(cell.unwrap(), " y")
    };
    assert!(top(first) > top(second));
    let rectangles = svg.matches("<rect").count();
    assert_eq!(
        rectangles, 4,
        "the background and three cells, one of them without data"
    );
}

#[test]
fn a_crowd_covers_the_area_of_its_discs() {
    // Not on a regular grid: there, all discs would have the same rounding errors.
    let near =
        |place: usize, k: usize| 0.1 + 0.2 * place as f64 + 0.02 * (0.618 * k as f64).fract();
    let disc = |k: usize| Disc {
        center: [near(k % 50, k), near(k / 50, 3 * k)],
        radius: 0.08,
        color: BLACK,
    };
    // In pixels.
    let black = |count: usize| {
        let marks = vec![Mark::Discs((0..count).map(disc).collect())];
        let (_, png) = single(ten(), ten(), marks);
        let image = image::load_from_memory(&png).unwrap().to_luma8();
        image
            .pixels()
            .map(|p| f64::from(255 - p.0[0]) / 255.0)
            .sum::<f64>()
    };
    // 150 / 72 pixels per point, and 150 points for 10 m.
    let area = 2500.0 * std::f64::consts::PI * (0.08_f64 * 31.25).powi(2);
    let drawn = black(2500) - black(0);
    assert!((drawn / area - 1.0).abs() < 0.03, "{drawn} of {area}");
}
