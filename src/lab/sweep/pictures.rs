//! Pictures of a study: measurements over one or two varied settings, with the confidence of their means.

use std::collections::BTreeSet;

use serde_json::Value;

use super::Study;
use super::cell::{LABEL, plain};
use super::gathered::{Combination, Gathered};
use super::readable::{readable, readables};
use crate::gallery::{self, band, curve, distinct, spanned, with_legend};
use analysis::statistics::MeanStd;
use output::colors::{ColorMap, Rgb, light};
use output::plot::{Axis, ColorBar, Mark, Panel, Point, Sheet, Style, line_color};

/// The most panels of a sheet that draws everything.
const MOST_PANELS: usize = 12;
/// The most panels in a row.
const COLUMNS: usize = 3;
/// Width and height of a panel, points.
const PANEL: [f64; 2] = [200.0, 130.0];
/// The height of a panel with a map.
const MAP: [f64; 2] = [180.0, 150.0];
/// The color of a confidence band, as a part of its line's.
const LIGHT: f64 = 0.25;

/// What to draw.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drawing {
    /// The measurements; all that have a value if empty.
    pub measurements: Vec<String>,
    /// One or two of the varied settings; if empty, the first one with at least two numbers.
    pub over: Vec<String>,
}

/// A study cannot be drawn as asked for.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DrawingError {
    /// A measurement has no value in any cell.
    #[error("--draw {0}: no finished cell has this measurement; there are {1}")]
    Measurement(String, String),
    /// A setting does not vary.
    #[error("--over {0}: is not varied by the study; it varies {1}")]
    Setting(String, String),
    /// More than two settings.
    #[error("--over: give one or two settings, not {0}")]
    Settings(usize),
}

impl Drawing {
    /// Checks the settings, before any cell has run.
    ///
    /// # Errors
    /// The study does not vary one of them, or there are more than two.
    pub fn check(&self, study: &Study) -> Result<(), DrawingError> {
        if self.over.len() > 2 {
            return Err(DrawingError::Settings(self.over.len()));
        }
        let unknown = self.over.iter().find(|name| !study.axes.contains(name));
        unknown.map_or(Ok(()), |name| {
            Err(DrawingError::Setting(name.clone(), study.axes.join(", ")))
        })
    }
}

/// A mean at a value of the horizontal axis.
type MeanAt<'a> = (f64, &'a MeanStd);

impl Gathered<'_> {
    /// The sheet of a study; `None` if no measurement has a value.
    ///
    /// # Errors
    /// It does not have what `drawing` asks for.
    pub fn sheet(&self, drawing: &Drawing) -> Result<Option<Sheet>, DrawingError> {
        let combinations = self.combinations();
        let measured = self.measured(&combinations, drawing)?;
        if measured.is_empty() {
            return Ok(None);
        }
        let over = self.over(drawing)?;
        let panels: Vec<Panel> = match over.as_slice() {
            [x, y] => maps(&combinations, &measured, [x, y], &self.study.axes),
            [x] => lines(&combinations, &measured, x, &self.study.axes),
            _ => return Ok(None),
        };
        let columns = panels.len().min(COLUMNS);
        let size = if over.len() == 2 { MAP } else { PANEL };
        let title = match over.len() {
            2 => self.study.name.clone(),
            _ => format!(
                "{}: means with 95 % intervals (seeds, Student's t)",
                self.study.name
            ),
        };
        Ok(Some(Sheet::new(&title, columns, size, panels)))
    }

    /// The measurements to draw: their numbers in the means, and their names.
    fn measured(
        &self,
        combinations: &[Combination],
        drawing: &Drawing,
    ) -> Result<Vec<(usize, String)>, DrawingError> {
        let has_value = |k: usize| combinations.iter().any(|one| one.means[k].is_some());
        let numbers = self.numbers().into_iter().enumerate();
        let all: Vec<(usize, String)> = numbers.filter(|(k, _)| has_value(*k)).collect();
        if drawing.measurements.is_empty() {
            return Ok(all.into_iter().take(MOST_PANELS).collect());
        }
        let known = || {
            let names: Vec<&str> = all.iter().map(|(_, name)| name.as_str()).collect();
            names.join(", ")
        };
        let find = |name: &String| {
            let found = all.iter().find(|(_, other)| other == name).cloned();
            found.ok_or_else(|| DrawingError::Measurement(name.clone(), known()))
        };
        drawing.measurements.iter().map(find).collect()
    }

    /// The settings of the axes.
    fn over(&self, drawing: &Drawing) -> Result<Vec<String>, DrawingError> {
        let axes = &self.study.axes;
        drawing.check(self.study)?;
        if !drawing.over.is_empty() {
            return Ok(drawing.over.clone());
        }
        let numbers = |axis: &&String| {
            let found = self.study.cells.iter().filter_map(|cell| cell.value(axis));
            let values: Vec<&Value> = found.collect();
            values.iter().all(|value| value.is_number()) && values.iter().any(|v| *v != values[0])
        };
        let label = || axes.iter().find(|axis| *axis == LABEL);
        let first = axes.iter().find(numbers).or_else(label).or(axes.first());
        Ok(first.into_iter().cloned().collect())
    }
}

