//! The source of pictures and pages of a crowd: a simulation, a trajectory file, or a recording.

pub mod recorded;
pub mod tracked;

use crate::cli::failure::Failure;
use engine::boundary::WallMethod;
use engine::math::Vector;
use engine::scene::{Region, Scene};
use engine::simulation::Simulation;
use lab::measure::{Behind, Kernel, MOST_HIDDEN, Site, parts};
use output::colors::{DENSITY_RANGE, SPEED_RANGE};
use output::drawing::{Drawing, Drawn};
use output::picture::Crowd;
use scenario::Scenario;
use scenario::floor_plan::{Label, Place};
use scenario::measurements::Observed;

/// The names of quantities that every crowd has.
const ALWAYS: [&str; 3] = ["density", "speed", "radius"];
/// Margin around walls and people, meters.
const MARGIN: f64 = 1.0;

/// The crowd at the moments of a run.
pub trait Frames: Send {
    /// Walls and places.
    fn scene(&self) -> &Scene;

    /// The simulation, if there is one. Its agents are those of [`crowd`](Self::crowd), in the same order.
    fn simulation(&self) -> Option<&Simulation> {
        None
    }

    /// The times of all frames, seconds, ascending, if they are known.
    fn times(&self) -> &[f64] {
        &[]
    }

    /// Goes to the frame nearest to a time, seconds, not before the current frame.
    fn go_to(&mut self, time: f64) -> Result<(), Failure>;

    /// The crowd in the current frame.
    fn crowd(&self) -> &Crowd;

    /// The names of the quantities of which the current frame has values.
    fn columns(&self) -> Vec<String>;

    /// The values of a quantity in the current frame, NaN where unknown; `None`: there is no such quantity.
    fn column(&self, name: &str) -> Result<Option<Vec<f64>>, Failure>;
}

/// A run to draw.
pub struct Run {
    pub frames: Box<dyn Frames>,
    /// Its title in pictures.
    pub title: String,
    /// The part of the plane to show.
    pub view: Region,
    /// The densities with the first and the last color, P/m².
    pub density_range: [f64; 2],
    /// The speeds with the first and the last color, m/s.
    pub speed_range: [f64; 2],
    /// The support radius of the kernel, meters.
    pub support_radius: f64,
    /// How the levels of a building lie.
    pub drawing: Option<Drawing>,
    /// The places that its measurements observe.
    pub observed: Vec<(String, Observed)>,
    /// What its floor plan names.
    pub places: Vec<Place>,
    /// Texts.
    pub labels: Vec<Label>,
    /// The mass of an average person, kg, if forces on walls are measured.
    pub body_mass: Option<f64>,
    /// The times of the first and the last frame, seconds, if they are known.
    pub times: Option<[f64; 2]>,
    /// The scenario and the report in JSON, if a file has them.
    pub scenario: Option<Scenario>,
    /// See [`scenario`](Self::scenario).
    pub report: Option<String>,
}

impl Run {
    /// A run of a scenario as it is drawn, with its ranges and places.
    pub fn of(scenario: &Scenario, drawn: Drawn, frames: Box<dyn Frames>) -> Self {
        Self {
            title: scenario.name.clone(),
            view: drawn.view,
            drawing: drawn.drawing,
            density_range: scenario.view.density_range,
            speed_range: scenario.view.speed_range,
            support_radius: support_radius(frames.scene()),
            observed: drawn.observed,
            labels: drawn.labels,
            places: scenario.places.clone(),
            body_mass: None,
            times: None,
            scenario: None,
            report: None,
            frames,
        }
    }

    /// A run without a scenario, of which the picture shows these points.
    pub fn around(points: impl Iterator<Item = Vector>, frames: Box<dyn Frames>) -> Self {
        let [low, high] = engine::math::bounds(points).unwrap_or_default();
        let margin = Vector::repeat(MARGIN);
        Self {
            title: String::new(),
            view: Region {
                min: low - margin,
                max: high + margin,
            },
            density_range: [0.0, DENSITY_RANGE.into()],
            speed_range: [0.0, SPEED_RANGE.into()],
            support_radius: support_radius(frames.scene()),
            drawing: None,
            observed: Vec::new(),
            labels: Vec::new(),
            places: Vec::new(),
            body_mass: None,
            times: None,
            scenario: None,
            report: None,
            frames,
        }
    }
}

