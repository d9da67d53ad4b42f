//! Reports: what is handed in with a run or a study. Plan, settings, results with their definitions, pictures, the
//! limits of the model, its status by the documents of this version, and how to run it again.

mod facts;
mod limits;
mod pictures;
mod run;
mod settings;
mod study;

pub use pictures::{moments, pictures};
pub use run::{Sources, of_run};
pub use study::of_study;
