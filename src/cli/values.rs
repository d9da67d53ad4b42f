//! Parsers for the values of options.

use std::ops::RangeBounds;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::ValueEnum;
use clap::builder::{PathBufValueParser, PossibleValue, TypedValueParser};
use clap_complete::Shell;

use super::failure::Failure;
use analysis::crossing::{Line, Passages};
use engine::scene::Region;
use output::document::ENDINGS;
use output::plot::has_extension;
use scenario::trajectories::FRAME_RATES;

/// A number in a range; the error is `otherwise`.
fn within<T: FromStr + PartialOrd>(
    text: &str,
    range: impl RangeBounds<T>,
    otherwise: &'static str,
) -> Result<T, &'static str> {
    let number = text.parse().ok();
    number
        .filter(|number| range.contains(number))
        .ok_or(otherwise)
}

pub fn seconds(text: &str) -> Result<f64, &'static str> {
    within(text, 0.0..=1e9, "not a time in seconds from 0 to 1e7")
}

pub fn positive_seconds(text: &str) -> Result<f64, &'static str> {
    let range = f64::MIN_POSITIVE..=1e9;
    within(text, range, "not a time in seconds above 0, at most 1e7")
}

/// A time that may lie before the start, seconds.
pub fn moment(text: &str) -> Result<f64, &'static str> {
    within(text, -1e9..=1e9, "not a time in seconds")
}

pub fn length(text: &str) -> Result<f64, &'static str> {
    within(text, 1e-3..=1e3, "not a number between 0.001 and 1000")
}

pub fn frame_rate(text: &str) -> Result<f64, &'static str> {
    let otherwise = "not a number of frames per second above 0";
    within(text, FRAME_RATES, otherwise)
}

pub fn threads(text: &str) -> Result<usize, &'static str> {
    within(text, 1..=1024, "not a number of threads between 1 and 1024")
}

pub fn repeats(text: &str) -> Result<usize, &'static str> {
    within(text, 1..=1000, "not a number of repeats between 1 and 1000")
}

pub fn runs(text: &str) -> Result<usize, &'static str> {
    let otherwise = "not a number of runs between 4 and 100000";
    within(text, 4..=100_000, otherwise)
}

pub fn minutes(text: &str) -> Result<f64, &'static str> {
    let range = f64::MIN_POSITIVE..=1e7;
    within(text, range, "not a time in minutes above 0")
}

/// Percent.
pub fn confidence(text: &str) -> Result<f64, &'static str> {
    let otherwise = "not a probability between 50 and 99.99 percent";
    within(text, 50.0..=99.99, otherwise)
}

pub fn seed(text: &str) -> Result<u64, &'static str> {
    within(text, .., "not a whole number from 0 to 2^64 - 1")
}

pub fn id(text: &str) -> Result<u32, &'static str> {
    within(text, .., "not an agent's id, a whole number from 0")
}

pub fn every_frames(text: &str) -> Result<u64, &'static str> {
    within(text, 1.., "not a number of frames, 1 or more")
}

fn four(text: &str) -> Option<[f64; 4]> {
    let parsed: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    let numbers: [f64; 4] = parsed.ok()?.try_into().ok()?;
    numbers.iter().all(|n| n.is_finite()).then_some(numbers)
}

pub fn region(text: &str) -> Result<Region, &'static str> {
    match four(text) {
        Some([x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(Region {
            min: [x0, y0].into(),
            max: [x1, y1].into(),
        }),
        _ => Err("expected four numbers x0,y0,x1,y1 with x0 < x1 and y0 < y1"),
    }
}

pub fn line(text: &str) -> Result<Line, &'static str> {
    match four(text) {
        Some([x0, y0, x1, y1]) if (x0, y0) != (x1, y1) => Ok(Line {
            start: [x0, y0].into(),
            end: [x1, y1].into(),
        }),
        _ => Err("expected four numbers x0,y0,x1,y1, the ends of a line"),
    }
}

pub fn segments(text: &str) -> Result<u32, &'static str> {
    within(text, 1..=100, "not a number of edges between 1 and 100")
}

/// The radius of Voronoi cells, meters.
#[derive(Debug, Clone, Copy)]
pub struct CutOff(pub Option<f64>);

/// A length, or `none`.
pub fn cut_off(text: &str) -> Result<CutOff, &'static str> {
    match text {
        "none" => Ok(CutOff(None)),
        text => length(text)
            .map(|radius| CutOff(Some(radius)))
            .map_err(|_| "neither a number between 0.001 and 1000 nor `none`"),
    }
}

