//! Static geometry: walls, obstacles and goals, logged once.

use rerun::components::ImageFormat;
use rerun::{
    AnnotationContext, AsComponents, ChannelDatatype, Color, ColorModel, LineStrips2D, Points2D,
    Radius, RecordingStream, Rgba32, SegmentationImage, Transform3D,
};

use super::error::Cause;
use super::names::Names;
use crate::engine::agents::Agents;
use crate::engine::geometry::Polygon;
use crate::engine::math::{Vector, bounds};
use crate::engine::period::Axis;
use crate::engine::scene::{Region, Scene};
use crate::output::colors::Rgb;
use crate::output::labels::AROUND;
use crate::output::scenery;

/// The filled obstacles: an image below everything else.
pub const OBSTACLES: &str = "world/geometry/obstacles";
/// Longest side of that image, pixels.
const RASTER_SIDE: f64 = 1024.0;
/// Minimum pixel size of that image, meters.
const RASTER_CELL: f64 = 0.05;
/// Margin around the floor in which an unbounded obstacle is shown, meters.
const SOLID_MARGIN: f64 = 1.0;
/// Up to this many goals get labels.
const NAMED_GOALS: usize = 8;

/// The tones of the ground, of obstacles, and of what is outside of the walkable area.
pub const GROUND: Rgb = [16, 17, 22];
const OBSTACLE: Rgb = [100, 102, 114];
pub const OUTSIDE: Rgb = [44, 46, 55];

/// The classes of pixels.
const FREE: u8 = 0;
const SOLID: u8 = 1;
const BEYOND: u8 = 2;

const WALL: Color = Color(Rgba32::from_rgb(214, 214, 222));
const GOAL: Color = Color(Rgba32::from_rgb(95, 211, 120));

/// Logs walls, obstacles and the goals of the scene's agents, and adds the names of goals.
pub fn log(
    stream: &RecordingStream,
    scene: &Scene,
    agents: &Agents,
    names: &mut Names,
) -> Result<(), Cause> {
    log_still(stream, scene.walls.obstacles())?;
    log_period(stream, scene, agents)?;
    log_goals(stream, (scene, agents), names)
}

/// Logs the direction of y, walls and obstacles.
pub fn log_still(stream: &RecordingStream, obstacles: &[Polygon]) -> Result<(), Cause> {
    // Y is up; the viewer's 2D views have y down.
    stream.log_static("world", &Transform3D::from_scale([1.0, -1.0, 1.0]))?;
    if !obstacles.is_empty() {
        log_walls(stream, obstacles)?;
        log_obstacles(stream, obstacles)?;
    }
    Ok(())
}

/// Whether the walkable area has an outside.
pub fn has_outside(obstacles: &[Polygon]) -> bool {
    obstacles.iter().any(Polygon::is_unbounded)
}

/// Logs a line at each end of the period.
fn log_period(stream: &RecordingStream, scene: &Scene, agents: &Agents) -> Result<(), Cause> {
    let Some(period) = &scene.period else {
        return Ok(());
    };
    let corners = scene.walls.iter().map(|wall| wall.start);
    let corners = bounds(corners.chain(agents.position.iter().copied())).unwrap_or_default();
    let [min, max] = period.clipped(corners);
    let [a, b, c, d] = Region { min, max }.corners().map(xy);
    let ends = match period.axis {
        Axis::X => [vec![a, d], vec![b, c]],
        Axis::Y => [vec![a, b], vec![d, c]],
    };
    let ends = LineStrips2D::new(ends)
        .with_radii([Radius::new_ui_points(0.75)])
        .with_colors([GOAL])
        .with_draw_order(6.0);
    Ok(stream.log_static("world/geometry/period", &ends)?)
}

fn log_walls(stream: &RecordingStream, obstacles: &[Polygon]) -> Result<(), Cause> {
    let rings = obstacles.iter().flat_map(Polygon::rings);
    let outlines = rings.map(|ring| {
        let closed = ring.iter().chain(ring.first());
        closed.map(|&p| xy(p)).collect::<Vec<_>>()
    });
    let walls = LineStrips2D::new(outlines)
        .with_radii([Radius::new_ui_points(0.75)])
        .with_colors([WALL])
        .with_draw_order(5.0);
    Ok(stream.log_static("world/geometry/walls", &walls)?)
}

