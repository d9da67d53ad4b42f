//! A crowd that should come to rest or, with a walking law, walk steadily, and a check whether it does.

use std::fmt;

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::condition::Condition;
use engine::agents::{Agents, NewAgent};
use engine::clock::Clock;
use engine::forces::rates::Rates;
use engine::geometry::Polygon;
use engine::math::Vector;
use engine::period::{Axis, Period};
use engine::placement::Grid;
use engine::profile::Blend;
use engine::scene::{Group, Scene};
use engine::simulation::{Fault, Simulation};
use scenario::catalog::{NavigationKind, Parameters, WalkingLawKind};
use scenario::measurements::{Watched, closest};

/// Agents along each side of the room.
const COLUMNS: u32 = 10;
/// Density of a full room relative to ρ⁰max: more than 1, so that all agents are under pressure.
const FILLING: f64 = 1.1;
/// Density of a loose room, P/m²: with fewer neighbors, each of them has more effect on viscosity.
const LOOSE: f64 = 2.0;
/// Jitter of the start positions, relative to the distance between them.
const JITTER: f64 = 0.1;
/// Speed of every agent at the start, m/s.
const KICK: f64 = 0.7;
/// Time in which a crowd must come to rest, seconds: the goal force alone slows by e⁻¹ in τ = 0.5 s.
const DURATION: f64 = 8.0;
/// The last part of it, in which the crowd is tested, seconds.
const JUDGED: f64 = 3.0;
/// Distances between agents are checked every this many frames.
const CLOSEST_EVERY: u64 = 5;
/// Preferred speed of crowds with a walking law, m/s.
const PACE: f64 = 1.34;
/// Number of crowds, each with another seed.
const SEEDS: u64 = 3;
/// Crowds below this speed are at rest, m/s; walking crowds if their velocities differ by less from their mean.
const RESTING: f64 = 0.1;
/// The smallest allowed distance between the centers of two agents, relative to the sum of their radii.
const CLOSEST: f64 = 0.1;

/// Square rooms of agents whose goals are their own positions, each moving in another direction at the start; with a
/// walking law, endless corridors of this length and width, through which all agents walk in the same direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Rest {
    /// k, m²/s².
    pub gas_constant: f64,
    /// ρ⁰max, P/m²; the density of the full room is a tenth higher.
    pub rest_density_max: f64,
    /// K^ag, 1/s².
    pub agent_stiffness: f64,
    /// μ, 1/s.
    pub viscosity: f64,
    /// The walking law.
    #[serde(flatten)]
    pub law: Law,
}

/// A walking law, with the parameter on which its stability depends most.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Law {
    /// Its kind; `None` without law.
    pub walking_law: Option<WalkingLawKind>,
    /// T, seconds.
    pub headway_time: Option<f64>,
    /// t, seconds.
    pub headway_anticipation: Option<f64>,
    /// γ, P/m².
    pub slowing_density: Option<f64>,
    /// γ₀, m²/s.
    pub drag_per_density: Option<f64>,
}

impl fmt::Display for Law {
    /// Its name with the parameters that are given; nothing without law.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Some(kind) = self.walking_law else {
            return Ok(());
        };
        f.write_str(json!(kind).as_str().unwrap_or_default())?;
        for (symbol, value) in [
            ("T", self.headway_time),
            ("t", self.headway_anticipation),
            ("γ", self.slowing_density),
            ("γ₀", self.drag_per_density),
        ] {
            value.map_or(Ok(()), |value| write!(f, " {symbol}={value}"))?;
        }
        Ok(())
    }
}

impl Default for Rest {
    /// The paper's `sph` (§5.5).
    fn default() -> Self {
        Self {
            gas_constant: 200.0,
            rest_density_max: 5.0,
            agent_stiffness: 50.0,
            viscosity: 0.0,
            law: Law::default(),
        }
    }
}

