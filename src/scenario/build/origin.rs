//! Which key of a file an agent of a scene comes from, for messages.

use crate::engine::scene::Scene;
use crate::scenario::file::File;

/// An agent of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Member {
    /// Its number among those that stand there at the start, if it is one of them.
    pub agent: Option<usize>,
    /// The number of its group.
    pub group: u16,
}

/// The list of a file that an agent comes from, and the number of its item there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Item {
    From,
    Agent(usize),
    Grid(usize),
    Crowd(usize),
    Source(usize),
    Entrance(usize),
}

/// What the agents of a scene come from.
pub struct Origins<'a> {
    keys: &'a File,
    scene: &'a Scene,
    /// The first group of a grid. From there on, each grid, crowd, source and entrance has its own group, in this
    /// order.
    first_grid: usize,
    /// The number of the first one of `agents`, which come after the people of `from`.
    first_single: usize,
}

impl<'a> Origins<'a> {
    pub fn new(keys: &'a File, scene: &'a Scene) -> Self {
        let lists = [
            keys.grids.len(),
            keys.crowds.len(),
            keys.sources.len(),
            keys.entrances.len(),
        ];
        let first_grid = scene.groups.len().saturating_sub(lists.iter().sum());
        let mut agents = scene.agents.iter();
        let before_grids = agents
            .position(|agent| usize::from(agent.group) >= first_grid)
            .unwrap_or(scene.agents.len());
        Self {
            keys,
            scene,
            first_grid,
            first_single: before_grids.saturating_sub(keys.agents.len()),
        }
    }

    fn item(&self, member: Member) -> Item {
        let Some(mut k) = usize::from(member.group).checked_sub(self.first_grid) else {
            let single = member
                .agent
                .and_then(|agent| agent.checked_sub(self.first_single));
            return single.map_or(Item::From, Item::Agent);
        };
        let keys = self.keys;
        let lists = [
            (keys.grids.len(), Item::Grid as fn(usize) -> Item),
            (keys.crowds.len(), Item::Crowd),
            (keys.sources.len(), Item::Source),
        ];
        for (length, item) in lists {
            match k.checked_sub(length) {
                Some(rest) => k = rest,
                None => return item(k),
            }
        }
        Item::Entrance(k)
    }

    /// The number of an agent whose body is given alone, as one of `agents`.
    pub fn single(&self, member: Member) -> Option<usize> {
        let is_single = matches!(self.item(member), Item::Agent(_));
        member.agent.filter(|_| is_single)
    }

    /// What messages call an agent: `agents[1]`, or the name of its group.
    pub fn name(&self, member: Member) -> String {
        match self.item(member) {
            Item::Agent(k) => format!("agents[{k}]"),
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
            Item::Agent(k) => Some(format!("agents[{k}].position")),
            Item::Grid(k) => Some(format!("grids[{k}]")),
            _ => None,
        }
    }

    /// The key that gives the goal: `agents[1].goal`, or `goal` at the top of the file.
    pub fn goal_key(&self, member: Member) -> String {
        let keys = self.keys;
        let (list, k, goal, offset) = match self.item(member) {
            Item::From => {
                let has_goal = keys.from.as_ref().is_some_and(|from| from.goal.is_some());
                return if has_goal { "from.goal" } else { "goal" }.to_owned();
            }
            Item::Agent(k) => ("agents", k, keys.agents[k].goal, None),
            Item::Grid(k) => ("grids", k, keys.grids[k].goal, keys.grids[k].goal_offset),
            Item::Crowd(k) => ("crowds", k, keys.crowds[k].goal, None),
            Item::Source(k) => (
                "sources",
                k,
                keys.sources[k].goal,
                keys.sources[k].goal_offset,
            ),
            Item::Entrance(k) => ("entrances", k, keys.entrances[k].goal, None),
        };
        match (goal, offset) {
            (Some(_), _) => format!("{list}[{k}].goal"),
            (None, Some(_)) => format!("{list}[{k}].goal_offset"),
            (None, None) => "goal".to_owned(),
        }
    }
}
