//! Figs. 7 and 9: the shockwave, a row for each variant, by speed.

use super::{Coloring, Stage, letter};
use crate::math::Vector;
use crate::plot::Sheet;
use crate::reproduce::concert::{Seen, TIMES, Variant};
use crate::reproduce::snapshot::Snapshot;
use crate::scene::{Region, Scene};

/// The crowd before and beside the stage, metres.
pub fn region() -> Region {
    Region {
        min: Vector::new(46.0, -28.0),
        max: Vector::new(92.0, 28.0),
    }
}

/// The sheet from a run for each variant; `title` begins with the figure's number.
pub fn sheet(title: &str, scene: &Scene, runs: &[(Variant, &Seen)]) -> Sheet {
    let stage = Stage::new(scene, region());
    let nobody = Snapshot::default();
    let mut panels = Vec::new();
    for (row, (_, seen)) in runs.iter().enumerate() {
        for time in TIMES {
            let snapshot = seen.at(time).unwrap_or(&nobody);
            let title = if row == 0 {
                format!("t = {time} s")
            } else {
                String::new()
            };
            panels.push(stage.panel(&title, snapshot, Coloring::Speed));
        }
    }
    let row_title = |(k, (variant, _)): (usize, &(Variant, &Seen))| {
        format!("({}) {}", letter(k), variant.label)
    };
    Sheet {
        title: title.to_owned(),
        columns: TIMES.len(),
        panel_size: stage.panel_size(126.0),
        shared_axes: true,
        row_titles: runs.iter().enumerate().map(row_title).collect(),
        bar: Some(Coloring::Speed.bar()),
        panels,
    }
}
