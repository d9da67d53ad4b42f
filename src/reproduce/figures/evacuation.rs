//! Fig. 5: the room after 15 s, by density.

use super::{Coloring, Stage, letter};
use crate::math::Vector;
use crate::plot::Sheet;
use crate::reproduce::snapshot::Snapshot;
use crate::scene::{Region, Scene};

/// When the paper looks, seconds.
pub const AT_SECS: f64 = 15.0;

/// One panel: profile, and the one parameter that is set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Panel {
    /// The profile's name (§5.5).
    pub profile: &'static str,
    /// The setting's key and value; `None`: the profile as it is.
    pub setting: Option<(&'static str, f64)>,
}

/// (a)–(e) SF, (f) RVO, (g)–(l) SPH, (m)–(o) SF+SPH, (p)–(r) RVO+SPH, (s)–(u) SF→SPH, (v)–(x)
/// RVO→SPH. Which three ρ⁰max the paper's (m)–(r) have it does not say; here those of (s)–(x).
pub fn panels() -> Vec<Panel> {
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
    /// Its name in files.
    pub fn key(&self) -> String {
        match self.setting {
            Some((key, value)) => format!("{}-{key}-{value}", self.profile),
            None => self.profile.to_owned(),
        }
    }

    /// The scenario's settings.
    pub fn settings(&self) -> Vec<String> {
        let profile = format!("profile={}", self.profile);
        let setting = self.setting.map(|(key, value)| format!("{key}={value}"));
        std::iter::once(profile).chain(setting).collect()
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
pub fn sheet(scene: &Scene, snapshots: &[(Panel, Snapshot)]) -> Sheet {
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
        title: format!("Fig. 5: evacuation after {AT_SECS} s, coloured by density"),
        columns: 6,
        panel_size: stage.panel_size(132.0),
        shared_axes: true,
        row_titles: Vec::new(),
        bar: Some(Coloring::Density.bar()),
        panels: snapshots.iter().enumerate().map(panel).collect(),
    }
}
