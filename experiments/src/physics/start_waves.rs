//! The speed at which a start runs back through a waiting crowd.

use super::{first, found, front_speed, grouped, mean, profile};
use sandbox::lab::gallery::points;
use sandbox::lab::reproduce::{Needs, Product};
use sandbox::lab::sweep::Combination;
use sandbox::output::plot::{Axis, BLACK, Corner, GRAY, Mark, Panel, Sheet, Style, line_color};
use sandbox::output::table::Table;
use sandbox::scenario::measurements::FrontData;

/// The length that people wait on, meters.
const LENGTH: f64 = 30.0;
/// The time at which they may go, seconds.
const RELEASED: f64 = 5.0;
/// The speed of velocity waves in start corrals of marathons (Bain and Bartolo 2019), m/s.
const MEASURED: f64 = 1.2;

/// The tables of its study.
const TABLES: [&str; 2] = ["start_waves", "start_waves-summary"];

/// The table, the start times and the speeds.
pub const PRODUCT: Product = Product {
    name: "start-waves",
    about: "open question: how fast does a start run back through a crowd?",
    in_all: false,
    studies: &["start_waves"],
    needs: Needs::All,
    tables: &TABLES,
    has_figure: true,
    find: |product, studies| found(product, studies, table, sheet),
};

/// The distance between people along the corridor, meters.
fn spacing(row: &Combination) -> Option<f64> {
    let columns = row.value("grids.0.columns")?.as_f64()?;
    Some(LENGTH / columns)
}

/// T of the headway law, seconds, if the profile gives it.
fn headway_time(row: &Combination) -> Option<f64> {
    let parameters = row.value("profile")?.get("parameters")?;
    parameters.get("headway_time")?.as_f64()
}

/// Spacing over T, m/s.
fn expected(row: &Combination) -> Option<f64> {
    Some(spacing(row)? / headway_time(row)?)
}

fn table(rows: &[Combination]) -> Table {
    let value =
        |what: &str, row: &Combination| mean(row, &format!("front_{what}")).map(|of| of.mean);
    Table::of(rows)
        .column("crowd", |row| row.label().to_owned())
        .column("profile", profile)
        .fixed("spacing [m]", 2, spacing)
        .fixed("spacing / T [m/s]", 3, expected)
        .fixed("front [m/s]", 3, front_speed)
        .fixed("in space [m/s]", 2, |row| {
            value("speed_in_space_m_per_s", row)
        })
        .fixed("slowness [s/m]", 3, |row| value("slowness_s_per_m", row))
        .table()
}

/// Start times over places for each profile, then front speeds over spacings.
fn sheet(rows: &[Combination]) -> Sheet {
    let groups = grouped(rows, profile);
    let panels = groups.iter().map(|(name, rows)| times(name, rows));
    let mut panels: Vec<Panel> = panels.collect();
    let latest = panels.iter().map(|panel| panel.y.range[1]);
    let latest = latest.fold(0.0, f64::max);
    for panel in &mut panels {
        panel.y.range[1] = latest;
    }
    if let Some(first) = panels.first_mut() {
        first.legend = Some(Corner::UpperLeft);
    }
    panels.push(fronts(rows));
    let title = "A start runs back through a waiting crowd";
    Sheet::new(title, 2, [250.0, 190.0], panels)
}

/// Dots at the start of each person in the first run, and the fitted lines.
fn times(name: &str, rows: &[&Combination]) -> Panel {
    let mut marks = Vec::new();
    let mut latest = 1.0_f64;
    for (k, row) in rows.iter().enumerate() {
        let Some(found) = first::<FrontData>(row, "front") else {
            continue;
        };
        let started = found.people.iter();
        let started = started.filter_map(|of| Some([of.place, of.secs? - RELEASED]));
        let started: Vec<[f64; 2]> = started.collect();
        latest = started.iter().map(|point| point[1]).fold(latest, f64::max);
        let color = line_color(k);
        marks.push(Mark::dots(started, Style::full(color, 1.0, row.label())));
        if let (Some(slowness), Some(at_zero)) = (found.slowness, found.passes_zero) {
            let line = [0.0, LENGTH].map(|place| [place, at_zero - RELEASED + slowness * place]);
            marks.push(Mark::line(line, Style::full(color, 0.6, "")));
        }
    }
    let x = Axis::linear("place behind the line [m]", [0.0, LENGTH]);
    let y = Axis::linear("start [s]", [0.0, 1.05 * latest]);
    Panel::new(name, x, y, marks)
}

/// The speed of the front by spacing, with the measured one and spacing over T.
pub(super) fn fronts(rows: &[Combination]) -> Panel {
    let groups = grouped(rows, profile);
    let mut marks = Vec::new();
    let all = groups.iter().flat_map(|(_, rows)| rows);
    if let Some(time) = all.clone().find_map(|row| headway_time(row)) {
        let style = Style::full(GRAY, 1.0, &format!("spacing / {time} s"));
        marks.push(Mark::line([[0.0, 0.0], [1.2, 1.2 / time]], style));
    }
    let measured = Style::broken(BLACK, 1.0, "start corrals of marathons");
    marks.push(Mark::line([[0.0, MEASURED], [1.2, MEASURED]], measured));
    for (k, (name, rows)) in groups.iter().enumerate() {
        let points = points(rows.iter().copied(), spacing, front_speed);
        if !points.is_empty() {
            let style = Style::full(line_color(k), 2.2, name);
            marks.push(Mark::Points(points, style));
        }
    }
    let x = Axis::linear("spacing [m]", [0.0, 1.2]);
    let y = Axis::linear("front speed [m/s]", [0.0, 1.6]);
    Panel::new("start of a waiting crowd", x, y, marks).with_legend(Corner::LowerRight)
}
