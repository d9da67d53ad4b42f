//! The entities under `world/debug`: kernels, hidden regions, wall points and every force.

use rerun::{Arrows2D, AsComponents, Ellipses2D, LineStrips2D, Points2D, RecordingStream};

use super::{DebugAgents, Open, arrows};
use crate::recording::draw::{Point, color, px, xy};
use crate::recording::error::Cause;
use engine::boundary::WallMethod;
use engine::math::Vector;
use engine::scene::Scene;
use figures::colors::Rgb;

/// With more debug agents than this, labels would hide everything; a click still shows an agent's id.
const MOST_LABELS: usize = 40;

const WHITE: Rgb = [255; 3];

/// The colors of routes, hidden regions, lines to walls, nearest and representative points.
pub const WAY: Rgb = [240, 200, 90];
pub const HIDDEN: Rgb = [220, 120, 200];
pub const LINK: Rgb = [190, 110, 110];
pub const NEAREST: Rgb = [255, 90, 80];
pub const REPRESENTATIVE: Rgb = [255, 190, 80];

/// The data of one frame, and its number of elements.
type Data = (Box<dyn AsComponents>, usize);

/// Finds the data of a layer.
type Find = Box<dyn Fn(&[Open]) -> Data + Send>;

/// One entity under `world/debug`.
pub struct Layer {
    entity: String,
    data: Find,
    shown: bool,
}

impl Layer {
    /// Logs one frame. A layer that has just become empty is logged as empty, so that it disappears from view.
    pub fn log(&mut self, stream: &RecordingStream, open: &[Open]) -> Result<(), Cause> {
        let (data, count) = (self.data)(open);
        if count > 0 || self.shown {
            stream.log(self.entity.as_str(), data.as_ref())?;
        }
        self.shown = count > 0;
        Ok(())
    }
}

/// The layers that can have content in `scene`; their colors, widths and drawing order are logged.
pub fn begin(
    stream: &RecordingStream,
    scene: &Scene,
    who: &DebugAgents,
) -> Result<Vec<Layer>, Cause> {
    let mut layers = Vec::new();
    if *who == DebugAgents::None {
        return Ok(layers);
    }
    let mut add = |name: &str, style: &dyn AsComponents, data: Find| -> Result<(), Cause> {
        let entity = format!("world/debug/{name}");
        stream.log_static(entity.as_str(), style)?;
        layers.push(Layer {
            entity,
            data,
            shown: false,
        });
        Ok(())
    };
    let labeled = point_style(WHITE, 1.5).with_show_labels(true);
    add("agents", &labeled, Box::new(labels))?;
    let ellipses = Ellipses2D::update_fields()
        .with_line_radii(px(0.6))
        .with_colors([color([150, 160, 220])])
        .with_draw_order(10.0);
    add("kernels", &ellipses, Box::new(kernels))?;
    let walls = !scene.walls.is_empty();
    if walls {
        let hidden = line_style(HIDDEN, 0.8);
        add("walls/hidden_regions", &hidden, Box::new(hidden_regions))?;
        let linking = line_style(LINK, 0.4);
        add("walls/links", &linking, Box::new(links))?;
        let nearest = point_style(NEAREST, 3.0);
        add("walls/nearest_points", &nearest, Box::new(nearest_points))?;
    }
    if walls && scene.wall_method == WallMethod::Representative {
        let (name, style) = (
            "walls/representative_points",
            point_style(REPRESENTATIVE, 3.0),
        );
        add(name, &style, Box::new(representative_points))?;
    }
    if scene.routes.is_some() {
        add("routes", &line_style(WAY, 1.0), Box::new(routes))?;
    }
    for term in arrows::acting(scene) {
        let style = arrow_style(term.color.1, 1.2).with_draw_order(13.0);
        let entity = format!("forces/{}", term.name);
        let data = move |open: &[Open]| arrows_of(open, |agent| agent.force(&term.name));
        add(&entity, &style, Box::new(data))?;
    }
    let style = arrow_style(arrows::TOTAL, 1.6).with_draw_order(14.0);
    let data = |open: &[Open]| arrows_of(open, |agent| agent.breakdown.acceleration.into());
    add("forces/total", &style, Box::new(data))?;
    Ok(layers)
}