/// The first and the last passage: parts such as 10%..90%, or numbers such as 10..90.
pub fn passages(text: &str) -> Result<Passages, &'static str> {
    let otherwise = "expected two parts of all passages such as 10%..90%, or two numbers of passages from 1 such as \
                     10..90, the smaller one first";
    let (first, last) = text.split_once("..").ok_or(otherwise)?;
    let part = |text: &str| {
        let percent: f64 = text.trim().strip_suffix('%')?.parse().ok()?;
        (0.0..=100.0).contains(&percent).then_some(percent / 100.0)
    };
    if let (Some(first), Some(last)) = (part(first), part(last)) {
        return (first < last)
            .then_some(Passages::Parts([first, last]))
            .ok_or(otherwise);
    }
    let [first, last] = [first, last].map(|text| within(text.trim(), 1.., otherwise));
    match (first?, last?) {
        (first, last) if first < last => Ok(Passages::Ranks([first, last])),
        _ => Err(otherwise),
    }
}

/// The ids that `--debug-agents` lists.
pub fn ids(text: &str) -> Result<Vec<u32>, Failure> {
    let ids: Result<Vec<u32>, _> = text.split(',').map(|id| id.trim().parse()).collect();
    ids.map_err(|_| {
        Failure::Input(format!(
            "--debug-agents {text}: expected ids separated by commas, all or none"
        ))
    })
}

/// A path with one of these extensions; the error is `otherwise`.
fn ending_in(
    known: &'static [&'static str],
    otherwise: &'static str,
) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |path| match has_extension(&path, known) {
        true => Ok(path),
        false => Err(otherwise),
    })
}

/// A path with the extension that the Rerun viewer expects of a recording, or that of a page.
pub fn recording() -> impl TypedValueParser<Value = PathBuf> {
    let otherwise = "a recording's name must end in .rrd, that of a page in .html";
    ending_in(&["rrd", "html", "htm"], otherwise)
}

/// A path with the extension of a page.
pub fn page() -> impl TypedValueParser<Value = PathBuf> {
    ending_in(&PAGES, "a page's name must end in .html")
}

/// The extensions of pages.
const PAGES: [&str; 2] = ["html", "htm"];

/// Whether a file is a page, by its extension.
pub fn is_page(path: &Path) -> bool {
    has_extension(path, &PAGES)
}

/// A path with the extension of a picture or an animation.
pub fn picture() -> impl TypedValueParser<Value = PathBuf> {
    let known = &["svg", "png", "pdf", "gif", "mp4", "webm", "html", "htm"];
    let otherwise = "a picture's name must end in .svg, .png or .pdf, that of an animation in .gif, .png, .mp4 or \
                     .webm, that of a page in .html";
    ending_in(known, otherwise)
}

/// A path with the extension of a file with results.
pub fn document() -> impl TypedValueParser<Value = PathBuf> {
    let otherwise =
        "the name must end in .html, .pdf, .md, .csv or .json; `sandbox draw` draws pictures";
    ending_in(&ENDINGS, otherwise)
}

/// The width of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Width {
    Millimeters(f64),
    Pixels(f64),
}

impl Width {
    /// In points, with this number of pixels per inch.
    pub fn points(self, dpi: f64) -> f64 {
        match self {
            Self::Millimeters(length) => length * 72.0 / 25.4,
            Self::Pixels(count) => count * 72.0 / dpi,
        }
    }
}

pub fn width(text: &str) -> Result<Width, &'static str> {
    const OTHERWISE: &str =
        "not a width in millimeters (30 to 2000), such as 85, or in pixels, such as 1200px";
    match text.strip_suffix("px") {
        Some(count) => within(count, 100.0..=20_000.0, OTHERWISE).map(Width::Pixels),
        None => {
            let length = text.strip_suffix("mm").unwrap_or(text);
            within(length, 30.0..=2000.0, OTHERWISE).map(Width::Millimeters)
        }
    }
}

pub fn millimeters(text: &str) -> Result<f64, &'static str> {
    let otherwise = "not a width between 50 and 500 millimeters";
    within(text, 50.0..=500.0, otherwise)
}

pub fn dpi(text: &str) -> Result<f64, &'static str> {
    let otherwise = "not a number of pixels per inch between 20 and 2400";
    within(text, 20.0..=2400.0, otherwise)
}

/// Two numbers, the first less than the second.
pub fn range(text: &str) -> Result<[f64; 2], &'static str> {
    let parts = text.split_once(',');
    let ends = parts.map(|(low, high)| [low, high].map(|end| end.trim().parse::<f64>()));
    match ends {
        Some([Ok(low), Ok(high)]) if low < high && low.is_finite() && high.is_finite() => {
            Ok([low, high])
        }
        _ => Err("expected two numbers FROM,TO, the first less than the second"),
    }
}

/// The man page in place of a shell.
pub const MAN: &str = "man";

/// What `sandbox generate` makes: scripts for shells, and the man page.
pub fn generated() -> Vec<PossibleValue> {
    let all = Shell::value_variants().iter();
    let shells = all.filter_map(ValueEnum::to_possible_value);
    shells.chain([PossibleValue::new(MAN)]).collect()
}
