//! What a slip in a scenario file probably meant: numbers with units, comments, spellings of other languages.

use crate::error::numbers::brief;
use crate::error::quote::shown;

/// Units with their names for messages, and the factor to the unit that keys have.
const UNITS: [(&[&str], &str, f64); 12] = [
    (&["s", "sec", "secs", "second", "seconds"], "seconds", 1.0),
    (&["min", "mins", "minute", "minutes"], "seconds", 60.0),
    (&["h", "hr", "hour", "hours"], "seconds", 3600.0),
    (&["ms"], "seconds", 1e-3),
    (&["m", "meter", "meters", "metre", "metres"], "meters", 1.0),
    (&["cm"], "meters", 1e-2),
    (&["mm"], "meters", 1e-3),
    (&["km"], "meters", 1e3),
    (&["m/s"], "m/s", 1.0),
    (&["km/h", "kmh", "kph"], "m/s", 1.0 / 3.6),
    (&["%"], "a share of 1", 1e-2),
    (&["P/m²", "P/m2", "/m²", "/m2", "1/m²"], "P/m²", 1.0),
];

/// What to write in place of a value of another type than expected; empty if that is not clear. `said` is serde's
/// message, and `given` the text that it quotes.
pub fn of_type(said: &str, given: &str) -> String {
    let expects = |what: &[&str]| {
        what.iter()
            .any(|what| said.contains(&format!("expected {what}")))
    };
    // A number or the one word for a distribution.
    let is_drawn = said.starts_with("unknown variant") && expects(&["`weidmann_age`"]);
    match said.starts_with("invalid type: string") {
        _ if is_drawn => of_text(given),
        true if expects(&["f64", "u32", "u64", "a number", "a whole number"]) => of_text(given),
        true if expects(&["a boolean"]) && ["true", "false"].contains(&given) => {
            format!("; write it without quotes: {given}")
        }
        _ if said.starts_with("invalid type: map, expected a sequence") => {
            "; put brackets around it: [{…}]".to_owned()
        }
        _ => String::new(),
    }
}

/// What to write in place of a text where a number is expected; empty if it has none.
fn of_text(given: &str) -> String {
    let text = given.trim();
    let digits = |c: char| c.is_ascii_digit() || "+-.,eE".contains(c);
    let end = text.find(|c| !digits(c)).unwrap_or(text.len());
    let (number, unit) = (text[..end].trim(), text[end..].trim());
    let value = number.replace(',', ".").parse();
    let Some(value) = value.ok().filter(|value: &f64| value.is_finite()) else {
        return String::new();
    };
    if unit.is_empty() {
        let without = match number.starts_with('+') {
            true => "the plus sign",
            false => "quotes",
        };
        return format!("; write it without {without}: {}", rounded(value));
    }
    let known = UNITS.iter().find(|(names, ..)| names.contains(&unit));
    known.map_or(String::new(), |(_, name, factor)| {
        let value = rounded(value * factor);
        format!("; write {value}, in {name} and without quotes")
    })
}

/// A number with at most six significant digits.
fn rounded(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    brief(rounded)
}

/// What is not JSON in a text at this line and column, both from 1, and what to write; `None` if that is not clear.
pub fn of_syntax(text: &str, line: usize, column: usize) -> Option<String> {
    if text.trim().is_empty() {
        return Some("the file is empty: a scenario is an object, {…}".to_owned());
    }
    if text.trim_start().starts_with('<') {
        return Some(
            "this is XML or HTML, not JSON: a floor plan is named in `walkable_area`".to_owned(),
        );
    }
    let whole = text.lines().nth(line.checked_sub(1)?)?;
    // Columns count bytes.
    let from = (0..column).rev().find(|&k| whole.is_char_boundary(k))?;
    let here = whole.get(from..)?;
    let near = whole.get(from.saturating_sub(1)..).unwrap_or(here);
    let starts = |with: &str| here.starts_with(with) || near.starts_with(with);
    if ["//", "/*", "#"].into_iter().any(starts) {
        return Some(
            "JSON has no comments: remove it, or put the words into `description`".to_owned(),
        );
    }
    let is_letter = |c: &char| c.is_alphanumeric() || *c == '_';
    let word: String = here.chars().take_while(is_letter).collect();
    of_word(&word).or_else(|| of_character(whole, from, &word))
}

/// What to write in place of a word of another language.
fn of_word(word: &str) -> Option<String> {
    let right = match word {
        "True" | "TRUE" => "true",
        "False" | "FALSE" => "false",
        "None" | "NULL" => "null",
        _ if matches!(&*word.to_lowercase(), "nan" | "inf" | "infinity") => {
            let advice = "is no number of JSON: leave the key out for its default";
            return Some(format!("`{}` {advice}", shown(word)));
        }
        _ => return None,
    };
    Some(format!("`{word}` is not JSON: write {right}"))
}

/// What to write in place of the character at `from` in a line, at which `word` begins; the word may be empty.
fn of_character(line: &str, from: usize, word: &str) -> Option<String> {
    let here = &line[from..];
    match here.chars().next()? {
        '\'' => Some("JSON has double quotes: write \"…\" in place of '…'".to_owned()),
        '“' | '”' | '„' | '«' | '»' => {
            Some("these are typographic quotes: JSON has straight ones, \"…\"".to_owned())
        }
        '+' => Some("numbers of JSON have no plus sign: remove it".to_owned()),
        '.' => Some("numbers of JSON begin with a digit: write 0 before the point".to_owned()),
        ';' => Some("JSON has commas between its values, no semicolons".to_owned()),
        '=' => Some("JSON has a colon after a key: write \"key\": value".to_owned()),
        c if !c.is_ascii() && (c.is_whitespace() || "\u{200b}\u{2060}\u{feff}".contains(c)) => {
            Some(format!(
                "a special space, U+{:04X}, stands here: write an ordinary one",
                u32::from(c)
            ))
        }
        c if c.is_ascii_digit() && is_decimal(line, from) => {
            Some("JSON has decimal points: write 1.5, not 1,5".to_owned())
        }
        _ if !word.is_empty() && here[word.len()..].trim_start().starts_with(':') => {
            Some(format!("keys stand in double quotes: \"{}\"", shown(word)))
        }
        _ => None,
    }
}

/// Whether the digit at `from` follows another digit and a comma.
fn is_decimal(line: &str, from: usize) -> bool {
    let before = line[..from].strip_suffix(',');
    before.is_some_and(|before| before.ends_with(|c: char| c.is_ascii_digit()))
}