/// A problem of `--level`.
pub fn of_level(problem: String) -> Failure {
    Failure::Input(format!("--level: {problem}"))
}

/// The largest support radius of all groups, meters; that of §5.6 without groups.
fn support_radius(scene: &Scene) -> f64 {
    let groups = scene.groups.iter();
    let radii = groups.map(|group| group.blend.sph.support_radius);
    radii.reduce(f64::max).unwrap_or(1.0)
}

/// The frames of a file.
pub trait Film: Send {
    /// The crowd in frame `k`.
    fn crowd(&self, k: usize) -> Crowd;

    /// The names of its own quantities.
    fn names(&self) -> Vec<&str>;

    /// The values of one of them in frame `k`.
    fn values(&self, k: usize, name: &str) -> Result<Option<Vec<f64>>, Failure>;
}

/// A run that is over.
pub struct Over<F> {
    film: F,
    /// The times of its frames, seconds, ascending.
    times: Vec<f64>,
    scene: Scene,
    site: Site,
    /// The number of the current frame.
    current: usize,
    crowd: Crowd,
}

impl<F: Film> Over<F> {
    /// The frames of a file at these times.
    pub fn new(film: F, times: Vec<f64>, scene: Scene) -> Self {
        Self {
            crowd: film.crowd(0),
            film,
            times,
            site: Site::new(scene.walls.obstacles().to_vec()),
            scene,
            current: 0,
        }
    }
}

impl<F: Film> Frames for Over<F> {
    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn go_to(&mut self, time: f64) -> Result<(), Failure> {
        let away = |k: &usize| (self.times[*k] - time).abs();
        let after = self.times.partition_point(|&own| own < time);
        let near = after.saturating_sub(1)..(after + 1).min(self.times.len());
        self.current = near.min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0);
        self.crowd = self.film.crowd(self.current);
        Ok(())
    }

    fn times(&self) -> &[f64] {
        &self.times
    }

    fn crowd(&self) -> &Crowd {
        &self.crowd
    }

    fn columns(&self) -> Vec<String> {
        let names = self.film.names().into_iter();
        let own = names.filter(|name| !ALWAYS.contains(name));
        ALWAYS.into_iter().chain(own).map(str::to_owned).collect()
    }

    fn column(&self, name: &str) -> Result<Option<Vec<f64>>, Failure> {
        let of_all = self.film.values(self.current, name)?;
        let own = of_all.filter(|values| values.len() == self.crowd.len());
        Ok(own.or_else(|| match name {
            "density" => {
                let kernel = kernel(support_radius(&self.scene));
                Some(densities(&self.crowd, &self.site, &kernel))
            }
            "speed" => Some(speeds(&self.crowd)),
            "radius" => Some(self.crowd.radius.clone()),
            _ => None,
        }))
    }
}

/// The speeds of a crowd, m/s.
pub fn speeds(crowd: &Crowd) -> Vec<f64> {
    let speeds = crowd.velocity.iter();
    speeds
        .map(|velocity| velocity.map_or(f64::NAN, |velocity| velocity.norm()))
        .collect()
}

/// The kernel with which densities are computed where a run has none.
pub fn kernel(support_radius: f64) -> Kernel {
    Kernel {
        support_radius,
        walls: WallMethod::Union,
    }
}

/// The SPH density of each person (§8), P/m².
fn densities(crowd: &Crowd, site: &Site, kernel: &Kernel) -> Vec<f64> {
    let parts = parts(site, &crowd.position, &crowd.mass, (kernel, Behind::Same));
    let density = parts.into_iter().map(|part| {
        let seen = 1.0 - part.hidden.share.min(MOST_HIDDEN);
        part.from_people / seen
    });
    density.collect()
}
