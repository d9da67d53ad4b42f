//! Where rooms end, and how far agents are from there.

use rayon::prelude::*;

use crate::math::Vector;
use crate::routes::floor::{Mesh, to_segment};

/// Free distances are clamped to this, meters: agents farther from all limits are located again after such a move.
const FARTHEST: f64 = 1.0;
/// Agents are never deeper in walls than this, meters.
const IN_WALLS: f64 = 0.5;

/// The limits of rooms: the closed sides of triangles between two rooms, which are parts of openings and passages that
/// are too narrow for routes.
#[derive(Debug, Clone)]
pub struct Limits {
    /// The closed sides, meters.
    sides: Vec<[Vector; 2]>,
    /// The sides near triangle t that limit its room have the numbers `near[starts[t]..starts[t + 1]]`.
    near: Vec<u32>,
    starts: Vec<u32>,
}

impl Limits {
    /// The limits of the rooms of a triangulation; `room` has the room of each triangle.
    pub fn of(mesh: &Mesh, room: &[u32]) -> Self {
        let mut sides = Vec::new();
        let count = room.iter().max().map_or(0, |&most| most as usize + 1);
        let mut of_room: Vec<Vec<u32>> = vec![Vec::new(); count];
        for (ends, beside) in mesh.closed_sides() {
            let rooms = beside.map(|t| room[t as usize]);
            if rooms[0] != rooms[1] {
                for room in rooms {
                    of_room[room as usize].push(sides.len() as u32);
                }
                sides.push(ends);
            }
        }
        let near = (0..room.len() as u32).into_par_iter().map(|t| {
            let middle = mesh.middle(t);
            let corners = mesh.corners(t).into_iter();
            let radius = corners.map(|c| (c - middle).norm()).fold(0.0, f64::max);
            let is_near = |&side: &u32| {
                let [a, b] = sides[side as usize];
                to_segment(middle, a, b) < radius + FARTHEST + IN_WALLS
            };
            let all = of_room[room[t as usize] as usize].iter().copied();
            all.filter(is_near).collect()
        });
        let near: Vec<Vec<u32>> = near.collect();
        let mut starts = vec![0];
        starts.extend(near.iter().scan(0, |end, near| {
            *end += near.len() as u32;
            Some(*end)
        }));
        Self {
            sides,
            near: near.concat(),
            starts,
        }
    }

    /// The distance from `p` in triangle `t` to the nearest limit of its room, at most a meter.
    pub fn distance(&self, t: u32, p: Vector) -> f64 {
        let [from, to] = [t, t + 1].map(|t| self.starts[t as usize] as usize);
        let near = self.near[from..to].iter();
        let distances = near.map(|&side| {
            let [a, b] = self.sides[side as usize];
            to_segment(p, a, b)
        });
        distances.fold(FARTHEST, f64::min)
    }

    /// The memory that they take, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.sides[..]) + size_of_val(&self.near[..]) + size_of_val(&self.starts[..])
    }
}
