//! Random buildings: lengths of routes against a graph of all corners that see each other, people who walk through
//! them to the end, and forces that people on other levels must not change. More of them with
//! `BAD_INPUT_TIMES=8 cargo test`, fewer with 0.1.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::math::Vector;
use sandbox::engine::routes::Destination;
use sandbox::engine::scene::Scene;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::Scenario;

use crate::common::buildings::each_of;
use crate::common::random_buildings::Building;
use crate::common::sheets::Sheets;

/// Buildings whose routes and forces are checked: 2,000 with `BAD_INPUT_TIMES=8`.
const BUILDINGS: u64 = 250;
/// People walk for this many frames in every building, and to the end in every `WHOLE`th.
const FRAMES: u32 = 100;
const WHOLE: u64 = 50;
/// The end of the longest runs, frames.
const END: u32 = 20_000;
/// Lengths agree to this, meters.
const ROUNDING: f64 = 1e-6;
/// The longest step, meters: 5 m/s.
const LONGEST_STEP: f64 = 0.1;
/// A step between two levels may pass beside the end of their join by this, meters.
const BESIDE: f64 = 0.02;

/// Checks many random buildings; `check` gets the number of each one.
fn check_all(check: impl Fn(u64, &Building, &Scenario) + Sync) {
    let times = std::env::var("BAD_INPUT_TIMES").map_or(1.0, |times| times.parse().unwrap());
    let count = (BUILDINGS as f64 * times) as u64;
    (0..count).into_par_iter().for_each(|seed| {
        let building = Building::random(&mut ChaCha8Rng::seed_from_u64(seed));
        let document = building.document();
        let scenario = Scenario::parse(&document.to_string(), "building.json", &[]);
        let scenario = scenario.unwrap_or_else(|error| panic!("{seed}: {error}\n{document}"));
        check(seed, &building, &scenario);
    });
}

#[test]
fn routes_in_random_buildings_are_as_long_as_those_of_a_visibility_graph() {
    check_all(|seed, building, scenario| {
        let sheets = Sheets::new(building);
        let routes = scenario.scene.routes.clone().unwrap();
        let agents = scenario.scene.agents.iter().zip(&building.people);
        for (agent, &person) in agents {
            for exit in 0..building.exits.len() {
                let own = routes.length(agent.position, Destination::Place(exit as u16));
                let other = sheets.length(person, exit);
                assert!(
                    (own - other).abs() < ROUNDING,
                    "{seed}: from {person:?} to exit {exit}: {own}, {other}"
                );
            }
        }
    });
}

/// Where a step crosses the line of a join, meters; `None` if it does not reach the line.
fn crossing([p, q]: [Vector; 2], [a, b]: [Vector; 2]) -> Option<Vector> {
    let [from, to] = [p, q].map(|p| (b - a).perp(&(p - a)));
    (from * to <= 0.0 && from != to).then(|| p + (q - p) * (from / (from - to)))
}

#[test]
fn people_in_random_buildings_arrive_change_levels_at_joins_only_and_do_not_jump() {
    check_all(|seed, building, scenario| {
        let number = |name: &str| building.levels.iter().position(|level| level.name == name);
        let is_whole = seed.is_multiple_of(WHOLE);
        let mut last: Vec<Option<(Vector, usize)>> = vec![None; building.people.len()];
        let frames = if is_whole { END } else { FRAMES };
        let left = each_of(scenario, frames, |id, p, name| {
            let level = number(name).unwrap();
            let Some((before, on)) = last[id as usize].replace((p, level)) else {
                return;
            };
            let step = (p - before).norm();
            let at = format!("{seed}: {id} from {before} to {p}");
            assert!(step < LONGEST_STEP, "{at}");
            let [from, to] = [on, level].map(|level| &building.levels[level]);
            let slope = from.rise.norm().max(to.rise.norm());
            let rise = (to.height(p) - from.height(before)).abs();
            assert!(rise < slope * step + 1e-9, "{at}: {rise} m");
            let crosses = |(line, between): &([Vector; 2], [usize; 2])| {
                let joins = [[on, level], [level, on]].contains(between);
                let at = crossing([before, p], *line).filter(|_| joins);
                at.is_some_and(|at| {
                    let [a, b] = *line;
                    let along = (b - a).normalize();
                    let [from, to] = [(at - a).dot(&along), (b - at).dot(&along)];
                    from > -BESIDE && to > -BESIDE
                })
            };
            assert!(
                on == level || building.joins.iter().any(crosses),
                "{at}: from {} to {}",
                from.name,
                to.name
            );
        });
        let people = building.people.len();
        assert!(
            !is_whole || left == people,
            "{seed}: {left} of {people} arrive"
        );
    });
}

/// The positions and accelerations of the first `count` agents over some frames.
fn bits(scene: Scene, count: usize) -> Vec<[u64; 4]> {
    let mut simulation = Simulation::new(scene).unwrap();
    let mut bits = Vec::new();
    for _ in 0..6 {
        simulation.evaluate().unwrap();
        let frame = simulation.frame();
        for id in 0..count as u32 {
            let i = frame.agents.index_of(id).unwrap();
            let (p, a) = (frame.agents.position[i], frame.fields.acceleration[i]);
            bits.push([p.x, p.y, a.x, a.y].map(f64::to_bits));
        }
        simulation.integrate().unwrap();
    }
    bits
}

#[test]
fn people_on_other_levels_of_random_buildings_change_no_bit_of_a_force() {
    check_all(|seed, building, scenario| {
        let level = building.people[seed as usize % building.people.len()].0;
        let joins = building.joins_from(level);
        let agents = || scenario.scene.agents.iter().zip(&building.people);
        let on = |is_there: &dyn Fn(usize) -> bool| -> Vec<NewAgent> {
            let there = agents().filter(|(_, (level, _))| is_there(joins[*level]));
            there.map(|(agent, _)| *agent).collect()
        };
        let own = on(&|joins| joins == 0);
        let others = on(&|joins| joins > 1);
        let with = |agents: Vec<NewAgent>| Scene {
            agents,
            ..scenario.scene.clone()
        };
        let count = own.len();
        let alone = bits(with(own.clone()), count);
        let together = bits(with([own, others].concat()), count);
        assert!(
            alone == together,
            "{seed}: forces on {:?}",
            building.levels[level].name
        );
    });
}
