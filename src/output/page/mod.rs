//! A page that plays a run in a browser: one HTML file without requests. `docs/reference/page-format.md` has its
//! format.
//!
//! The file is written part by part while the run goes on, so memory does not grow with the length of the run, and a
//! run that is killed leaves a page that plays up to its last part. `viewer/` has the script, its style and its
//! elements.

mod block;
mod embedded;
mod file;
mod frames;
mod live;
mod moment;
mod options;
mod plan;

pub use embedded::EmbeddedViewer;
pub use file::PageError;
pub use frames::Coded;
pub use live::Live;
pub use moment::Moment;
pub use options::PageOptions;

use std::path::Path;

use serde_json::{Value, json};

use crate::drawing::Drawing;
use crate::picture::Picture;
use crate::scenery;
use engine::math::Vector;
use figures::colors::ColorMap;
use figures::html::{self, Head, escape};
use figures::plot::Mark;
use file::{PageFile, Part};
use frames::{Code, Frames};
use plan::{hex, millimeters};

/// The unit of positions, meters: no coordinate is more than half of it off, so no position is more than 0.71 of it
/// off.
pub const POSITION: f64 = 0.01;
/// The unit of densities, P/m².
pub const DENSITY: f64 = 0.02;
/// The unit of speeds, m/s.
pub const SPEED: f64 = 0.01;
/// The unit of accelerations, m/s².
pub const ACCELERATION: f64 = 0.01;
/// The unit of radii, meters.
const RADIUS: f64 = 0.001;

/// The style of the viewer.
pub const STYLE: &str = include_str!("viewer/page.css");
/// For pages with the Rerun viewer.
const RERUN: &str = include_str!("viewer/rerun.js");
/// Its elements, with `{title}` and `{description}`.
pub const BODY: &str = include_str!("viewer/page.html");
/// Its script: it starts where the page has a scene, and else waits for another script to use it.
pub const SCRIPT: &str = concat!(
    include_str!("viewer/data.js"),
    include_str!("viewer/plan.js"),
    include_str!("viewer/plots.js"),
    include_str!("viewer/people.js"),
    include_str!("viewer/page.js"),
);

/// A page that is being written.
pub struct Page {
    file: PageFile,
    code: Code,
    frames: Frames,
}

impl Page {
    /// Begins a page with the plan of a picture.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, plan: &Picture, options: &PageOptions) -> Result<Self, PageError> {
        let mut file = PageFile::create(path)?;
        let (code, scene) = options.coded(plan);
        file.write(Part::Text(
            options.beginning() + &html::data("scene", &scene),
        ))?;
        let frames = Frames::new(&code);
        Ok(Self { file, code, frames })
    }

    /// Adds a moment, later than those before.
    ///
    /// # Errors
    /// An earlier part could not be written.
    pub fn add(&mut self, moment: &Moment) -> Result<(), PageError> {
        let coded = self.code.of(moment);
        self.frames.add(&coded);
        if !self.frames.is_full() {
            return Ok(());
        }
        self.write_part()?;
        self.frames.begin_with(&coded);
        Ok(())
    }

    /// Writes the frames since the last part.
    fn write_part(&mut self) -> Result<(), PageError> {
        let (blocks, series) = self.frames.take();
        self.file.write(Part::Frames(blocks.into(), series))
    }

    /// Adds the Rerun viewer with a recording, which must be complete. Its [`PageOptions::has_viewer`] must be set.
    ///
    /// # Errors
    /// A file cannot be read, or the page cannot be written.
    pub fn embed(&mut self, viewer: &EmbeddedViewer, recording: &Path) -> Result<(), PageError> {
        self.flush()?;
        viewer.parts(recording, |part| self.file.write(part))
    }

    /// Writes the frames that are left.
    fn flush(&mut self) -> Result<(), PageError> {
        match self.frames.is_empty() {
            true => Ok(()),
            false => self.write_part(),
        }
    }

    /// Adds what has been found out, as HTML below the plan, and closes the file.
    ///
    /// # Errors
    /// The file could not be written.
    pub fn finish(mut self, results: &str) -> Result<(), PageError> {
        self.flush()?;
        let program = html::PROGRAM;
        let end = format!(
            "<footer><p>Positions are rounded to {POSITION} m: none is more than {:.4} m off. Densities are rounded to \
             {DENSITY} P/m², speeds to {SPEED} m/s.</p>\n<p>{program}.</p></footer>\n{}",
            POSITION * 0.5_f64.sqrt(),
            html::END,
        );
        self.file.write(Part::Text(format!("{results}{end}")))?;
        self.file.finish()
    }
}

impl PageOptions {
    /// How moments in the plan of a picture become numbers, and what does not move.
    fn coded(&self, plan: &Picture) -> (Code, Value) {
        let levels = plan.drawing.map_or(Vec::new(), Drawing::rectangles);
        let plan = plan.plan();
        let origin = plan.0[0].map(f64::floor);
        let code = Code::new(origin, self);
        let mut scene = self.scene(plan, origin, &code.columns());
        scene["levels"] = plan::levels(&levels, origin);
        (code, scene)
    }

    /// The file up to the plan.
    fn beginning(&self) -> String {
        let script = match self.has_viewer {
            true => format!("{SCRIPT}{RERUN}"),
            false => SCRIPT.to_owned(),
        };
        let head = Head {
            title: &self.title,
            style: STYLE,
            script: &script,
            allowed: match self.has_viewer {
                true => embedded::ALLOWED,
                false => "",
            },
        };
        let [title, description] = [&self.title, &self.description].map(|text| escape(text));
        let body = BODY
            .replace("{title}", &title)
            .replace("{description}", &description);
        head.text() + &body
    }

    /// What does not move: the plan, with places from `origin` on, and the words and colors of everything.
    fn scene(
        &self,
        (shown, below, above): ([Vector; 2], Vec<Mark>, Vec<Mark>),
        origin: Vector,
        columns: &[&str],
    ) -> Value {
        let density = self.density_range.map(|end| end as f32);
        let speed = self.speed_range.map(|end| end as f32);
        let series = self.series.iter();
        let terms = self.terms.iter();
        json!({
            "format": 1,
            "origin": [origin.x, origin.y],
            "shown": shown.map(|corner| [corner.x - origin.x, corner.y - origin.y].map(millimeters)),
            "columns": columns,
            "units": {
                "position": POSITION, "density": DENSITY, "speed": SPEED, "acceleration": ACCELERATION,
                "radius": RADIUS,
            },
            "below": plan::marks(&below, origin),
            "above": plan::marks(&above, origin),
            "colors": {
                "density": plan::bar("density [P/m²]", &ColorMap::viridis(density)),
                "speed": plan::bar("speed [m/s]", &ColorMap::inferno(speed)),
            },
            "stages": self.has_stages.then(|| scenery::STAGES.map(|(_, color)| hex(color))),
            "opens_at": self.opens_at,
            "follows": self.follows,
            "groups": self.groups,
            "places": self.places,
            "behind": plan::areas(&self.behind, origin),
            "terms": terms.map(|(name, color)| json!([name, hex(*color)])).collect::<Value>(),
            "series": series.map(|(plot, name, color)| json!([plot, name, hex(*color)])).collect::<Value>(),
        })
    }
}
