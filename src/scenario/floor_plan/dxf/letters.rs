//! The letters of texts: code pages, and the codes that texts contain.

use std::cell::Cell;

/// How a file stores letters.
#[derive(Debug, Clone, PartialEq, Default)]
enum Page {
    /// Files since version AC1021.
    Utf8,
    /// Western European.
    #[default]
    Latin1,
    /// A code page that is not read.
    Other(String),
}

/// Decodes the texts of a file.
#[derive(Debug, Default)]
pub struct Letters {
    page: Page,
    /// Whether letters were replaced by question marks.
    is_lossy: Cell<bool>,
}

impl Letters {
    /// The letters of a file with this version, such as AC1015, and this code page.
    pub fn new(version: &str, page: &str) -> Self {
        let number = version.get(2..).and_then(|digits| digits.parse().ok());
        let is_utf8 = number.is_some_and(|number: u32| number >= 1021);
        let name = page.trim().to_ascii_uppercase();
        let page = match name.as_str() {
            _ if is_utf8 => Page::Utf8,
            "" | "ANSI_1252" | "DOS850" | "ISO8859-1" | "ISO-8859-1" | "ASCII" => Page::Latin1,
            "UTF8" | "UTF-8" => Page::Utf8,
            _ => Page::Other(name),
        };
        Self {
            page,
            is_lossy: Cell::new(false),
        }
    }

    /// A note on the code page, if it is not read and letters were lost by it.
    pub fn note(&self) -> Option<String> {
        match &self.page {
            Page::Other(name) if self.is_lossy.get() => Some(format!(
                "the code page {name} is not read: other letters than those of ASCII are `?` in names; save the \
                 drawing as DXF of version 2007 or later"
            )),
            _ => None,
        }
    }

    /// A text without spaces around it.
    pub fn text(&self, bytes: &[u8]) -> String {
        let bytes = bytes.trim_ascii();
        let text = match self.page {
            // Some programs write UTF-8 whatever the version says.
            Page::Utf8 => String::from_utf8_lossy(bytes).into_owned(),
            Page::Latin1 => match std::str::from_utf8(bytes) {
                Ok(text) => text.to_owned(),
                Err(_) => bytes.iter().copied().map(windows_1252).collect(),
            },
            Page::Other(_) => {
                self.is_lossy.set(self.is_lossy.get() || !bytes.is_ascii());
                let letter = |&byte: &u8| {
                    if byte.is_ascii() {
                        char::from(byte)
                    } else {
                        '?'
                    }
                };
                bytes.iter().map(letter).collect()
            }
        };
        unescaped(&text)
    }
}

/// A letter of the code page 1252.
fn windows_1252(byte: u8) -> char {
    const MIDDLE: [char; 32] = [
        '€', '?', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '?', 'Ž', '?', '?', '‘',
        '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '?', 'ž', 'Ÿ',
    ];
    match byte {
        0x80..=0x9f => MIDDLE[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}

/// A text with the letters that `\U+XXXX` stands for.
fn unescaped(text: &str) -> String {
    let mut parts = text.split("\\U+");
    let mut found = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let code = part.get(..4);
        let letter = code.and_then(|code| u32::from_str_radix(code, 16).ok());
        match letter.and_then(char::from_u32) {
            Some(letter) => {
                found.push(letter);
                found.push_str(&part[4..]);
            }
            None => {
                found.push_str("\\U+");
                found.push_str(part);
            }
        }
    }
    found
}

/// The text of a TEXT or MTEXT without its formatting, on one line.
pub fn plain(text: &str) -> String {
    let mut found = String::new();
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '{' | '}' => {}
            '\\' => match letters.next() {
                // A name is the first line.
                Some('P' | 'N' | 'X') if !found.trim().is_empty() => break,
                Some('P' | 'n' | '~' | 'N' | 'X') => found.push(' '),
                Some(other @ ('\\' | '{' | '}')) => found.push(other),
                // Switches without a value.
                Some('L' | 'l' | 'O' | 'o' | 'K' | 'k') | None => {}
                // Codes such as `\H2.5;` end with a semicolon.
                Some('S') => found.extend(letters.by_ref().take_while(|&letter| letter != ';')),
                Some(_) => letters
                    .by_ref()
                    .take_while(|&letter| letter != ';')
                    .for_each(drop),
            },
            '%' if letters.peek() == Some(&'%') => {
                letters.next();
                match letters.next() {
                    Some('d' | 'D') => found.push('°'),
                    Some('p' | 'P') => found.push('±'),
                    Some('c' | 'C') => found.push('Ø'),
                    _ => {}
                }
            }
            letter if letter.is_control() => found.push(' '),
            letter => found.push(letter),
        }
    }
    let words: Vec<&str> = found.split_whitespace().collect();
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_read_by_version_and_code_page() {
        let old = Letters::new("AC1015", "ANSI_1252");
        assert_eq!(old.text(b"T\xfcr \\U+00DF"), "Tür ß");
        assert_eq!(old.text("Tür".as_bytes()), "Tür");
        assert_eq!(old.note(), None);
        assert_eq!(
            Letters::new("AC1027", "ANSI_1252").text("Tür".as_bytes()),
            "Tür"
        );
        let other = Letters::new("AC1009", "ANSI_936");
        assert_eq!(other.text(b"A\xfc\\U+12"), "A?\\U+12");
        assert!(other.note().unwrap().contains("ANSI_936"));
    }

    #[test]
    fn formatting_of_texts_is_left_out() {
        let formatted = "{\\fArial|b0;Hall}\\P%%uNord \\H2.5x;A\\\\B";
        assert_eq!(plain(formatted), "Hall");
        assert_eq!(plain("Hall A\\\\B"), "Hall A\\B");
        assert_eq!(plain("20%%d, 50%"), "20°, 50%");
    }
}
