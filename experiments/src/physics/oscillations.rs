//! Oscillations of dense crowds: spectra of locally averaged velocities by density.

use super::{first, found, grouped, mean, profile};
use sandbox::analysis::oscillation::Oscillation;
use sandbox::lab::gallery::{BAND, with_legend};
use sandbox::lab::reproduce::{Needs, Product};
use sandbox::lab::sweep::Combination;
use sandbox::output::plot::{Axis, Mark, Panel, Sheet, Style};
use sandbox::output::table::Table;

/// The measured angular frequency of crowds above 4 P/m² (Gu et al. 2025), rad/s.
const MEASURED: [f64; 2] = [0.30, 0.40];
/// The ends of the axes: angular frequency, rad/s, and power density, m²/s² per rad/s.
const AXES: [[f64; 2]; 2] = [[0.05, 8.0], [1e-10, 0.1]];

/// The most panels side by side.
const IN_A_ROW: usize = 3;

/// The tables of its study.
const TABLES: [&str; 2] = ["oscillations", "oscillations-summary"];

/// The table and the spectra.
pub const PRODUCT: Product = Product {
    name: "oscillations",
    about: "open question: do crowds in a closed square oscillate above 4 P/m²?",
    in_all: false,
    studies: &["oscillations"],
    needs: Needs::All,
    tables: &TABLES,
    has_figure: true,
    find: |product, studies| found(product, studies, table, sheet),
};

fn table(rows: &[Combination]) -> Table {
    let value =
        |what: &'static str| move |row: &Combination| mean(row, &format!("oscillation_{what}"));
    let speed = value("speed_m_per_s");
    let millimeters = move |row: &Combination| speed(row).map(|of| 1000.0 * of.mean);
    Table::of(rows)
        .column("crowd", |row| row.label().to_owned())
        .column("profile", profile)
        .fixed("velocity [mm/s]", 2, millimeters)
        .fixed("peak [rad/s]", 2, value("peak_rad_per_s"))
        .fixed("power at the peak", 2, value("peak_share"))
        .fixed("power at 0.30 to 0.40 rad/s", 3, value("band_share"))
        .fixed("spin", 2, value("spin"))
        .fixed("its root mean square", 2, value("spin_rms"))
        .table()
}

fn sheet(rows: &[Combination]) -> Sheet {
    let panels = with_legend(spectra(rows), IN_A_ROW);
    let title = "Mean velocity in boxes of 2 m: power by angular frequency";
    Sheet::new(
        title,
        panels.len().clamp(1, IN_A_ROW),
        [260.0, 200.0],
        panels,
    )
}

/// A panel for each profile, with a line for each crowd.
pub(super) fn spectra(rows: &[Combination]) -> Vec<Panel> {
    let groups = grouped(rows, profile);
    let panels = groups.iter().map(|(name, rows)| panel(name, rows));
    panels.collect()
}

fn panel(name: &str, rows: &[&Combination]) -> Panel {
    let [[left, right], [low, high]] = AXES;
    let mut marks = vec![Mark::rectangle(MEASURED, [low, high], BAND)];
    for (k, row) in rows.iter().enumerate() {
        let Some(found) = first::<Oscillation>(row, "oscillation") else {
            continue;
        };
        let points = found.spectrum.densities();
        let points = points.filter(|[frequency, _]| (left..=right).contains(frequency));
        let points = points.map(|[frequency, density]| [frequency, density.max(0.1 * low)]);
        marks.push(Mark::line(points, Style::nth(k, 1.0, row.label())));
    }
    let x = Axis::log("angular frequency [rad/s]", [left, right]);
    let y = Axis::log("power density [m²/s² per rad/s]", [low, high]);
    Panel::new(&format!("{name}; gray: measured in crowds"), x, y, marks)
}
