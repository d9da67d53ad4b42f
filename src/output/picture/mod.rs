//! A picture of a scene at one moment: floor and walls, places, zones, agents; and the ways to a destination.

mod forces;
mod labels;
mod paths;
mod scene;

pub use paths::Paths;

use crate::engine::math::{Vector, bounds};
use crate::engine::scene::Region;
use crate::engine::simulation::Simulation;
use crate::output::colors::Rgb;
use crate::output::plot::{Axis, LABEL_SIZE, Label, Mark, Panel, PlotError, Sheet};
use crate::output::scenery;
use labels::{Labels, width_of};

/// The largest panel, points: alone, and one of several.
const ALONE: [f64; 2] = [640.0, 460.0];
const OF_SEVERAL: [f64; 2] = [440.0, 340.0];
/// The smallest panel, points.
const SMALLEST: [f64; 2] = [200.0, 110.0];
/// Around what is shown, points.
const MARGIN: f64 = 10.0;
/// Below it, for the scale bar and the legend, points.
const FOOT: f64 = 22.0;
/// The scale bar is at most this part of the panel's width.
const SCALE_BAR: f64 = 0.2;

/// A picture of a scene.
pub struct Picture<'a> {
    /// Its title.
    pub title: String,
    /// What it shows, in its current frame, which must be evaluated.
    pub simulation: &'a Simulation,
    /// The part of the plane that it shows at least.
    pub view: Region,
    /// The ways that it shows, each in its own panel.
    pub paths: Vec<Paths>,
    /// The mass of an average person, kg, if walls are colored by the force on them.
    pub body_mass: Option<f64>,
}

/// The part of the plane that a panel shows, and its size.
#[derive(Debug, Clone, Copy)]
struct Frame {
    min: Vector,
    max: Vector,
    /// Points per meter.
    scale: f64,
}

impl Frame {
    /// Around a part of the plane, in a panel of at most `most` points.
    fn around([low, high]: [Vector; 2], most: [f64; 2]) -> Self {
        let room = [most[0] - 2.0 * MARGIN, most[1] - MARGIN - FOOT];
        let extent = high - low;
        let scale = (room[0] / extent.x).min(room[1] / extent.y);
        let lengths = [0, 1].map(|k| (extent[k] * scale).max(SMALLEST[k]) / scale);
        let more = (Vector::from(lengths) - extent) * 0.5;
        let margin = |x: f64, y: f64| Vector::new(x, y) / scale;
        Self {
            min: low - more - margin(MARGIN, FOOT),
            max: high + more + margin(MARGIN, MARGIN),
            scale,
        }
    }

    /// A length in points, in meters.
    fn meters(&self, points: f64) -> f64 {
        points / self.scale
    }

    fn size(&self) -> [f64; 2] {
        ((self.max - self.min) * self.scale).into()
    }
}

