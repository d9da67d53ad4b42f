//! What entities are, by their layers, and what is left out.

use super::blocks::{Placed, place};
use super::entities::Content;
use super::file::{Drawing, Layer};
use super::map::Point;
use super::syntax;
use super::units::Frame;
use crate::error::quote::shown;
use crate::error::suggestion;
use crate::floor_plan::error::FloorPlanError;
use crate::floor_plan::kind::Kind;
use crate::floor_plan::reading::Reading;

/// Most layers in a message.
const MOST_LISTED: usize = 20;
/// Entities that nobody expects in a plan.
const EXPECTED: [&str; 4] = ["ATTDEF", "ATTRIB", "VIEWPORT", "SEQEND"];

/// A note on layers in `plan.layers` that a drawing does not have, if there are any.
pub fn missing(drawing: &Drawing, reading: &Reading) -> Option<String> {
    let has = |name: &str| {
        let mut layers = drawing.layers.all().iter();
        layers.any(|layer| layer.name.to_lowercase() == name.to_lowercase())
    };
    let unknown = reading.layers.keys().filter(|name| !has(name));
    let missing: Vec<String> = unknown.map(|name| format!("\"{}\"", shown(name))).collect();
    let note = format!(
        "`plan.layers` names {}, which the drawing does not have",
        missing.join(", ")
    );
    (!missing.is_empty()).then_some(note)
}

/// The entities of a layer, or of several, that are left out.
#[derive(Debug, Clone, Copy)]
struct Left<'a> {
    layer: usize,
    count: usize,
    first: Placed<'a>,
}

