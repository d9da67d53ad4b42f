//! Walls that are lines → the floor between them.

use std::collections::{BTreeMap, BTreeSet};

use super::entities::is_name;
use super::faces::{Faces, OUTSIDE};
use super::gaps::{self, Gap, distance};
use super::items::{Form, Item};
use super::joined::beside;
use super::map::Point;
use super::names::Label;
use super::network::Line;
use super::units::Extent;
use crate::error::quote::{shown, to_centimeters};
use crate::floor_plan::error::FloorPlanError;
use crate::floor_plan::kind::Kind;
use crate::floor_plan::reading::Reading;
use crate::floor_plan::shape::Shape;
use engine::geometry::Area;

/// Enclosed areas that are smaller are not listed, m².
const LISTED: f64 = 2.0;
/// Smaller enclosed areas are no floor unless a point asks for them, m².
const LEAST: f64 = 1.0;
/// A floor that is a smaller part of the rectangle around the walls is doubtful.
const LITTLE: f64 = 0.1;
/// Most ends of walls among which the nearest two are searched.
const MOST_ENDS: usize = 3000;

/// The rooms of a plan.
pub struct Rooms {
    /// The floor, the rooms with names, and the walls.
    pub shapes: Vec<Shape>,
    /// How they were found.
    pub notes: Vec<String>,
    /// The gaps that were closed.
    pub gaps: Vec<Gap>,
}

/// The areas that walls enclose. Those on both sides of a door belong together.
struct Enclosed {
    faces: Faces,
    /// The smallest number of a face that belongs to each face.
    group: Vec<usize>,
}

impl Enclosed {
    fn new(lines: &[Line]) -> Self {
        let faces = Faces::new(lines);
        let mut group: Vec<usize> = (0..faces.count()).collect();
        for (k, _) in faces
            .network
            .edges
            .iter()
            .enumerate()
            .filter(|(_, edge)| edge.is_open)
        {
            let sides = faces.sides(k);
            if sides.contains(&OUTSIDE) {
                continue;
            }
            let [a, b] = sides.map(|face| root(&mut group, face));
            group[a.max(b)] = a.min(b);
        }
        for face in 0..group.len() {
            group[face] = root(&mut group, face);
        }
        Self { faces, group }
    }

    /// The groups but the outside, largest first, with their sizes.
    fn by_size(&self) -> Vec<(usize, f64)> {
        let mut by_group = BTreeMap::new();
        for face in 1..self.faces.count() {
            *by_group.entry(self.group[face]).or_insert(0.0) += self.faces.size(face);
        }
        let mut sizes: Vec<(usize, f64)> = by_group.into_iter().collect();
        sizes.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        sizes
    }

    fn union(&self, group: usize) -> Result<Vec<Area>, FloorPlanError> {
        self.faces.union(|face| self.group[face] == group)
    }

    /// A point in a group.
    fn point_in(&self, group: usize) -> Result<Point, FloorPlanError> {
        let areas = self.union(group)?;
        let largest = areas.iter().max_by(|a, b| a.area().total_cmp(&b.area()));
        Ok(largest.map_or([0.0, 0.0], |area| Shape::middle(area).0.into()))
    }
}

/// The smallest number of a group.
fn root(group: &mut [usize], face: usize) -> usize {
    let mut face = face;
    while group[face] != face {
        group[face] = group[group[face]];
        face = group[face];
    }
    face
}

/// The lines of items between which the floor is: walls, and the openings that end it.
fn lines(items: &[Item]) -> (Vec<&Item>, Vec<Line>) {
    let mut found = (Vec::new(), Vec::new());
    for item in items {
        let is_line = matches!(item.form, Form::Line(_));
        let is_open = match item.kind {
            Kind::Wall => false,
            Kind::Door => true,
            // A line ends the floor, also where a door opens outward behind it.
            Kind::Exit | Kind::Entrance => !is_line,
            _ => continue,
        };
        for points in item.lines() {
            found.0.push(item);
            found.1.push(Line { points, is_open });
        }
    }
    found
}

