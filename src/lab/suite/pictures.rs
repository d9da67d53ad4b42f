//! A picture of each case.

use super::keys::{Case, Moment};
use super::known::label;
use crate::error::LabError;
use crate::sweep::Cell;
use engine::simulation::{Fault, Simulation};
use output::drawing::Drawn;
use output::picture::{Crowd, Picture};
use output::plot::Print;
use runs::job::Listener;
use runs::parallel::side_by_side;
use runs::store::Store;

/// Draws a run of each case that asks for a picture, at one moment, with the first profile and seed: `NAME.png`.
pub fn save(
    cases: &[&Case],
    cells: &[&Cell],
    store: &Store,
    listener: &dyn Listener,
) -> Result<(), LabError> {
    let pictures = cases
        .iter()
        .filter_map(|case| Some((&case.name, case.picture.as_ref()?)));
    let drawn: Vec<(&String, &Moment)> = pictures.collect();
    listener.notes(&format!("drawing {} picture(s)", drawn.len()));
    side_by_side(drawn.len(), |k| {
        let (name, Moment { run, at_secs }) = drawn[k];
        let found = cells.iter().find(|cell| label(cell) == run);
        let cell = found.ok_or_else(|| LabError::missing(name, "run for its picture"))?;
        let failed = |error| LabError::of(run, error);
        let read = cell.case.scenario();
        let scenario = read.map_err(|error| LabError::of(run, error))?;
        let mut simulation = Simulation::new(scenario.scene.clone()).map_err(failed)?;
        go_to(*at_secs, &mut simulation).map_err(failed)?;
        let drawn = Drawn::of(&scenario);
        let crowd = Crowd::of(&simulation, drawn.drawing.as_ref());
        let picture = Picture {
            simulation: Some(&simulation),
            body_mass: scenario.mass_on_walls(),
            observed: &[],
            ..Picture::of(&drawn, &crowd, format!("{name}: {run}"))
        };
        let path = store.path(&format!("{name}.png"));
        picture.save(&path, &Print::of_program())?;
        Ok(())
    })
}

/// Advances to a time, seconds, and evaluates the frame.
fn go_to(at: f64, simulation: &mut Simulation) -> Result<(), Fault> {
    let last = simulation.frame().clock.frame_at(at);
    while simulation.frame().clock.frame() < last {
        simulation.step()?;
    }
    simulation.evaluate().map(|_| ())
}
