//! The people around each person, seen through the kernel of Eq. 13, with walls between them.

mod moments;

pub use moments::Moments;

use rayon::prelude::*;

use super::site::{Hidden, Site};
use engine::agents::{Agents, NewAgent, REFERENCE_RADIUS};
use engine::density::from_agents;
use engine::geometry::Walls;
use engine::kernel;
use engine::math::{Vector, bounds};
use engine::neighbors::{BLOCK, Neighbors, Ranges};
use engine::pairs::{Bodies, Reach};

/// At most this share of a kernel counts as hidden: in a narrow gap, the visible rest is too small to be meaningful.
pub const MOST_HIDDEN: f64 = 0.9;

/// A wall hides no person farther in front of it than this, meters: more than the rounding of distances.
const ON_WALL: f64 = 1e-9;

/// The people around each person in a frame.
pub struct Surroundings<'a> {
    walls: &'a Walls,
    /// h, meters.
    support_radius: f64,
    /// Sorted; their ids count the people in the given order.
    agents: Agents,
    neighbors: Neighbors,
    /// The walls near agents that lean over walls, in place of those that `neighbors` lists.
    near_eye: Vec<Option<Vec<u32>>>,
    /// The part of the kernel that walls hide from each agent.
    hidden: Vec<Hidden>,
    /// The corners of the rectangle around all agents, meters; `None` if some lean over walls.
    extent: Option<[Vector; 2]>,
    /// The index of each person.
    index: Vec<usize>,
}

impl<'a> Surroundings<'a> {
    /// The people around each of `positions`, as far as h. Without `masses`, all masses are 1. `hide` returns what
    /// walls hide from a person at a position, given the walls within h, which it may replace by those within h of the
    /// eye.
    pub fn new(
        walls: &'a Walls,
        positions: &[Vector],
        masses: &[f64],
        support_radius: f64,
        hide: impl Fn(Vector, &mut Vec<u32>) -> Hidden + Sync,
    ) -> Self {
        let mut agents = Agents::default();
        for (k, &position) in positions.iter().enumerate() {
            let person = NewAgent {
                radius: Some(REFERENCE_RADIUS),
                mass: Some(masses.get(k).copied().unwrap_or(1.0)),
                ..NewAgent::at(position, position, 0)
            };
            agents.enter(person, 0);
        }
        let ranges = Ranges {
            support: support_radius,
            ..Ranges::default()
        };
        let mut neighbors = Neighbors::default();
        neighbors.sort(&mut agents, ranges);
        neighbors.list_agents();
        neighbors.list_walls(&agents, walls);
        let seen = agents.position.par_iter().enumerate().with_min_len(BLOCK);
        let seen = seen.map_init(Vec::new, |near: &mut Vec<u32>, (i, &position)| {
            let listed = neighbors.near_walls(i);
            near.clear();
            near.extend_from_slice(listed);
            let hidden = hide(position, near);
            (hidden, (near != listed).then(|| near.clone()))
        });
        let (hidden, near_eye): (Vec<Hidden>, Vec<_>) = seen.unzip();
        let all_outside = hidden.iter().all(|hidden| hidden.inside.is_none());
        let extent = bounds(positions.iter().copied()).filter(|_| all_outside);
        let mut index = vec![0; agents.len()];
        for (i, &id) in agents.id.iter().enumerate() {
            index[id as usize] = i;
        }
        Self {
            walls,
            support_radius,
            agents,
            neighbors,
            near_eye,
            hidden,
            extent,
            index,
        }
    }

    /// The part of the kernel that walls hide from a person.
    pub fn hidden(&self, person: usize) -> Hidden {
        self.hidden[self.index[person]]
    }

