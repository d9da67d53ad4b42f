//! The bodies of a scene and the passages on their ways: which they pass, and which only with turned shoulders.

use std::collections::BTreeMap;

use crate::error::Problem;
use crate::error::quote::{shown, to_centimeters};
use crate::scene::entrances::NEARLY_ALL;
use crate::scene::origin::{Member, Origins};
use crate::scene::reach::Stops;
use crate::scene::ways::{Prepared, To};
use engine::agents::RADIUS_RANGE;
use engine::journeys::{Choice, Exit, JourneyStage, Kind, Place};
use engine::math::{Vector, direction, perpendicular};
use engine::profile::Blend;
use engine::scene::Scene;
use engine::ways::{Destination, Floor, Goal, Passage, Passages};

/// The part of its width that a body needs with turned shoulders. Adults are 0.46 m wide and 0.28 m deep in summer
/// dress, 0.50 m and 0.32 m in winter dress (Predtechenskii and Milinskii 1978): 0.61 and 0.64. The widest 5 % of men
/// are 0.58 m and 0.33 m without clothes, 0.63 m and 0.38 m with them (Pheasant 1996): 0.57 and 0.60.
pub const SIDEWAYS: f64 = 0.6;
/// Agents that walk straight into a passage stick in it alone below this part of their width: with RVO, which keeps a
/// distance from walls, and without. Measured with all profiles and radii up to 0.3 m: at most 1.08 and 0.98.
const ALONE_RVO: f64 = 1.1;
const ALONE: f64 = 1.0;
/// The same where a part of the radius counts in contacts with walls: at least this.
const LEAST_ALONE: f64 = 0.8;

/// The distance between the points of a line that stand for it, meters.
const STEP: f64 = 0.1;
/// The most points of a line.
const MOST_STEPS: f64 = 200.0;
/// Behind an exit is what lies this far from its line, meters.
const BESIDE: f64 = 0.05;

/// The widest body of a group.
#[derive(Debug, Clone, Copy)]
pub struct Widest {
    /// An agent of the group, or the group.
    pub member: Member,
    /// The width of the body, meters.
    pub width: f64,
    /// The narrowest passage in which it does not stick alone, meters.
    pub alone: f64,
}

impl Widest {
    /// The widest body of each group that has agents; of single agents, that of each.
    pub fn all(scene: &Scene, origins: &Origins) -> Vec<Self> {
        let mut found: BTreeMap<(u16, Option<usize>), Self> = BTreeMap::new();
        let mut add = |member: Member, radius: f64| {
            let blend = &scene.groups[usize::from(member.group)].blend;
            let width = 2.0 * radius;
            let alone = width * part_alone(blend);
            let new = Self {
                member,
                width,
                alone,
            };
            let key = (member.group, origins.single(member));
            let widest = found.entry(key).or_insert(new);
            if width > widest.width {
                *widest = new;
            }
        };
        let of_group = |group: u16| {
            let traits = &scene.groups[usize::from(group)].traits;
            let radius = traits.radius.as_ref();
            radius.map_or(RADIUS_RANGE[1], |radius| radius.quantile(NEARLY_ALL))
        };
        for (k, agent) in scene.agents.iter().enumerate() {
            let member = Member {
                agent: Some(k),
                group: agent.group,
            };
            let own = origins.single(member).and(agent.radius);
            add(member, own.unwrap_or_else(|| of_group(agent.group)));
        }
        let later = scene.sources.iter().map(|source| (source.group, None));
        let later = later.chain(scene.entrances.iter().map(|one| (one.group, None)));
        let people = scene.latecomers.iter().map(|late| &late.agent);
        let later = later.chain(people.map(|agent| (agent.group, agent.radius)));
        for (group, own) in later {
            let member = Member { agent: None, group };
            add(member, own.unwrap_or_else(|| of_group(group)));
        }
        found.into_values().collect()
    }
}

/// The narrowest passage that an agent passes alone, as a part of its width.
fn part_alone(blend: &Blend) -> f64 {
    if blend.rvo().is_some() {
        return ALONE_RVO;
    }
    let scales = blend.steps().iter();
    let scales = scales.map(|step| step.profile.contact.wall_contact_scale);
    ALONE * scales.fold(LEAST_ALONE, f64::max)
}

/// A part of the ways of a group.
#[derive(Clone, Copy)]
struct Leg {
    from: Vector,
    to: Destination,
    /// The narrowest passage of the widest way.
    passage: Passage,
}

