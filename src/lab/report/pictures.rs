//! Pictures of a run at named times.

use crate::engine::scene::Region;
use crate::engine::simulation::{Fault, Simulation};
use crate::output::colors::ColorMap;
use crate::output::picture::{Coloring, Crowd, Picture};
use crate::output::plot::{ColorBar, Print, Sheet};
use crate::runs::summary::Summary;
use crate::scenario::Scenario;
use crate::scenario::floor_plan::Label;
use crate::scenario::measurements::Observed;

/// The times of pictures if none are named, seconds: the start, the highest density, and when half of the agents had
/// left; else the middle of the run.
pub fn moments(run: &Summary) -> Vec<f64> {
    let highest = run.highest_density.map(|highest| highest.at_secs);
    let mut times: Vec<f64> = [Some(0.0), highest, run.t50_secs]
        .into_iter()
        .flatten()
        .collect();
    if times.len() == 1 {
        times.push(0.5 * run.time_secs);
    }
    times.sort_by(f64::total_cmp);
    times.dedup_by(|one, other| (*one - *other).abs() < 1.0);
    times
}

/// Pictures of a scenario at these ascending times, seconds, with agents in the colors of their densities. Times at
/// which no agent is left are left out. `show` shows the progress.
///
/// # Errors
/// The simulation fails.
pub fn pictures(
    scenario: &Scenario,
    times: &[f64],
    print: &Print,
    show: impl Fn(&Simulation),
) -> Result<Vec<(f64, Sheet)>, Fault> {
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    let measurements = scenario.measurements.iter();
    let observed: Vec<(String, Observed)> = measurements.flat_map(|one| one.observed()).collect();
    let range = scenario.view.density_range.map(|end| end as f32);
    let bar = ColorBar::new("SPH density [P/m²]", &ColorMap::viridis(range));
    let mut sheets = Vec::new();
    for &time in times {
        let frame = simulation.frame().clock.frame_at(time);
        while simulation.frame().clock.frame() < frame {
            show(&simulation);
            simulation.step()?;
        }
        simulation.evaluate_with_density()?;
        let crowd = Crowd::of(&simulation);
        if crowd.is_empty() && time > 0.0 {
            continue;
        }
        let densities = &simulation.frame().fields.density;
        let present = simulation.frame().agents.present();
        let coloring = Coloring {
            values: present.map(|i| densities[i]).collect(),
            bar: bar.clone(),
        };
        let view: Region = scenario.view.region;
        let labels: &[Label] = &scenario.labels;
        let picture = Picture {
            coloring: Some(coloring),
            observed: &observed,
            labels,
            ..Picture::of(&simulation, &crowd, String::new(), view)
        };
        sheets.push((simulation.frame().clock.time(), picture.sheet(print)));
    }
    Ok(sheets)
}
