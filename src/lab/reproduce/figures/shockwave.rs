//! Figs. 7 and 9: the shockwave by speed, one row for each variant.

use super::concert::{self, FIG7, FIG9, TIMES, Variant};
use super::{Coloring, Stage, letter, save, scene};
use crate::engine::math::Vector;
use crate::engine::scene::{Region, Scene};
use crate::lab::reproduce::case::Case;
use crate::lab::reproduce::error::ReproduceError;
use crate::lab::reproduce::product::Product;
use crate::lab::reproduce::runner::Results;
use crate::lab::reproduce::snapshot::Snapshot;
use crate::lab::reproduce::store::Store;
use crate::output::plot::Sheet;

/// Fig. 7.
pub const FIG7_PRODUCT: Product = Product {
    name: "fig7",
    about: "the shockwave at six times, by speed, six variants of SPH",
    in_all: true,
    cases: |_| Ok(FIG7.iter().map(case).collect()),
    write: |_, results, store| {
        let title = "Fig. 7: the shockwave, colored by speed";
        write(&FIG7, title, "fig7", results, store)
    },
};

/// Fig. 9.
pub const FIG9_PRODUCT: Product = Product {
    name: "fig9",
    about: "the same without SPH, two strengths of contact",
    in_all: true,
    cases: |_| Ok(FIG9.iter().map(case).collect()),
    write: |_, results, store| {
        let title = "Fig. 9: the shockwave without SPH, colored by speed";
        write(&FIG9, title, "fig9", results, store)
    },
};

fn case(variant: &Variant) -> Case {
    TIMES.into_iter().fold(variant.case(), Case::snapshot)
}

fn write(
    variants: &[Variant],
    title: &str,
    name: &str,
    results: &Results,
    store: &Store,
) -> Result<String, ReproduceError> {
    let mut rows = Vec::new();
    for variant in variants {
        let result = results.of(&case(variant))?;
        let snapshots: Result<Vec<_>, _> = TIMES.into_iter().map(|t| result.snapshot(t)).collect();
        rows.push((*variant, snapshots?));
    }
    let concert = scene(&concert::case())?;
    save(&sheet(title, &concert, &rows), store, name)
}

/// The crowd in front of the stage and beside it, meters.
fn region() -> Region {
    Region {
        min: Vector::new(44.0, -31.0),
        max: Vector::new(92.0, 31.0),
    }
}

/// The sheet from snapshots at [`TIMES`] for each variant; `title` begins with the figure's number.
fn sheet(title: &str, scene: &Scene, rows: &[(Variant, Vec<Snapshot>)]) -> Sheet {
    let stage = Stage::new(scene, region());
    let mut panels = Vec::new();
    for (row, (_, snapshots)) in rows.iter().enumerate() {
        for (time, snapshot) in TIMES.iter().zip(snapshots) {
            let title = if row == 0 {
                format!("t = {time} s")
            } else {
                String::new()
            };
            panels.push(stage.panel(&title, snapshot, Coloring::CrowdSpeed));
        }
    }
    let row_title = |(k, (variant, _)): (usize, &(Variant, Vec<Snapshot>))| {
        format!("({}) {}", letter(k), variant.label)
    };
    Sheet {
        title: title.to_owned(),
        columns: TIMES.len(),
        panel_size: stage.panel_size(108.0),
        shared_axes: true,
        row_titles: rows.iter().enumerate().map(row_title).collect(),
        bar: Some(Coloring::CrowdSpeed.bar()),
        panels,
    }
}
