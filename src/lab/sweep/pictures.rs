//! Pictures of a study: measurements over one or two varied settings, with the confidence of their means.

use std::collections::BTreeMap;

use serde_json::Value;

use super::Study;
use super::cell::{LABEL, plain};
use super::gathered::{Combination, Gathered};
use super::readable::{readable, readables};
use crate::analysis::statistics::MeanStd;
use crate::output::colors::{ColorMap, Rgb};
use crate::output::plot::{Axis, Cells, ColorBar, Corner, LINES, Mark, Panel, Point, Sheet, Style};

/// The most panels of a sheet that draws everything.
const MOST_PANELS: usize = 12;
/// The most panels in a row.
const COLUMNS: usize = 3;
/// Width and height of a panel, points.
const PANEL: [f64; 2] = [200.0, 130.0];
/// The height of a panel with a map.
const MAP: [f64; 2] = [180.0, 150.0];
/// The part of white in the color of a confidence band.
const PALE: f64 = 0.75;

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
type Place<'a> = (f64, &'a MeanStd);

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
        Ok(Some(Sheet {
            title: self.study.name.clone(),
            columns: panels.len().min(COLUMNS),
            panel_size: if over.len() == 2 { MAP } else { PANEL },
            panels,
            ..Sheet::default()
        }))
    }

    /// The measurements to draw: their numbers in the means, and their names.
    fn measured(
        &self,
        combinations: &[Combination],
        drawing: &Drawing,
    ) -> Result<Vec<(usize, String)>, DrawingError> {
        let has_value = |k: usize| combinations.iter().any(|one| one.means[k].is_some());
        let all = self.numbers().into_iter().enumerate();
        let all: Vec<(usize, String)> = all.filter(|(k, _)| has_value(*k)).collect();
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
            let values = self.study.cells.iter().filter_map(|cell| cell.value(axis));
            let values: Vec<&Value> = values.collect();
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
            let of_line = combinations.iter();
            let of_line = of_line.filter(|one| other(one, &[x], axes) == *line);
            let places = of_line.filter_map(|one| {
                Some((
                    scale.place(one.cells.first()?.value(x)?)?,
                    one.means[*k].as_ref()?,
                ))
            });
            let mut places: Vec<Place> = places.collect();
            places.sort_by(|a, b| a.0.total_cmp(&b.0));
            let color = LINES[number % LINES.len()];
            let (band, line) = line_marks(&places, color, line, scale.is_numeric());
            let (areas, borders): (Vec<_>, Vec<_>) = band
                .into_iter()
                .partition(|mark| matches!(mark, Mark::Area(..)));
            bands.extend(areas);
            marks.extend(borders.into_iter().chain(line));
        }
        let values = || combinations.iter().filter_map(|one| one.means[*k].as_ref());
        let ends = values().flat_map(|mean| {
            let half = mean.interval_95().unwrap_or(0.0);
            [mean.mean - half, mean.mean + half]
        });
        let y = Axis::linear(name, around(ends));
        let marks = bands.into_iter().chain(marks).collect();
        Panel::new("", scale.axis(x), y, marks)
    };
    let mut panels: Vec<Panel> = measured.iter().map(panel).collect();
    // One legend for all, at the end of the first row.
    if let Some(last) = panels.iter_mut().take(COLUMNS).last() {
        last.legend = (names.len() > 1).then_some(Corner::Beside);
    }
    panels
}

