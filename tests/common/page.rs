//! Reads pages as docs/reference/page-format.md describes them.

use std::collections::BTreeMap;
use std::path::Path;

use miniz_oxide::inflate::decompress_to_vec;
use serde_json::Value;

/// What a page says about a person in a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Person {
    pub group: usize,
    /// Meters.
    pub radius: f64,
    /// The whole numbers of all columns.
    pub values: Vec<i32>,
}

/// People by id.
pub type People = BTreeMap<i64, Person>;

/// A page.
pub struct Page {
    pub html: String,
    pub scene: Value,
    /// Seconds.
    pub times: Vec<f64>,
    /// The people in each frame, and those whose accelerations are known.
    pub crowds: Vec<People>,
    pub forces: Vec<People>,
    /// The values of each time series.
    pub series: Vec<Vec<Option<f64>>>,
    /// The number of parts.
    pub parts: usize,
}

impl Page {
    pub fn read(path: &Path) -> Self {
        let html = std::fs::read_to_string(path).unwrap();
        let scene = elements(&html, r#"<script type="application/json" id="scene">"#);
        let scene: Value = serde_json::from_str(scene[0]).unwrap();
        let radius = scene["units"]["radius"].as_f64().unwrap();
        let frames = |class: &str, columns: usize| {
            let mut all: Vec<People> = Vec::new();
            for bytes in bytes(&html, class) {
                let block = block(&bytes, columns, radius);
                if let Some(last) = all.pop() {
                    assert_eq!(
                        last, block[0],
                        "a part begins with the last frame of the one before"
                    );
                }
                all.extend(block);
            }
            all
        };
        let mut page = Self {
            crowds: frames("crowd", scene["columns"].as_array().unwrap().len()),
            forces: frames("forces", 2 * scene["terms"].as_array().unwrap().len()),
            times: Vec::new(),
            series: vec![Vec::new(); scene["series"].as_array().unwrap().len()],
            parts: 0,
            scene,
            html: String::new(),
        };
        for bytes in bytes(&html, "series") {
            let part: Value = serde_json::from_slice(&bytes).unwrap();
            let numbers = |list: &Value| -> Vec<Option<f64>> {
                list.as_array().unwrap().iter().map(Value::as_f64).collect()
            };
            page.times
                .extend(numbers(&part["times"]).into_iter().flatten());
            for (k, values) in page.series.iter_mut().enumerate() {
                values.extend(numbers(&part["series"][k]));
            }
            page.parts += 1;
        }
        page.html = html;
        assert_eq!(page.crowds.len(), page.times.len());
        page
    }

    /// The bytes of the elements of a class.
    pub fn bytes(&self, class: &str) -> Vec<Vec<u8>> {
        bytes(&self.html, class)
    }

    /// The place of a person, meters.
    pub fn position(&self, person: &Person) -> [f64; 2] {
        let unit = self.unit("position");
        let origin = &self.scene["origin"];
        [0, 1].map(|axis| origin[axis].as_f64().unwrap() + f64::from(person.values[axis]) * unit)
    }

    /// The density (column 2) or the speed (3) of a person.
    pub fn value(&self, person: &Person, name: &str) -> Option<f64> {
        let columns = self.scene["columns"].as_array().unwrap();
        let k = columns.iter().position(|column| column == name).unwrap();
        let value = person.values[k];
        (value > 0).then(|| f64::from(value - 1) * self.unit(name))
    }

    pub fn unit(&self, name: &str) -> f64 {
        self.scene["units"][name].as_f64().unwrap()
    }
}

/// The texts of the elements with this beginning.
pub fn elements<'a>(html: &'a str, begin: &str) -> Vec<&'a str> {
    let parts = html.split(begin).skip(1);
    parts
        .map(|part| part.split_once("</script>").unwrap().0)
        .collect()
}

fn bytes(html: &str, class: &str) -> Vec<Vec<u8>> {
    let begin = format!(r#"<script type="text/plain" class="{class}">"#);
    let texts = elements(html, &begin).into_iter();
    texts
        .map(|text| decompress_to_vec(&from_base64(text)).unwrap())
        .collect()
}

/// Decodes base64.
pub fn from_base64(text: &str) -> Vec<u8> {
    let digit = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        c => panic!("{c} in base64"),
    };
    let (mut bytes, mut bits, mut count) = (Vec::new(), 0_u32, 0);
    for c in text.trim_end_matches('=').bytes() {
        bits = bits << 6 | u32::from(digit(c));
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count & 255) as u8);
        }
    }
    bytes
}

/// Reads numbers.
struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    fn byte(&mut self) -> u8 {
        let (first, rest) = self.0.split_first().unwrap();
        self.0 = rest;
        *first
    }

    fn number(&mut self) -> u64 {
        let (mut value, mut shift) = (0, 0);
        loop {
            let byte = self.byte();
            value |= u64::from(byte & 127) << shift;
            shift += 7;
            if byte < 128 {
                return value;
            }
        }
    }

    fn signed(&mut self) -> i64 {
        let number = self.number();
        match number % 2 {
            0 => (number / 2) as i64,
            _ => -((number / 2) as i64) - 1,
        }
    }
}

/// The people in each frame of a block.
pub fn block(bytes: &[u8], columns: usize, radius: f64) -> Vec<People> {
    let mut numbers = Numbers(bytes);
    let frames = numbers.number() as usize;
    let tracks = numbers.number() as usize;
    let mut people = vec![People::new(); frames];
    let mut heads = Vec::new();
    let mut id = 0;
    for _ in 0..tracks {
        id += numbers.signed();
        let [first, count] = [numbers.number(), numbers.number()].map(|n| n as usize);
        let own = f64::from(numbers.number() as u32) * radius;
        let group = numbers.number() as usize;
        assert!(first + count <= frames);
        for here in people.iter_mut().skip(first).take(count) {
            let person = Person {
                group,
                radius: own,
                values: Vec::new(),
            };
            assert!(here.insert(id, person).is_none(), "{id} twice in a frame");
        }
        heads.push((id, first, count));
    }
    assert!(heads.is_sorted());
    for _ in 0..columns {
        let order = numbers.byte();
        assert!(order == 1 || order == 2);
        let mut start = 0_i32;
        for &(id, first, count) in &heads {
            let mut values: Vec<i32> = Vec::new();
            for k in 0..count {
                let expected = match (k, order) {
                    (0, _) => start,
                    (1, _) | (_, 1) => values[k - 1],
                    _ => values[k - 1].wrapping_add(values[k - 1].wrapping_sub(values[k - 2])),
                };
                values.push(expected.wrapping_add(numbers.signed() as i32));
            }
            start = values[0];
            for (k, value) in values.into_iter().enumerate() {
                people[first + k].get_mut(&id).unwrap().values.push(value);
            }
        }
    }
    assert!(numbers.0.is_empty());
    people
}
