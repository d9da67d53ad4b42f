//! Reads the HDF5 files of the Pedestrian Dynamics Data Archive: a dataset `trajectory` of records with `id`, `frame`,
//! `x` and `y`, its attribute `fps`, and the walkable area in the attribute `wkt_geometry` of the file. The only file
//! that names hdf5_pure.

use crate::error::quote::{shown, shown_message};
use std::path::Path;

use hdf5_pure::{AttrValue, CompoundMember, Dataset, Datatype, DatatypeByteOrder, File};

use super::error::ReadError;
use super::level::Levels;
use super::tracks::{Contents, Entry, Tracks};
use super::{ReadOptions, Unit, frame_rate};
use engine::math::Vector;

/// Rows that are decoded at a time.
const ROWS: u64 = 1 << 16;
/// The highest compression that is plausible: deflate reaches about 1030.
const MOST_COMPRESSED: u64 = 1100;

pub fn read(path: &Path, options: &ReadOptions) -> Result<Tracks, ReadError> {
    let contents = contents(path, options)
        .map_err(|problem| ReadError::file(path, shown_message(&problem)))?;
    Levels::new(&options.level).check(path)?;
    Tracks::new(path, contents, options)
}

/// The content of a file, or what is wrong with it.
fn contents(path: &Path, options: &ReadOptions) -> Result<Contents, String> {
    let file = File::open(path).map_err(|error| damaged(&error))?;
    let trajectory = file.dataset("trajectory").map_err(|error| {
        format!(
            "this HDF5 file has no dataset `trajectory`, as those of the Pedestrian Dynamics Data Archive have \
             ({error}); convert it to text or SQLite"
        )
    })?;
    let about = trajectory.attrs().map_err(|error| damaged(&error))?;
    let fps = match about.get("fps").map(number_of) {
        Some(text) => options
            .own_rate(frame_rate(&text))
            .map_err(|problem| format!("attribute fps of `trajectory`: {problem}"))?,
        None => None,
    };
    let own = file.root().attrs().map_err(|error| damaged(&error))?;
    let walkable = own.get("wkt_geometry").and_then(AttrValue::as_str);
    let mut contents = Contents {
        unit: Some(Unit::Meter),
        fps,
        walkable: walkable.map(str::to_owned).into_iter().collect(),
        place: "row",
        ..Contents::default()
    };
    add_rows(path, &trajectory, &mut contents)?;
    Ok(contents)
}

fn damaged(error: &hdf5_pure::Error) -> String {
    format!("this HDF5 file cannot be read: {error}")
}

/// A number as text, for the check of frame rates.
fn number_of(value: &AttrValue) -> String {
    let whole = || value.as_i64().map(|number| number.to_string());
    let number = value.as_f64().map(|number| number.to_string());
    let text = || value.as_str().map(str::to_owned);
    number.or_else(whole).or_else(text).unwrap_or_default()
}

fn add_rows(path: &Path, trajectory: &Dataset, contents: &mut Contents) -> Result<(), String> {
    let shape = trajectory.shape().map_err(|error| damaged(&error))?;
    let datatype = trajectory.datatype().map_err(|error| damaged(&error))?;
    let ([rows], Datatype::Compound { size, members }) = (shape.as_slice(), datatype) else {
        let problem = "its dataset `trajectory` is not a list of records with id, frame, x and y";
        return Err(problem.to_owned());
    };
    let field = |name| Field::named(&members, name, size);
    let (id, frame) = (field("id")?, field("frame")?);
    let (x, y) = (field("x")?, field("y")?);
    let bytes = path.metadata().map_or(u64::MAX, |about| about.len());
    if rows.saturating_mul(u64::from(size)) > bytes.saturating_mul(MOST_COMPRESSED) {
        return Err(format!(
            "`trajectory` has {rows} rows, more than fit into the file: it is damaged"
        ));
    }
    for first in (0..*rows).step_by(ROWS as usize) {
        let read = trajectory.read_raw_rows(first, ROWS);
        let records = read.map_err(|error| damaged(&error))?;
        for (line, record) in (first + 1..).zip(records.chunks_exact(size as usize)) {
            let parsed = || {
                Ok(Entry {
                    frame: frame.whole(record)?,
                    id: id.whole(record)?,
                    position: Vector::new(x.finite(record)?, y.finite(record)?),
                    mass: 1.0,
                    line,
                })
            };
            let entry = parsed().map_err(|what: String| format!("row {line}: {what}"))?;
            contents.entries.push(entry);
        }
    }
    Ok(())
}

