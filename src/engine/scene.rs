//! A scene: everything that is fixed before the first frame.

use crate::engine::agents::NewAgent;
use crate::engine::boundary::WallMethod;
use crate::engine::clock::Clock;
use crate::engine::forces::social::SocialForce;
use crate::engine::geometry::{Polygon, Walls};
use crate::engine::math::Vector;
use crate::engine::neighbors::{ListPolicy, Ranges, SKIN};
use crate::engine::pairs::{Precision, Wanted};
use crate::engine::placement::Grid;
use crate::engine::profile::{Blend, Override};

/// How the state is moved on by one frame (§5).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// v ← clamp(v + a Δt), then r ← r + v Δt with the new v.
    #[default]
    SemiImplicit,
    /// r moves with the old v.
    ForwardEuler,
    /// r ← r + v Δt + a Δt²/2, and v by the mean of the accelerations at both ends. Forces that depend on
    /// the velocity see a predicted one, v + a Δt: the velocity of a frame, off by some Δt².
    VelocityVerlet,
    /// The second-order Runge-Kutta method that evaluates all forces but RVO a second time, half a frame
    /// on, and takes the whole step with what it finds there.
    Midpoint,
}

impl Integrator {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::SemiImplicit,
        Self::ForwardEuler,
        Self::VelocityVerlet,
        Self::Midpoint,
    ];
}

/// Agents that share their behavior and their fate.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// What it is called in reports.
    pub name: String,
    /// How its agents behave.
    pub blend: Blend,
    /// Within this distance of the goal an agent leaves, meters; `None`: never.
    pub removal_radius: Option<f64>,
    /// Do its arrivals count as evacuated?
    pub counted: bool,
}

/// Where the agents of a grid or source go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// All to one point, meters.
    Point(Vector),
    /// Each to its own start plus this, meters.
    Offset(Vector),
}

/// Agents that enter on a grid, once or again and again.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// What it is called in reports.
    pub name: String,
    /// Where.
    pub grid: Grid,
    /// Their group.
    pub group: u16,
    /// Where they go.
    pub goal: Goal,
    /// First entry, seconds.
    pub start: f64,
    /// Time between entries, seconds, above 0.
    pub every: f64,
    /// How many entries; `None`: without end.
    pub times: Option<u32>,
}

/// For a while, everybody who is in a rectangle at one moment behaves differently. Whoever two pushes
/// get hold of follows the later one.
#[derive(Debug, Clone, PartialEq)]
pub struct Push {
    /// What it is called in reports.
    pub name: String,
    /// When, seconds.
    pub at: f64,
    /// For how long, seconds.
    pub lasting: f64,
    /// Lower left and upper right corner, meters; who stands here at the start takes part.
    pub region: Region,
    /// What changes for them.
    pub change: Override,
}

/// An axis-parallel rectangle, borders included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// Lower left corner, meters.
    pub min: Vector,
    /// Upper right corner, meters.
    pub max: Vector,
}

impl Region {
    /// Does `p` lie in the rectangle?
    pub fn contains(&self, p: Vector) -> bool {
        (self.min.x..=self.max.x).contains(&p.x) && (self.min.y..=self.max.y).contains(&p.y)
    }
}

/// Everything that [`Simulation`](crate::engine::simulation::Simulation) needs to begin.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Seed of who enters: bodies, and jitter of where they stand.
    pub seed: u64,
    /// Seed of what they do, RVO's candidates; `None`: the same.
    pub behaviour_seed: Option<u64>,
    /// Δt_fine and Δt_coarse.
    pub clock: Clock,
    /// How the state is moved on.
    pub integrator: Integrator,
    /// How walls enter SPH.
    pub wall_method: WallMethod,
    /// The numbers for sums over pairs.
    pub precision: Precision,
    /// When neighbors are listed anew.
    pub neighbor_lists: ListPolicy,
    /// s_pref, m/s (§5.6).
    pub preferred_speed: f64,
    /// s_max, m/s (§5.6).
    pub max_speed: f64,
    /// The obstacles and their walls.
    pub walls: Walls,
    /// Groups by index.
    pub groups: Vec<Group>,
    /// Who is there at the start, in the order of their ids.
    pub agents: Vec<NewAgent>,
    /// Who enters later.
    pub sources: Vec<Source>,
    /// What happens later.
    pub pushes: Vec<Push>,
}