impl Picture<'_> {
    /// Writes the picture: a PNG if the name ends in .png, else an SVG.
    ///
    /// # Errors
    /// It cannot be drawn, or the file cannot be written.
    pub fn save(&self, path: &std::path::Path) -> Result<(), PlotError> {
        self.sheet().save_as(path)
    }

    /// The picture as a sheet.
    pub fn sheet(&self) -> Sheet {
        let shown = self.shown();
        let most = if self.paths.len() > 1 {
            OF_SEVERAL
        } else {
            ALONE
        };
        let frame = Frame::around(shown, most);
        let panels = match self.paths.as_slice() {
            [] => vec![self.panel(&frame, None)],
            paths => paths
                .iter()
                .map(|paths| self.panel(&frame, Some(paths)))
                .collect(),
        };
        Sheet {
            title: self.title.clone(),
            columns: if panels.len() > 1 { 2 } else { 1 },
            panel_size: frame.size(),
            panels,
            ..Sheet::default()
        }
    }

    /// The view, with all places and zones.
    fn shown(&self) -> [Vector; 2] {
        let Region { min, max } = self.view;
        let journeys = &self.simulation.scene().journeys;
        let places = journeys.places.iter().flat_map(scenery::lines);
        let zones = journeys.zones.iter().flat_map(|zone| zone.area.points());
        let points = places.chain(zones.copied()).chain([min, max]);
        bounds(points).unwrap_or([min, max])
    }

    fn panel(&self, frame: &Frame, paths: Option<&Paths>) -> Panel {
        let mut labels = Labels::new(frame);
        let mut below = scene::ground(self.simulation);
        let mut above = Vec::new();
        let drawn = paths.map(|paths| paths.draw(self.simulation, frame));
        let (title, bar) = match drawn {
            Some(drawn) => {
                below.extend(drawn.field);
                above = drawn.lines;
                (drawn.title, Some(drawn.bar))
            }
            None => {
                below.extend(scene::tints(self.simulation));
                let bar = self.body_mass.map(|_| forces::bar());
                (scene::summary(self.simulation), bar)
            }
        };
        below.extend(scene::agents(self.simulation, paths.is_some()));
        let mut marks = vec![Mark::Group(below)];
        marks.extend(scene::walls(self.simulation));
        let body_mass = self.body_mass.filter(|_| paths.is_none());
        marks.extend(
            body_mass
                .into_iter()
                .flat_map(|mass| forces::marks(self.simulation, mass)),
        );
        let inside = paths.is_none();
        marks.extend(scene::zones(self.simulation, frame, inside, &mut labels));
        marks.extend(scene::sources(self.simulation, &mut labels));
        marks.append(&mut above);
        marks.extend(scene::places(self.simulation, frame, &mut labels));
        marks.extend(scene::goals(self.simulation, frame, &mut labels));
        marks.extend(labels.into_marks());
        marks.extend(self.foot(frame, paths.is_some()));
        Panel {
            title,
            x: Axis::linear("x [m]", [frame.min.x, frame.max.x]),
            y: Axis::linear("y [m]", [frame.min.y, frame.max.y]),
            marks,
            bar,
            legend: None,
        }
    }

    /// The scale bar and the legend.
    fn foot(&self, frame: &Frame, has_paths: bool) -> Vec<Mark> {
        let y = frame.min.y + frame.meters(0.5 * FOOT - 2.0);
        let mut x = frame.min.x + frame.meters(MARGIN);
        let longest = SCALE_BAR * (frame.max.x - frame.min.x);
        let decade = 10_f64.powf(longest.log10().floor());
        let steps = [5.0, 2.0, 1.0].map(|factor| factor * decade);
        let length = steps
            .into_iter()
            .find(|step| *step <= longest)
            .unwrap_or(decade);
        let mut marks = scene::scale_bar([x, y], length, frame);
        let mut text = |x: f64, text: String, color: Rgb| {
            let width = frame.meters(width_of(&text));
            marks.push(Mark::Label(Label {
                at: [x, y],
                side: [1, 0],
                text,
                color,
            }));
            x + width
        };
        x = text(
            x + length + frame.meters(4.0),
            format!("{length} m"),
            [0; 3],
        );
        x += frame.meters(16.0);
        let entries = scene::legend(self.simulation, has_paths);
        let mut samples = Vec::new();
        for entry in entries {
            let width = frame.meters(14.0 + width_of(&entry.text));
            if x + width > frame.max.x {
                break;
            }
            samples.push(entry.sample([x, y], frame));
            x = text(x + frame.meters(14.0), entry.text, [0; 3]) + frame.meters(12.0);
        }
        marks.extend(samples.into_iter().flatten());
        marks
    }
}

/// A darker color, for text.
fn dark(color: Rgb) -> Rgb {
    color.map(|value| (f64::from(value) * 0.62) as u8)
}

/// A lighter color, for areas.
fn light(color: Rgb, part: f64) -> Rgb {
    color.map(|value| (255.0 - part * (255.0 - f64::from(value))) as u8)
}

fn xy(p: Vector) -> [f64; 2] {
    p.into()
}

/// The height of a label, points.
const TEXT_HEIGHT: f64 = 1.2 * LABEL_SIZE;