/// The results of some crowds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Remains {
    /// Root mean square speed in the last seconds, relative to the mean velocity of crowds that walk, m/s; `None` if a
    /// run failed.
    pub speed: Option<f64>,
    /// The correlation of the velocities from one frame to the next in those seconds, Σ v(t)·v(t − Δt) / Σ v²: 1 if all
    /// velocities are constant, −1 if all of them reverse in every frame.
    pub persistence: f64,
    /// The smallest distance between two centers, relative to the sum of their radii.
    pub closest: f64,
    /// Number of agents that passed through a wall.
    pub escaped: usize,
}

impl Remains {
    /// Whether the time step is stable: agents must stay apart and inside the room, and the crowds must come to rest,
    /// or at least not move because of the step. If a step is too long, velocities reverse in every frame; oscillations
    /// of the model itself take several frames.
    pub fn are_stable(&self) -> bool {
        let moves_on = self.persistence > 0.0;
        let rests = self.speed.is_some_and(|speed| speed <= RESTING || moves_on);
        rests && self.closest >= CLOSEST && self.escaped == 0
    }
}

/// Observations of some crowds: sums over agents and frames of the last seconds, and all failures.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    /// Whether the crowds walk.
    walk: bool,
    agents: f64,
    /// Sum of |v|², m²/s².
    squares: f64,
    /// Sum of v(t) · v(t − Δt), m²/s².
    lasting: f64,
    closest: f64,
    escaped: usize,
    failed: bool,
}

impl Seen {
    /// Adds a frame of the last seconds. `before` are the previous frame's velocities by id; they are replaced.
    fn add(&mut self, agents: &Agents, before: &mut [Vector]) {
        let mut mean = Vector::zeros();
        if self.walk {
            mean = agents.velocity.iter().sum::<Vector>() / agents.len() as f64;
        }
        for (&id, velocity) in agents.id.iter().zip(&agents.velocity) {
            let velocity = velocity - mean;
            let last = std::mem::replace(&mut before[id as usize], velocity);
            self.agents += 1.0;
            self.squares += velocity.norm_squared();
            self.lasting += velocity.dot(&last);
        }
    }

    /// Runs a crowd to its end, or until it fails.
    fn run(&mut self, simulation: &mut Simulation) -> Result<(), Fault> {
        let clock = *simulation.frame().clock;
        let judged = clock.frame_at(DURATION - JUDGED);
        let last = clock.frame_at(DURATION).max(1);
        let mut before = vec![Vector::zeros(); simulation.frame().agents.len()];
        let mut watched = Watched::default();
        for frame in 1..=last {
            simulation.evaluate()?;
            watched.observe(simulation);
            if (frame - 1).is_multiple_of(CLOSEST_EVERY) {
                self.closest = self.closest.min(closest(simulation));
            }
            if simulation.integrate().is_err() {
                self.failed = true;
                break;
            }
            if frame == judged {
                let mut first = Self {
                    walk: self.walk,
                    ..Self::default()
                };
                first.add(simulation.frame().agents, &mut before);
            } else if frame > judged {
                self.add(simulation.frame().agents, &mut before);
            }
        }
        self.escaped += watched.agents_through_walls(simulation);
        Ok(())
    }
}

impl Rest {
    /// The densities of the full and the loose room, P/m²: a crowd passes through all densities between them.
    pub fn densities(&self) -> [f64; 2] {
        [FILLING * self.rest_density_max, LOOSE]
    }

    /// The parameters of the profile.
    ///
    /// # Panics
    /// One of the fields of this struct is no parameter.
    fn parameters(&self) -> Parameters {
        let fields = Parameters::deserialize(json!(self));
        fields.unwrap_or_else(|error| panic!("{self:?}: {error}"))
    }

