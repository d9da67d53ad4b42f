//! The content of a page beside its frames.

use crate::recording::force_terms;
use crate::scenery;
use crate::series::{self, CROWD, Count};
use engine::math::Vector;
use engine::scene::{Group, Scene};
use figures::colors::Rgb;

/// The plots of the first time series of [`CROWD`]; a page has neither energies nor computing times.
const PLOTS: [&str; 5] = [
    "People",
    "People",
    "Density [P/m²]",
    "Density [P/m²]",
    "Speed [m/s]",
];
const WAITING: Rgb = [230, 159, 0];

/// The content of a page beside its frames.
#[derive(Debug, Clone, Default)]
pub struct PageOptions {
    /// Its title.
    pub title: String,
    /// A description in a sentence; may be empty.
    pub description: String,
    /// The densities with the first and the last color, P/m².
    pub density_range: [f64; 2],
    /// The speeds with the first and the last color, m/s.
    pub speed_range: [f64; 2],
    /// The time that it shows first, seconds; `None`: the first frame.
    pub opens_at: Option<f64>,
    /// Whether it gets the Rerun viewer, see [`Page::embed`](super::Page::embed).
    pub has_viewer: bool,
    /// The person that it follows first.
    pub follows: Option<u32>,
    /// The groups of people: name, profile, and journey or nothing.
    pub groups: Vec<[String; 3]>,
    /// The names of the places to which people walk.
    pub places: Vec<String>,
    /// The floors behind exits and entrances, where agents are not counted: the name and the corners.
    pub behind: Vec<(String, Vec<Vector>)>,
    /// Whether journeys have several stages, by which people can be colored.
    pub has_stages: bool,
    /// The names and colors of the terms of accelerations, the sum first; empty without forces.
    pub terms: Vec<(String, Rgb)>,
    /// The time series: plot, name and color.
    pub series: Vec<(String, String, Rgb)>,
}

impl PageOptions {
    /// A page of people of whom only positions, speeds and densities are known.
    pub fn watched() -> Self {
        let series = CROWD.iter().zip(PLOTS).map(|((_, name, color), plot)| {
            let name = name.split_once(" [").map_or(*name, |(name, _)| name);
            (plot.to_owned(), name.to_owned(), *color)
        });
        Self {
            series: series.collect(),
            ..Self::default()
        }
    }

    /// A page of a run in a scene.
    pub fn of(scene: &Scene, has_forces: bool) -> Self {
        let mut page = Self::watched();
        let waiting = series::waiting(scene);
        page.series
            .extend(waiting.map(|name| ("People".to_owned(), name, WAITING)));
        page.series
            .extend(series::of_places(scene).map(|(number, _, count)| {
                let (name, color) = series::look(scene, number);
                let plot = match count {
                    Count::Present => "Waiting areas and queues",
                    Count::Passed => "Passed exits",
                };
                (plot.to_owned(), name, color)
            }));
        let group = |group: &Group| {
            let number = group.journey.map(usize::from);
            let found = number.and_then(|k| scene.journeys.journeys.get(k));
            let journey = found.map(|journey| journey.name.clone());
            [
                group.name.clone(),
                group.blend.name.clone(),
                journey.unwrap_or_default(),
            ]
        };
        let places = scene.journeys.places.iter();
        Self {
            groups: scene.groups.iter().map(group).collect(),
            places: places
                .map(|place| scenery::named(place.kind.name(), &place.name))
                .collect(),
            behind: behind(scene),
            has_stages: scenery::has_stages(scene),
            terms: if has_forces {
                force_terms(scene)
            } else {
                Vec::new()
            },
            ..page
        }
    }
}

/// The floors behind exits and entrances, each with the name of the nearest line. None in a building, whose levels lie
/// elsewhere on a page.
fn behind(scene: &Scene) -> Vec<(String, Vec<Vector>)> {
    if scene.levels.is_some() {
        return Vec::new();
    }
    let places = scene.journeys.places.iter();
    let exits = places.filter(|place| place.is_exit());
    let exits = exits.filter_map(|place| Some((&place.name, place.line()?)));
    let entrances = scene.entrances.iter().map(|one| (&one.name, one.line));
    let lines: Vec<(&String, [Vector; 2])> = exits.chain(entrances).collect();
    let away = |area: &[Vector], line: &[Vector; 2]| -> f64 {
        let to = |end: &Vector| {
            area.iter()
                .map(|p| (p - end).norm())
                .fold(f64::MAX, f64::min)
        };
        line.iter().map(to).sum()
    };
    let named = |area: &Vec<Vector>| {
        let nearest = |a: &&(&String, [Vector; 2]), b: &&(&String, [Vector; 2])| {
            away(area, &a.1).total_cmp(&away(area, &b.1))
        };
        let (name, _) = lines.iter().min_by(nearest)?;
        Some(((*name).clone(), area.clone()))
    };
    scene.behind.iter().filter_map(named).collect()
}
