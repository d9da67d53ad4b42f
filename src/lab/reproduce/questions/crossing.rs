//! How the crossing (§6.2) behaves with each profile, under three guesses of its geometry.

use serde_json::json;

use super::Answer;
use super::geometry::Crossing;
use crate::lab::reproduce::case::Case;
use crate::lab::reproduce::comparison::Spread;
use crate::lab::reproduce::error::ReproduceError;
use crate::lab::reproduce::product::Plan;
use crate::lab::reproduce::published::written;
use crate::lab::reproduce::runner::Results;
use crate::lab::reproduce::table2;
use crate::output::table::Table;

/// The run of a profile with a guessed geometry.
fn case(guess: Crossing, profile: &str, seed: u64) -> Case {
    let case = table2::case(profile, seed);
    if guess == Crossing::Streets {
        return case;
    }
    let [left, right] = guess.stream();
    case.set("obstacles", json!(guess.obstacles()))
        .set("sources.1.min", json!([left, 19.0]))
        .set("sources.1.max", json!([right, 20.0]))
}

pub(super) fn cases(plan: &Plan) -> Result<Vec<Case>, ReproduceError> {
    let mut cases = Vec::new();
    for (guess, _) in Crossing::ALL {
        for row in crate::lab::reproduce::published()?.table2.rows {
            cases.extend(plan.seeds().map(|seed| case(guess, &row.profile, seed)));
        }
    }
    Ok(cases)
}

pub(super) fn answer(plan: &Plan, results: &Results) -> Result<Answer, ReproduceError> {
    let mut rows = Table::new(
        0,
        &[
            "geometry",
            "profile",
            "density [P/m²]",
            "its deviation",
            "flow [P/s]",
            "of the stream through in 60 s",
        ],
    );
    let mut rankings = Table::new(0, &["geometry", "flow", "density", "broken"]);
    let mut data = Vec::new();
    for (guess, about) in Crossing::ALL {
        let table = table2::Table::new(plan, results, |profile, seed| case(guess, profile, seed))?;
        for row in &table.rows {
            let through: Result<Vec<f64>, ReproduceError> = plan
                .seeds()
                .map(|seed| Ok(results.of(&case(guess, &row.profile, seed))?.uncounted as f64))
                .collect();
            let through = Spread::of(&through?).map_or(0.0, |spread| spread.mean);
            rows.add([
                about.to_owned(),
                written(&row.profile),
                row.density.ours_written(),
                row.deviation.ours_written(),
                row.flow.ours_written(),
                format!("{through:.0}"),
            ]);
            data.push(json!({ "geometry": about, "row": row, "through": through }));
        }
        let kept = |quantity| {
            let [kept, all] = table.kept(quantity);
            format!("{kept} of {all}")
        };
        rankings.add([
            about.to_owned(),
            kept("flow"),
            kept("density"),
            table.broken().join("; "),
        ]);
    }
    Ok(Answer {
        title: "How does the crossing behave, and which rankings of Table 2 hold under other guesses of its geometry?",
        text: "Rankings compare rows that differ by more than 10 % in the paper. In 60 s, 240 agents enter the crossing \
               stream; about 170 of them have enough time to cross.",
        table: format!("{}\n{}", rankings.markdown(), rows.markdown()),
        data: json!(data),
    })
}
