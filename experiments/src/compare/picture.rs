//! The picture: cost over the number of agents.

use sandbox::lab::bench::pictures::{around, color, curve};
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
    let x = Axis::log(
        "agents",
        around(rows.iter().map(|row| f64::from(row.agents)), 1.3),
    );
    let y = Axis::log(
        "computing time per simulated second [s]",
        around(costs, 1.5),
    );
    let panel = |title: &str, rows: &[&Row]| {
        let mut marks = vec![Mark::Line(
            vec![[x.range[0], 1.0], [x.range[1], 1.0]],
            Style::broken(GRAY, 0.8, "real time"),
        )];
        marks.extend(curves(rows));
        let mut panel = Panel::new(title, x.clone(), y.clone(), marks);
        panel.legend = Some(Corner::LowerRight);
        panel
    };
    Sheet {
        title: format!("Cost of crowds at {DENSITY} P/m², one thread"),
        columns: 1,
        panel_size: [460.0, 260.0],
        panels: vec![
            panel("Social forces", &social),
            panel("Velocity obstacles and speed models", &other),
        ],
        ..Sheet::default()
    }
}

fn curves(rows: &[&Row]) -> Vec<Mark> {
    let mut settings: Vec<&Row> = Vec::new();
    for row in rows {
        if settings
            .iter()
            .all(|known| known.description != row.description)
        {
            settings.push(row);
        }
    }
    let marks = settings.iter().enumerate().flat_map(|(k, setting)| {
        let of = &setting.description;
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
        curve(&points, color(k), &label)
    });
    marks.collect()
}
