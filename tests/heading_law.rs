//! The walking law `headings` in plain code, written from "The law exactly" in docs/reference/profiles.md alone, beside
//! what agents decide: with walls, narrowings, oncoming people, motivation and density.

use std::collections::BTreeMap;

use sandbox::engine::simulation::Simulation;
use serde_json::{Value, json};

use crate::common::simulated::start;

/// The parameters of the law, as a scenario lists them.
struct Law(Value);

impl Law {
    fn of(&self, name: &str) -> f64 {
        self.0[name].as_f64().unwrap_or_else(|| panic!("{name}"))
    }
}

type Point = [f64; 2];

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn plus(a: Point, b: Point, times: f64) -> Point {
    [a[0] + b[0] * times, a[1] + b[1] * times]
}

fn unit(a: Point) -> Point {
    let length = a[0].hypot(a[1]);
    if length > 0.0 {
        [a[0] / length, a[1] / length]
    } else {
        a
    }
}

fn positive(x: f64) -> f64 {
    x.max(0.0)
}

/// The distance of a point from a segment.
fn distance(p: Point, [a, b]: [Point; 2]) -> f64 {
    let along = minus(b, a);
    let share = (dot(minus(p, a), along) / dot(along, along)).clamp(0.0, 1.0);
    let away = minus(p, plus(a, along, share));
    away[0].hypot(away[1])
}

/// How far a disc can move before it touches a segment: by steps of the free distance.
fn free_way(p: Point, radius: f64, heading: Point, wall: [Point; 2], far: f64) -> f64 {
    let gap = |s: f64| distance(plus(p, heading, s), wall) - radius;
    if gap(0.0) <= 0.0 {
        return if gap(1e-7) < gap(0.0) {
            0.0
        } else {
            f64::INFINITY
        };
    }
    let mut way = 0.0;
    while way < far {
        match gap(way) {
            gap if gap < 1e-9 => return way,
            gap => way += gap,
        }
    }
    f64::INFINITY
}

/// Where a ray from `p` meets a segment: the distance.
fn ray(p: Point, heading: Point, [a, b]: [Point; 2]) -> Option<f64> {
    let along = minus(b, a);
    let across = cross(heading, along);
    let from = minus(a, p);
    let (way, share) = (cross(from, along) / across, cross(from, heading) / across);
    (way >= 0.0 && (0.0..=1.0).contains(&share)).then_some(way)
}

/// A person, with what the law takes as given.
struct Person {
    r: Point,
    v: Point,
    radius: f64,
    /// The preferred velocity.
    wish: Point,
    density: f64,
    /// The next point on the way.
    aim: Point,
    heading: i32,
}

/// A room of 10 m × 12 m whose walls taper to a gap of 1.2 m, then a passage of 2.4 m that becomes 1.8 m wide.
const OUTLINE: [Point; 14] = [
    [0.0, 0.0],
    [10.0, 0.0],
    [11.0, 5.4],
    [12.0, 0.0],
    [20.0, 0.0],
    [20.0, 4.8],
    [26.0, 4.8],
    [26.0, 5.1],
    [34.0, 5.1],
    [34.0, 6.9],
    [26.0, 6.9],
    [26.0, 7.2],
    [20.0, 7.2],
    [20.0, 12.0],
];
const REST: [Point; 4] = [[12.0, 12.0], [11.0, 6.6], [10.0, 12.0], [0.0, 12.0]];

fn outline() -> Vec<Point> {
    [&OUTLINE[..], &REST].concat()
}

fn scene(precision: &str, motivation: f64) -> Value {
    json!({
        "profile": "steer+sph",
        "precision": precision,
        "motivation": motivation,
        "walkable_area": [[outline()]],
        "exits": [{"name": "east", "line": [[34, 5.1], [34, 6.9]]}, {"name": "west", "line": [[0, 5], [0, 7]]}],
        "journeys": [{"name": "to the east", "stages": ["east"]}, {"name": "to the west", "stages": ["west"]}],
        "crowds": [
            {"area": [[5, 2], [9.5, 2], [9.5, 10], [5, 10]], "number": 60, "journey": "to the east"},
            {"area": [[13, 3], [17, 3], [17, 9], [13, 9]], "number": 30, "journey": "to the east"},
            {"area": [[21, 5.2], [25, 5.2], [25, 6.8], [21, 6.8]], "number": 8, "journey": "to the east"},
            {"area": [[17.2, 3], [19, 3], [19, 9], [17.2, 9]], "number": 12, "journey": "to the west",
             "preferred_speed": 0.9}
        ]
    })
}

fn people(simulation: &Simulation) -> BTreeMap<u32, Person> {
    let frame = simulation.frame();
    let agents = frame.agents;
    let person = |i: usize| Person {
        r: agents.position[i].into(),
        v: agents.velocity[i].into(),
        radius: agents.radius[i],
        wish: frame.fields.preferred_velocity[i].into(),
        density: frame.fields.density[i],
        aim: agents.aim[i].into(),
        heading: i32::from(agents.heading[i]),
    };
    (0..agents.len())
        .map(|i| (agents.id[i], person(i)))
        .collect()
}

