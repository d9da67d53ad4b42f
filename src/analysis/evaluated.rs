//! What several measurements need of one evaluated frame: each quantity is computed once, for the first that asks.

use std::cell::OnceCell;

use super::local::{Local, People};
use super::surroundings::Surroundings;
use engine::math::Vector;
use engine::simulation::Simulation;

/// An evaluated frame of a run.
pub struct Evaluated<'a> {
    /// The simulation in this frame.
    pub simulation: &'a Simulation,
    people: OnceCell<(People, Surroundings<'a>)>,
    /// Without and with pressures.
    local: [OnceCell<Vec<Local>>; 2],
    wall_pushes: OnceCell<Vec<WallPush>>,
}

/// The push of a wall on an agent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallPush {
    /// The index of the agent.
    pub agent: usize,
    /// The wall.
    pub wall: u32,
    /// The point of the wall that is nearest to the agent, meters.
    pub nearest: Vector,
    /// The acceleration of the agent, m/s².
    pub push: Vector,
}

impl<'a> Evaluated<'a> {
    /// The current frame of a simulation, which must be evaluated.
    pub fn new(simulation: &'a Simulation) -> Self {
        Self {
            simulation,
            people: OnceCell::new(),
            local: Default::default(),
            wall_pushes: OnceCell::new(),
        }
    }

    /// The agents with their surroundings, by id, with pressures if `pressure`.
    pub fn people(&self, pressure: bool) -> &[Local] {
        let [plain, with_pressures] = &self.local;
        let around = || {
            let scene = self.simulation.scene();
            let people = People::of(self.simulation.frame().agents, scene.period.as_ref());
            let around = people.among(&scene.walls);
            (people, around)
        };
        let plain = || {
            let (people, around) = self.people.get_or_init(around);
            plain.get_or_init(|| people.local(around, false))
        };
        let pressed = || {
            let mut local = plain().to_vec();
            let (people, around) = self.people.get_or_init(around);
            people.add_pressures(around, &mut local);
            local
        };
        match with_pressures.get() {
            Some(people) => people,
            None if pressure => with_pressures.get_or_init(pressed),
            None => plain(),
        }
    }

    /// The pushes of walls by pressure (Eq. 12) and contact (Eq. 23).
    pub fn wall_pushes(&self) -> &[WallPush] {
        self.wall_pushes.get_or_init(|| {
            let frame = self.simulation.frame();
            let mut found = Vec::new();
            self.simulation.each_wall_push(|agent, wall, push| {
                let position = frame.agents.position[agent];
                found.push(WallPush {
                    agent,
                    wall,
                    nearest: frame.walls.wall(wall).nearest_point(position).point,
                    push,
                });
            });
            found
        })
    }
}
