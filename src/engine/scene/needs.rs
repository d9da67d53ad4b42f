//! The quantities that a scene needs.

use crate::agents::Agents;
use crate::forces::near::Wanted;
use crate::forces::own::Force;
use crate::forces::walking::{Headings, WalkingLaw};
use crate::profile::Profile;
use crate::routes::Narrowings;
use crate::scene::Scene;

/// The widest place that counts as a narrowing, meters.
const WIDEST_NARROWING: f64 = 6.0;

/// The quantities that a scene needs, decided once. No other quantity is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Needs {
    /// Density, read in every frame by SPH forces, blending or other forces.
    pub density: bool,
    /// Sums over near neighbors that some profile reads.
    #[doc(hidden)]
    pub pairs: Wanted,
    /// Some profile uses RVO.
    pub rvo: bool,
    /// Some profile uses social forces.
    pub social: bool,
    /// Some profile has a walking law.
    pub walking: bool,
    /// The largest reach of forces that are not in the paper, meters.
    pub reach: f64,
    /// The largest avoidance radius, meters.
    pub avoidance: Option<f64>,
    /// Some agents choose headings.
    pub headings: bool,
    /// Some agents leave at their goal.
    pub removal: bool,
    /// Agents have preferred speeds of their own, or do not walk all the time.
    pub paces: bool,
    /// Some agents walk in a direction, not to a goal.
    pub directions: bool,
}

impl Needs {
    /// The union of two needs.
    pub fn with(&self, other: &Self) -> Self {
        let radii = self.avoidance.into_iter().chain(other.avoidance);
        Self {
            density: self.density || other.density,
            pairs: self.pairs.with(other.pairs),
            rvo: self.rvo || other.rvo,
            social: self.social || other.social,
            walking: self.walking || other.walking,
            headings: self.headings || other.headings,
            reach: self.reach.max(other.reach),
            avoidance: radii.reduce(f64::max),
            removal: self.removal || other.removal,
            paces: self.paces || other.paces,
            directions: self.directions || other.directions,
        }
    }
}

impl Scene {
    /// The quantities that this scene needs; only these are computed.
    pub fn needs(&self) -> Needs {
        let of_people = self.needs_of_people();
        let own = self.model.as_ref();
        let reach = own.map_or(0.0, |own| own.model.reach());
        let density = own.is_some_and(|own| own.model.needs_density());
        let of_profiles = match self.is_replaced() {
            false => self.needs_of_profiles(),
            true => Needs {
                reach: self
                    .own_forces
                    .iter()
                    .map(|own| own.reach())
                    .fold(0.0, f64::max),
                density: self.own_forces.iter().any(|own| own.needs_density()),
                ..of_people
            },
        };
        let with_model = Needs {
            reach,
            density,
            ..of_people
        };
        of_profiles.with(&with_model)
    }

    /// What the scene needs whatever the profiles: how people walk and leave.
    fn needs_of_people(&self) -> Needs {
        Needs {
            density: false,
            pairs: Wanted::default(),
            rvo: false,
            social: false,
            walking: false,
            headings: false,
            reach: 0.0,
            avoidance: None,
            removal: self
                .groups
                .iter()
                .any(|group| group.removal_radius.is_some()),
            paces: !self.journeys.zones.is_empty(),
            directions: self.groups.iter().any(|group| group.direction.is_some()),
        }
    }

    fn needs_of_profiles(&self) -> Needs {
        let wanted = self.profiles().map(Profile::wanted);
        let pairs = wanted.fold(Wanted::default(), Wanted::with);
        let mut groups = self.groups.iter();
        let blending = groups.any(|group| group.blend.depends_on_density());
        let own = self.all_forces().any(|force| force.needs_density());
        let mut laws = self.profiles().filter_map(|profile| profile.walking);
        let law = laws.any(|law| law.needs_density());
        Needs {
            density: pairs.pressure || pairs.viscosity || blending || law || own,
            pairs,
            rvo: self.groups.iter().any(|group| group.blend.rvo().is_some()),
            social: !self.social_forces().is_empty(),
            walking: !self.walking_laws().is_empty(),
            headings: self.headings().next().is_some(),
            reach: self.all_forces().map(Force::reach).fold(0.0, f64::max),
            avoidance: (self.profiles())
                .filter_map(|profile| profile.navigation.avoidance_radius())
                .reduce(f64::max),
            ..self.needs_of_people()
        }
    }

    /// The laws of headings of all profiles.
    fn headings(&self) -> impl Iterator<Item = &Headings> {
        let laws = self
            .profiles()
            .filter_map(|profile| profile.walking.as_ref());
        laws.filter_map(WalkingLaw::headings)
    }

    /// The narrowings of the floor, if a walking law heeds them.
    #[doc(hidden)]
    pub fn narrowings(&self) -> Narrowings {
        let heeds = self.headings().any(|law| law.gap.narrowing_share != 0.0);
        let routes = self.routes.as_ref().filter(|_| heeds);
        routes.map_or_else(Narrowings::default, |routes| {
            Narrowings::of(routes.floor.whole(), WIDEST_NARROWING)
        })
    }

    /// The distance of walls that walking laws see, meters.
    pub(super) fn sight(&self, agents: &Agents) -> Option<f64> {
        let pace = self.highest_pace(agents);
        let laws = self.walking_laws().into_iter();
        laws.filter_map(|law| law.sees_walls(pace)).reduce(f64::max)
    }
}
