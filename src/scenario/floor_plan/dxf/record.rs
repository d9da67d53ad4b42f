//! Records: all pairs from one group code 0 to the next.

use super::map::Point;
use super::pairs::{Pair, Pairs, Place};
use super::syntax;
use crate::floor_plan::error::FloorPlanError;

/// Most pairs of a record.
const MOST_PAIRS: usize = 8_000_000;

/// An entity, or an entry of a table.
#[derive(Debug, Default)]
pub struct Record<'a> {
    /// What it is.
    pub kind: String,
    /// Where it begins.
    pub at: Place,
    /// All but the first pair.
    pub pairs: Vec<Pair<'a>>,
}

/// Reads records.
pub struct Records<'a> {
    pairs: Pairs<'a>,
    /// The pair with which the next record begins.
    next: Option<Pair<'a>>,
}

impl<'a> Records<'a> {
    /// The records of a file. It must begin with group code 0.
    pub fn new(bytes: &'a [u8]) -> Result<Self, FloorPlanError> {
        let mut pairs = Pairs::new(bytes);
        let next = pairs.next()?;
        match next {
            Some(Pair { code: 0, .. }) => Ok(Self { pairs, next }),
            Some(pair) => Err(syntax(format!(
                "{}: begins with group code {}; a DXF begins with 0 and SECTION",
                pair.at, pair.code
            ))),
            None => Err(syntax("is empty")),
        }
    }

    /// The error of a file that ends too early.
    pub fn truncated(&self) -> FloorPlanError {
        self.pairs.truncated()
    }

    /// The next record; `None` at the end. Without `keeps`, its pairs are left out.
    pub fn next(&mut self, keeps: bool) -> Result<Option<Record<'a>>, FloorPlanError> {
        let Some(first) = self.next.take() else {
            return Ok(None);
        };
        let mut record = Record {
            kind: String::from_utf8_lossy(first.word()).into_owned(),
            at: first.at,
            pairs: Vec::new(),
        };
        // What follows the end need not be valid.
        if record.kind == "EOF" {
            return Ok(Some(record));
        }
        loop {
            match self.pairs.next()? {
                Some(pair) if pair.code == 0 => {
                    self.next = Some(pair);
                    break;
                }
                Some(pair) if keeps => record.pairs.push(pair),
                Some(_) => {}
                None => break,
            }
            if record.pairs.len() > MOST_PAIRS {
                return Err(syntax(format!(
                    "{}: the {} has more than {MOST_PAIRS} pairs",
                    record.at, record.kind
                )));
            }
        }
        Ok(Some(record))
    }
}

impl<'a> Record<'a> {
    /// The first pair with a group code.
    pub fn find(&self, code: i32) -> Option<&Pair<'a>> {
        self.pairs.iter().find(|pair| pair.code == code)
    }

    /// All pairs with a group code.
    fn all(&self, code: i32) -> impl Iterator<Item = &Pair<'a>> {
        self.pairs.iter().filter(move |pair| pair.code == code)
    }

    /// The bytes of a text; empty without one.
    pub fn word(&self, code: i32) -> &'a [u8] {
        self.find(code).map_or(&[], Pair::word)
    }

    /// A number, or a default.
    pub fn number(&self, code: i32, default: f64) -> Result<f64, FloorPlanError> {
        self.find(code).map_or(Ok(default), Pair::number)
    }

    /// An integer, or a default.
    pub fn whole(&self, code: i32, default: i64) -> Result<i64, FloorPlanError> {
        self.find(code).map_or(Ok(default), Pair::whole)
    }

    /// All numbers with a group code.
    pub fn numbers(&self, code: i32) -> Result<Vec<f64>, FloorPlanError> {
        self.all(code).map(Pair::number).collect()
    }

    /// The numbers with a code, with that plus 10 and plus 20; by default 0.
    pub fn space(&self, code: i32) -> Result<[f64; 3], FloorPlanError> {
        let one = |k: i32| self.number(code + 10 * k, 0.0);
        Ok([one(0)?, one(1)?, one(2)?])
    }

    /// The point whose x has this code.
    ///
    /// # Errors
    /// There is none.
    pub fn point(&self, code: i32) -> Result<Point, FloorPlanError> {
        let one = |code: i32| match self.find(code) {
            Some(pair) => pair.number(),
            None => Err(self.lacks(code)),
        };
        Ok([one(code)?, one(code + 10)?])
    }

    /// All points whose x has this code.
    pub fn points(&self, code: i32) -> Result<Vec<Point>, FloorPlanError> {
        let [x, y] = [self.numbers(code)?, self.numbers(code + 10)?];
        if x.len() != y.len() {
            return Err(self.lacks(code + 10));
        }
        Ok(x.into_iter().zip(y).map(|(x, y)| [x, y]).collect())
    }

    fn lacks(&self, code: i32) -> FloorPlanError {
        syntax(format!(
            "{}: the {} lacks group code {code}; save the drawing again",
            self.at, self.kind
        ))
    }
}
