//! The entities under `focus`: one per followed agent, which moves with it. A view with this entity as its origin shows
//! the agent in the middle.
//!
//! | entity | what |
//! |---|---|
//! | `focus/ID` | the position of the agent |
//! | `focus/ID/here` | turns y up |
//! | `focus/ID/here/agent` | the agent, and the circle of its kernel |
//! | `focus/ID/here/forces` | arrows with names, and the magnitudes of the forces as time series |
//! | `focus/ID/here/walls` | hidden regions, lines to walls, nearest and representative points, the way, the headings |
//! | `focus/ID/here/scale` | arrows of 0.2, 2 and 20 m/s² |

use rerun::{
    Arrows2D, AsComponents, Ellipses2D, LineStrips2D, Points2D, Radius, RecordingStream, Scalars,
    SeriesLines, Transform3D,
};

use super::Open;
use super::arrows::{self, Acting, TOTAL};
use super::layers::{HIDDEN, LINK, NEAREST, REPRESENTATIVE, WAY};
use crate::recording::draw::{Point, color, px, texts, xy, y_up};
use crate::recording::error::Cause;
use engine::math::Vector;
use engine::scene::Region;
use figures::colors::Rgb;

/// Half the side of the view around an agent, meters.
pub const REACH: f64 = 2.5;
/// The color of the followed agent: no force and no other agent has it.
const AGENT: Rgb = [255, 244, 214];
const KERNEL: Rgb = [150, 160, 220];
/// The colors of the heading that the agent follows, and of the others.
const FOLLOWED: Rgb = [190, 255, 150];
const HEADING: Rgb = [90, 150, 110];
/// Headings are as long as agents walk in this time at the speed for which there is room, seconds.
const HEADING_SECS: f64 = 1.0;
const SCALE: Rgb = [150, 154, 168];

/// The part of the plane that the view of an agent shows, in the agent's frame.
pub fn region() -> Region {
    Region {
        min: Vector::repeat(-REACH),
        max: Vector::repeat(REACH),
    }
}

/// The entity of the followed agent called `name`.
pub fn entity(name: &str) -> String {
    format!("focus/{name}")
}

/// The entity with the forces and their time series.
pub fn forces(name: &str) -> String {
    format!("{}/here/forces", entity(name))
}

/// Logs one followed agent.
pub struct Focus {
    name: String,
    terms: Vec<Acting>,
    /// The agent that is shown.
    shown: Option<u32>,
    /// Whether something at walls is shown.
    has_walls: bool,
}

impl Focus {
    /// Logs colors, widths, names and the scale.
    pub fn begin(stream: &RecordingStream, name: String, terms: &[Acting]) -> Result<Self, Cause> {
        let here = format!("{}/here", entity(&name));
        stream.log_static(here.as_str(), &y_up())?;
        let words = terms.iter().map(Acting::in_words);
        let colors = terms.iter().map(|term| term.color.1);
        let series = SeriesLines::new()
            .with_names(["total".to_owned()].into_iter().chain(words))
            .with_colors([TOTAL].into_iter().chain(colors).map(color))
            .with_widths(vec![1.5; terms.len() + 1]);
        let style = Arrows2D::update_fields().with_draw_order(21.0);
        let names = Points2D::update_fields()
            .with_radii(px(0.0))
            .with_show_labels(true)
            .with_draw_order(22.0);
        let static_parts: [&dyn AsComponents; 3] = [&style, &names, &series];
        stream.log_static(forces(&name), &static_parts)?;
        let lines = LineStrips2D::update_fields()
            .with_radii(px(0.8))
            .with_draw_order(18.0);
        let points = Points2D::update_fields()
            .with_radii(px(3.0))
            .with_draw_order(19.0);
        let wall_parts: [&dyn AsComponents; 2] = [&lines, &points];
        stream.log_static(format!("{here}/walls"), &wall_parts)?;
        let body = Points2D::update_fields()
            .with_colors([color(AGENT)])
            .with_draw_order(20.0);
        let kernel = Ellipses2D::update_fields()
            .with_line_radii(px(0.8))
            .with_colors([color(KERNEL)])
            .with_draw_order(17.0);
        let parts: [&dyn AsComponents; 2] = [&body, &kernel];
        stream.log_static(format!("{here}/agent"), &parts)?;
        log_scale(stream, &here)?;
        Ok(Self {
            name,
            terms: terms.to_vec(),
            shown: None,
            has_walls: false,
        })
    }

    /// Logs one frame; `None`: the agent is absent.
    pub fn log(&mut self, stream: &RecordingStream, agent: Option<&Open>) -> Result<(), Cause> {
        let id = agent.map(|agent| agent.breakdown.id);
        if id != self.shown {
            self.log_body(stream, agent)?;
            self.shown = id;
        } else if id.is_none() {
            return Ok(());
        }
        let mut forces = Vec::new();
        if let Some(agent) = agent {
            let [x, y] = xy(agent.position);
            let place = Transform3D::from_translation([x, -y, 0.0]);
            stream.log(entity(&self.name), &place)?;
            forces = arrows::forces(agent, &self.terms);
        }
        let (arrows, names) = arrows::named(&forces);
        let values = agent.map(|agent| {
            let total = Vector::from(agent.breakdown.acceleration).norm();
            let values = self.terms.iter().map(|term| agent.force(&term.name).norm());
            Scalars::new([total].into_iter().chain(values))
        });
        let mut parts: Vec<&dyn AsComponents> = vec![&arrows, &names];
        parts.extend(values.as_ref().map(|values| values as &dyn AsComponents));
        stream.log(self::forces(&self.name), &parts)?;
        self.log_walls(stream, agent)
    }

