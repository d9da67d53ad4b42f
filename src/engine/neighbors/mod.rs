//! Step 1: the neighbors of each agent, and the walls near it.
//!
//! Agents are sorted into the cells of a [`Grid`]. Near neighbors (for SPH and contact) are listed as runs of
//! agents in memory, for [`Clusters`] of agents that are close together. The lists have a margin, the *skin*:
//! until an agent has moved by half of it since the sort, they miss no neighbor; in a large crowd, until agents that
//! are near each other have moved by it against each other ([`Shifts`]). Neighbors in the wide circle of the avoidance
//! methods are read from the grid's rows, without lists.

mod clusters;
mod grid;
mod lists;
mod run;
mod shifts;
mod wall_cells;

pub use clusters::{BLOCK, CLUSTER, ClusterBlock, Clusters, TASK, WIDEST, WIDEST_SOCIAL};
pub use grid::{Grid, Place};
pub use lists::Lists;
pub use run::Run;
pub use shifts::{STRIP, Shifts};

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use crate::agents::{Agents, Spare};
use crate::geometry::Walls;
use crate::levels::Levels;
use crate::math::{Vector, bounds};
use crate::period::Period;
use shifts::Tiles;
use wall_cells::WallCells;

/// Margin of all lists, meters: when an agent has moved by half of it since the sort, all lists are rebuilt. With a
/// larger margin, lists are rebuilt less often but are longer.
pub const SKIN: f64 = 0.14;

/// From this number of agents on, lists follow a crowd that moves as one. Sorts of smaller crowds cost little: their
/// agents are in fast memory.
pub const MANY: usize = 30_000;

/// The distance that any agent may move before the next sort if lists follow the crowd, meters. With a longer one,
/// sorts are fewer, and more walls are listed.
pub const FOLLOWED: f64 = 1.0;

/// When the lists of near agents are rebuilt, and whether they can miss neighbors in between.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ListPolicy {
    /// As often as needed, with a margin: no neighbor is ever missed.
    #[default]
    Complete,
    /// In every coarse frame, without a margin (§5.1): agents that come near in between are missed.
    Coarse,
}

/// The ranges of the neighbor search. Ranges that no profile needs are `None` and cost nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranges {
    /// Support radius h of SPH, meters.
    pub support: f64,
    /// Radius of the avoidance methods, meters.
    pub avoidance: Option<f64>,
    /// Radius within which walking laws see walls, meters.
    pub sight: Option<f64>,
    /// Radius of the sums over agents that do not read the lists of near agents, meters: social forces and walking
    /// laws.
    pub wide: Option<f64>,
    /// The greatest width of a cluster, in units of the lists' reach: at most [`WIDEST`].
    pub widest_cluster: f64,
    /// The longest step of any agent in a frame, s_max Δt, meters.
    pub longest_step: f64,
    /// The distance that any agent may move between sorts without missing a wall, meters.
    pub drift: f64,
    /// The distance that any agent may move between sorts without missing a neighbor, meters; at most `drift`. If lists
    /// follow the crowd, half of the distance that two that are near each other may move against each other.
    pub margin: f64,
    /// Whether lists are valid until agents that are near each other have moved by the [`SKIN`] against each other, not
    /// only until one has moved by half of it.
    pub follow: bool,
    /// Agents are also neighbors across the ends of this period, in which all of them are at the sort.
    pub period: Option<Period>,
}

impl Default for Ranges {
    fn default() -> Self {
        Self {
            support: 0.0,
            avoidance: None,
            sight: None,
            wide: None,
            widest_cluster: WIDEST,
            longest_step: 0.0,
            drift: 0.0,
            margin: 0.0,
            follow: false,
            period: None,
        }
    }
}

impl Ranges {
    /// The distance within which agents of these radii act on each other, meters.
    pub fn interaction(&self, widest: f64) -> f64 {
        let avoidance = self.avoidance.unwrap_or_default();
        self.support.max(2.0 * widest).max(avoidance)
    }

    /// The distance within which agents read each other, meters: at least `reach`, that of the lists.
    fn farthest(&self, reach: f64) -> f64 {
        let others = [self.avoidance, self.wide];
        others.into_iter().flatten().fold(reach, f64::max)
    }
}

