//! The names of what a recording shows, where they do not cover each other before the viewer zooms in.

use std::collections::BTreeMap;

use rerun::{AsComponents, LineStrips2D, RecordingStream};

use super::bars;
use crate::labels::{self, Labels, Placed, Screen, Spot, along_lines, along_walls};
use crate::recording::arrangement::Arrangement;
use crate::recording::draw::{color, px, texts, xy};
use crate::recording::error::Cause;
use engine::geometry::Walls;
use engine::math::Vector;
use engine::scene::{Region, Scene};
use figures::colors::Rgb;
use scenario::floor_plan::Label;

/// The usual width of a letter, and what a label has beside its text, pixels.
const LETTER: f64 = 6.0;
const RIM: f64 = 8.0;
/// The height of a label, and how far its middle is below its point, pixels.
const HEIGHT: f64 = 23.0;
const BELOW: f64 = 12.0;

/// The length of the line to a label, as a fraction of the distance from its rim to its middle.
const INTO: f64 = 0.6;

/// The width of a label in the viewer, pixels.
fn width(text: &str) -> f64 {
    LETTER * text.chars().count() as f64 + RIM
}

/// The names, each with the entity that it belongs to.
pub struct Names {
    labels: Labels,
    screen: Screen,
    entities: Vec<String>,
}

impl Names {
    /// For views of this part of the plane. Names cover walls only if they find no other place.
    pub fn of_walls(view: &Region, walls: &Walls) -> Self {
        Self::new(view, |apart| along_walls(walls, apart).collect())
    }

    /// For views of this part of the plane. Names cover walls, places and zones only if they find no other place.
    pub fn of_scene(view: &Region, scene: &Scene) -> Self {
        let names = Self::new(view, |apart| along_lines(scene, apart));
        Self {
            labels: names.labels.among_areas(scene),
            ..names
        }
    }

    /// Names that avoid the points that `avoided` returns for a distance between them, meters.
    fn new(view: &Region, avoided: impl FnOnce(f64) -> Vec<Vector>) -> Self {
        let panel = Vector::from(Arrangement::of(view).panel());
        let shown = bars::with_bar(view);
        let extent = shown.max - shown.min;
        let scale = panel.component_div(&extent).min();
        // The viewer shows what is around the view, too; color bars are at its right.
        let more = (panel / scale - extent) * 0.5;
        let inside = [
            view.min - more,
            Vector::new(view.max.x, view.max.y + more.y),
        ];
        let screen = Screen {
            inside,
            scale,
            height: HEIGHT,
            width,
        };
        let avoided = avoided(screen.meters(0.5 * HEIGHT));
        Self {
            labels: Labels::new(screen, avoided),
            screen,
            entities: Vec::new(),
        }
    }

    /// The area where they are shown.
    pub fn screen(&self) -> &Screen {
        &self.screen
    }

    /// Adds the name of something in `entity`, one of `count` similar things.
    pub fn add(&mut self, entity: &str, count: usize, text: &str, place: (Rgb, &[Spot])) {
        let is_placed = !text.is_empty() && self.labels.add_of(count, text, place);
        self.entities.extend(is_placed.then(|| entity.to_owned()));
    }

    /// Adds a text in the middle of its room.
    pub fn add_within(&mut self, entity: &str, label: &Label, color: Rgb) {
        let is_placed = self.labels.add_within(label, color);
        self.entities.extend(is_placed.then(|| entity.to_owned()));
    }

    /// Adds the names of outlines in `{entity}/names`, around them.
    pub fn add_outlines(&mut self, entity: &str, color: Rgb, named: &[(String, Vec<Vector>)]) {
        for (name, outline) in named {
            let spots = labels::around(outline, false);
            self.add(
                &format!("{entity}/names"),
                named.len(),
                name,
                (color, &spots),
            );
        }
    }

    /// Logs the names of each entity below it.
    pub fn log(self, stream: &RecordingStream) -> Result<(), Cause> {
        let above = Vector::new(0.0, self.screen.meters(BELOW));
        let mut by_entity: BTreeMap<String, Vec<Placed>> = BTreeMap::new();
        for (entity, label) in self.entities.into_iter().zip(self.labels.into_placed()) {
            by_entity.entry(entity).or_default().push(label);
        }
        for (entity, own) in by_entity {
            let of = |label: &Placed| color(label.color);
            let middle = |label: &Placed| (label.around[0] + label.around[1]) * 0.5;
            let far = || own.iter().filter(|label| label.leader.is_some());
            // To a place inside of the label: it keeps its size when the viewer zooms in.
            let end = |label: &Placed| label.at + (middle(label) - label.at) * INTO;
            let leaders = far().filter_map(|label| Some([xy(label.leader?), xy(end(label))]));
            let lines = LineStrips2D::new(leaders)
                .with_colors(far().map(of))
                .with_radii(px(0.4))
                .with_draw_order(7.0);
            let places = own.iter().map(|label| xy(middle(label) + above));
            let texts = texts(places, own.iter().map(|label| label.text.as_str()))
                .with_colors(own.iter().map(of))
                .with_draw_order(7.0);
            let parts: [&dyn AsComponents; 2] = [&lines, &texts];
            stream.log_static(format!("world/geometry/{entity}"), &parts)?;
        }
        Ok(())
    }
}
