//! A moment of a run, for its page.

use crate::events::Line;
use crate::picture::Crowd;
use crate::recording::{DebugAgents, forces_on};
use crate::series;
use analysis::statistics::MeanStd;
use engine::journeys::{Status, Trip};
use engine::math::Vector;
use engine::simulation::Simulation;

/// People at one moment, in the order of the crowd.
#[derive(Debug, Clone)]
pub struct Moment<'a> {
    /// Where they are and how fast.
    pub crowd: &'a Crowd,
    /// Their densities, P/m²; NaN or missing if unknown, like their speeds, m/s.
    pub density: Vec<f64>,
    /// Their speeds.
    pub speed: Vec<f64>,
    /// The numbers of their groups; missing: 0.
    pub groups: Vec<u16>,
    /// How far they have come on their journeys; missing without journeys.
    pub trips: Vec<[i32; 2]>,
    /// The time series.
    pub series: Vec<Option<f64>>,
    /// What has happened since the last moment.
    pub events: Vec<Line>,
    /// The accelerations of some people, by id: the sum, then term by term, m/s².
    pub forces: Vec<(u32, Vec<Vector>)>,
}

impl<'a> Moment<'a> {
    /// The current frame of a simulation, which must be evaluated. `evacuated` agents have been counted so far, and the
    /// page shows the forces on some agents.
    pub fn of(
        simulation: &Simulation,
        crowd: &'a Crowd,
        (evacuated, events): (usize, Vec<Line>),
        debug: &DebugAgents,
    ) -> Self {
        let frame = simulation.frame();
        let present = || frame.agents.present();
        let density: Vec<f64> = match frame.fields.density.is_empty() {
            true => Vec::new(),
            false => present().map(|i| frame.fields.density[i]).collect(),
        };
        let speeds = crowd.velocity.iter().flatten();
        let speed = speeds.map(|velocity| velocity.norm()).collect();
        let mut moment = Self::watched(crowd, density, speed);
        moment.series[1] = Some(evacuated as f64);
        let waiting = simulation.backlogs().map(|one| f64::from(one.waiting));
        let places = series::counts(simulation).into_iter();
        moment.series.extend(waiting.chain(places).map(Some));
        let trips = &frame.agents.trip;
        Self {
            groups: present().map(|i| frame.agents.group[i]).collect(),
            trips: present()
                .map(|i| trip(trips.get(i).and_then(Option::as_ref)))
                .collect(),
            events,
            forces: forces_on(simulation, debug),
            ..moment
        }
    }

    /// People of whom only positions, speeds and densities are known.
    pub fn watched(crowd: &'a Crowd, density: Vec<f64>, speed: Vec<f64>) -> Self {
        let series = vec![
            Some(crowd.len() as f64),
            None,
            mean(&density),
            density.iter().copied().reduce(f64::max),
            mean(&speed),
        ];
        Self {
            crowd,
            density,
            speed,
            groups: Vec::new(),
            trips: Vec::new(),
            series,
            events: Vec::new(),
            forces: Vec::new(),
        }
    }
}

/// The mean of the known values.
fn mean(values: &[f64]) -> Option<f64> {
    let known: Vec<f64> = values.iter().copied().filter(|one| !one.is_nan()).collect();
    MeanStd::of(&known).map(|of| of.mean)
}

/// An agent's journey in two numbers. The first is 0 without a journey, else 1 + 4 × stage + what it does: 0 walks,
/// 1 waits, 2 stands in a queue, 3 has ended it. The second is 1 + the number of the place ahead, 0 without one.
fn trip(trip: Option<&Trip>) -> [i32; 2] {
    let Some(trip) = trip else {
        return [0, 0];
    };
    let doing = match trip.status {
        Status::Walking => 0,
        Status::Waiting { .. } => 1,
        Status::Queued { .. } => 2,
        Status::Finished | Status::Outside { .. } => 3,
    };
    let place = trip.place_ahead().map_or(0, |place| 1 + i32::from(place));
    [1 + 4 * i32::from(trip.stage) + doing, place]
}
