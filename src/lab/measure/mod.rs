//! Densities, speeds and flows in real or simulated trajectories: the SPH density of §8, the classic and the Voronoi
//! density, and the velocity of each person, mean fields, fundamental diagrams, regions, flow across lines.
//!
//! A person's SPH density is Eq. 9, with and without the person's own mass. Where walls hide part of the kernel, the
//! crowd behind them is assumed to be as dense as at the person's position, or as in the engine ([`Behind`]); fields
//! always use the former. For Voronoi cells see [`Tessellation`], for densities of regions [`RegionState`]. For
//! velocities see [`speed::velocities`], for crossings [`Crossings`]. Time is frame number divided by frame rate.

mod density;
mod diagram;
mod fields;
mod line;
mod measured;
mod moment;
mod options;
mod output;
mod person;
pub mod pictures;
mod record;
mod regions;
mod regions_report;
mod report;
mod safety;
mod safety_report;
pub mod speed;
mod tessellation;
mod view;

pub use analysis::site::{Hidden, Kernel, Site};
pub use analysis::surroundings::MOST_HIDDEN;
pub use density::{Parts, parts};
pub use diagram::{CLASS, Class, Classes, Density, Diagram, FrameMean};
pub use fields::{Fields, Mean, cells_over};
pub use line::{Crossing, Crossings, Way};
pub use measured::{Measured, Overview, check, measure};
pub use moment::Moment;
pub use options::{Behind, CellLimit, MOST_CELLS, MeasureError, Options};
pub use output::{Results, STREAMED};
pub use person::Person;
pub use record::MomentRecorder;
pub use regions::{RegionState, Regions};
pub use report::{Report, names};
pub use safety::{Departures, Safety, Sample};
pub use tessellation::{OwnCell, Tessellation};
