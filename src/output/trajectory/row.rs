//! One agent in one frame, and its columns.

use serde::ser::{Serialize, SerializeStruct, Serializer};

use engine::agents::Agents;
use engine::frame::{Fields, Frame};
use engine::math::{Vector, direction};
use engine::scene::{Group, Scene};
use engine::simulation::Simulation;

/// Below this speed, m/s, an agent faces its goal: the direction of such a velocity is noise.
const STANDING: f64 = 0.01;

/// One agent in one evaluated frame. As a record it has the fields of [`COLUMNS`], and of the forces that keep a state.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    /// The frame's number at the file's own rate, from 0.
    pub number: u64,
    /// Seconds.
    time: f64,
    agents: &'a Agents,
    fields: &'a Fields,
    scene: &'a Scene,
    i: usize,
}

/// How a row fills a column.
#[derive(Clone, Copy)]
pub enum Value {
    /// A whole number.
    Count(fn(&Row<'_>) -> u64),
    /// A number.
    Number(fn(&Row<'_>) -> f64),
    /// The number of this index among those that the force of this index in [`Agents::states`] shows; none for agents
    /// on which the force does not act.
    OfForce(usize, usize),
    /// A name, if there is one.
    Name(for<'a> fn(&Row<'a>) -> Option<&'a str>),
}

use Value::{Count, Name, Number, OfForce};

/// The name, the meaning with its unit, and the value of each column of all scenes. In a periodic scene each lap of an
/// agent has an id of its own: its remainder modulo the number of agents is the agent's id. The goal of an agent that
/// walks in a direction is its start.
#[rustfmt::skip] // One line each.
pub const COLUMNS: [(&str, &str, Value); 27] = [
    ("frame", "number of the frame at the file's own rate", Count(|row| row.number)),
    ("time", "time, s", Number(|row| row.time)),
    ("id", "the agent, from 0 in the order of entry", Count(|row| row.id().into())),
    ("group", "name of the agent's group", Name(|row| Some(&row.group().name))),
    ("push", "name of the push that the agent takes part in", Name(|row| row.push())),
    ("pos_x", "position, m", Number(|row| row.place().x)),
    ("pos_y", "position, m", Number(|row| row.place().y)),
    ("vel_x", "velocity, m/s", Number(|row| row.velocity().x)),
    ("vel_y", "velocity, m/s", Number(|row| row.velocity().y)),
    ("speed", "speed, m/s", Number(|row| row.speed())),
    ("ori_x", "direction in which the agent faces, of length 1", Number(|row| row.orientation().x)),
    ("ori_y", "direction in which the agent faces, of length 1", Number(|row| row.orientation().y)),
    ("goal_x", "goal, m", Number(|row| row.in_building(row.agents.goal[row.i]).x)),
    ("goal_y", "goal, m", Number(|row| row.in_building(row.agents.goal[row.i]).y)),
    ("radius", "radius of the body, m", Number(|row| row.agents.radius[row.i])),
    ("mass", "mass, 1 = an average person", Number(|row| row.mass())),
    ("density", "density, P/m²", Number(|row| row.density())),
    ("density_from_walls", "the walls' part of the density, P/m²", Number(|row| row.fields.density_from_walls[row.i])),
    ("mean_density", "mean density of the last seconds, P/m²", Number(|row| row.fields.mean_density[row.i])),
    ("rest_density", "rest density, P/m²", Number(|row| row.fields.rest_density[row.i])),
    ("pressure", "pressure, 1/s²", Number(|row| row.pressure())),
    ("wall_gradient_x", "gradient of the kernel over the walls, 1/m", Number(|row| row.fields.wall_gradient[row.i].x)),
    ("wall_gradient_y", "gradient of the kernel over the walls, 1/m", Number(|row| row.fields.wall_gradient[row.i].y)),
    ("preferred_vel_x", "preferred velocity, m/s", Number(|row| row.fields.preferred_velocity[row.i].x)),
    ("preferred_vel_y", "preferred velocity, m/s", Number(|row| row.fields.preferred_velocity[row.i].y)),
    ("acc_x", "acceleration, m/s²", Number(|row| row.fields.acceleration[row.i].x)),
    ("acc_y", "acceleration, m/s²", Number(|row| row.fields.acceleration[row.i].y)),
];

/// The columns of buildings.
const OF_LEVELS: [(&str, &str, Value); 2] = [
    (
        "level",
        "name of the agent's level",
        Name(|row| row.level()),
    ),
    (
        "z",
        "height of the floor at the agent, m",
        Number(|row| row.height()),
    ),
];

impl<'a> Row<'a> {
    /// Unique, from 0 in the order of entry.
    pub fn id(&self) -> u32 {
        id_of(self.agents, self.i)
    }

    fn group(&self) -> &'a Group {
        &self.scene.groups[usize::from(self.agents.group[self.i])]
    }

    fn push(&self) -> Option<&'a str> {
        let push = self.agents.push[self.i]?;
        Some(&self.scene.pushes[usize::from(push)].name)
    }

    /// r_i in the plane of the engine, meters.
    fn position(&self) -> Vector {
        self.agents.position[self.i]
    }

    /// r_i, in a building at its place there, meters.
    pub fn place(&self) -> Vector {
        self.in_building(self.position())
    }

    /// A place of the plane in the building, meters: on one level, the place itself.
    fn in_building(&self, place: Vector) -> Vector {
        let levels = self.scene.levels.as_ref();
        levels.map_or(place, |levels| levels.in_building(place))
    }

    /// The name of the level of a building on which the agent is.
    pub fn level(&self) -> Option<&'a str> {
        let levels = self.scene.levels.as_ref()?;
        Some(&levels.all()[levels.level(self.position())].name)
    }

    /// The height of the floor at the agent, meters.
    pub fn height(&self) -> f64 {
        let levels = self.scene.levels.as_ref();
        levels.map_or(0.0, |levels| levels.height(self.position()))
    }

    /// v_i, m/s.
    fn velocity(&self) -> Vector {
        self.agents.velocity[self.i]
    }

    /// |v_i|, m/s.
    pub fn speed(&self) -> f64 {
        self.velocity().norm()
    }

    /// The direction in which the agent faces: that of its velocity, that of its goal if it stands, the x direction if
    /// it also stands at its goal.
    pub fn orientation(&self) -> Vector {
        let facing = match self.speed() < STANDING {
            true => {
                let goal = self.agents.goal[self.i];
                let ahead = self.group().direction;
                direction(ahead.unwrap_or(goal - self.position()))
            }
            false => direction(self.velocity()),
        };
        match facing == Vector::zeros() {
            true => Vector::x(),
            false => facing,
        }
    }

    /// m_i, 1 = an average person.
    pub fn mass(&self) -> f64 {
        self.agents.mass[self.i]
    }

    /// ρ_i, P/m².
    pub fn density(&self) -> f64 {
        self.fields.density[self.i]
    }

    /// p_i, 1/s².
    pub fn pressure(&self) -> f64 {
        self.fields.pressure[self.i]
    }

    /// A number that a force shows, as [`OfForce`].
    pub fn of_force(&self, force: usize, k: usize) -> Option<f64> {
        let states = &self.agents.states[force];
        let state = states.of(self.i)?;
        let of_profile = self.group().blend.forces();
        let mut all = of_profile.iter().chain(&self.scene.own_forces);
        let force = all.find(|force| force.name() == states.force)?;
        force.values(self.position(), state).get(k).copied()
    }
}

/// The columns of a scene: [`COLUMNS`], and those of the forces that keep a state for agents.
pub fn columns(scene: &Scene) -> Vec<(&'static str, &'static str, Value)> {
    let of_forces = scene.keeping_forces().into_iter().enumerate();
    let of_forces = of_forces.flat_map(|(number, force)| {
        let shown = force.shown().iter().enumerate();
        shown.map(move |(k, shown)| (shown.name, shown.about, OfForce(number, k)))
    });
    let of_levels = OF_LEVELS.into_iter().filter(|_| scene.levels.is_some());
    COLUMNS
        .into_iter()
        .chain(of_levels)
        .chain(of_forces)
        .collect()
}

impl Serialize for Row<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let columns = columns(self.scene);
        let mut record = serializer.serialize_struct("Row", columns.len())?;
        for (name, _, value) in &columns {
            match value {
                Count(of) => record.serialize_field(name, &of(self))?,
                Number(of) => record.serialize_field(name, &of(self))?,
                Name(of) => record.serialize_field(name, &of(self))?,
                OfForce(force, k) => record.serialize_field(name, &self.of_force(*force, *k))?,
            }
        }
        record.end()
    }
}

/// All agents in an evaluated frame with the number `number`, by id.
pub fn rows(simulation: &Simulation, number: u64) -> Vec<Row<'_>> {
    let Frame { agents, fields, .. } = simulation.frame();
    let mut order: Vec<usize> = agents.present().collect();
    order.sort_unstable_by_key(|&i| id_of(agents, i));
    let row = |i| Row {
        number,
        time: simulation.frame().clock.time(),
        agents,
        fields,
        scene: simulation.scene(),
        i,
    };
    order.into_iter().map(row).collect()
}

/// The id of an agent, or of its current lap. Programs that read trajectories compute speeds from positions: with one
/// id for all laps, an agent would seem to run back at the end of each.
fn id_of(agents: &Agents, i: usize) -> u32 {
    let laps = agents.laps.get(i).copied().unwrap_or(0);
    let back = u32::from(laps < 0);
    let number = laps.unsigned_abs().wrapping_mul(2).wrapping_sub(back);
    let first = agents.entered().wrapping_mul(number);
    first.wrapping_add(agents.id[i])
}
