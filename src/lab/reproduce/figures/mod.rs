//! The figures of the paper, drawn from the results of studies.

mod grid;
mod performance;
mod snapshots;
mod waves;

use super::product::{Needs, Product};
use snapshots::{ALL, CROWD_SPEED, DENSITY, SPEED, Snapshots};

pub use grid::PRODUCT as STUDY;
pub use performance::PRODUCT as FIG11;
pub use waves::PRODUCT as WAVES;

/// The evacuation after 15 s.
const EVACUATION: Snapshots = Snapshots {
    name: "fig5",
    title: "Fig. 5: evacuation after 15 s, colored by density",
    about: "the evacuation after 15 s, by density, 24 profiles",
    studies: &["fig5"],
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
    about: "the crossing after 45 s, by speed, six profiles",
    studies: &["fig6"],
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
    about: "the shockwave at six times, by speed, six variants of SPH",
    studies: &["shockwave"],
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
    about: "the same without SPH, two strengths of contact",
    labels: &["no SPH, Kᵃᵍ = 50", "no SPH, Kᵃᵍ = 1000"],
    ..SHOCKWAVE
};

/// Two crowds when the push begins.
const REST_DENSITIES: Snapshots = Snapshots {
    name: "fig8",
    title: "Fig. 8: static and dynamic rest density at t = 150 s, colored by speed",
    about: "the crowd before the push with a static and a dynamic rest density",
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
    about: "the crowd before the push without contact between agents, and with",
    labels: &["Kᵃᵍ = 0", "baseline"],
    titles: &["Kᵃᵍ = 0", "Kᵃᵍ = 50 (baseline)"],
    ..REST_DENSITIES
};

/// Figs. 5 to 10.
const SNAPSHOTS: [Snapshots; 6] = [
    EVACUATION,
    CROSSING,
    SHOCKWAVE,
    REST_DENSITIES,
    NO_SPH,
    CONTACTS,
];

/// Fig. `NUMBER`, 5 to 10.
pub const fn figure<const NUMBER: usize>() -> Product {
    let Snapshots {
        name,
        about,
        studies,
        labels,
        ..
    } = SNAPSHOTS[NUMBER - 5];
    Product {
        name,
        about,
        in_all: true,
        studies,
        needs: match labels {
            [] => Needs::All,
            labels => Needs::Labeled(labels),
        },
        tables: &[],
        has_figure: true,
        find: |product, studies| Ok(product.figure(SNAPSHOTS[NUMBER - 5].sheet(studies)?)),
    }
}
