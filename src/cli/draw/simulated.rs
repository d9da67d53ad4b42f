//! Frames of a simulation.

use crate::cli::failure::Failure;
use crate::cli::frames::{Frames, Run, speeds};
use crate::cli::moment;
use crate::cli::watch::Progress;
use engine::scene::Scene;
use engine::simulation::Simulation;
use output::drawing::{Drawing, Drawn};
use output::picture::Crowd;
use scenario::Scenario;

/// The value of agent `i` in an evaluated frame.
type Value = fn(&Simulation, usize) -> f64;

/// All quantities but the speed.
const COLUMNS: [(&str, Value); 12] = [
    ("density", |s, i| s.frame().fields.density[i]),
    ("pressure", |s, i| s.frame().fields.pressure[i]),
    ("rest_density", |s, i| s.frame().fields.rest_density[i]),
    ("mean_density", |s, i| s.frame().fields.mean_density[i]),
    ("density_from_walls", |s, i| {
        s.frame().fields.density_from_walls[i]
    }),
    ("acceleration", |s, i| {
        s.frame().fields.acceleration[i].norm()
    }),
    ("radius", |s, i| s.frame().agents.radius[i]),
    ("mass", |s, i| s.frame().agents.mass[i]),
    ("preferred_speed", |s, i| {
        let own = s.frame().agents.preferred_speed.get(i).copied();
        own.unwrap_or(s.scene().preferred_speed)
    }),
    ("max_speed", |s, i| s.scene().max_speed(s.frame().agents, i)),
    ("group", |s, i| f64::from(s.frame().agents.group[i])),
    ("id", |s, i| f64::from(s.frame().agents.id[i])),
];

struct Simulated {
    simulation: Simulation,
    /// The scene and the crowd as they are drawn.
    scene: Scene,
    drawing: Option<Drawing>,
    crowd: Crowd,
    progress: Progress,
    /// The option that asks for the time at which agents must be left.
    option: String,
    until: f64,
}

/// The run of a scenario until a time, seconds, which `option` asks for.
pub fn open(
    scenario: &Scenario,
    drawing: Option<Drawing>,
    (until, option): (f64, String),
) -> Result<Run, Failure> {
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    let last = simulation.frame().clock.frame_at(until);
    simulation.request_density_until(last + 1);
    simulation.evaluate()?;
    let drawn = Drawn::with(scenario, drawing);
    let frames = Simulated {
        crowd: Crowd::of(&simulation, drawn.drawing.as_ref()),
        scene: drawn.scene.clone().into_owned(),
        drawing: drawn.drawing.clone(),
        simulation,
        progress: Progress::new(until),
        option,
        until,
    };
    Ok(Run {
        body_mass: scenario.mass_on_walls(),
        ..Run::of(scenario, drawn, Box::new(frames))
    })
}

impl Frames for Simulated {
    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn simulation(&self) -> Option<&Simulation> {
        Some(&self.simulation)
    }

    fn go_to(&mut self, time: f64) -> Result<(), Failure> {
        let simulation = &mut self.simulation;
        let by = (self.option.as_str(), &self.progress);
        moment::advance(simulation, time.min(self.until), by)?;
        simulation.evaluate()?;
        self.crowd = Crowd::of(simulation, self.drawing.as_ref());
        Ok(())
    }

    fn crowd(&self) -> &Crowd {
        &self.crowd
    }

    fn columns(&self) -> Vec<String> {
        let names = COLUMNS.iter().map(|(name, _)| *name);
        names.chain(["speed"]).map(str::to_owned).collect()
    }

    fn column(&self, name: &str) -> Result<Option<Vec<f64>>, Failure> {
        if name == "speed" {
            return Ok(Some(speeds(&self.crowd)));
        }
        let of = COLUMNS.iter().find(|(own, _)| *own == name);
        let present = self.simulation.frame().agents.present();
        Ok(of.map(|(_, value)| present.map(|i| value(&self.simulation, i)).collect()))
    }
}
