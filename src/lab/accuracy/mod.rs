//! Run time against error: the cost of each numerical choice, and the distance of its result from the limit of the
//! model for small steps.
//!
//! Every point is a scenario under some settings, as `--set` takes them; the studies `accuracy_*.json` list them
//! ([`Trial`]). Its cost is milliseconds per simulated second on one thread. Its error is one of two: the distance of
//! agents from their positions in a run at Δt/64 ([`Motion`]), before chaos takes over ([`Lyapunov`]); or the distance
//! of the means of measurements over seeds from those of a run with a fine step.

mod cost;
mod front;
mod lyapunov;
mod pictures;
mod report;
mod results;
mod scenes;
mod statistics;
mod suite;
mod trajectory;
mod trials;

pub use front::{better, cheapest};
pub use lyapunov::Lyapunov;
pub use report::{CHOICES, Report, file_names};
pub use results::{Measured, Point, Quantity, SceneResults};
pub use scenes::{Kind, SCENES, Scene};
pub use suite::{Plan, accuracy};
pub use trajectory::{Errors, Motion, SAMPLES, Trajectories, limit};
pub use trials::{Trial, choices, few, trials};
