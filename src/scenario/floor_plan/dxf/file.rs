//! The sections of a file → its header, layers, blocks and entities.

use std::collections::HashMap;

use super::entities::{self, Content, Entity};
use super::letters::Letters;
use super::map::{Map, Point};
use super::record::{Record, Records};
use super::syntax;
use crate::floor_plan::error::FloorPlanError;

/// What the header says.
#[derive(Debug, Default)]
pub struct Header {
    /// The number of the unit; 0 if none.
    pub unit: i64,
    version: String,
    page: String,
}

/// A layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Its name.
    pub name: String,
    /// Whether it is off or frozen.
    pub is_off: bool,
    /// Whether blocks on it are hidden, too.
    pub is_frozen: bool,
}

/// The layers of a file.
#[derive(Debug, Default)]
pub struct Layers {
    all: Vec<Layer>,
    /// Their numbers by their names in lowercase.
    numbers: HashMap<String, usize>,
}

impl Layers {
    /// The number of the layer with a name, which may be new.
    pub fn number(&mut self, name: &str) -> usize {
        let next = self.all.len();
        let number = *self.numbers.entry(name.to_lowercase()).or_insert(next);
        if number == next {
            self.all.push(Layer {
                name: name.to_owned(),
                is_off: false,
                is_frozen: false,
            });
        }
        number
    }

    /// All layers.
    pub fn all(&self) -> &[Layer] {
        &self.all
    }
}

/// A block.
#[derive(Debug, Default)]
pub struct Block {
    /// The point that comes to where the block is inserted.
    pub base: Point,
    /// Its entities.
    pub entities: Vec<Entity>,
}

/// A file.
#[derive(Debug, Default)]
pub struct Drawing {
    /// What its header says.
    pub header: Header,
    /// Its layers.
    pub layers: Layers,
    /// Its blocks, by their names in lowercase.
    pub blocks: HashMap<String, Block>,
    /// The entities of its model space.
    pub entities: Vec<Entity>,
    /// How its letters are decoded.
    pub letters: Letters,
}

/// The number of the layer to which entities in blocks belong that take the layer of the block.
pub const LAYER_OF_BLOCK: usize = 0;

/// Reads a file.
pub fn read(bytes: &[u8]) -> Result<Drawing, FloorPlanError> {
    let mut drawing = Drawing::default();
    drawing.layers.number("0");
    let mut records = Records::new(bytes)?;
    while let Some(section) = records.next(true)? {
        match section.kind.as_str() {
            "EOF" => break,
            "SECTION" => {}
            "ENDSEC" => continue,
            other => {
                let found = String::from_utf8_lossy(other.as_bytes());
                return Err(syntax(format!(
                    "{}: expected SECTION, found `{found}`; the file is damaged: save the drawing again",
                    section.at
                )));
            }
        }
        match section.word(2) {
            b"HEADER" => header(&section, &mut drawing)?,
            b"TABLES" => tables(&mut records, &mut drawing)?,
            b"BLOCKS" => blocks(&mut records, &mut drawing)?,
            b"ENTITIES" => drawing.entities = list(&mut records, &mut drawing, "ENDSEC")?,
            _ => while expected(&mut records, false)?.kind != "ENDSEC" {},
        }
    }
    Ok(drawing)
}

/// The next record, which must exist.
fn expected<'a>(records: &mut Records<'a>, keeps: bool) -> Result<Record<'a>, FloorPlanError> {
    match records.next(keeps)? {
        Some(record) if record.kind != "EOF" => Ok(record),
        _ => Err(records.truncated()),
    }
}

/// Reads the variables of the header, which are the pairs of its first record.
fn header(section: &Record, drawing: &mut Drawing) -> Result<(), FloorPlanError> {
    let mut variable: &[u8] = &[];
    let header = &mut drawing.header;
    for pair in &section.pairs {
        if pair.code == 9 {
            variable = pair.word();
            continue;
        }
        let word = || String::from_utf8_lossy(pair.word()).into_owned();
        match variable {
            b"$ACADVER" => header.version = word(),
            b"$DWGCODEPAGE" => header.page = word(),
            b"$INSUNITS" => header.unit = pair.whole()?,
            _ => {}
        }
    }
    drawing.letters = Letters::new(&header.version, &header.page);
    Ok(())
}

