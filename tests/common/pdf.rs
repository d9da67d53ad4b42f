//! Reads the PDFs of the program page by page: texts by the map from glyphs to letters that the file has, and circles.

use std::collections::BTreeMap;

use miniz_oxide::inflate::decompress_to_vec_zlib;

/// A page.
pub struct Page {
    /// Its texts in the order in which they are drawn, one per line.
    pub text: String,
    /// The centers of its circles in the order in which they are drawn, units with y down, relative to the figure.
    pub circles: Vec<[f64; 2]>,
}

impl Page {
    /// Its text without line breaks.
    pub fn words(&self) -> String {
        self.text.replace('\n', " ")
    }
}

/// An object: what stands before its stream, and its decompressed stream.
type Object = (String, Vec<u8>);

/// The pages of a PDF.
pub fn pages(pdf: &[u8]) -> Vec<Page> {
    assert!(pdf.starts_with(b"%PDF-") && pdf.trim_ascii_end().ends_with(b"%%EOF"));
    let objects = objects(pdf);
    let maps = objects.values().map(|(_, stream)| letters(stream));
    let letters: BTreeMap<u16, String> = maps.flatten().collect();
    let is_page = |(words, _): &&Object| words.contains("/Type /Page\n");
    let contents = objects.values().filter(is_page).map(|(words, _)| {
        let reference = between(words, "/Contents ", " 0 R");
        &objects[&reference.parse().unwrap()].1
    });
    contents.map(|content| page(content, &letters)).collect()
}

fn between<'a>(text: &'a str, begin: &str, end: &str) -> &'a str {
    let (_, rest) = text.split_once(begin).unwrap();
    rest.split_once(end).unwrap().0
}

fn find(bytes: &[u8], words: &str) -> Option<usize> {
    bytes
        .windows(words.len())
        .position(|part| part == words.as_bytes())
}

fn objects(pdf: &[u8]) -> BTreeMap<u32, Object> {
    let (mut objects, mut rest) = (BTreeMap::new(), pdf);
    while let Some(at) = find(rest, " 0 obj") {
        let before = String::from_utf8_lossy(&rest[..at]).into_owned();
        let number = before.rsplit('\n').next().unwrap().parse().unwrap();
        rest = &rest[at + " 0 obj".len()..];
        let end = find(rest, "endobj").unwrap();
        let Some(begin) = find(&rest[..end], "stream\n") else {
            let words = String::from_utf8_lossy(&rest[..end]).into_owned();
            objects.insert(number, (words, Vec::new()));
            continue;
        };
        let words = String::from_utf8_lossy(&rest[..begin]).into_owned();
        let length = between(&words, "/Length ", "\n").trim().parse().unwrap();
        let data: &[u8] = &rest[begin + "stream\n".len()..][..length];
        let data = match words.contains("/FlateDecode") {
            true => decompress_to_vec_zlib(data).unwrap(),
            false => data.to_vec(),
        };
        rest = &rest[begin + "stream\n".len() + length..];
        objects.insert(number, (words, data));
    }
    objects
}

/// The letters of glyphs, if this is such a map: lines like `<0001> <0041>`.
fn letters(stream: &[u8]) -> Vec<(u16, String)> {
    let text = String::from_utf8_lossy(stream);
    let parts = text.split("beginbfchar").skip(1);
    let lines = parts.flat_map(|part| part.split("endbfchar").next().unwrap().lines());
    let pairs = lines.filter_map(|line| {
        let mut words = line
            .split_whitespace()
            .map(|word| word.trim_matches(['<', '>']));
        let glyph = u16::from_str_radix(words.next()?, 16).ok()?;
        let units =
            words.next()?.as_bytes().chunks(4).map(|digits| {
                u16::from_str_radix(std::str::from_utf8(digits).unwrap(), 16).unwrap()
            });
        let units: Vec<u16> = units.collect();
        Some((glyph, String::from_utf16(&units).unwrap()))
    });
    pairs.collect()
}

fn page(content: &[u8], letters: &BTreeMap<u16, String>) -> Page {
    let (mut text, mut circles) = (String::new(), Vec::new());
    let (mut numbers, mut string, mut curves) = (Vec::new(), Vec::new(), Vec::new());
    let mut start = [0.0; 2];
    let mut rest = content;
    while let Some((&first, after)) = rest.split_first() {
        match first {
            b' ' | b'\n' => rest = after,
            b'<' => {
                let end = find(after, ">").unwrap();
                let digits = std::str::from_utf8(&after[..end]).unwrap();
                let digits = digits.as_bytes().chunks(2);
                string = digits
                    .map(|pair| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap())
                    .collect();
                rest = &after[end + 1..];
            }
            b'(' => (string, rest) = literal(after),
            _ => {
                let end = rest.iter().position(|c| b" \n<([".contains(c));
                let (word, after) = rest.split_at(end.unwrap_or(rest.len()).max(1));
                rest = after;
                let word = std::str::from_utf8(word).unwrap();
                if let Ok(number) = word.parse::<f64>() {
                    numbers.push(number);
                    continue;
                }
                match word {
                    "m" => (start, curves) = ([numbers[0], numbers[1]], Vec::new()),
                    "c" => curves.push([numbers[4], numbers[5]]),
                    "f" if curves.len() == 4 => {
                        // Half a turn leads to the other end of a diameter.
                        circles.push([0, 1].map(|k| 0.5 * (start[k] + curves[1][k])));
                    }
                    "Tj" => {
                        let glyphs = string
                            .chunks(2)
                            .map(|pair| u16::from_be_bytes([pair[0], pair[1]]));
                        text.extend(glyphs.map(|glyph| letters[&glyph].as_str()));
                        text.push('\n');
                    }
                    _ => {}
                }
                if word != "m" && word != "c" {
                    curves.clear();
                }
                numbers.clear();
            }
        }
    }
    Page { text, circles }
}

/// A string in brackets, after its first one.
fn literal(mut rest: &[u8]) -> (Vec<u8>, &[u8]) {
    let (mut bytes, mut depth) = (Vec::new(), 1);
    loop {
        let (&first, after) = rest.split_first().unwrap();
        rest = after;
        match first {
            b'\\' => {
                let (&escaped, after) = rest.split_first().unwrap();
                rest = after;
                bytes.push(match escaped {
                    b'n' => b'\n',
                    b'r' => b'\r',
                    b't' => b'\t',
                    b'b' => 8,
                    b'f' => 12,
                    b'0'..=b'7' => {
                        let digits = std::str::from_utf8(&rest[..2]).unwrap();
                        let low = u8::from_str_radix(digits, 8).unwrap();
                        rest = &rest[2..];
                        (escaped - b'0') * 64 + low
                    }
                    other => other,
                });
                continue;
            }
            b'(' => depth += 1,
            b')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return (bytes, rest);
        }
        bytes.push(first);
    }
}
