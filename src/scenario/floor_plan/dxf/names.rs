//! The names of places, from texts in them and from their kinds.

use std::collections::{HashMap, HashSet};

use super::blocks::Placed;
use super::entities::{Content, is_name};
use super::gaps::distance;
use super::items::{Form, Item, is_inside};
use super::layers::Sorted;
use super::map::Point;
use super::units::{Extent, Frame};
use crate::floor_plan::kind::Kind;

/// Texts this near to a line name it, meters.
const NEAR: f64 = 0.5;
/// Most pairs of texts and places that are compared.
const MOST_PAIRS: usize = 50_000_000;

/// A text of the plan.
pub struct Label<'a> {
    /// Its entity.
    pub placed: Placed<'a>,
    /// Whether its layer is unknown.
    pub is_unknown: bool,
    /// Where it is, meters.
    pub at: Point,
    /// What it says.
    pub says: String,
    /// Whether something is named by it.
    pub is_used: bool,
}

/// The texts of a drawing, those with the largest letters first.
pub fn labels<'a>(sorted: &Sorted<'a>, frame: &Frame) -> Vec<Label<'a>> {
    let mut found = Vec::new();
    for &(placed, is_known) in &sorted.texts {
        if let Content::Text(text) = &placed.entity.content {
            let label = Label {
                placed,
                is_unknown: !is_known,
                at: frame.at(placed.map.at(text.at)),
                says: text.says.clone(),
                is_used: false,
            };
            found.push((text.height * placed.map.growth(), label));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().map(|(_, label)| label).collect()
}

/// How near a text is to a place: the extent of the area around it, or else its distance from the line.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
enum Nearness {
    Inside(f64),
    Beside(f64),
}

fn nearness(at: Point, item: &Item) -> Option<Nearness> {
    match &item.form {
        Form::Ring(ring) => is_inside(at, ring).then(|| Nearness::Inside(extent(ring))),
        Form::Area(rings) => {
            let around = rings.iter().filter(|ring| is_inside(at, ring)).count();
            (around % 2 == 1)
                .then(|| Nearness::Inside(rings.first().map_or(0.0, |ring| extent(ring))))
        }
        Form::Line(points) => {
            let apart = points
                .windows(2)
                .map(|pair| from_line(at, pair[0], pair[1]));
            let nearest = apart.fold(f64::INFINITY, f64::min);
            (nearest <= NEAR).then_some(Nearness::Beside(nearest))
        }
        Form::Point(point) => {
            let apart = distance(at, *point);
            (apart <= NEAR).then_some(Nearness::Beside(apart))
        }
    }
}

/// The size of the rectangle around points.
fn extent(points: &[Point]) -> f64 {
    let around = Extent::of(points);
    around.map_or(0.0, |Extent { low, high }| {
        (high[0] - low[0]) * (high[1] - low[1])
    })
}

/// The distance of a point from a straight line between two others.
fn from_line(p: Point, a: Point, b: Point) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let squared = along[0] * along[0] + along[1] * along[1];
    let product = (p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1];
    let share = (product / squared.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    distance(p, [a[0] + share * along[0], a[1] + share * along[1]])
}

/// Names the places that texts are in, or else the floors and obstacles.
pub fn by_texts(items: &mut [Item], labels: &mut [Label]) {
    if items.len().saturating_mul(labels.len()) > MOST_PAIRS {
        return;
    }
    for label in labels.iter_mut().filter(|label| is_name(&label.says)) {
        let is_place = |item: &Item| !item.kind.is_built();
        let is_area = |item: &Item| {
            matches!(item.kind, Kind::Floor | Kind::Obstacle) && !matches!(item.form, Form::Line(_))
        };
        // The names of rooms are often near doors.
        let may_name = |item: &Item| item.kind != Kind::Door || item.layer == label.placed.layer;
        for fits in [is_place as fn(&Item) -> bool, is_area] {
            let candidates = items.iter_mut().filter(|item| fits(item) && may_name(item));
            let near = candidates.filter_map(|item| Some((nearness(label.at, item)?, item)));
            let nearest =
                near.min_by(|a, b| a.0.partial_cmp(&b.0).unwrap_or(std::cmp::Ordering::Equal));
            if let Some((_, item)) = nearest {
                if item.name.is_none() {
                    item.name = Some(label.says.clone());
                    label.is_used = true;
                }
                break;
            }
        }
    }
}

/// Names all other places by their kinds and numbers, such as `exit 2`. The parts of a block share a name.
pub fn by_numbers(items: &mut [Item]) {
    let given: HashSet<String> = items.iter().filter_map(|item| item.name.clone()).collect();
    let mut counts: HashMap<&str, usize> = HashMap::new();
    let mut of_blocks: HashMap<(&str, usize), String> = HashMap::new();
    for item in items.iter_mut().filter(|item| !item.kind.is_built()) {
        let word = item.kind.word();
        let known = item
            .block
            .and_then(|block| of_blocks.get(&(word, block)).cloned());
        let name = item.name.clone().or(known).unwrap_or_else(|| {
            let count = counts.entry(word).or_insert(0);
            loop {
                *count += 1;
                let name = format!("{word} {count}");
                if !given.contains(&name) {
                    return name;
                }
            }
        });
        if let Some(block) = item.block {
            of_blocks
                .entry((word, block))
                .or_insert_with(|| name.clone());
        }
        item.name = Some(name);
    }
}

/// Leaves the first part of each block that is a door: its leaf, without the arc in which it swings.
pub fn first_of_doors(items: &mut Vec<Item>) {
    let mut seen = HashSet::new();
    items.retain(|item| {
        let block = item.block.filter(|_| item.kind == Kind::Door);
        block.is_none_or(|block| seen.insert(block))
    });
}
