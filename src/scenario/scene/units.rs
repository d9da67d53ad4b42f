//! Notes on values whose unit is probably another one: speeds, radii, masses, flows, times and the factors of zones.

use crate::error::numbers::brief;
use crate::error::quote::{shown, to_centimeters};
use crate::file::File;
use crate::keys::shapes::Point;
use engine::agents::RADIUS_RANGE;
use engine::journeys::{Kind, Place, Queue};
use engine::math::Vector;
use engine::scene::Scene;

/// Crowds do not run faster, m/s.
const FAST: f64 = 4.0;
/// People who walk are not slower, m/s.
const SLOW: f64 = 0.2;
/// The share of the slowest, and of the fastest agents, whose speeds are looked at.
const RARE: f64 = 0.05;
/// No zone of floor makes people this many times as fast: moving walkways add half of the walking speed.
const FASTER: f64 = 2.0;
/// The bodies of people are not narrower or wider than these multiples of the radii of adults.
const BODIES: [f64; 2] = [0.5, 1.7];
/// The masses of people, as multiples of that of an average person.
const MASSES: [f64; 2] = [0.1, 5.0];
/// No line passes more people per meter and second.
const MOST_PER_METER: f64 = 5.0;

/// The notes. The file has its end at `last`, seconds.
pub fn notes(keys: &File, scene: &Scene, last: f64) -> Vec<String> {
    let mut notes = speeds(keys, scene);
    notes.extend(slowed(scene));
    notes.extend(masses(keys, scene));
    notes.extend(flows(keys));
    notes.extend(services(scene, last));
    notes.extend(zones(scene));
    let radii = radii(keys, scene);
    notes.extend(radii.first().map(|(radius, place)| {
        let more = match radii.len() - 1 {
            0 => String::new(),
            more => format!(", and {more} more"),
        };
        format!(
            "{place}: {} m is not the radius of a person{more}: check that the unit is meters (adults have {} to {} m)",
            brief(*radius),
            RADIUS_RANGE[0],
            RADIUS_RANGE[1]
        )
    }));
    notes
}

/// The least radius that is not one of a person, meters.
pub fn doubtful_radius(scene: &Scene) -> Option<f64> {
    let own = scene.agents.iter().filter_map(|agent| agent.radius);
    let groups = scene.groups.iter();
    let means = groups.filter_map(|group| Some(group.traits.radius.as_ref()?.mean()));
    let small = own.chain(means).filter(|&radius| is_doubtful(radius));
    small.reduce(f64::min)
}

fn is_doubtful(radius: f64) -> bool {
    !(BODIES[0] * RADIUS_RANGE[0]..=BODIES[1] * RADIUS_RANGE[1]).contains(&radius)
}

/// Notes on preferred speeds above those of running crowds, and below those of people who walk.
fn speeds(keys: &File, scene: &Scene) -> Vec<String> {
    let is_odd = |speed: f64| speed > FAST || (speed > 0.0 && speed < SLOW);
    let mut found = vec![(scene.preferred_speed, "preferred_speed".to_owned())];
    for (k, agent) in keys.agents.iter().enumerate() {
        let speed = agent.preferred_speed;
        found.extend(speed.map(|speed| (speed, format!("agents[{k}].preferred_speed"))));
    }
    for group in &scene.groups {
        let Some(speed) = &group.traits.preferred_speed else {
            continue;
        };
        let place = || format!("preferred_speed of {}", shown(&group.name));
        let tails = [RARE, 1.0 - RARE].map(|share| speed.quantile(share));
        let tail = tails.into_iter().find(|speed| is_odd(*speed));
        found.push(match tail.filter(|_| !is_odd(speed.mean())) {
            Some(tail) => (tail, format!("{}, of one agent in 20", place())),
            None => (speed.mean(), place()),
        });
    }
    let odd = found.into_iter().filter(|(speed, _)| is_odd(*speed));
    let note = |(speed, place): (f64, String)| {
        let than = match speed > FAST {
            true => "faster than crowds run",
            false => "slower than people walk",
        };
        let speed = brief(speed);
        format!("{place}: {speed} m/s is {than}: check that the unit is m/s (walking is 1.3 m/s)")
    };
    odd.map(note).collect()
}

