//! A scene: the complete input of a simulation.

mod intervention;
mod needs;
mod region;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::agents::{Agents, NewAgent};
pub use crate::boundary::WallMethod;
use crate::clock::Clock;
pub use crate::clock::Integrator;
use crate::entrance::{Entrance, ScheduledAgent};
use crate::forces::model::OwnModel;
use crate::forces::own::Force;
use crate::forces::social::SocialForce;
use crate::forces::walking::WalkingLaw;
use crate::geometry::{Polygon, Walls};
use crate::journeys::Journeys;
use crate::levels::Levels;
use crate::math::Vector;
pub use crate::neighbors::ListPolicy;
use crate::neighbors::{FOLLOWED, MANY, Ranges, SKIN, WIDEST, WIDEST_SOCIAL};
pub use crate::pairs::Precision;
use crate::period::Period;
use crate::placement::Grid;
use crate::profile::{Blend, Override, Profile};
use crate::routes::{Rooms, Routes};
use crate::traits::Traits;

pub use intervention::{Action, Intervention};
pub use needs::Needs;
pub use region::Region;

/// How agents choose between routes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Routing {
    /// By what they choose.
    pub choice: RouteChoice,
    /// What they know.
    pub knowledge: Knowledge,
}

/// By what agents choose between routes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RouteChoice {
    /// The length.
    #[default]
    Shortest,
    /// The expected time.
    Quickest,
}

/// What agents know about waiting times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Knowledge {
    /// Those of the whole floor.
    #[default]
    Floor,
    /// Those before the openings of the room where they are.
    Sight,
}

/// Agents that share a blend and the rules for leaving.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Name in reports.
    pub name: String,
    /// The profiles of its agents.
    pub blend: Blend,
    /// Agents leave within this distance of their goal, meters; `None`: they never leave.
    pub removal_radius: Option<f64>,
    /// Whether arrivals count as evacuated.
    pub counted: bool,
    /// The number of the journey of its agents; `None`: each walks to its own goal.
    pub journey: Option<u16>,
    /// The direction in which its agents walk, of length 1, instead of to their goals.
    pub direction: Option<Vector>,
    /// How much its agents hurry, from 0 (calm) to 1 (told to hurry): read by the choice of headings.
    pub motivation: f64,
    /// The properties that are drawn for each of its agents.
    pub traits: Traits,
}

impl Group {
    /// Agents that never leave, without a journey.
    pub fn new(name: &str, blend: Blend) -> Self {
        Self {
            name: name.to_owned(),
            blend,
            removal_radius: None,
            counted: true,
            journey: None,
            direction: None,
            motivation: 0.0,
            traits: Traits::default(),
        }
    }
}

/// Goals of the agents of a grid or source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// One point for all agents, meters.
    Point(Vector),
    /// The initial position of each agent plus this offset, meters.
    Offset(Vector),
}

/// Agents that enter on a grid, once or repeatedly.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// Name in reports.
    pub name: String,
    /// Where agents enter.
    pub grid: Grid,
    /// Index of their group.
    pub group: u16,
    /// Their goals.
    pub goal: Goal,
    /// Time of the first entry, seconds.
    pub start: f64,
    /// Time between entries, seconds, above 0.
    pub every: f64,
    /// Number of entries; `None`: unlimited.
    pub times: Option<u32>,
}

/// A temporary change of behavior of all agents that are in a rectangle when the push begins. An agent that takes
/// part in two pushes follows the later one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Push {
    /// Name in reports.
    pub name: String,
    /// When it begins, seconds.
    pub at: f64,
    /// Duration, seconds.
    pub lasting: f64,
    /// Agents that are here when the push begins take part.
    pub region: Region,
    /// The changes for these agents.
    pub change: Override,
}

/// The lowest s_max of agents with a preferred speed of their own, m/s: agents that walk slowly or stand can also be
/// pushed.
pub const SLOWEST_MAX_SPEED: f64 = 0.5;

