//! Snapshots of crowds side by side (Figs. 5 to 10).

use std::sync::LazyLock;

use crate::error::LabError;
use crate::sweep::Gathered;
use engine::geometry::Polygon;
use output::colors::{self, ColorMap};
use output::plot::{Axis, ColorBar, Disc, GRAY, Mark, Panel, Sheet, Style};
use scenario::measurements::Snapshot;

/// Inferno up to 1 m/s: the push itself reaches 0.9 m/s.
static WAVE_SPEED: LazyLock<ColorMap> = LazyLock::new(|| ColorMap::inferno([0.0, 1.0]));
/// The color of the measured region's outline.
const GREEN: [u8; 3] = [0, 158, 115];

/// The meaning of the discs' colors (Fig. 3).
#[derive(Clone, Copy)]
pub(super) struct Coloring {
    label: &'static str,
    map: fn() -> &'static ColorMap,
    values: fn(&Snapshot) -> &[f64],
}

/// |v_i|.
pub(super) const SPEED: Coloring = Coloring {
    label: "speed [m/s]",
    map: || &colors::SPEED,
    values: |snapshot| &snapshot.speed,
};
/// |v_i| in a crowd that hardly moves: the color range ends at the speed of its waves.
pub(super) const CROWD_SPEED: Coloring = Coloring {
    map: || &WAVE_SPEED,
    ..SPEED
};
/// ρ_i.
pub(super) const DENSITY: Coloring = Coloring {
    label: "density [P/m²]",
    map: || &colors::DENSITY,
    values: |snapshot| &snapshot.density,
};

/// A picture with a panel for each run, or with a row for each run and a panel for each time.
#[derive(Clone, Copy)]
pub(super) struct Snapshots {
    /// The name of its files.
    pub name: &'static str,
    /// Its title.
    pub title: &'static str,
    /// A description, in one line.
    pub about: &'static str,
    /// Its study.
    pub studies: &'static [&'static str],
    /// The times of the snapshots, seconds.
    pub times: &'static [f64],
    /// The part of the plane that is shown: lower left and upper right corner, meters.
    pub region: [[f64; 2]; 2],
    /// The meaning of the colors.
    pub coloring: Coloring,
    /// Panels side by side.
    pub columns: usize,
    /// Width of a panel, points.
    pub width: f64,
    /// A region whose outline is drawn.
    pub measured: Option<[[f64; 2]; 2]>,
    /// The runs by their labels; if empty, all of the study.
    pub labels: &'static [&'static str],
    /// Their titles, if they are not the labels.
    pub titles: &'static [&'static str],
}

/// All runs of a study under their labels; the other fields are yet to be given.
pub(super) const ALL: Snapshots = Snapshots {
    name: "",
    title: "",
    about: "",
    studies: &[],
    times: &[],
    region: [[0.0; 2]; 2],
    coloring: SPEED,
    columns: 1,
    width: 0.0,
    measured: None,
    labels: &[],
    titles: &[],
};

impl Snapshots {
    /// The runs of the study.
    pub fn sheet(&self, studies: &[Gathered]) -> Result<Sheet, LabError> {
        let study = &studies[0];
        let mut labels = self.labels.to_vec();
        if labels.is_empty() {
            labels.extend(study.study.cells.iter().filter_map(|cell| cell.label()));
        }
        let titles = match self.titles {
            [] => labels.as_slice(),
            titles => titles,
        };
        let [min, max] = self.region;
        let many = self.times.len() > 1;
        let (mut panels, mut row_titles) = (Vec::new(), Vec::new());
        for (k, (label, title)) in labels.iter().zip(titles).enumerate() {
            let (cell, result) = study.labeled(label)?;
            let scenario = cell.case.scenario();
            let scene = scenario.map_err(|error| LabError::of(*label, error))?.scene;
            let outline = |wall: &Polygon| wall.points().iter().map(|r| [r.x, r.y]).collect();
            let walls: Vec<Vec<[f64; 2]>> = scene.walls.obstacles().iter().map(outline).collect();
            // (a), (b), …
            let letter = char::from(b'a' + (k % 26) as u8);
            for &time in self.times {
                let title = match (many, k) {
                    (false, _) => format!("({letter}) {title}"),
                    (true, 0) => format!("t = {time} s"),
                    (true, _) => String::new(),
                };
                let name = Snapshot::name(time);
                let data = result.summary.data(&name);
                let snapshot = data.ok_or_else(|| LabError::missing(*label, name))?;
                panels.push(self.panel(title, &snapshot, &walls));
            }
            row_titles.extend(many.then(|| format!("({letter}) {title}")));
        }
        let height = self.width * (max[1] - min[1]) / (max[0] - min[0]);
        let map = (self.coloring.map)();
        Ok(Sheet {
            shared_axes: true,
            row_titles,
            bar: Some(ColorBar::new(self.coloring.label, map)),
            ..Sheet::new(self.title, self.columns, [self.width, height], panels)
        })
    }

    fn panel(&self, title: String, snapshot: &Snapshot, walls: &[Vec<[f64; 2]>]) -> Panel {
        let map = (self.coloring.map)();
        let values = (self.coloring.values)(snapshot).iter().enumerate();
        let discs = values.map(|(i, &value)| Disc {
            center: [snapshot.x[i], snapshot.y[i]],
            radius: snapshot.radius[i],
            color: map.color(value as f32),
        });
        let mut marks = vec![Mark::Discs(discs.collect())];
        let walls = walls.iter().cloned();
        marks.extend(walls.map(|corners| Mark::Area(corners, GRAY)));
        if let Some([[left, low], [right, high]]) = self.measured {
            let corners = [[left, low], [right, low], [right, high], [left, high]];
            let outline = [&corners[..], &corners[..1]].concat();
            marks.push(Mark::Line(outline, Style::full(GREEN, 0.8, "")));
        }
        let [min, max] = self.region;
        let x = Axis::linear("x [m]", [min[0], max[0]]);
        let y = Axis::linear("y [m]", [min[1], max[1]]);
        Panel::new(&title, x, y, marks)
    }
}
