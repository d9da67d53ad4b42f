//! HTML files of one piece: a page that plays a run, a report. They have no links to other files, and their content
//! security policy forbids requests, so they open from a disk and can be mailed.
//!
//! How to write one: a [`Head`] begins the file, [`escape`] makes text of any string, [`Table::html`] a table,
//! [`picture`] shows an SVG drawing, [`data`] and [`bytes`] hold what a script reads, and [`END`] ends the file. The
//! style sheet
//! `style.css` has the look that all of them share; a kind of file adds its own rules.
//!
//! [`Table::html`]: crate::table::Table::html

use std::fmt::Write as _;

use serde_json::Value;

/// The rules that all files share: fonts, colors, tables, print.
const STYLE: &str = include_str!("style.css");
/// The end of a file.
pub const END: &str = "</body>\n</html>\n";
/// The program, its version and its licenses, in one line of HTML.
pub const PROGRAM: &str = concat!(
    "sandbox ",
    env!("CARGO_PKG_VERSION"),
    ", a research sandbox for dense crowds; license ",
    env!("CARGO_PKG_LICENSE")
);

/// The beginning of a file.
#[derive(Debug, Clone, Copy, Default)]
pub struct Head<'a> {
    /// The title in the browser's window.
    pub title: &'a str,
    /// Rules beside those that all files share.
    pub style: &'a str,
    /// A script that runs while the file is read.
    pub script: &'a str,
    /// What the content security policy allows beside styles, scripts and images in the file; usually nothing.
    pub allowed: &'a str,
}

impl Head<'_> {
    /// The file up to the beginning of its body.
    pub fn text(&self) -> String {
        let title = escape(self.title);
        let script = match self.script {
            "" => String::new(),
            script => format!("<script>\n{script}</script>\n"),
        };
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; \
             style-src 'unsafe-inline'; img-src data:; script-src 'unsafe-inline'{}\">\n\
             <meta name=\"generator\" content=\"{PROGRAM}\">\n<link rel=\"icon\" href=\"data:,\">\n\
             <title>{title}</title>\n<style>\n{STYLE}{}</style>\n{script}</head>\n<body>\n",
            self.allowed, self.style,
        )
    }
}

/// A text in which no character has a meaning in HTML: neither in elements nor in quoted attributes.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            // HTML has no other control characters.
            c if c.is_control() && !matches!(c, '\n' | '\t') => escaped.push('\u{fffd}'),
            c => escaped.push(c),
        }
    }
    escaped
}

/// Data for a script: `JSON.parse(document.getElementById(id).textContent)`.
pub fn data(id: &str, value: &Value) -> String {
    // In a script element only `<` has a meaning; in JSON it occurs only in strings.
    let text = value.to_string().replace('<', "\\u003c");
    format!("<script type=\"application/json\" id=\"{id}\">{text}</script>\n")
}

/// Bytes for a script, in base64, as an element of a class: there may be several.
pub fn bytes(class: &str, bytes: &[u8]) -> String {
    let text = base64(bytes);
    format!("<script type=\"text/plain\" class=\"{class}\">{text}</script>\n")
}

/// An SVG drawing as an image: its names and rules do not reach the rest of the file. `about` describes it in words.
pub fn picture(svg: &str, about: &str) -> String {
    let (about, image) = (escape(about), base64(svg.as_bytes()));
    format!("<img alt=\"{about}\" src=\"data:image/svg+xml;base64,{image}\">\n")
}

/// A JSON value as rows of names and texts, with the names of nested objects joined by dots; arrays stay whole.
pub fn facts(value: &Value) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    add_facts(&mut rows, String::new(), value);
    rows
}

fn add_facts(rows: &mut Vec<(String, String)>, name: String, value: &Value) {
    match value {
        Value::Object(entries) => {
            for (key, value) in entries {
                let mut inner = name.clone();
                let dot = if name.is_empty() { "" } else { "." };
                write!(inner, "{dot}{key}").ok();
                add_facts(rows, inner, value);
            }
        }
        Value::String(text) => rows.push((name, text.clone())),
        value => rows.push((name, value.to_string())),
    }
}

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Base64 (RFC 4648), padded.
fn base64(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |k: usize| u32::from(group.get(k).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * k) & 63) as usize];
            text.push(if k > group.len() { '=' } else { digit.into() });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn base64_is_that_of_the_standard() {
        // The test vectors of RFC 4648.
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(base64(&[0xfb, 0xff]), "+/8=");
    }

    #[test]
    fn no_text_ends_an_element_an_attribute_or_a_script() {
        let hostile = "</script><b x=\"'\">&amp;\u{0}";
        assert!(!escape(hostile).contains(['<', '>', '"', '\'', '\u{0}']));
        assert_eq!(escape("a & b"), "a &amp; b");
        let script = data("id", &json!({ "name": hostile }));
        assert_eq!(script.matches('<').count(), 2, "{script}");
        let text = script
            .split_once('>')
            .unwrap()
            .1
            .rsplit_once('<')
            .unwrap()
            .0;
        assert_eq!(
            serde_json::from_str::<Value>(text).unwrap()["name"],
            hostile
        );
    }

    #[test]
    fn facts_have_the_names_of_all_keys_on_their_way() {
        let rows = facts(&json!({"a": {"b": 1, "c": "x"}, "d": [1, 2]}));
        let expected = [("a.b", "1"), ("a.c", "x"), ("d", "[1,2]")];
        assert_eq!(rows, expected.map(|(a, b)| (a.to_owned(), b.to_owned())));
    }
}
