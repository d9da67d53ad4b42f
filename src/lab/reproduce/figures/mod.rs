//! The figures of the paper, drawn from the results of studies.

mod grid;
mod performance;
mod snapshots;
mod waves;

use super::product::{Needs, Product, Write};
use crate::lab::error::LabError;
use crate::output::plot::Sheet;
use crate::runs::store::Store;
use snapshots::{ALL, CROWD_SPEED, DENSITY, SPEED, Snapshots};

pub use grid::PRODUCT as STUDY;
pub use performance::PRODUCT as FIG11;
pub use waves::PRODUCT as WAVES;

/// The evacuation after 15 s.
const EVACUATION: Snapshots = Snapshots {
    name: "fig5",
    title: "Fig. 5: evacuation after 15 s, colored by density",
    times: &[15.0],
    region: [[8.0, -1.0], [23.0, 21.0]],
    coloring: DENSITY,
    columns: 6,
    width: 132.0,
    ..ALL
};

/// The crossing after 45 s, with the region that Table 2 measures.
const CROSSING: Snapshots = Snapshots {
    name: "fig6",
    title: "Fig. 6: crossing and bottleneck after 45 s, colored by speed",
    times: &[45.0],
    region: [[-21.0, -5.0], [18.0, 21.0]],
    coloring: SPEED,
    columns: 2,
    width: 330.0,
    measured: Some([[8.0, 4.0], [14.0, 12.0]]),
    ..ALL
};

/// The shockwave at six times.
const SHOCKWAVE: Snapshots = Snapshots {
    name: "fig7",
    title: "Fig. 7: the shockwave, colored by speed",
    times: &[150.3, 151.0, 152.0, 153.0, 154.0, 156.0],
    region: [[44.0, -31.0], [92.0, 31.0]],
    coloring: CROWD_SPEED,
    columns: 6,
    width: 108.0,
    labels: &[
        "baseline",
        "k = 100",
        "k = 400",
        "ρ⁰max = 4",
        "ρ⁰max = 6",
        "μ = 0",
    ],
    ..ALL
};

/// The same without SPH.
const NO_SPH: Snapshots = Snapshots {
    name: "fig9",
    title: "Fig. 9: the shockwave without SPH, colored by speed",
    labels: &["no SPH, Kᵃᵍ = 50", "no SPH, Kᵃᵍ = 1000"],
    ..SHOCKWAVE
};

/// Two crowds when the push begins.
const REST_DENSITIES: Snapshots = Snapshots {
    name: "fig8",
    title: "Fig. 8: static and dynamic rest density at t = 150 s, colored by speed",
    times: &[150.0],
    region: [[44.0, -32.0], [110.0, 32.0]],
    columns: 2,
    width: 320.0,
    labels: &["static ρ⁰ = 4", "ρ⁰max = 4"],
    titles: &["static ρ⁰ = 4", "dynamic ρ⁰, 0 to 4"],
    ..SHOCKWAVE
};

/// The same for other crowds.
const CONTACTS: Snapshots = Snapshots {
    name: "fig10",
    title: "Fig. 10: without and with contact at t = 150 s, colored by speed",
    labels: &["Kᵃᵍ = 0", "baseline"],
    titles: &["Kᵃᵍ = 0", "Kᵃᵍ = 50 (baseline)"],
    ..REST_DENSITIES
};

/// Fig. 5.
pub const FIG5: Product = Product {
    name: "fig5",
    about: "the evacuation after 15 s, by density, 24 profiles",
    in_all: true,
    studies: &["fig5"],
    needs: Needs::All,
    write: |studies, store| EVACUATION.write(studies, store),
};

/// Fig. 6.
pub const FIG6: Product = Product {
    name: "fig6",
    about: "the crossing after 45 s, by speed, six profiles",
    studies: &["fig6"],
    write: |studies, store| CROSSING.write(studies, store),
    ..FIG5
};

/// A figure of some runs of the shockwave.
const fn shockwave(
    name: &'static str,
    about: &'static str,
    labels: &'static [&'static str],
    write: Write,
) -> Product {
    Product {
        name,
        about,
        in_all: true,
        studies: &["shockwave"],
        needs: Needs::Labeled(labels),
        write,
    }
}

/// Fig. 7.
pub const FIG7: Product = shockwave(
    "fig7",
    "the shockwave at six times, by speed, six variants of SPH",
    SHOCKWAVE.labels,
    |studies, store| SHOCKWAVE.write(studies, store),
);

/// Fig. 8.
pub const FIG8: Product = shockwave(
    "fig8",
    "the crowd before the push with a static and a dynamic rest density",
    REST_DENSITIES.labels,
    |studies, store| REST_DENSITIES.write(studies, store),
);

/// Fig. 9.
pub const FIG9: Product = shockwave(
    "fig9",
    "the same without SPH, two strengths of contact",
    NO_SPH.labels,
    |studies, store| NO_SPH.write(studies, store),
);

/// Fig. 10.
pub const FIG10: Product = shockwave(
    "fig10",
    "the crowd before the push without contact between agents, and with",
    CONTACTS.labels,
    |studies, store| CONTACTS.write(studies, store),
);

/// Writes a picture into the store's folder, and returns a line with the file names.
fn save(sheet: &Sheet, store: &Store, name: &str) -> Result<String, LabError> {
    let stem = store.path(name);
    sheet.save(&stem)?;
    Ok(format!("{0}.svg, {0}.png\n", stem.display()))
}
