//! The highest density at each place of the floor over a run.

use super::still::bar;
use engine::math::Vector;
use engine::scene::Region;
use engine::simulation::Simulation;
use output::drawing::{Drawing, Drawn};
use output::picture::{Crowd, Field, Picture};
use output::plot::{Cells, Print, Sheet};
use scenario::Scenario;

/// The side of a cell, meters, and the most cells along a side of the map: larger floors have larger cells.
const CELL: f64 = 0.5;
const MOST: f64 = 800.0;

/// The highest SPH density at an agent in each cell so far, P/m²; 0 where no agent was.
pub struct Peaks {
    drawing: Option<Drawing>,
    /// Lower left corner, meters.
    min: Vector,
    /// The side of a cell, meters.
    pub cell: f64,
    columns: usize,
    most: Vec<f32>,
}

impl Peaks {
    /// A map of what pictures of the scenario show.
    pub fn new(scenario: &Scenario) -> Self {
        let Drawn { drawing, view, .. } = Drawn::of(scenario);
        let Region { min, max } = view;
        let cell = CELL.max((max - min).max() / MOST);
        let count = (max - min).map(|length| (length / cell).ceil().max(1.0));
        Self {
            drawing,
            min,
            cell,
            columns: count.x as usize,
            most: vec![0.0; (count.x * count.y) as usize],
        }
    }

    /// Adds the current frame, which must be evaluated with densities.
    pub fn add(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        for i in frame.agents.present() {
            let p = frame.agents.position[i];
            let place = self.drawing.as_ref().map_or(p, |drawing| drawing.place(p));
            let at = (place - self.min) / self.cell;
            let is_inside = at.x >= 0.0 && at.y >= 0.0 && at.x < self.columns as f64;
            let k = at.y as usize * self.columns + at.x as usize;
            let (density, cell) = (frame.fields.density.get(i), self.most.get_mut(k));
            if let (true, Some(&density), Some(cell)) = (is_inside, density, cell) {
                *cell = cell.max(density as f32);
            }
        }
    }

    /// The highest density of all, P/m²; `None` if no agent was there.
    pub fn highest(&self) -> Option<f64> {
        let most = self.most.iter().copied().fold(0.0, f32::max);
        (most > 0.0).then_some(f64::from(most))
    }

    /// The map.
    pub fn sheet(&self, scenario: &Scenario, print: &Print) -> Sheet {
        let bar = bar(scenario);
        let rows = self.most.len() / self.columns;
        let size = Vector::new(self.columns as f64, rows as f64) * self.cell;
        let values = self.most.iter().map(|&most| f64::from(most));
        let cells = Cells {
            extent: [self.min, self.min + size].map(Into::into),
            columns: self.columns,
            values: values.map(|most| (most > 0.0).then_some(most)).collect(),
            map: bar.map.clone(),
        };
        let crowd = Crowd::default();
        let drawn = Drawn::of(scenario);
        let picture = Picture {
            field: Some(Field { cells, bar }),
            heading: Some("highest density over the run".to_owned()),
            observed: &[],
            ..Picture::of(&drawn, &crowd, String::new())
        };
        picture.sheet(print)
    }
}
