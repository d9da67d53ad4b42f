//! The work that the engine skips, done beside it on its frozen frames.

use std::hint::black_box;
use std::time::Instant;

use rayon::prelude::*;

use crate::engine::agents::Agents;
use crate::engine::forces::rvo::Scratch;
use crate::engine::neighbors::{Lists, Neighbors};
use crate::engine::pairs::Packed;
use crate::engine::scene::Needs;
use crate::engine::simulation::{Fault, Simulation, StageTimes};
use crate::lab::bench::timing::warmed;

/// Work for every evaluated frame.
pub trait Work {
    /// Does the work, and returns the seconds that it took.
    fn seconds(&mut self, simulation: &Simulation) -> f64;

    /// Why there is nothing to do in this scene, or `None` if there is something.
    fn nothing_to_do(&self, simulation: &Simulation) -> Option<&'static str> {
        let _ = simulation;
        None
    }
}

/// A crowd that moves on, optionally with work beside it.
pub struct Course {
    simulation: Simulation,
    work: Option<Box<dyn Work>>,
    /// Time that the work took.
    seconds: f64,
    frames: u64,
}

impl Course {
    /// A copy that also computes `more`, after the warm-up. All copies are sorted in the same frame.
    pub fn new(
        start: &Simulation,
        more: &Needs,
        work: Option<Box<dyn Work>>,
    ) -> Result<Self, Fault> {
        let mut simulation = start.clone();
        simulation.pay_for(more);
        let mut simulation = warmed(simulation)?;
        simulation.reset_stages();
        Ok(Self {
            simulation,
            work,
            seconds: 0.0,
            frames: 0,
        })
    }

    /// Simulates `frames` frames.
    pub fn advance(&mut self, frames: u64) -> Result<(), Fault> {
        for _ in 0..frames {
            self.simulation.evaluate()?;
            if let Some(work) = &mut self.work {
                self.seconds += work.seconds(&self.simulation);
            }
            self.simulation.integrate()?;
        }
        self.frames += frames;
        Ok(())
    }

    /// The time of the simulation itself.
    pub fn times(&self) -> &StageTimes {
        self.simulation.stages()
    }

    /// The time of the work.
    pub fn work_ms_per_frame(&self) -> f64 {
        1e3 * self.seconds / self.frames as f64
    }
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// Was the crowd sorted in this frame?
fn is_sorted(simulation: &Simulation) -> bool {
    let frame = simulation.frame();
    frame.neighbors.sorted_at() == frame.agents.position
}

/// RVO for all agents whose blend contains RVO but gives it no weight at the moment.
pub struct RvoByBlend;

impl Work for RvoByBlend {
    fn seconds(&mut self, simulation: &Simulation) -> f64 {
        let frame = simulation.frame();
        if !frame.clock.is_coarse() {
            return 0.0;
        }
        let max_speed = simulation.scene().max_speed;
        seconds(|| {
            (0..frame.agents.len()).into_par_iter().for_each_init(
                Scratch::default,
                |scratch, i| {
                    let blend = simulation.blend(i);
                    if let Some(rvo) = blend.rvo()
                        && !blend.rvo_acts(&frame, i)
                    {
                        black_box(rvo.acceleration(&frame, i, max_speed, scratch));
                    }
                },
            );
        })
    }

    fn nothing_to_do(&self, simulation: &Simulation) -> Option<&'static str> {
        let mut groups = simulation.scene().groups.iter();
        let none =
            groups.all(|group| group.blend.rvo().is_none() || !group.blend.depends_on_density());
        none.then_some("no blend has RVO at some densities only")
    }
}

/// Sorting and listing at fixed intervals.
pub struct KeptLists {
    coarse: bool,
    neighbors: Neighbors,
    packed: Packed,
}

impl KeptLists {
    pub fn every_frame() -> Self {
        Self {
            coarse: false,
            neighbors: Neighbors::default(),
            packed: Packed::default(),
        }
    }

    pub fn every_coarse_frame() -> Self {
        Self {
            coarse: true,
            ..Self::every_frame()
        }
    }
}

impl Work for KeptLists {
    fn seconds(&mut self, simulation: &Simulation) -> f64 {
        let (frame, scene, needs) = (simulation.frame(), simulation.scene(), simulation.needs());
        if self.coarse && !frame.clock.is_coarse() {
            return 0.0;
        }
        let mut agents: Agents = frame.agents.clone();
        let Self {
            neighbors, packed, ..
        } = self;
        seconds(|| {
            neighbors.sort(&mut agents, scene.ranges(needs));
            neighbors.list_walls(&agents, frame.walls);
            if needs.pairs.any() || needs.social || needs.density {
                neighbors.list_agents();
                packed.take_bodies(&agents, neighbors.extent(), |i| {
                    let group = &scene.groups[usize::from(agents.group[i])];
                    group.blend.sph.support_radius
                });
            }
        })
    }
}

/// The time of a wall search agent by agent, minus that of a search by blocks.
#[derive(Default)]
pub struct WallsByBlocks {
    near: Lists,
    far: Lists,
}

impl Work for WallsByBlocks {
    fn seconds(&mut self, simulation: &Simulation) -> f64 {
        if !is_sorted(simulation) {
            return 0.0;
        }
        let frame = simulation.frame();
        let (agents, walls) = (frame.agents, frame.walls);
        let ranges = simulation.scene().ranges(simulation.needs());
        let least = ranges.support.max(ranges.longest_step);
        let mut neighbors = frame.neighbors.clone();
        let by_blocks = seconds(|| neighbors.list_walls(agents, walls));
        let list = |lists: &mut Lists, reach: &(dyn Fn(usize) -> f64 + Sync)| {
            let nobody_knows = |_| vec![0]; // no search by blocks
            lists.rebuild(agents.len(), nobody_knows, |i, _, found| {
                walls.near(agents.position[i], reach(i) + ranges.drift, found);
            });
        };
        let one_by_one = seconds(|| {
            list(&mut self.near, &|i| least.max(agents.radius[i]));
            if let Some(radius) = ranges.avoidance {
                list(&mut self.far, &|_| radius);
            }
        });
        one_by_one - by_blocks
    }

    fn nothing_to_do(&self, simulation: &Simulation) -> Option<&'static str> {
        let none = simulation.scene().walls.is_empty();
        none.then_some("there are no walls")
    }
}
