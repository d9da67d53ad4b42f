//! What a report keeps of a moment of its run, for a picture.

use engine::math::Vector;
use engine::simulation::Simulation;
use output::colors::ColorMap;
use output::drawing::Drawn;
use output::picture::{Coloring, Crowd, Picture};
use output::plot::{ColorBar, Print, Sheet};
use output::scenery;
use scenario::Scenario;

/// The agents at one moment: far less than the state of the run.
#[derive(Debug, Clone)]
pub struct Still {
    /// Seconds.
    pub time: f64,
    /// The number of agents that had left.
    pub left: usize,
    position: Vec<Vector>,
    radius: Vec<f32>,
    density: Vec<f32>,
    /// The numbers of the places that are closed.
    closed: Vec<usize>,
}

impl Still {
    /// The current frame, which must be evaluated with densities.
    pub fn of(simulation: &Simulation) -> Self {
        let frame = simulation.frame();
        let (agents, densities) = (frame.agents, &frame.fields.density);
        let present = || agents.present();
        let places = 0..simulation.scene().journeys.places.len();
        Self {
            time: frame.clock.time(),
            left: simulation.outcome().arrivals.len(),
            position: present().map(|i| agents.position[i]).collect(),
            radius: present().map(|i| agents.radius[i] as f32).collect(),
            density: present()
                .map(|i| densities.get(i).copied().unwrap_or(f64::NAN) as f32)
                .collect(),
            closed: places
                .filter(|&k| scenery::is_closed(simulation, k))
                .collect(),
        }
    }

    /// The number of agents.
    pub fn count(&self) -> usize {
        self.position.len()
    }

    /// The picture, with agents in the colors of their densities.
    pub fn sheet(&self, scenario: &Scenario, print: &Print) -> Sheet {
        let numbers = |values: &[f32]| values.iter().map(|&x| f64::from(x)).collect::<Vec<f64>>();
        let drawn = Drawn::of(scenario);
        let crowd = Crowd {
            time: self.time,
            id: (0..self.count() as i64).collect(),
            position: self.position.iter().map(|&p| drawn.place(p)).collect(),
            radius: numbers(&self.radius),
            mass: vec![1.0; self.count()],
            velocity: vec![None; self.count()],
        };
        let coloring = Coloring {
            values: numbers(&self.density),
            bar: bar(scenario),
        };
        let picture = Picture {
            coloring: Some(coloring),
            closed: &self.closed,
            ..Picture::of(&drawn, &crowd, String::new())
        };
        picture.sheet(print)
    }
}

/// The colors of densities.
pub fn bar(scenario: &Scenario) -> ColorBar {
    let range = scenario.view.density_range.map(|end| end as f32);
    ColorBar::new("SPH density [P/m²]", &ColorMap::viridis(range))
}
