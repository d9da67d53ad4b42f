//! Checks that agents can reach their goals and the places of their journeys.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::Problem;
use crate::error::quote::{shown, to_centimeters};
use crate::scene::maps::{Maps, described};
use crate::scene::routes::{Prepared, To};
use crate::scene::slits;
use engine::journeys::{Choice, JourneyStage};
use engine::math::{Vector, direction, perpendicular};
use engine::routes::{Destination, Floor, Regions, Routes};

/// Points from which people go on to the next stage: of each journey, stage and place that they reach.
pub type Stops = BTreeMap<(u16, usize, u16), Vec<Vector>>;

/// Beside a point is what lies this far from it, meters.
const BESIDE: f64 = 1e-3;

/// Points of a place with the same regions beside them.
struct Stand {
    point: Vector,
    /// The regions of the floor beside it.
    sides: Vec<u32>,
}

/// Where people of a journey choose between the places of a stage.
struct Group {
    /// The point that messages name.
    point: Vector,
    /// What messages call it.
    name: String,
    /// The regions that they reach from there.
    reached: BTreeSet<u32>,
}

/// The places and parts of places that people reach on their journeys.
struct Journeying<'a> {
    prepared: &'a Prepared<'a>,
    regions: Regions<'a>,
    /// The stands of each place.
    stands: Vec<Vec<Stand>>,
    stops: Stops,
    /// The places that somebody can choose.
    chosen: BTreeSet<u16>,
    /// The places that cannot be reached from some point, and the first of these points.
    closed: BTreeMap<u16, Vector>,
}

impl<'a> Journeying<'a> {
    fn new(prepared: &'a Prepared<'a>, routes: &'a Routes) -> Self {
        let regions = Regions::of(routes);
        let places = prepared.places.iter().zip(prepared.reached);
        let stands = places.map(|(place, reached)| {
            let mut stands: Vec<Stand> = Vec::new();
            for &point in &reached.stands {
                let axes = match place.line() {
                    Some([a, b]) => vec![perpendicular(direction(b - a))],
                    None => vec![Vector::x(), Vector::y()],
                };
                let beside = axes.iter().flat_map(|way| [way * BESIDE, way * -BESIDE]);
                let mut sides: Vec<u32> =
                    beside.filter_map(|way| regions.at(point + way)).collect();
                sides.sort_unstable();
                sides.dedup();
                if stands.iter().all(|stand| stand.sides != sides) {
                    stands.push(Stand { point, sides });
                }
            }
            stands
        });
        Self {
            stands: stands.collect(),
            prepared,
            regions,
            stops: Stops::new(),
            chosen: BTreeSet::new(),
            closed: BTreeMap::new(),
        }
    }

    /// Follows people on a journey from the points where they choose between the places of its first stage.
    fn follow(&mut self, journey: u16, start: Group) -> Result<(), Problem> {
        let prepared = self.prepared;
        let mut groups = vec![start];
        let stages = &prepared.scene.journeys.journeys[usize::from(journey)].stages;
        for (k, stage) in stages.iter().enumerate() {
            let mut next: BTreeMap<u16, Group> = BTreeMap::new();
            for group in &groups {
                self.check_stage((journey, stage), group)?;
                for &place in &stage.places {
                    for stand in self.reached(group, place) {
                        let name = &prepared.places[usize::from(place)].name;
                        let on = next.entry(place).or_insert_with(|| Group {
                            point: stand.point,
                            name: format!("`{}`", shown(name)),
                            reached: BTreeSet::new(),
                        });
                        let sides = match self.gets_out(stage, place) {
                            Some(p) => self.regions.nearest(p).into_iter().collect(),
                            None => self.beyond(group, stand),
                        };
                        for side in sides {
                            on.reached.append(&mut self.regions.reached_from(side));
                        }
                    }
                    let reached = self.reached(group, place).map(|stand| stand.point);
                    let ends = reached.map(|p| self.gets_out(stage, place).unwrap_or(p));
                    let points: Vec<Vector> = ends.collect();
                    match points.is_empty() {
                        true => _ = self.closed.entry(place).or_insert(group.point),
                        false => {
                            self.chosen.insert(place);
                            let stops = self.stops.entry((journey, k, place)).or_default();
                            stops.extend(points);
                        }
                    }
                }
            }
            next.retain(|&place, _| !prepared.places[usize::from(place)].is_exit());
            groups = next.into_values().collect();
        }
        Ok(())
    }

