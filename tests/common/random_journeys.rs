//! Random scenarios of journeys: floor plans with exits, waypoints, waiting areas, queues, choices, zones, events,
//! crowds, entrances and profiles. They are built from a list of parts, so that a failing case shrinks to few parts.

use proptest::prelude::*;
use proptest::sample::select;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;
use serde_json::{Map, Value, json};

use super::floors::Plan;

/// A part of a scenario. Its numbers come from the random numbers of `seed`.
#[derive(Debug, Clone)]
struct Part {
    kind: &'static str,
    seed: u64,
}

/// A scenario and its plan.
#[derive(Debug, Clone)]
pub struct RandomJourney {
    pub plan: Plan,
    pub document: Value,
}

fn parts(kind: &'static str, most: usize) -> impl Strategy<Value = Vec<Part>> {
    let part = any::<u64>().prop_map(move |seed| Part { kind, seed });
    prop::collection::vec(part, 0..=most)
}

/// Any scenario of journeys.
pub fn random_journeys() -> impl Strategy<Value = RandomJourney> {
    let places = (
        parts("exits", 3),
        parts("waypoints", 3),
        parts("waiting_areas", 2),
        parts("queues", 2),
    );
    let people = (
        parts("agents", 2),
        parts("crowds", 2),
        parts("grids", 1),
        parts("entrances", 2),
        parts("sources", 1),
    );
    let rest = (
        parts("journeys", 3),
        parts("zones", 2),
        parts("events", 3),
        parts("obstacles", 1),
    );
    let profiles = ["sph", "rvo", "sf", "rvo->sph", "sf->sph"];
    let whole = (any::<u64>(), select(profiles.to_vec()), 0..4_u8);
    (places, people, rest, whole).prop_map(|(places, people, rest, (seed, profile, how))| {
        let parts = [
            places.0, places.1, places.2, places.3, rest.0, rest.1, rest.2, rest.3, people.0,
            people.1, people.2, people.3, people.4,
        ];
        build(&parts.concat(), seed, profile, how)
    })
}

fn build(parts: &[Part], seed: u64, profile: &str, how: u8) -> RandomJourney {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let plan = match how {
        0 => Plan::with_gaps(&mut rng, 6, 0.8),
        _ => Plan::random(&mut rng),
    };
    let mut document = json!({"seed": seed % 1000, "profile": profile, "duration_secs": 4});
    // Bodies are holes of the walkable area, or obstacles in it.
    if how == 1 {
        document["walkable_area"] = json!([[plan.rings[0]]]);
        document["obstacles"] = json!(plan.rings[1..]);
    } else {
        document["walkable_area"] = json!([plan.rings]);
    }
    let mut names = Names::default();
    for (k, part) in parts.iter().enumerate() {
        let rng = &mut ChaCha8Rng::seed_from_u64(part.seed);
        let value = Builder {
            rng,
            plan: &plan,
            names: &names,
        }
        .value(part.kind);
        let Some(mut value) = value else {
            continue;
        };
        let name = format!("{}{k}", part.kind);
        match part.kind {
            "exits" => names.exits.push(name.clone()),
            "waypoints" | "waiting_areas" | "queues" => names.places.push(name.clone()),
            "journeys" => names.journeys.push(name.clone()),
            _ => {}
        }
        if !["agents", "obstacles", "events"].contains(&part.kind) {
            value["name"] = json!(name);
        }
        let list = document
            .as_object_mut()
            .and_then(|keys| keys.entry(part.kind).or_insert(json!([])).as_array_mut());
        list.unwrap().push(value);
    }
    RandomJourney { plan, document }
}

/// The names that later parts can use.
#[derive(Default)]
struct Names {
    exits: Vec<String>,
    places: Vec<String>,
    journeys: Vec<String>,
}

struct Builder<'a> {
    rng: &'a mut ChaCha8Rng,
    plan: &'a Plan,
    names: &'a Names,
}