/// Everything that a [`Simulation`](crate::simulation::Simulation) is built from.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Seed of radii and of jitter of initial positions.
    pub seed: u64,
    /// Seed of RVO candidates; `None`: `seed`.
    pub behavior_seed: Option<u64>,
    /// Δt_fine and Δt_coarse.
    pub clock: Clock,
    /// How the state is advanced.
    pub integrator: Integrator,
    /// How walls enter SPH.
    pub wall_method: WallMethod,
    /// Precision of sums over pairs.
    pub precision: Precision,
    /// When neighbor lists are rebuilt.
    pub neighbor_lists: ListPolicy,
    /// s_pref, m/s (§5.6).
    pub preferred_speed: f64,
    /// s_max, m/s (§5.6).
    pub max_speed: f64,
    /// s_max of agents with a preferred speed of their own, divided by that speed; `None`: they have the scene's s_max.
    pub max_speed_ratio: Option<f64>,
    /// The obstacles and their walls; in a periodic scene those of the neighboring periods, too.
    pub walls: Walls,
    /// The outlines of the floors behind exits and entrances, where nobody counts, meters.
    pub behind: Vec<Vec<Vector>>,
    /// The period of a periodic scene: at least twice as long as any agent reaches (`Ranges::interaction`).
    pub period: Option<Period>,
    /// The levels of a building, side by side; not in a periodic scene.
    pub levels: Option<Arc<Levels>>,
    /// Groups by index.
    pub groups: Vec<Group>,
    /// Initial agents, in the order of their ids.
    pub agents: Vec<NewAgent>,
    /// Agents that enter later.
    pub sources: Vec<Source>,
    /// Lines through which agents come in later.
    pub entrances: Vec<Entrance>,
    /// Agents that come in later at places of their own, in the order of their times.
    pub scheduled: Vec<ScheduledAgent>,
    /// Temporary changes of behavior.
    pub pushes: Vec<Push>,
    /// Changes at the beginning of given frames, in the order of these frames.
    pub interventions: Vec<Intervention>,
    /// Places, journeys and zones.
    pub journeys: Journeys,
    /// Routes around walls; `None`: agents walk straight toward their goals, as in the paper.
    pub routes: Option<Arc<Routes>>,
    /// Routes for a scene without, from the first intervention on that needs them.
    pub later_routes: Option<Arc<Routes>>,
    /// How agents choose between routes.
    pub routing: Routing,
    /// Forces from outside this crate.
    pub own_forces: Vec<Arc<dyn Force>>,
    /// A model of the whole crowd from outside this crate.
    pub model: Option<OwnModel>,
}

impl Default for Scene {
    /// An empty plane with the paper's settings (§5.6).
    fn default() -> Self {
        Self {
            seed: 1,
            behavior_seed: None,
            clock: Clock::default(),
            integrator: Integrator::default(),
            wall_method: WallMethod::default(),
            precision: Precision::default(),
            neighbor_lists: ListPolicy::default(),
            preferred_speed: 1.4,
            max_speed: 1.8,
            max_speed_ratio: Some(1.8 / 1.4),
            walls: Walls::new(Vec::new()),
            behind: Vec::new(),
            period: None,
            levels: None,
            groups: Vec::new(),
            agents: Vec::new(),
            sources: Vec::new(),
            entrances: Vec::new(),
            scheduled: Vec::new(),
            pushes: Vec::new(),
            interventions: Vec::new(),
            journeys: Journeys::default(),
            routes: None,
            later_routes: None,
            routing: Routing::default(),
            own_forces: Vec::new(),
            model: None,
        }
    }
}

impl Scene {
    /// Obstacles with the paper's settings.
    pub fn with_obstacles(obstacles: Vec<Polygon>) -> Self {
        Self {
            walls: Walls::new(obstacles),
            ..Self::default()
        }
    }

    /// The rooms of the floor, if agents choose the quickest routes or some doors restrict them.
    pub fn rooms(&self) -> Option<&Rooms> {
        self.routes.as_ref()?.rooms()
    }

    /// Whether agents choose the quickest routes.
    pub fn by_time(&self) -> bool {
        self.routing.choice == RouteChoice::Quickest
    }

    /// Adds a model of the whole crowd, in place of another one.
    pub fn set_model(&mut self, own: OwnModel) {
        let others = self.model.take();
        let name = others.map(|other| other.model.name().to_owned());
        self.own_forces
            .retain(|force| Some(force.name()) != name.as_deref());
        self.own_forces.extend(own.force());
        self.model = Some(own);
    }

    /// Whether the accelerations of a model take the place of those of the profiles.
    pub fn is_replaced(&self) -> bool {
        self.model.as_ref().is_some_and(OwnModel::replaces)
    }

    /// Adds a group and returns its index.
    pub fn add_group(&mut self, group: Group) -> u16 {
        self.groups.push(group);
        (self.groups.len() - 1) as u16
    }

    /// The profiles of all groups.
    pub fn profiles(&self) -> impl Iterator<Item = &Profile> {
        let steps = self.groups.iter().flat_map(|group| group.blend.steps());
        steps.map(|step| &step.profile)
    }

    /// The forces of all profiles in addition to those of the paper, and those on all agents.
    pub fn all_forces(&self) -> impl Iterator<Item = &dyn Force> {
        let of_profiles = self.profiles().flat_map(|profile| &profile.forces);
        of_profiles.chain(&self.own_forces).map(AsRef::as_ref)
    }

    /// Of these forces, one of each name that keeps a state for agents: in the order of [`Agents::states`].
    pub fn keeping_forces(&self) -> Vec<&dyn Force> {
        let mut keeping: Vec<&dyn Force> = Vec::new();
        for force in self.all_forces().filter(|force| !force.kept().is_empty()) {
            if keeping.iter().all(|known| known.name() != force.name()) {
                keeping.push(force);
            }
        }
        keeping
    }

