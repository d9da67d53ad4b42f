//! Filled obstacles, as an image below everything else.

use rerun::{RecordingStream, Rgba32};

use crate::recording::draw::log_classes;
use crate::recording::error::Cause;
use analysis::way_field::Grid;
use engine::geometry::Polygon;
use engine::math::{Vector, bounds};
use figures::colors::Rgb;

/// The entity of the image.
pub const ENTITY: &str = "world/geometry/obstacles";
/// Its longest side, pixels.
const SIDE: f64 = 1024.0;
/// The smallest pixel, meters.
const PIXEL: f64 = 0.05;
/// Margin around the floor in which an unbounded obstacle is shown, meters.
const MARGIN: f64 = 1.0;

/// The tones of the ground, of obstacles, and of what is outside of the walkable area.
pub const GROUND: Rgb = [16, 17, 22];
const OBSTACLE: Rgb = [100, 102, 114];
pub const OUTSIDE: Rgb = [44, 46, 55];

/// The classes of pixels.
const FREE: u8 = 0;
const SOLID: u8 = 1;
const BEYOND: u8 = 2;

/// Whether the walkable area has an outside.
pub fn has_outside(obstacles: &[Polygon]) -> bool {
    obstacles.iter().any(Polygon::is_unbounded)
}

/// Logs the image, if there are obstacles.
pub fn log(stream: &RecordingStream, obstacles: &[Polygon]) -> Result<(), Cause> {
    if obstacles.is_empty() {
        return Ok(());
    }
    let Raster { grid, pixels } = Raster::of(obstacles);
    let tone = |[r, g, b]: Rgb| Rgba32::from_rgb(r, g, b);
    // Around an unbounded obstacle, the view's background has the tone of what is outside.
    let free = match has_outside(obstacles) {
        true => tone(GROUND),
        false => Rgba32::TRANSPARENT,
    };
    let outside = "outside of the walkable area".to_owned();
    let classes = [
        (FREE, "free".to_owned(), free),
        (SOLID, "obstacle".to_owned(), tone(OBSTACLE)),
        (BEYOND, outside, tone(OUTSIDE)),
    ];
    log_classes(stream, ENTITY, (&grid, pixels), &classes, -5.0)
}

/// The classes of the plane as an image; rows go up from the lowest y.
struct Raster {
    grid: Grid,
    pixels: Vec<u8>,
}

impl Raster {
    fn of(obstacles: &[Polygon]) -> Self {
        let points = obstacles.iter().flat_map(Polygon::points);
        let [min, max] = bounds(points.copied()).unwrap_or_default();
        let has_outside = has_outside(obstacles);
        let margin = Vector::repeat(if has_outside { MARGIN } else { 0.0 });
        let (min, max) = (min - margin, max + margin);
        let grid = Grid::over([min, max], ((max - min).max() / SIDE).max(PIXEL));
        let pixels = vec![FREE; grid.len()];
        let mut raster = Self { grid, pixels };
        let (unbounded, bounded): (Vec<&Polygon>, Vec<&Polygon>) =
            obstacles.iter().partition(|one| one.is_unbounded());
        unbounded.into_iter().for_each(|one| raster.fill(one));
        raster.mark_outside();
        bounded.into_iter().for_each(|one| raster.fill(one));
        raster
    }

    /// Marks the solid pixels that are connected with the border: the others are obstacles inside the walkable area.
    fn mark_outside(&mut self) {
        let Grid { columns, rows, .. } = self.grid;
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
        let Grid {
            min,
            cell,
            columns,
            rows,
        } = self.grid;
        for row in 0..rows {
            let y = min.y + (row as f64 + 0.5) * cell;
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
                let column = |x: f64| ((x - min.x) / cell + 0.5) as usize;
                let (from, to) = (column(inside[0]), column(inside[1]).min(columns));
                self.pixels[row * columns..][from.min(to)..to].fill(SOLID);
            }
        }
    }
}
