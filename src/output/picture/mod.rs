//! A picture of a crowd at one moment: floor and walls, places, zones, agents, their paths, a field; or the routes to a
//! destination.

mod agents;
mod crowd;
mod foot;
mod forces;
mod paths;
mod regions;
mod scene;

pub use crowd::{Crowd, Trails};
pub use paths::Paths;

use crate::drawing::{Drawing, Drawn};
use crate::labels::{Labels, Placed, Screen, along_lines};
use crate::scenery;
use engine::math::{Vector, bounds};
use engine::scene::{Region, Scene};
use engine::simulation::Simulation;
use figures::colors::{ColorMap, Rgb};
use figures::plot::{
    Axis, Cells, ColorBar, LABEL_SIZE, Label as Text, Mark, Panel, PlotError, Print, Sheet, Style,
    label_width,
};
use scenario::floor_plan::Label;
use scenario::measurements::Observed;

/// The largest panel, points: alone, and one of several.
const ALONE: [f64; 2] = [640.0, 460.0];
const OF_SEVERAL: [f64; 2] = [440.0, 340.0];
/// Scenes are wide if their width is more than this many times their height.
const WIDE: f64 = 1.3;
/// The smallest panel, points.
const SMALLEST: [f64; 2] = [150.0, 90.0];
/// The least width and height of a scene on narrow sheets, points.
const LEAST: f64 = 40.0;
/// The color of texts.
const NAME: Rgb = [90, 92, 100];
/// The width of the line from a label to its point, points.
const LEADER: f64 = 0.4;
/// The margin around the scene, points.
const MARGIN: f64 = 10.0;

/// A picture of a crowd.
pub struct Picture<'a> {
    /// Its title.
    pub title: String,
    /// The line above its panel; `None`: the time and the number of agents.
    pub heading: Option<String>,
    /// Walls and places.
    pub scene: &'a Scene,
    /// The people.
    pub crowd: &'a Crowd,
    /// The simulation of these people, in the same order, if there is one: for their activities, for open and closed
    /// places, for routes and forces on walls. Its frame must be evaluated.
    pub simulation: Option<&'a Simulation>,
    /// The numbers of places that are closed, without a simulation.
    pub closed: &'a [usize],
    /// The part of the plane that it shows at least.
    pub view: Region,
    /// The colors of people; `None`: by their activities.
    pub coloring: Option<Coloring>,
    /// A field below the people; their discs are then small.
    pub field: Option<Field>,
    /// The paths of the last seconds.
    pub trails: Option<&'a Trails>,
    /// The places that measurements observe, with names.
    pub observed: &'a [(String, Observed)],
    /// Texts.
    pub labels: &'a [Label],
    /// The routes that it shows, each in its own panel.
    pub paths: Vec<Paths>,
    /// The mass of an average person, kg, if walls are colored by the force on them.
    pub body_mass: Option<f64>,
    /// How the levels of a building lie in it: its scene, people, texts and observed places are drawn so.
    pub drawing: Option<&'a Drawing>,
}

/// The colors of people by a quantity.
#[derive(Debug, Clone)]
pub struct Coloring {
    /// The value of each person; NaN if unknown.
    pub values: Vec<f64>,
    /// The meaning of the colors.
    pub bar: ColorBar,
}

/// A field.
#[derive(Debug, Clone)]
pub struct Field {
    /// Its values.
    pub cells: Cells,
    /// The meaning of the colors.
    pub bar: ColorBar,
}

/// The part of the plane that a panel shows, and its size.
#[derive(Debug, Clone, Copy)]
struct Frame {
    min: Vector,
    max: Vector,
    /// Points per meter.
    scale: f64,
    /// The height of the space for the scale bar and the legend, points.
    foot: f64,
}

impl Frame {
    /// A frame around a part of the plane, in a panel of at most `most` points, `foot` of which are below it.
    fn around([low, high]: [Vector; 2], most: [f64; 2], foot: f64) -> Self {
        let inner = [most[0] - 2.0 * MARGIN, most[1] - MARGIN - foot];
        let room = inner.map(|room| room.max(LEAST));
        let extent = high - low;
        let scale = (room[0] / extent.x).min(room[1] / extent.y);
        let lengths = [0, 1].map(|k| (extent[k] * scale).max(SMALLEST[k].min(room[k])) / scale);
        let more = (Vector::from(lengths) - extent) * 0.5;
        let margin = |x: f64, y: f64| Vector::new(x, y) / scale;
        Self {
            min: low - more - margin(MARGIN, foot),
            max: high + more + margin(MARGIN, MARGIN),
            scale,
            foot,
        }
    }

    /// The area for labels: above the scale bar and the legend.
    fn screen(&self) -> Screen {
        let foot = Vector::new(0.0, self.meters(self.foot - 4.0));
        Screen {
            inside: [self.min + foot, self.max],
            scale: self.scale,
            height: TEXT_HEIGHT,
            width: label_width,
        }
    }

    fn ranges(&self) -> [[f64; 2]; 2] {
        [[self.min.x, self.max.x], [self.min.y, self.max.y]]
    }

