//! Values in messages: user input, shortened and without control characters, and rounded lengths.

/// Most characters of a value, name or key in a message.
const LONGEST: usize = 80;
/// Most characters of a library's message, which may quote its input.
const LONGEST_MESSAGE: usize = 400;

/// Quotes a value, name or key: control characters are escaped, and a long text is shortened to its beginning and
/// its length.
pub fn shown(text: &str) -> String {
    within(text, LONGEST)
}

/// Like [`shown`], with a higher limit, for a library's message.
pub fn shown_message(text: &str) -> String {
    within(text, LONGEST_MESSAGE)
}

/// A length in meters, rounded to centimeters.
pub fn to_centimeters(length: f64) -> f64 {
    (100.0 * length).round() / 100.0 + 0.0 // turns −0 into 0
}

/// Escapes control characters except line feeds.
pub fn printable(text: &str) -> String {
    let mut lines = text.split('\n').map(|line| escaped(line.chars()));
    let first = lines.next().unwrap_or_default();
    lines.fold(first, |text, line| text + "\n" + &line)
}

fn within(text: &str, longest: usize) -> String {
    if text.chars().nth(longest).is_none() {
        return escaped(text.chars());
    }
    let start = escaped(text.chars().take(longest));
    format!("{start}… ({} characters)", text.chars().count())
}

fn escaped(characters: impl Iterator<Item = char>) -> String {
    let mut text = String::new();
    for c in characters {
        if is_obeyed(c) {
            text.extend(c.escape_default());
        } else {
            text.push(c);
        }
    }
    text
}

/// Whether this is a control character, or one that reorders or hides text (Unicode Technical Report 36).
fn is_obeyed(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}')
}
