//! The content of a picture of a crowd: colors by a quantity, a field, paths of the last seconds.

use crate::cli::failure::Failure;
use crate::cli::frames::{Run, kernel};
use engine::math::Vector;
use lab::measure::{Fields, Mean, Person, Site, cells_over};
use output::colors::ColorMap;
use output::picture::{Coloring, Field};
use output::plot::{Cells, ColorBar};
use scenario::quote::shown;
use scenario::suggestion;

/// `--color` for agents in the colors of what they do.
pub const NONE: &str = "none";
/// Cells along the longer side of a field.
const CELLS: f64 = 400.0;
/// The smallest side of a cell, meters.
const LEAST_CELL: f64 = 0.05;

/// The units of quantities.
const UNITS: [(&str, &str); 15] = [
    ("density", "P/m²"),
    ("mean_density", "P/m²"),
    ("rest_density", "P/m²"),
    ("density_from_walls", "P/m²"),
    ("pressure", "1/s²"),
    ("speed", "m/s"),
    ("preferred_speed", "m/s"),
    ("max_speed", "m/s"),
    ("vel_x", "m/s"),
    ("vel_y", "m/s"),
    ("acceleration", "m/s²"),
    ("acc_x", "m/s²"),
    ("acc_y", "m/s²"),
    ("radius", "m"),
    ("lean", "m"),
];

/// The value of a cell of a field.
type OfCell = fn(Mean) -> Option<f64>;

/// The coloring of crowds in all pictures of a run.
pub struct Look {
    /// The column; `None`: by what agents do.
    column: Option<(String, ColorBar)>,
    /// The value of a cell, its colors, the field and the walls.
    field: Option<(OfCell, ColorBar, Fields, Site)>,
}

impl Look {
    /// The look of the pictures of a run, in whose current frame ranges are found.
    pub fn new(
        run: &Run,
        color: &str,
        field: Option<&str>,
        range: Option<[f64; 2]>,
    ) -> Result<Self, Failure> {
        let column = match color {
            NONE => None,
            name => Some((name.to_owned(), bar(run, name, range)?)),
        };
        let field = match field {
            None => None,
            Some(name) => {
                let value: OfCell = match name {
                    "speed" => |mean| mean.speed,
                    _ => |mean| Some(mean.density),
                };
                let site = Site::new(run.frames.scene().walls.obstacles().to_vec());
                let (low, high) = (run.view.min, run.view.max);
                let cell = ((high - low).max() / CELLS).max(LEAST_CELL);
                let too_large = || Failure::Input("the view is too large".to_owned());
                let grid = cells_over(low, high, cell).ok_or_else(too_large)?;
                let fields = Fields::new(grid, &site, kernel(run.support_radius));
                Some((value, bar(run, name, range)?, fields, site))
            }
        };
        Ok(Self { column, field })
    }

    /// The colors of the people in the current frame.
    pub fn coloring(&self, run: &Run) -> Result<Option<Coloring>, Failure> {
        let Some((name, bar)) = &self.column else {
            return Ok(None);
        };
        let values = values(run, name)?;
        let bar = bar.clone();
        Ok(Some(Coloring { values, bar }))
    }

    /// The field in the current frame.
    pub fn field(&mut self, run: &Run) -> Option<Field> {
        let (value, bar, fields, site) = self.field.as_mut()?;
        fields.clear();
        let people = people(run, site);
        fields.add(&people.iter().collect::<Vec<_>>(), site);
        let values = fields.means(1).map(|mean| value(mean?)).collect();
        let grid = &fields.grid;
        let size = Vector::new(grid.columns as f64, grid.rows as f64) * grid.cell;
        Some(Field {
            cells: Cells {
                extent: [grid.min, grid.min + size].map(Into::into),
                columns: grid.columns,
                values,
                map: bar.map.clone(),
            },
            bar: bar.clone(),
        })
    }
}

/// The people in the current frame, as measurements see them.
fn people(run: &Run, site: &Site) -> Vec<Person> {
    let crowd = run.frames.crowd();
    let (kernel, mut near) = (kernel(run.support_radius), Vec::new());
    let person = |i: usize| {
        let position = crowd.position[i];
        let eye = match site.is_inside(position) {
            true => {
                site.walls.near(position, kernel.support_radius, &mut near);
                site.hidden(position, &mut near, &kernel).eye
            }
            false => position,
        };
        Person {
            number: i as u32,
            id: crowd.id[i],
            position,
            eye,
            mass: crowd.mass[i],
            velocity: crowd.velocity[i],
            density: 0.0,
            density_of_others: 0.0,
            voronoi: None,
            density_from_walls: 0.0,
        }
    };
    (0..crowd.len()).map(person).collect()
}

fn values(run: &Run, name: &str) -> Result<Vec<f64>, Failure> {
    run.frames.column(name)?.ok_or_else(|| {
        let columns = run.frames.columns();
        let near = suggestion(name, columns.iter().map(String::as_str));
        let known: Vec<String> = columns
            .iter()
            .map(|name| format!("`{}`", shown(name)))
            .collect();
        Failure::Input(format!(
            "--color {}: no such column{near}; there are {} and `{NONE}`",
            shown(name),
            known.join(", ")
        ))
    })
}

/// The meaning of the colors for a quantity.
fn bar(run: &Run, name: &str, range: Option<[f64; 2]>) -> Result<ColorBar, Failure> {
    let of_frame = || -> Result<[f64; 2], Failure> { Ok(usual(&values(run, name)?)) };
    let range = match (range, name) {
        (Some(range), _) => range,
        (None, "density") => run.density_range,
        (None, "speed") => run.speed_range,
        (None, _) => of_frame()?,
    };
    let ends = range.map(|end| end as f32);
    let map = match name {
        "speed" => ColorMap::inferno(ends),
        _ => ColorMap::viridis(ends),
    };
    let known = UNITS.iter().find(|(own, _)| *own == name);
    let unit = known.map_or(String::new(), |(_, unit)| format!(" [{unit}]"));
    Ok(ColorBar {
        label: format!("{}{unit}", name.replace('_', " ")),
        map,
    })
}

/// The range from the 1st to the 99th percentile of the known values; from 0 to 1 without any.
fn usual(values: &[f64]) -> [f64; 2] {
    let mut known: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    known.sort_by(f64::total_cmp);
    if known.is_empty() {
        return [0.0, 1.0];
    }
    let last = (known.len() - 1) as f64;
    let [low, high] = [0.01, 0.99].map(|part| known[(part * last).round() as usize]);
    // One value for everybody still needs a range.
    let least = 1e-6 * low.abs().max(high.abs()).max(1e-3);
    match high - low > least {
        true => [low, high],
        false => [low - 0.5, low + 0.5],
    }
}
