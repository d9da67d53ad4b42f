//! The entities under `world/debug`: kernels, hidden regions, wall points and every force.

use rerun::{
    Arrows2D, AsComponents, Color, Ellipses2D, LineStrips2D, Points2D, Radius, RecordingStream,
};

use super::debug::{DebugAgents, Open};
use super::error::Cause;
use super::geometry::xy;
use crate::engine::boundary::WallMethod;
use crate::engine::math::Vector;
use crate::engine::profile::Term;
use crate::engine::scene::Scene;

/// With more debug agents than this, labels would hide everything; a click still shows an agent's id.
const MOST_LABELS: usize = 40;

/// Length of an arrow in meters per m/s² of acceleration: 0.5 m for the goal force of an average person at rest.
pub const METERS_PER_ACCELERATION: f64 = 0.2;

/// One entity under `world/debug`.
struct Layer {
    entity: String,
    kind: Kind,
    shown: bool,
}

/// What a layer shows.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Labels,
    Kernels,
    HiddenRegions,
    Links,
    NearestPoints,
    RepresentativePoints,
    /// A term of the breakdown.
    Force(Term),
    Total,
}

/// The color of a force's arrows, in words and as RGB.
fn color(term: Term) -> (&'static str, [u8; 3]) {
    match term {
        Term::Goal => ("green", [95, 211, 120]),
        Term::SocialAgents => ("light blue", [86, 180, 233]),
        Term::SocialWalls => ("blue", [70, 120, 255]),
        Term::Rvo => ("cyan", [60, 220, 220]),
        Term::PressureAgents => ("orange", [255, 150, 30]),
        Term::PressureWalls => ("red", [255, 70, 60]),
        Term::Viscosity => ("purple", [170, 110, 255]),
        Term::ContactAgents => ("yellow", [250, 230, 80]),
        Term::ContactWalls => ("pink", [255, 120, 190]),
    }
}

/// The names of the forces and the colors of their arrows in words.
pub fn force_colors() -> impl Iterator<Item = (&'static str, &'static str)> {
    Term::all().map(|term| (term.name(), color(term).0))
}

/// Logs the debug agents.
pub struct Layers {
    layers: Vec<Layer>,
}

impl Layers {
    /// The layers that can have content in `scene`.
    pub fn new(scene: &Scene, who: &DebugAgents) -> Self {
        let kinds = if *who == DebugAgents::None {
            Vec::new()
        } else {
            kinds(scene)
        };
        let layers = kinds.into_iter().map(|kind| Layer {
            entity: format!("world/debug/{}", kind.name()),
            kind,
            shown: false,
        });
        Self {
            layers: layers.collect(),
        }
    }

    /// No layers at all.
    pub fn none() -> Self {
        Self { layers: Vec::new() }
    }

    pub fn log_style(&self, stream: &RecordingStream) -> Result<(), Cause> {
        for layer in &self.layers {
            stream.log_static(layer.entity.as_str(), layer.kind.style().as_ref())?;
        }
        Ok(())
    }

    /// Logs one frame. A layer that has just become empty is logged as empty, so that it disappears from view.
    pub fn log(&mut self, stream: &RecordingStream, open: &[Open]) -> Result<(), Cause> {
        for layer in &mut self.layers {
            let (data, count) = layer.kind.data(open, METERS_PER_ACCELERATION);
            if count > 0 || layer.shown {
                stream.log(layer.entity.as_str(), data.as_ref())?;
            }
            layer.shown = count > 0;
        }
        Ok(())
    }
}

/// The layers that can have content in `scene`.
fn kinds(scene: &Scene) -> Vec<Kind> {
    let mut kinds = vec![Kind::Labels, Kind::Kernels];
    let walls = !scene.walls.is_empty();
    if walls {
        kinds.extend([Kind::HiddenRegions, Kind::Links, Kind::NearestPoints]);
        if scene.wall_method == WallMethod::Representative {
            kinds.push(Kind::RepresentativePoints);
        }
    }
    kinds.extend(
        Term::all()
            .filter(|&term| acts(term, scene))
            .map(Kind::Force),
    );
    kinds.push(Kind::Total);
    kinds
}

/// Does some profile of `scene` have this force?
fn acts(term: Term, scene: &Scene) -> bool {
    let mut steps = scene.groups.iter().flat_map(|group| group.blend.steps());
    (!term.is_of_walls() || !scene.walls.is_empty()) && steps.any(|step| step.profile.has(term))
}

impl Kind {
    fn name(self) -> String {
        match self {
            Self::Labels => "agents".to_owned(),
            Self::Kernels => "kernels".to_owned(),
            Self::HiddenRegions => "walls/hidden_regions".to_owned(),
            Self::Links => "walls/links".to_owned(),
            Self::NearestPoints => "walls/nearest_points".to_owned(),
            Self::RepresentativePoints => "walls/representative_points".to_owned(),
            Self::Force(term) => format!("forces/{}", term.name()),
            Self::Total => "forces/total".to_owned(),
        }
    }

