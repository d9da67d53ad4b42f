//! The entities under `world/debug`: kernels, hidden regions, wall points and every force.

use rerun::{
    Arrows2D, AsComponents, Color, Ellipses2D, LineStrips2D, Points2D, Radius, RecordingStream,
};

use super::debug::{DebugAgents, Open};
use super::error::Cause;
use super::geometry::xy;
use crate::engine::boundary::WallMethod;
use crate::engine::breakdown::WallTerm;
use crate::engine::math::Vector;
use crate::engine::profile::Term;
use crate::engine::scene::Scene;

/// With more debug agents than this, labels would hide everything; a click still shows an agent's id.
const MOST_LABELS: usize = 40;

/// Length of an arrow in meters per m/s² of acceleration: 0.5 m for the goal force of an average person at rest.
pub const METERS_PER_ACCELERATION: f64 = 0.2;

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
pub fn color(term: Term) -> (&'static str, [u8; 3]) {
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

/// One entity under `world/debug`.
pub struct Layer {
    entity: String,
    kind: Kind,
    color: Color,
    /// Line width or point radius on the screen.
    radius: Radius,
    shown: bool,
}

/// The layers that can have content in `scene`.
pub fn layers(scene: &Scene, who: &DebugAgents) -> Vec<Layer> {
    if *who == DebugAgents::None {
        return Vec::new();
    }
    let mut layers = vec![
        Layer::new(Kind::Labels, "agents", [255, 255, 255], 1.5),
        Layer::new(Kind::Kernels, "kernels", [150, 160, 220], 0.6),
    ];
    let walls = !scene.walls.is_empty();
    if walls {
        layers.extend([
            Layer::new(
                Kind::HiddenRegions,
                "walls/hidden_regions",
                [220, 120, 200],
                0.8,
            ),
            Layer::new(Kind::Links, "walls/links", [190, 110, 110], 0.4),
            Layer::new(
                Kind::NearestPoints,
                "walls/nearest_points",
                [255, 90, 80],
                3.0,
            ),
        ]);
    }
    if walls && scene.wall_method == WallMethod::Representative {
        let (kind, name) = (Kind::RepresentativePoints, "walls/representative_points");
        layers.push(Layer::new(kind, name, [255, 190, 80], 3.0));
    }
    for term in Term::all().filter(|&term| acts(term, scene)) {
        let name = format!("forces/{}", term.name());
        layers.push(Layer::new(Kind::Force(term), &name, color(term).1, 1.2));
    }
    layers.push(Layer::new(
        Kind::Total,
        "forces/total",
        [255, 255, 255],
        1.6,
    ));
    layers
}

/// Does some profile of `scene` have this force?
fn acts(term: Term, scene: &Scene) -> bool {
    let mut steps = scene.groups.iter().flat_map(|group| group.blend.steps());
    (!term.is_of_walls() || !scene.walls.is_empty()) && steps.any(|step| step.profile.has(term))
}

impl Layer {
    fn new(kind: Kind, name: &str, [r, g, b]: [u8; 3], radius: f32) -> Self {
        Self {
            entity: format!("world/debug/{name}"),
            kind,
            color: Color::from_rgb(r, g, b),
            radius: Radius::new_ui_points(radius),
            shown: false,
        }
    }

    /// Logs colors, widths and the drawing order.
    pub fn log_style(&self, stream: &RecordingStream) -> Result<(), Cause> {
        let (radii, colors) = ([self.radius], [self.color]);
        let points = Points2D::update_fields()
            .with_radii(radii)
            .with_colors(colors)
            .with_draw_order(12.0);
        let arrows = Arrows2D::update_fields()
            .with_radii(radii)
            .with_colors(colors);
        let style: Box<dyn AsComponents> = match self.kind {
            Kind::Labels => Box::new(points.with_show_labels(true)),
            Kind::NearestPoints | Kind::RepresentativePoints => Box::new(points),
            Kind::Kernels => Box::new(
                Ellipses2D::update_fields()
                    .with_line_radii(radii)
                    .with_colors(colors)
                    .with_draw_order(10.0),
            ),
            Kind::HiddenRegions | Kind::Links => Box::new(
                LineStrips2D::update_fields()
                    .with_radii(radii)
                    .with_colors(colors)
                    .with_draw_order(11.0),
            ),
            Kind::Force(_) => Box::new(arrows.with_draw_order(13.0)),
            Kind::Total => Box::new(arrows.with_draw_order(14.0)),
        };
        Ok(stream.log_static(self.entity.as_str(), style.as_ref())?)
    }

    /// Logs one frame. A layer that has just become empty is logged as empty, so that it disappears from view.
    pub fn log(&mut self, stream: &RecordingStream, open: &[Open]) -> Result<(), Cause> {
        let (data, count) = self.kind.data(open);
        if count > 0 || self.shown {
            stream.log(self.entity.as_str(), data.as_ref())?;
        }
        self.shown = count > 0;
        Ok(())
    }
}

impl Kind {
    /// The data of one frame for all debug agents, and its number of elements.
    fn data(self, open: &[Open]) -> (Box<dyn AsComponents>, usize) {
        let positions = open.iter().map(|agent| xy(agent.position));
        let walls = open.iter().flat_map(|agent| {
            let walls = agent.breakdown.walls.iter();
            walls.map(|term| (xy(agent.position), term))
        });
        match self {
            Self::Labels => {
                let readable = open.len() <= MOST_LABELS;
                let labels = open.iter().filter(|_| readable);
                let labels = labels.map(|agent| agent.breakdown.id.to_string());
                let points = Points2D::update_fields().with_positions(positions);
                (Box::new(points.with_labels(labels)), open.len())
            }
            Self::Kernels => {
                let half_sizes = open.iter().map(|agent| [agent.support_radius as f32; 2]);
                let circles = Ellipses2D::update_fields()
                    .with_centers(positions)
                    .with_half_sizes(half_sizes);
                (Box::new(circles), open.len())
            }
            Self::HiddenRegions => {
                let outlines = open.iter().flat_map(|agent| agent.hidden.iter().cloned());
                strips(outlines.collect())
            }
            Self::Links => {
                let link =
                    |(from, term): ([f32; 2], &WallTerm)| vec![from, xy(term.nearest_point.into())];
                strips(walls.map(link).collect())
            }
            Self::NearestPoints => dots(
                walls
                    .map(|(_, term)| xy(term.nearest_point.into()))
                    .collect(),
            ),
            Self::RepresentativePoints => {
                let found = walls.filter_map(|(_, term)| term.representative_point);
                dots(found.map(|p| xy(p.into())).collect())
            }
            Self::Force(term) => arrows(open, |agent| agent.force(term)),
            Self::Total => arrows(open, |agent| agent.breakdown.acceleration.into()),
        }
    }
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
fn arrows(open: &[Open], acceleration: impl Fn(&Open) -> Vector) -> (Box<dyn AsComponents>, usize) {
    let (origins, vectors): (Vec<_>, Vec<_>) = open
        .iter()
        .map(|agent| (xy(agent.position), acceleration(agent)))
        .filter(|(_, acceleration)| *acceleration != Vector::zeros())
        .map(|(origin, acceleration)| (origin, xy(acceleration * METERS_PER_ACCELERATION)))
        .unzip();
    let count = origins.len();
    let arrows = Arrows2D::update_fields()
        .with_origins(origins)
        .with_vectors(vectors);
    (Box::new(arrows), count)
}