/// Neighbors as of the last sort.
#[derive(Debug, Clone, Default)]
pub struct Neighbors {
    ranges: Ranges,
    /// Radius within which agents are listed as near, including the skin, meters.
    reach: f64,
    /// The largest radius of an agent, meters.
    widest: f64,
    grid: Grid,
    near: Clusters,
    near_walls: Lists,
    far_walls: Lists,
    /// The walls around each cell of the floor, for both.
    wall_cells: [WallCells; 2],
    /// The walls around each cell that walking laws see.
    seen_walls: WallCells,
    /// The agents' positions at the last sort, meters.
    sorted_at: Vec<Vector>,
    /// The greatest distance of any agent from its position at the last sort, meters.
    travelled: f64,
    /// The shifts of each [`STRIP`] of agents, if lists follow the crowd.
    strips: Vec<Shifts>,
    tiles: Tiles,
    /// Whether agents that may meet have moved against each other by more than the [`SKIN`].
    are_torn: bool,
    /// Memory that every sort needs.
    order: Vec<u32>,
    spare: Spare,
}

impl Neighbors {
    /// Neighbors on some levels, also through their joins.
    pub fn on_levels(levels: Option<Arc<Levels>>) -> Self {
        Self {
            grid: Grid::on(levels),
            ..Self::default()
        }
    }

    /// Sorts the agents into the cells of a new grid. Invalidates all lists.
    pub fn sort(&mut self, agents: &mut Agents, ranges: Ranges) {
        self.ranges = ranges;
        self.travelled = 0.0;
        self.are_torn = false;
        self.near.clear();
        self.widest = widest(agents);
        self.reach = ranges.support.max(2.0 * self.widest) + 2.0 * ranges.margin;
        let period = ranges.period;
        let (grid, order) = (&mut self.grid, &mut self.order);
        grid.rebuild(&agents.position, self.reach, period, order);
        agents.arrange_with(order, &mut self.spare);
        self.sorted_at.clone_from(&agents.position);
        let radius = ranges.farthest(self.reach) + 2.0 * ranges.drift;
        self.grid.look_through(&self.sorted_at, radius);
        let strips = agents.len().div_ceil(STRIP);
        self.strips.resize(strips, Shifts::default());
    }

    /// Lists the near neighbors of all agents, as far as SPH and contact reach.
    ///
    /// May be called some frames after the sort, as long as the lists would not be stale. The lists are built from the
    /// positions at the sort, so that they do not depend on when they are first needed: requesting a density must not
    /// change the order of any sum, which would change the motion by rounding.
    pub fn list_agents(&mut self) {
        let sizes = [self.reach, self.ranges.widest_cluster];
        self.near.rebuild(&self.grid, &self.sorted_at, sizes);
    }

    /// Lists the walls near each agent: near walls for SPH, contact and stopping moves, far walls for avoidance.
    /// Walking laws look at walls too rarely for lists.
    pub fn list_walls(&mut self, agents: &Agents, walls: &Walls) {
        let margin = self.ranges.drift;
        let least = self.ranges.support.max(self.ranges.longest_step);
        let [near, far] = &mut self.wall_cells;
        let bodies = (agents, self.widest);
        list_walls(&mut self.near_walls, near, bodies, walls, |radius| {
            least.max(radius) + margin
        });
        if let Some(sight) = self.ranges.sight {
            self.seen_walls.reach_to(walls, sight + self.widest);
        }
        match self.ranges.avoidance {
            Some(radius) => {
                list_walls(&mut self.far_walls, far, bodies, walls, |_| radius + margin);
            }
            None => self.far_walls.clear(),
        }
    }

    /// The agents' positions at the last sort, meters.
    pub fn sorted_at(&self) -> &[Vector] {
        &self.sorted_at
    }

    /// Whether lists follow the crowd: then [`moved`](Self::moved) needs the shifts of all agents.
    pub fn follow(&self) -> bool {
        self.ranges.follow
    }

    /// The memory for the shifts of each [`STRIP`] of agents.
    pub fn take_strips(&mut self) -> Vec<Shifts> {
        std::mem::take(&mut self.strips)
    }

    /// Takes the greatest distance, in meters, of any agent from its position at the last sort, and the shifts of each
    /// [`STRIP`] of agents, which count if lists follow the crowd.
    pub fn moved(&mut self, farthest: f64, strips: Vec<Shifts>) {
        (self.travelled, self.strips) = (farthest, strips);
        if self.ranges.follow && farthest > 0.5 * SKIN {
            let size = self.ranges.farthest(self.reach) + 2.0 * FOLLOWED;
            let sorted = (&self.grid, &self.sorted_at[..]);
            self.are_torn = self.tiles.differ(sorted, &self.strips, size, SKIN);
        }
    }

