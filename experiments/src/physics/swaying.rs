//! People with legs in closed squares: from which density on they turn together, how fast, and how far apart.

use super::{grouped, mean, of_studies};
use sandbox::analysis::statistics::Estimate;
use sandbox::lab::error::LabError;
use sandbox::lab::gallery::{BAND, curve, distinct, in_cell, map, points};
use sandbox::lab::reproduce::{Needs, Product};
use sandbox::lab::sweep::{Combination, Gathered};
use sandbox::output::colors::ColorMap;
use sandbox::output::document::{Block, Findings};
use sandbox::output::plot::{
    Axis, BLACK, ColorBar, Corner, Mark, Panel, Point, Sheet, Style, line_color,
};
use sandbox::output::table::{Cell, Table};

/// What Gu et al. (2025) filmed on 50 m × 20 m: the density from which on people turn, P/m², the angular frequency with
/// its uncertainty, rad/s, and a distance over which they turn together, meters.
const ONSET: f64 = 4.0;
const FREQUENCY: Point = Point {
    x: 31.6,
    y: 0.35,
    error: 0.05,
};
const TOGETHER: f64 = 10.0;
const PEOPLE: &str = "people, 50 m × 20 m";
/// The least part of the power at the peak for a common frequency.
const LEAST_SHARE: f64 = 0.5;
/// A run has one sense of rotation from this mean spin on, and both from this root mean square on.
const SPINS: [f64; 2] = [0.2, 0.5];
/// The ends of the axis of sizes, meters.
const SIDES: [f64; 2] = [7.0, 60.0];
/// The ends of the axis of densities, P/m².
const DENSITIES: [f64; 2] = [0.0, 10.0];
/// The densities with a curve over sizes, P/m².
const CURVES: [f64; 3] = [5.0, 6.0, 7.0];

/// The tables and the map of what the law can and cannot do.
pub const PRODUCT: Product = Product {
    name: "swaying",
    about: "open question: from which density on do people with legs turn together in closed squares, and how fast?",
    in_all: false,
    studies: &["sway_small", "sway_large", "sway"],
    needs: Needs::All,
    tables: &[
        "sway_small",
        "sway_small-summary",
        "sway_large",
        "sway_large-summary",
        "sway",
        "sway-summary",
    ],
    has_figure: true,
    find,
};

/// The table of other parameters, and of people with legs with fluid forces.
pub const RATES: Product = Product {
    name: "swaying-rates",
    about: "open question: do people with legs turn together with other parameters, and over fluid forces?",
    in_all: false,
    studies: &["sway_rates"],
    needs: Needs::All,
    tables: &["sway_rates", "sway_rates-summary"],
    has_figure: false,
    find: |product, studies| {
        let table = cells(&studies[0].combinations());
        of_studies(product, studies, vec![Block::table(table)])
    },
};

fn find(product: &Product, studies: &[Gathered]) -> Result<Findings, LabError> {
    let rows: Vec<Combination> = studies.iter().flat_map(Gathered::combinations).collect();
    let blocks = vec![
        Block::table(sizes(&rows)),
        Block::table(cells(&rows)),
        Block::figure(product.name, sheet(&rows), product.about),
    ];
    of_studies(product, studies, blocks)
}

/// Width and height of the square, meters.
fn sides(row: &Combination) -> Option<[f64; 2]> {
    let corner = row.value("measurements.0.oscillation.region")?.get(1)?;
    Some([corner.get(0)?.as_f64()?, corner.get(1)?.as_f64()?])
}

fn square(row: &Combination) -> String {
    match sides(row) {
        Some([width, height]) if width == height => format!("{width} m"),
        Some([width, height]) => format!("{width} m × {height} m"),
        None => String::new(),
    }
}

/// √ of the area, meters.
fn side(row: &Combination) -> Option<f64> {
    sides(row).map(|[width, height]| (width * height).sqrt())
}

/// Whole people per square meter.
fn density(row: &Combination) -> Option<f64> {
    let count = |key: &str| row.value(key)?.as_f64();
    let people = count("grids.0.columns")? * count("grids.0.rows")?;
    Some((people / side(row)?.powi(2)).round())
}

fn values(row: &Combination, what: &str) -> Vec<f64> {
    row.values(what).into_iter().flatten().collect()
}

fn value(row: &Combination, what: &str) -> Option<Estimate> {
    Estimate::of_mean(&values(row, what))
}

fn correlation(row: &Combination) -> Option<Estimate> {
    value(row, "oscillation_correlation_m")
}

/// The frequency of people who turn together: most of the power is at one peak, and the correlation reaches as far as
/// in the film, or through nine tenths of the square (between the centers of its boxes of 2 m).
fn frequency(row: &Combination) -> Option<Estimate> {
    let longest = sides(row)?.into_iter().fold(0.0, f64::max) - 2.0;
    let has_peak = mean(row, "oscillation_peak_share")?.mean >= LEAST_SHARE;
    let reaches = correlation(row)?.value >= TOGETHER.min(0.9 * longest);
    peak(row).filter(|_| has_peak && reaches)
}