/// One panel per measurement, with a line for each combination of the other settings.
fn lines(
    combinations: &[Combination],
    measured: &[(usize, String)],
    x: &str,
    axes: &[String],
) -> Vec<Panel> {
    let scale = Scale::of(combinations, x);
    let names = others(combinations, &[x], axes);
    let panel = |(k, name): &(usize, String)| {
        let mut bands = Vec::new();
        let mut marks = Vec::new();
        for (number, line) in names.iter().enumerate() {
            let own = combinations.iter();
            let own = own.filter(|one| other(one, &[x], axes) == *line);
            let points = own.filter_map(|one| Some((scale.place(one)?, one.means[*k].as_ref()?)));
            let mut places: Vec<MeanAt> = points.collect();
            places.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (area, line) = line_marks(&places, line_color(number), line, scale.numeric);
            bands.extend(area);
            marks.extend(line);
        }
        let values = || combinations.iter().filter_map(|one| one.means[*k].as_ref());
        let ends = values().flat_map(|mean| {
            let half = mean.interval_95().unwrap_or(0.0);
            [mean.mean - half, mean.mean + half]
        });
        let y = Axis::linear(name, spanned(ends));
        let marks = bands.into_iter().chain(marks).collect();
        Panel::new("", scale.axis(), y, marks)
    };
    let panels: Vec<Panel> = measured.iter().map(panel).collect();
    match names.len() > 1 {
        true => with_legend(panels, COLUMNS),
        false => panels,
    }
}

/// A confidence band, if the axis has numbers and some mean has an interval; and a line with points and the borders of
/// the band, or points with error bars.
fn line_marks(
    places: &[MeanAt],
    color: Rgb,
    label: &str,
    is_numeric: bool,
) -> (Option<Mark>, Vec<Mark>) {
    let half = |mean: &MeanStd| mean.interval_95().unwrap_or(0.0);
    let has_band =
        is_numeric && places.len() > 1 && places.iter().any(|(_, mean)| half(mean) > 0.0);
    let [upper, lower] = [1.0, -1.0].map(|side| -> Vec<[f64; 2]> {
        let places = places.iter();
        let border = places.map(|(x, mean)| [*x, mean.mean + side * half(mean)]);
        border.collect()
    });
    let area = has_band.then(|| band(&upper, &lower, light(color, LIGHT)));
    // Where bands cover each other, their borders show both.
    let borders = [upper, lower].map(|line| Mark::Line(line, Style::full(color, 0.4, "")));
    let points = places.iter().map(|&(x, mean)| Point {
        x,
        y: mean.mean,
        error: if has_band { 0.0 } else { half(mean) },
    });
    let [line, points] = curve(points, Style::full(color, 1.2, label), 2.2);
    let mut marks: Vec<Mark> = borders.into_iter().filter(|_| has_band).collect();
    marks.extend(is_numeric.then_some(line));
    marks.push(points);
    (area, marks)
}