    /// Whether agents have moved so far since the sort that lists with the [`SKIN`] could miss a neighbor.
    pub fn are_stale(&self) -> bool {
        match self.ranges.follow {
            true => self.are_torn || self.travelled > FOLLOWED,
            false => self.travelled > 0.5 * SKIN,
        }
    }

    /// The way of one lap of a [`Run`], meters: over the period, or from a level to the next; zero without either.
    pub fn way(&self) -> Vector {
        self.grid.way()
    }

    /// The laps from an agent to the image that is nearest to another, which is `difference` away from it, meters.
    pub fn nearest_laps(&self, difference: Vector) -> i32 {
        let way = self.way();
        match way.norm_squared() {
            0.0 => 0,
            squared => (difference.dot(&way) / squared).round() as i32,
        }
    }

    /// The neighbors for SPH and contact, and some agents out of range.
    pub fn near(&self) -> &Clusters {
        &self.near
    }

    /// Coordinates may wrap with a period of twice this length, meters: wrapping makes no agent that a cluster reads
    /// seem near. See [`Clusters::extent`]. For sums without lists, the distance to an agent is at most the sum of a
    /// cluster's width, two cells, the radius and two displacements since the sort.
    pub fn extent(&self) -> f64 {
        let far = |radius: f64| radius + 2.5 * self.reach + 2.0 * self.ranges.margin;
        let unlisted = 2.0 * (self.ranges.drift - self.ranges.margin);
        Clusters::extent(self.reach).max(self.ranges.wide.map_or(0.0, far)) + unlisted
    }

