//! Run time against error: the cost of each numerical choice, and how far its result is from the model's own limit.
//!
//! Every point is a scenario under some settings, as `--set` takes them. Its cost is milliseconds per simulated second
//! on one thread. Its error is one of two: how far agents are from their positions in a run at Δt/64 ([`Motion`]),
//! before chaos takes over ([`Lyapunov`]); or how far Table 1's numbers, averaged over seeds, are from those of a run
//! with a fine step ([`Deviation`]). The accuracy of the integrals over walls is measured separately, in [`walls`].

mod cost;
mod found;
mod front;
mod knob;
mod lyapunov;
mod pictures;
mod report;
mod scenes;
mod statistics;
mod suite;
mod trajectory;
pub mod walls;

pub use found::{Found, Measured, Point, Quantity};
pub use front::{Front, cheapest};
pub use knob::{Curve, Detail, KNOBS, Knob};
pub use lyapunov::Lyapunov;
pub use report::{Report, WALLS};
pub use scenes::{Kind, SCENES, Scene};
pub use statistics::{Deviation, Sample, sample};
pub use suite::{Plan, accuracy};
pub use trajectory::{Errors, Motion, SAMPLES, Trajectories};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_step_of_the_knobs_meets_every_sample() {
        for curve in Knob::TimeStep.curves(Detail::All) {
            for settings in curve.points {
                let step: f64 = settings[0].split_once('=').unwrap().1.parse().unwrap();
                for time in SAMPLES {
                    let frames = time / step;
                    assert!((frames - frames.round()).abs() < 1e-9, "{step} {time}");
                }
            }
        }
    }
}
