//! Trajectories in memory, column by column.

use super::area::WalkableArea;
use super::error::Cause;
use super::row::{COLUMNS, Row, Value, columns, rows};
use super::{TrajectoryError, frames_between};
use engine::scene::{Region, Scene};
use engine::simulation::Simulation;
use scenario::catalog::Parameters;

/// The values of a column, row by row.
#[derive(Debug, Clone, PartialEq)]
pub enum Column {
    /// Whole numbers.
    Counts(Vec<u64>),
    /// Numbers.
    Numbers(Vec<f64>),
    /// Names.
    Names {
        /// The number of the name of each row; -1: none.
        codes: Vec<i32>,
        /// The different names, in the order of their first rows.
        names: Vec<String>,
    },
}

/// The columns of a CSV file, some of them or all.
pub struct Columns {
    /// The name, how a row fills it, and the values.
    kept: Vec<(&'static str, Value, Column)>,
}

impl Columns {
    /// The names of all columns, with their meanings and units. Those of forces are only there if a profile has them.
    pub fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
        let of_forces = Parameters::every_force().into_iter().flat_map(|force| {
            let shown = force.shown().iter();
            shown
                .map(|shown| (shown.name, shown.about))
                .collect::<Vec<_>>()
        });
        let everywhere = COLUMNS.iter().map(|&(name, meaning, _)| (name, meaning));
        everywhere.chain(of_forces)
    }

    /// No rows yet, of the columns of the scene for which `is_kept` holds.
    pub fn new(scene: &Scene, is_kept: impl Fn(&str) -> bool) -> Self {
        let kept = columns(scene)
            .into_iter()
            .filter(|(name, ..)| is_kept(name));
        let begun = kept.map(|(name, _, value)| (name, value, Column::of(value)));
        Self {
            kept: begun.collect(),
        }
    }

    /// Adds all agents of an evaluated frame with the number `number`, by id.
    pub fn add(&mut self, simulation: &Simulation, number: u64) {
        self.append(&rows(simulation, number));
    }

    fn append(&mut self, rows: &[Row<'_>]) {
        for (_, value, column) in &mut self.kept {
            rows.iter().for_each(|row| column.push(*value, row));
        }
    }

    /// The names of the columns, and their values.
    pub fn into_values(self) -> impl Iterator<Item = (&'static str, Column)> {
        let kept = self.kept.into_iter();
        kept.map(|(name, _, column)| (name, column))
    }
}

impl Column {
    /// An empty column of such values.
    fn of(value: Value) -> Self {
        match value {
            Value::Count(_) => Self::Counts(Vec::new()),
            Value::Number(_) | Value::OfForce(..) => Self::Numbers(Vec::new()),
            Value::Name(_) => Self::Names {
                codes: Vec::new(),
                names: Vec::new(),
            },
        }
    }

    /// Adds the value of a row.
    fn push(&mut self, value: Value, row: &Row<'_>) {
        match (self, value) {
            (Self::Counts(values), Value::Count(of)) => values.push(of(row)),
            (Self::Numbers(values), Value::Number(of)) => values.push(of(row)),
            (Self::Numbers(values), Value::OfForce(force, k)) => {
                values.push(row.of_force(force, k).unwrap_or(f64::NAN));
            }
            (Self::Names { codes, names }, Value::Name(of)) => codes.push(code(names, of(row))),
            // A column is that of its value.
            _ => {}
        }
    }
}

/// The number of a name, which is added to `names` if it is new.
fn code(names: &mut Vec<String>, name: Option<&str>) -> i32 {
    let Some(name) = name else {
        return -1;
    };
    let known = names.iter().position(|known| known == name);
    let code = known.unwrap_or_else(|| {
        names.push(name.to_owned());
        names.len() - 1
    });
    code as i32
}

/// The trajectories of a run in memory.
pub struct Collected {
    every: u64,
    area: WalkableArea,
    columns: Columns,
}

impl Collected {
    /// Begins with `fps` frames per second. From now on every frame has densities. The walkable area includes `view`.
    ///
    /// # Errors
    /// `fps` does not divide the simulation's rate.
    pub fn new(
        simulation: &mut Simulation,
        view: Region,
        fps: f64,
        columns: Columns,
    ) -> Result<Self, TrajectoryError> {
        let every = frames_between(simulation.frame().clock, fps)?;
        simulation.request_density_until(u64::MAX);
        Ok(Self {
            every,
            area: WalkableArea::new(simulation, view),
            columns,
        })
    }

    /// Adds the current frame, which must be evaluated, if it is due.
    pub fn log(&mut self, simulation: &Simulation) {
        let frame = simulation.frame().clock.frame();
        if frame.is_multiple_of(self.every) {
            let rows = rows(simulation, frame / self.every);
            self.area.reach(&rows);
            self.columns.append(&rows);
        }
    }

    /// The walkable area as WKT: it includes all agents so far.
    ///
    /// # Errors
    /// The obstacles cannot be cut out of the area.
    pub fn area(&self) -> Result<String, Cause> {
        self.area.cut_out().map(|(wkt, _)| wkt)
    }

    /// The columns.
    pub fn into_columns(self) -> Columns {
        self.columns
    }
}

/// The walkable area of a simulation in its current state, as WKT; it includes `view`.
///
/// # Errors
/// The obstacles cannot be cut out of the area.
pub fn walkable_area(simulation: &Simulation, view: Region) -> Result<String, Cause> {
    let area = WalkableArea::new(simulation, view);
    area.cut_out().map(|(wkt, _)| wkt)
}