/// One panel per measurement and combination of the other settings: a map over two settings.
fn maps(
    combinations: &[Combination],
    measured: &[(usize, String)],
    over: [&str; 2],
    axes: &[String],
) -> Vec<Panel> {
    let scales = over.map(|axis| Scale::of(combinations, axis).by_name());
    let names = others(combinations, &over, axes);
    let mut panels = Vec::new();
    for (k, measurement) in measured {
        let values = || combinations.iter().filter_map(|one| one.means[*k].as_ref());
        let map = ColorMap::viridis(spanned(values().map(|mean| mean.mean)).map(|x| x as f32));
        for name in &names {
            let [columns, rows] = scales.each_ref().map(|scale| scale.values.len());
            let mut cells = vec![None; columns * rows];
            let of_panel = combinations.iter();
            for one in of_panel.filter(|one| other(one, &over, axes) == *name) {
                if let [Some(column), Some(row)] = scales.each_ref().map(|scale| scale.index(one)) {
                    cells[row * columns + column] = one.means[*k].as_ref().map(|mean| mean.mean);
                }
            }
            let (scaled, bar) = (
                scales.each_ref().map(Scale::axis),
                ColorBar::new(measurement, &map),
            );
            panels.push(gallery::map(name, scaled, cells, bar));
        }
    }
    panels
}

/// The combinations of the settings that are not on an axis, in order.
fn others(combinations: &[Combination], over: &[&str], axes: &[String]) -> Vec<String> {
    distinct(combinations.iter().map(|one| other(one, over, axes)))
}

/// The settings of a combination that are not on an axis, as text: `sf->sph, viscosity=5`.
pub(super) fn other(combination: &Combination, over: &[&str], axes: &[String]) -> String {
    let Some(cell) = combination.cells.first() else {
        return String::new();
    };
    let named = over.contains(&LABEL) || !axes.iter().any(|axis| axis == LABEL);
    let shown = cell
        .settings()
        .filter(|(key, _)| named && !over.contains(&key.as_str()));
    let label = cell.label().filter(|_| !named).map(str::to_owned);
    let values = shown.map(|(key, value)| match (key.as_str(), &value["name"]) {
        (_, Value::String(_)) | ("profile", _) => readable(value),
        (key, _) => format!("{key}={}", readable(value)),
    });
    let all: Vec<String> = label.into_iter().chain(values).collect();
    all.join(", ")
}

/// The values of a setting on an axis.
struct Scale<'a> {
    /// The setting.
    name: &'a str,
    /// In ascending order if all are numbers, else as in the study.
    values: Vec<Value>,
    numeric: bool,
}

impl<'a> Scale<'a> {
    fn of(combinations: &[Combination], name: &'a str) -> Self {
        let mut seen = BTreeSet::new();
        let all = combinations.iter().filter_map(|one| one.value(name));
        let once = all.filter(|value| seen.insert(plain(value)));
        let mut values: Vec<Value> = once.cloned().collect();
        let numeric = values.len() > 1 && values.iter().all(Value::is_number);
        if numeric {
            let number = |value: &Value| value.as_f64().unwrap_or_default();
            values.sort_by(|a, b| number(a).total_cmp(&number(b)));
        }
        Self {
            name,
            values,
            numeric,
        }
    }

    /// Equal room for every value.
    fn by_name(self) -> Self {
        Self {
            numeric: false,
            ..self
        }
    }

    /// The number of a combination's value.
    fn index(&self, of: &Combination) -> Option<usize> {
        let value = of.value(self.name)?;
        self.values.iter().position(|other| other == value)
    }

    /// Its place on the axis.
    fn place(&self, of: &Combination) -> Option<f64> {
        match self.numeric {
            true => of.value(self.name)?.as_f64(),
            false => Some(self.index(of)? as f64 + 0.5),
        }
    }

    fn axis(&self) -> Axis {
        let numbers = self.values.iter().filter_map(Value::as_f64);
        match self.numeric {
            true => Axis::linear(self.name, spanned(numbers)),
            false => Axis::names(self.name, readables(&self.values)),
        }
    }
}
