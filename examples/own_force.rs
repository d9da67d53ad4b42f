//! Adds a force of its own to the engine: a slope, on which agents slow down while they walk up.

use std::sync::Arc;

use sandbox::prelude::*;

/// Ground that rises along x between two places.
#[derive(Debug)]
struct Slope {
    /// Where it begins and ends, meters.
    x: [f64; 2],
    /// Rise over run.
    grade: f64,
}

impl Force for Slope {
    fn name(&self) -> &str {
        "slope"
    }

    // The slope pushes equally at all places on it and at all velocities: it does not limit the time step.
    fn rates(&self, _: &Extremes) -> Rates {
        Rates::default()
    }

    fn acceleration(&self, frame: &Frame, i: usize) -> Vector {
        let x = frame.agents.position[i].x;
        let is_on_it = (self.x[0]..self.x[1]).contains(&x);
        // A tenth of gravity along the ground: legs carry the rest.
        let downhill = if is_on_it { -0.981 * self.grade } else { 0.0 };
        Vector::new(downhill, 0.0)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut scene = Scene::default();
    let group = scene.add_group(Group {
        removal_radius: Some(0.5),
        ..Group::new("walkers", catalog::named("sph", &Parameters::default())?)
    });
    let goal = Vector::new(30.0, 0.0);
    scene.agents = vec![NewAgent::at(Vector::zeros(), goal, group)];
    scene.own_forces.push(Arc::new(Slope {
        x: [10.0, 20.0],
        grade: 0.5,
    }));
    let mut simulation = Simulation::new(scene)?;
    while simulation.outcome().arrivals.is_empty() {
        let frame = simulation.evaluate()?;
        if frame.clock.frame().is_multiple_of(200) {
            let (position, velocity) = (frame.agents.position[0], frame.agents.velocity[0]);
            println!("x = {:5.2} m, {:.2} m/s", position.x, velocity.norm());
        }
        if frame.clock.frame() == 500 {
            let breakdown = Breakdown::of(&simulation, 0).ok_or("no density")?;
            print!("{breakdown}");
        }
        simulation.integrate()?;
    }
    Ok(())
}