/// What a person heeds of the next narrowing, found on the straight line to the next point of the way.
fn narrowing(law: &Law, one: &Person, walls: &[[Point; 2]]) -> f64 {
    // The narrowings of this floor: the gap, the mouth of the passage, where it becomes narrower, and the exits.
    let places = [
        [[11.0, 5.4], [11.0, 6.6]],
        [[20.0, 4.8], [20.0, 7.2]],
        [[26.0, 5.1], [26.0, 6.9]],
        [[34.0, 5.1], [34.0, 6.9]],
        [[0.0, 5.0], [0.0, 7.0]],
    ];
    let way = unit(one.wish);
    let to_aim = minus(one.aim, one.r);
    let far = (2.5 * law.of("narrowing_range")).min(to_aim[0].hypot(to_aim[1]) + 1.0);
    let crossed = places
        .iter()
        .filter_map(|&place| Some((ray(one.r, way, place)?, place)));
    let next = crossed
        .filter(|(x, _)| *x <= far)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let Some((x, [a, b])) = next else {
        return 0.0;
    };
    let left = [-way[1], way[0]];
    let free = |side: Point| {
        let met = walls.iter().filter_map(|&wall| ray(one.r, side, wall));
        met.fold(f64::INFINITY, f64::min)
    };
    let width = minus(b, a);
    let here = free(left) + free([-left[0], -left[1]]);
    let counts = ((here / width[0].hypot(width[1]) - 1.0) / 0.5).clamp(0.0, 1.0);
    counts * (-(x / law.of("narrowing_range")).powi(2)).exp()
}

/// How near people who come toward a person are, without those whom a wall hides.
fn opposed(one: &Person, others: &[&Person], walls: &[[Point; 2]]) -> f64 {
    let degree = |other: &&Person| {
        let to = minus(other.r, one.r);
        let away = to[0].hypot(to[1]);
        let met = walls.iter().filter_map(|&wall| ray(one.r, unit(to), wall));
        let hidden = met.fold(f64::INFINITY, f64::min) < away;
        let against = -dot(unit(one.wish), unit(other.wish));
        match hidden {
            true => 0.0,
            false => ((against - 0.7) / 0.2).clamp(0.0, 1.0) * (2.0 - away / 1.5).clamp(0.0, 1.0),
        }
    };
    others.iter().map(degree).fold(0.0, f64::max)
}

/// The factor g of the time gap.
fn factor(
    law: &Law,
    one: &Person,
    motivation: f64,
    (others, walls): (&[&Person], &[[Point; 2]]),
) -> f64 {
    let calm = 1.0 - motivation;
    let met = opposed(one, others, walls);
    let pressed = (one.density - law.of("press_density")) / law.of("press_range");
    (1.0 - law.of("hurry_share") * motivation)
        * (1.0 - law.of("press_share") * calm * pressed.clamp(0.0, 1.0))
        * (1.0
            + law.of("queue_share")
                * calm
                * (1.0 - met)
                * (one.density - law.of("queue_density")).clamp(0.0, 1.0))
        * (1.0 + law.of("narrowing_share") * narrowing(law, one, walls))
}

/// The utilities of the seven headings, from the right to the left, for a person that follows heading `held`.
fn utilities(
    law: &Law,
    one: &Person,
    (held, gap): (i32, f64),
    (others, walls): (&[&Person], &[[Point; 2]]),
) -> [f64; 7] {
    let (way, s) = (unit(one.wish), one.wish[0].hypot(one.wish[1]));
    let time = law.of("headway_time") * gap;
    let (length, half) = (law.of("headway_length"), law.of("heading_half_width"));
    let far = length + time * s + law.of("look_ahead");
    let step = law.of("heading_angle").to_radians() / 3.0;
    std::array::from_fn(|k| {
        let angle = (k as f64 - 3.0) * step;
        let heading = plus(
            [way[0] * angle.cos(), way[1] * angle.cos()],
            [-way[1], way[0]],
            angle.sin(),
        );
        let mut nearest = far;
        for other in others {
            let to = minus(other.r, one.r);
            let u = dot(minus(other.v, one.v), heading);
            let oncoming = (4.0 * positive(-dot(way, unit(other.wish)))).min(1.0);
            let a = dot(to, heading);
            let c = cross(heading, to) + law.of("side_preference") * oncoming;
            let expected = positive(
                a + law.of("headway_anticipation") * positive(u)
                    + law.of("evasion_time") * oncoming * u.min(0.0).max(-2.0 * s),
            );
            let outside =
                positive((c.abs() - half) / (half / 2.0)) + positive(1.0 - a / (half / 2.0));
            nearest = nearest.min((expected.powi(2) + c.powi(2) + far * far * outside).sqrt());
        }
        let before_people = positive((nearest - length) / time);
        let routes = walls
            .iter()
            .map(|&wall| free_way(one.r, one.radius, heading, wall, far));
        let room = before_people.min(routes.fold(f64::INFINITY, f64::min) / time);
        room * angle.cos()
            - law.of("heading_persistence") * (k as f64 - 3.0 - f64::from(held)).abs() * step
    })
}

