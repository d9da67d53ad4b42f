//! Figs. 8 and 10: two crowds side by side before the push, by speed.

use super::concert::{self, FIG8, FIG10, PUSH, Variant};
use super::{Coloring, Stage, save, scene};
use crate::engine::math::Vector;
use crate::engine::scene::{Region, Scene};
use crate::lab::reproduce::case::Case;
use crate::lab::reproduce::error::ReproduceError;
use crate::lab::reproduce::product::Product;
use crate::lab::reproduce::runner::Results;
use crate::lab::reproduce::snapshot::Snapshot;
use crate::lab::reproduce::store::Store;
use crate::output::plot::Sheet;

/// Fig. 8.
pub const FIG8_PRODUCT: Product = Product {
    name: "fig8",
    about: "the crowd before the push with a static and a dynamic rest density",
    in_all: true,
    cases: |_| Ok(FIG8.iter().map(case).collect()),
    write: |_, results, store| {
        let title = "Fig. 8: static and dynamic rest density at t = 150 s, colored by speed";
        write(FIG8, title, "fig8", results, store)
    },
};

/// Fig. 10.
pub const FIG10_PRODUCT: Product = Product {
    name: "fig10",
    about: "the crowd before the push without contact between agents, and with",
    in_all: true,
    cases: |_| Ok(FIG10.iter().map(case).collect()),
    write: |_, results, store| {
        let title = "Fig. 10: without and with contact at t = 150 s, colored by speed";
        write(FIG10, title, "fig10", results, store)
    },
};

fn case(variant: &Variant) -> Case {
    variant.case().snapshot(PUSH)
}

fn write(
    variants: [Variant; 2],
    title: &str,
    name: &str,
    results: &Results,
    store: &Store,
) -> Result<String, ReproduceError> {
    let of = |variant: Variant| Ok((variant, results.of(&case(&variant))?.snapshot(PUSH)?));
    let pair: Result<Vec<_>, ReproduceError> = variants.into_iter().map(of).collect();
    let concert = scene(&concert::case())?;
    save(&sheet(title, &concert, &pair?), store, name)
}

/// The sheet from two snapshots; `title` begins with the figure's number.
fn sheet(title: &str, scene: &Scene, pair: &[(Variant, Snapshot)]) -> Sheet {
    // The whole crowd.
    let region = Region {
        min: Vector::new(44.0, -32.0),
        max: Vector::new(110.0, 32.0),
    };
    let stage = Stage::new(scene, region);
    let panel = |(variant, snapshot): &(Variant, Snapshot)| {
        stage.panel(variant.label, snapshot, Coloring::CrowdSpeed)
    };
    Sheet {
        title: title.to_owned(),
        columns: 2,
        panel_size: stage.panel_size(320.0),
        shared_axes: true,
        row_titles: Vec::new(),
        bar: Some(Coloring::CrowdSpeed.bar()),
        panels: pair.iter().map(panel).collect(),
    }
}
