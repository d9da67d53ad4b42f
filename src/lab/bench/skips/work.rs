//! The work that the engine skips, done separately on its frozen frames.

use std::hint::black_box;
use std::time::Instant;

use rayon::prelude::*;

use super::Undone;
use crate::bench::timing::{failed, ms_of, warmed};
use crate::error::LabError;
use analysis::evaluated::Evaluated;
use engine::forces::rvo::{Preference, Scratch};
use engine::forces::walking::{Decided, Deciders, Headway, WalkingLaw};
use engine::geometry::{Area, Ring};
use engine::math::{Vector, bounds};
use engine::neighbors::{BLOCK, Lists, Neighbors, TASK};
use engine::pairs::Packed;
use engine::routes::{Floor, Route, Routes};
use engine::simulation::{Simulation, StageTimes};
use scenario::measurements::{Integrity, Measure, Watched};

/// Does the work for an evaluated frame, and returns the seconds that it took.
pub type Work = Box<dyn FnMut(&Simulation) -> f64 + Send>;

/// A crowd that moves on, optionally with a skip undone.
pub struct Course {
    simulation: Simulation,
    undone: Option<Undone>,
    /// Time that separate work took.
    seconds: f64,
    frames: u64,
}

impl Course {
    /// A copy of `start` after the warm-up. All copies are sorted in the same frame.
    pub fn new(start: &Simulation, undone: Option<Undone>) -> Result<Self, LabError> {
        let mut simulation = start.clone();
        match &undone {
            Some(Undone::Needs(more)) => simulation.pay_for(more),
            _ => simulation.pay_for(start.needs()),
        }
        Ok(Self {
            simulation: warmed(&simulation)?,
            undone,
            seconds: 0.0,
            frames: 0,
        })
    }

    /// Simulates `frames` frames.
    pub fn advance(&mut self, frames: u64) -> Result<(), LabError> {
        self.frames += frames;
        rayon::scope(|_| {
            for _ in 0..frames {
                self.simulation.evaluate().map_err(failed)?;
                if let Some(Undone::Work(work, _)) = &mut self.undone {
                    self.seconds += work(&self.simulation);
                }
                self.simulation.integrate().map_err(failed)?;
            }
            Ok(())
        })
    }

    /// The time of the simulation itself.
    pub fn times(&self) -> &StageTimes {
        self.simulation.stages()
    }

    /// Milliseconds per frame with the skip undone. If the work is separate, its time replaces that of some stages in
    /// `base`, the times with all skips.
    pub fn ms_per_frame(&self, base: &StageTimes) -> f64 {
        match &self.undone {
            Some(Undone::Work(_, instead_of)) => {
                let saved: f64 = instead_of.iter().map(|&stage| ms_of(base, stage)).sum();
                let work = 1e3 * self.seconds / self.frames as f64;
                base.total_ms_per_frame() - saved + work
            }
            _ => self.times().total_ms_per_frame(),
        }
    }
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// RVO for all agents whose blend contains RVO but gives it no weight at the moment.
pub fn rvo_by_blend(simulation: &Simulation) -> Result<Work, &'static str> {
    let mut groups = simulation.scene().groups.iter();
    if groups.all(|group| group.blend.rvo().is_none() || !group.blend.depends_on_density()) {
        return Err("no blend has RVO at some densities only");
    }
    Ok(Box::new(|simulation| {
        let frame = simulation.frame();
        if !frame.clock.is_coarse() {
            return 0.0;
        }
        let choose = |scratch: &mut Scratch, i: usize| {
            let blend = simulation.blend(i);
            if let Some(rvo) = blend.rvo()
                && !blend.rvo_acts(&frame, i)
            {
                let wish = Preference {
                    preferred_velocity: frame.fields.preferred_velocity[i],
                    max_speed: simulation.scene().max_speed(frame.agents, i),
                };
                black_box(rvo.acceleration(&frame, i, wish, scratch));
            }
        };
        let agents = (0..frame.agents.len()).into_par_iter();
        seconds(|| agents.for_each_init(Scratch::default, choose))
    }))
}

/// Sorting and listing in every frame, or in every coarse frame.
pub fn lists(coarse: bool) -> Work {
    let (mut neighbors, mut packed) = (Neighbors::default(), Packed::default());
    Box::new(move |simulation| {
        let (frame, scene, needs) = (simulation.frame(), simulation.scene(), simulation.needs());
        if coarse && !frame.clock.is_coarse() {
            return 0.0;
        }
        let mut agents = frame.agents.clone();
        seconds(|| {
            let ranges = scene.ranges(needs, &agents);
            neighbors.sort(&mut agents, ranges);
            neighbors.list_walls(&agents, frame.walls);
            if needs.pairs.any() || needs.social || needs.walking || needs.density {
                neighbors.list_agents();
                packed.take_bodies(&agents, neighbors.extent(), neighbors.way(), |i| {
                    let group = &scene.groups[usize::from(agents.group[i])];
                    group.blend.reach()
                });
            }
        })
    })
}

