//! A push that runs through a row of people, in a run or in the data from which it begins.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Measure, Observed, Quantity, is_due};
use crate::error::Problem;
use crate::keys::shapes::Point;
use crate::trajectories::Tracks;
use analysis::evaluated::Evaluated;
use analysis::push::Pushed;
use engine::math::{Vector, direction};
use engine::scene::Scene;
use engine::simulation::Simulation;

/// The name of the values if none is given.
const NAME: &str = "push";
/// The most people whose values have names.
const MOST: u32 = 100;

/// A push through a row of people, who are numbered along it: the speed of the front, the momentum passed on, and the
/// top speed and the displacement of each person.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Push {
    /// The beginning of the names of its values. Default: `push`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    /// The number of people with values of their own, from the beginning of the row on.
    #[schemars(range(min = 1, max = MOST))]
    people: u32,
    /// The direction of the push, along which places are measured. Default: along x.
    #[serde(default = "along_x")]
    direction: Point,
    /// Time between two samples, seconds.
    #[schemars(range(max = 1), extend("exclusiveMinimum" = 0))]
    #[serde(default = "every")]
    every_secs: f64,
}

fn along_x() -> Point {
    Point([1.0, 0.0])
}

/// 25 samples per second, as many cameras take.
fn every() -> f64 {
    0.04
}

/// What was seen so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Seen {
    /// Time between two samples, seconds.
    every: f64,
    /// The people of the first frame, with their places along the row.
    people: Vec<(u32, Vec<f64>)>,
}

impl Push {
    fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(NAME)
    }

    fn way(&self) -> Vector {
        direction(Vector::from(self.direction))
    }

    /// The values, by their names, for people in `tracks` from the time `at` in it, seconds, on: their places are taken
    /// at the frames of a run of `scene` that begins at `at`.
    pub fn of_tracks(&self, tracks: &Tracks, at: f64, scene: &Scene) -> Vec<(String, Option<f64>)> {
        let clock = scene.clock;
        let every = clock.time_at(clock.frame_at(self.every_secs).max(1));
        let near = tracks.rounding();
        let places = |p: usize| {
            let [first, last] = tracks.times_of(p);
            let samples = ((last + near - at) / every).floor().max(0.0) as usize;
            let place = |k: usize| tracks.place_at(p, at + k as f64 * every).dot(&self.way());
            (first <= at + near).then(|| (p as u32, (0..=samples).map(place).collect()))
        };
        let seen = Seen {
            every,
            people: (0..tracks.ids.len()).filter_map(places).collect(),
        };
        let measured = Quantity::paired(self.quantities(), self.results(&seen));
        measured.map(|(one, value)| (one.name, value)).collect()
    }

    fn results(&self, seen: &Seen) -> Vec<Option<f64>> {
        let people = seen.people.iter();
        let pushed = people.filter_map(|(_, places)| Pushed::of(places, seen.every));
        let mut row: Vec<Pushed> = pushed.collect();
        row.sort_by(|a, b| a.place.total_cmp(&b.place));
        let of_each = |value: fn(&Pushed) -> f64| {
            let row = &row;
            (0..self.people as usize).map(move |k| row.get(k).map(value))
        };
        let of_row = [
            Pushed::front(&row),
            Pushed::front_of_starts(&row),
            Pushed::passed_on(&row),
        ];
        let of_people = of_each(|one| one.top_speed).chain(of_each(|one| one.reach));
        of_row.into_iter().chain(of_people).collect()
    }
}

impl Measure for Push {
    type Seen = Seen;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn check(&self) -> Result<(), Problem> {
        match self.way() == Vector::zeros() {
            true => Err(Problem::new("push.direction", "must not be [0, 0]")),
            false => Ok(()),
        }
    }

    fn quantities(&self) -> Vec<Quantity> {
        let fronts = [
            (
                "front_m_per_s",
                "m/s",
                "speed of the front: the median, over six speeds, of the slowness with which people reach them",
            ),
            (
                "break_m_per_s",
                "m/s",
                "speed of the front through the times at which people start: breaks of two straight lines",
            ),
            (
                "passed_on_m_per_s",
                "m/s",
                "largest sum of the speeds of all people but the first at one time",
            ),
        ];
        let of_row = Quantity::all(self.name(), &fronts);
        let of_each = |what: &str, [unit, end]: [&'static str; 2], meaning: &str| {
            let name = |k| format!("{}_{what}_{k}_{end}", self.name());
            let quantity = |k| Quantity::new(name(k), unit, &format!("{meaning} {k}"));
            (1..=self.people).map(quantity).collect::<Vec<_>>()
        };
        let top_speeds = of_each("top_speed", ["m/s", "m_per_s"], "top speed of person");
        let reaches = of_each("reach", ["m", "m"], "largest displacement of person");
        [of_row, top_speeds, reaches].concat()
    }

    fn observe(&self, seen: &mut Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        if !is_due(simulation, [0.0, f64::MAX], self.every_secs) {
            return;
        }
        let (clock, agents) = (simulation.frame().clock, simulation.frame().agents);
        if clock.frame() == 0 {
            seen.every = clock.time_at(clock.frame_at(self.every_secs).max(1));
            let there = agents.present().map(|i| (agents.id[i], Vec::new()));
            seen.people = there.collect();
        }
        let way = self.way();
        for (id, places) in &mut seen.people {
            if let Some(i) = agents.index_of(*id) {
                places.push(agents.position[i].dot(&way));
            }
        }
    }

    fn values(&self, seen: &Seen, _: &Simulation) -> Vec<Option<f64>> {
        self.results(seen)
    }
}
