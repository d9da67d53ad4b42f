//! docs/paper.md: its tables have every equation, section, table and figure of the paper; the functions that it names
//! are in the files that it names; its code is that of the files; its commands run; its numbers follow from each other.

use std::fs;
use std::path::{Path, PathBuf};

use sandbox::engine::density::SphParameters;

use crate::common::program::{run, stderr};

const PAGE: &str = include_str!("../docs/paper.md");
const PLAIN: &str = "examples/paper.rs";

/// The cells of a row: the place in the paper, what it is, plain code, fast code, figure or table, command.
type Row = [&'static str; 6];

fn rows() -> Vec<Row> {
    let lines = PAGE.lines().filter(|line| line.starts_with("| "));
    let cells = lines.map(|line| {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        <Row>::try_from(cells).unwrap()
    });
    cells.filter(|row| row[0] != "paper").collect()
}

/// The number of the equation of a row.
fn equation(row: &Row) -> Option<u32> {
    Some(row[0].strip_prefix("Eq. ")?.parse().unwrap())
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_owned()
}

fn text_of(file: &str) -> String {
    fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// The files that a cell links to, each with the items that it names after the link; `first` is the file of items
/// before any link.
fn named(cell: &str, first: Option<&str>) -> Vec<(String, Vec<String>)> {
    let mut found: Vec<(String, Vec<String>)> = Vec::new();
    found.extend(first.map(|file| (file.to_owned(), Vec::new())));
    for (k, part) in cell.split('`').enumerate() {
        if k % 2 == 1 {
            found.last_mut().unwrap().1.push(part.to_owned());
            continue;
        }
        let links = part.split("](../").skip(1);
        let targets = links.map(|link| link.split_once(')').unwrap().0.to_owned());
        found.extend(targets.map(|target| (target, Vec::new())));
    }
    found
}

/// The comment of the item of this name in a Rust file; `None` if the file does not define it.
fn comment_of(text: &str, name: &str) -> Option<String> {
    let defines = |line: &str| {
        ["fn", "struct", "enum", "const"].iter().any(|kind| {
            let rest = line.split_once(&format!("{kind} {name}"));
            rest.is_some_and(|(before, after)| {
                let ends = !after.starts_with(|c: char| c.is_alphanumeric() || c == '_');
                ends && !before.contains("//")
            })
        })
    };
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let at = lines.iter().position(|line| defines(line))?;
    let above = lines[..at].iter().rev();
    let above = above.take_while(|line| line.starts_with("///") || line.starts_with("#["));
    let comment: Vec<&str> = above.copied().collect();
    Some(comment.into_iter().rev().collect::<Vec<_>>().join(" "))
}

/// Whether a text names the equation: "Eq. 8", "Eqs. 10, 8 and 5".
fn has_equation(text: &str, number: u32) -> bool {
    let lists = text.split("Eq. ").chain(text.split("Eqs. ")).skip(1);
    lists.into_iter().any(|rest| {
        let list: String = rest.replace(" and ", ", ");
        let end = list.find(|c: char| !(c.is_ascii_digit() || c == ',' || c == ' '));
        let list = &list[..end.unwrap_or(list.len())];
        list.split(", ").any(|one| one.trim().parse() == Ok(number))
    })
}

#[test]
fn the_table_has_every_equation_section_table_and_figure_once() {
    let equations = (1..=23).map(|n| format!("Eq. {n}"));
    let sections = (1..=4).map(|n| format!("§4.{n}"));
    let settings = (1..=6).map(|n| format!("§5.{n}"));
    let tables = (1..=2).map(|n| format!("Table {n}"));
    let figures = (5..=11).map(|n| format!("Fig. {n}"));
    let all = equations.chain(sections).chain(settings);
    let all: Vec<String> = all.chain(tables).chain(figures).collect();
    let places: Vec<&str> = rows().iter().map(|row| row[0]).collect();
    assert_eq!(places, all);
    assert!(PAGE.lines().count() <= 120);
}

#[test]
fn every_named_item_is_in_its_file() {
    let mut count = 0;
    for row in rows() {
        let fast = named(row[3], None);
        for (file, items) in named(row[2], Some(PLAIN)).into_iter().chain(fast) {
            let text = text_of(&file);
            for item in items {
                assert!(
                    comment_of(&text, &item).is_some(),
                    "{row:?}: {file}: {item}"
                );
                count += 1;
            }
        }
    }
    assert!(count > 80, "{count}");
    let text = text_of(PLAIN);
    assert_eq!(comment_of(&text, "press"), None);
    assert_eq!(comment_of(&text, "H").as_deref(), Some(""));
}

#[test]
fn plain_and_fast_code_say_that_they_are_of_the_equation() {
    // Eqs. 1 and 3 have no code of their own; Eqs. 2, 4, 6 and 16 are parts of others.
    let own = |number: &u32| ![1, 2, 3, 4, 6, 16].contains(number);
    let rows = rows();
    let equations = rows.iter().filter_map(|row| Some((equation(row)?, row)));
    for (number, row) in equations {
        let plain = named(row[2], Some(PLAIN)).remove(0).1;
        let fast = named(row[3], None);
        if matches!(number, 1 | 3) {
            assert!(plain.is_empty() && fast.is_empty(), "{row:?}");
            continue;
        }
        let text = text_of(PLAIN);
        let comments = plain.iter().map(|item| comment_of(&text, item).unwrap());
        let is_said = |comment: String| has_equation(&comment, number);
        assert!(
            !own(&number) || comments.into_iter().any(is_said),
            "{row:?}"
        );
        assert!(has_equation(&text, number), "{row:?}");
        let mut is_plain_form = false;
        let mut is_numbered = false;
        for (file, _) in fast {
            let text = text_of(&file);
            is_numbered |= has_equation(&text, number);
            let (_, form) = text.split_once("//! Plain form").expect(&file);
            let (form, _) = form.split_once("`examples/paper.rs`").unwrap();
            is_plain_form |= plain.iter().any(|item| form.contains(&format!("`{item}`")));
        }
        assert!(is_plain_form, "{row:?}");
        assert!(!own(&number) || is_numbered, "{row:?}");
    }
}

#[test]
fn the_code_of_the_page_is_that_of_the_files() {
    let mut blocks = 0;
    for (k, part) in PAGE.split("```rust\n").enumerate().skip(1) {
        let before = PAGE.split("```rust\n").nth(k - 1).unwrap();
        let file = before.trim_end().rsplit('`').nth(1).unwrap();
        let (code, _) = part.split_once("```").unwrap();
        assert!(text_of(file).contains(code), "{file}: {code}");
        blocks += 1;
    }
    assert_eq!(blocks, 2);
}

#[test]
fn the_pressure_of_the_page_follows_from_its_densities() {
    let (_, block) = PAGE.split_once("```text\n").unwrap();
    let number = |name: &str| -> f64 {
        let (_, rest) = block.split_once(&format!("{name} ")).unwrap();
        let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.'));
        rest[..end.unwrap()].parse().unwrap()
    };
    let [density, rest, pressure] = ["density", "rest", "pressure"].map(number);
    let k = SphParameters::default().gas_constant;
    assert!((k * (density - rest) - pressure).abs() < k * 1e-4);
    let said = format!("{k} · ({density} − {rest}) = {pressure:.1}:");
    assert!(PAGE.contains(&said), "{said}");
}

/// The commands of the page, with `inspect` written out.
fn commands() -> Vec<String> {
    let (_, whole) = PAGE.split_once("`inspect` stands for `").unwrap();
    let (whole, _) = whole.split_once('`').unwrap();
    let rows = rows();
    let spans = rows
        .iter()
        .flat_map(|row| row[5].split('`').skip(1).step_by(2));
    let written = spans.map(|span| match span.strip_prefix("inspect") {
        Some(options) => format!("{whole}{options}"),
        None => span.to_owned(),
    });
    let blocks = PAGE.split("```sh\n").skip(1);
    let typed = blocks.flat_map(|block| block.split_once("```").unwrap().0.lines());
    written.chain(typed.map(str::to_owned)).collect()
}

#[test]
fn every_command_is_accepted() {
    let mut commands = commands();
    commands.sort();
    commands.dedup();
    assert!(commands.len() > 20, "{commands:?}");
    for command in commands {
        let words = command.replace('\'', "").replace("--at 5", "--at 0.1");
        let words: Vec<&str> = words.split(' ').collect();
        let words = words.strip_prefix(&["sandbox"]).expect(&command);
        // Runs end early. `reproduce` takes minutes: an unknown option after all others is refused as the first error.
        let (more, code): (&[&str], i32) = match words[0] {
            "evacuation" | "crossing" => (&["--until", "0.1"], 0),
            "reproduce" => (&["--no-such-option"], 2),
            _ => (&[], 0),
        };
        let output = run(&[words, more].concat());
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{command}: {said}");
        if code == 2 {
            assert!(
                said.contains("unexpected argument '--no-such-option'"),
                "{command}: {said}"
            );
        }
    }
}

#[test]
fn the_plain_program_has_the_row_that_the_page_names() {
    let command = "cargo run --release --example paper -- evacuation sf 250";
    assert!(PAGE.contains(command) && text_of(PLAIN).contains(command));
}
