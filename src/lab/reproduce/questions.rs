//! Questions about the tables: what walls, doorways, starts and guesses change in Tables 1 and 2. Each is a study.

use serde_json::json;

use super::comparison::Spread;
use super::product::{Needs, Product};
use super::table2;
use crate::lab::error::LabError;
use crate::lab::sweep::{Combination, Gathered};
use crate::output::table::Table;
use crate::runs::store::Store;

/// Answers to all questions.
pub const PRODUCT: Product = Product {
    name: "questions",
    about: "what walls, doorways, starts and guesses change in Tables 1 and 2",
    in_all: false,
    studies: &[
        "questions_sf_flow",
        "questions_geometry",
        "questions_last_agents",
        "questions_rvo_density",
        "questions_blend_spread",
        CROSSING,
    ],
    needs: Needs::Seeds,
    write,
};

/// The study about Table 2; its list has that table's profiles once for each geometry.
const CROSSING: &str = "questions_crossing";

/// What the tables show: metric and head. Metrics that a study does not measure are left out.
const COLUMNS: [(&str, &str); 10] = [
    ("evacuated", "evacuated"),
    ("locked", "locked"),
    ("density_mean_15s", "density [P/m²]"),
    ("density_std_15s", "its deviation"),
    ("density_mean_45s", "density [P/m²]"),
    ("density_std_45s", "its deviation"),
    ("flow_per_s", "flow [P/s]"),
    ("flow_first_60s_per_s", "flow [P/s]"),
    ("pauses_secs", "pauses [s]"),
    ("flow_between_pauses_per_s", "flow between pauses"),
];

fn write(studies: &[Gathered], store: &Store) -> Result<String, LabError> {
    let (mut markdown, mut data) = (String::new(), Vec::new());
    for study in studies {
        let about = study.study.document["description"]
            .as_str()
            .unwrap_or_default();
        let (title, text) = about.split_once("? ").unwrap_or((about, ""));
        let combinations = study.combinations();
        let rankings = match study.study.name.as_str() {
            CROSSING => rankings(&combinations)?,
            _ => String::new(),
        };
        markdown += &format!(
            "### {title}?\n\n{text}\n\n{rankings}{}\n",
            table(study, &combinations)
        );
        data.push(json!({ "question": title, "study": study.json() }));
    }
    let seeds = studies.first().map_or(0, |study| study.study.seeds);
    let markdown = format!("Over {seeds} seed(s): mean ± sample standard deviation.\n\n{markdown}");
    let json = json!({ "seeds": seeds, "questions": data });
    store.write("questions.md", markdown.as_bytes())?;
    store.write("questions.json", format!("{json:#}\n").as_bytes())?;
    Ok(markdown)
}

/// One line per entry of the list.
fn table(study: &Gathered, combinations: &[Combination]) -> String {
    let measured = |metric: &str| {
        let mut values = combinations.iter().flat_map(|row| row.values(metric));
        values.any(|value| value.is_some())
    };
    let columns: Vec<_> = COLUMNS
        .into_iter()
        .filter(|(metric, _)| measured(metric))
        .collect();
    let heads: Vec<&str> = columns.iter().map(|(_, head)| *head).collect();
    let mut table = Table::new(1, &[&["run"], heads.as_slice()].concat());
    for row in combinations {
        let label = row
            .cells
            .first()
            .and_then(|cell| cell.label())
            .unwrap_or_default();
        let cells = columns.iter().map(|(metric, _)| {
            let values: Vec<f64> = row.values(metric).into_iter().flatten().collect();
            match *metric {
                "locked" => format!("{} of {}", values.iter().sum::<f64>(), study.study.seeds),
                "evacuated" => evacuated(&values),
                _ => Spread::of(&values).map_or("–".to_owned(), |spread| spread.written()),
            }
        });
        table
            .rows
            .push(std::iter::once(label.to_owned()).chain(cells).collect());
    }
    table.markdown()
}

/// The numbers of all seeds, or a single one if they are equal.
fn evacuated(values: &[f64]) -> String {
    let mut numbers = values.to_vec();
    numbers.dedup();
    let numbers = if numbers.len() == 1 { &numbers } else { values };
    let each: Vec<String> = numbers.iter().map(f64::to_string).collect();
    each.join(", ")
}

/// Which rankings of Table 2 hold in each geometry, and how many of the crossing stream get through.
fn rankings(combinations: &[Combination]) -> Result<String, LabError> {
    let profiles = super::published()?.table2.rows.len();
    let head = [
        "geometry",
        "flow",
        "density",
        "broken",
        "of the stream through in 60 s",
    ];
    let mut rankings = Table::new(1, &head);
    for rows in combinations.chunks(profiles) {
        let table = table2::Table::new(rows)?;
        let kept = |quantity| {
            let [kept, all] = table.kept(quantity);
            format!("{kept} of {all}")
        };
        let label = rows
            .first()
            .and_then(|row| row.cells.first()?.label())
            .unwrap_or_default();
        let through = rows
            .iter()
            .flat_map(|row| row.values("uncounted"))
            .flatten();
        let through: Vec<f64> = through.collect();
        let least = through.iter().copied().fold(f64::INFINITY, f64::min);
        let most = through.iter().copied().fold(0.0, f64::max);
        rankings.add([
            label
                .rsplit_once(": ")
                .map_or(label, |(geometry, _)| geometry)
                .to_owned(),
            kept("flow"),
            kept("density"),
            table.broken().join("; "),
            format!("{least} to {most}"),
        ]);
    }
    Ok(format!("{}\n", rankings.markdown()))
}
