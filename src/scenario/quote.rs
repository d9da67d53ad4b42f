//! Quoting of user input in messages: shortened, and without control characters.

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

/// Is this a control character, or one that reorders or hides text (Unicode Technical Report 36)?
fn is_obeyed(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_repeated_as_it_is_unless_it_is_long_or_a_terminal_obeys_it() {
        for text in ["", "sf->sph", "Zürich 群", "\"a\" `b`"] {
            assert_eq!(shown(text), text);
        }
        assert_eq!(shown("\u{1b}[31m\n\u{9b}"), "\\u{1b}[31m\\n\\u{9b}");
        assert_eq!(shown("a\u{202e}b"), "a\\u{202e}b");
        let long = "ä".repeat(100_000);
        let expected = format!("{}… (100000 characters)", "ä".repeat(80));
        assert_eq!(shown(&long), expected);
        assert_eq!(shown(&"a".repeat(80)), "a".repeat(80));
    }

    #[test]
    fn lines_of_a_printable_text_stay_lines() {
        assert_eq!(printable("a\n\u{7}b\r\n"), "a\n\\u{7}b\\r\n");
    }
}
