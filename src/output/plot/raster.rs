//! Draws pixels in place of too many shapes: a crowd of thousands, a fine heat map.

use super::canvas::Pixels;
use super::{Cells, Disc};

/// White pixels.
fn blank(width: u32, height: u32) -> Pixels {
    Pixels {
        width,
        height,
        rgb: vec![255; 3 * width as usize * height as usize],
    }
}

/// Draws discs with centers and radii in pixels, right and down. Edges are not antialiased: pixels are small, and
/// few colors keep the file small.
pub fn discs(size: [u32; 2], discs: impl Iterator<Item = Disc>) -> Pixels {
    let mut pixels = blank(size[0], size[1]);
    for disc in discs {
        let ([x, y], r) = (disc.center, disc.radius);
        let span = |c: f64, end: u32| {
            let first = (c - r).max(0.0) as u32;
            first..((c + r + 1.0).max(0.0) as u32).min(end)
        };
        for row in span(y, size[1]) {
            for column in span(x, size[0]) {
                let distance = (f64::from(column) + 0.5 - x).hypot(f64::from(row) + 0.5 - y);
                if distance <= r {
                    let first = 3 * (row as usize * size[0] as usize + column as usize);
                    pixels.rgb[first..first + 3].copy_from_slice(&disc.color);
                }
            }
        }
    }
    pixels
}

/// Draws a grid of cells over the whole image.
pub fn cells(size: [u32; 2], cells: &Cells) -> Pixels {
    let mut pixels = blank(size[0], size[1]);
    let (columns, rows) = (cells.columns, cells.rows());
    for (k, rgb) in pixels.rgb.chunks_exact_mut(3).enumerate() {
        let (x, y) = (k % size[0] as usize, k / size[0] as usize);
        let column = x * columns / size[0] as usize;
        let row = rows - 1 - y * rows / size[1] as usize;
        if let Some(value) = cells.values[row * columns + column] {
            rgb.copy_from_slice(&cells.map.color(value as f32));
        }
    }
    pixels
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::colors::ColorMap;

    #[test]
    fn a_disc_covers_its_area() {
        let disc = Disc {
            center: [15.3, 14.6],
            radius: 9.0,
            color: [0, 0, 0],
        };
        let pixels = discs([30, 30], std::iter::once(disc));
        let dark = pixels.rgb.chunks_exact(3).filter(|rgb| rgb[0] == 0);
        let area = std::f64::consts::PI * 81.0;
        assert!((dark.count() as f64 / area - 1.0).abs() < 0.03);
    }

    #[test]
    fn a_disc_over_the_rim_is_cut() {
        let disc = Disc {
            center: [-1.0, 31.0],
            radius: 4.0,
            color: [1, 2, 3],
        };
        let pixels = discs([30, 30], std::iter::once(disc));
        assert_eq!(pixels.rgb[3 * 29 * 30..][..3], [1, 2, 3]);
    }

    #[test]
    fn the_first_row_of_a_field_is_at_the_bottom() {
        let map = ColorMap::viridis([0.0, 1.0]);
        let field = Cells {
            extent: [[0.0, 0.0], [1.0, 1.0]],
            columns: 1,
            values: vec![Some(0.0), None],
            map: map.clone(),
        };
        let pixels = cells([2, 2], &field);
        assert_eq!(pixels.rgb[..3], [255, 255, 255]);
        assert_eq!(pixels.rgb[9..], map.color(0.0));
    }
}
