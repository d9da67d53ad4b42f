//! Crowds in periodic scenes.

use super::{person, vector};
use rand::Rng;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::math::Vector;
use sandbox::engine::random::{Purpose, stream};
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

pub fn parsed(document: &Value) -> Scenario {
    Scenario::parse(&document.to_string(), "f", &[]).unwrap()
}

/// `count` people at random in a box, moving, at least 0.2 m apart. Their density rises: at rest density, rounding
/// decides on the sign of the pressure, and the sign on the force.
pub fn people(count: usize, extent: Vector) -> Vec<NewAgent> {
    let mut random = stream(3, Purpose::Crowd, 0, 0);
    let mut number = |low: f64, high: f64| random.random_range(low..high);
    let mut agents: Vec<NewAgent> = Vec::new();
    while agents.len() < count {
        let position = vector(number(0.1, extent.x - 0.1), number(0.0, extent.y));
        let is_near = |other: &NewAgent| (other.position - position).norm() < 0.2;
        if agents.iter().any(is_near) {
            continue;
        }
        agents.push(NewAgent {
            velocity: vector(number(-1.0, 1.0), number(-1.0, 1.0)),
            mean_density: Some(1.0),
            ..person(position, Vector::zeros())
        });
    }
    agents
}

/// A corridor with a pillar and a body across the ends of the period, and a crowd in it. Three of them in a row without
/// `periodic`; the middle one has the lowest ids.
pub fn corridor(profile: &str, axis: &str, periodic: bool) -> Value {
    let turned = |[x, y]: [f64; 2]| if axis == "x" { [x, y] } else { [y, x] };
    let length = 11.0;
    let copies = if periodic {
        &[0.0][..]
    } else {
        &[0.0, -length, length]
    };
    let rectangle = |x: [f64; 2], y: [f64; 2]| {
        let corners = [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
        json!(corners.map(turned))
    };
    let crowd = people(70, vector(length, 3.0));
    let agents = copies.iter().flat_map(|shift| {
        crowd.iter().map(move |agent| {
            let position: [f64; 2] = agent.position.into();
            let velocity: [f64; 2] = agent.velocity.into();
            json!({"position": turned([position[0] + shift, position[1]]), "velocity": turned(velocity),
                   "radius": 0.25, "mass": 1.1, "mean_density": 1})
        })
    });
    let bodies = copies.iter().flat_map(|shift| {
        let pillar = rectangle([3.0 + shift, 3.5 + shift], [1.0, 1.5]);
        let across = rectangle([10.0 + shift, 11.6 + shift], [2.5, 3.0]);
        [pillar, across]
    });
    let ends = if periodic {
        [0.0, length]
    } else {
        [-length, 2.0 * length]
    };
    let mut document = json!({"profile": profile, "goal": {"direction": turned([1.0, 0.0])}, "precision": "double",
        "agents": agents.collect::<Vec<_>>(), "obstacles": bodies.collect::<Vec<_>>(),
        "walkable_area": [[rectangle(ends, [0.0, 3.0])]]});
    if periodic {
        document["periodic"] = json!({"axis": axis, "length": length});
    }
    document
}