/// The floor between walls, by the points of `plan.inside` or the largest enclosed area.
///
/// # Errors
/// Nothing is enclosed, or a point is outside.
pub fn rooms(
    items: &[Item],
    labels: &mut [Label],
    reading: &Reading,
) -> Result<Rooms, FloorPlanError> {
    let (owners, mut lines) = lines(items);
    gaps::refuse_crowded(&lines)?;
    let gaps = gaps::close(&mut lines, reading.gap());
    let enclosed = Enclosed::new(&lines);
    let mut notes = Vec::new();
    let sizes = enclosed.by_size();
    let Some(&(largest, size)) = sizes.first() else {
        return Err(wrong(format!(
            "the walls enclose no area{}",
            ends(&enclosed.faces, reading.gap())
        )));
    };
    let mut chosen = Vec::new();
    for &at in &reading.inside {
        let face = enclosed.faces.at(at);
        if face == OUTSIDE {
            return Err(outside(at, &lines, &enclosed.faces, reading.gap()));
        }
        chosen.push(enclosed.group[face]);
    }
    if chosen.is_empty() && size < LEAST {
        return Err(wrong(format!(
            "the walls enclose no room: the largest enclosed area has {} m²{}",
            to_centimeters(size),
            ends(&enclosed.faces, reading.gap())
        )));
    }
    if chosen.is_empty() {
        chosen.push(largest);
        notes.push(
            choice(&enclosed, &sizes)? + &doubt(size, &lines, &enclosed.faces, reading.gap()),
        );
    }
    chosen.sort_unstable();
    chosen.dedup();
    notes.extend(closed_doors(&enclosed, &owners, &lines));
    notes.extend(outer_doors(&enclosed, &chosen, &owners, &lines));
    let mut shapes = floors(&enclosed, &chosen, labels, &mut notes)?;
    let walls = owners
        .iter()
        .zip(lines)
        .filter(|(item, _)| item.kind == Kind::Wall);
    shapes.extend(walls.map(|(item, line)| Shape {
        name: item.name.clone(),
        ..Shape::line(item.place.clone(), line.points, Kind::Wall)
    }));
    Ok(Rooms {
        shapes,
        notes,
        gaps,
    })
}

/// A note on doors to the outside, if there are any: people leave by exits alone.
fn outer_doors(
    enclosed: &Enclosed,
    chosen: &[usize],
    owners: &[&Item],
    lines: &[Line],
) -> Option<String> {
    let is_in = |face: usize| chosen.binary_search(&enclosed.group[face]).is_ok();
    let outward = |line: &Line| -> Option<Point> {
        let mut parts = line.points.windows(2);
        let found = parts.find(|pair| {
            let [left, right] = beside(pair[0], pair[1]).map(|p| enclosed.faces.at(p));
            left != right && [left, right].contains(&OUTSIDE) && is_in(left.max(right))
        });
        found.map(|pair| pair[0])
    };
    let doors = owners
        .iter()
        .zip(lines)
        .filter(|(item, _)| item.kind == Kind::Door);
    let mut outer = doors.filter_map(|(item, line)| Some((item.name.clone(), outward(line)?)));
    let (first, at) = outer.next()?;
    let others: BTreeSet<Option<String>> = outer
        .map(|(name, _)| name)
        .filter(|name| *name != first)
        .collect();
    let more = match others.len() {
        0 => String::new(),
        count => format!(" and {count} more"),
    };
    Some(format!(
        "{}{more}, at {}, ends the floor at the outside: people leave by exits alone; draw a line on a layer for exits \
         there, from jamb to jamb",
        first.unwrap_or_default(),
        shown_point(at)
    ))
}

