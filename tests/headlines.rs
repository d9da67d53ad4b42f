//! The numbers with which the README, the pages and reports say how real the profiles are, and how many rows of the
//! paper's Table 1 are met, are those of the data: docs/findings/held_out.json, docs/findings/validation.json and
//! docs/reference/tables/reproduction.md.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::common::room::{done, scenario};

const README: &str = include_str!("../README.md");
const VALIDATION: &str = include_str!("../docs/findings/validation.md");
const COMPARISON: &str = include_str!("../docs/guide/comparison.md");
const PAGES: [(&str, &str); 5] = [
    ("README.md", README),
    ("docs/index.md", include_str!("../docs/index.md")),
    ("docs/guide/comparison.md", COMPARISON),
    (
        "docs/guide/jupedsim.md",
        include_str!("../docs/guide/jupedsim.md"),
    ),
    ("docs/findings/validation.md", VALIDATION),
];

/// The values that were held out.
fn held_out() -> Value {
    serde_json::from_str(include_str!("../docs/findings/held_out.json")).unwrap()
}

/// The results of `sandbox validate` by profile.
fn validated() -> Value {
    let status: Value =
        serde_json::from_str(include_str!("../docs/findings/validation.json")).unwrap();
    status["profiles"].clone()
}

/// A count of values: those inside, and all.
fn count(value: &Value) -> [u64; 2] {
    [&value[0], &value[1]].map(|number| number.as_u64().unwrap())
}

fn written([inside, all]: [u64; 2]) -> String {
    format!("{inside} of {all}")
}

/// A text with one blank between words.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// All counts `N of M` in a text.
fn counts_in(text: &str) -> Vec<[u64; 2]> {
    let flat = flat(text);
    let words: Vec<&str> = flat.split(' ').collect();
    let number = |word: &str| {
        let digits = word.trim_matches(|c: char| !c.is_ascii_digit());
        digits.parse().ok()
    };
    let pairs = words.windows(3).filter(|words| words[1] == "of");
    let counts = pairs.filter_map(|words| Some([number(words[0])?, number(words[2])?]));
    counts.collect()
}

/// The pages in a folder, and in the folders in it.
fn pages_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let pages = paths.flat_map(|path| match path.is_dir() {
        true => pages_in(&path),
        false => vec![path],
    });
    let pages = pages.filter(|path| path.extension().is_some_and(|one| one == "md"));
    pages.collect()
}

/// The README and all pages of docs/.
fn all_pages() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = pages_in(&root.join("docs"));
    assert!(all.len() > 30, "{all:?}");
    all.push(root.join("README.md"));
    all.into_iter()
        .map(|path| (path.clone(), fs::read_to_string(path).unwrap()))
        .collect()
}

/// The rows of the table between the marks `name` of a document.
fn table(document: &str, name: &str) -> Vec<Vec<String>> {
    let (_, rest) = document.split_once(&format!("<!-- {name} -->")).unwrap();
    let (table, _) = rest.split_once(&format!("<!-- /{name} -->")).unwrap();
    let rows = table.lines().filter(|line| line.starts_with('|'));
    let cells = rows.map(|row| {
        row.trim_matches('|')
            .split('|')
            .map(|cell| cell.trim().to_owned())
    });
    cells.map(Iterator::collect).collect()
}

#[test]
fn the_data_of_held_out_runs_agree_with_themselves() {
    let held_out = held_out();
    let kinds = held_out["kinds"].as_array().unwrap().iter();
    let sums = kinds.map(|kind| count(&kind["values"]));
    let sum = sums.fold([0, 0], |[a, b], [inside, all]| [a + inside, b + all]);
    assert_eq!(sum, count(&held_out["values"]));
    // Flow, density and speed of each run.
    assert_eq!(sum[1], 3 * held_out["runs"].as_u64().unwrap());
    let beside = &held_out["beside"];
    for (model, values) in beside["values"].as_object().unwrap() {
        assert_eq!(
            count(values)[1],
            3 * beside["runs"].as_u64().unwrap(),
            "{model}"
        );
    }
}

