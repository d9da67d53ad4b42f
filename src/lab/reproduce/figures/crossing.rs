//! Fig. 6: the crossing after 45 s, by speed.

use super::{Coloring, Stage, letter, save, scene};
use crate::engine::math::Vector;
use crate::engine::scene::{Region, Scene};
use crate::lab::reproduce::case::Case;
use crate::lab::reproduce::error::ReproduceError;
use crate::lab::reproduce::product::Product;
use crate::lab::reproduce::snapshot::Snapshot;
use crate::output::plot::{Mark, Sheet, Style};

/// The time of the paper's figure, seconds.
const AT_SECS: f64 = 45.0;

/// (a)–(f): the paper speaks of six profiles; SF+SPH, which is in Table 2, is not among them.
const PROFILES: [&str; 6] = ["sf", "rvo", "sph", "rvo+sph", "sf->sph", "rvo->sph"];

/// The figure.
pub const PRODUCT: Product = Product {
    name: "fig6",
    about: "the crossing after 45 s, by speed, six profiles",
    in_all: true,
    cases: |_| Ok(PROFILES.into_iter().map(case).collect()),
    write: |_, results, store| {
        let of = |profile| Ok((profile, results.of(&case(profile))?.snapshot(AT_SECS)?));
        let snapshots: Result<Vec<_>, ReproduceError> = PROFILES.into_iter().map(of).collect();
        let crossing = scene(&Case::shipped("crossing"))?;
        save(&sheet(&crossing, &snapshots?), store, "fig6")
    },
};

/// The run, until the time of the figure.
fn case(profile: &str) -> Case {
    Case::shipped("crossing")
        .set("profile", profile)
        .set("duration_secs", AT_SECS)
        .snapshot(AT_SECS)
        .taking(3.0)
}

/// The region in which the paper measures the density (Fig. 4b), meters.
const MEASURED: [[f64; 2]; 5] = [
    [8.0, 4.0],
    [14.0, 4.0],
    [14.0, 12.0],
    [8.0, 12.0],
    [8.0, 4.0],
];
const GREEN: [u8; 3] = [0, 158, 115];

/// The sheet from a snapshot for each of [`PROFILES`].
fn sheet(scene: &Scene, snapshots: &[(&str, Snapshot)]) -> Sheet {
    let region = Region {
        min: Vector::new(-21.0, -5.0),
        max: Vector::new(18.0, 21.0),
    };
    let stage = Stage::new(scene, region);
    let panel = |(k, (profile, snapshot)): (usize, &(&str, Snapshot))| {
        let profile = profile.to_uppercase().replace("->", "→");
        let title = format!("({}) {profile}", letter(k));
        let mut panel = stage.panel(&title, snapshot, Coloring::Speed);
        let style = Style::full(GREEN, 0.8, "");
        panel.marks.push(Mark::Line(MEASURED.to_vec(), style));
        panel
    };
    Sheet {
        title: format!("Fig. 6: crossing and bottleneck after {AT_SECS} s, colored by speed"),
        columns: 2,
        panel_size: stage.panel_size(330.0),
        shared_axes: true,
        row_titles: Vec::new(),
        bar: Some(Coloring::Speed.bar()),
        panels: snapshots.iter().enumerate().map(panel).collect(),
    }
}