impl Builder<'_> {
    fn value(&mut self, kind: &str) -> Option<Value> {
        Some(match kind {
            "exits" => self.exit()?,
            "waypoints" if self.one_of(2) => json!({"line": self.line(3.0)?}),
            "waypoints" => {
                json!({"at": self.point(0.1)?, "within": self.rng.random_range(0.2..2.0)})
            }
            "waiting_areas" => self.waiting_area()?,
            "queues" => self.queue()?,
            "journeys" => self.journey()?,
            "zones" => {
                json!({"area": self.square(3.0)?, "speed_factor": self.rng.random_range(0.05..2.0)})
            }
            "events" => self.event()?,
            "obstacles" => json!(self.square(0.8)?),
            _ => self.people(kind)?,
        })
    }

    fn one_of(&mut self, n: u32) -> bool {
        self.rng.random_ratio(1, n)
    }

    fn point(&mut self, gap: f64) -> Option<[f64; 2]> {
        Some(self.plan.free(self.rng, gap)?.into())
    }

    /// Two points of the floor up to `reach` meters apart in each direction.
    fn line(&mut self, reach: f64) -> Option<[[f64; 2]; 2]> {
        let a = Vector::from(self.point(0.1)?);
        (0..20).find_map(|_| {
            let way = [(); 2].map(|()| self.rng.random_range(-reach..reach));
            let b = a + Vector::from(way);
            (self.plan.is_free(b, 0.1) && (b - a).norm() > 0.35).then_some([a.into(), b.into()])
        })
    }

    /// A rectangle; most have all corners on the floor.
    fn square(&mut self, size: f64) -> Option<Vec<[f64; 2]>> {
        let mut ring = Vec::new();
        for _ in 0..8 {
            let [x, y] = self.point(0.3)?;
            let [w, h] = [(); 2].map(|()| self.rng.random_range(0.3..size));
            ring = vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h]];
            if ring.iter().all(|&p| self.plan.is_free(p.into(), 0.1)) {
                break;
            }
        }
        Some(ring)
    }

    /// A line on an edge of the outline, or in the room.
    fn exit(&mut self) -> Option<Value> {
        let line = match self.one_of(4) {
            true => self.line(2.0)?,
            false => (0..20).find_map(|_| self.on_outline())?,
        };
        let mut exit = json!({"line": line});
        if self.one_of(3) {
            exit["most_per_sec"] = json!(self.rng.random_range(0.1..5.0));
        }
        if self.one_of(3) {
            let from = self.rng.random_range(0.0..2.0);
            exit["closed_secs"] = json!([[from, from + self.rng.random_range(0.1..3.0)]]);
        }
        Some(exit)
    }

    /// A part of an edge of the outline with floor before it.
    fn on_outline(&mut self) -> Option<[[f64; 2]; 2]> {
        let outline = &self.plan.rings[0];
        let k = self.rng.random_range(0..outline.len());
        let [a, b] = [outline[k], outline[(k + 1) % outline.len()]].map(Vector::from);
        let length = (b - a).norm();
        let width = self.rng.random_range(0.5..2.0_f64).min(length);
        let from = self.rng.random_range(0.0..=length - width);
        let along = (b - a) / length;
        // The outline is counterclockwise.
        let before = a + along * (from + 0.5 * width) + Vector::new(-along.y, along.x) * 0.1;
        let is_free = self.plan.is_free(before, 0.05);
        is_free.then(|| [from, from + width].map(|part| (a + along * part).into()))
    }

    fn waiting_area(&mut self) -> Option<Value> {
        let mut area =
            json!({"area": self.square(4.0)?, "for_secs": self.rng.random_range(0.0..3.0)});
        if self.one_of(2) {
            area["until_secs"] = json!(self.rng.random_range(0.0..4.0));
        }
        if self.one_of(2) {
            area["facing"] = json!(self.point(0.0)?);
        }
        Some(area)
    }

    fn queue(&mut self) -> Option<Value> {
        let [a, b] = self.line(4.0)?;
        let mut path = vec![a, b];
        if self.one_of(2) {
            path.push(self.point(0.3)?);
        }
        let servers = self.rng.random_range(1..4);
        let secs = self.rng.random_range(0.01..2.0);
        let service = if self.one_of(2) {
            json!(secs)
        } else {
            json!({"exponential": secs})
        };
        Some(
            json!({"path": path, "servers": servers, "service_secs": service,
                    "spacing": self.rng.random_range(0.3..1.0)}),
        )
    }

    /// Names of some places, without repeats.
    fn some(&mut self, names: &[String]) -> Vec<String> {
        let some: Vec<String> = names
            .iter()
            .filter(|_| self.rng.random_bool(0.6))
            .cloned()
            .collect();
        if some.is_empty() {
            names.iter().take(1).cloned().collect()
        } else {
            some
        }
    }

    fn stage(&mut self, names: &[String]) -> Value {
        let some = self.some(names);
        let weights = |rng: &mut ChaCha8Rng| -> Map<String, Value> {
            let weight = |name: &String| (name.clone(), json!(rng.random_range(0.1..3.0)));
            some.iter().map(weight).collect()
        };
        match self.rng.random_range(0..5) {
            0 => json!({"nearest": some}),
            1 => json!({"quickest": some}),
            2 => json!({"fewest": some}),
            3 => json!({"shares": weights(self.rng)}),
            _ => json!(some[0]),
        }
    }

    fn journey(&mut self) -> Option<Value> {
        let names = self.names;
        let mut stages: Vec<Value> = Vec::new();
        if !names.places.is_empty() {
            let count = self.rng.random_range(0..4);
            stages.extend((0..count).map(|_| self.stage(&names.places)));
        }
        if !names.exits.is_empty() && (stages.is_empty() || !self.one_of(4)) {
            stages.push(self.stage(&names.exits));
        }
        (!stages.is_empty()).then(|| json!({"stages": stages}))
    }

    fn event(&mut self) -> Option<Value> {
        let at = self.rng.random_range(0.0..3.0);
        let all = [&self.names.exits[..], &self.names.places].concat();
        let what = ["open", "close", "release"][self.rng.random_range(0..3)];
        let of = if what == "release" {
            all
        } else {
            self.names.exits.clone()
        };
        let is_area = |name: &&String| what != "release" || name.starts_with("waiting");
        let of: Vec<&String> = of.iter().filter(is_area).collect();
        if of.is_empty() || self.one_of(3) {
            let [x, y] = self.point(0.0)?;
            let region = [[x - 2.0, y - 2.0], [x + 2.0, y + 2.0]];
            return Some(json!({"at_secs": at, "for_secs": 1, "region": region, "goal_scale": 4}));
        }
        Some(json!({"at_secs": at, what: of[self.rng.random_range(0..of.len())]}))
    }

    fn people(&mut self, kind: &str) -> Option<Value> {
        let mut people = match kind {
            "agents" => json!({"position": self.point(0.25)?}),
            "crowds" => {
                let density = self.rng.random_range(0.2..1.5);
                json!({"area": self.square(4.0)?, "density": density})
            }
            "grids" | "sources" => {
                let [x, y] = self.point(0.3)?;
                let [columns, rows] = [(); 2].map(|()| self.rng.random_range(1..4));
                json!({"min": [x, y], "max": [x + 0.6 * f64::from(columns), y + 0.6 * f64::from(rows)],
                       "columns": columns, "rows": rows})
            }
            _ => {
                json!({"line": self.exit()?["line"], "per_sec": self.rng.random_range(0.5..5.0), "number": 8})
            }
        };
        if kind == "sources" {
            people["every_secs"] = json!(self.rng.random_range(0.5..2.0));
            people["times"] = json!(2);
        }
        let names = &self.names.journeys;
        if !names.is_empty() && !self.one_of(6) {
            people["journey"] = json!(names[self.rng.random_range(0..names.len())]);
        } else if self.names.exits.is_empty() || self.one_of(2) {
            people["goal"] = json!(self.point(0.1)?);
            people["remove_within"] = json!(0.5);
        }
        if self.one_of(3) {
            people["premovement_secs"] = json!(self.rng.random_range(0.0..2.0));
        }
        if self.one_of(3) {
            people["preferred_speed"] = json!(self.rng.random_range(0.5..2.0));
        }
        Some(people)
    }
}
