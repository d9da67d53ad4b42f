//! The arrangement of the views in the viewer's window.

use super::scene::bars;
use engine::math::Vector;
use engine::scene::Region;

/// The usual size of the viewer without its panels, pixels, and the height of a view's title.
const WINDOW: [f64; 2] = [1300.0, 800.0];
const TITLE: f64 = 24.0;
/// An arrangement is clearly better than another if it shows the crowd this many times as large.
const CLEARLY: f64 = 1.15;

/// The positions of the two views of the whole crowd.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrangement {
    /// Side by side above the rest.
    Columns,
    /// One above the other, above the rest: for wide plans.
    Wide,
    /// Side by side, left of the rest: for tall plans.
    Tall,
}

impl Arrangement {
    /// The arrangement in which this part of the plane is largest, but columns unless another is clearly better.
    pub fn of(view: &Region) -> Self {
        let shown = bars::with_bar(view);
        let scale = |other: &Self| {
            let extent = shown.max - shown.min;
            Vector::from(other.panel()).component_div(&extent).min()
        };
        let better = |other: &Self| scale(other) > CLEARLY * scale(&Self::Columns);
        let mut others = [Self::Wide, Self::Tall].into_iter();
        others.find(better).unwrap_or(Self::Columns)
    }

    /// The heights of the views of the whole crowd and of the rest.
    pub fn row_shares(self) -> [f32; 2] {
        match self {
            Self::Wide => [13.0, 8.0],
            _ => [11.0, 10.0],
        }
    }

    /// The usual width and height of a view of the whole crowd, pixels.
    pub fn panel(self) -> [f64; 2] {
        let [width, height] = WINDOW;
        let [crowds, rest] = self.row_shares().map(f64::from);
        let above = height * crowds / (crowds + rest);
        match self {
            Self::Columns => [0.5 * width, above - TITLE],
            Self::Wide => [width, 0.5 * above - TITLE],
            Self::Tall => [0.25 * width, height - TITLE],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_of_any_shape_fill_most_of_their_views() {
        for (aspect, expected) in [
            (0.25, Some(Arrangement::Tall)),
            (0.7, None),
            (1.0, Some(Arrangement::Columns)),
            (2.0, Some(Arrangement::Columns)),
            (3.5, None),
            (5.0, Some(Arrangement::Wide)),
            (8.0, Some(Arrangement::Wide)),
        ] {
            let (min, max) = (Vector::zeros(), Vector::new(10.0 * aspect, 10.0));
            let view = Region { min, max };
            let chosen = Arrangement::of(&view);
            assert!(
                expected.is_none_or(|one| one == chosen),
                "{aspect}: {chosen:?}"
            );
            let extent = bars::with_bar(&view).max;
            let filled = |arrangement: Arrangement| {
                let parts = extent.component_div(&Vector::from(arrangement.panel()));
                parts.min() / parts.max()
            };
            assert!(filled(chosen) > 0.45, "{aspect}: {}", filled(chosen));
            assert!(filled(Arrangement::Columns) > 0.45 || chosen != Arrangement::Columns);
        }
    }
}
