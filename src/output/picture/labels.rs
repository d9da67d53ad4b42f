//! Labels that do not cover each other.

use super::{Frame, TEXT_HEIGHT, dark};
use crate::engine::math::Vector;
use crate::output::colors::Rgb;
use crate::output::plot::{Label, Mark, Style, label_width};
use crate::output::scenery::brief;
use crate::scenario::floor_plan::Label as GivenLabel;

/// Labels keep this distance from their points, points.
const GAP: f64 = 4.0;
/// Where no place beside its point is free, a label is at most this many times its height away, with a line to its point.
const FARTHEST: u32 = 7;
/// More similar things than this have labels only where there is room.
const FEW: usize = 8;
/// The width of that line, points.
const LEADER: f64 = 0.4;

/// All eight sides of a point and its center, the best first.
pub const AROUND: [[i8; 2]; 9] = [
    [0, 1],
    [0, -1],
    [1, 0],
    [-1, 0],
    [1, 1],
    [-1, 1],
    [1, -1],
    [-1, -1],
    [0, 0],
];

/// The corners of a box, meters.
type Corners = [Vector; 2];

/// The labels of a panel.
pub struct Labels<'a> {
    frame: &'a Frame,
    placed: Vec<(Corners, Label)>,
    /// Lines from labels to their points.
    leaders: Vec<Mark>,
    /// Points that labels cover only if they find no other place nearby, by x.
    avoided: Vec<Vector>,
}

/// A possible place of a label.
struct Place {
    around: Corners,
    /// The point that it belongs to.
    point: Vector,
    side: [i8; 2],
    /// The distance from that point, points.
    distance: f64,
}

impl<'a> Labels<'a> {
    pub fn new(frame: &'a Frame, mut avoided: Vec<Vector>) -> Self {
        avoided.sort_by(|a, b| a.x.total_cmp(&b.x));
        Self {
            frame,
            placed: Vec::new(),
            leaders: Vec::new(),
            avoided,
        }
    }

    /// Adds a label at the first of `places` where it fits into the panel and covers no other label, or farther away
    /// with a line to its point; if possible, at one where it covers no agents and walls. Where nothing is free there
    /// is no label.
    pub fn add(&mut self, text: &str, color: Rgb, places: &[(Vector, [i8; 2])]) {
        self.add_near((text, FARTHEST), color, places);
    }

    /// Adds the label of one of `count` similar things. If there are many, only where it covers nothing beside its point.
    pub fn add_of(
        &mut self,
        count: usize,
        text: &str,
        (color, places): (Rgb, &[(Vector, [i8; 2])]),
    ) {
        let rings = if count > FEW { 1 } else { FARTHEST };
        self.add_near((text, rings), color, places);
    }

    /// Adds a label in one of this many rings around `places`.
    fn add_near(&mut self, (text, rings): (&str, u32), color: Rgb, places: &[(Vector, [i8; 2])]) {
        let text = brief(text);
        let width = label_width(&text);
        let is_crowded = rings < FARTHEST;
        let rings = (0..rings).map(|ring| GAP + f64::from(ring) * TEXT_HEIGHT);
        let candidates = rings.flat_map(|distance| {
            let outward = places.iter();
            let outward = outward.filter(move |(_, side)| *side != [0, 0] || distance == GAP);
            outward.map(move |&(point, side)| (point, side, distance))
        });
        let candidates =
            candidates.map(|(point, side, distance)| self.place(width, point, side, distance));
        let free: Vec<Place> = candidates.filter(|place| self.is_free(place)).collect();
        let empty = free.iter().find(|place| self.is_empty(place));
        let Some(found) = empty.or(free.first().filter(|_| !is_crowded)) else {
            return;
        };
        let at = self.beside(found);
        if found.distance > GAP {
            let style = Style::full(color, LEADER, "");
            let ends = [found.point, at].map(Into::into).to_vec();
            self.leaders.push(Mark::Line(ends, style));
        }
        let label = Label {
            at: at.into(),
            side: found.side,
            text,
            color: dark(color),
        };
        self.placed.push((found.around, label));
    }

    /// Adds a text in the middle of its room, or a line above or below, if it fits there.
    pub fn add_within(&mut self, label: &GivenLabel, color: Rgb) {
        let room = label
            .width
            .map_or(f64::INFINITY, |width| width * self.frame.scale);
        if label_width(&brief(&label.text)) <= room {
            let line = Vector::new(0.0, self.frame.meters(TEXT_HEIGHT));
            let places = [0.0, 1.0, -1.0].map(|lines| (label.at + line * lines, [0, 0]));
            self.add(&label.text, color, &places);
        }
    }

    /// The point of the label that is nearest to the point that it belongs to.
    fn beside(&self, place: &Place) -> Vector {
        let side = Vector::from(place.side.map(f64::from));
        place.point + side * self.frame.meters(place.distance)
    }

    fn place(&self, width: f64, point: Vector, side: [i8; 2], distance: f64) -> Place {
        // Some room between two labels in a row.
        let size = [width + 0.5 * TEXT_HEIGHT, TEXT_HEIGHT].map(|points| self.frame.meters(points));
        let half = Vector::from(size) * 0.5;
        let mut place = Place {
            around: [point; 2],
            point,
            side,
            distance,
        };
        let side = Vector::from(side.map(f64::from));
        let center = self.beside(&place) + side.component_mul(&half);
        place.around = [center - half, center + half];
        place
    }

    /// Whether a label fits there into the panel, and covers no other label.
    fn is_free(&self, place: &Place) -> bool {
        let [low, high] = place.around;
        let [least, most] = self.frame.inside();
        let covers = |([l, h], _): &(Corners, Label)| {
            low.x < h.x && l.x < high.x && low.y < h.y && l.y < high.y
        };
        let fits = low == low.sup(&least) && high == high.inf(&most);
        fits && !self.placed.iter().any(covers)
    }

    /// Whether a label there covers none of the points to avoid.
    fn is_empty(&self, place: &Place) -> bool {
        let [low, high] = place.around;
        let first = self.avoided.partition_point(|p| p.x < low.x);
        let column = self.avoided[first..].iter().take_while(|p| p.x <= high.x);
        !column.into_iter().any(|p| (low.y..=high.y).contains(&p.y))
    }

    pub fn into_marks(self) -> impl Iterator<Item = Mark> {
        let labels = self.placed.into_iter();
        let labels = labels.map(|(_, label)| Mark::Label(label));
        self.leaders.into_iter().chain(labels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_one_point_never_overlap_and_stay_inside() {
        let frame = Frame::around(
            [Vector::zeros(), Vector::new(10.0, 10.0)],
            [400.0, 400.0],
            22.0,
        );
        let mut labels = Labels::new(&frame, Vec::new());
        let places = AROUND.map(|side| (Vector::new(5.0, 5.0), side));
        for k in 0..60 {
            labels.add(&format!("label {k}"), [0; 3], &places);
        }
        assert!(labels.placed.len() > 12, "{}", labels.placed.len());
        let [least, most] = frame.inside();
        for (k, ([low, high], _)) in labels.placed.iter().enumerate() {
            assert!(low.x >= least.x && low.y >= least.y && high.x <= most.x && high.y <= most.y);
            for ([l, h], _) in &labels.placed[..k] {
                let apart = h.x <= low.x || high.x <= l.x || h.y <= low.y || high.y <= l.y;
                assert!(apart);
            }
        }
    }
}
