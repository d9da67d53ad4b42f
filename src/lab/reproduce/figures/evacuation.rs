//! Fig. 5: the room after 15 s, by density.

use super::{Coloring, Stage, letter, save, scene};
use crate::engine::math::Vector;
use crate::engine::scene::{Region, Scene};
use crate::lab::reproduce::case::Case;
use crate::lab::reproduce::error::ReproduceError;
use crate::lab::reproduce::product::Product;
use crate::lab::reproduce::snapshot::Snapshot;
use crate::output::plot::Sheet;

/// The time of the paper's figure, seconds.
const AT_SECS: f64 = 15.0;

/// The figure.
pub const PRODUCT: Product = Product {
    name: "fig5",
    about: "the evacuation after 15 s, by density, 24 profiles",
    in_all: true,
    cases: |_| Ok(panels().iter().map(Panel::case).collect()),
    write: |_, results, store| {
        let of = |panel: Panel| Ok((panel, results.of(&panel.case())?.snapshot(AT_SECS)?));
        let snapshots: Result<Vec<_>, ReproduceError> = panels().into_iter().map(of).collect();
        let room = scene(&Case::shipped("evacuation"))?;
        save(&sheet(&room, &snapshots?), store, "fig5")
    },
};

/// One panel: a profile, and the one parameter that is set.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Panel {
    /// The profile's name (§5.5).
    profile: &'static str,
    /// The key and value of the setting; `None` for the unchanged profile.
    setting: Option<(&'static str, f64)>,
}

/// (a)–(e) SF, (f) RVO, (g)–(l) SPH, (m)–(o) SF+SPH, (p)–(r) RVO+SPH, (s)–(u) SF→SPH, (v)–(x) RVO→SPH. The paper does
/// not give the three ρ⁰max of (m)–(r); here they are those of (s)–(x).
fn panels() -> Vec<Panel> {
    let with = |profile, key, values: &[f64]| -> Vec<Panel> {
        let panel = |&value| Panel {
            profile,
            setting: Some((key, value)),
        };
        values.iter().map(panel).collect()
    };
    let rvo = Panel {
        profile: "rvo",
        setting: None,
    };
    let density = "rest_density_max";
    let contact = [50.0, 100.0, 250.0, 500.0, 1000.0];
    let mut panels = with("sf", "agent_stiffness", &contact);
    panels.push(rvo);
    panels.extend(with("sph", density, &[3.0, 4.0, 5.0, 6.0, 7.0, 8.0]));
    for profile in ["sf+sph", "rvo+sph", "sf->sph", "rvo->sph"] {
        panels.extend(with(profile, density, &[4.0, 5.0, 6.0]));
    }
    panels
}

impl Panel {
    /// The run, until the time of the figure.
    fn case(&self) -> Case {
        let case = Case::shipped("evacuation")
            .set("profile", self.profile)
            .set("duration_secs", AT_SECS)
            .snapshot(AT_SECS)
            .taking(1.5);
        match self.setting {
            Some((key, value)) => case.set(key, value),
            None => case,
        }
    }

    fn title(&self) -> String {
        let profile = self.profile.to_uppercase().replace("->", "→");
        match self.setting {
            Some(("agent_stiffness", value)) => format!("{profile}, Kᵃᵍ = {value}"),
            Some((_, value)) => format!("{profile}, ρ⁰max = {value}"),
            None => profile,
        }
    }
}

/// The sheet from the panels' snapshots.
fn sheet(scene: &Scene, snapshots: &[(Panel, Snapshot)]) -> Sheet {
    let region = Region {
        min: Vector::new(8.0, -1.0),
        max: Vector::new(23.0, 21.0),
    };
    let stage = Stage::new(scene, region);
    let panel = |(k, (panel, snapshot)): (usize, &(Panel, Snapshot))| {
        let title = format!("({}) {}", letter(k), panel.title());
        stage.panel(&title, snapshot, Coloring::Density)
    };
    Sheet {
        title: format!("Fig. 5: evacuation after {AT_SECS} s, colored by density"),
        columns: 6,
        panel_size: stage.panel_size(132.0),
        shared_axes: true,
        row_titles: Vec::new(),
        bar: Some(Coloring::Density.bar()),
        panels: snapshots.iter().enumerate().map(panel).collect(),
    }
}