/// A field of a record.
struct Field {
    name: &'static str,
    from: usize,
    size: usize,
    kind: Kind,
    is_reversed: bool,
}

enum Kind {
    Signed,
    Unsigned,
    Float,
}

impl Field {
    /// The field called `name` in records of `size` bytes.
    fn named(members: &[CompoundMember], name: &'static str, size: u32) -> Result<Self, String> {
        let found = members.iter().find(|member| member.name == name);
        let member = found.ok_or_else(|| {
            let own: Vec<&str> = members.iter().map(|member| member.name.as_str()).collect();
            let names = shown(&own.join(", ")).to_string();
            format!("the records of `trajectory` have no field {name}, only {names}")
        })?;
        let (length, order, kind) = match &member.datatype {
            Datatype::FixedPoint {
                size: length @ (1 | 2 | 4 | 8),
                byte_order,
                layout,
            } if u32::from(layout.bit_precision) == 8 * length => match layout.signed {
                true => (*length, byte_order, Kind::Signed),
                false => (*length, byte_order, Kind::Unsigned),
            },
            Datatype::FloatingPoint {
                size: length @ (4 | 8),
                byte_order,
                ..
            } => (*length, byte_order, Kind::Float),
            _ => return Err(format!("the field {name} of `trajectory` is not a number")),
        };
        let from = member.byte_offset as usize;
        if from + length as usize > size as usize || *order == DatatypeByteOrder::Vax {
            return Err(format!("the field {name} of `trajectory` is damaged"));
        }
        Ok(Self {
            name,
            from,
            size: length as usize,
            kind,
            is_reversed: *order == DatatypeByteOrder::BigEndian,
        })
    }

    /// The bytes of the field, padded with `fill` to eight, little endian.
    fn bytes(&self, record: &[u8], fill: u8) -> [u8; 8] {
        let mut bytes = [fill; 8];
        let own = &mut bytes[..self.size];
        own.copy_from_slice(&record[self.from..self.from + self.size]);
        if self.is_reversed {
            own.reverse();
        }
        bytes
    }

    fn number(&self, record: &[u8]) -> f64 {
        let bytes = self.bytes(record, 0);
        match (&self.kind, bytes) {
            (Kind::Float, [a, b, c, d, ..]) if self.size == 4 => {
                f64::from(f32::from_le_bytes([a, b, c, d]))
            }
            (Kind::Float, bytes) => f64::from_le_bytes(bytes),
            (Kind::Signed | Kind::Unsigned, _) => self.integer(record) as f64,
        }
    }

    /// An integer; unsigned ones above 2^63 are negative.
    fn integer(&self, record: &[u8]) -> i64 {
        let top = record[self.from + if self.is_reversed { 0 } else { self.size - 1 }];
        let is_negative = matches!(self.kind, Kind::Signed) && top >= 0x80;
        i64::from_le_bytes(self.bytes(record, if is_negative { 0xff } else { 0 }))
    }

    fn whole(&self, record: &[u8]) -> Result<i64, String> {
        let whole = match self.kind {
            Kind::Signed => Some(self.integer(record)),
            Kind::Unsigned => Some(self.integer(record)).filter(|&number| number >= 0),
            Kind::Float => super::whole(self.number(record)),
        };
        whole.ok_or_else(|| format!("{} is not a whole number", self.name))
    }

    fn finite(&self, record: &[u8]) -> Result<f64, String> {
        let number = Some(self.number(record)).filter(|number| number.is_finite());
        number.ok_or_else(|| format!("{} is not a finite number", self.name))
    }
}