#[test]
fn pages_lead_with_the_values_to_which_nothing_was_fitted() {
    let (held_out, validated) = (held_out(), validated());
    let one = &validated["steer+sph"];
    let first = written(count(&held_out["values"]));
    let second = written(count(&one["values"]));
    let [inside, all] = count(&one["fitted"]);
    let fitted = format!("{inside} of them fitted");
    let of_fitted = format!("{inside} of the {all} values that it was fitted to");
    assert!(VALIDATION.contains(&of_fitted), "{of_fitted}");
    let row = format!("| without the scenes that need data | {second} |");
    assert!(VALIDATION.contains(&row), "{row}");
    let profiles = validated.as_object().unwrap().values();
    let beside = held_out["beside"]["values"].as_object().unwrap().values();
    let of_profiles = profiles.map(|one| &one["values"]).chain(beside);
    let known: Vec<[u64; 2]> = of_profiles
        .chain([&held_out["values"]])
        .map(count)
        .collect();
    let [inside, all] = count(&held_out["values"]);
    let runs = held_out["runs"].as_u64().unwrap();
    for (name, page) in PAGES {
        let page = flat(page);
        let at = page.find(&first).expect(name);
        assert!(
            page.contains(&format!("{runs} runs")),
            "{name}: {runs} runs"
        );
        assert!(page.contains("nothing was fitted"), "{name}");
        for said in counts_in(&page) {
            assert!(said[1] != all || said[0] == inside, "{name}: {said:?}");
            // docs/findings/validation.md also has counts of other seeds, steps and candidates.
            assert!(
                name == "docs/findings/validation.md" || known.contains(&said),
                "{name}: {said:?}"
            );
        }
        if name != "docs/guide/jupedsim.md" {
            assert!(
                at < page.find(&second).expect(name),
                "{name}: {second} comes first"
            );
            assert!(page.contains(&fitted), "{name}: {fitted}");
        }
    }
    let of_paper = ["sph", "sf->sph", "rvo->sph"].map(|name| count(&validated[name]["values"]));
    let [least, most] = [of_paper.iter().min(), of_paper.iter().max()].map(Option::unwrap);
    let said = format!("profiles {} to {}", least[0], written(*most));
    assert!(COMPARISON.contains(&said), "{said}");
    // What they are, for a reader of the README alone.
    let commit = held_out["commit"].as_str().unwrap();
    for page in [README, VALIDATION] {
        for words in [
            commit,
            "outside of this repository",
            "never opened here",
            "stays closed",
        ] {
            assert!(flat(page).contains(words), "{words}");
        }
    }
}

#[test]
fn pages_have_the_counts_of_the_other_models() {
    let held_out = held_out();
    let beside = &held_out["beside"];
    let value = |model: &str| count(&beside["values"][model]);
    let [speed, all] = value("JuPedSim, collision-free speed");
    let [anticipation, _] = value("JuPedSim, anticipation");
    let [ours, _] = value("steer+sph");
    let said = format!("meet {speed} and {anticipation} of {all} values, `steer+sph` {ours}");
    let runs = format!("On {} of ", beside["runs"]);
    for (name, page) in PAGES.iter().filter(|(name, _)| *name != "docs/index.md") {
        let page = flat(page);
        assert!(
            page.contains(&said) && page.contains(&runs),
            "{name}: {said}"
        );
        assert!(page.contains("at their defaults"), "{name}");
    }
}

#[test]
fn the_page_of_validation_has_the_table_of_the_held_out_data() {
    let held_out = held_out();
    for kind in held_out["kinds"].as_array().unwrap() {
        let name = kind["name"].as_str().unwrap();
        let note = kind["note"].as_str().unwrap_or_default();
        let row = format!("| {name} | {} | {note} |", written(count(&kind["values"])));
        assert!(flat(VALIDATION).contains(&flat(&row)), "{row}");
    }
    let all = format!(
        "| all {} | {} | mean deviation {} tolerances |",
        held_out["runs"],
        written(count(&held_out["values"])),
        held_out["mean_deviation"]
    );
    assert!(VALIDATION.contains(&all), "{all}");
    let share = held_out["others"]["walk+sph"].as_str().unwrap();
    assert!(VALIDATION.contains(&format!("`walk+sph` meets {share} of these values")));
}

#[test]
fn the_status_file_has_the_fitted_values_of_the_document() {
    let rows = table(VALIDATION, "validation");
    let profiles = rows
        .iter()
        .find(|row| row[0].starts_with("values within"))
        .unwrap();
    let [all, fitted] =
        ["all", "fitted to it"].map(|name| rows.iter().find(|row| row[0] == name).unwrap());
    let validated = validated();
    for (k, profile) in profiles.iter().enumerate().skip(1) {
        let one = &validated[profile];
        assert_eq!(all[k], written(count(&one["values"])), "{profile}");
        match one.get("fitted") {
            Some(values) => assert_eq!(fitted[k], written(count(values)), "{profile}"),
            None => assert_eq!(fitted[k], "–", "{profile}"),
        }
        let row = format!("| `{profile}` | {} |", all[k]);
        assert!(VALIDATION.contains(&row), "{row}");
    }
}