    /// The static style: colors, widths, drawing order.
    fn style(self) -> Box<dyn AsComponents> {
        let points = |[r, g, b]: [u8; 3], size: f32| {
            Points2D::update_fields()
                .with_radii([Radius::new_ui_points(size)])
                .with_colors([Color::from_rgb(r, g, b)])
                .with_draw_order(12.0)
        };
        let lines = |[r, g, b]: [u8; 3], width: f32| {
            LineStrips2D::update_fields()
                .with_radii([Radius::new_ui_points(width)])
                .with_colors([Color::from_rgb(r, g, b)])
                .with_draw_order(11.0)
        };
        let arrows = |[r, g, b]: [u8; 3], width: f32, order: f32| {
            Arrows2D::update_fields()
                .with_radii([Radius::new_ui_points(width)])
                .with_colors([Color::from_rgb(r, g, b)])
                .with_draw_order(order)
        };
        match self {
            Self::Labels => Box::new(points([255, 255, 255], 1.5).with_show_labels(true)),
            Self::Kernels => Box::new(
                Ellipses2D::update_fields()
                    .with_line_radii([Radius::new_ui_points(0.6)])
                    .with_colors([Color::from_rgb(150, 160, 220)])
                    .with_draw_order(10.0),
            ),
            Self::HiddenRegions => Box::new(lines([220, 120, 200], 0.8)),
            Self::Links => Box::new(lines([190, 110, 110], 0.4)),
            Self::NearestPoints => Box::new(points([255, 90, 80], 3.0)),
            Self::RepresentativePoints => Box::new(points([255, 190, 80], 3.0)),
            Self::Force(term) => Box::new(arrows(color(term).1, 1.2, 13.0)),
            Self::Total => Box::new(arrows([255, 255, 255], 1.6, 14.0)),
        }
    }

    /// The data of one frame for all debug agents, and its number of elements.
    fn data(self, open: &[Open], scale: f64) -> (Box<dyn AsComponents>, usize) {
        match self {
            Self::Labels => {
                let labels = open.iter().map(|agent| agent.breakdown.id.to_string());
                let points = Points2D::update_fields().with_positions(positions(open));
                let readable = open.len() <= MOST_LABELS;
                let labels = labels.filter(|_| readable);
                (Box::new(points.with_labels(labels)), open.len())
            }
            Self::Kernels => {
                let half_sizes = open.iter().map(|agent| [agent.support_radius as f32; 2]);
                let circles = Ellipses2D::update_fields()
                    .with_centers(positions(open))
                    .with_half_sizes(half_sizes);
                (Box::new(circles), open.len())
            }
            Self::HiddenRegions => {
                let outlines = open.iter().flat_map(|agent| agent.hidden.iter().cloned());
                strips(outlines.collect())
            }
            Self::Links => strips(links(open)),
            Self::NearestPoints => dots(nearest_points(open)),
            Self::RepresentativePoints => {
                let walls = open.iter().flat_map(|agent| &agent.breakdown.walls);
                let found = walls.filter_map(|term| term.representative_point);
                dots(found.map(|p| xy(p.into())).collect())
            }
            Self::Force(term) => arrows(open, scale, |agent| agent.force(term)),
            Self::Total => arrows(open, scale, |agent| agent.breakdown.acceleration.into()),
        }
    }
}

fn positions(open: &[Open]) -> impl Iterator<Item = [f32; 2]> + '_ {
    open.iter().map(|agent| xy(agent.position))
}

fn nearest_points(open: &[Open]) -> Vec<[f32; 2]> {
    let walls = open.iter().flat_map(|agent| &agent.breakdown.walls);
    walls.map(|term| xy(term.nearest_point.into())).collect()
}

/// Lines from each agent to its nearest point on each wall.
fn links(open: &[Open]) -> Vec<Vec<[f32; 2]>> {
    let of = |agent: &Open| {
        let walls = agent.breakdown.walls.iter();
        let link = |end: [f64; 2]| vec![xy(agent.position), xy(end.into())];
        walls
            .map(|term| link(term.nearest_point))
            .collect::<Vec<_>>()
    };
    open.iter().flat_map(of).collect()
}

fn strips(strips: Vec<Vec<[f32; 2]>>) -> (Box<dyn AsComponents>, usize) {
    let count = strips.len();
    let lines = LineStrips2D::update_fields().with_strips(strips);
    (Box::new(lines), count)
}

fn dots(points: Vec<[f32; 2]>) -> (Box<dyn AsComponents>, usize) {
    let count = points.len();
    let points = Points2D::update_fields().with_positions(points);
    (Box::new(points), count)
}

/// Arrows for the nonzero accelerations.
fn arrows(
    open: &[Open],
    scale: f64,
    acceleration: impl Fn(&Open) -> Vector,
) -> (Box<dyn AsComponents>, usize) {
    let (origins, vectors): (Vec<_>, Vec<_>) = open
        .iter()
        .map(|agent| (xy(agent.position), acceleration(agent)))
        .filter(|(_, acceleration)| *acceleration != Vector::zeros())
        .map(|(origin, acceleration)| (origin, xy(acceleration * scale)))
        .unzip();
    let count = origins.len();
    let arrows = Arrows2D::update_fields()
        .with_origins(origins)
        .with_vectors(vectors);
    (Box::new(arrows), count)
}
