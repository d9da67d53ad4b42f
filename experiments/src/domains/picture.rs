//! The picture of `domains`: balance and halos as found, speed-ups as modeled.

use indicatif::HumanCount;
use sandbox::analysis::statistics::Range;
use sandbox::lab::gallery::{around, color, medians};
use sandbox::output::plot::{Axis, Corner, GRAY, Mark, Panel, Sheet, Style};

use super::Row;
use super::cut::Way;
use super::network::NETWORKS;

/// Four panels: balance, halos, and two modeled speed-ups.
pub fn sheet(rows: &[Row]) -> Sheet {
    let still = rows.iter().rfind(|row| row.drift.is_none());
    let moving = rows.iter().rfind(|row| row.drift.is_some());
    let of = |crowd: Option<&Row>| -> Vec<&Row> {
        let same =
            |row: &&Row| crowd.is_some_and(|c| (&c.crowd, c.agents) == (&row.crowd, row.agents));
        rows.iter().filter(same).collect()
    };
    let (still, moving) = (of(still), of(moving));
    let panels = vec![
        balance(&moving),
        halos(rows),
        speed_up(&still),
        speed_up(&moving),
    ];
    let title = "Crowds cut into parts, one per process";
    Sheet::new(title, 2, [300.0, 210.0], panels)
}

/// The name and size of the crowd of some rows.
fn title(rows: &[&Row]) -> String {
    let name = rows
        .first()
        .map(|row| format!("{}, {} agents", row.crowd, HumanCount(row.agents as u64)));
    name.unwrap_or_default()
}

/// An axis over numbers of parts.
fn parts_axis(rows: &[&Row]) -> Axis {
    let ends = around(rows.iter().map(|row| row.parts as f64), 1.3);
    let counts = rows.chunk_by(|a, b| a.parts == b.parts);
    let counts = counts.map(|chunk| chunk[0].parts);
    Axis::log("parts", ends).ticked(counts.map(|parts| (parts as f64, parts.to_string())))
}

/// A line through single values.
fn line(points: &[(f64, f64)], number: usize, label: &str) -> Vec<Mark> {
    let points = points.iter().map(|&(x, y)| (x, Range::of(&[y])));
    medians(&points.collect::<Vec<_>>(), color(number), label)
}

/// The work of the largest part over the mean, by parts and cut.
fn balance(rows: &[&Row]) -> Panel {
    let mut marks = Vec::new();
    for (k, way) in Way::ALL.into_iter().enumerate() {
        let own = rows.iter().filter(|row| row.cut == way.name());
        let points = own.map(|row| (row.parts as f64, row.work_ratio));
        marks.extend(line(&points.collect::<Vec<_>>(), k, way.name()));
    }
    let most = rows.iter().map(|row| row.work_ratio).fold(1.0, f64::max);
    let y = Axis::log("work, largest part over mean", [0.9, 2.0 * most]);
    Panel::new(&title(rows), parts_axis(rows), y, marks).with_legend(Corner::UpperLeft)
}

/// Halos of bisections by work, relative to the own agents.
fn halos(rows: &[Row]) -> Panel {
    let bisections = rows.iter().filter(|row| row.cut == Way::Work.name());
    let bisections: Vec<&Row> = bisections.collect();
    let own = |row: &Row| row.agents as f64 / row.parts as f64;
    let relative = |row: &Row| row.halo_mean / own(row);
    let mut marks = Vec::new();
    let crowds = bisections.chunk_by(|a, b| (&a.crowd, a.agents) == (&b.crowd, b.agents));
    for (k, crowd) in crowds.enumerate() {
        let points = crowd.iter().map(|row| (own(row), relative(row)));
        let label = format!("{}, {:.2} m", title(crowd), crowd[0].reach);
        marks.extend(line(&points.collect::<Vec<_>>(), k, &label));
    }
    let sizes = around(bisections.iter().map(|row| own(row)), 1.3);
    let shares = around(bisections.iter().map(|row| relative(row)), 1.5);
    // Room for the legend.
    let shares = [shares[0] / 10.0, shares[1]];
    let x = Axis::log("agents per part", sizes);
    let y = Axis::log("agents of the halo per own agent", shares);
    let title = "Halos of bisections by work, with their reach";
    Panel::new(title, x, y, marks).with_legend(Corner::LowerLeft)
}

/// Speed-ups of bisections by work by the model.
fn speed_up(rows: &[&Row]) -> Panel {
    let bisections = rows.iter().filter(|row| row.cut == Way::Work.name());
    let bisections: Vec<&Row> = bisections.copied().collect();
    let ends = around(bisections.iter().map(|row| row.parts as f64), 1.3);
    let ideal = ends.map(|parts| [parts, parts]);
    let mut marks = vec![Mark::line(ideal, Style::broken(GRAY, 0.8, "ideal"))];
    for (k, network) in NETWORKS.iter().enumerate() {
        let points = bisections
            .iter()
            .map(|row| (row.parts as f64, row.model[k].speed_up));
        marks.extend(line(&points.collect::<Vec<_>>(), k, network.name));
    }
    let all = bisections
        .iter()
        .flat_map(|row| &row.model)
        .map(|model| model.speed_up);
    let y = around(all.chain(ends), 1.3);
    let y = Axis::log("times as fast as one thread (model)", y);
    Panel::new(&title(rows), parts_axis(rows), y, marks).with_legend(Corner::UpperLeft)
}