/// A note on doors along walls that lead on below them, if there are any: such walls stay closed.
fn closed_doors(enclosed: &Enclosed, owners: &[&Item], lines: &[Line]) -> Option<String> {
    let is_closed = |line: &Line| {
        let mut parts = line.points.windows(2);
        parts.any(|pair| {
            let [left, right] = beside(pair[0], pair[1]).map(|p| enclosed.faces.at(p));
            let is_inside = left != OUTSIDE && right != OUTSIDE;
            is_inside && enclosed.group[left] != enclosed.group[right]
        })
    };
    let doors = owners.iter().zip(lines);
    let mut closed = doors.filter(|(item, line)| item.kind == Kind::Door && is_closed(line));
    let (first, _) = closed.next()?;
    let more = match closed.count() {
        0 => String::new(),
        count => format!(" and {count} more"),
    };
    Some(format!(
        "{}{more}: doors along walls without a gap stay closed; interrupt the walls there",
        shown(&first.place)
    ))
}

fn wrong(reason: String) -> FloorPlanError {
    FloorPlanError::Geometry {
        place: String::new(),
        reason,
    }
}

/// A point in messages.
pub fn shown_point(at: Point) -> String {
    let [x, y] = at.map(to_centimeters);
    format!("({x}, {y})")
}

/// A note on the gaps that were closed.
pub fn gaps_note(gaps: &[Gap]) -> Option<String> {
    let largest = gaps
        .iter()
        .max_by(|a, b| a.length().total_cmp(&b.length()))?;
    let (word, length) = match gaps.len() {
        1 => ("gap", String::new()),
        _ => ("gaps", "the largest ".to_owned()),
    };
    let size = (1e4 * largest.length()).round() / 1e4;
    Some(format!(
        "{} {word} between ends of lines closed, {length}{size} m at {}; `plan.gap` says otherwise",
        gaps.len(),
        shown_point(largest.from)
    ))
}

/// A note on the area that is taken without a given point, and the next smaller ones.
fn choice(enclosed: &Enclosed, sizes: &[(usize, f64)]) -> Result<String, FloorPlanError> {
    let (largest, size) = sizes[0];
    let at = shown_point(enclosed.point_in(largest)?);
    let mut note = format!(
        "walls are lines: the floor is what can be reached from {at}: {} m²; `plan.inside` says otherwise",
        rounded(size)
    );
    let next = sizes[1..].iter().filter(|(_, size)| *size > LISTED).take(3);
    let described = next.map(|&(group, size)| {
        Ok(format!(
            "{} m² around {}",
            rounded(size),
            shown_point(enclosed.point_in(group)?)
        ))
    });
    let others: Vec<String> = described.collect::<Result<_, FloorPlanError>>()?;
    if !others.is_empty() {
        note += &format!(". Other enclosed areas: {}", others.join(", "));
    }
    Ok(note)
}

/// What to say of a floor that is a small part of the extent of the walls; as the end of a sentence.
fn doubt(size: f64, lines: &[Line], faces: &Faces, gap: f64) -> String {
    let extent = Extent::of(lines.iter().flat_map(|line| &line.points));
    let [width, height] = extent.map_or([0.0, 0.0], |Extent { low, high }| {
        [high[0] - low[0], high[1] - low[1]]
    });
    match size < LITTLE * width * height {
        true => format!(
            ". That is little of the {} by {} m of the walls; probably they are open somewhere{}",
            to_centimeters(width),
            to_centimeters(height),
            ends(faces, gap)
        ),
        false => String::new(),
    }
}

/// A size in messages: whole square meters, or one decimal if it is small.
fn rounded(size: f64) -> f64 {
    match size {
        size if size >= 100.0 => size.round(),
        size => (10.0 * size).round() / 10.0,
    }
}

