//! The frames of a run that goes on, for a page that gets them while they are computed.

use serde_json::Value;

use super::frames::{Code, Coded, Frames};
use super::moment::Moment;
use super::options::PageOptions;
use crate::picture::Picture;

/// A page of a run that goes on.
pub struct Live {
    code: Code,
    scene: Value,
}

impl Live {
    /// A page with the plan of a picture.
    pub fn new(plan: &Picture, options: &PageOptions) -> Self {
        let (code, scene) = options.coded(plan);
        Self { code, scene }
    }

    /// What does not move, as in the element `scene` of pages.
    pub fn scene(&self) -> &Value {
        &self.scene
    }

    /// A moment in whole numbers.
    pub fn coded(&self, moment: &Moment) -> Coded {
        self.code.of(moment)
    }

    /// The time series, the people and the forces of some moments, as in pages but not compressed: they are read at
    /// once, on the same machine. The part begins with the moment `before`, if there is one. `more` is added to the
    /// time series. Without moments there are no people.
    pub fn part(
        &self,
        before: Option<&Coded>,
        moments: &[&Coded],
        more: serde_json::Map<String, Value>,
    ) -> [Vec<u8>; 3] {
        let mut frames = Frames::new(&self.code);
        if let Some(before) = before {
            frames.begin_with(before);
        }
        for moment in moments {
            frames.add(moment);
        }
        let (blocks, mut series) = frames.take();
        if let Some(entries) = series.as_object_mut() {
            entries.extend(more);
        }
        let mut blocks = blocks.into_iter().map(|block| match moments.is_empty() {
            true => Vec::new(),
            false => block.bytes(),
        });
        let [crowd, forces] = [0, 1].map(|_| blocks.next().unwrap_or_default());
        [series.to_string().into_bytes(), crowd, forces]
    }
}
