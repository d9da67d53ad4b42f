//! Quickest routes, recomputed from positions and choices with the formulas of docs/reference/routes.md alone.

use std::collections::BTreeMap;

use sandbox::engine::math::Vector;
use sandbox::engine::routes::Side;
use sandbox::engine::simulation::Simulation;
use serde_json::json;

use crate::common::simulated::start;

/// The speed that the scene's agents prefer, and the one that the crowd prefers, m/s.
const USUAL: f64 = 1.4;
const OWN: f64 = 1.2;
/// The wall begins here, and the exit is a line across the room, meters.
const WALL: f64 = 10.0;
const EXIT: f64 = 20.0;
/// The doors: from, to, meters.
const DOORS: [[f64; 2]; 2] = [[4.4, 5.4], [14.2, 16.0]];

/// The opening in a doorway, as people walk east.
#[derive(Default)]
struct Gate {
    x: f64,
    ends: [f64; 2],
    side: Option<Side>,
    /// People that have passed since the last second; in a crowd, and for how long, seconds: both fade.
    passes: f64,
    passed: f64,
    crowded: f64,
    /// The bins of the distances of all people bound for it.
    bins: Vec<i64>,
}

fn bin(length: f64) -> i64 {
    (length / 0.1) as i64
}

impl Gate {
    fn width(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }

    /// Where the way to it ends: 0.1 mm before it, 1 cm from its ends.
    fn end(&self, p: Vector) -> Vector {
        let y = p.y.clamp(self.ends[0] + 0.01, self.ends[1] - 0.01);
        Vector::new(self.x - 1e-4, y)
    }

    /// The corner of the wall around which the way from here leads.
    fn corner(&self, p: Vector) -> Option<Vector> {
        let way = self.end(p) - p;
        let at_wall = p.y + way.y * (WALL - p.x) / way.x;
        let is_free = p.x > WALL || (self.ends[0]..=self.ends[1]).contains(&at_wall);
        let y = self.ends[usize::from(p.y > self.ends[1])];
        (!is_free && self.x > WALL + 0.1).then(|| Vector::new(WALL, y))
    }

    /// The length of the way to it.
    fn distance(&self, p: Vector) -> f64 {
        let end = self.end(p);
        if p.x > end.x {
            return 0.0;
        }
        let corner = self.corner(p);
        corner.map_or((end - p).norm(), |corner| {
            (corner - p).norm() + (end - corner).norm()
        })
    }

    /// The length of the shortest way through it to the exit.
    fn exact(&self, p: Vector) -> f64 {
        let beside = (self.ends[0] - p.y).max(p.y - self.ends[1]).max(0.0);
        beside.hypot((WALL - p.x).max(0.0)) + EXIT - WALL.max(p.x)
    }

    /// From where the way to it ends to its middle.
    fn aside(&self, p: Vector) -> f64 {
        (self.end(p).y - 0.5 * (self.ends[0] + self.ends[1])).abs()
    }

    fn nearer(&self, length: f64) -> f64 {
        let nearer = self.bins.iter().filter(|&&other| other < bin(length));
        nearer.count() as f64
    }

    /// When the people that are nearer have passed, of whom each walks there, and all pass one after the other.
    fn clear(&self, length: f64, flow: f64) -> f64 {
        let mut nearer: Vec<i64> = self.bins.clone();
        nearer.retain(|&other| other < bin(length));
        nearer.sort_unstable();
        let passed = |clear: f64, bin: i64| clear.max(0.1 * bin as f64 / USUAL) + 1.0 / flow;
        nearer.into_iter().fold(0.0, passed)
    }

    fn flow(&self, per_meter: f64) -> f64 {
        let flow = (5.0 * per_meter * self.width() + self.passed) / (5.0 + self.crowded);
        flow.max(0.05)
    }
}

/// The openings in the two doorways.
fn gates(simulation: &Simulation) -> [Gate; 2] {
    let rooms = simulation.scene().rooms().unwrap();
    assert_eq!(rooms.openings().len(), 2);
    DOORS.map(|ends| {
        let middle = 0.5 * (ends[0] + ends[1]);
        let is_here = |&side: &Side| {
            let away = rooms.opening(side).middle().y - middle;
            away.abs() < 1e-6 && rooms.ahead(side).x > 0.0
        };
        let side = rooms.sides().find(is_here);
        let x = rooms.opening(side.unwrap()).middle().x;
        Gate {
            x,
            ends,
            side,
            ..Gate::default()
        }
    })
}

/// Whether a place is west of the openings.
fn is_west(p: Vector, gates: &[Gate; 2]) -> bool {
    p.x < gates[usize::from(p.y > 10.0)].x
}

