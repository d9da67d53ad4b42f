//! One agent in one frame.

use rayon::prelude::*;
use serde::Serialize;

use engine::agents::Agents;
use engine::frame::Frame;
use engine::math::{Vector, direction};
use engine::simulation::Simulation;

/// Below this speed, m/s, an agent faces its goal: the direction of such a velocity is noise.
const STANDING: f64 = 0.01;

/// All quantities of one agent in one frame. The fields are the columns of a CSV file. SI units.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Row<'a> {
    /// The frame's number at the file's own rate, from 0.
    pub frame: u64,
    /// Seconds.
    pub time: f64,
    /// Unique, from 0 in the order of entry. In a periodic scene each lap of an agent has an id of its own: its
    /// remainder modulo the number of agents is the agent's id.
    pub id: u32,
    /// The name of the agent's group.
    pub group: &'a str,
    /// The push that the agent takes part in.
    pub push: Option<&'a str>,
    /// r_i, meters.
    pub pos_x: f64,
    /// Its y component.
    pub pos_y: f64,
    /// v_i, m/s.
    pub vel_x: f64,
    /// Its y component.
    pub vel_y: f64,
    /// |v_i|, m/s.
    pub speed: f64,
    /// Direction of the velocity, or of the goal if the agent stands still: a unit vector.
    pub ori_x: f64,
    /// Its y component.
    pub ori_y: f64,
    /// g_i, meters; the start of an agent that walks in a direction.
    pub goal_x: f64,
    /// Its y component.
    pub goal_y: f64,
    /// D_i, meters.
    pub radius: f64,
    /// m_i, 1 = an average person.
    pub mass: f64,
    /// ρ_i, P/m².
    pub density: f64,
    /// The walls' part of ρ_i, P/m².
    pub density_from_walls: f64,
    /// ρ̂_i, P/m².
    pub mean_density: f64,
    /// ρ_i⁰, P/m².
    pub rest_density: f64,
    /// p_i, 1/s².
    pub pressure: f64,
    /// Σ_k ∫ ∇W over P_k, 1/m.
    pub wall_gradient_x: f64,
    /// Its y component.
    pub wall_gradient_y: f64,
    /// v_i^pref, m/s.
    pub preferred_vel_x: f64,
    /// Its y component.
    pub preferred_vel_y: f64,
    /// a_i, m/s².
    pub acc_x: f64,
    /// Its y component.
    pub acc_y: f64,
    /// y_i, the position of the legs, meters; `None`, and no column, if no profile has legs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub legs_x: Option<f64>,
    /// Its y component.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub legs_y: Option<f64>,
    /// w_i, the velocity of the legs, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub legs_vel_x: Option<f64>,
    /// Its y component.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub legs_vel_y: Option<f64>,
    /// |r_i − y_i|, meters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lean: Option<f64>,
}

/// The value of a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell<'a> {
    /// A whole number.
    Count(u64),
    /// A number; NaN if there is none.
    Number(f64),
    /// A name; `None` if there is none.
    Name(Option<&'a str>),
}

