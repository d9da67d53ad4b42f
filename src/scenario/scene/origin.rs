//! Which key of a file an agent of a scene comes from, for messages.

use crate::file::File;
use crate::keys::people::{Grid, People};
use engine::scene::Scene;

/// An agent of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Member {
    /// Its number among those that stand there at the start, if it is one of them.
    pub agent: Option<usize>,
    /// The number of its group.
    pub group: u16,
}

/// The list of a file that agents come from, and the number of its item there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Item {
    From,
    Agent(usize),
    Grid(usize),
    Crowd(usize),
    Source(usize),
    Entrance(usize),
}

impl std::fmt::Display for Item {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::From => f.write_str("from"),
            Self::Agent(k) => write!(f, "agents[{k}]"),
            Self::Grid(k) => write!(f, "grids[{k}]"),
            Self::Crowd(k) => write!(f, "crowds[{k}]"),
            Self::Source(k) => write!(f, "sources[{k}]"),
            Self::Entrance(k) => write!(f, "entrances[{k}]"),
        }
    }
}

/// The items of a file in the order in which they were added to a scene, each with the numbers of agents and of groups
/// that the scene then had.
#[derive(Debug, Default)]
pub struct Items(Vec<(Item, [usize; 2])>);

impl Items {
    /// Notes that an item has been added to `scene`.
    pub fn add(&mut self, item: Item, scene: &Scene) {
        self.0
            .push((item, [scene.agents.len(), scene.groups.len()]));
    }

    /// What the agents of `scene` come from, which has been built from `keys`.
    pub fn origins<'a>(&'a self, keys: &'a File, scene: &'a Scene) -> Origins<'a> {
        Origins {
            keys,
            scene,
            items: self,
        }
    }

    /// The item that placed the agent of this number at the start.
    pub fn of_agent(&self, k: usize) -> Item {
        self.after(|[agents, _]| agents <= k)
    }

    fn of(&self, member: Member) -> Item {
        match member.agent {
            Some(agent) => self.of_agent(agent),
            None => self.after(|[_, groups]| groups <= usize::from(member.group)),
        }
    }

    /// The first item after those `before`.
    fn after(&self, before: impl Fn([usize; 2]) -> bool) -> Item {
        let k = self.0.partition_point(|&(_, counts)| before(counts));
        self.0.get(k).map_or(Item::From, |&(item, _)| item)
    }
}

/// What the agents of a scene come from.
#[derive(Clone, Copy)]
pub struct Origins<'a> {
    pub keys: &'a File,
    pub scene: &'a Scene,
    pub items: &'a Items,
}

impl Origins<'_> {
    fn item(&self, member: Member) -> Item {
        self.items.of(member)
    }

    /// The number of an agent whose body is given alone, as one of `agents`.
    pub fn single(&self, member: Member) -> Option<usize> {
        let is_single = matches!(self.item(member), Item::Agent(_));
        member.agent.filter(|_| is_single)
    }

    /// What messages call an agent: `agents[1]`, or the name of its group.
    pub fn name(&self, member: Member) -> String {
        match self.item(member) {
            item @ Item::Agent(_) => item.to_string(),
            _ => self.scene.groups[usize::from(member.group)].name.clone(),
        }
    }

    /// A clause: `agents[1] starts`, or `agents of crowd start`.
    pub fn starting(&self, member: Member) -> String {
        let name = self.name(member);
        match self.item(member) {
            Item::Agent(_) => format!("{name} starts"),
            _ => format!("agents of {name} start"),
        }
    }

    /// The key that says where a single agent or a grid starts: `agents[1].position`, or `grids[0]`.
    pub fn start_key(&self, member: Member) -> Option<String> {
        match self.item(member) {
            item @ Item::Agent(_) => Some(format!("{item}.position")),
            item @ Item::Grid(_) => Some(item.to_string()),
            _ => None,
        }
    }

    /// The key that gives the goal: `agents[1].goal`, or `goal` at the top of the file.
    pub fn goal_key(&self, member: Member) -> String {
        let keys = self.keys;
        let item = self.item(member);
        let own = |people: &People| people.behavior.goal.and(Some("goal"));
        let of_grid = |grid: &Grid| own(&grid.people).or(grid.goal_offset.and(Some("goal_offset")));
        let given = match item {
            Item::From => keys.from.as_ref().and_then(|from| own(&from.all)),
            Item::Agent(k) => keys.agents[k].behavior.goal.and(Some("goal")),
            Item::Grid(k) => of_grid(&keys.grids[k]),
            Item::Crowd(k) => own(&keys.crowds[k].people),
            Item::Source(k) => of_grid(&keys.sources[k]),
            Item::Entrance(k) => own(&keys.entrances[k].people),
        };
        given.map_or("goal".to_owned(), |key| format!("{item}.{key}"))
    }
}
