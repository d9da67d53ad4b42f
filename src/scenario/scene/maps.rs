//! The passages on the routes of agents.

use std::collections::BTreeMap;

use crate::error::quote::to_centimeters;
use engine::journeys::{Choice, Exit, JourneyStage, Kind, Place};
use engine::math::{Vector, direction, perpendicular};
use engine::routes::{Destination, Floor, Goal, Passage, Passages};

/// The distance between the points of a line that stand for it, meters.
const STEP: f64 = 0.1;
/// The most points of a line.
const MOST_STEPS: f64 = 200.0;
/// Behind an exit is what lies this far from its line, meters.
const BESIDE: f64 = 0.05;

/// A part of the routes of a group.
#[derive(Clone, Copy)]
pub struct Leg {
    pub from: Vector,
    pub to: Destination,
    /// The narrowest passage of the widest way.
    pub passage: Passage,
}

/// The passages on the routes to places and goals, found when they are needed.
pub struct Maps<'a> {
    floor: &'a Floor,
    places: &'a [Place],
    of_places: Vec<Option<Vec<Passages>>>,
    of_goals: BTreeMap<[u64; 2], Passages>,
}

impl<'a> Maps<'a> {
    pub fn new(floor: &'a Floor, places: &'a [Place]) -> Self {
        Self {
            floor,
            places,
            of_places: vec![None; places.len()],
            of_goals: BTreeMap::new(),
        }
    }

    /// The place of a stage with the widest way, or the one with the narrowest if agents do not look at the way.
    pub fn leg_to_stage(&mut self, from: Vector, stage: &JourneyStage) -> Option<Leg> {
        let looks = matches!(stage.choice, Choice::Nearest | Choice::Quickest);
        let sign = if looks { -1.0 } else { 1.0 };
        let places = stage.places.iter();
        let legs = places.filter_map(|&place| self.leg(from, Destination::Place(place)));
        let width = |leg: &Leg| sign * leg.passage.width;
        legs.min_by(|a, b| width(a).total_cmp(&width(b)))
    }

    pub fn leg(&mut self, from: Vector, to: Destination) -> Option<Leg> {
        let passage = self.passage(from, to)?;
        Some(Leg { from, to, passage })
    }

    /// The narrowest passage of the widest way to a destination; `None` without a way.
    pub fn passage(&mut self, from: Vector, to: Destination) -> Option<Passage> {
        let floor = self.floor;
        let from = floor.locate(from)?;
        let place = match to {
            Destination::Goal(goal) => {
                let entry = self.of_goals.entry([goal.x, goal.y].map(f64::to_bits));
                let map = entry.or_insert_with(|| floor.passages([goal].into_iter()));
                return map.from(from);
            }
            Destination::Place(place) => usize::from(place),
        };
        let maps = self.of_places[place].get_or_insert_with(|| {
            let maps = sides(&self.places[place])
                .into_iter()
                .map(|points| floor.passages(points.into_iter()));
            maps.collect()
        });
        let found = maps.iter().filter_map(|map| map.from(from));
        found.reduce(Passage::or_narrower)
    }
}

/// Points that agents must reach to have reached a place, all of which stand for the same: behind an exit on both
/// sides.
fn sides(place: &Place) -> Vec<Vec<Vector>> {
    let points_of_goals = place.goals.iter().flat_map(|goal| match *goal {
        Goal::Point(p) => vec![p],
        Goal::Line(ends) => points(ends).collect(),
    });
    let goals: Vec<Vector> = points_of_goals.collect();
    let Kind::Exit(Exit { line: [a, b], .. }) = place.kind else {
        return vec![goals];
    };
    let beside = perpendicular(direction(b - a)) * BESIDE;
    let moved = |way: Vector| goals.iter().map(|p| p + way).collect();
    vec![moved(beside), moved(-beside)]
}

/// Points of a line at equal distances, without its ends.
fn points([a, b]: [Vector; 2]) -> impl Iterator<Item = Vector> {
    let count = ((b - a).norm() / STEP).clamp(1.0, MOST_STEPS).ceil();
    let at = move |k: u32| a + (b - a) * ((f64::from(k) + 0.5) / count);
    (0..count as u32).map(at)
}

/// The width and the place of a passage, in words.
pub fn described(passage: &Passage) -> String {
    let (width, at) = (to_centimeters(passage.width), passage.middle());
    format!(
        "{width} m at ({}, {})",
        to_centimeters(at.x),
        to_centimeters(at.y)
    )
}
