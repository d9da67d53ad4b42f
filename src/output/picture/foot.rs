//! The scale bar and the legend, below a scene.

use super::agents::{self, Entry};
use super::{Frame, MARGIN, Picture, TEXT_HEIGHT, scene};
use analysis::round;
use figures::plot::{Mark, label_width};

/// The height of a single row, points.
const ROW: f64 = 22.0;
/// The distance between rows, points.
const APART: f64 = 1.15 * TEXT_HEIGHT;
/// The largest width of the scale bar, as a fraction of the panel's width.
const SCALE_BAR: f64 = 0.2;
/// The space between the scale bar and its length, points.
const BESIDE: f64 = 4.0;
/// The width of an entry's sample, and the space after an entry, points.
const SAMPLE: f64 = 14.0;
const GAP: f64 = 12.0;

/// The height of this number of rows, points.
pub fn height(rows: usize) -> f64 {
    ROW + APART * rows.saturating_sub(1) as f64
}

/// The length of the scale bar: 1, 2 or 5 times a power of ten, meters.
fn length(frame: &Frame) -> f64 {
    let longest = SCALE_BAR * (frame.max.x - frame.min.x);
    let decade = 10_f64.powf(longest.log10().floor());
    let mut steps = [5.0, 2.0, 1.0].map(|factor| factor * decade).into_iter();
    steps.find(|step| *step <= longest).unwrap_or(decade)
}

/// The entries of the legend in rows, each with its distance from the left rim, points. The scale bar is before the
/// first.
pub fn rows(picture: &Picture, frame: &Frame, has_paths: bool) -> Vec<Vec<(f64, Entry)>> {
    let length = length(frame);
    let scale = label_width(&format!("{} m", round::text(length)));
    let mut x = MARGIN + length * frame.scale + BESIDE + scale + 2.0 * BESIDE + GAP;
    let mut rows = vec![Vec::new()];
    let most = frame.size()[0] - 2.0 * MARGIN - SAMPLE;
    let entries = agents::legend(picture, has_paths).into_iter();
    for entry in entries.flat_map(|entry| entry.lines(most)) {
        let width = SAMPLE + label_width(&entry.text);
        if x + width > frame.size()[0] && x > MARGIN {
            rows.push(Vec::new());
            x = MARGIN;
        }
        if let Some(row) = rows.last_mut() {
            row.push((x, entry));
        }
        x += width + GAP;
    }
    rows
}

/// The marks of the scale bar and of the legend.
pub fn marks(picture: &Picture, frame: &Frame, has_paths: bool) -> Vec<Mark> {
    let rows = rows(picture, frame, has_paths);
    let count = rows.len();
    let height = |row: usize| {
        let above = (count - 1 - row) as f64 * APART;
        frame.min.y + frame.meters(0.5 * ROW - 2.0 + above)
    };
    let text = |at: [f64; 2], text: String| Mark::label(at, [1, 0], text);
    let (length, first) = (length(frame), height(0));
    let left = frame.min.x + frame.meters(MARGIN);
    let mut marks = scene::scale_bar([left, first], length, frame);
    let beside = left + length + frame.meters(BESIDE);
    marks.push(text([beside, first], format!("{} m", round::text(length))));
    for (k, row) in rows.into_iter().enumerate() {
        for (x, entry) in row {
            let place = [frame.min.x + frame.meters(x), height(k)];
            marks.extend(entry.sample(place, frame));
            let beside = place[0] + frame.meters(SAMPLE);
            marks.push(text([beside, place[1]], entry.text));
        }
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Crowd;
    use engine::math::Vector;
    use engine::scene::{Region, Scene};

    #[test]
    fn on_panels_of_any_width_the_legend_ends_before_the_color_bar() {
        let (scene, crowd) = (Scene::default(), Crowd::default());
        let (min, max) = (Vector::zeros(), Vector::new(2.0, 8.0));
        let picture = Picture::of_scene((&scene, &crowd), String::new(), Region { min, max });
        for width in [100.0, 130.0, 160.0, 190.0, 640.0] {
            let frame = Frame::around([min, max], [width, 300.0], height(4));
            assert!(
                frame.size()[0] <= width + 1e-9,
                "{width}: {:?}",
                frame.size()
            );
            for (x, entry) in rows(&picture, &frame, true).into_iter().flatten() {
                let end = x + SAMPLE + label_width(&entry.text);
                assert!(
                    end <= frame.size()[0],
                    "{width}: {} ends at {end}",
                    entry.text
                );
            }
        }
    }
}
