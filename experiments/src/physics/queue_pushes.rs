//! The speed and the reach of a push through a row of standing people.

use super::{first, found, front_speed, grouped, mean, profile};
use sandbox::analysis::sound::speed_of_fluid;
use sandbox::analysis::statistics::Estimate;
use sandbox::lab::gallery::{curve, points};
use sandbox::lab::reproduce::{Needs, Product};
use sandbox::lab::sweep::Combination;
use sandbox::output::plot::{Axis, BLACK, Corner, GRAY, Mark, Panel, Point, Sheet, Style};
use sandbox::output::table::Table;
use sandbox::scenario::measurements::FrontData;

/// k of the paper's profiles.
const GAS_CONSTANT: f64 = 200.0;
/// Two rows of five people, pushed by Feldmann and Adrian (2023): the mean distance, meters, and the speed of the front
/// through their heads, m/s, with the uncertainty that the choice of a threshold makes (docs/findings/questions.md).
const MEASURED: [Point; 2] = [
    Point {
        x: 0.357,
        y: 2.4,
        error: 0.13,
    },
    Point {
        x: 0.362,
        y: 3.5,
        error: 0.5,
    },
];
/// The distances on the axis, meters.
const DISTANCES: [f64; 2] = [0.2, 1.1];
/// The setting with the velocity of the last person in the row.
const PUSH: &str = "agents.0.velocity";

/// The tables of its study.
const TABLES: [&str; 2] = ["queue_pushes", "queue_pushes-summary"];

/// The table, and speed and reach by distance.
pub const PRODUCT: Product = Product {
    name: "queue-pushes",
    about: "open question: how fast and how far does a push run through a row?",
    in_all: false,
    studies: &["queue_pushes"],
    needs: Needs::All,
    tables: &TABLES,
    has_figure: true,
    find: |product, studies| found(product, studies, table, sheet),
};

/// The distance between neighbors at the start, meters.
fn distance(row: &Combination) -> Option<f64> {
    let found: FrontData = first(row, "front")?;
    let places = || found.people.iter().map(|of| of.place);
    let [first, last] = [places().reduce(f64::min)?, places().reduce(f64::max)?];
    Some((last - first) / (found.people.len() as f64 - 1.0))
}

/// The initial speed of the pushed agent, m/s.
fn push(row: &Combination) -> Option<f64> {
    row.value(PUSH)?.get(0)?.as_f64()
}

/// The mean number of agents that the push reached, without the pushed agent.
fn reached(row: &Combination) -> Option<f64> {
    mean(row, "front_agents").map(|of| of.mean - 1.0)
}

fn table(rows: &[Combination]) -> Table {
    Table::of(rows)
        .column("row", |row| row.label().to_owned())
        .column("profile", profile)
        .fixed("push [m/s]", 1, push)
        .fixed("people reached", 0, reached)
        .fixed("reach [m]", 1, |row| {
            mean(row, "front_reach_m").map(|of| of.mean)
        })
        .fixed("front [m/s]", 1, front_speed)
        .table()
}

fn sheet(rows: &[Combination]) -> Sheet {
    let people = |row: &Combination| {
        let value = reached(row)?;
        Some(Estimate { value, error: 0.0 })
    };
    let reach = Axis::linear("people reached", [0.0, 21.0]);
    let groups = by_push(rows);
    let reach = panel("", &groups, reach, people).with_legend(Corner::Beside);
    let title = "A push through a row of twenty people";
    Sheet::new(title, 2, [220.0, 190.0], vec![fronts(&groups), reach])
}

/// Combinations of the same profile and push.
fn by_push<'r, 'a>(rows: &'r [Combination<'a>]) -> Vec<(String, Vec<&'r Combination<'a>>)> {
    grouped(rows, |row| match push(row) {
        Some(push) => format!("{}, {push} m/s", profile(row)),
        None => profile(row),
    })
}

/// The speed of the front after the strongest push.
pub(super) fn strongest(rows: &[Combination]) -> Panel {
    let most = rows.iter().filter_map(push).reduce(f64::max);
    let mut groups = by_push(rows);
    groups.retain(|(_, own)| own.first().and_then(|row| push(row)) == most);
    fronts(&groups).with_legend(Corner::UpperRight)
}

/// The speed of the front by distance, with the measured ones and the linear theory.
fn fronts(groups: &[(String, Vec<&Combination>)]) -> Panel {
    let theory = DISTANCES.map(|x| [x, speed_of_fluid(GAS_CONSTANT)]);
    let speeds = Axis::linear("front speed [m/s]", [0.0, 16.0]);
    let title = "push through a row; dashed: √(k/2)";
    let mut panel = panel(title, groups, speeds, front_speed);
    let theory = Mark::line(theory, Style::broken(GRAY, 1.0, ""));
    let measured = Style::full(BLACK, 2.6, "five people, measured");
    let measured = Mark::Points(MEASURED.to_vec(), measured);
    panel.marks.extend([theory, measured]);
    panel
}

/// A quantity by distance, with a line for each group.
fn panel(
    title: &str,
    groups: &[(String, Vec<&Combination>)],
    y: Axis,
    quantity: impl Fn(&Combination) -> Option<Estimate>,
) -> Panel {
    let mut marks = Vec::new();
    for (k, (name, rows)) in groups.iter().enumerate() {
        let points = points(rows.iter().copied(), distance, &quantity);
        marks.extend(curve(points, Style::nth(k, 0.8, name), 2.2));
    }
    let x = Axis::linear("distance from person to person [m]", DISTANCES);
    Panel::new(title, x, y, marks)
}
