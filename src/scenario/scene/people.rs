//! Agents, grids, crowds, sources and entrances of a file → groups, agents, sources and entrances of a scene.

use libm::hypot;
use std::collections::BTreeMap;

use crate::error::{Problem, Under};
use crate::file::File;
use crate::keys::limits::MOST_NUMBERED;
use crate::keys::people;
use crate::keys::people::{Behavior, People};
use crate::keys::profiles::ProfileChoice;
use crate::keys::shapes::{Corners, Point, region};
use crate::scene::draws::traits;
use crate::scene::origin::{Item, Items};
use crate::scene::target::Target;
use crate::scene::{overlaps, profiles};
use engine::agents::NewAgent;
use engine::math::Vector;
use engine::packing::Body;
use engine::placement::Grid;
use engine::profile::Blend;
use engine::scene::{Group, Region, Scene, Source};
use engine::traits::Traits;

/// Most different profiles defined in full: each takes its own sum over all agents.
const MOST_CUSTOM: usize = 1_000;

/// Relative rounding error that a speed clamped to `max_speed` may have.
const ROUNDING: f64 = 1e-9;

/// What the single agents of a group have in common. Numbers are equal if their bits are.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Shared {
    /// The number of their profile in [`Population::profiles`].
    profile: Option<usize>,
    remove_within: Option<u64>,
    motivation: Option<u64>,
    counted: Option<bool>,
    journey: Option<u16>,
    direction: Option<[u64; 2]>,
}

/// Adds the agents to a scene.
pub struct Population<'a> {
    pub file: &'a File,
    default: &'a Blend,
    /// The outlines of the floors behind exits and entrances, where no crowd starts.
    pub behind: &'a [Vec<Vector>],
    pub scene: &'a mut Scene,
    /// Groups of single agents, by what these have in common.
    shared: BTreeMap<Shared, u16>,
    /// The different profiles that agents name or define in full.
    profiles: Vec<ProfileChoice>,
    /// For readers of the results.
    pub notes: Vec<String>,
    /// The bodies of the first agents of the scene, as far as they have been needed.
    pub bodies: Vec<Body>,
}

impl<'a> Population<'a> {
    /// `default` is the blend of agents that name no profile; `behind` are the floors behind exits and entrances.
    pub fn new(
        file: &'a File,
        default: &'a Blend,
        behind: &'a [Vec<Vector>],
        scene: &'a mut Scene,
    ) -> Self {
        Self {
            file,
            default,
            behind,
            scene,
            shared: BTreeMap::new(),
            profiles: Vec::new(),
            notes: Vec::new(),
            bodies: Vec::new(),
        }
    }

    /// Adds the people of `from`, single agents, grids, crowds, sources, then entrances. Their number has been checked.
    /// Returns notes for readers of the results, and what has been added.
    pub fn enter(mut self) -> Result<(Vec<String>, Items), Problem> {
        let mut items = Items::default();
        if let Some(from) = &self.file.from {
            self.add_data(from).under("from")?;
            items.add(Item::From, self.scene);
        }
        for (k, agent) in self.file.agents.iter().enumerate() {
            self.add(Item::Agent(k), &mut items, |all, _| all.agent(agent))?;
        }
        for (k, grid) in self.file.grids.iter().enumerate() {
            self.add(Item::Grid(k), &mut items, |all, name| all.grid(grid, name))?;
        }
        for (k, crowd) in self.file.crowds.iter().enumerate() {
            let enter = |all: &mut Self, name: &str| all.crowd(crowd, k as u32, name);
            self.add(Item::Crowd(k), &mut items, enter)?;
        }
        for (k, source) in self.file.sources.iter().enumerate() {
            let enter = |all: &mut Self, name: &str| all.source(source, name);
            self.add(Item::Source(k), &mut items, enter)?;
        }
        for (k, entrance) in self.file.entrances.iter().enumerate() {
            let enter = |all: &mut Self, name: &str| all.entrance(entrance, name);
            self.add(Item::Entrance(k), &mut items, enter)?;
        }
        self.note_bodies();
        self.notes.extend(overlaps::note(&self.bodies));
        Ok((self.notes, items))
    }

    /// Adds what `enter` adds, which gets the name of the item.
    fn add(
        &mut self,
        item: Item,
        items: &mut Items,
        enter: impl FnOnce(&mut Self, &str) -> Result<(), Problem>,
    ) -> Result<(), Problem> {
        let name = item.to_string();
        enter(self, &name).under(&name)?;
        items.add(item, self.scene);
        Ok(())
    }

    fn agent(&mut self, agent: &people::Agent) -> Result<(), Problem> {
        let [x, y] = agent.velocity.unwrap_or_default();
        let own_most = |speed| self.scene.own_speeds(speed)[1];
        let own = agent.preferred_speed.map(own_most);
        let (speed, most) = (hypot(x, y), own.unwrap_or(self.scene.max_speed));
        if speed > most * (1.0 + ROUNDING) {
            let reason = format!(
                "the speed {speed} m/s is above max_speed {most}; lower it, or raise max_speed"
            );
            return Err(Problem::new("velocity", reason));
        }
        let target = self.target(&agent.behavior, None)?;
        let position = agent.position.into();
        let group = self.shared_group(&agent.behavior, &target)?;
        self.scene.agents.push(NewAgent {
            velocity: [x, y].into(),
            radius: agent.radius,
            mass: agent.mass,
            mean_density: agent.mean_density,
            preferred_speed: agent.preferred_speed,
            premovement: agent.premovement_secs,
            ..NewAgent::at(position, target.goal_from(position), group)
        });
        Ok(())
    }