/// How many runs turn to the left, to the right, in both senses at once, and in none.
fn senses(row: &Combination) -> [usize; 4] {
    let [one, both] = SPINS;
    let [means, squares] =
        ["spin", "spin_rms"].map(|what| row.values(&format!("oscillation_{what}")));
    let mut counts = [0; 4];
    for (mean, square) in means.into_iter().zip(squares) {
        let sense = match (mean, square) {
            (Some(mean), _) if mean >= one => 0,
            (Some(mean), _) if mean <= -one => 1,
            (_, Some(square)) if square >= both => 2,
            _ => 3,
        };
        counts[sense] += 1;
    }
    counts
}

fn written(counts: [usize; 4]) -> String {
    counts.map(|count| count.to_string()).join(", ")
}

/// What was filmed, and for each square the densities at which its people turn together.
fn sizes(rows: &[Combination]) -> Table {
    let filmed = [PEOPLE, "4.0 ± 0.5", "0.35 ± 0.05", "> 10", "both"].map(str::to_owned);
    let of_square = |(name, rows): (String, Vec<&Combination>)| {
        let together: Vec<_> = rows.iter().filter(|row| frequency(row).is_some()).collect();
        let densities: Vec<String> = together
            .iter()
            .filter_map(|row| density(row).map(|of| of.to_string()))
            .collect();
        let range = |values: Vec<f64>, digits: usize| {
            let low = values.iter().copied().reduce(f64::min)?;
            let high = values.iter().copied().reduce(f64::max)?;
            Some(format!("{low:.digits$} to {high:.digits$}"))
        };
        let means = |of: fn(&Combination) -> Option<Estimate>| -> Vec<f64> {
            let means = together.iter().filter_map(|row| of(row));
            means.map(|of| of.value).collect()
        };
        let mut counts = [0; 4];
        for row in &together {
            for (sum, count) in counts.iter_mut().zip(senses(row)) {
                *sum += count;
            }
        }
        let none = || "–".to_owned();
        [
            name,
            Some(densities.join(", "))
                .filter(|list| !list.is_empty())
                .unwrap_or_else(none),
            range(means(frequency), 2).unwrap_or_else(none),
            range(means(correlation), 1).unwrap_or_else(none),
            if together.is_empty() {
                none()
            } else {
                written(counts)
            },
        ]
    };
    let squares = grouped(rows, square).into_iter().map(of_square);
    let all: Vec<[String; 5]> = [filmed].into_iter().chain(squares).collect();
    let column = |k: usize| move |row: &[String; 5]| row[k].clone();
    Table::of(&all)
        .column("square", column(0))
        .column("people turn together at [P/m²]", column(1))
        .column("frequency there [rad/s]", column(2))
        .column("correlation there [m]", column(3))
        .column("runs there to the left, right, both, none", column(4))
        .table()
}

/// The mean over runs, with its standard error if there are several.
fn with_error(row: &Combination, what: &str) -> Option<Cell> {
    let of = mean(row, what)?;
    Some(Cell::Spread(of.mean, (of.count > 1).then(|| of.error())))
}

/// All cells of the studies.
fn cells(rows: &[Combination]) -> Table {
    let mean = |what: &'static str| move |row: &Combination| mean(row, what).map(|of| of.mean);
    let speed = mean("oscillation_speed_m_per_s");
    Table::of(rows)
        .column("crowd", |row| row.label().to_owned())
        .column("runs", |row| row.results.len())
        .fixed("velocity [mm/s]", 0, move |row| {
            speed(row).map(|of| 1000.0 * of)
        })
        .fixed("peak [rad/s]", 2, |row| {
            with_error(row, "oscillation_peak_rad_per_s")
        })
        .fixed("power at the peak", 2, mean("oscillation_peak_share"))
        .fixed("spin, root mean square", 2, mean("oscillation_spin_rms"))
        .column("left, right, both, none", |row| written(senses(row)))
        .fixed("correlation [m]", 1, |row| {
            with_error(row, "oscillation_correlation_m")
        })
        .fixed("along x", 1, mean("oscillation_correlation_x_m"))
        .fixed("along y", 1, mean("oscillation_correlation_y_m"))
        .fixed("unbalanced", 2, mean("unbalanced_share"))
        .table()
}

fn sheet(rows: &[Combination]) -> Sheet {
    let panels = vec![
        map_of(
            rows,
            "correlation length [m]",
            ([0.0, 20.0], 4, 0),
            (correlation, TOGETHER),
        ),
        map_of(
            rows,
            "frequency where people turn together [rad/s]",
            ([0.25, 0.55], 6, 2),
            (frequency, FREQUENCY.y),
        ),
        by_size(rows),
    ];
    let title = "People with legs in closed squares; top rows and black: filmed (Gu et al. 2025)";
    Sheet::new(title, 3, [270.0, 210.0], panels)
}