/// The entities of a drawing by what they are.
#[derive(Debug)]
pub struct Sorted<'a> {
    layers: &'a [Layer],
    /// Those that are read, in order.
    pub known: Vec<(Placed<'a>, Kind)>,
    /// Texts, and whether their layers are known.
    pub texts: Vec<(Placed<'a>, bool)>,
    /// Those on layers that nothing is known about.
    unknown: Vec<Left<'a>>,
    /// Those on layers that are off.
    hidden: Vec<Left<'a>>,
    /// Those of kinds that are not read, on known layers.
    unread: Option<Left<'a>>,
}

/// What each layer is, in the form of [`Reading::kind_of`].
fn kinds(
    drawing: &Drawing,
    reading: &Reading,
) -> Result<Vec<Option<Option<Kind>>>, FloorPlanError> {
    let kind = |layer: &Layer| {
        reading.kind_of(&layer.name).map_err(|word| {
            let words: Vec<&str> = Kind::words().collect();
            syntax(format!(
                "`plan.layers`: \"{}\" is `{}`, which is unknown{}; write {} or none",
                shown(&layer.name),
                shown(&word),
                suggestion(&word, Kind::words()),
                words.join(", ")
            ))
        })
    };
    drawing.layers.all().iter().map(kind).collect()
}

impl<'a> Sorted<'a> {
    /// Sorts entities by their layers.
    ///
    /// # Errors
    /// `plan.layers` has an unknown word.
    pub fn new(
        drawing: &'a Drawing,
        placed: Vec<Placed<'a>>,
        reading: &Reading,
    ) -> Result<Self, FloorPlanError> {
        let kinds = kinds(drawing, reading)?;
        let layers = drawing.layers.all();
        let mut sorted = Self {
            layers,
            known: Vec::new(),
            texts: Vec::new(),
            unknown: Vec::new(),
            hidden: Vec::new(),
            unread: None,
        };
        for one in placed {
            let kind = kinds[one.layer];
            let is_expected = EXPECTED.contains(&&*one.entity.kind);
            let is_text = matches!(one.entity.content, Content::Text(_));
            match kind {
                Some(None) => {}
                _ if is_expected => {}
                _ if layers[one.layer].is_off => count(&mut sorted.hidden, one),
                _ if is_text => sorted.texts.push((one, kind.is_some())),
                None => count(&mut sorted.unknown, one),
                Some(Some(_))
                    if matches!(one.entity.content, Content::Other | Content::Insert(_)) =>
                {
                    let first = Left {
                        layer: one.layer,
                        count: 0,
                        first: one,
                    };
                    sorted.unread.get_or_insert(first).count += 1;
                }
                Some(Some(kind)) => sorted.known.push((one, kind)),
            }
        }
        sorted.refuse_wrong()?;
        Ok(sorted)
    }

    /// The error of the first known entity that is wrong.
    fn refuse_wrong(&self) -> Result<(), FloorPlanError> {
        for (one, _) in &self.known {
            if let Content::Wrong(error) = &one.entity.content {
                let said = match error {
                    FloorPlanError::Syntax { reason, .. } => reason.clone(),
                    other => other.to_string(),
                };
                let place = place(one.entity, &self.layer(one.layer));
                return Err(FloorPlanError::Geometry {
                    place,
                    reason: said,
                });
            }
        }
        Ok(())
    }

    /// The name of a layer in messages.
    pub fn layer(&self, number: usize) -> String {
        shown(&self.layers[number].name)
    }

    /// Leaves out an entity, as one on an unknown layer.
    pub fn leave_out(&mut self, one: Placed<'a>) {
        count(&mut self.unknown, one);
    }

    /// Notes on what was left out.
    pub fn notes(&self, frame: &Frame) -> Vec<String> {
        let mut notes = Vec::new();
        if !self.unknown.is_empty() {
            let listed = self.listed(&self.unknown, Some(frame));
            notes.push(format!(
                "left out: {listed}; `plan.layers` says what a layer is"
            ));
        }
        if !self.hidden.is_empty() {
            let listed = self.listed(&self.hidden, None);
            notes.push(format!(
                "left out, because they are off or frozen: {listed}"
            ));
        }
        if let Some(Left {
            layer,
            count,
            first,
        }) = &self.unread
        {
            let kind = shown(&first.entity.kind);
            let fix = match first.entity.content {
                Content::Insert(_) => "its block is missing: save the drawing again",
                _ => "explode it into lines",
            };
            notes.push(format!(
                "not read: {} on known layers, the first a {kind} on layer \"{}\" ({}); {fix}",
                entities(*count),
                self.layer(*layer),
                first.entity.at
            ));
        }
        notes
    }

    /// The error of a drawing without shapes.
    pub fn nothing(&self) -> FloorPlanError {
        let all = [&self.unknown[..], &self.hidden[..], self.unread.as_slice()].concat();
        if all.is_empty() && (!self.known.is_empty() || !self.texts.is_empty()) {
            return syntax(
                "has neither floor, walls nor obstacles: draw them, or say in `plan.layers` which layers they are",
            );
        }
        if all.is_empty() {
            return syntax(
                "has no entities in its model space: draw the walls or the floor, and save it again",
            );
        }
        if let ([one], Some(_)) = (&all[..], &self.unread) {
            return syntax_long(format!(
                "has only entities that are not read, the first a {} on layer \"{}\" ({}); explode them into lines",
                shown(&one.first.entity.kind),
                self.layer(one.layer),
                one.first.entity.at
            ));
        }
        syntax_long(format!(
            "no layer says what it is; `plan.layers` says so, for example {{\"{}\": \"wall\"}}. Layers: {}",
            self.layer(all[0].layer),
            self.listed(&all, None)
        ))
    }

    /// The layers of what is left out, for an error; empty without any.
    pub fn left_out(&self) -> String {
        match self.unknown.is_empty() {
            true => String::new(),
            false => format!(". Left out: {}", self.listed(&self.unknown, None)),
        }
    }

    fn listed(&self, left: &[Left], frame: Option<&Frame>) -> String {
        let one = |left: &Left| {
            let kind = shown(&left.first.entity.kind);
            let first = frame.map_or(String::new(), |frame| match anchor(&left.first) {
                Some(at) => {
                    let [x, y] = frame.at(at).map(|x| (10.0 * x).round() / 10.0 + 0.0);
                    format!(", the first a {kind} at ({x}, {y})")
                }
                None => format!(", the first a {kind} ({})", left.first.entity.at),
            });
            format!(
                "layer \"{}\" ({}{first})",
                self.layer(left.layer),
                entities(left.count)
            )
        };
        let mut parts: Vec<String> = left.iter().take(MOST_LISTED).map(one).collect();
        if left.len() > MOST_LISTED {
            parts.push(format!("and {} more layers", left.len() - MOST_LISTED));
        }
        parts.join(", ")
    }
}

/// An error whose reason is not shortened.
fn syntax_long(reason: String) -> FloorPlanError {
    FloorPlanError::Geometry {
        place: String::new(),
        reason,
    }
}

fn entities(count: usize) -> String {
    match count {
        1 => "1 entity".to_owned(),
        count => format!("{count} entities"),
    }
}

fn count<'a>(left: &mut Vec<Left<'a>>, one: Placed<'a>) {
    match left.iter_mut().find(|left| left.layer == one.layer) {
        Some(left) => left.count += 1,
        None => left.push(Left {
            layer: one.layer,
            count: 1,
            first: one,
        }),
    }
}

/// A point of an entity, in the coordinates of the drawing.
fn anchor(placed: &Placed) -> Option<Point> {
    let path = |path: &super::curves::Path| path.points(f64::MAX).first().copied();
    let at = match &placed.entity.content {
        Content::Path(line) => path(line)?,
        Content::Area(lines) => lines.iter().find_map(path)?,
        Content::Point(at) => *at,
        Content::Text(text) => text.at,
        Content::Insert(insert) => insert.at,
        Content::Other | Content::Wrong(_) => return None,
    };
    Some(placed.map.at(at))
}