/// The floor of some groups, and their rooms with names.
fn floors(
    enclosed: &Enclosed,
    chosen: &[usize],
    labels: &mut [Label],
    notes: &mut Vec<String>,
) -> Result<Vec<Shape>, FloorPlanError> {
    let mut shapes = Vec::new();
    let is_in = |face: usize| chosen.binary_search(&enclosed.group[face]).is_ok();
    for area in enclosed.faces.union(is_in)? {
        let at = shown_point(Shape::middle(&area).0.into());
        shapes.push(Shape::new(
            format!("the floor around {at}"),
            rings(&area),
            Kind::Floor,
        ));
    }
    let rooms = (0..enclosed.faces.count())
        .filter(|&face| is_in(face))
        .count();
    let mut named: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    for label in labels
        .iter_mut()
        .filter(|label| !label.is_used && is_name(&label.says))
    {
        let face = enclosed.faces.at(label.at);
        if face != OUTSIDE && is_in(face) {
            let names = named.entry(face).or_default();
            if !names.contains(&label.says) {
                names.push(label.says.clone());
            }
            label.is_used = true;
        }
    }
    for (face, names) in named {
        let [name] = &names[..] else {
            notes.push(several_names(
                &names,
                &enclosed.faces.union(|other| other == face)?,
            ));
            continue;
        };
        if let ([floor], 1) = (&mut shapes[..], rooms) {
            floor.name = Some(name.clone());
            break;
        }
        let areas = enclosed.faces.union(|other| other == face)?;
        shapes.extend(areas.iter().map(|area| Shape {
            name: Some(name.clone()),
            ..Shape::new(format!("the room \"{name}\""), rings(area), Kind::Place)
        }));
    }
    Ok(shapes)
}

/// A note on an area in which several texts are.
fn several_names(names: &[String], areas: &[Area]) -> String {
    let quoted: Vec<String> = names
        .iter()
        .take(3)
        .map(|name| format!("\"{}\"", shown(name)))
        .collect();
    let more = match names.len().saturating_sub(3) {
        0 => String::new(),
        count => format!(" and {count} more"),
    };
    let size: f64 = areas.iter().map(Area::area).sum();
    format!(
        "the texts {}{more} are in one area of {} m², which gets no name: no wall or door lies between them",
        quoted.join(", "),
        rounded(size)
    )
}

/// The rings of an area: the outline, then the holes.
pub fn rings(area: &Area) -> Vec<Vec<Point>> {
    let rings = area.rings();
    rings
        .map(|ring| ring.points().iter().map(|&p| p.into()).collect())
        .collect()
}

/// The error of a point of `plan.inside` that is not enclosed.
fn outside(at: Point, lines: &[Line], faces: &Faces, gap: f64) -> FloorPlanError {
    let extent = Extent::of(lines.iter().flat_map(|line| &line.points));
    let is_beyond =
        extent.is_none_or(|extent| (0..2).any(|k| at[k] < extent.low[k] || at[k] > extent.high[k]));
    if let (true, Some(Extent { low, high })) = (is_beyond, extent) {
        return wrong(format!(
            "`plan.inside`: {} is outside of the walls, which reach from {} to {}",
            shown_point(at),
            shown_point(low),
            shown_point(high)
        ));
    }
    wrong(format!(
        "the floor around {} is open to the outside{}",
        shown_point(at),
        ends(faces, gap)
    ))
}

/// The nearest two ends of walls that meet no line, and what to do with them; as the end of a sentence.
fn ends(faces: &Faces, gap: f64) -> String {
    let network = &faces.network;
    let loose = network.loose_ends();
    let all: Vec<Point> = loose
        .iter()
        .map(|&node| network.grid.place(network.nodes[node]))
        .collect();
    let few = &all[..all.len().min(MOST_ENDS)];
    let mut nearest: Option<(f64, [Point; 2])> = None;
    for (k, &a) in few.iter().enumerate() {
        for &b in &few[k + 1..] {
            let apart = distance(a, b);
            if apart > gap && nearest.is_none_or(|(least, _)| apart < least) {
                nearest = Some((apart, [a, b]));
            }
        }
    }
    match nearest {
        Some((apart, [a, b])) => format!(
            ": the nearest open ends of walls are {} and {}, {} m apart; close them, draw an exit or a door between \
             them, or give a larger `plan.gap`",
            shown_point(a),
            shown_point(b),
            to_centimeters(apart)
        ),
        None => ": no wall has an open end, so the openings are between corners; draw an exit or a door across each \
                 opening, or say in `plan.layers` which layers are walls, too"
            .to_owned(),
    }
}