impl Prepared<'_> {
    /// Checks that the widest body of each group passes all passages on the widest of its ways. Adds notes on those
    /// that it passes with turned shoulders only, or in which it can stick.
    ///
    /// `stops` are the points where people go on to the next stage.
    pub fn check_bodies(
        &self,
        floor: &Floor,
        stops: &Stops,
        notes: &mut Vec<String>,
    ) -> Result<(), Problem> {
        let most = self.widest.iter().map(|widest| widest.width);
        let most = most.fold(0.0, f64::max);
        let wider = match self.width < most {
            true => Some(self.floor(most)?),
            false => None,
        };
        let floor = wider.as_ref().unwrap_or(floor);
        if !floor.has_closed() {
            return Ok(());
        }
        for (widest, leg) in self.widest.iter().zip(self.narrowest_legs(floor, stops)) {
            let Some(leg) = leg.filter(|leg| leg.passage.width < widest.width) else {
                continue;
            };
            let (name, to) = (self.origins.name(widest.member), self.named(leg.to));
            let (width, passage) = (to_centimeters(widest.width), described(&leg.passage));
            let sideways = SIDEWAYS * widest.width;
            if leg.passage.width < sideways {
                let reason = format!(
                    "no way from ({}, {}) to {to} is wide enough for {name}: bodies {width} m wide need {} m with \
                     turned shoulders, and the widest way has a passage of {passage}; widen it, or give a smaller \
                     `radius`",
                    to_centimeters(leg.from.x),
                    to_centimeters(leg.from.y),
                    to_centimeters(sideways),
                );
                return Err(Problem::new("", reason));
            }
            let what = match leg.passage.width < widest.alone {
                true => "can stick",
                false => "fit only with turned shoulders",
            };
            notes.push(format!(
                "{name}: on the way to {to}, bodies {width} m wide {what} in a passage of {passage}"
            ));
        }
        Ok(())
    }

    fn named(&self, to: Destination) -> String {
        match to {
            Destination::Goal(goal) => format!("({}, {})", goal.x, goal.y),
            Destination::Place(place) => {
                format!("`{}`", shown(&self.places[usize::from(place)].name))
            }
        }
    }

    /// For each of the widest bodies, the leg of its ways with the narrowest passage.
    fn narrowest_legs(&self, floor: &Floor, stops: &Stops) -> Vec<Option<Leg>> {
        let mut maps = Maps::new(floor, self.places);
        let key = |member: Member| (member.group, self.origins.single(member));
        let numbers = self.widest.iter().enumerate();
        let numbers: BTreeMap<_, usize> = numbers.map(|(k, w)| (key(w.member), k)).collect();
        let mut narrowest: Vec<Option<Leg>> = vec![None; self.widest.len()];
        let mut journeys = BTreeMap::new();
        for start in self.starts {
            let Some(&number) = numbers.get(&key(start.member)) else {
                continue;
            };
            let leg = match start.to {
                To::Goal { goal, .. } if self.goals.contains(&goal) => {
                    maps.leg(start.place, Destination::Goal(goal))
                }
                To::Journey(journey) => {
                    journeys.insert(number, journey);
                    let stages = &self.scene.journeys.journeys[usize::from(journey)].stages;
                    maps.leg_to_stage(start.place, &stages[0])
                }
                To::Goal { .. } | To::Away => None,
            };
            narrower(&mut narrowest[number], leg);
        }
        for (number, journey) in journeys {
            let stages = &self.scene.journeys.journeys[usize::from(journey)].stages;
            for (k, pair) in stages.windows(2).enumerate() {
                for &place in &pair[0].places {
                    let from = stops.get(&(journey, k, place)).into_iter().flatten();
                    let legs = from.filter_map(|&from| maps.leg_to_stage(from, &pair[1]));
                    let widest = legs.max_by(|a, b| a.passage.width.total_cmp(&b.passage.width));
                    narrower(&mut narrowest[number], widest);
                }
            }
        }
        narrowest
    }
}

/// Replaces a leg by one with a narrower passage.
fn narrower(before: &mut Option<Leg>, leg: Option<Leg>) {
    if let Some(leg) = leg
        && before.is_none_or(|before| leg.passage.width < before.passage.width)
    {
        *before = Some(leg);
    }
}

/// The passages on the ways to places and goals, found when they are needed.
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
    fn leg_to_stage(&mut self, from: Vector, stage: &JourneyStage) -> Option<Leg> {
        let looks = matches!(stage.choice, Choice::Nearest | Choice::Quickest);
        let sign = if looks { -1.0 } else { 1.0 };
        let places = stage.places.iter();
        let legs = places.filter_map(|&place| self.leg(from, Destination::Place(place)));
        let width = |leg: &Leg| sign * leg.passage.width;
        legs.min_by(|a, b| width(a).total_cmp(&width(b)))
    }

    fn leg(&mut self, from: Vector, to: Destination) -> Option<Leg> {
        let passage = self.passage(from, to)?;
        Some(Leg { from, to, passage })
    }

    /// The narrowest passage of the widest way to a destination; `None` without a way.
    pub fn passage(&mut self, from: Vector, to: Destination) -> Option<Passage> {
        let floor = self.floor;
        let from = floor.locate(from)?;
        let place = match to {
            Destination::Goal(goal) => {
                let map = self.of_goals.entry([goal.x, goal.y].map(f64::to_bits));
                let map = map.or_insert_with(|| floor.passages([goal].into_iter()));
                return map.from(from);
            }
            Destination::Place(place) => usize::from(place),
        };
        let maps = self.of_places[place].get_or_insert_with(|| {
            let maps = sides(&self.places[place]).into_iter();
            let maps = maps.map(|points| floor.passages(points.into_iter()));
            maps.collect()
        });
        let found = maps.iter().filter_map(|map| map.from(from));
        found.reduce(Passage::or_narrower)
    }
}

/// Points that agents must reach to have reached a place, all of which stand for the same: behind an exit on both
/// sides.
fn sides(place: &Place) -> Vec<Vec<Vector>> {
    let goals = place.goals.iter();
    let goals = goals.flat_map(|goal| match *goal {
        Goal::Point(p) => vec![p],
        Goal::Line(ends) => points(ends).collect(),
    });
    let goals: Vec<Vector> = goals.collect();
    let Kind::Exit(Exit { line: [a, b], .. }) = place.kind else {
        return vec![goals];
    };
    let beside = perpendicular(direction(b - a)) * BESIDE;
    [beside, -beside]
        .map(|beside| goals.iter().map(|p| p + beside).collect())
        .to_vec()
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
