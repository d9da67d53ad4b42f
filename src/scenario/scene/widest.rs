//! The widest bodies of groups, and the passages that are too narrow for them.

use std::collections::BTreeMap;

use crate::keys::goals::WayFinding;
use crate::scene::entrances::NEARLY_ALL;
use crate::scene::origin::{Member, Origins};
use engine::agents::RADIUS_RANGE;
use engine::profile::Blend;
use engine::scene::Scene;

/// The part of its width that a body needs with turned shoulders. Adults are 0.46 m wide and 0.28 m deep in summer
/// dress, 0.50 m and 0.32 m in winter dress (Predtechenskii and Milinskii 1978): 0.61 and 0.64. The widest 5 % of men
/// are 0.58 m and 0.33 m without clothes, 0.63 m and 0.38 m with them (Pheasant 1996): 0.57 and 0.60.
pub const SIDEWAYS: f64 = 0.6;
/// Agents that walk straight into a passage stick in it alone below this part of their width: with RVO, which keeps a
/// distance from walls, and without. Measured with all profiles and radii up to 0.3 m: at most 1.08 and 0.98.
const ALONE_RVO: f64 = 1.1;
const ALONE: f64 = 1.0;
/// The same where a part of the radius counts in contacts with walls: at least this.
const LEAST_ALONE: f64 = 0.8;

/// The widest body of a group.
#[derive(Debug, Clone, Copy)]
pub struct Widest {
    /// An agent of the group, or the group.
    pub member: Member,
    /// The width of the body, meters.
    pub width: f64,
    /// The narrowest passage in which it does not stick alone, meters.
    pub alone: f64,
}

impl Widest {
    /// The widest body of each group that has agents; of single agents, that of each.
    pub fn all(scene: &Scene, origins: &Origins) -> Vec<Self> {
        let mut found: BTreeMap<(u16, Option<usize>), Self> = BTreeMap::new();
        let mut add = |member: Member, radius: f64| {
            let blend = &scene.groups[usize::from(member.group)].blend;
            let width = 2.0 * radius;
            let alone = width * part_alone(blend);
            let new = Self {
                member,
                width,
                alone,
            };
            let key = (member.group, origins.single(member));
            let widest = found.entry(key).or_insert(new);
            if width > widest.width {
                *widest = new;
            }
        };
        let of_group = |group: u16| {
            let traits = &scene.groups[usize::from(group)].traits;
            let radius = traits.radius.as_ref();
            radius.map_or(RADIUS_RANGE[1], |radius| radius.quantile(NEARLY_ALL))
        };
        for (k, agent) in scene.agents.iter().enumerate() {
            let member = Member {
                agent: Some(k),
                group: agent.group,
            };
            let own = origins.single(member).and(agent.radius);
            add(member, own.unwrap_or_else(|| of_group(agent.group)));
        }
        let sources = scene.sources.iter().map(|source| (source.group, None));
        let entrances = scene.entrances.iter().map(|one| (one.group, None));
        let people = scene.scheduled.iter().map(|late| &late.agent);
        let scheduled = people.map(|agent| (agent.group, agent.radius));
        for (group, own) in sources.chain(entrances).chain(scheduled) {
            let member = Member { agent: None, group };
            add(member, own.unwrap_or_else(|| of_group(group)));
        }
        found.into_values().collect()
    }
}

/// The narrowest passage that an agent passes alone, as a part of its width.
fn part_alone(blend: &Blend) -> f64 {
    if blend.rvo().is_some() {
        return ALONE_RVO;
    }
    let steps = blend.steps().iter();
    let scales = steps.map(|step| step.profile.contact.wall_contact_scale);
    ALONE * scales.fold(LEAST_ALONE, f64::max)
}

/// The width below which agents take no passage, meters; `None`: they walk straight.
pub fn passable(origins: &Origins) -> Option<f64> {
    let keys = origins.keys;
    let least = || {
        let widest = Widest::all(origins.scene, origins).into_iter();
        widest.map(|widest| widest.alone).fold(0.0, f64::max)
    };
    let finds = keys.navigation == WayFinding::Paths;
    finds.then(|| keys.min_passage_width.unwrap_or_else(least))
}