/// The speed along the heading that a person follows.
fn speed(law: &Law, one: &Person, gap: f64, others: &[&Person]) -> f64 {
    let (way, s) = (unit(one.wish), one.wish[0].hypot(one.wish[1]));
    let angle = f64::from(one.heading) * law.of("heading_angle").to_radians() / 3.0;
    let heading = plus(
        [way[0] * angle.cos(), way[1] * angle.cos()],
        [-way[1], way[0]],
        angle.sin(),
    );
    let time = law.of("headway_time") * gap;
    let (length, half) = (law.of("headway_length"), law.of("lane_half_width"));
    let range = length + time * s;
    let distances = others.iter().map(|other| {
        let to = minus(other.r, one.r);
        let (a, c) = (dot(to, heading), cross(heading, to));
        let u = dot(minus(other.v, one.v), heading);
        let outside = positive((c.abs() - half) / (half / 2.0))
            + positive(1.0 - a / (half / 2.0))
            + 4.0 * positive(-dot(heading, unit(other.wish)));
        let expected = a + law.of("headway_anticipation") * positive(u);
        (expected.powi(2) + c.powi(2) + range * range * outside).sqrt()
    });
    let nearest = distances.fold(range, f64::min);
    positive((nearest - length) / time).min(s)
}

/// What a run of some seconds has shown.
#[derive(Default)]
struct Seen {
    choices: u32,
    turned: u32,
    at_walls: u32,
    narrowed: u32,
    slowed: u32,
    opposed: u32,
}

fn compare(precision: &str, exact: f64, motivation: f64) -> Seen {
    let document = scene(precision, motivation);
    let settings = crate::common::simulated::scenario(&document, &[])
        .unwrap()
        .settings();
    let law = Law(settings["parameters"].clone());
    let corners = outline();
    let walls: Vec<[Point; 2]> = corners
        .iter()
        .zip(corners.iter().cycle().skip(1))
        .map(|(&a, &b)| [a, b])
        .collect();
    let mut simulation = start(&document, &[]);
    simulation.evaluate().unwrap();
    let mut seen = Seen::default();
    for frame in 1..=400_u32 {
        let held: BTreeMap<u32, i32> = people(&simulation)
            .iter()
            .map(|(&id, one)| (id, one.heading))
            .collect();
        simulation.integrate().unwrap();
        simulation.evaluate().unwrap();
        if frame % 50 != 0 {
            continue;
        }
        let all = people(&simulation);
        let agents = simulation.frame().agents;
        for (&id, one) in &all {
            // Not at the exits, behind which people have left.
            if one.r[0] < 1.0 || one.r[0] > 32.0 || !held.contains_key(&id) {
                continue;
            }
            let others = all.iter().filter(|(other, _)| **other != id);
            let others: Vec<&Person> = others.map(|(_, other)| other).collect();
            let gap = factor(&law, one, motivation, (&others, &walls));
            let found = utilities(&law, one, (held[&id], gap), (&others, &walls));
            let best = found.iter().copied().fold(f64::MIN, f64::max);
            let chosen = found[(one.heading + 3) as usize];
            assert!(
                best - chosen < exact,
                "frame {frame}, agent {id}: {found:?}, {}",
                one.heading
            );
            let i = agents.index_of(id).unwrap();
            let s = one.wish[0].hypot(one.wish[1]);
            let allowed = agents.allowed_speed[i].unwrap().min(s);
            let expected = speed(&law, one, gap, &others);
            assert!(
                (allowed - expected).abs() < exact,
                "frame {frame}, agent {id}: {allowed}, {expected}"
            );
            let without = utilities(&law, one, (held[&id], gap), (&others, &[]));
            seen.choices += 1;
            seen.turned += u32::from(one.heading != 0);
            seen.at_walls += u32::from(without != found);
            seen.narrowed += u32::from(narrowing(&law, one, &walls) > 0.05);
            seen.slowed += u32::from(expected < s);
            let met = opposed(one, &others, &walls);
            seen.opposed += u32::from(met > 0.1 && one.density > law.of("queue_density"));
        }
    }
    seen
}

#[test]
fn agents_decide_as_the_documented_law_says() {
    for (precision, exact, motivation) in [
        ("double", 1e-6, 0.0),
        ("double", 1e-6, 0.7),
        ("mixed", 2e-3, 0.3),
    ] {
        let Seen {
            choices,
            turned,
            at_walls,
            narrowed,
            slowed,
            opposed,
        } = compare(precision, exact, motivation);
        assert!(choices > 300, "{choices}");
        assert!(
            turned > 30 && at_walls > 30 && narrowed > 30 && slowed > 30 && opposed > 30,
            "{turned} {at_walls} {narrowed} {slowed} {opposed}"
        );
    }
}
