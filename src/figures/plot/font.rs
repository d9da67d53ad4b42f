//! The font of all pictures: widths of texts, lines, and the starting points of texts.

use std::collections::BTreeSet;
use std::sync::{LazyLock, Mutex, PoisonError};

use ab_glyph::{Font, FontRef, GlyphId};
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{FontStyle, FontTransform};
use plotters_backend::{BackendCoord, BackendTextStyle};

/// plotters' sizes of texts are this many times the size of the em square.
pub const SIZE_PER_EM: f64 = 1.24;
/// The box that stands for a letter that the font lacks.
pub const LACKING: GlyphId = GlyphId(0);
/// The height of a line, in sizes of its text.
pub const LINE: f64 = 1.2;

static FACE: LazyLock<Option<FontRef<'static>>> =
    LazyLock::new(|| FontRef::try_from_slice(dejavu::sans::regular()).ok());

/// The font.
pub fn face() -> Option<&'static FontRef<'static>> {
    FACE.as_ref()
}

/// Makes the font known to plotters. A font of our own makes pictures the same on every machine; without it, drawing
/// text is an error.
pub fn register() {
    let _ =
        plotters::style::register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular());
}

/// The letters that were drawn although the font lacks them.
static LACKED: Mutex<BTreeSet<char>> = Mutex::new(BTreeSet::new());

/// The glyph of a letter that is drawn; the box that stands for all others is remembered for [`take_lacked`].
pub fn drawn(face: &FontRef, letter: char) -> GlyphId {
    let glyph = face.glyph_id(letter);
    if glyph == LACKING && !letter.is_control() {
        let lacked = LACKED.lock();
        lacked
            .unwrap_or_else(PoisonError::into_inner)
            .insert(letter);
    }
    glyph
}

/// The letters that the font of PNG and PDF files lacks, of all texts drawn since the last call, each once.
pub fn take_lacked() -> String {
    let lacked = LACKED.lock();
    let letters = std::mem::take(&mut *lacked.unwrap_or_else(PoisonError::into_inner));
    letters.into_iter().collect()
}

/// The glyphs of a text, each with the place where it begins, in ems; and the width of the text.
pub fn glyphs(face: &FontRef, text: &str) -> (Vec<(GlyphId, f64)>, f64) {
    let em = f64::from(face.units_per_em().unwrap_or(2048.0));
    let mut width = 0.0;
    let placed = text.chars().map(|letter| {
        let glyph = face.glyph_id(letter);
        let begins = width;
        width += f64::from(face.h_advance_unscaled(glyph)) / em;
        (glyph, begins)
    });
    (placed.collect(), width)
}

/// The width of a text of this size, points.
pub fn width_of(text: &str, size: f64) -> f64 {
    face().map_or(0.6 * text.chars().count() as f64, |face| {
        glyphs(face, text).1
    }) * size
}

/// The lines of a text that is broken at blanks so that it fits into `most` points, if its words do.
pub fn lines(text: &str, size: f64, most: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if width_of(&format!("{line} {word}"), size) <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines.retain(|line| !line.is_empty());
    lines
}

/// The start of a text's baseline, in units of a backend, and the size of its em square.
pub fn baseline(
    text: &str,
    style: &impl BackendTextStyle,
    (x, y): BackendCoord,
) -> ([f64; 2], f64) {
    let em = style.size() / SIZE_PER_EM;
    let width = width_of(text, em);
    let anchor = style.anchor();
    let along = match anchor.h_pos {
        HPos::Left => 0.0,
        HPos::Center => -0.5 * width,
        HPos::Right => -width,
    };
    // As in an SVG by plotters: 0.76 em, and ± half the height of an x.
    let down = match anchor.v_pos {
        VPos::Top => 0.76,
        VPos::Center => 0.27,
        VPos::Bottom => -0.27,
    };
    let [right, below] = turned(&style.transform(), [along, down * em]);
    ([f64::from(x) + right, f64::from(y) + below], em)
}

/// A direction in a text as a direction on the sheet, both with y down.
pub fn turned(by: &FontTransform, [x, y]: [f64; 2]) -> [f64; 2] {
    match by {
        FontTransform::None => [x, y],
        FontTransform::Rotate90 => [-y, x],
        FontTransform::Rotate180 => [-x, -y],
        FontTransform::Rotate270 => [y, -x],
    }
}