/// The time of a search for walls agent by agent, minus that of a search by blocks, in frames that sort the crowd.
pub fn walls_one_by_one(simulation: &Simulation) -> Result<Work, &'static str> {
    if simulation.scene().walls.is_empty() {
        return Err("there are no walls");
    }
    let (mut near, mut far) = (Lists::default(), Lists::default());
    Ok(Box::new(move |simulation| {
        let frame = simulation.frame();
        let (agents, walls) = (frame.agents, frame.walls);
        if frame.neighbors.sorted_at() != agents.position {
            return 0.0;
        }
        let ranges = simulation.scene().ranges(simulation.needs(), agents);
        let least = ranges.support.max(ranges.longest_step);
        let mut neighbors = frame.neighbors.clone();
        let by_blocks = seconds(|| neighbors.list_walls(agents, walls));
        let list = |lists: &mut Lists, reach: &(dyn Fn(usize) -> f64 + Sync)| {
            let all = |_| vec![0]; // no search by blocks
            lists.rebuild(agents.len(), all, |i, _, found| {
                walls.near(agents.position[i], reach(i) + ranges.drift, found);
            });
        };
        let one_by_one = seconds(|| {
            list(&mut near, &|i| least.max(agents.radius[i]));
            if let Some(radius) = ranges.avoidance {
                list(&mut far, &|_| radius);
            }
        });
        one_by_one - by_blocks
    }))
}

/// The headway law for all agents, in coarse frames.
pub fn walking_law(simulation: &Simulation) -> Result<Work, &'static str> {
    let needs = simulation.needs();
    if needs.walking {
        return Err("the scene needs it");
    }
    if !(needs.pairs.any() || needs.social || needs.density) {
        return Err("the scene has no packed agents");
    }
    let law = WalkingLaw::Headway(Headway::default());
    let mut allowed = Vec::new();
    Ok(Box::new(move |simulation| {
        let mut frame = simulation.frame();
        if !frame.clock.is_coarse() {
            return 0.0;
        }
        let mut packed = frame.packed.clone();
        packed.take_headings(&frame.fields.preferred_velocity);
        frame.packed = &packed;
        allowed.resize(frame.agents.len(), None);
        let blocks = allowed.par_chunks_mut(BLOCK).with_min_len(TASK);
        let due = Deciders {
            is_due: [true; BLOCK],
            gap: [1.0; BLOCK],
            meets: false,
        };
        let decide = |(b, allowed): (usize, &mut [Option<f64>])| {
            let heading = &mut [];
            law.decide(&frame, b, &due, Decided { allowed, heading });
        };
        seconds(|| blocks.enumerate().for_each(decide))
    }))
}

/// The measurement of integrity.
pub fn integrity() -> Work {
    let (keys, mut seen) = (Integrity {}, Watched::default());
    Box::new(move |simulation| seconds(|| keys.observe(&mut seen, &Evaluated::new(simulation))))
}

/// The most goals with a path map.
const MOST_GOALS: usize = 100;
/// The floor reaches this far beyond agents and goals, meters.
const AROUND: f64 = 5.0;

/// Looking up routes on an open floor.
pub fn routes(simulation: &Simulation) -> Result<Work, &'static str> {
    let (agents, scene) = (simulation.frame().agents, simulation.scene());
    if scene.routes.is_some() {
        return Err("walls stand between agents and goals");
    }
    let mut goals: Vec<Vector> = Vec::new();
    for goal in &agents.goal {
        if goals.len() < MOST_GOALS && !goals.contains(goal) {
            goals.push(*goal);
        }
    }
    let routes = open_floor(&agents.position, goals).ok_or("there is no floor")?;
    let seed = scene.seed;
    let mut held: Vec<(Option<Route>, Vector)> = Vec::new();
    Ok(Box::new(move |simulation| {
        let frame = simulation.frame();
        let mut agents = frame.agents.clone();
        held.resize(agents.entered() as usize, (None, Vector::zeros()));
        (agents.route, agents.aim) = agents.id.iter().map(|&id| held[id as usize]).unzip();
        agents.lacks_routes = agents.route.contains(&None);
        let spent = seconds(|| agents.follow(&routes, frame.clock.is_coarse(), seed));
        let routes = agents.route.into_iter().zip(agents.aim);
        for (&id, route) in agents.id.iter().zip(routes) {
            held[id as usize] = route;
        }
        spent
    }))
}

/// Path maps to goals on a rectangle without walls inside.
fn open_floor(positions: &[Vector], goals: Vec<Vector>) -> Option<Routes> {
    let [low, high] = bounds(positions.iter().chain(&goals).copied())?;
    let (low, high) = (low.add_scalar(-AROUND), high.add_scalar(AROUND));
    let corners = vec![
        low,
        Vector::new(high.x, low.y),
        high,
        Vector::new(low.x, high.y),
    ];
    let area = Area {
        exterior: Ring::new(corners).ok()?,
        holes: Vec::new(),
    };
    Routes::new(Floor::new(&[area], 0.0).ok()?, &[], goals).ok()
}