/// Reads the table of layers.
fn tables(records: &mut Records, drawing: &mut Drawing) -> Result<(), FloorPlanError> {
    loop {
        let record = expected(records, true)?;
        match record.kind.as_str() {
            "ENDSEC" => return Ok(()),
            "LAYER" => {
                let name = drawing.letters.text(record.word(2));
                let number = drawing.layers.number(&name);
                let layer = &mut drawing.layers.all[number];
                layer.is_frozen = record.whole(70, 0)? & 1 != 0;
                layer.is_off = layer.is_frozen || record.whole(62, 7)? < 0;
            }
            _ => {}
        }
    }
}

/// Reads the blocks.
fn blocks(records: &mut Records, drawing: &mut Drawing) -> Result<(), FloorPlanError> {
    loop {
        let record = expected(records, true)?;
        match record.kind.as_str() {
            "ENDSEC" => return Ok(()),
            "BLOCK" => {
                let name = drawing.letters.text(record.word(2)).to_lowercase();
                let base = record.space(10)?;
                let block = Block {
                    base: [base[0], base[1]],
                    entities: list(records, drawing, "ENDBLK")?,
                };
                drawing.blocks.insert(name, block);
            }
            _ => {}
        }
    }
}

/// Reads entities up to the record `end`.
fn list(
    records: &mut Records,
    drawing: &mut Drawing,
    end: &str,
) -> Result<Vec<Entity>, FloorPlanError> {
    let mut found = Vec::new();
    loop {
        let record = expected(records, true)?;
        if record.kind == end {
            return Ok(found);
        }
        if record.kind == "ENDSEC" {
            let reason = format!(
                "{}: expected {end}, found ENDSEC; save the drawing again",
                record.at
            );
            return Err(syntax(reason));
        }
        let parts = parts(&record, records)?;
        let is_hidden = record.whole(67, 0)? != 0 || record.whole(60, 0)? != 0;
        if !is_hidden {
            found.push(entity(&record, &parts, drawing)?);
        }
    }
}

/// The vertices of a polyline, or the attributes of a block.
fn parts<'a>(
    record: &Record,
    records: &mut Records<'a>,
) -> Result<Vec<Record<'a>>, FloorPlanError> {
    let part = match record.kind.as_str() {
        "POLYLINE" => "VERTEX",
        "INSERT" if record.whole(66, 0)? != 0 => "ATTRIB",
        _ => return Ok(Vec::new()),
    };
    let mut parts = Vec::new();
    loop {
        let next = expected(records, true)?;
        match next.kind.as_str() {
            "SEQEND" => return Ok(parts),
            kind if kind == part => parts.push(next),
            other => {
                return Err(syntax(format!(
                    "{}: expected {part} or SEQEND of the {} at {}, found `{other}`; save the drawing again",
                    next.at, record.kind, record.at
                )));
            }
        }
    }
}

/// An entity of the file.
fn entity(
    record: &Record,
    parts: &[Record],
    drawing: &mut Drawing,
) -> Result<Entity, FloorPlanError> {
    let letters = &drawing.letters;
    let read = match record.kind.as_str() {
        "POLYLINE" => entities::polyline(record, parts),
        _ => entities::content(record, letters),
    };
    let plane = entities::plane(record);
    // Errors matter only on layers that are part of the plan.
    let (content, plane) = match (read, plane) {
        (Ok(Content::Insert(mut insert)), Ok(plane)) => {
            insert.name = entities::name(parts, letters);
            (Content::Insert(insert), plane)
        }
        (Ok(content), Ok(plane)) => (content, plane),
        (Err(error), _) | (_, Err(error)) => (Content::Wrong(error), Map::SAME),
    };
    let name = match record.word(8) {
        [] => "0".to_owned(),
        name => letters.text(name),
    };
    Ok(Entity {
        kind: record.kind.as_str().into(),
        at: record.at,
        handle: String::from_utf8_lossy(record.word(5)).into(),
        layer: drawing.layers.number(&name),
        plane,
        content,
    })
}
