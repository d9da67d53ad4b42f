//! Polygons without effect: obstacles off the floor, and floors inside other floors.

use super::error::FloorPlanError;
use super::shape::{SAME, Shape};
use super::unite::{free, rings};
use crate::engine::geometry::Area;
use crate::engine::math::{Vector, bounds};
use crate::scenario::error::quote::shown;

/// Plans with more polygons are not searched: all pairs of bounding boxes are compared.
const MOST: usize = 5_000;

/// A polygon with the corners of its bounding box.
struct Boxed<'a> {
    shape: &'a Shape,
    low: Vector,
    high: Vector,
}

impl<'a> Boxed<'a> {
    fn new(shape: &'a Shape) -> Self {
        let outline = shape.rings.iter().take(1).flatten();
        let [low, high] = bounds(outline.map(|&p| p.into())).unwrap_or_default();
        Self { shape, low, high }
    }

    fn overlaps(&self, other: &Self) -> bool {
        let [one, another] = [other.high - self.low, self.high - other.low];
        one.min() > SAME && another.min() > SAME
    }

    fn fits_into(&self, other: &Self) -> bool {
        let [low, high] = [self.low - other.low, other.high - self.high];
        low.min() >= -SAME && high.min() >= -SAME
    }

    /// Whether it lies wholly inside another polygon.
    fn is_inside(&self, other: &Self) -> Result<bool, FloorPlanError> {
        if !self.fits_into(other) {
            return Ok(false);
        }
        let [own, around] = [self.shape.area()?, other.shape.area()?];
        let may_be = around.contains(Shape::middle(&own).0);
        Ok(may_be && free(&[rings(&[own])], &rings(&[around]))?.is_empty())
    }

    /// Whether it lies wholly off these floors.
    fn is_off(&self, floors: &[Self]) -> Result<bool, FloorPlanError> {
        let near = floors.iter().filter(|floor| floor.overlaps(self));
        let near = near.map(|floor| floor.shape.area());
        let near: Vec<Area> = near.collect::<Result<_, _>>()?;
        if near.is_empty() {
            return Ok(true);
        }
        let own = self.shape.area()?;
        let middle = Shape::middle(&own).0;
        let is_on = near.iter().any(|floor| floor.contains(middle));
        Ok(!is_on && free(&[rings(&[own]), rings(&near)], &Vec::new())?.is_empty())
    }
}

/// A note on the obstacles off the floor, and one on the floors inside other floors, if there are any.
pub fn notes(shapes: &[Shape]) -> Result<Vec<String>, FloorPlanError> {
    if shapes.len() > MOST {
        return Ok(Vec::new());
    }
    let boxed = shapes.iter().map(Boxed::new);
    let (obstacles, floors): (Vec<Boxed>, Vec<Boxed>) =
        boxed.partition(|polygon| polygon.shape.is_obstacle);
    let mut notes = Vec::new();
    if floors.is_empty() {
        return Ok(notes);
    }
    let mut off = Vec::new();
    for obstacle in &obstacles {
        if obstacle.is_off(&floors)? {
            off.push(obstacle);
        }
    }
    if let Some(first) = listed(&off) {
        notes.push(format!(
            "{first}: obstacles wholly off the floor have no effect; move or remove them"
        ));
    }
    let mut inside = Vec::new();
    let mut around = None;
    for (k, floor) in floors.iter().enumerate() {
        let outer = floors.iter().enumerate().filter(|(l, _)| *l != k);
        for (l, outer) in outer {
            // Of two equal floors, the later one adds nothing.
            if floor.is_inside(outer)? && (l < k || !outer.is_inside(floor)?) {
                inside.push(floor);
                around.get_or_insert(outer);
                break;
            }
        }
    }
    if let (Some(first), Some(outer)) = (listed(&inside), around) {
        notes.push(format!(
            "{first}: floor wholly inside other floor ({}) adds nothing; remove it, or make it an obstacle",
            shown(&outer.shape.place)
        ));
    }
    Ok(notes)
}

/// The first polygon, and the number of the others.
fn listed(polygons: &[&Boxed]) -> Option<String> {
    let first = shown(&polygons.first()?.shape.place);
    Some(match polygons.len() {
        1 => first,
        count => format!("{first} and {} more", count - 1),
    })
}
