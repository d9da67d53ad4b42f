//! A page that plays a run in a browser: one HTML file without requests. `docs/reference/page-format.md` has its
//! format.
//!
//! The file is written part by part while the run goes on, so memory does not grow with the length of the run, and a
//! run that is killed leaves a page that plays up to its last part. `viewer/` has the script, its style and its
//! elements.

mod block;
mod embedded;
mod file;
mod moment;
mod options;
mod plan;

pub use embedded::EmbeddedViewer;
pub use file::PageError;
pub use moment::Moment;
pub use options::PageOptions;

use std::path::Path;

use serde_json::{Value, json};

use crate::drawing::Drawing;
use crate::picture::Picture;
use crate::scenery;
use block::Block;
use engine::math::Vector;
use figures::colors::ColorMap;
use figures::html::{self, Head, escape};
use figures::plot::Mark;
use file::{PageFile, Part};
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

/// The most frames that are compressed together, and the number of persons, summed over frames, that ends a block.
const MOST_FRAMES: u32 = 256;
const ROWS: usize = 1 << 20;

const STYLE: &str = include_str!("viewer/page.css");
/// For pages with the Rerun viewer.
const RERUN: &str = include_str!("viewer/rerun.js");
const BODY: &str = include_str!("viewer/page.html");
const SCRIPT: &str = concat!(
    include_str!("viewer/data.js"),
    include_str!("viewer/plan.js"),
    include_str!("viewer/plots.js"),
    include_str!("viewer/people.js"),
    include_str!("viewer/page.js"),
);

/// A page that is being written.
pub struct Page {
    file: PageFile,
    origin: Vector,
    has_trips: bool,
    has_forces: bool,
    crowd: Block,
    forces: Block,
    times: Vec<f64>,
    series: Vec<Vec<Option<f64>>>,
    events: Vec<Value>,
}

impl Page {
    /// Begins a page with the plan of a picture.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, plan: &Picture, options: &PageOptions) -> Result<Self, PageError> {
        let mut file = PageFile::create(path)?;
        let levels = plan.drawing.map_or(Vec::new(), Drawing::rectangles);
        let plan = plan.plan();
        let origin = plan.0[0].map(f64::floor);
        let mut columns = vec!["x", "y", "density", "speed"];
        let has_trips = !options.places.is_empty();
        if has_trips {
            columns.extend(["trip", "place"]);
        }
        let mut scene = options.scene(plan, origin, &columns);
        scene["levels"] = plan::levels(&levels, origin);
        file.write(Part::Text(
            options.beginning() + &html::data("scene", &scene),
        ))?;
        let forces = 2 * options.terms.len();
        Ok(Self {
            file,
            origin,
            has_trips,
            has_forces: forces > 0,
            crowd: Block::new(columns.len()),
            forces: Block::new(forces),
            times: Vec::new(),
            series: vec![Vec::new(); options.series.len()],
            events: Vec::new(),
        })
    }

    /// Adds a moment, later than those before.
    ///
    /// # Errors
    /// An earlier part could not be written.
    pub fn add(&mut self, moment: &Moment) -> Result<(), PageError> {
        self.add_frame(moment);
        self.times.push(moment.crowd.time);
        for (values, value) in self.series.iter_mut().zip(&moment.series) {
            values.push(value.filter(|value| value.is_finite()).map(rounded));
        }
        let events = moment.events.iter();
        self.events
            .extend(events.map(|line| json!([line.time, line.text, line.level == "WARN"])));
        if self.crowd.rows() < ROWS && self.crowd.frames() < MOST_FRAMES {
            return Ok(());
        }
        self.write_part()?;
        // The last frame of a block is the first of the next one.
        self.add_frame(moment);
        Ok(())
    }

    fn add_frame(&mut self, moment: &Moment) {
        let crowd = moment.crowd;
        self.crowd.begin_frame();
        for (k, (&id, position)) in crowd.id.iter().zip(&crowd.position).enumerate() {
            let [x, y] = [0, 1].map(|axis| whole(position[axis] - self.origin[axis], POSITION));
            let density = known(moment.density.get(k).copied(), DENSITY);
            let speed = known(moment.speed.get(k).copied(), SPEED);
            let [trip, place] = moment.trips.get(k).copied().unwrap_or_default();
            let trip = self.has_trips.then_some([trip, place]);
            let group = moment.groups.get(k).copied().unwrap_or(0);
            let body = [whole(crowd.radius[k], RADIUS).unsigned_abs(), group.into()];
            let values = [x, y, density, speed].into_iter();
            self.crowd
                .add(id, body, values.chain(trip.into_iter().flatten()));
        }
        self.forces.begin_frame();
        for (id, terms) in &moment.forces {
            let components = terms.iter().flat_map(|term| [term.x, term.y]);
            let values = components.map(|value| whole(value, ACCELERATION));
            self.forces.add((*id).into(), [0, 0], values);
        }
    }

    /// Writes the frames since the last part.
    fn write_part(&mut self) -> Result<(), PageError> {
        let take = |block: &mut Block| {
            let next = block.next();
            std::mem::replace(block, next)
        };
        let crowd = take(&mut self.crowd);
        let forces = take(&mut self.forces);
        let blocks = match self.has_forces {
            true => vec![crowd, forces],
            false => vec![crowd],
        };
        let values: Vec<_> = self.series.iter_mut().map(std::mem::take).collect();
        let times = std::mem::take(&mut self.times);
        let events = std::mem::take(&mut self.events);
        let series = json!({"times": times, "series": values, "events": events});
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
        match self.times.is_empty() && self.events.is_empty() {
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
            "terms": terms.map(|(name, color)| json!([name, hex(*color)])).collect::<Value>(),
            "series": series.map(|(plot, name, color)| json!([plot, name, hex(*color)])).collect::<Value>(),
        })
    }
}

/// The nearest whole number of units. `as` saturates, and NaN is 0.
fn whole(value: f64, unit: f64) -> i32 {
    (value / unit).round() as i32
}

/// One more than the nearest whole number of units; 0 if the value is unknown.
fn known(value: Option<f64>, unit: f64) -> i32 {
    let value = value.filter(|value| value.is_finite());
    value.map_or(0, |value| whole(value, unit).saturating_add(1))
}

/// With five significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}