    /// The parts of a place that a group reaches.
    fn reached(&self, group: &Group, place: u16) -> impl Iterator<Item = &Stand> {
        let stands = self.stands[usize::from(place)].iter();
        stands.filter(|stand| stand.sides.iter().any(|side| group.reached.contains(side)))
    }

    /// The regions in which those of a group are that have passed a part of a place: behind a one-way door, those that
    /// they did not reach before.
    fn beyond(&self, group: &Group, stand: &Stand) -> Vec<u32> {
        let is_new = |side: &&u32| !group.reached.contains(side);
        let new: Vec<u32> = stand.sides.iter().filter(is_new).copied().collect();
        match new.is_empty() || !self.regions.has_one_way() {
            true => stand.sides.clone(),
            false => new,
        }
    }

    /// Where people get out of the lift for which they wait at a place.
    fn gets_out(&self, stage: &JourneyStage, place: u16) -> Option<Vector> {
        let (scene, level) = (self.prepared.scene, stage.to_level?);
        let (lift, _) = scene.journeys.lift_at(place)?;
        let stop = &lift.stops[lift.stop_on(level)?];
        let levels = scene.levels.as_ref()?;
        Some(stop.entry + levels.way(i32::from(level)))
    }

    /// Checks that a group reaches a place of a stage; all of its places if people choose without looking at the way.
    fn check_stage(
        &self,
        (journey, stage): (u16, &JourneyStage),
        group: &Group,
    ) -> Result<(), Problem> {
        let looks = matches!(stage.choice, Choice::Nearest | Choice::Quickest);
        let is_open = |place: &u16| self.reached(group, *place).next().is_some();
        let mut places = stage.places.iter().copied();
        let missed = match looks {
            true => places.next().filter(|_| !stage.places.iter().any(is_open)),
            false => places.find(|place| !is_open(place)),
        };
        let Some(missed) = missed else {
            return Ok(());
        };
        let prepared = self.prepared;
        // A place has no words after its name.
        let comma = if group.name.contains(',') { "," } else { "" };
        let reason = format!(
            "of `{}`: no way leads from {}{comma} to `{}`: {}",
            shown(&prepared.scene.journeys.journeys[usize::from(journey)].name),
            group.name,
            shown(&prepared.places[usize::from(missed)].name),
            prepared.why_closed(group.point, Destination::Place(missed))?,
        );
        Err(Problem::new("journeys", reason))
    }
}

impl Prepared<'_> {
    /// Checks that all agents can reach their goals.
    pub fn check_goals(&self, routes: &Routes) -> Result<(), Problem> {
        for start in self.starts {
            let To::Goal { goal } = start.to else {
                continue;
            };
            let to = Destination::Goal(goal);
            if self.goals.contains(&goal) && !routes.is_open(start.place, to) {
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

    /// Checks that all agents can reach the places of the first stage of their journey, and from the parts that
    /// they reach those of the next stages. Adds notes about the places that no agent can choose. Returns where people
    /// go on to the next stages.
    pub fn check_journeys(
        &self,
        routes: &Routes,
        notes: &mut Vec<String>,
    ) -> Result<Stops, Problem> {
        let mut journeying = Journeying::new(self, routes);
        let mut known = BTreeSet::new();
        for start in self.starts {
            let To::Journey(journey) = start.to else {
                continue;
            };
            let region = journeying.regions.nearest(start.place);
            if !known.insert((journey, region)) {
                continue;
            }
            let starting = self.origins.starting(start.member);
            let start = Group {
                point: start.place,
                name: format!("({}, {}), where {starting}", start.place.x, start.place.y),
                reached: region.map_or(BTreeSet::new(), |region| {
                    journeying.regions.reached_from(region)
                }),
            };
            journeying.follow(journey, start)?;
        }
        for (&place, &from) in &journeying.closed {
            if !journeying.chosen.contains(&place) {
                let why = self.why_closed(from, Destination::Place(place))?;
                let name = shown(&self.places[usize::from(place)].name);
                notes.push(format!("no agent can choose `{name}`: {why}"));
            }
        }
        Ok(journeying.stops)
    }

    /// What says that all routes are too narrow, and what to do.
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
        if self.routes(self.width)?.is_open(from, to) {
            let why = "one-way doors on every way lead only away from it; turn one of them, or open another way";
            return Ok(why.to_owned());
        }
        let open = self.routes(0.0)?;
        Ok(match open.is_open(from, to) {
            true => self.why_narrow(&self.floor(self.width)?, from, to),
            false => match slits::apart(&self.scene.walls) {
                Some(apart) => format!("{apart}; let them touch or overlap"),
                None => "walls close it off; open them, or move one of the two".to_owned(),
            },
        })
    }
}
