//! Drawings for tests: pairs of group codes and values.

use std::fmt::Display;

use sandbox::scenario::floor_plan::{self, FloorPlan, FloorPlanError, Reading};

/// A drawing in the making: group codes and values, one per line.
#[derive(Default)]
pub struct Drawing(String);

impl Drawing {
    /// A drawing in a unit: 4 is millimeters, 6 meters.
    pub fn new(unit: i32) -> Self {
        let mut drawing = Self::default();
        drawing.add(&[
            (0, "SECTION"),
            (2, "HEADER"),
            (9, "$ACADVER"),
            (1, "AC1027"),
            (9, "$INSUNITS"),
        ]);
        drawing.pair(70, unit);
        drawing.pair(0, "ENDSEC");
        drawing
    }

    pub fn pair(&mut self, code: i32, value: impl Display) {
        self.0 += &format!("{code}\n{value}\n");
    }

    pub fn add(&mut self, pairs: &[(i32, &str)]) {
        for &(code, value) in pairs {
            self.pair(code, value);
        }
    }

    /// Begins a section.
    pub fn section(mut self, name: &str) -> Self {
        self.add(&[(0, "SECTION"), (2, name)]);
        self
    }

    /// Ends a section.
    pub fn end(mut self) -> Self {
        self.pair(0, "ENDSEC");
        self
    }

    pub fn point(&mut self, code: i32, [x, y]: [f64; 2]) {
        self.pair(code, x);
        self.pair(code + 10, y);
    }

    pub fn line(mut self, layer: &str, from: [f64; 2], to: [f64; 2]) -> Self {
        self.add(&[(0, "LINE"), (8, layer)]);
        self.point(10, from);
        self.point(11, to);
        self
    }

    /// A polyline from vertices with bulges.
    pub fn bulges(mut self, layer: &str, is_closed: bool, vertices: &[([f64; 2], f64)]) -> Self {
        self.add(&[(0, "LWPOLYLINE"), (8, layer)]);
        self.pair(90, vertices.len());
        self.pair(70, i32::from(is_closed));
        for &(at, bulge) in vertices {
            self.point(10, at);
            self.pair(42, bulge);
        }
        self
    }

    pub fn polyline(self, layer: &str, is_closed: bool, points: &[[f64; 2]]) -> Self {
        let vertices: Vec<_> = points.iter().map(|&at| (at, 0.0)).collect();
        self.bulges(layer, is_closed, &vertices)
    }

    pub fn text(mut self, layer: &str, at: [f64; 2], text: &str) -> Self {
        self.add(&[(0, "TEXT"), (8, layer), (40, "0.3"), (1, text)]);
        self.point(10, at);
        self
    }

    /// A block, as part of the section BLOCKS.
    pub fn block(mut self, name: &str, base: [f64; 2], content: Self) -> Self {
        self.add(&[(0, "BLOCK"), (8, "0"), (2, name)]);
        self.point(10, base);
        self.0 += &content.0;
        self.pair(0, "ENDBLK");
        self
    }

    /// A block at a place, with factors along its axes and a turn in degrees.
    pub fn insert(mut self, layer: &str, name: &str, at: [f64; 2], [x, y, turn]: [f64; 3]) -> Self {
        self.add(&[(0, "INSERT"), (8, layer), (2, name)]);
        self.point(10, at);
        for (code, value) in [(41, x), (42, y), (50, turn)] {
            self.pair(code, value);
        }
        self
    }

    pub fn read_as(mut self, reading: &Reading) -> Result<FloorPlan, FloorPlanError> {
        self.pair(0, "EOF");
        floor_plan::parse_bytes(self.0.as_bytes(), reading)
    }

    pub fn read(self) -> FloorPlan {
        self.read_as(&Reading::default()).unwrap()
    }

    pub fn refused(self) -> String {
        self.read_as(&Reading::default()).unwrap_err().to_string()
    }
}