/// A note if the largest speed is below the preferred one.
fn slowed(scene: &Scene) -> Option<String> {
    let (most, wanted) = (scene.max_speed, scene.preferred_speed);
    let mut groups = scene.groups.iter();
    let are_own = groups.all(|group| group.traits.preferred_speed.is_some());
    (most < wanted && wanted <= FAST && !are_own).then(|| {
        format!(
            "max_speed: {} m/s is below the preferred speed of {} m/s: no agent walks faster than that",
            brief(most),
            brief(wanted)
        )
    })
}

/// Notes on masses in kilograms.
fn masses(keys: &File, scene: &Scene) -> Vec<String> {
    let agents = keys.agents.iter().enumerate();
    let own = agents.filter_map(|(k, agent)| Some((agent.mass?, format!("agents[{k}].mass"))));
    let groups = scene.groups.iter().filter_map(|group| {
        let mass = group.traits.mass.as_ref()?.mean();
        Some((mass, format!("mass of {}", shown(&group.name))))
    });
    let all = own.chain(groups);
    let odd = all.filter(|(mass, _)| !(MASSES[0]..=MASSES[1]).contains(mass));
    let note = |(mass, place): (f64, String)| {
        format!(
            "{place}: {} is not the mass of a person: it counts in average persons, not in kilograms",
            brief(mass)
        )
    };
    odd.map(note).collect()
}

/// Notes on flows through exits and entrances that are given per minute or hour.
fn flows(keys: &File) -> Vec<String> {
    let mut given = Vec::new();
    for (k, exit) in keys.exits.iter().enumerate() {
        let place = format!("exits[{k}].most_per_sec");
        given.extend(exit.most_per_sec.map(|flow| (place, flow, exit.line)));
    }
    for (k, entrance) in keys.entrances.iter().enumerate() {
        let place = format!("entrances[{k}].per_sec");
        given.extend(entrance.per_sec.map(|flow| (place, flow, entrance.line.0)));
    }
    let note = |(place, flow, line): (String, f64, [Point; 2])| {
        let [a, b] = line.map(Vector::from);
        let width = (b - a).norm();
        (flow > MOST_PER_METER * width).then(|| {
            format!(
                "{place}: {} per second is more than pass {} m: check that it is not per minute or per hour",
                brief(flow),
                brief(to_centimeters(width))
            )
        })
    };
    given.into_iter().filter_map(note).collect()
}

/// Notes on queues in which the service of one person outlasts the run, to `end`, seconds.
fn services(scene: &Scene, end: f64) -> Vec<String> {
    let places = scene.journeys.places.iter();
    let slow = places.filter_map(|place| match &place.kind {
        Kind::Queue(queue) if queue.mean_service > end && end > 0.0 => Some((place, queue)),
        _ => None,
    });
    let note = |(place, queue): (&Place, &Queue)| {
        format!(
            "queue `{}`: to serve one person takes {} s, longer than the run of {} s: `service_secs` is in seconds",
            shown(&place.name),
            brief(queue.mean_service),
            brief(end)
        )
    };
    slow.map(note).collect()
}

/// Notes on zones in which people would run.
fn zones(scene: &Scene) -> impl Iterator<Item = String> {
    let zones = scene.journeys.zones.iter();
    let fast = zones.filter(|zone| zone.speed_factor > FASTER);
    fast.map(|zone| {
        format!(
            "zone `{}`: people walk {} times as fast there: `speed_factor` is a factor on the preferred speed, such as \
             0.5 on stairs",
            shown(&zone.name),
            brief(zone.speed_factor)
        )
    })
}

/// The mean radii that are not those of people, with their places.
fn radii(keys: &File, scene: &Scene) -> Vec<(f64, String)> {
    let agents = keys.agents.iter().enumerate();
    let own = agents.filter_map(|(k, agent)| Some((agent.radius?, format!("agents[{k}].radius"))));
    let groups = scene.groups.iter().filter_map(|group| {
        let radius = group.traits.radius.as_ref()?.mean();
        Some((radius, format!("radius of {}", shown(&group.name))))
    });
    let all = own.chain(groups);
    all.filter(|(radius, _)| is_doubtful(*radius)).collect()
}
