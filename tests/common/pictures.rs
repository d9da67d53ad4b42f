//! Reads pictures by their content: circles, texts, and where agents are drawn.

use std::path::Path;

use super::page::from_base64;

/// The SVGs in an HTML document, with their captions.
pub fn figures(html: &str) -> Vec<(String, String)> {
    let figures = html.split("<figure>").skip(1);
    let figure = |text: &str| {
        let (_, data) = text.split_once("data:image/svg+xml;base64,").unwrap();
        let (data, rest) = data.split_once('"').unwrap();
        let (_, caption) = rest.split_once("<figcaption>").unwrap();
        let (caption, _) = caption.split_once("</figcaption>").unwrap();
        let svg = String::from_utf8(from_base64(data)).unwrap();
        (svg, caption.to_owned())
    };
    figures.map(figure).collect()
}

/// The value of an attribute of an SVG's element.
fn attribute(element: &str, name: &str) -> f64 {
    let (_, rest) = element.split_once(&format!(" {name}=\"")).unwrap();
    rest.split_once('"').unwrap().0.parse().unwrap()
}

/// The centers of the circles of an SVG, in the order in which they are drawn.
pub fn circles(svg: &str) -> Vec<[f64; 2]> {
    let elements = svg.split("<circle").skip(1);
    elements
        .map(|element| ["cx", "cy"].map(|name| attribute(element, name)))
        .collect()
}

/// The texts of an SVG.
pub fn texts(svg: &str) -> Vec<String> {
    let elements = svg.split("<text").skip(1);
    let text = |element: &str| {
        let (_, rest) = element.split_once('>').unwrap();
        rest.split_once("</text>").unwrap().0.trim().to_owned()
    };
    elements.map(text).collect()
}

/// The different ones of the centers of circles: an agent is one with a rim of another color.
pub fn different(circles: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut all: Vec<[f64; 2]> = Vec::new();
    for &center in circles {
        if !all.contains(&center) {
            all.push(center);
        }
    }
    all
}

/// The least and the greatest of the `k`-th coordinates.
fn ends(points: &[[f64; 2]], k: usize) -> [f64; 2] {
    let values = points.iter().map(|point| point[k]);
    let low = values.clone().fold(f64::INFINITY, f64::min);
    [low, values.fold(f64::NEG_INFINITY, f64::max)]
}

/// Checks that the circles of a picture, in units with y down, are these places, meters, in one scale.
pub fn assert_drawn(circles: &[[f64; 2]], places: &[[f64; 2]], about: &str) {
    let drawn = different(circles);
    assert_eq!(drawn.len(), places.len(), "{about}");
    let [[left, right], [_, low]] = [0, 1].map(|k| ends(&drawn, k));
    let [[from, to], [foot, _]] = [0, 1].map(|k| ends(places, k));
    let scale = (right - left) / (to - from);
    for [x, y] in places {
        let at = [left + scale * (x - from), low - scale * (y - foot)];
        let near = drawn
            .iter()
            .any(|one| (one[0] - at[0]).hypot(one[1] - at[1]) < 4.0);
        assert!(near, "{about}: nobody is drawn at ({x}, {y}), {at:?}");
    }
}

/// The texts of a picture that is written as SVG and as PNG. Checks that both have the same shape, and that the PNG has
/// marks on its ground.
pub fn texts_of(stem: &Path) -> Vec<String> {
    let svg = std::fs::read_to_string(stem.with_added_extension("svg")).unwrap();
    let size = ["width", "height"].map(|name| {
        let (_, rest) = svg.split_once(&format!("{name}=\"")).unwrap();
        rest.split_once("pt\"").unwrap().0.parse::<f64>().unwrap()
    });
    let png = image::open(stem.with_added_extension("png"))
        .unwrap()
        .to_rgb8();
    let [width, height] = [png.width(), png.height()].map(f64::from);
    assert!(
        (width / height / (size[0] / size[1]) - 1.0).abs() < 0.02,
        "{size:?}"
    );
    let marks = png.pixels().filter(|pixel| pixel.0 != [255; 3]).count() as f64;
    assert!(
        marks > 0.01 * width * height,
        "{}: {marks} pixels",
        stem.display()
    );
    texts(&svg)
}

/// Checks that a picture that is written as SVG and as PNG has these texts.
pub fn assert_has(stem: &Path, wanted: &[&str]) {
    let texts = texts_of(stem);
    for text in wanted {
        assert!(
            texts.iter().any(|one| one.contains(text)),
            "{}: no {text} in {texts:?}",
            stem.display()
        );
    }
}