    /// The speed at which agent `i` wants to walk at `time` seconds, m/s.
    pub fn pace(&self, agents: &Agents, i: usize, time: f64) -> f64 {
        if agents.walks_from.get(i).is_some_and(|&from| time < from) {
            return 0.0;
        }
        let own = agents.preferred_speed.get(i);
        let factor = agents.zone.get(i).copied().flatten();
        own.copied().unwrap_or(self.preferred_speed) * factor.unwrap_or(1.0)
    }

    /// s_pref and s_max of an agent with this preferred speed of its own, m/s.
    pub fn own_speeds(&self, preferred: f64) -> [f64; 2] {
        let ratio = self.max_speed_ratio;
        let most = ratio.map_or(self.max_speed, |ratio| {
            (preferred * ratio).max(SLOWEST_MAX_SPEED)
        });
        [preferred, most]
    }

    /// s_max of agent `i`, m/s.
    pub fn max_speed(&self, agents: &Agents, i: usize) -> f64 {
        agents.max_speed.get(i).copied().unwrap_or(self.max_speed)
    }

    /// The largest s_max of all agents, m/s.
    pub fn highest_speed(&self, agents: &Agents) -> f64 {
        let own = agents.max_speed.iter().copied().reduce(f64::max);
        own.unwrap_or(self.max_speed)
    }

    /// The distinct social forces of all profiles.
    pub fn social_forces(&self) -> Vec<SocialForce> {
        different((self.profiles()).filter_map(|profile| profile.navigation.social()))
    }

    /// The distinct walking laws of all profiles.
    pub fn walking_laws(&self) -> Vec<WalkingLaw> {
        different(self.profiles().filter_map(|profile| profile.walking))
    }

    /// How much agent `i` hurries at `time` seconds, from 0 to 1.
    pub fn motivation(&self, agents: &Agents, i: usize, time: f64) -> f64 {
        let here = self.journeys.motivation(agents.position[i], time);
        self.groups[usize::from(agents.group[i])]
            .motivation
            .max(here)
    }

    /// The way that an agent walked from one place to another, meters: across the end of the period, or over joins of
    /// levels.
    pub fn walked(&self, from: Vector, to: Vector) -> Vector {
        match (&self.period, &self.levels) {
            (Some(period), _) => period.shortest(to - from),
            (None, Some(levels)) => levels.in_building(to) - levels.in_building(from),
            (None, None) => to - from,
        }
    }

    /// The largest preferred speed of all agents in any zone, m/s.
    pub fn highest_pace(&self, agents: &Agents) -> f64 {
        let own = agents.preferred_speed.iter().copied();
        let factors = self.journeys.zones.iter().map(|zone| zone.speed_factor);
        own.fold(self.preferred_speed, f64::max) * factors.fold(1.0, f64::max)
    }

    /// The ranges of the neighbor search for these agents.
    #[doc(hidden)]
    pub fn ranges(&self, needs: &Needs, agents: &Agents) -> Ranges {
        let radii = self
            .groups
            .iter()
            .map(|group| group.blend.sph.support_radius);
        let support = radii.fold(needs.reach, f64::max);
        let longest_step = self.highest_speed(agents) * self.clock.time_step();
        let ahead = match self.integrator {
            Integrator::Midpoint => 0.5 * longest_step, // forces are also evaluated half a step ahead
            _ => 0.0,
        };
        let follow = self.neighbor_lists == ListPolicy::Complete
            && agents.len() >= MANY
            && self.period.is_none()
            && self.levels.is_none();
        let (drift, margin) = match self.neighbor_lists {
            ListPolicy::Complete if follow => (FOLLOWED + ahead, 0.5 * SKIN + ahead),
            // On levels agents are sorted in every frame.
            ListPolicy::Complete if self.levels.is_some() => (ahead, ahead),
            ListPolicy::Complete => (0.5 * SKIN + ahead, 0.5 * SKIN + ahead),
            ListPolicy::Coarse => {
                let frames = f64::from(self.clock.coarse_every());
                (frames * longest_step + ahead, 0.0)
            }
        };
        Ranges {
            support,
            avoidance: needs.avoidance,
            sight: self.sight(agents),
            wide: (needs.social || needs.walking).then(|| {
                let social = self.social_forces().into_iter();
                let pace = self.highest_pace(agents);
                let laws = self.walking_laws().into_iter();
                let laws = laws.map(|law| law.reach(pace, support));
                let radii = social.map(|social| social.avoidance_radius).chain(laws);
                radii.fold(0.0, f64::max)
            }),
            widest_cluster: if needs.social { WIDEST_SOCIAL } else { WIDEST },
            longest_step,
            drift,
            margin,
            follow,
            period: self.period,
        }
    }
}

fn different<T: PartialEq>(all: impl Iterator<Item = T>) -> Vec<T> {
    let mut different = Vec::new();
    for one in all {
        if !different.contains(&one) {
            different.push(one);
        }
    }
    different
}
