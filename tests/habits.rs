//! Habits of the code that reviews asked for, counted: functions that are too long, values that are bound to the same
//! name again and again, and anonymous tuples among arguments. The limits may only fall.

use std::path::Path;

use crate::architecture::{code, files};

/// Lines of a function from which on it counts as long, and how many may be long.
const LONG: usize = 60;
const MOST_LONG: usize = 8;
/// How many times a name may be bound again in the block that has bound it.
const MOST_REBOUND: usize = 260;
/// How many functions may have a tuple of three or more values among their arguments.
const MOST_TUPLES: usize = 20;

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// Whether a line begins a function.
fn begins_function(line: &str) -> bool {
    let words = line.trim_start();
    let words = words.strip_prefix("pub").map_or(words, |rest| {
        let rest = rest.strip_prefix('(').and_then(|rest| rest.split_once(')'));
        rest.map_or(words.trim_start_matches("pub"), |(_, rest)| rest)
    });
    let words = words.trim_start().trim_start_matches("const ");
    words.trim_start_matches("unsafe ").starts_with("fn ")
}

/// The numbers of lines of the functions of a file.
fn lengths(lines: &[String]) -> Vec<usize> {
    let starts = (0..lines.len()).filter(|&k| begins_function(&lines[k]));
    let length = |start: usize| {
        let end = format!("{}}}", &lines[start][..indent(&lines[start])]);
        let same_line = lines[start].ends_with(['}', ';']);
        let rest = lines[start..].iter();
        let found = rest.take_while(|line| **line != end).count() + 1;
        if same_line { 1 } else { found }
    };
    starts.map(length).collect()
}

/// The name that a line binds with `let NAME` or `let mut NAME`.
fn bound(line: &str) -> Option<&str> {
    let rest = line.trim_start().strip_prefix("let ")?;
    let rest = rest.strip_prefix("mut ").unwrap_or(rest);
    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'))?;
    let after = rest[end..].trim_start();
    (end > 0 && after.starts_with([':', '='])).then(|| &rest[..end])
}

/// How often a name is bound again in the block that has bound it.
fn rebound(lines: &[String]) -> usize {
    let mut open: Vec<(usize, &str)> = Vec::new();
    let mut count = 0;
    for line in lines.iter().filter(|line| !line.trim().is_empty()) {
        let depth = indent(line);
        if begins_function(line) {
            open.clear();
        }
        if line.trim_start().starts_with('}') {
            open.retain(|&(of_block, _)| of_block <= depth);
        }
        if let Some(name) = bound(line) {
            open.retain(|&(of_block, _)| of_block <= depth);
            count += usize::from(open.contains(&(depth, name)));
            open.push((depth, name));
        }
    }
    count
}

/// The number of values of the widest tuple among the arguments, for each function of a text.
fn widest_tuples(text: &str) -> Vec<usize> {
    let functions = text.match_indices("fn ").filter_map(|(at, _)| {
        let begins = at == 0 || text[..at].ends_with([' ', '\n']);
        let rest = &text[at + 3..];
        let arguments = &rest[rest.find('(')?..];
        begins.then(|| widest_tuple(arguments))
    });
    functions.collect()
}

/// The largest number of values of a tuple in the parentheses with which a text begins.
fn widest_tuple(arguments: &str) -> usize {
    let mut depths: Vec<(usize, bool)> = Vec::new();
    let (mut widest, mut before) = (0, ' ');
    for c in arguments.chars() {
        match c {
            '(' | '[' | '{' | '<' => {
                // After a name, as in `Fn(…)`, it is no tuple.
                let is_tuple = c == '(' && !depths.is_empty() && !before.is_alphanumeric();
                depths.push((0, is_tuple));
            }
            '>' if before == '-' || before == '=' => {}
            ')' | ']' | '}' | '>' => {
                if let Some((commas, true)) = depths.pop() {
                    widest = widest.max(commas + usize::from(before != ','));
                }
                if depths.is_empty() {
                    break;
                }
            }
            ',' => {
                if let Some((commas, _)) = depths.last_mut() {
                    *commas += 1;
                }
            }
            _ => {}
        }
        if !c.is_whitespace() {
            before = c;
        }
    }
    widest
}

#[test]
fn few_functions_are_long_few_names_are_bound_again_and_few_arguments_are_wide_tuples() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut long, mut again, mut tuples) = (Vec::new(), 0, 0);
    for path in files(&source) {
        let lines: Vec<String> = code(&path).into_iter().map(|(_, line)| line).collect();
        let too_long = lengths(&lines).into_iter().filter(|&length| length > LONG);
        long.extend(too_long.map(|length| (path.clone(), length)));
        again += rebound(&lines);
        tuples += widest_tuples(&lines.join("\n"))
            .into_iter()
            .filter(|&width| width >= 3)
            .count();
    }
    assert!(long.len() <= MOST_LONG, "{long:?}");
    assert!(again <= MOST_REBOUND, "{again} names are bound again");
    assert!(tuples <= MOST_TUPLES, "{tuples} functions with wide tuples");
}

/// Functions of floating-point numbers that differ between systems, or between processors with other vectors.
const DIFFER: [&str; 25] = [
    "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "sin", "cos", "tan",
    "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
    "hypot", "mul_add",
];

#[test]
fn states_and_measured_values_come_from_functions_that_are_the_same_everywhere() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let folders = ["engine", "scenario", "analysis"].map(|folder| source.join(folder));
    let mut found = Vec::new();
    for path in folders.iter().flat_map(|folder| files(folder)) {
        for (number, line) in code(&path) {
            let calls = DIFFER
                .iter()
                .filter(|name| line.contains(&format!(".{name}(")));
            found.extend(calls.map(|name| format!("{}:{number}: {name}", path.display())));
        }
    }
    assert!(
        found.is_empty(),
        "use libm, and mul_add_precise: {found:#?}"
    );
}

#[test]
fn the_counts_are_those_of_small_texts() {
    let lines: Vec<String> = SMALL.lines().map(str::to_owned).collect();
    assert_eq!((lengths(&lines), rebound(&lines)), (vec![8, 1], 1));
    assert_eq!(widest_tuples(TUPLES), [3, 3, 0, 3]);
}

const SMALL: &str = "pub(super) fn f(a: u8) {
    let x = 1;
    let y = 2;
    let x = x + y;
    {
        let x = 3;
    }
}
fn g() {}
";

const TUPLES: &str = "fn f(a: (u8, u8, u8)) {}
fn g((a, b, c): (u8, u8, u8), d: &(u8, u8)) {}
fn h(f: impl Fn(u8, u8, u8)) {}
fn i(v: [(u8, u8, u8); 2]) {}
";