fn log_obstacles(stream: &RecordingStream, obstacles: &[Polygon]) -> Result<(), Cause> {
    let raster = Raster::of(obstacles);
    let tone = |[r, g, b]: Rgb| Rgba32::from_rgb(r, g, b);
    // Around an unbounded obstacle, the view's background has the tone of what is outside.
    let free = match has_outside(obstacles) {
        true => tone(GROUND),
        false => Rgba32::TRANSPARENT,
    };
    let classes = AnnotationContext::new([
        (u16::from(FREE), "free", free),
        (u16::from(SOLID), "obstacle", tone(OBSTACLE)),
        (
            u16::from(BEYOND),
            "outside of the walkable area",
            tone(OUTSIDE),
        ),
    ]);
    let format = ImageFormat::from_color_model(
        [raster.columns as u32, raster.rows as u32],
        ColorModel::L,
        ChannelDatatype::U8,
    );
    let image = SegmentationImage::new(raster.pixels, format)
        .with_opacity(1.0)
        .with_draw_order(-5.0);
    let place = Transform3D::from_translation_scale(
        [raster.min.x as f32, raster.min.y as f32, 0.0],
        [raster.cell as f32; 3],
    );
    let parts: [&dyn AsComponents; 3] = [&place, &classes, &image];
    Ok(stream.log_static(OBSTACLES, &parts)?)
}

/// The classes of the plane as an image; rows go up from the lowest y.
struct Raster {
    min: Vector,
    cell: f64,
    columns: usize,
    rows: usize,
    pixels: Vec<u8>,
}

impl Raster {
    fn of(obstacles: &[Polygon]) -> Self {
        let points = obstacles.iter().flat_map(Polygon::points);
        let [min, max] = bounds(points.copied()).unwrap_or_default();
        let margin = Vector::repeat(if has_outside(obstacles) {
            SOLID_MARGIN
        } else {
            0.0
        });
        let (min, max) = (min - margin, max + margin);
        let cell = ((max - min).max() / RASTER_SIDE).max(RASTER_CELL);
        let cells = |length: f64| (length / cell).ceil().max(1.0) as usize;
        let (columns, rows) = (cells(max.x - min.x), cells(max.y - min.y));
        let mut raster = Self {
            min,
            cell,
            columns,
            rows,
            pixels: vec![0; columns * rows],
        };
        for obstacle in obstacles.iter().filter(|one| one.is_unbounded()) {
            raster.fill(obstacle);
        }
        raster.mark_outside();
        for obstacle in obstacles.iter().filter(|one| !one.is_unbounded()) {
            raster.fill(obstacle);
        }
        raster
    }

    /// Marks the solid pixels that are connected with the border: the others are obstacles inside the walkable area.
    fn mark_outside(&mut self) {
        let (columns, rows) = (self.columns, self.rows);
        let on_border = |k: &usize| {
            let (column, row) = (k % columns, k / columns);
            column == 0 || row == 0 || column + 1 == columns || row + 1 == rows
        };
        let mut next: Vec<usize> = (0..self.pixels.len()).filter(on_border).collect();
        while let Some(k) = next.pop() {
            if self.pixels[k] != SOLID {
                continue;
            }
            self.pixels[k] = BEYOND;
            let (column, row) = (k % columns, k / columns);
            next.extend((column > 0).then(|| k - 1));
            next.extend((column + 1 < columns).then_some(k + 1));
            next.extend((row > 0).then(|| k - columns));
            next.extend((row + 1 < rows).then_some(k + columns));
        }
    }

    /// Fills each row between successive pairs of crossings of its center line with the outline.
    fn fill(&mut self, obstacle: &Polygon) {
        for row in 0..self.rows {
            let y = self.min.y + (row as f64 + 0.5) * self.cell;
            let mut crossings: Vec<f64> = obstacle
                .edges()
                .filter(|(a, b)| (a.y > y) != (b.y > y))
                .map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
                .collect();
            if obstacle.is_unbounded() {
                crossings.extend([f64::NEG_INFINITY, f64::INFINITY]);
            }
            crossings.sort_by(f64::total_cmp);
            for inside in crossings.chunks_exact(2) {
                // Pixels whose centers lie inside; `as` saturates at 0.
                let column = |x: f64| ((x - self.min.x) / self.cell + 0.5) as usize;
                let (from, to) = (column(inside[0]), column(inside[1]).min(self.columns));
                self.pixels[row * self.columns..][from.min(to)..to].fill(SOLID);
            }
        }
    }
}

fn log_goals(
    stream: &RecordingStream,
    (scene, agents): (&Scene, &Agents),
    names: &mut Names,
) -> Result<(), Cause> {
    let goals = scenery::goals(scene, agents);
    if goals.is_empty() {
        return Ok(());
    }
    if goals.len() <= NAMED_GOALS {
        let [r, g, b, _] = GOAL.to_array();
        for ((goal, _), text) in goals.iter().zip(scenery::goal_labels(scene, &goals)) {
            let spots: Vec<_> = AROUND[..8].iter().map(|&side| (*goal, side)).collect();
            names.add("goals/names", goals.len(), &text, ([r, g, b], &spots));
        }
    }
    let points = Points2D::new(goals.iter().map(|(p, _)| xy(*p)))
        .with_radii([Radius::new_ui_points(5.0)])
        .with_colors([GOAL])
        .with_draw_order(6.0);
    Ok(stream.log_static("world/geometry/goals", &points)?)
}

pub fn xy(v: Vector) -> [f32; 2] {
    [v.x as f32, v.y as f32]
}