    /// Σ_j m_j W including j = i, P/m², of each person: by the engine's own sums, in double precision, over all people
    /// within reach or, near walls, only over the visible ones.
    pub fn from_people(&self, only_visible: bool) -> Vec<f64> {
        let agents = &self.agents;
        let mut bodies = Bodies::<f64>::default();
        bodies.take(agents, 1.0, Vector::zeros(), |_| self.reach());
        bodies.take_motions(agents);
        let mut sums = vec![0.0; agents.len()];
        let blocks = sums.par_chunks_mut(BLOCK).enumerate();
        blocks.for_each(|(b, sums)| from_agents(&bodies, self.neighbors.near().block(b), sums));
        if only_visible {
            let sums = sums.par_iter_mut().enumerate().with_min_len(BLOCK);
            let partly = sums.filter(|(i, _)| self.sees_partly(*i));
            partly.for_each(|(i, sum)| *sum = self.visible(i).map(|(_, weight)| weight).sum());
        }
        self.index.iter().map(|&i| sums[i]).collect()
    }

    /// The walls within h of the eye of agent `i`.
    fn near_walls(&self, i: usize) -> &[u32] {
        let listed = || self.neighbors.near_walls(i);
        self.near_eye[i].as_deref().unwrap_or_else(listed)
    }

    /// Whether walls may stand between agent `i` and others within h.
    fn sees_partly(&self, i: usize) -> bool {
        let near = self.near_walls(i);
        let Some([low, high]) = self.extent else {
            return !near.is_empty();
        };
        let (eye, reach) = (self.hidden[i].eye, Vector::repeat(self.support_radius));
        let [low, high] = [low.sup(&(eye - reach)), high.inf(&(eye + reach))];
        let may_hide = |&k: &u32| {
            let wall = self.walls.wall(k);
            let farthest_behind =
                low.zip_zip_map(
                    &high,
                    &wall.normal,
                    |low, high, normal| {
                        if normal > 0.0 { low } else { high }
                    },
                );
            wall.faces(eye) && wall.signed_distance(farthest_behind) < ON_WALL
        };
        near.iter().any(may_hide)
    }

    fn reach(&self) -> Reach {
        Reach {
            support_radius: self.support_radius,
            contact_scale: 1.0,
        }
    }

    /// The moments of the velocities that each person sees, its own included.
    pub fn moments(&self, velocities: &[Option<Vector>]) -> Vec<Moments> {
        let mut agents = self.agents.clone();
        for i in 0..agents.len() {
            let known = velocities[agents.id[i] as usize];
            agents.velocity[i] = known.unwrap_or_default();
            agents.mass[i] = if known.is_some() { 1.0 } else { 0.0 };
        }
        let mut bodies = Bodies::<f64>::default();
        bodies.take(&agents, 1.0, Vector::zeros(), |_| self.reach());
        bodies.take_motions(&agents);
        let mut found = vec![Moments::default(); agents.len()];
        let blocks = found.par_chunks_mut(BLOCK).enumerate();
        blocks.for_each(|(b, found)| {
            moments::of_block(&bodies, self.neighbors.near().block(b), found);
            for (i, found) in (b * BLOCK..).zip(found) {
                if self.sees_partly(i) {
                    *found = Moments::default();
                    for (j, weight) in self.visible(i) {
                        found.add(weight * agents.mass[j], agents.velocity[j]);
                    }
                }
            }
        });
        self.index.iter().map(|&i| found[i]).collect()
    }

    /// The agents j that agent `i` sees, itself included, each with m_j W in P/m².
    fn visible(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (agents, near, eye) = (&self.agents, self.near_walls(i), self.hidden[i].eye);
        let candidates = self.neighbors.near().near(i).map(|(j, _)| j);
        let weighted = candidates.map(move |j| {
            let offset = agents.position[i] - agents.position[j];
            let kernel = kernel::density(offset.norm_squared(), self.support_radius);
            (j, agents.mass[j] * kernel)
        });
        weighted.filter(move |&(j, weight)| {
            j == i || weight > 0.0 && Site::is_clear(self.walls, eye, self.hidden[j].eye, near)
        })
    }
}
