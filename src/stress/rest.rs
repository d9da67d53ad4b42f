//! A crowd that should come to rest, and whether it does.

use serde::{Deserialize, Serialize};

use super::watch::{Watch, mean_square_speed};
use crate::agents::NewAgent;
use crate::catalog::{NavigationKind, Parameters};
use crate::clock::Clock;
use crate::geometry::Polygon;
use crate::math::Vector;
use crate::placement::Grid;
use crate::profile::Blend;
use crate::scene::{Group, Scene};
use crate::simulation::{Fault, Simulation};
use crate::stability::Mode;

/// People along each side of the room.
const COLUMNS: u32 = 10;
/// People in a full room for each whom ρ⁰max asks for: everybody is pressed.
const FILLING: f64 = 1.1;
/// People in a loose room, P/m²: the fewer neighbours, the more each of them matters to viscosity.
const LOOSE: f64 = 2.0;
/// How far from their places people start, in distances between places.
const JITTER: f64 = 0.1;
/// How fast everybody is thrown about at the start, m/s.
const KICK: f64 = 0.7;
/// How long a crowd is given to come to rest, seconds: the goal force alone slows by e⁻¹ in τ = 0.5 s.
const DURATION: f64 = 8.0;
/// So many crowds of different people are looked at.
const SEEDS: u64 = 3;
/// The last part of it, in which the crowd is judged, seconds.
const JUDGED: f64 = 3.0;
/// A step shakes a crowd if it takes the crowd's speed by more than this part of the way from what it is at
/// the finest steps to the highest allowed, at which a crowd that is thrown about soon is.
const SHAKEN: f64 = 1.0 / 3.0;
/// Nobody's centre may be nearer to another's than this part of their radii's sum.
const CLOSEST: f64 = 0.1;

/// Square rooms of people who want to stay where they are, thrown about a little at the start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rest {
    /// k.
    pub gas_constant: f64,
    /// ρ⁰max, P/m²; the full room holds a tenth more.
    pub rest_density_max: f64,
    /// K^ag.
    pub agent_stiffness: f64,
    /// μ.
    pub viscosity: f64,
}

impl Default for Rest {
    /// The paper's `sph` (§5.5).
    fn default() -> Self {
        Self {
            gas_constant: 200.0,
            rest_density_max: 5.0,
            agent_stiffness: 50.0,
            viscosity: 0.0,
        }
    }
}

/// What became of a crowd.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Remains {
    /// Root mean square speed in the last seconds, m/s, of the most restless crowd; `None` if a run broke off.
    pub speed: Option<f64>,
    /// The least distance of two centres, in parts of their radii's sum.
    pub closest: f64,
    /// How many got through a wall.
    pub escaped: u64,
}

impl Remains {
    /// Both, with the higher of their squared speeds: some crowds boil by chance, at the finest steps too.
    fn and(self, other: Self) -> Self {
        Self {
            speed: self.speed.zip(other.speed).map(|(a, b)| a.max(b)),
            closest: self.closest.min(other.closest),
            escaped: self.escaped + other.escaped,
        }
    }

    /// Did the crowd come to rest, in one piece? `unrest` is the speed that it keeps at the finest steps.
    fn are_stable(&self, unrest: f64) -> bool {
        let most = unrest + SHAKEN * (Scene::default().max_speed - unrest);
        let rests = self.speed.is_some_and(|speed| speed <= most);
        rests && self.closest >= CLOSEST && self.escaped == 0
    }
}

impl Rest {
    /// A full room and a loose one, P/m²: a crowd passes through all densities between them.
    pub fn densities(&self) -> [f64; 2] {
        [FILLING * self.rest_density_max, LOOSE]
    }

    fn parameters(&self) -> Parameters {
        Parameters {
            gas_constant: Some(self.gas_constant),
            rest_density_max: Some(self.rest_density_max),
            agent_stiffness: Some(self.agent_stiffness),
            viscosity: Some(self.viscosity),
            ..Parameters::default()
        }
    }

    /// A room and its people, `density` P/m², at a time step in seconds.
    pub fn scene(&self, density: f64, time_step: f64) -> Scene {
        let parameters = self.parameters();
        let spacing = (1.0 / density).sqrt();
        let side = f64::from(COLUMNS) * spacing;
        let mut scene = Scene::with_obstacles(walls(side));
        scene.clock = Clock::new(time_step, Clock::nearest_coarse_every(time_step));
        scene.preferred_speed = 0.0;
        let profile = parameters.profile("sph", NavigationKind::Goal, true);
        let group = scene.add_group(Group {
            name: "crowd".to_owned(),
            blend: Blend::single(profile, parameters.sph()),
            removal_radius: None,
            counted: false,
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
            // The golden angle: no two neighbours are thrown the same way.
            let angle = 2.399_963 * f64::from(id);
            NewAgent {
                velocity: Vector::new(angle.cos(), angle.sin()) * KICK,
                ..NewAgent::at(place, place, group)
            }
        });
        scene.agents = thrown.collect();
        scene
    }

    /// Runs one room at a time step in seconds, with people after people.
    ///
    /// # Errors
    /// Somebody has no place at the start.
    pub fn run(&self, density: f64, time_step: f64) -> Result<Remains, Fault> {
        let mut all = Remains {
            speed: Some(0.0),
            closest: 1.0,
            escaped: 0,
        };
        for seed in 1..=SEEDS {
            let mut scene = self.scene(density, time_step);
            scene.seed = seed;
            all = all.and(Self::run_scene(scene)?);
        }
        all.speed = all.speed.map(f64::sqrt);
        Ok(all)
    }

    /// Runs one crowd; the speed is squared.
    fn run_scene(scene: Scene) -> Result<Remains, Fault> {
        let mut simulation = Simulation::new(scene)?;
        let mut watch = Watch::new(&simulation);
        let last = simulation.frame().clock.frame_at(DURATION).max(1);
        let judged = simulation.frame().clock.frame_at(DURATION - JUDGED);
        let (mut squares, mut frames, mut broken) = (0.0, 0.0, false);
        while simulation.frame().clock.frame() < last && !broken {
            simulation.evaluate()?;
            watch.look(&simulation);
            broken = simulation.integrate().is_err();
            if simulation.frame().clock.frame() > judged {
                squares += mean_square_speed(&simulation);
                frames += 1.0;
            }
        }
        let found = watch.found(&simulation);
        let speed: f64 = squares / frames;
        Ok(Remains {
            speed: (!broken).then_some(speed),
            closest: found.closest,
            escaped: found.passed,
        })
    }

    /// The speeds that the model keeps in both rooms at a step far below every limit, m/s.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn unrest(&self, time_step: f64) -> Result<[f64; 2], Fault> {
        let mut speeds = [0.0; 2];
        for (speed, density) in speeds.iter_mut().zip(self.densities()) {
            *speed = self.run(density, time_step)?.speed.unwrap_or(0.0);
        }
        Ok(speeds)
    }

    /// Is a time step in seconds stable in both rooms, whose own [`unrest`](Self::unrest) is known?
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn is_stable(&self, time_step: f64, unrest: [f64; 2]) -> Result<bool, Fault> {
        for (density, unrest) in self.densities().into_iter().zip(unrest) {
            if !self.run(density, time_step)?.are_stable(unrest) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The fastest mode of both rooms.
    pub fn mode(&self) -> Mode {
        Mode::of(&self.scene(LOOSE, 1.0))
    }
}

/// Two angles of wall, 1 m thick, round [0, side]²: nowhere more than two edges push the same way.
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
