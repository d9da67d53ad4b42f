//! Checks that agents can reach their goals and the places of their journeys.

use std::collections::{BTreeMap, BTreeSet};

use crate::engine::journeys::{Choice, JourneyStage};
use crate::engine::math::Vector;
use crate::engine::ways::{Destination, Floor, Ways};
use crate::scenario::build::bodies::{Maps, described};
use crate::scenario::build::ways::{Prepared, To};
use crate::scenario::error::Problem;
use crate::scenario::error::quote::{shown, to_centimeters};

/// A point from which agents choose between the places of a stage.
struct Stand<'a> {
    point: Vector,
    /// What messages call it.
    name: &'a dyn Fn() -> String,
    /// The number of the journey.
    journey: u16,
}

/// The places that agents reach from one stage.
#[derive(Default)]
struct Reached {
    places: BTreeSet<u16>,
    /// The places that cannot be reached from some point, and the first of these points.
    closed: BTreeMap<u16, Vector>,
}

impl Prepared<'_> {
    /// Checks that all agents can reach their goals.
    pub fn check_goals(&self, ways: &Ways) -> Result<(), Problem> {
        for start in self.starts {
            let To::Goal { goal } = start.to else {
                continue;
            };
            let to = Destination::Goal(goal);
            if self.goals.contains(&goal) && !ways.is_open(start.place, to) {
                let reason = format!(
                    "no way leads from ({}, {}), where {}, to the goal ({}, {}): {}; or set \
                     `navigation` to `straight`",
                    start.place.x,
                    start.place.y,
                    self.origins.starting(start.member),
                    goal.x,
                    goal.y,
                    self.why_closed(start.place, to)?,
                );
                return Err(Problem::new(self.origins.goal_key(start.member), reason));
            }
        }
        Ok(())
    }

    /// Checks that all agents can reach the places of the first stage of their journey, and from there those of the
    /// next stages. Returns notes about the places that no agent can choose.
    pub fn check_journeys(&self, ways: &Ways) -> Result<Vec<String>, Problem> {
        let journeys = &self.scene.journeys.journeys;
        let mut first: BTreeMap<u16, Reached> = BTreeMap::new();
        for start in self.starts {
            if let To::Journey(journey) = start.to {
                let name = || {
                    let starting = self.origins.starting(start.member);
                    format!("({}, {}), where {starting}", start.place.x, start.place.y)
                };
                let from = Stand {
                    point: start.place,
                    name: &name,
                    journey,
                };
                let stage = &journeys[usize::from(journey)].stages[0];
                self.check_stage(ways, &from, stage, first.entry(journey).or_default())?;
            }
        }
        let (mut chosen, mut closed) = (BTreeSet::new(), BTreeMap::new());
        for (journey, mut before) in first {
            for pair in journeys[usize::from(journey)].stages.windows(2) {
                let mut next = Reached::default();
                let places = pair[0].places.iter();
                for place in places.filter(|place| before.places.contains(place)) {
                    let place = &self.places[usize::from(*place)];
                    if place.is_exit() {
                        continue; // people leave there
                    }
                    let from = Stand {
                        point: place.nearest_point(Vector::zeros()),
                        name: &|| format!("`{}`", shown(&place.name)),
                        journey,
                    };
                    self.check_stage(ways, &from, &pair[1], &mut next)?;
                }
                chosen.append(&mut before.places);
                closed.append(&mut before.closed);
                before = next;
            }
            chosen.append(&mut before.places);
            closed.append(&mut before.closed);
        }
        let never = closed
            .into_iter()
            .filter(|(place, _)| !chosen.contains(place));
        let note = |(place, from)| {
            let why = self.why_closed(from, Destination::Place(place))?;
            let name = shown(&self.places[usize::from(place)].name);
            Ok(format!("no agent can choose `{name}`: {why}"))
        };
        never.map(note).collect()
    }

    /// Checks that agents reach a place of `stage` from a point; all of its places if they choose without looking at
    /// the way. Adds these places to `reached`.
    fn check_stage(
        &self,
        ways: &Ways,
        from: &Stand,
        stage: &JourneyStage,
        reached: &mut Reached,
    ) -> Result<(), Problem> {
        let is_open = |place: u16| ways.is_open(from.point, Destination::Place(place));
        let looks = matches!(stage.choice, Choice::Nearest | Choice::Quickest);
        let places = || stage.places.iter().copied();
        // Places that others reach are not looked up again.
        let new = places().filter(|place| !reached.places.contains(place));
        let (open, closed): (Vec<u16>, Vec<u16>) = new.partition(|&place| is_open(place));
        let known = |place: &u16| reached.places.contains(place);
        let is_any_open = !open.is_empty() || places().any(|place| known(&place) && is_open(place));
        let missed = match looks {
            true => places().next().filter(|_| !is_any_open),
            false => places().find(|&place| !is_open(place)),
        };
        if let Some(missed) = missed {
            let reason = format!(
                "of `{}`: no way leads from {}, to `{}`: {}",
                shown(&self.scene.journeys.journeys[usize::from(from.journey)].name),
                (from.name)(),
                shown(&self.places[usize::from(missed)].name),
                self.why_closed(from.point, Destination::Place(missed))?,
            );
            return Err(Problem::new("journeys", reason));
        }
        reached.places.extend(open);
        for place in closed {
            reached.closed.entry(place).or_insert(from.point);
        }
        Ok(())
    }

    /// What says that all ways are too narrow, and what to do.
    fn why_narrow(&self, floor: &Floor, from: Vector, to: Destination) -> String {
        let passage = Maps::new(floor, self.places).passage(from, to);
        let widest = passage.map_or(String::new(), |passage| {
            format!("; the widest way has one of {}", described(&passage))
        });
        let setter = self
            .widest
            .iter()
            .min_by(|a, b| b.alone.total_cmp(&a.alone)); // the first of the widest
        match setter.filter(|_| !self.is_given) {
            Some(setter) => format!(
                "every way there has a passage narrower than {} m, too narrow for {}, up to {} m wide{widest}: widen \
                 it, give a smaller `radius`, or set `min_passage_width`",
                to_centimeters(self.width),
                self.origins.name(setter.member),
                to_centimeters(setter.width),
            ),
            None => format!(
                "every way there has a passage narrower than `min_passage_width`, {} m{widest}: widen it, or lower \
                 that",
                self.width
            ),
        }
    }

    /// Why no way leads to a destination, and what to do.
    fn why_closed(&self, from: Vector, to: Destination) -> Result<String, Problem> {
        if self.ways(self.width)?.is_open(from, to) {
            let why = "one-way doors on every way lead only away from it; turn one of them, or open another way";
            return Ok(why.to_owned());
        }
        let open = self.ways(0.0)?;
        Ok(match open.is_open(from, to) {
            true => self.why_narrow(&self.floor(self.width)?, from, to),
            false => "walls close it off; open them, or move one of the two".to_owned(),
        })
    }
}