#[test]
fn times_and_flows_follow_from_positions_and_choices() {
    let doorways =
        DOORS.map(|[low, high]| json!([[[9.9, low], [10.3, low], [10.3, high], [9.9, high]]]));
    let rooms = [
        json!([[[0, 0], [10, 0], [10, 20], [0, 20]]]),
        json!([[[10.2, 0], [20, 0], [20, 20], [10.2, 20]]]),
    ];
    let document = json!({
        "duration_secs": 60, "profile": "walk+sph", "route_choice": "quickest", "preferred_speed": USUAL,
        "walkable_area": rooms.into_iter().chain(doorways).collect::<Vec<_>>(),
        "exits": [{"name": "end", "line": [[EXIT, 0], [EXIT, 20]]}],
        "crowds": [{"area": [[1, 1], [8, 1], [8, 14], [1, 14]], "number": 120, "preferred_speed": OWN}],
    });
    let mut simulation = start(&document, &[]);
    let mut gates = gates(&simulation);
    // Who was in the west in the last coarse frame, and for which gates people are bound.
    let mut west: BTreeMap<u32, bool> = BTreeMap::new();
    let mut toward: BTreeMap<u32, Option<usize>> = BTreeMap::new();
    let (mut per_meter, mut compared, mut waited) = (1.9, 0, 0);
    let mut through = [0, 0];
    while simulation.frame().clock.time() < 40.0 {
        let frame = simulation.frame();
        let clock = *frame.clock;
        if !clock.is_coarse() {
            simulation.step().unwrap();
            continue;
        }
        let places: Vec<(u32, Vector)> = frame
            .agents
            .id
            .iter()
            .copied()
            .zip(frame.agents.position.clone())
            .collect();
        let is_second = clock.frame().is_multiple_of(clock.frame_at(1.0));
        if is_second {
            // The largest flow is that of the second before.
            let flows = gates.iter().map(|gate| gate.flow(1.3) / gate.width());
            per_meter = flows.fold(1.9, f64::max);
            for (k, gate) in gates.iter_mut().enumerate() {
                let bound = places
                    .iter()
                    .filter(|(id, _)| toward.get(id) == Some(&Some(k)));
                gate.bins = bound.map(|&(_, p)| bin(gate.distance(p))).collect();
                let crowd = 1.0 + 1.3 * gate.width() * 2.0 / USUAL;
                gate.passed *= 14.0 / 15.0;
                gate.crowded *= 14.0 / 15.0;
                if gate.nearer(2.0) >= crowd {
                    gate.passed += gate.passes;
                    gate.crowded += 1.0;
                }
                gate.passes = 0.0;
            }
        }
        // Those who pass now count for the next second.
        for &(id, p) in &places {
            let is_west = is_west(p, &gates);
            if west.insert(id, is_west) == Some(true) && !is_west {
                let k = toward.get(&id).copied().flatten().unwrap();
                assert!(
                    gates[k].distance(p) < 0.1,
                    "agent {id} has chosen another door"
                );
                gates[k].passes += 1.0;
                through[k] += 1;
            }
        }
        simulation.step().unwrap();
        let agents = simulation.frame().agents;
        for (&id, plan) in agents.id.iter().zip(&agents.plan) {
            let side = plan.and_then(|plan| plan.toward);
            toward.insert(
                id,
                gates
                    .iter()
                    .position(|gate| side.is_some() && gate.side == side),
            );
        }
        if !is_second {
            continue;
        }
        for (k, gate) in gates.iter_mut().enumerate() {
            let bound = places
                .iter()
                .filter(|(id, _)| toward.get(id) == Some(&Some(k)));
            gate.bins = bound.map(|&(_, p)| bin(gate.distance(p))).collect();
        }
        let waits = simulation.waits();
        for gate in &gates {
            let expected = gate.bins.len() as f64 / gate.flow(per_meter);
            let shown = waits[gate.side.unwrap().opening()];
            assert!(
                (shown - expected).abs() < 1e-6,
                "{shown} s, not {expected} s at {} s",
                clock.time()
            );
            waited += usize::from(expected > 5.0);
        }
        for i in agents.present().filter(|&i| agents.position[i].x < WALL) {
            let p = agents.position[i];
            let Some(decision) = simulation.route_decision(i) else {
                continue;
            };
            let shortest = usize::from(gates[1].exact(p) < gates[0].exact(p));
            for (k, gate) in gates.iter().enumerate() {
                let mut seen = decision.prospects.iter();
                let seen = seen.find(|one| one.side == gate.side).unwrap();
                let (length, beyond) = (gate.distance(p), EXIT - gate.x);
                let through = (length / OWN).max(gate.clear(seen.length, gate.flow(per_meter)));
                // Over the middle of the opening, or the shortest way itself.
                let walked = match k == shortest {
                    true => gate.exact(p) - length,
                    false => gate.aside(p) + beyond,
                };
                let total = through + walked / OWN;
                let at = clock.time();
                assert!(
                    (seen.length - length).abs() < 1e-6,
                    "{seen:?}, not {length} m at {at} s"
                );
                assert!(
                    (seen.expected.total_secs - total).abs() < 2e-3,
                    "{seen:?} at {p}, not {total} s at {at} s"
                );
                compared += 1;
            }
        }
    }
    assert!(
        compared > 1000 && waited > 10,
        "{compared} comparisons, {waited} waits"
    );
    assert!(
        through[0] > 20 && through[1] > 20,
        "{through:?} people by the two doors"
    );
}