#[test]
fn a_report_leads_with_the_held_out_values() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    done(
        folder.path(),
        &["report", "room.json", "--until", "1", "--json"],
    );
    let html = fs::read_to_string(folder.path().join("room.html")).unwrap();
    let (_, status) = html
        .split_once("<h2>Verification and validation</h2>")
        .unwrap();
    let (held_out, validated) = (held_out(), validated());
    let [first, second] =
        [&held_out["values"], &validated["steer+sph"]["values"]].map(|one| written(count(one)));
    let fitted = count(&validated["steer+sph"]["fitted"])[0];
    let first = format!("{first} values of {} runs", held_out["runs"]);
    let second =
        format!("{second} measured values are within the tolerances, {fitted} of them fitted");
    let at = |words: &str| {
        status
            .find(words)
            .unwrap_or_else(|| panic!("no {words:?} in {status}"))
    };
    assert!(at(&first) < at(&second));
    assert!(at(held_out["commit"].as_str().unwrap()) < at(&second));
    for kind in held_out["kinds"].as_array().unwrap() {
        let said = format!(
            "{} {}",
            kind["name"].as_str().unwrap(),
            written(count(&kind["values"]))
        );
        assert!(at(&said) < at(&second));
    }
}

#[test]
fn flows_through_gaps_are_as_much_too_high_as_pages_say() {
    let rows = table(VALIDATION, "validation");
    let header = rows.iter().find(|row| row[0] == "case").unwrap();
    let column = header.iter().position(|name| name == "steer+sph").unwrap();
    let excess = ["gap-2.4", "gap-3.6"].map(|case| {
        let row = rows
            .iter()
            .find(|row| row[0] == case && row[2].starts_with("flow"))
            .unwrap();
        let (_, percent) = row[column].split_once("(+").unwrap();
        percent.split_once(" %").unwrap().0.parse::<u64>().unwrap()
    });
    let [low, high] = [excess[0].min(excess[1]), excess[0].max(excess[1])];
    let said = format!("{low} to {high} % too high");
    for (name, page) in PAGES
        .iter()
        .filter(|(name, _)| *name != "docs/guide/jupedsim.md")
    {
        assert!(flat(page).contains(&said), "{name}: {said}");
        assert!(
            flat(page).contains("full counterflows") || flat(page).contains("Full counterflows"),
            "{name}"
        );
    }
}

#[test]
fn pages_count_the_rows_of_table_1_that_the_table_has() {
    let rows = table(
        include_str!("../docs/reference/tables/reproduction.md"),
        "table1",
    );
    let kept = rows
        .iter()
        .filter(|row| row.last().is_some_and(|cell| cell == "kept"))
        .count();
    // A row of names and one of dashes.
    let all = rows.len() - 2;
    assert_eq!(all, 30);
    let said = format!("{kept} of {all} rows");
    let pages = all_pages();
    let mut found = 0;
    for (path, page) in &pages {
        let page = flat(page);
        let counts = page.matches(&format!(" of {all} rows")).count();
        assert_eq!(
            page.matches(&said).count(),
            counts,
            "{}: not {said}",
            path.display()
        );
        found += counts;
    }
    assert!(found > 0);
}

#[test]
fn a_speed_beside_jupedsim_says_both_steps_and_that_of_one_step() {
    let page = include_str!("../docs/findings/performance.md");
    let row = |begin: &str| -> Vec<String> {
        let line = page
            .lines()
            .find(|line| line.starts_with(begin))
            .expect(begin);
        line.trim_matches('|')
            .split('|')
            .map(|cell| cell.trim().to_owned())
            .collect()
    };
    let ours = row("| sandbox, social force | 2.5 m");
    let theirs = row("| JuPedSim 1.4.2, social force | 2.5 m");
    let number = |cell: &String| cell.replace(',', "").parse::<f64>().unwrap();
    let [step, second] = [3, 4].map(|k| (number(&theirs[k]) / number(&ours[k])).round());
    let mut found = 0;
    for (path, page) in all_pages() {
        for paragraph in page
            .split("\n\n")
            .filter(|one| one.contains('×') && one.contains("JuPedSim's"))
        {
            let said = flat(paragraph);
            for words in [
                format!("{second}× faster than JuPedSim's per simulated second"),
                format!("with steps of {} here and {} there", ours[2], theirs[2]),
                format!("per step they are {step}× faster"),
            ] {
                assert!(said.contains(&words), "{}: {words}", path.display());
            }
            found += 1;
        }
    }
    assert_eq!(found, 1);
}
