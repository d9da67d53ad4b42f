//! Reports: what is handed in with a run or a study. Plan, people, doors, settings, results with their definitions,
//! pictures, the limits of the model, the status of the profiles, and how to run it again.

mod facts;
mod held_out;
mod levels;
mod limits;
mod passages;
mod peaks;
mod people;
mod run;
mod settings;
mod status;
mod still;
mod study;
mod watched;
mod worth;

pub use run::{InputFile, Sources, of_run};
pub use study::of_study;
pub use watched::Watched;