    fn grid(&mut self, given: &people::Grid, place: &str) -> Result<(), Problem> {
        for (key, is_given) in [
            ("start_secs", given.start_secs.is_some()),
            ("every_secs", given.every_secs.is_some()),
            ("times", given.times.is_some()),
        ] {
            if is_given {
                let reason = "is a key of `sources`; agents of `grids` enter once, at the start";
                return Err(Problem::new(key, reason));
            }
        }
        let (grid, group, target) = self.placed(given, place)?;
        let first_id = self.scene.agents.len() as u32;
        let agents = grid
            .positions(self.scene.seed, first_id)
            .map(|position| NewAgent::at(position, target.goal_from(position), group));
        self.scene.agents.extend(agents);
        Ok(())
    }

    fn source(&mut self, given: &people::Grid, place: &str) -> Result<(), Problem> {
        let (grid, group, target) = self.placed(given, place)?;
        let [start, every] = given.schedule();
        let source = Source {
            name: given.name.as_deref().unwrap_or(place).to_owned(),
            grid,
            group,
            goal: target.goal,
            start,
            every,
            times: given.times,
        };
        self.scene.sources.push(source);
        Ok(())
    }

    /// The grid, the group and the target of a grid or source.
    fn placed(
        &mut self,
        given: &people::Grid,
        place: &str,
    ) -> Result<(Grid, u16, Target), Problem> {
        let Region { min, max } = region("min", Corners([given.min, given.max]))?;
        let grid = Grid {
            min,
            max,
            columns: given.columns,
            rows: given.rows,
            jitter: given.jitter,
        };
        for (key, cells, extent) in [
            ("columns", grid.columns, max.x - min.x),
            ("rows", grid.rows, max.y - min.y),
        ] {
            if cells > 1 && extent == 0.0 && grid.jitter == 0.0 {
                let reason = format!(
                    "{cells} agents would stand at one point: `min` and `max` are 0 m apart; move one, or set `jitter`"
                );
                return Err(Problem::new(key, reason));
            }
        }
        let name = given.name.as_deref().unwrap_or(place);
        let (group, target) = self.people(name, &given.people, given.goal_offset)?;
        Ok((grid, group, target))
    }

    /// Adds the group of agents that share keys. Returns it with their target, which is `offset` from where they start
    /// if that is given.
    pub fn people(
        &mut self,
        name: &str,
        given: &People,
        offset: Option<Point>,
    ) -> Result<(u16, Target), Problem> {
        let traits = traits(given)?;
        let target = self.target(&given.behavior, offset)?;
        let group = self.group((name, traits), &given.behavior, &target)?;
        Ok((group, target))
    }

    /// The group of single agents with this behavior; creates it if needed.
    fn shared_group(&mut self, given: &Behavior, target: &Target) -> Result<u16, Problem> {
        // The target has goal and journey.
        let Behavior {
            goal: _,
            journey: _,
            uses_stairs: _, // buildings have turned it into a journey
            profile,
            remove_within,
            motivation,
            counted,
        } = given;
        let shared = Shared {
            profile: profile.as_ref().map(|profile| self.number_of(profile)),
            remove_within: remove_within.map(f64::to_bits),
            motivation: motivation.map(f64::to_bits),
            counted: *counted,
            journey: target.journey,
            direction: target.direction.map(|d| [d.x, d.y].map(f64::to_bits)),
        };
        if let Some(&group) = self.shared.get(&shared) {
            return Ok(group);
        }
        let group = self.group(("agents", Traits::default()), given, target)?;
        self.shared.insert(shared, group);
        Ok(group)
    }

    /// The number of a profile among the different ones.
    fn number_of(&mut self, profile: &ProfileChoice) -> usize {
        let known = self.profiles.iter().position(|one| one == profile);
        known.unwrap_or_else(|| {
            self.profiles.push(profile.clone());
            self.profiles.len() - 1
        })
    }

    /// Adds a group.
    fn group(
        &mut self,
        (name, traits): (&str, Traits),
        given: &Behavior,
        target: &Target,
    ) -> Result<u16, Problem> {
        if self.scene.groups.len() >= MOST_NUMBERED {
            let reason = format!(
                "more than {MOST_NUMBERED} groups of agents; put several into one grid or source, or give \
                 single agents the same profile, `remove_within` and `counted`"
            );
            return Err(Problem::new("", reason));
        }
        let is_custom = |profile: &&ProfileChoice| matches!(profile, ProfileChoice::Custom(_));
        if let Some(profile) = given.profile.as_ref().filter(is_custom) {
            self.number_of(profile);
            if self.profiles.iter().filter(is_custom).count() > MOST_CUSTOM {
                let reason = format!(
                    "more than {MOST_CUSTOM} different profiles defined in full; let agents share profiles"
                );
                return Err(Problem::new("profile", reason));
            }
        }
        let blend = match &given.profile {
            None => self.default.clone(),
            Some(choice) => profiles::blend(choice, &self.file.parameters).under("profile")?,
        };
        Ok(self.scene.add_group(Group {
            name: name.to_owned(),
            blend,
            removal_radius: given.remove_within,
            counted: given.counted.unwrap_or(true),
            journey: target.journey,
            direction: target.direction,
            motivation: given.motivation.unwrap_or(self.file.motivation),
            traits,
        }))
    }
}