    /// A length in points, in meters.
    fn meters(&self, points: f64) -> f64 {
        points / self.scale
    }

    fn size(&self) -> [f64; 2] {
        ((self.max - self.min) * self.scale).into()
    }
}

impl<'a> Picture<'a> {
    /// People in what is drawn of a scenario, all in one color.
    pub fn of(drawn: &'a Drawn, crowd: &'a Crowd, title: String) -> Self {
        Self {
            drawing: drawn.drawing.as_ref(),
            observed: &drawn.observed,
            labels: &drawn.labels,
            ..Self::of_scene((&*drawn.scene, crowd), title, drawn.view)
        }
    }

    /// People in a scene, all in one color.
    pub fn of_scene((scene, crowd): (&'a Scene, &'a Crowd), title: String, view: Region) -> Self {
        Self {
            title,
            heading: None,
            scene,
            crowd,
            simulation: None,
            closed: &[],
            view,
            coloring: None,
            field: None,
            trails: None,
            observed: &[],
            labels: &[],
            paths: Vec::new(),
            body_mass: None,
            drawing: None,
        }
    }

    /// Writes the picture: a PNG, PDF or SVG, by the extension.
    ///
    /// # Errors
    /// It cannot be drawn, or the file cannot be written.
    pub fn save(&self, path: &std::path::Path, print: &Print) -> Result<(), PlotError> {
        self.sheet(print).save_as(path, print)
    }

    /// The picture as a sheet.
    pub fn sheet(&self, print: &Print) -> Sheet {
        let shown = self.shown();
        let columns = self.columns(shown, print);
        let most = match (columns, print.width) {
            (1, None) => ALONE,
            (_, None) => OF_SEVERAL,
            (columns, Some(width)) => [width / columns as f64; 2],
        };
        let mut frame = self.frame(shown, most);
        if print.width.is_some() {
            // Labels have sizes in points, so they must know the size that is left for a panel.
            for _ in 0..3 {
                let panel = self.draft(&frame, columns).printed_panel(print);
                frame = self.frame(shown, panel);
            }
        }
        let routes = self.paths.iter();
        let panels = match self.paths.is_empty() {
            true => vec![self.panel(&frame, None)],
            false => routes
                .map(|paths| self.panel(&frame, Some(paths)))
                .collect(),
        };
        Sheet::new(&self.title, columns, frame.size(), panels)
    }

    /// Panels per row: on narrow sheets, wide ones are below each other.
    fn columns(&self, [low, high]: [Vector; 2], print: &Print) -> usize {
        let is_wide = high.x - low.x > WIDE * (high.y - low.y);
        match self.paths.len() {
            0 | 1 => 1,
            _ if is_wide && print.width.is_some() => 1,
            _ => 2,
        }
    }

    /// The sheet without marks.
    fn draft(&self, frame: &Frame, columns: usize) -> Sheet {
        let title = agents::summary(self);
        let [x, y] = self.axes(frame);
        let bar = match self.paths.is_empty() {
            true => self.bar(),
            false => Some(paths::bar(&ColorMap::pale([0.0, 100.0], 10))),
        };
        let panel = Panel {
            bar,
            ..Panel::new(&title, x, y, Vec::new())
        };
        let panels = vec![panel; self.paths.len().max(1)];
        Sheet::new("", columns, frame.size(), panels)
    }

    /// The frame of each panel, with room for all entries of the legend.
    fn frame(&self, shown: [Vector; 2], most: [f64; 2]) -> Frame {
        let one = Frame::around(shown, most, foot::height(1));
        let rows = foot::rows(self, &one, !self.paths.is_empty()).len();
        Frame::around(shown, most, foot::height(rows))
    }

    /// The axes, without numbers where levels lie beside each other.
    fn axes(&self, frame: &Frame) -> [Axis; 2] {
        let [across, up] = frame.ranges();
        match self.drawing {
            Some(drawing) if drawing.only.is_none() => [Axis::bare(across), Axis::bare(up)],
            _ => [Axis::linear("x [m]", across), Axis::linear("y [m]", up)],
        }
    }

    /// The view, with all places and zones.
    fn shown(&self) -> [Vector; 2] {
        let Region { min, max } = self.view;
        if self.drawing.is_some() {
            return [min, max];
        }
        let journeys = &self.scene.journeys;
        let places = journeys.places.iter().flat_map(scenery::lines);
        let zones = journeys.zones.iter().flat_map(|zone| zone.area.points());
        bounds(places.chain(zones.copied()).chain([min, max])).unwrap_or([min, max])
    }

