//! Animations: GIF, animated PNG, and videos by ffmpeg.

use std::cmp::Reverse;
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufWriter, IntoInnerError, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use gif::DisposalMethod;
use image::RgbImage;

use super::Print;
use super::error::PlotError;
use super::output::resolution;
use crate::colors::Rgb;
use common::outputs::Replacement;

/// The most colors in a frame of a GIF, without the transparent one.
const COLORS: usize = 255;
/// Hundredths of a second: the unit of the times in a GIF.
const GIF_UNITS: f64 = 100.0;

/// The number of grays among them.
const GRAYS: usize = 16;

/// An animation while it is written.
pub struct Animation {
    path: PathBuf,
    /// Under a temporary name until the animation is finished.
    file: Replacement,
    fps: f64,
    /// Frames so far.
    count: u64,
    writer: Writer,
}

enum Writer {
    Gif {
        encoder: Box<gif::Encoder<BufWriter<File>>>,
        before: Option<RgbImage>,
    },
    Png(Box<png::Writer<BufWriter<File>>>),
    Video(Child),
}

/// The program that writes videos.
fn ffmpeg() -> Command {
    let mut command = Command::new("ffmpeg");
    command.args(["-loglevel", "error"]).stdout(Stdio::null());
    command
}

/// Whether a file has one of these extensions, in letters of any case.
pub fn has_extension(path: &Path, wanted: &[&str]) -> bool {
    let own = path.extension().unwrap_or_default();
    wanted.iter().any(|one| own.eq_ignore_ascii_case(one))
}

impl Animation {
    /// Whether an animation can be written to a file with this name; check it before long computations.
    ///
    /// # Errors
    /// It is a video, and there is no ffmpeg.
    pub fn check(path: &Path) -> Result<(), PlotError> {
        if !has_extension(path, &["mp4", "webm"]) {
            return Ok(());
        }
        let ran = ffmpeg().arg("-version").stdin(Stdio::null()).status();
        let outcome = ran.map_err(|error| error.to_string());
        let tried = outcome.and_then(|status| match status.success() {
            true => Ok(()),
            false => Err(format!("`ffmpeg -version` ends with {status}")),
        });
        tried.map_err(|reason| PlotError::NoFfmpeg {
            path: path.to_owned(),
            reason,
        })
    }

    /// Begins an animation of `count` frames of this size: a GIF, an animated PNG, or a video (.mp4, .webm).
    ///
    /// # Errors
    /// The file cannot be written, or ffmpeg cannot be started.
    pub fn create(
        path: &Path,
        first: &RgbImage,
        (count, fps): (u32, f64),
        print: &Print,
    ) -> Result<Self, PlotError> {
        let size = [first.width(), first.height()];
        let failed = |reason| PlotError::writing(path, reason);
        let (replacement, file) = Replacement::begin(path).map_err(failed)?;
        let writer = if has_extension(path, &["mp4", "webm"]) {
            Writer::Video(video((path, replacement.written_at()), size, fps)?)
        } else {
            let file = BufWriter::new(file);
            match has_extension(path, &["gif"]) {
                true => gif(file, size).map_err(std::io::Error::other),
                false => apng(file, size, (count, fps), print).map_err(std::io::Error::other),
            }
            .map_err(failed)?
        };
        Ok(Self {
            path: path.to_owned(),
            file: replacement,
            fps,
            count: 0,
            writer,
        })
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, image: RgbImage) -> Result<(), PlotError> {
        let ends = |k: u64| (k as f64 * GIF_UNITS / self.fps).round() as u64;
        let delay = (ends(self.count + 1) - ends(self.count)).min(u64::from(u16::MAX)) as u16;
        self.count += 1;
        let written = match &mut self.writer {
            Writer::Gif { encoder, before } => {
                let frame = changed(&image, before.as_ref(), delay);
                *before = Some(image);
                encoder.write_frame(&frame).map_err(std::io::Error::other)
            }
            Writer::Png(writer) => writer
                .write_image_data(&image)
                .map_err(std::io::Error::other),
            Writer::Video(child) => match &mut child.stdin {
                Some(input) => input.write_all(&image),
                None => Ok(()),
            },
        };
        match (written, &mut self.writer) {
            (Ok(()), _) => Ok(()),
            // ffmpeg says why it ended.
            (Err(reason), Writer::Video(child)) => Err(PlotError::writing(
                &self.path,
                ended(child).unwrap_or(reason),
            )),
            (Err(reason), _) => Err(PlotError::writing(&self.path, reason)),
        }
    }

    /// Closes the file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(self) -> Result<(), PlotError> {
        let closed = match self.writer {
            Writer::Gif { encoder, .. } => encoder
                .into_inner()
                .map_err(std::io::Error::other)
                .and_then(|file| file.into_inner().map_err(IntoInnerError::into_error))
                .map(drop),
            Writer::Png(writer) => writer.finish().map_err(std::io::Error::other),
            Writer::Video(mut child) => ended(&mut child).map_or(Ok(()), Err),
        };
        let kept = closed.and_then(|()| self.file.keep());
        kept.map_err(|reason| PlotError::writing(&self.path, reason))
    }
}

/// Waits for ffmpeg and returns its error, if there is one.
fn ended(child: &mut Child) -> Option<std::io::Error> {
    drop(child.stdin.take());
    let mut message = String::new();
    if let Some(mut errors) = child.stderr.take() {
        std::io::Read::read_to_string(&mut errors, &mut message).ok();
    }
    match child.wait() {
        Ok(status) if status.success() => None,
        Ok(status) => {
            let text = format!("ffmpeg ended with {status}: {}", message.trim());
            Some(std::io::Error::other(text))
        }
        Err(error) => Some(error),
    }
}