    /// A room with its agents at `density` P/m², for a time step in seconds.
    pub fn scene(&self, density: f64, time_step: f64) -> Scene {
        let parameters = self.parameters();
        let walks = self.law.walking_law.is_some();
        let spacing = (1.0 / density).sqrt();
        let side = f64::from(COLUMNS) * spacing;
        let mut scene = Scene::with_obstacles(match walks {
            true => sides(side),
            false => walls(side),
        });
        scene.clock = Clock::new(time_step, Clock::nearest_coarse_every(time_step));
        scene.preferred_speed = if walks { PACE } else { 0.0 };
        scene.period = walks.then_some(Period {
            axis: Axis::X,
            from: 0.0,
            length: side,
        });
        let profile = parameters.profile("sph", NavigationKind::Goal, true);
        let group = scene.add_group(Group {
            counted: false,
            direction: walks.then(Vector::x),
            ..Group::new("crowd", Blend::single(profile, parameters.part()))
        });
        let grid = Grid {
            min: Vector::zeros(),
            max: Vector::new(side, side),
            columns: COLUMNS,
            rows: COLUMNS,
            jitter: JITTER * spacing,
        };
        let places = grid.positions(scene.seed, 0).zip(0_u32..);
        let thrown = places.map(|(place, id)| {
            // The golden angle: no two neighbors start in the same direction.
            let angle = 2.399_963 * f64::from(id);
            let kick = if walks { 0.0 } else { KICK };
            NewAgent {
                velocity: Vector::new(angle.cos(), angle.sin()) * kick,
                ..NewAgent::at(place, place, group)
            }
        });
        scene.agents = thrown.collect();
        scene
    }

    /// Runs rooms of one density at a time step in seconds under a condition, with the seeds after `first_seed`.
    ///
    /// # Errors
    /// An agent cannot be placed at the start.
    pub fn run(
        &self,
        density: f64,
        time_step: f64,
        (condition, first_seed): (Condition, u64),
    ) -> Result<Remains, Fault> {
        let mut seen = Seen {
            walk: self.law.walking_law.is_some(),
            closest: f64::INFINITY,
            ..Seen::default()
        };
        for seed in 1..=SEEDS {
            let mut scene = self.scene(density, time_step);
            scene.seed = first_seed + seed;
            scene.wall_method = condition.walls;
            scene.integrator = condition.scheme.integrator();
            seen.run(&mut Simulation::new(scene)?)?;
        }
        Ok(Remains {
            speed: (!seen.failed).then_some((seen.squares / seen.agents).sqrt()),
            persistence: seen.lasting / seen.squares,
            closest: seen.closest,
            escaped: seen.escaped,
        })
    }

    /// Runs the full and the loose room at a time step in seconds.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn rooms(&self, time_step: f64, under: (Condition, u64)) -> Result<[Remains; 2], Fault> {
        let run = |density| self.run(density, time_step, under);
        let [full, loose] = self.densities().map(run);
        Ok([full?, loose?])
    }

    /// Whether a time step, in seconds, is stable in both rooms.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn is_stable(&self, time_step: f64, under: (Condition, u64)) -> Result<bool, Fault> {
        for density in self.densities() {
            if !self.run(density, time_step, under)?.are_stable() {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The fastest mode of both rooms.
    pub fn mode(&self) -> Rates {
        Rates::of(&self.scene(LOOSE, 1.0))
    }
}

/// Two walls, 1 m thick, beside an endless corridor along x that repeats after its width, `side`.
fn sides(side: f64) -> Vec<Polygon> {
    let (left, right) = (-side - 10.0, 2.0 * side + 10.0);
    let wall = |low: f64, high: f64| {
        let corners = [[left, low], [right, low], [right, high], [left, high]];
        Polygon::new(corners.map(Vector::from).to_vec())
    };
    let both = [wall(-1.0, 0.0), wall(side, side + 1.0)];
    both.into_iter().flatten().collect()
}

/// Two L-shaped walls, 1 m thick, around [0, side]²: at no place do more than two edges push in the same direction.
pub fn walls(side: f64) -> Vec<Polygon> {
    let outer = side + 1.0;
    let lower = [
        [-1.0, -1.0],
        [outer, -1.0],
        [outer, 0.0],
        [0.0, 0.0],
        [0.0, outer],
        [-1.0, outer],
    ];
    let upper = [
        [outer, 0.0],
        [outer, outer],
        [0.0, outer],
        [0.0, side],
        [side, side],
        [side, 0.0],
    ];
    [lower, upper]
        .into_iter()
        .filter_map(|corners| Polygon::new(corners.map(Vector::from).to_vec()).ok())
        .collect()
}
