//! The bodies of a scene and the passages on their routes: which they pass, and which only with turned shoulders.

use std::collections::BTreeMap;

use crate::error::Problem;
use crate::error::quote::{shown, to_centimeters};
use crate::scene::maps::{Leg, Maps, described};
use crate::scene::origin::Member;
use crate::scene::reach::Stops;
use crate::scene::routes::{Prepared, To};
use crate::scene::widest::SIDEWAYS;
use engine::routes::{Destination, Floor};

impl Prepared<'_> {
    /// Checks that the widest body of each group passes all passages on the widest of its routes. Adds notes on those
    /// that it passes with turned shoulders only, or in which it can stick.
    ///
    /// `stops` are the points where people go on to the next stage.
    pub fn check_bodies(
        &self,
        floor: &Floor,
        stops: &Stops,
        notes: &mut Vec<String>,
    ) -> Result<(), Problem> {
        let widths = self.widest.iter().map(|widest| widest.width);
        let most = widths.fold(0.0, f64::max);
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
                "{name}: on the way to {to}, bodies {width} m wide {what} in a passage of {passage}: one of them alone \
                 may stay there, more often the shorter the time step"
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

    /// For each of the widest bodies, the leg of its routes with the narrowest passage.
    fn narrowest_legs(&self, floor: &Floor, stops: &Stops) -> Vec<Option<Leg>> {
        let mut maps = Maps::new(floor, self.places);
        let key = |member: Member| (member.group, self.origins.single(member));
        let widest = self.widest.iter().enumerate();
        let numbers: BTreeMap<_, usize> = widest.map(|(k, w)| (key(w.member), k)).collect();
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