fn gif(file: BufWriter<File>, [width, height]: [u32; 2]) -> Result<Writer, gif::EncodingError> {
    let side = |length: u32| u16::try_from(length).unwrap_or(u16::MAX);
    let mut encoder = gif::Encoder::new(file, side(width), side(height), &[])?;
    encoder.set_repeat(gif::Repeat::Infinite)?;
    Ok(Writer::Gif {
        encoder: Box::new(encoder),
        before: None,
    })
}

fn apng(
    file: BufWriter<File>,
    [width, height]: [u32; 2],
    (count, fps): (u32, f64),
    print: &Print,
) -> Result<Writer, png::EncodingError> {
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_filter(png::FilterType::Paeth);
    encoder.set_pixel_dims(Some(resolution(print)));
    encoder.set_animated(count, 0)?;
    let per_second = (fps * 100.0).round().clamp(1.0, f64::from(u16::MAX)) as u16;
    encoder.set_frame_delay(100, per_second)?;
    Ok(Writer::Png(Box::new(encoder.write_header()?)))
}

/// Starts ffmpeg, which writes the video `path` at another place for now.
fn video(
    (path, at): (&Path, &Path),
    [width, height]: [u32; 2],
    fps: f64,
) -> Result<Child, PlotError> {
    let codec: &[&str] = match has_extension(path, &["webm"]) {
        true => &["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0"],
        false => &["-c:v", "libx264", "-crf", "18", "-movflags", "+faststart"],
    };
    let size = format!("{width}x{height}");
    ffmpeg()
        .args(["-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", &size])
        .args(["-r", &fps.to_string(), "-i", "-"])
        // The usual format of videos has one color for 2 × 2 pixels.
        .args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white"])
        .args(["-pix_fmt", "yuv420p"])
        .args(codec)
        .arg(at)
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| PlotError::NoFfmpeg {
            path: path.to_owned(),
            reason: error.to_string(),
        })
}

/// The part of an image that differs from the one before, with its own colors.
fn changed(image: &RgbImage, before: Option<&RgbImage>, delay: u16) -> gif::Frame<'static> {
    let differs = |x: u32, y: u32| {
        before.is_none_or(|before| before.get_pixel(x, y) != image.get_pixel(x, y))
    };
    let (mut low, mut high) = ([image.width(), image.height()], [0, 0]);
    for (x, y, _) in image.enumerate_pixels().filter(|&(x, y, _)| differs(x, y)) {
        low = [low[0].min(x), low[1].min(y)];
        high = [high[0].max(x + 1), high[1].max(y + 1)];
    }
    if high == [0, 0] {
        (low, high) = ([0, 0], [1, 1]);
    }
    let places = (low[1]..high[1]).flat_map(|y| (low[0]..high[0]).map(move |x| (x, y)));
    let color = |(x, y)| differs(x, y).then(|| image.get_pixel(x, y).0);
    let colors: Vec<Option<Rgb>> = places.map(color).collect();
    let frequent = most_frequent(colors.iter().flatten().copied());
    let mut known: HashMap<Rgb, u8> = HashMap::new();
    let mut index = |color: Rgb| {
        *known
            .entry(color)
            .or_insert_with(|| nearest(&frequent, color))
    };
    let pixels: Vec<u8> = colors
        .iter()
        .map(|color| color.map_or(COLORS as u8, &mut index))
        .collect();
    let [width, height] = [0, 1].map(|k| (high[k] - low[k]) as u16);
    let palette = frequent.concat();
    let clear = Some(COLORS as u8);
    let mut frame = gif::Frame::from_palette_pixels(width, height, pixels, palette, clear);
    (frame.left, frame.top) = (low[0] as u16, low[1] as u16);
    frame.delay = delay;
    frame.dispose = DisposalMethod::Keep;
    frame
}

/// The most frequent colors, as many as a palette has, and grays for the edges of letters. Marks keep their own colors:
/// only the many colors of smooth edges are changed.
fn most_frequent(colors: impl Iterator<Item = Rgb>) -> Vec<Rgb> {
    let mut by_color: HashMap<Rgb, u32> = HashMap::new();
    for color in colors {
        *by_color.entry(color).or_insert(0) += 1;
    }
    let mut counts: Vec<(Rgb, u32)> = by_color.into_iter().collect();
    counts.sort_by_key(|&(color, count)| (Reverse(count), color));
    let step = 255 / (GRAYS as u8 - 1);
    let grays = (0..GRAYS as u8).map(|k| [k * step; 3]);
    let frequent = counts.into_iter().map(|(color, _)| color);
    let mut palette: Vec<Rgb> = frequent.take(COLORS - GRAYS).chain(grays).collect();
    palette.resize(COLORS + 1, [255; 3]);
    palette
}

/// The index of the color of a palette that is most like another color.
fn nearest(palette: &[Rgb], color: Rgb) -> u8 {
    let distance = |other: &Rgb| -> i32 {
        let parts = other.iter().zip(color);
        parts
            .map(|(&a, b)| (i32::from(a) - i32::from(b)).pow(2))
            .sum()
    };
    let colors = (0..COLORS as u8).zip(palette);
    let nearest = colors.min_by_key(|(_, other)| distance(other));
    nearest.map_or(0, |(index, _)| index)
}