fn point_style(rgb: Rgb, radius: f32) -> Points2D {
    Points2D::update_fields()
        .with_radii(px(radius))
        .with_colors([color(rgb)])
        .with_draw_order(12.0)
}

fn line_style(rgb: Rgb, width: f32) -> LineStrips2D {
    LineStrips2D::update_fields()
        .with_radii(px(width))
        .with_colors([color(rgb)])
        .with_draw_order(11.0)
}

fn arrow_style(rgb: Rgb, width: f32) -> Arrows2D {
    Arrows2D::update_fields()
        .with_radii(px(width))
        .with_colors([color(rgb)])
}

fn positions(open: &[Open]) -> impl Iterator<Item = Point> {
    open.iter().map(|agent| xy(agent.position))
}

fn labels(open: &[Open]) -> Data {
    let few = open.iter().filter(|_| open.len() <= MOST_LABELS);
    let labels = few.map(|agent| agent.breakdown.id.to_string());
    let points = Points2D::update_fields().with_positions(positions(open));
    (Box::new(points.with_labels(labels)), open.len())
}

fn kernels(open: &[Open]) -> Data {
    let circles = Ellipses2D::update_fields()
        .with_centers(positions(open))
        .with_half_sizes(open.iter().map(|agent| [agent.support_radius as f32; 2]));
    (Box::new(circles), open.len())
}

fn hidden_regions(open: &[Open]) -> Data {
    strips(open.iter().flat_map(|agent| agent.hidden.iter().cloned()))
}

/// The rest of each agent's way, over its corners to its end.
fn routes(open: &[Open]) -> Data {
    let routes = open.iter().filter_map(|agent| {
        let aims = agent.breakdown.way.as_ref()?.corners.iter();
        let corners = aims.map(|&corner| xy(agent.drawn(corner)));
        Some(std::iter::once(xy(agent.position)).chain(corners).collect())
    });
    strips(routes)
}

/// The positions of agents, each with its nearest point on a wall and its representative point there.
fn walls(open: &[Open]) -> impl Iterator<Item = (Point, Point, Option<Point>)> {
    open.iter().flat_map(|agent| {
        let walls = agent.breakdown.walls.iter();
        walls.map(|term| {
            let representative = term.representative_point.map(|p| xy(agent.drawn(p)));
            let nearest = xy(agent.drawn(term.nearest_point));
            (xy(agent.position), nearest, representative)
        })
    })
}

/// Lines from each agent to its nearest point on each wall.
fn links(open: &[Open]) -> Data {
    strips(walls(open).map(|(from, to, _)| vec![from, to]))
}

fn nearest_points(open: &[Open]) -> Data {
    dots(walls(open).map(|(_, nearest, _)| nearest))
}

fn representative_points(open: &[Open]) -> Data {
    dots(walls(open).filter_map(|(.., representative)| representative))
}

fn strips(strips: impl Iterator<Item = Vec<Point>>) -> Data {
    let strips: Vec<_> = strips.collect();
    let count = strips.len();
    let lines = LineStrips2D::update_fields().with_strips(strips);
    (Box::new(lines), count)
}

fn dots(points: impl Iterator<Item = Point>) -> Data {
    let places: Vec<_> = points.collect();
    let count = places.len();
    let points = Points2D::update_fields().with_positions(places);
    (Box::new(points), count)
}

/// Arrows for the nonzero accelerations.
fn arrows_of(open: &[Open], acceleration: impl Fn(&Open) -> Vector) -> Data {
    let (origins, vectors): (Vec<_>, Vec<_>) = open
        .iter()
        .map(|agent| (xy(agent.position), acceleration(agent)))
        .filter(|(_, acceleration)| *acceleration != Vector::zeros())
        .map(|(origin, acceleration)| (origin, xy(arrows::arrow(acceleration))))
        .unzip();
    let count = origins.len();
    let arrows = Arrows2D::update_fields()
        .with_origins(origins)
        .with_vectors(vectors);
    (Box::new(arrows), count)
}
