//! Exits, waypoints, waiting areas, queues, journeys and zones of a file → those of a scene.

use std::collections::BTreeMap;

use crate::error::quote::shown;
use crate::error::{Problem, Under, suggestion};
use crate::file::File;
use crate::floor_plan::Rings;
use crate::keys::limits::MOST_NUMBERED;
use crate::keys::places;
use crate::keys::places::Stage;
use crate::scene::changes::changes;
use crate::scene::lifts::lift;
use crate::scene::places::{door, exit, queue, waypoint, zone};
use crate::scene::waiting::waiting_area;
use engine::geometry::Walls;
use engine::journeys::{Choice, Journey, JourneyStage, Journeys, Kind, Place};
use engine::levels::Levels;
use engine::math::Vector;
use engine::scene::RouteChoice;

/// The names of the journey of people without goal and journey in scenarios with exits, by the shortest and by the
/// quickest way.
pub const TO_EXIT: [&str; 2] = ["nearest exit", "quickest exit"];

/// The places, journeys and zones of a file, among `walls`.
///
/// `behind` are the floors behind exits and entrances. Adds notes about waiting areas in walls.
pub fn journeys(
    keys: &File,
    (walls, behind, levels): (&Walls, &Rings, Option<&Levels>),
    notes: &mut Vec<String>,
) -> Result<Journeys, Problem> {
    let mut found = Builder {
        walls,
        behind,
        levels,
        notes,
        journeys: Journeys::default(),
        numbers: BTreeMap::new(),
    };
    found.add_places(keys)?;
    for (k, given) in keys.lifts.iter().enumerate() {
        found.add_lift(given, keys).under(&format!("lifts[{k}]"))?;
    }
    for (k, given) in keys.journeys.iter().enumerate() {
        found.add_journey(given).under(&format!("journeys[{k}]"))?;
    }
    let numbers = keys.exits.iter().map(|exit| found.numbers[&exit.name]);
    let exits: Vec<u16> = numbers.collect();
    if !exits.is_empty() {
        let [nearest, quickest] = TO_EXIT;
        let (name, choice) = match keys.route_choice.unwrap_or_default() {
            RouteChoice::Shortest => (nearest, Choice::Nearest),
            RouteChoice::Quickest => (quickest, Choice::Quickest),
        };
        found.journeys.journeys.push(Journey {
            name: name.to_owned(),
            stages: vec![JourneyStage {
                choice,
                places: exits,
                to_level: None,
            }],
        });
    }
    for (k, given) in keys.zones.iter().enumerate() {
        found.journeys.zones.push(zone(k, given)?);
    }
    let changes = changes(keys, &found.journeys.places, |name| found.number(name))?;
    found.journeys.changes = changes;
    found.check_waits()?;
    Ok(found.journeys)
}

/// Places and journeys so far.
struct Builder<'a> {
    walls: &'a Walls,
    behind: &'a Rings,
    levels: Option<&'a Levels>,
    notes: &'a mut Vec<String>,
    journeys: Journeys,
    /// The number of each place by its name.
    numbers: BTreeMap<String, u16>,
}

