//! Polygons without effect: obstacles and holes off the floor, and floors inside other floors.

use super::error::FloorPlanError;
use super::kind::Kind;
use super::shape::{Form, SAME, Shape, part};
use super::unite::{free, rings};
use crate::error::quote::shown;
use engine::geometry::{Area, Ring};
use engine::math::{Vector, bounds};

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
        let may_be = around.contains(Shape::middle(own).0);
        Ok(may_be && free(&[rings([own])], &rings([around]))?.is_empty())
    }

    /// Whether it lies wholly off these floors.
    fn is_off(&self, floors: &[Self]) -> Result<bool, FloorPlanError> {
        let beside = floors.iter().filter(|floor| floor.overlaps(self));
        let areas = beside.map(|floor| floor.shape.area());
        let near: Vec<&Area> = areas.collect::<Result<_, _>>()?;
        if near.is_empty() {
            return Ok(true);
        }
        let own = self.shape.area()?;
        let middle = Shape::middle(own).0;
        let is_on = near.iter().any(|floor| floor.contains(middle));
        Ok(!is_on && free(&[rings([own]), rings(near)], &Vec::new())?.is_empty())
    }
}

/// A note on the obstacles off the floor, one on such holes, and one on the floors inside other floors, if there are
/// any.
pub fn notes(shapes: &[Shape]) -> Result<Vec<String>, FloorPlanError> {
    if shapes.len() > MOST {
        return Ok(Vec::new());
    }
    let areas = shapes.iter().filter(|shape| shape.form == Form::Area);
    let boxed = areas
        .filter(|shape| matches!(shape.kind, Kind::Floor | Kind::Obstacle))
        .map(Boxed::new);
    let (obstacles, floors): (Vec<Boxed>, Vec<Boxed>) =
        boxed.partition(|polygon| polygon.shape.kind == Kind::Obstacle);
    let mut notes = Vec::new();
    if floors.is_empty() {
        return Ok(notes);
    }
    let mut off = Vec::new();
    for obstacle in &obstacles {
        if obstacle.is_off(&floors)? {
            off.push(obstacle.shape.place.clone());
        }
    }
    if let Some(first) = listed(off) {
        notes.push(format!(
            "{first}: obstacles wholly off the floor have no effect; move or remove them"
        ));
    }
    if let Some(first) = listed(holes_off(&floors)?) {
        notes.push(format!(
            "{first}: holes wholly off the floor have no effect; move or remove them"
        ));
    }
    let mut inside = Vec::new();
    let mut around = None;
    for (k, floor) in floors.iter().enumerate() {
        let outer = floors.iter().enumerate().filter(|(l, _)| *l != k);
        for (l, outer) in outer {
            // Of two equal floors, the later one adds nothing.
            if floor.is_inside(outer)? && (l < k || !outer.is_inside(floor)?) {
                inside.push(floor.shape.place.clone());
                around.get_or_insert(outer);
                break;
            }
        }
    }
    if let (Some(first), Some(outer)) = (listed(inside), around) {
        notes.push(format!(
            "{first}: floor wholly inside other floor ({}) adds nothing; remove it, or make it an obstacle",
            shown(&outer.shape.place)
        ));
    }
    Ok(notes)
}

/// The places of the holes of floors that lie wholly off all floors. A hole on another floor is cut out of it.
fn holes_off(floors: &[Boxed]) -> Result<Vec<String>, FloorPlanError> {
    let mut holes = Vec::new();
    for Boxed { shape, .. } in floors.iter().filter(|floor| floor.shape.rings.len() > 1) {
        let Area {
            exterior,
            holes: own,
        } = shape.area()?;
        let is_apart = |hole: &Ring| !hole.points().iter().any(|&p| exterior.contains(p));
        let apart = (1..).zip(own).filter(|(_, hole)| is_apart(hole));
        holes.extend(apart.map(|(k, _)| Shape {
            place: part(&shape.place, "hole", k - 1),
            ..outline(shape, k)
        }));
    }
    if holes.is_empty() {
        return Ok(Vec::new());
    }
    let outlines: Vec<Shape> = floors.iter().map(|floor| outline(floor.shape, 0)).collect();
    let boxed: Vec<Boxed> = outlines.iter().map(Boxed::new).collect();
    let mut off = Vec::new();
    for hole in &holes {
        if Boxed::new(hole).is_off(&boxed)? {
            off.push(hole.place.clone());
        }
    }
    Ok(off)
}

/// Ring `k` of a floor as a floor of its own.
fn outline(shape: &Shape, k: usize) -> Shape {
    Shape::new(
        shape.place.clone(),
        vec![shape.rings[k].clone()],
        Kind::Floor,
    )
}

/// The first place, and the number of the others.
fn listed(places: Vec<String>) -> Option<String> {
    let first = shown(places.first()?);
    Some(match places.len() {
        1 => first,
        count => format!("{first} and {} more", count - 1),
    })
}