impl Default for Scene {
    /// An empty plane with the paper's settings (§5.6).
    fn default() -> Self {
        Self {
            seed: 1,
            behaviour_seed: None,
            clock: Clock::default(),
            integrator: Integrator::default(),
            wall_method: WallMethod::default(),
            precision: Precision::default(),
            neighbor_lists: ListPolicy::default(),
            preferred_speed: 1.4,
            max_speed: 1.8,
            walls: Walls::new(Vec::new()),
            groups: Vec::new(),
            agents: Vec::new(),
            sources: Vec::new(),
            pushes: Vec::new(),
        }
    }
}

impl Scene {
    /// The paper's settings round some obstacles.
    pub fn with_obstacles(obstacles: Vec<Polygon>) -> Self {
        Self {
            walls: Walls::new(obstacles),
            ..Self::default()
        }
    }

    /// Adds a group and returns its index.
    pub fn add_group(&mut self, group: Group) -> u16 {
        self.groups.push(group);
        (self.groups.len() - 1) as u16
    }

    /// What this scene needs, and so what it pays for.
    pub fn needs(&self) -> Needs {
        let profiles = || {
            self.groups
                .iter()
                .flat_map(|group| group.blend.steps())
                .map(|step| &step.profile)
        };
        let pairs = Wanted {
            pressure: profiles().any(|profile| profile.pressure),
            viscosity: profiles().any(|profile| profile.viscosity.is_some()),
            contact: profiles().any(|profile| profile.contact.agent_stiffness.is_some()),
        };
        let blending = self
            .groups
            .iter()
            .any(|group| group.blend.depends_on_density());
        Needs {
            density: pairs.pressure || pairs.viscosity || blending,
            pairs,
            rvo: self.groups.iter().any(|group| group.blend.rvo().is_some()),
            social: !self.social_forces().is_empty(),
            avoidance: profiles()
                .filter_map(|profile| profile.navigation.avoidance_radius())
                .reduce(f64::max),
            removal: self
                .groups
                .iter()
                .any(|group| group.removal_radius.is_some()),
        }
    }

    /// The different social forces of all profiles.
    pub fn social_forces(&self) -> Vec<SocialForce> {
        let steps = self.groups.iter().flat_map(|group| group.blend.steps());
        let mut different = Vec::new();
        for social in steps.filter_map(|step| step.profile.navigation.social()) {
            if !different.contains(&social) {
                different.push(social);
            }
        }
        different
    }

    /// How far neighbors must be looked for.
    pub fn ranges(&self, needs: &Needs) -> Ranges {
        let support = self
            .groups
            .iter()
            .map(|group| group.blend.sph.support_radius)
            .fold(0.0, f64::max);
        let longest_step = self.max_speed * self.clock.time_step();
        let ahead = match self.integrator {
            Integrator::Midpoint => 0.5 * longest_step, // forces are evaluated there, too
            _ => 0.0,
        };
        let (drift, margin) = match self.neighbor_lists {
            ListPolicy::Complete => (0.5 * SKIN + ahead, 0.5 * SKIN + ahead),
            ListPolicy::Coarse => {
                let frames = f64::from(self.clock.coarse_every());
                (frames * longest_step + ahead, 0.0)
            }
        };
        Ranges {
            support,
            avoidance: needs.avoidance,
            social: needs.social.then(|| {
                self.social_forces()
                    .iter()
                    .map(|social| social.avoidance_radius)
                    .fold(0.0, f64::max)
            }),
            longest_step,
            drift,
            margin,
        }
    }
}

/// What the profiles of a scene ask for, decided once; the rest is never computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Needs {
    /// SPH forces or blending read the density in every frame.
    pub density: bool,
    /// Sums over near neighbors that some profile reads.
    pub pairs: Wanted,
    /// Some profile avoids by RVO.
    pub rvo: bool,
    /// Some profile avoids by social forces.
    pub social: bool,
    /// The widest avoidance radius, meters.
    pub avoidance: Option<f64>,
    /// Some agents leave at their goal.
    pub removal: bool,
}

impl Needs {
    /// What either asks for.
    pub fn with(&self, other: &Self) -> Self {
        let radii = self.avoidance.into_iter().chain(other.avoidance);
        Self {
            density: self.density || other.density,
            pairs: self.pairs.with(other.pairs),
            rvo: self.rvo || other.rvo,
            social: self.social || other.social,
            avoidance: radii.reduce(f64::max),
            removal: self.removal || other.removal,
        }
    }
}