impl<'a> Row<'a> {
    /// The name, the meaning with its unit, and the value of each field.
    pub fn cells(&self) -> [(&'static str, &'static str, Cell<'a>); 32] {
        use Cell::{Count, Name, Number};
        let of_legs = |value: Option<f64>| Number(value.unwrap_or(f64::NAN));
        [
            (
                "frame",
                "number of the frame at the file's own rate",
                Count(self.frame),
            ),
            ("time", "time, s", Number(self.time)),
            (
                "id",
                "the agent, from 0 in the order of entry",
                Count(self.id.into()),
            ),
            ("group", "name of the agent's group", Name(Some(self.group))),
            (
                "push",
                "name of the push that the agent takes part in",
                Name(self.push),
            ),
            ("pos_x", "position, m", Number(self.pos_x)),
            ("pos_y", "position, m", Number(self.pos_y)),
            ("vel_x", "velocity, m/s", Number(self.vel_x)),
            ("vel_y", "velocity, m/s", Number(self.vel_y)),
            ("speed", "speed, m/s", Number(self.speed)),
            (
                "ori_x",
                "direction in which the agent faces, of length 1",
                Number(self.ori_x),
            ),
            (
                "ori_y",
                "direction in which the agent faces, of length 1",
                Number(self.ori_y),
            ),
            ("goal_x", "goal, m", Number(self.goal_x)),
            ("goal_y", "goal, m", Number(self.goal_y)),
            ("radius", "radius of the body, m", Number(self.radius)),
            ("mass", "mass, 1 = an average person", Number(self.mass)),
            ("density", "density, P/m²", Number(self.density)),
            (
                "density_from_walls",
                "the walls' part of the density, P/m²",
                Number(self.density_from_walls),
            ),
            (
                "mean_density",
                "mean density of the last seconds, P/m²",
                Number(self.mean_density),
            ),
            (
                "rest_density",
                "rest density, P/m²",
                Number(self.rest_density),
            ),
            ("pressure", "pressure, 1/s²", Number(self.pressure)),
            (
                "wall_gradient_x",
                "gradient of the kernel over the walls, 1/m",
                Number(self.wall_gradient_x),
            ),
            (
                "wall_gradient_y",
                "gradient of the kernel over the walls, 1/m",
                Number(self.wall_gradient_y),
            ),
            (
                "preferred_vel_x",
                "preferred velocity, m/s",
                Number(self.preferred_vel_x),
            ),
            (
                "preferred_vel_y",
                "preferred velocity, m/s",
                Number(self.preferred_vel_y),
            ),
            ("acc_x", "acceleration, m/s²", Number(self.acc_x)),
            ("acc_y", "acceleration, m/s²", Number(self.acc_y)),
            ("legs_x", "position of the legs, m", of_legs(self.legs_x)),
            ("legs_y", "position of the legs, m", of_legs(self.legs_y)),
            (
                "legs_vel_x",
                "velocity of the legs, m/s",
                of_legs(self.legs_vel_x),
            ),
            (
                "legs_vel_y",
                "velocity of the legs, m/s",
                of_legs(self.legs_vel_y),
            ),
            (
                "lean",
                "distance from the legs to the body, m",
                of_legs(self.lean),
            ),
        ]
    }
}

/// All agents in an evaluated frame with the number `number`, by id.
pub fn rows(simulation: &Simulation, number: u64) -> Vec<Row<'_>> {
    let agents = simulation.frame().agents;
    let mut order: Vec<usize> = agents.present().collect();
    order.sort_unstable_by_key(|&i| id_of(agents, i));
    let row = |i| row(simulation, number, i);
    order.into_par_iter().with_min_len(1024).map(row).collect()
}

fn row(simulation: &Simulation, number: u64, i: usize) -> Row<'_> {
    let (frame, scene) = (simulation.frame(), simulation.scene());
    let Frame { agents, fields, .. } = frame;
    let (position, velocity, goal) = (agents.position[i], agents.velocity[i], agents.goal[i]);
    let group = &scene.groups[usize::from(agents.group[i])];
    let ahead = group.direction.unwrap_or(goal - position);
    let orientation = orientation(velocity, ahead);
    let wall_gradient = fields.wall_gradient[i];
    let preferred_velocity = fields.preferred_velocity[i];
    let acceleration = fields.acceleration[i];
    let (legs, legs_velocity) = (agents.legs.get(i), agents.legs_velocity.get(i));
    Row {
        frame: number,
        time: frame.clock.time(),
        id: id_of(agents, i),
        group: &group.name,
        push: agents.push[i].map(|push| scene.pushes[usize::from(push)].name.as_str()),
        pos_x: position.x,
        pos_y: position.y,
        vel_x: velocity.x,
        vel_y: velocity.y,
        speed: velocity.norm(),
        ori_x: orientation.x,
        ori_y: orientation.y,
        goal_x: goal.x,
        goal_y: goal.y,
        radius: agents.radius[i],
        mass: agents.mass[i],
        density: fields.density[i],
        density_from_walls: fields.density_from_walls[i],
        mean_density: fields.mean_density[i],
        rest_density: fields.rest_density[i],
        pressure: fields.pressure[i],
        wall_gradient_x: wall_gradient.x,
        wall_gradient_y: wall_gradient.y,
        preferred_vel_x: preferred_velocity.x,
        preferred_vel_y: preferred_velocity.y,
        acc_x: acceleration.x,
        acc_y: acceleration.y,
        legs_x: legs.map(|legs| legs.x),
        legs_y: legs.map(|legs| legs.y),
        legs_vel_x: legs_velocity.map(|velocity| velocity.x),
        legs_vel_y: legs_velocity.map(|velocity| velocity.y),
        lean: legs.map(|_| agents.lean(i).norm()),
    }
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

/// The direction in which an agent faces: `ahead` if it stands, the x direction if it also stands at its goal.
fn orientation(velocity: Vector, ahead: Vector) -> Vector {
    let facing = match velocity.norm() < STANDING {
        true => direction(ahead),
        false => direction(velocity),
    };
    match facing == Vector::zeros() {
        true => Vector::x(),
        false => facing,
    }
}
