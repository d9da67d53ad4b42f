//! The figures of the paper, drawn from the results of studies.

mod grid;
mod performance;
mod snapshots;
mod waves;

use super::product::{Needs, Product};
use crate::lab::error::LabError;
use crate::output::plot::Sheet;
use crate::runs::store::Store;
use snapshots::{Coloring, Snapshots};

pub use grid::PRODUCT as STUDY;
pub use performance::PRODUCT as FIG11;
pub use waves::PRODUCT as WAVES;

/// Fig. 5.
pub const FIG5: Product = Product {
    name: "fig5",
    about: "the evacuation after 15 s, by density, 24 profiles",
    in_all: true,
    studies: &["fig5"],
    needs: Needs::All,
    write: |studies, store| {
        let picture = Snapshots {
            name: "fig5",
            title: "Fig. 5: evacuation after 15 s, colored by density",
            times: &[15.0],
            region: [[8.0, -1.0], [23.0, 21.0]],
            coloring: Coloring::Density,
            columns: 6,
            width: 132.0,
            measured: None,
        };
        picture.write_all(studies, store)
    },
};

/// Fig. 6, with the region that Table 2 measures.
pub const FIG6: Product = Product {
    name: "fig6",
    about: "the crossing after 45 s, by speed, six profiles",
    in_all: true,
    studies: &["fig6"],
    needs: Needs::All,
    write: |studies, store| {
        let picture = Snapshots {
            name: "fig6",
            title: "Fig. 6: crossing and bottleneck after 45 s, colored by speed",
            times: &[45.0],
            region: [[-21.0, -5.0], [18.0, 21.0]],
            coloring: Coloring::Speed,
            columns: 2,
            width: 330.0,
            measured: Some([[8.0, 4.0], [14.0, 12.0]]),
        };
        picture.write_all(studies, store)
    },
};

/// The moments of Figs. 7 and 9, seconds.
const TIMES: [f64; 6] = [150.3, 151.0, 152.0, 153.0, 154.0, 156.0];
/// When the push begins, seconds.
const PUSH: [f64; 1] = [150.0];

/// The shockwave at six times.
const SHOCKWAVE: Snapshots = Snapshots {
    name: "fig7",
    title: "Fig. 7: the shockwave, colored by speed",
    times: &TIMES,
    region: [[44.0, -31.0], [92.0, 31.0]],
    coloring: Coloring::CrowdSpeed,
    columns: TIMES.len(),
    width: 108.0,
    measured: None,
};

/// Two crowds before the push.
const PAIR: Snapshots = Snapshots {
    name: "fig8",
    title: "Fig. 8: static and dynamic rest density at t = 150 s, colored by speed",
    times: &PUSH,
    region: [[44.0, -32.0], [110.0, 32.0]],
    columns: 2,
    width: 320.0,
    ..SHOCKWAVE
};

const FIG7_LABELS: &[&str] = &[
    "baseline",
    "k = 100",
    "k = 400",
    "ρ⁰max = 4",
    "ρ⁰max = 6",
    "μ = 0",
];
const FIG8_LABELS: &[&str] = &["static ρ⁰ = 4", "ρ⁰max = 4"];
const FIG9_LABELS: &[&str] = &["no SPH, Kᵃᵍ = 50", "no SPH, Kᵃᵍ = 1000"];
const FIG10_LABELS: &[&str] = &["Kᵃᵍ = 0", "baseline"];

/// Fig. 7.
pub const FIG7: Product = Product {
    name: "fig7",
    about: "the shockwave at six times, by speed, six variants of SPH",
    in_all: true,
    studies: &["shockwave"],
    needs: Needs::Labeled(FIG7_LABELS),
    write: |studies, store| SHOCKWAVE.write(studies, FIG7_LABELS, FIG7_LABELS, store),
};

/// Fig. 8.
pub const FIG8: Product = Product {
    name: "fig8",
    about: "the crowd before the push with a static and a dynamic rest density",
    needs: Needs::Labeled(FIG8_LABELS),
    write: |studies, store| {
        let titles = [FIG8_LABELS[0], "dynamic ρ⁰, 0 to 4"];
        PAIR.write(studies, FIG8_LABELS, &titles, store)
    },
    ..FIG7
};

/// Fig. 9.
pub const FIG9: Product = Product {
    name: "fig9",
    about: "the same without SPH, two strengths of contact",
    needs: Needs::Labeled(FIG9_LABELS),
    write: |studies, store| {
        let picture = Snapshots {
            name: "fig9",
            title: "Fig. 9: the shockwave without SPH, colored by speed",
            ..SHOCKWAVE
        };
        picture.write(studies, FIG9_LABELS, FIG9_LABELS, store)
    },
    ..FIG7
};

/// Fig. 10.
pub const FIG10: Product = Product {
    name: "fig10",
    about: "the crowd before the push without contact between agents, and with",
    needs: Needs::Labeled(FIG10_LABELS),
    write: |studies, store| {
        let picture = Snapshots {
            name: "fig10",
            title: "Fig. 10: without and with contact at t = 150 s, colored by speed",
            ..PAIR
        };
        let titles = [FIG10_LABELS[0], "Kᵃᵍ = 50 (baseline)"];
        picture.write(studies, FIG10_LABELS, &titles, store)
    },
    ..FIG7
};

/// Writes a picture into the store's folder, and returns a line with the file names.
fn save(sheet: &Sheet, store: &Store, name: &str) -> Result<String, LabError> {
    let stem = store.path(name);
    sheet.save(&stem)?;
    Ok(format!("{0}.svg, {0}.png\n", stem.display()))
}