    fn log_body(&self, stream: &RecordingStream, agent: Option<&Open>) -> Result<(), Cause> {
        let agents = || agent.into_iter();
        let body = Points2D::update_fields()
            .with_positions(agents().map(|_| [0.0, 0.0]))
            .with_radii(
                agents().map(|agent| Radius::new_scene_units(agent.breakdown.radius as f32)),
            )
            .with_labels(agents().map(|agent| agent.breakdown.id.to_string()))
            // Names of forces are around the agent; a click or the view's name tells its id.
            .with_show_labels(false);
        let kernel = Ellipses2D::update_fields()
            .with_centers(agents().map(|_| [0.0, 0.0]))
            .with_half_sizes(agents().map(|agent| [agent.support_radius as f32; 2]));
        let parts: [&dyn AsComponents; 2] = [&body, &kernel];
        Ok(stream.log(format!("{}/here/agent", entity(&self.name)), &parts)?)
    }

    fn log_walls(&mut self, stream: &RecordingStream, agent: Option<&Open>) -> Result<(), Cause> {
        let mut lines: Vec<(Vec<Point>, Rgb)> = Vec::new();
        let mut points: Vec<(Point, Rgb)> = Vec::new();
        if let Some(agent) = agent {
            let from = agent.position;
            let here = |p: [f64; 2]| xy(agent.drawn(p) - from);
            let [x, y] = xy(from);
            let hidden = agent.hidden.iter();
            lines.extend(hidden.map(|outline| {
                let outline = outline.iter().map(|p| [p[0] - x, p[1] - y]);
                (outline.collect(), HIDDEN)
            }));
            for wall in &agent.breakdown.walls {
                let nearest = here(wall.nearest_point);
                lines.push((vec![[0.0, 0.0], nearest], LINK));
                points.push((nearest, NEAREST));
                points.extend(wall.representative_point.map(|p| (here(p), REPRESENTATIVE)));
            }
            let way = agent.breakdown.way.as_ref().map(|way| {
                let corners = way.corners.iter().map(|&corner| here(corner));
                (std::iter::once([0.0, 0.0]).chain(corners).collect(), WAY)
            });
            lines.extend(way);
            let choice = agent.breakdown.choice.iter();
            lines.extend(choice.flat_map(|choice| &choice.headings).map(|heading| {
                let end = xy(Vector::from(heading.direction) * (heading.room * HEADING_SECS));
                let color = if heading.followed { FOLLOWED } else { HEADING };
                (vec![[0.0, 0.0], end], color)
            }));
        }
        let has_walls = !lines.is_empty();
        if has_walls || self.has_walls {
            let (strips, colors): (Vec<_>, Vec<_>) = lines.into_iter().unzip();
            let lines = LineStrips2D::update_fields()
                .with_strips(strips)
                .with_colors(colors.into_iter().map(color));
            let (places, colors): (Vec<_>, Vec<_>) = points.into_iter().unzip();
            let points = Points2D::update_fields()
                .with_positions(places)
                .with_colors(colors.into_iter().map(color));
            let parts: [&dyn AsComponents; 2] = [&lines, &points];
            stream.log(format!("{}/here/walls", entity(&self.name)), &parts)?;
        }
        self.has_walls = has_walls;
        Ok(())
    }
}

/// Logs arrows of known accelerations at the lower left corner of the view.
fn log_scale(stream: &RecordingStream, here: &str) -> Result<(), Cause> {
    let low = Vector::repeat(0.12 - REACH);
    let examples = [20.0, 2.0, 0.2];
    let places = (1..).map(|k| low + Vector::new(0.0, 0.28 * f64::from(k)));
    let arrows: Vec<(Vector, f64)> = places
        .zip(examples)
        .map(|(place, a)| (place, arrows::arrow_length(a)))
        .collect();
    let right = |&(place, length): &(Vector, f64)| place + Vector::new(length + 0.45, 0.1);
    let tips = arrows.iter().map(right).map(xy);
    let names = texts(tips, examples.map(|a| format!("{a} m/s²")))
        .with_colors([color(SCALE)])
        .with_draw_order(22.0);
    let scale = Arrows2D::from_vectors(arrows.iter().map(|&(_, length)| [length as f32, 0.0]))
        .with_origins(arrows.iter().map(|&(place, _)| xy(place)))
        .with_colors([color(SCALE)])
        .with_radii(px(1.2))
        .with_draw_order(21.0);
    let parts: [&dyn AsComponents; 2] = [&scale, &names];
    Ok(stream.log_static(format!("{here}/scale"), &parts)?)
}
