//! The picture: cost over the number of agents.

use sandbox::lab::gallery::{around, color, distinct, medians};
use sandbox::output::plot::{Axis, Corner, GRAY, Mark, Panel, Sheet, Style};

use super::DENSITY;
use super::race::Row;
use super::setting::Family;

/// One panel for social forces and one for the other models, with one curve per engine and setting: those on one
/// thread that are measured at several sizes.
pub fn picture(rows: &[Row]) -> Sheet {
    let is_social = |row: &&Row| row.description.family == Family::SocialForce;
    let several = |row: &&Row| {
        let own = rows
            .iter()
            .filter(|other| other.description == row.description);
        own.count() > 1
    };
    let (social, other): (Vec<&Row>, Vec<&Row>) = rows.iter().filter(several).partition(is_social);
    let costs = social
        .iter()
        .chain(&other)
        .map(|row| row.ms_per_simulated_second);
    let costs = costs.flat_map(|range| [1e-3 * range.minimum, 1e-3 * range.maximum]);
    let agents = rows.iter().map(|row| f64::from(row.agents));
    let x = Axis::log("agents", around(agents, 1.3));
    let y = Axis::log(
        "computing time per simulated second [s]",
        around(costs, 1.5),
    );
    let panel = |title: &str, rows: &[&Row]| {
        let real_time = Style::broken(GRAY, 0.8, "real time");
        let mut marks = vec![Mark::line(x.range.map(|agents| [agents, 1.0]), real_time)];
        marks.extend(curves(rows));
        Panel::new(title, x.clone(), y.clone(), marks).with_legend(Corner::LowerRight)
    };
    let title = format!("Cost of crowds at {DENSITY} P/m², one thread");
    let panels = vec![
        panel("Social forces", &social),
        panel("Velocity obstacles and speed models", &other),
    ];
    Sheet::new(&title, 1, [460.0, 260.0], panels)
}

fn curves(rows: &[&Row]) -> Vec<Mark> {
    let settings = distinct(rows.iter().map(|row| &row.description));
    let marks = settings.into_iter().enumerate().flat_map(|(k, of)| {
        let own = rows.iter().filter(|row| row.description == *of);
        let point = |row: &&Row| {
            (
                f64::from(row.agents),
                row.ms_per_simulated_second.times(1e-3),
            )
        };
        let mut points: Vec<_> = own.map(point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let name = of.engine.split(" (").next().unwrap_or_default();
        let label = format!("{name}, {}, {} m", of.model, of.radius);
        medians(&points, color(k), &label)
    });
    marks.collect()
}
