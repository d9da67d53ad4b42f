//! The behavior of agents: that of their group, as current pushes change it.

use std::ops::Range;

use super::Fixed;
use crate::agents::Agents;
use crate::profile::{Blend, Override};

impl Fixed {
    pub(super) fn blend(&self, agents: &Agents, i: usize) -> &Blend {
        &self.scene.groups[usize::from(agents.group[i])].blend
    }

    pub(super) fn change(&self, agents: &Agents, i: usize) -> Option<&Override> {
        agents.push[i].map(|push| &self.scene.pushes[usize::from(push)].change)
    }

    /// Splits a range of agents wherever the group or the push changes.
    #[inline]
    pub(super) fn each_span(
        &self,
        agents: &Agents,
        range: Range<usize>,
        mut take: impl FnMut(Range<usize>, &Blend, Option<&Override>),
    ) {
        let behavior = |i: usize| (agents.group[i], agents.push[i]);
        let mut start = range.start;
        while start < range.end {
            let same = |&i: &usize| behavior(i) == behavior(start);
            let end = (start + 1..range.end).find(|i| !same(i));
            let end = end.unwrap_or(range.end);
            let (blend, change) = (self.blend(agents, start), self.change(agents, start));
            take(start..end, blend, change);
            start = end;
        }
    }
}