/// A quantity of the model over density and square, and what was filmed in the row above.
fn map_of(
    rows: &[Combination],
    title: &str,
    (range, bands, digits): ([f32; 2], u32, usize),
    (of, filmed): (fn(&Combination) -> Option<Estimate>, f64),
) -> Panel {
    let mut densities: Vec<f64> = distinct(rows.iter().filter_map(density));
    densities.sort_by(f64::total_cmp);
    let squares = grouped(rows, square);
    let mut values = Vec::new();
    for (_, own) in &squares {
        let at = |wanted: &f64| {
            let row = own.iter().find(|row| density(row) == Some(*wanted))?;
            of(row).map(|of| of.value)
        };
        values.extend(densities.iter().map(at));
    }
    let people = densities.iter().map(|&at| (at >= ONSET).then_some(filmed));
    values.extend(people);
    let names = squares.iter().map(|(name, _)| name.clone());
    let names = names.chain([PEOPLE.to_owned()]);
    let columns = densities.len();
    let axes = [
        Axis::names("density [P/m²]", densities.iter().map(f64::to_string)),
        Axis::names("", names),
    ];
    let map_of = ColorMap::pale(range, bands);
    let mut panel = map(title, axes, values.clone(), ColorBar::new("", &map_of));
    for (k, value) in values.into_iter().enumerate() {
        let more = if k / columns == squares.len() && digits == 0 {
            "> "
        } else {
            ""
        };
        let text = value.map_or("–".to_owned(), |value| format!("{more}{value:.digits$}"));
        panel
            .marks
            .push(in_cell([k % columns, k / columns], text, true));
    }
    panel
}

/// The frequencies of a peak that agree with the film, rad/s.
fn filmed() -> [f64; 2] {
    [-FREQUENCY.error, FREQUENCY.error].map(|error| FREQUENCY.y + error)
}

fn peak(row: &Combination) -> Option<Estimate> {
    value(row, "oscillation_peak_rad_per_s")
}

/// The frequency over density: of people who turn together, and of people who do not.
pub(super) fn frequencies(rows: &[Combination]) -> Panel {
    let of = |rows: Vec<&Combination>| points(rows, |row| density(row), |row| peak(row));
    let (together, apart): (Vec<_>, Vec<_>) = rows.iter().partition(|row| frequency(row).is_some());
    let dense = [ONSET, DENSITIES[1]];
    let marks = vec![
        Mark::rectangle(dense, filmed(), BAND),
        Mark::line(
            dense.map(|density| [density, FREQUENCY.y]),
            Style::broken(BLACK, 1.2, "filmed, over 10 m and more"),
        ),
        Mark::Points(
            of(together),
            Style::full(line_color(0), 3.0, "legs, together over 10 m and more"),
        ),
        Mark::Points(
            of(apart),
            Style::broken(line_color(0), 3.0, "legs, not together"),
        ),
    ];
    let x = Axis::linear("density [P/m²]", DENSITIES);
    let y = Axis::linear("frequency of the peak [rad/s]", [0.0, 0.6]);
    Panel::new("people with legs in a square of 50 m × 20 m", x, y, marks)
        .with_legend(Corner::LowerRight)
}

/// The frequency at some densities over the side of the square.
fn by_size(rows: &[Combination]) -> Panel {
    let mut marks = vec![Mark::rectangle(SIDES, filmed(), BAND)];
    for (k, at) in CURVES.into_iter().enumerate() {
        let here = rows.iter().filter(|row| density(row) == Some(at));
        let (squares, oblong): (Vec<_>, Vec<_>) =
            here.partition(|row| sides(row).is_some_and(|[width, height]| width == height));
        let of = |rows: Vec<&Combination>| points(rows, |row| side(row), |row| peak(row));
        let style = |label: &str| Style::full(line_color(k), 1.0, label);
        marks.extend(curve(of(squares), style(&format!("{at} P/m²")), 2.2));
        let cross = Style {
            width: 3.6,
            ..style("")
        };
        marks.push(Mark::Points(of(oblong), cross));
    }
    marks.push(Mark::Points(
        vec![FREQUENCY],
        Style::full(BLACK, 3.0, PEOPLE),
    ));
    let x = Axis::log("√ of the area [m]; large dots: 50 m × 20 m", SIDES)
        .ticked([8, 12, 18, 25, 36, 50].map(|side| (f64::from(side), side.to_string())));
    let y = Axis::linear("frequency of the peak [rad/s]", [0.2, 0.7]);
    Panel::new("frequency over size, held out from the fit", x, y, marks)
        .with_legend(Corner::UpperRight)
}