    /// All agents within `radius` meters of agent `i`, itself among them, and some out of range.
    pub fn around(
        &self,
        i: usize,
        positions: &[Vector],
        radius: f64,
    ) -> impl Iterator<Item = Run> + '_ {
        let (places, margin) = self.places(positions, radius);
        self.grid.rows(places[i], [places[i]; 2], radius + margin)
    }

    /// The places from which agents look for others within `radius` meters in the grid, and how much farther they look,
    /// meters: from their `positions`, as far as the others may have moved since the sort; or, if lists follow the
    /// crowd and no sum reads agents farther away, from their positions at the sort, since when both have moved alike.
    fn places<'a>(&'a self, positions: &'a [Vector], radius: f64) -> (&'a [Vector], f64) {
        let moves_alike = self.ranges.follow && radius <= self.ranges.farthest(self.reach);
        match self.ranges {
            Ranges { margin, .. } if moves_alike => (&self.sorted_at, 2.0 * margin),
            Ranges { drift, .. } if self.ranges.follow => (positions, drift),
            Ranges { margin, .. } => (positions, margin),
        }
    }

    /// The place from which an agent at `p` sees the agents of a run: across the ends of a period, or through a join.
    pub fn seen_from(&self, p: Vector, laps: i32) -> Vector {
        self.grid.seen_from(p, laps)
    }

    /// Replaces `found` by runs with all agents within `radius` meters of any of `agents`, which are one cluster, and
    /// some that are farther away.
    pub fn around_cluster(
        &self,
        agents: Range<usize>,
        positions: &[Vector],
        radius: f64,
        found: &mut Vec<Run>,
    ) {
        found.clear();
        let (places, margin) = self.places(positions, radius);
        if self.grid.height() <= self.reach {
            let viewer = places[agents.start];
            let corners = bounds(places[agents].iter().copied()).unwrap_or_default();
            found.extend(self.grid.rows(viewer, corners, radius + margin));
            return;
        }
        // Cells had to be made larger than the reach of the lists, so clusters have one agent: list only its
        // neighbors.
        for i in agents {
            let at = [places[i], positions[i]];
            self.grid.each_near(at, positions, [radius, margin], found);
        }
    }

    /// Replaces `found` by runs with all agents that `agents`, which are one cluster, may see in a rectangle, given by
    /// its lower left and upper right corners, and some that are near it.
    pub fn inside(
        &self,
        agents: Range<usize>,
        corners: [Vector; 2],
        positions: &[Vector],
        found: &mut Vec<Run>,
    ) {
        found.clear();
        let (places, margin) = self.places(positions, 0.0);
        let margin = Vector::repeat(margin);
        let viewer = places[agents.start];
        let shifts = agents.map(|i| positions[i] - places[i]);
        let [least, most] = bounds(shifts).unwrap_or_default();
        let moved = [corners[0] - most - margin, corners[1] - least + margin];
        self.grid.inside(Some(viewer), moved, found);
        if self.grid.height() <= self.reach {
            return;
        }
        // Cells had to be made larger than the reach of the lists, and have agents that are far away.
        for Run { agents, laps } in std::mem::take(found) {
            let [low, high] = corners.map(|corner| self.seen_from(corner, laps));
            let near = agents.filter(|&j| {
                let p = positions[j as usize];
                low.x <= p.x && low.y <= p.y && p.x <= high.x && p.y <= high.y
            });
            found.extend(near.map(|j| Run {
                agents: j..j + 1,
                laps,
            }));
        }
    }

    /// All agents in a rectangle, given by its lower left and upper right corners, and some that are near it. The
    /// agents may have moved since the lists were found to be valid.
    pub fn in_rectangle(&self, [low, high]: [Vector; 2]) -> Vec<Run> {
        let margin = Vector::repeat(self.travelled * (1.0 + 1e-9)); // rounding
        let mut found = Vec::new();
        let around = [low - margin, high + margin];
        self.grid.inside(None, around, &mut found);
        found
    }

    /// The longest step of any agent in a frame, meters.
    pub fn longest_step(&self) -> f64 {
        self.ranges.longest_step
    }

    /// The largest support radius, meters.
    pub fn support(&self) -> f64 {
        self.ranges.support
    }

    /// Walls that may be within reach of agent `i` for SPH and contact, in ascending order.
    pub fn near_walls(&self, i: usize) -> &[u32] {
        self.near_walls.of(i)
    }

    /// The agents among `agents`, all of one block, that may have walls in reach for SPH and contact, with these
    /// walls.
    pub fn agents_near_walls(&self, agents: Range<usize>) -> impl Iterator<Item = (usize, &[u32])> {
        self.near_walls.listed(agents)
    }

    /// Walls that may be within reach of agent `i` for avoidance, in ascending order.
    pub fn far_walls(&self, i: usize) -> &[u32] {
        self.far_walls.of(i)
    }

    /// Walls that agents at `p` may see by their walking laws, in ascending order.
    pub fn seen_walls(&self, walls: &Walls, p: Vector) -> &[u32] {
        self.seen_walls.around(walls, p)
    }

    /// The radius within which walking laws see walls, meters.
    pub fn sight(&self) -> f64 {
        self.ranges.sight.unwrap_or_default()
    }
}

/// Up to this many candidate walls of a block of agents are checked for each of them; of more, those around its cell.
const FEW_WALLS: usize = 16;

/// Lists the walls within reach of each agent; `reach` is a function of the agent's radius, of which `widest` is the
/// largest.
fn list_walls(
    lists: &mut Lists,
    cells: &mut WallCells,
    (agents, widest): (&Agents, f64),
    walls: &Walls,
    reach: impl Fn(f64) -> f64 + Sync,
) {
    if walls.is_empty() {
        lists.clear();
        return;
    }
    if walls.len() > FEW_WALLS {
        cells.reach_to(walls, reach(widest));
    }
    let reach = |i: usize| reach(agents.radius[i]);
    let cells = &*cells;
    lists.rebuild(
        agents.len(),
        |some| {
            let widest = some.clone().map(reach).fold(0.0, f64::max);
            walls.near_any(&agents.position[some], widest)
        },
        |i, candidates, found| {
            let (p, radius) = (agents.position[i], reach(i));
            let candidates = match candidates.len() {
                ..=FEW_WALLS => candidates,
                _ => cells.around(walls, p),
            };
            found.extend(candidates.iter().filter(|&&k| {
                let wall = walls.wall(k);
                !wall.is_beyond(p, radius)
                    && (wall.nearest_point(p).point - p).norm_squared() < radius * radius
            }));
        },
    );
}

/// The largest radius of an agent, meters.
fn widest(agents: &Agents) -> f64 {
    let radii = agents.radius.par_chunks(BLOCK).with_min_len(TASK);
    let widest = radii.map(|some| some.iter().copied().fold(0.0, f64::max));
    widest.reduce(|| 0.0, f64::max)
}
