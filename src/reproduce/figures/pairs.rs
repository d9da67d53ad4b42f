//! Figs. 8 and 10: two crowds side by side before the push, by speed.

use super::{Coloring, Stage};
use crate::math::Vector;
use crate::plot::Sheet;
use crate::reproduce::concert::{PUSH, Seen, Variant};
use crate::reproduce::snapshot::Snapshot;
use crate::scene::{Region, Scene};

/// The sheet from two runs; `title` begins with the figure's number.
pub fn sheet(title: &str, scene: &Scene, runs: [(Variant, &Seen); 2]) -> Sheet {
    // The whole crowd with its rim.
    let region = Region {
        min: Vector::new(44.0, -32.0),
        max: Vector::new(110.0, 32.0),
    };
    let stage = Stage::new(scene, region);
    let nobody = Snapshot::default();
    let panel = |(variant, seen): &(Variant, &Seen)| {
        let snapshot = seen.at(PUSH).unwrap_or(&nobody);
        stage.panel(variant.label, snapshot, Coloring::Speed)
    };
    Sheet {
        title: title.to_owned(),
        columns: 2,
        panel_size: stage.panel_size(360.0),
        shared_axes: true,
        row_titles: Vec::new(),
        bar: Some(Coloring::Speed.bar()),
        panels: runs.iter().map(panel).collect(),
    }
}
