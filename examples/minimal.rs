//! Uses the engine as a library: builds a scene, runs it, reads densities.

use sandbox::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A pillar 1 m before the goal, and 100 people walking to that goal.
    let corners = [[11.0, 4.0], [12.0, 4.0], [12.0, 6.0], [11.0, 6.0]];
    let pillar = Polygon::new(corners.map(Vector::from).to_vec())?;
    let mut scene = Scene::with_obstacles(vec![pillar]);
    let group = scene.add_group(Group {
        removal_radius: Some(0.5),
        ..Group::new("visitors", catalog::named("sph", &Parameters::default())?)
    });
    let grid = Grid {
        min: Vector::new(0.0, 0.0),
        max: Vector::new(10.0, 10.0),
        columns: 10,
        rows: 10,
        jitter: 0.1,
    };
    let goal = Vector::new(13.0, 5.0);
    let places = grid.positions(scene.seed, 0);
    scene.agents = places
        .map(|place| NewAgent::at(place, goal, group))
        .collect();

    let mut simulation = Simulation::new(scene)?;
    while simulation.frame().clock.time() < 10.0 {
        simulation.evaluate()?;
        let frame = simulation.frame();
        if frame.clock.frame().is_multiple_of(50) {
            let densest = frame.fields.density.iter().copied().fold(0.0, f64::max);
            println!("{:4.1} s: {densest:.2} P/m² at most", frame.clock.time());
        }
        simulation.integrate()?;
    }
    println!("{} arrived", simulation.outcome().arrivals.len());
    Ok(())
}