/// A confidence band with its borders, if the axis has numbers and some mean has an interval; and a line with points,
/// or points with error bars.
fn line_marks(
    places: &[Place],
    color: Rgb,
    label: &str,
    is_numeric: bool,
) -> (Vec<Mark>, Vec<Mark>) {
    let half = |mean: &MeanStd| mean.interval_95().unwrap_or(0.0);
    let has_band =
        is_numeric && places.len() > 1 && places.iter().any(|(_, mean)| half(mean) > 0.0);
    let mut band = Vec::new();
    if has_band {
        let border = |side: f64| -> Vec<[f64; 2]> {
            let at = |(x, mean): &Place| [*x, mean.mean + side * half(mean)];
            places.iter().map(at).collect()
        };
        let [upper, lower] = [border(1.0), border(-1.0)];
        let around = upper.iter().chain(lower.iter().rev()).copied();
        let pale = color.map(|value| (255.0 - (1.0 - PALE) * (255.0 - f64::from(value))) as u8);
        band.push(Mark::Area(around.collect(), pale));
        // Where bands cover each other, their borders show both.
        let borders = [upper, lower].map(|line| Mark::Line(line, Style::full(color, 0.4, "")));
        band.extend(borders);
    }
    let points = places.iter().map(|&(x, mean)| Point {
        x,
        y: mean.mean,
        error: if has_band { 0.0 } else { half(mean) },
    });
    let points = Mark::Points(points.collect(), Style::full(color, 2.2, label));
    let line = places.iter().map(|(x, mean)| [*x, mean.mean]).collect();
    let line = is_numeric.then(|| Mark::Line(line, Style::full(color, 1.2, "")));
    (band, line.into_iter().chain([points]).collect())
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
        let map = ColorMap::viridis(around(values().map(|mean| mean.mean)).map(|x| x as f32));
        for name in &names {
            let [columns, rows] = [0, 1].map(|axis: usize| scales[axis].values.len());
            let mut cells = vec![None; columns * rows];
            let of_panel = combinations.iter();
            for one in of_panel.filter(|one| other(one, &over, axes) == *name) {
                let index = |axis: usize| {
                    let value = one.cells.first()?.value(over[axis])?;
                    scales[axis].index(value)
                };
                if let (Some(column), Some(row)) = (index(0), index(1)) {
                    cells[row * columns + column] = one.means[*k].as_ref().map(|mean| mean.mean);
                }
            }
            let marks = vec![Mark::Cells(Cells {
                extent: [[0.0; 2], [columns as f64, rows as f64]],
                columns,
                values: cells,
                map: map.clone(),
            })];
            panels.push(Panel {
                bar: Some(ColorBar {
                    label: measurement.clone(),
                    map: map.clone(),
                }),
                ..Panel::new(
                    name,
                    scales[0].axis(over[0]),
                    scales[1].axis(over[1]),
                    marks,
                )
            });
        }
    }
    panels
}

/// The combinations of the settings that are not on an axis, in order.
fn others(combinations: &[Combination], over: &[&str], axes: &[String]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for one in combinations {
        let name = other(one, over, axes);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// The settings of a combination that are not on an axis, as text: `sf->sph, viscosity=5`.
fn other(combination: &Combination, over: &[&str], axes: &[String]) -> String {
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
    label
        .into_iter()
        .chain(values)
        .collect::<Vec<_>>()
        .join(", ")
}

/// The values of a setting on an axis.
struct Scale {
    /// In ascending order if all are numbers, else as in the study.
    values: Vec<Value>,
    numeric: bool,
}

impl Scale {
    fn of(combinations: &[Combination], axis: &str) -> Self {
        let mut seen = BTreeMap::new();
        let cells = combinations.iter().filter_map(|one| one.cells.first());
        for (k, value) in cells.filter_map(|cell| cell.value(axis)).enumerate() {
            seen.entry(plain(value)).or_insert((k, value.clone()));
        }
        let mut values: Vec<(usize, Value)> = seen.into_values().collect();
        values.sort_by_key(|(k, _)| *k);
        let mut values: Vec<Value> = values.into_iter().map(|(_, value)| value).collect();
        let numeric = values.len() > 1 && values.iter().all(Value::is_number);
        if numeric {
            let number = |value: &Value| value.as_f64().unwrap_or_default();
            values.sort_by(|a, b| number(a).total_cmp(&number(b)));
        }
        Self { values, numeric }
    }

    /// Equal room for every value.
    fn by_name(self) -> Self {
        Self {
            numeric: false,
            ..self
        }
    }

    fn is_numeric(&self) -> bool {
        self.numeric
    }

    fn index(&self, value: &Value) -> Option<usize> {
        self.values.iter().position(|other| other == value)
    }

    fn place(&self, value: &Value) -> Option<f64> {
        match self.numeric {
            true => value.as_f64(),
            false => Some(self.index(value)? as f64 + 0.5),
        }
    }

    fn axis(&self, name: &str) -> Axis {
        match self.numeric {
            true => Axis::linear(name, around(self.values.iter().filter_map(Value::as_f64))),
            false => Axis::names(name, readables(&self.values)),
        }
    }
}

/// A range around all values, with a margin of 5 %.
fn around(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    });
    let [low, high] = if ends[0] <= ends[1] { ends } else { [0.0, 1.0] };
    let margin = match 0.05 * (high - low) {
        margin if margin > 0.0 => margin,
        _ => 0.05 * low.abs().max(1.0),
    };
    [low - margin, high + margin]
}