    fn panel(&self, frame: &Frame, paths: Option<&Paths>) -> Panel {
        let scene = self.scene;
        let mut labels = Labels::new(frame.screen(), self.avoided(frame)).among_areas(scene);
        // The names of places first: they are the most important.
        let places = scene::places(self, frame, &mut labels);
        let mut below = scene::ground(scene);
        let mut above = Vec::new();
        let drawable = paths.zip(self.simulation);
        let drawn = drawable.map(|(paths, simulation)| paths.draw(simulation, frame, self.drawing));
        let (title, bar) = match drawn {
            Some(drawn) => {
                below.extend(drawn.field);
                above = drawn.lines;
                (drawn.title, Some(drawn.bar))
            }
            None => {
                below.extend(scene::tints(scene));
                below.extend(scene::steps(self, frame));
                let field = self.field.as_ref();
                below.extend(field.map(|field| Mark::Overlay(field.cells.clone())));
                below.extend(agents::trails(self));
                (agents::summary(self), self.bar())
            }
        };
        below.extend(agents::agents(self, paths.is_some()));
        let mut marks = vec![Mark::Group(below)];
        marks.extend(scene::walls(scene));
        if let (None, Some(simulation), Some(mass)) = (paths, self.simulation, self.wall_mass()) {
            marks.extend(forces::marks(simulation, mass, self.drawing));
        }
        marks.extend(self.lines(frame, paths.is_none(), (above, places), labels));
        marks.extend(foot::marks(self, frame, paths.is_some()));
        let [x, y] = self.axes(frame);
        Panel {
            bar,
            ..Panel::new(&title, x, y, marks)
        }
    }

    /// Zones, sources, places, goals and regions with all names; `above` are the marks between sources and places.
    fn lines(
        &self,
        frame: &Frame,
        is_plain: bool,
        (above, places): (Vec<Mark>, Vec<Mark>),
        mut labels: Labels,
    ) -> Vec<Mark> {
        let scene = self.scene;
        let mut marks = scene::zones(scene, frame, is_plain, &mut labels);
        marks.extend(scene::levels(self, &mut labels));
        marks.extend(scene::sources(scene, &mut labels));
        marks.extend(above);
        marks.extend(places);
        marks.extend(scene::goals(self, frame, &mut labels));
        // Texts lie in their rooms; names of measurements find other places.
        let observed = self.observed.iter().map(|(name, _)| name.as_str());
        for label in scenery::own_texts(scene, observed, self.labels) {
            labels.add_within(label, NAME);
        }
        if is_plain {
            marks.extend(regions::marks(scene, self.observed, &mut labels));
        }
        marks.extend(written(labels));
        marks
    }

    /// What does not move, for a viewer with its own scale: the part of the plane that it shows, what lies below
    /// agents, and what lies above them.
    pub fn plan(&self) -> ([Vector; 2], Vec<Mark>, Vec<Mark>) {
        let shown = self.shown();
        let frame = Frame::around(shown, ALONE, MARGIN);
        let mut labels = Labels::new(frame.screen(), self.avoided(&frame)).among_areas(self.scene);
        let places = scene::places(self, &frame, &mut labels);
        let ground = scene::ground(self.scene).into_iter();
        let tinted = ground.chain(scene::tints(self.scene));
        let below = tinted.chain(scene::steps(self, &frame)).collect();
        let mut above = scene::walls(self.scene);
        above.extend(self.lines(&frame, true, (Vec::new(), places), labels));
        (shown, below, above)
    }

    /// The points of agents, walls, places and zones.
    fn avoided(&self, frame: &Frame) -> Vec<Vector> {
        let apart = frame.meters(0.5 * TEXT_HEIGHT);
        let mut points = along_lines(self.scene, apart);
        points.extend(&self.crowd.position);
        points
    }

    /// Whether person `i` is shown: in a drawing of one level, those on others are not.
    fn shows(&self, i: usize) -> bool {
        let only = self.drawing.filter(|drawing| drawing.only.is_some());
        only.is_none_or(|drawing| drawing.shown.contains(self.crowd.position[i]))
    }

    /// The mass of an average person, kg, if walls are colored: there is one color bar only.
    fn wall_mass(&self) -> Option<f64> {
        let is_free = self.field.is_none() && self.coloring.is_none();
        self.body_mass.filter(|_| is_free)
    }

    fn bar(&self) -> Option<ColorBar> {
        let field = self.field.as_ref().map(|field| &field.bar);
        let coloring = self.coloring.as_ref().map(|coloring| &coloring.bar);
        let walls = || self.wall_mass().map(|_| forces::bar());
        field.or(coloring).cloned().or_else(walls)
    }
}

/// The marks of labels, with lines to the points of those that are far from them.
fn written(labels: Labels) -> impl Iterator<Item = Mark> {
    let placed = labels.into_placed();
    let line = |label: &Placed| {
        let ends = [label.leader?, label.at].map(xy);
        Some(Mark::line(ends, Style::full(label.color, LEADER, "")))
    };
    let leaders: Vec<Mark> = placed.iter().filter_map(line).collect();
    let texts = placed.into_iter().map(|label| {
        Mark::Label(Text {
            at: xy(label.at),
            side: label.side,
            text: label.text,
            color: dark(label.color),
        })
    });
    leaders.into_iter().chain(texts)
}

/// A darker color, for text.
fn dark(color: Rgb) -> Rgb {
    color.map(|value| (f64::from(value) * 0.62) as u8)
}

fn xy(p: Vector) -> [f64; 2] {
    p.into()
}

/// The height of a label, points.
const TEXT_HEIGHT: f64 = 1.2 * LABEL_SIZE;