impl Builder<'_> {
    fn add_places(&mut self, keys: &File) -> Result<(), Problem> {
        for (k, given) in keys.exits.iter().enumerate() {
            let exit = exit(given);
            self.add("exits", k, &given.name, exit)?;
        }
        for (k, given) in keys.waypoints.iter().enumerate() {
            self.add("waypoints", k, &given.name, waypoint(given))?;
        }
        for (k, given) in keys.waiting_areas.iter().enumerate() {
            let place = format!("waiting_areas[{k}]");
            let area = waiting_area(given, self.walls, self.behind);
            let (kind, note) = area.under(&place)?;
            self.notes
                .extend(note.map(|note| format!("{place}.{note}")));
            self.add("waiting_areas", k, &given.name, Ok(kind))?;
        }
        let exits = keys.exits.iter().map(|exit| exit.line);
        let lines = exits.chain(keys.entrances.iter().map(|entrance| entrance.line.0));
        let lines: Vec<[Vector; 2]> = lines.map(|line| line.map(Vector::from)).collect();
        for (k, given) in keys.queues.iter().enumerate() {
            let queue = queue(given, self.walls, &lines);
            self.add("queues", k, &given.name, queue)?;
        }
        for (k, given) in keys.doors.iter().enumerate() {
            self.add("doors", k, &given.name, door(given))?;
        }
        Ok(())
    }

    fn add_lift(&mut self, given: &places::Lift, keys: &File) -> Result<(), Problem> {
        let Some(levels) = self.levels else {
            return Err(Problem::new(
                "",
                "there are no `levels` between which it moves",
            ));
        };
        if self
            .journeys
            .lifts
            .iter()
            .any(|lift| lift.name == given.name)
        {
            let reason = format!(
                "there are two lifts named `{}`; rename one",
                shown(&given.name)
            );
            return Err(Problem::new("name", reason));
        }
        let mut stops = Vec::with_capacity(given.stops.len());
        for (k, name) in given.stops.iter().enumerate() {
            let place = format!("stops[{k}]");
            let number = self.number(name).under(&place)?;
            let waiting = match &self.journeys.places[usize::from(number)].kind {
                Kind::Waiting(waiting) if waiting.until.is_none() && waiting.lasting.is_none() => {
                    waiting
                }
                Kind::Waiting(_) => {
                    let reason =
                        "people wait there for the lift: leave out `until_secs` and `for_secs`";
                    return Err(Problem::new(place, reason));
                }
                _ => {
                    let reason = format!("`{}` is no waiting area", shown(name));
                    return Err(Problem::new(place, reason));
                }
            };
            let is_released = keys
                .events
                .iter()
                .any(|event| event.release.as_ref() == Some(name));
            if is_released || self.journeys.lift_at(number).is_some() {
                let reason = format!(
                    "`{}` is that of another lift, or an event releases it",
                    shown(name)
                );
                return Err(Problem::new(place, reason));
            }
            stops.push((number, waiting));
        }
        let lift = lift(given, &stops, (self.walls, self.behind, levels))?;
        self.journeys.lifts.push(lift);
        Ok(())
    }

    fn add(
        &mut self,
        list: &str,
        k: usize,
        name: &str,
        kind: Result<Kind, Problem>,
    ) -> Result<(), Problem> {
        let place = format!("{list}[{k}]");
        let number = self.journeys.places.len();
        if number >= MOST_NUMBERED {
            let reason = format!("more than {MOST_NUMBERED} places");
            return Err(Problem::new(place, reason));
        }
        let other = self.numbers.insert(name.to_owned(), number as u16);
        if other.is_some() {
            let reason = format!("there are two places named `{}`; rename one", shown(name));
            return Err(Problem::new(format!("{place}.name"), reason));
        }
        let kind = kind.under(&place)?;
        self.journeys.places.push(Place::new(name.to_owned(), kind));
        Ok(())
    }

    fn number(&self, name: &str) -> Result<u16, Problem> {
        self.numbers.get(name).copied().ok_or_else(|| {
            let names = self.numbers.keys().map(String::as_str);
            let near = suggestion(name, names.clone());
            let known: Vec<String> = names.map(|name| format!("`{name}`")).collect();
            let known = match known.as_slice() {
                [] => "; the scenario has no exits, waypoints, waiting areas, queues or doors"
                    .to_owned(),
                names if near.is_empty() => format!("; there are {}", names.join(", ")),
                _ => String::new(),
            };
            let reason = format!("there is no place named `{}`{near}{known}", shown(name));
            Problem::new("", reason)
        })
    }

    /// The number of a place that people visit.
    fn visited(&self, name: &str) -> Result<u16, Problem> {
        let number = self.number(name)?;
        match &self.journeys.places[usize::from(number)].kind {
            Kind::Door(_) => {
                let reason = format!(
                    "`{}` is a door, which people pass on their way; give a waypoint with its line",
                    shown(name)
                );
                Err(Problem::new("", reason))
            }
            _ => Ok(number),
        }
    }

    fn add_journey(&mut self, given: &places::Journey) -> Result<(), Problem> {
        let is_known = |journey: &Journey| journey.name == given.name;
        if self.journeys.journeys.iter().any(is_known) || TO_EXIT.contains(&&*given.name) {
            let reason = format!(
                "there are two journeys named `{}`; rename one",
                shown(&given.name)
            );
            return Err(Problem::new("name", reason));
        }
        let stages = given.stages.iter().enumerate();
        let checked = stages.map(|(k, stage)| self.stage(stage).under(&format!("stages[{k}]")));
        let stages: Vec<JourneyStage> = checked.collect::<Result<_, _>>()?;
        let is_exit = |&place: &u16| self.journeys.places[usize::from(place)].is_exit();
        let early = stages.split_last().and_then(|(_, before)| {
            before.iter().position(|stage| {
                let leaves_some =
                    matches!(stage.choice, Choice::Shares(_)) && !stage.places.iter().all(is_exit);
                stage.places.iter().any(is_exit) && !leaves_some
            })
        });
        if let Some(k) = early {
            let reason = "people leave at an exit, so it must be in the last stage; before it, some can leave: give \
                          `shares` with an exit and other places";
            return Err(Problem::new(format!("stages[{k}]"), reason));
        }
        self.journeys.journeys.push(Journey {
            name: given.name.clone(),
            stages,
        });
        Ok(())
    }

    fn stage(&self, given: &Stage) -> Result<JourneyStage, Problem> {
        let choice = match given {
            Stage::Place(name) => {
                return Ok(JourneyStage {
                    choice: Choice::Nearest,
                    places: vec![self.visited(name)?],
                    to_level: None,
                });
            }
            Stage::Choice(choice) if choice.lifts.is_some() || choice.to.is_some() => {
                return self.ride(choice);
            }
            Stage::Choice(choice) => choice,
        };
        let places::Choice {
            nearest,
            quickest,
            fewest,
            shares,
            ..
        } = choice;
        let lists = [
            (Choice::Nearest, "nearest", nearest),
            (Choice::Quickest, "quickest", quickest),
            (Choice::Fewest, "fewest", fewest),
        ];
        let mut given = lists.into_iter().filter_map(|(choice, key, names)| {
            let names = names.as_ref()?;
            Some((choice, key, names.iter().collect::<Vec<_>>()))
        });
        let shares = shares.as_ref().map(|shares| {
            let weights = shares.values().copied().collect();
            (Choice::Shares(weights), "shares", shares.keys().collect())
        });
        let (Some((choice, key, names)), None) = (given.next().or(shares), given.next()) else {
            let reason = "give one of `nearest`, `quickest`, `fewest` and `shares`";
            return Err(Problem::new("", reason));
        };
        if let Choice::Shares(weights) = &choice
            && weights.iter().all(|&weight| weight == 0.0)
        {
            let reason = "the weights must have a sum above 0";
            return Err(Problem::new(key, reason));
        }
        let mut places: Vec<u16> = Vec::new();
        for (k, name) in names.into_iter().enumerate() {
            let place = format!("{key}[{k}]");
            let number = self.visited(name).under(&place)?;
            if places.contains(&number) {
                let reason = format!("`{}` is listed twice; remove one", shown(name));
                return Err(Problem::new(place, reason));
            }
            places.push(number);
        }
        Ok(JourneyStage {
            choice,
            places,
            to_level: None,
        })
    }

    /// A ride by one of some lifts to a level.
    fn ride(&self, choice: &places::Choice) -> Result<JourneyStage, Problem> {
        let lists = [&choice.nearest, &choice.quickest, &choice.fewest];
        let is_alone = lists.iter().all(|list| list.is_none()) && choice.shares.is_none();
        let (Some(names), Some(to), true) = (&choice.lifts, &choice.to, is_alone) else {
            return Err(Problem::new(
                "",
                "give `lifts` and `to`, and no other choice",
            ));
        };
        let levels = self.levels.into_iter().flat_map(Levels::all);
        let names_of_levels = || levels.clone().map(|level| level.name.as_str());
        let Some(level) = names_of_levels().position(|name| name == to) else {
            let near = suggestion(to, names_of_levels());
            let reason = format!("there is no level named `{}`{near}", shown(to));
            return Err(Problem::new("to", reason));
        };
        let mut places = Vec::new();
        for (k, name) in names.iter().enumerate() {
            let place = format!("lifts[{k}]");
            let lifts = &self.journeys.lifts;
            let Some(lift) = lifts.iter().find(|lift| lift.name == *name) else {
                let near = suggestion(name, lifts.iter().map(|lift| lift.name.as_str()));
                let reason = format!("there is no lift named `{}`{near}", shown(name));
                return Err(Problem::new(place, reason));
            };
            if lift.stop_on(level as u16).is_none() {
                let reason = format!("`{}` does not stop on `{}`", shown(name), shown(to));
                return Err(Problem::new(place, reason));
            }
            let others = lift
                .stops
                .iter()
                .filter(|stop| usize::from(stop.level) != level);
            places.extend(others.map(|stop| stop.place));
        }
        Ok(JourneyStage {
            choice: Choice::Nearest,
            places,
            to_level: Some(level as u16),
        })
    }

    /// Checks that agents do not wait forever before the last stage of a journey.
    fn check_waits(&self) -> Result<(), Problem> {
        let Journeys {
            places,
            journeys,
            changes,
            ..
        } = &self.journeys;
        let is_endless = |&place: &u16| match &places[usize::from(place)].kind {
            Kind::Waiting(waiting) => {
                let released = changes.iter().any(|change| change.place == place);
                waiting.until.is_none() && waiting.lasting.is_none() && !released
            }
            _ => false,
        };
        for (k, journey) in journeys.iter().enumerate() {
            let before_last = journey.stages.iter().rev().skip(1);
            let kept = before_last.filter(|stage| stage.to_level.is_none());
            let mut visited = kept.flat_map(|stage| stage.places.iter().copied());
            if let Some(place) = visited.find(is_endless) {
                let name = shown(&places[usize::from(place)].name);
                let mend = "`until_secs`, `for_secs` or an event that releases it";
                let reason = format!("agents would wait forever in `{name}`: give it {mend}");
                return Err(Problem::new(format!("journeys[{k}]"), reason));
            }
        }
        Ok(())
    }
}
