//! Fundamental diagrams: density, speed and flow in a region, per person and per frame, for several densities side by
//! side.

use std::collections::BTreeMap;

use serde::Serialize;

use super::Moment;
use analysis::statistics::MeanStd;
use engine::scene::Region;

/// Width of a density class, P/m².
pub const CLASS: f64 = 0.5;

/// The definitions of density.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Density {
    /// SPH density at people, without the person's own weight.
    SphAtPeople,
    /// Mean of the SPH field over a region.
    SphField,
    /// People in a region / its area.
    Classic,
    /// For a person: 1 / the area of its Voronoi cell. For a region: the mean of this density over its area.
    Voronoi,
}

impl Density {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::SphAtPeople,
        Self::SphField,
        Self::Classic,
        Self::Voronoi,
    ];

    /// The name in files.
    pub fn key(self) -> &'static str {
        self.names()[0]
    }

    /// The name in texts and pictures.
    pub fn name(self) -> &'static str {
        self.names()[1]
    }

    fn names(self) -> [&'static str; 2] {
        match self {
            Self::SphAtPeople => ["sph_at_people", "SPH at people"],
            Self::SphField => ["sph_field", "SPH field mean"],
            Self::Classic => ["classic", "classic"],
            Self::Voronoi => ["voronoi", "Voronoi"],
        }
    }
}

/// The people of a region in a frame. Without a region, the densities of regions are unknown.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FrameMean {
    /// Number of the region, from 1 in the given order.
    pub region: usize,
    /// The frame.
    pub frame: i64,
    /// Time of the frame, seconds.
    pub time: f64,
    /// Number of people in the region.
    pub people: usize,
    /// Mean of their SPH densities without their own weights, P/m²; `None` without people.
    pub sph_at_people: Option<f64>,
    /// Mean of the SPH field over the region, P/m².
    pub sph_field: Option<f64>,
    /// People / area, P/m².
    pub classic: Option<f64>,
    /// Voronoi density, P/m².
    pub voronoi: Option<f64>,
    /// The part of the region that Voronoi cells cover.
    pub voronoi_covered: Option<f64>,
    /// Mean of the known speeds of the people in the region, m/s.
    pub speed: Option<f64>,
    /// Voronoi speed, m/s.
    pub voronoi_speed: Option<f64>,
}

impl FrameMean {
    /// The density, P/m².
    pub fn density(&self, density: Density) -> Option<f64> {
        match density {
            Density::SphAtPeople => self.sph_at_people,
            Density::SphField => self.sph_field,
            Density::Classic => self.classic,
            Density::Voronoi => self.voronoi,
        }
    }

    /// The speed that belongs to a density, m/s: the Voronoi speed, or the mean speed of the people.
    pub fn speed(&self, density: Density) -> Option<f64> {
        match density {
            Density::Voronoi => self.voronoi_speed,
            _ => self.speed,
        }
    }

    /// Density times speed, P/(m s).
    pub fn flow(&self, density: Density) -> Option<f64> {
        Some(self.density(density)? * self.speed(density)?)
    }
}

/// Density, speed and flow of people or frames.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Class {
    /// P/m².
    pub density: MeanStd,
    /// m/s.
    pub speed: MeanStd,
    /// ρ v of each, P/(m s).
    pub flow: MeanStd,
}

/// Classes by number: class k begins at k times [`CLASS`]. Empty classes are absent.
pub type Classes = BTreeMap<usize, Class>;

/// The results for one region.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Diagram {
    /// The region; `None` for everywhere.
    pub region: Option<Region>,
    /// The walkable area of the region, m².
    pub walkable: Option<f64>,
    /// Frame by frame; frames without people anywhere are absent.
    pub frames: Vec<FrameMean>,
    /// Classes of the people in single frames, by their [`Density::SphAtPeople`] and [`Density::Voronoi`].
    pub of_persons: BTreeMap<Density, Classes>,
    /// Classes of frames, by each density.
    pub of_frames: BTreeMap<Density, Classes>,
}

impl Diagram {
    /// Adds a frame; `number` is that of the region.
    pub fn add(&mut self, number: usize, moment: &Moment) {
        let is_there = |p| self.region.is_none_or(|region| region.contains(p));
        let there = moment.people.iter();
        let (mut density, mut speed, mut people) = (MeanStd::default(), MeanStd::default(), 0);
        for person in there.filter(|person| is_there(person.position)) {
            people += 1;
            density.add(person.density_of_others);
            let Some(velocity) = person.velocity else {
                continue;
            };
            speed.add(velocity.norm());
            let of = [
                (Density::SphAtPeople, Some(person.density_of_others)),
                (Density::Voronoi, person.voronoi),
            ];
            for (kind, density) in of {
                if let Some(density) = density {
                    add(&mut self.of_persons, kind, [density, velocity.norm()]);
                }
            }
        }
        let known = |of: &MeanStd| (of.count > 0).then_some(of.mean);
        let state = self.region.and(moment.regions.get(number - 1));
        let frame = FrameMean {
            region: number,
            frame: moment.frame,
            time: moment.time,
            people,
            sph_at_people: known(&density),
            sph_field: state.map(|state| state.sph_field),
            classic: state.map(|state| state.classic),
            voronoi: state.map(|state| state.voronoi),
            voronoi_covered: state.map(|state| state.voronoi_covered),
            speed: known(&speed),
            voronoi_speed: state.and_then(|state| state.voronoi_speed),
        };
        for kind in Density::ALL {
            if let (Some(density), Some(speed)) = (frame.density(kind), frame.speed(kind)) {
                add(&mut self.of_frames, kind, [density, speed]);
            }
        }
        self.frames.push(frame);
    }

    /// The classes by a density, and the word for what they consist of: the rows of the file (people in single frames)
    /// for the density at people, and for the Voronoi density without a region; else frames.
    pub fn classes(&self, kind: Density) -> Option<(&'static str, &Classes)> {
        let of_rows = match kind {
            Density::SphAtPeople => true,
            Density::Voronoi => self.region.is_none(),
            _ => false,
        };
        match of_rows {
            true => Some(("rows", self.of_persons.get(&kind)?)),
            false => Some(("frames", self.of_frames.get(&kind)?)),
        }
    }

    /// Mean density, speed and flow over `count` frames, of which those that are absent have no people: their density
    /// and flow are 0, and their speed is unknown. The density at people is a mean over frames with people. `None`
    /// without a region for densities of regions.
    pub fn means(&self, kind: Density, count: u64) -> Option<Class> {
        let mut means = Class::default();
        let is_at_people = kind == Density::SphAtPeople;
        for frame in &self.frames {
            if let Some(density) = frame.density(kind) {
                means.density.add(density);
                let known = frame.flow(kind);
                // People whose speeds are unknown have an unknown flow; where there are none, the flow is 0.
                let flow = known.or((frame.people == 0).then_some(0.0));
                flow.into_iter().for_each(|flow| means.flow.add(flow));
            }
            if let Some(speed) = frame.speed(kind) {
                means.speed.add(speed);
            }
        }
        if !is_at_people {
            self.region?;
            for _ in self.frames.len() as u64..count {
                means.density.add(0.0);
                means.flow.add(0.0);
            }
        }
        Some(means)
    }
}

/// Adds a person or a frame to its class.
fn add(classes: &mut BTreeMap<Density, Classes>, kind: Density, [density, speed]: [f64; 2]) {
    let classes = classes.entry(kind).or_default();
    let class = classes.entry((density / CLASS) as usize).or_default();
    class.density.add(density);
    class.speed.add(speed);
    class.flow.add(density * speed);
}
