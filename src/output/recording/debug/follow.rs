//! Which debug agents have views of their own, and which moment a recording opens at.

use super::DebugAgents;
use crate::recording::frame::Snapshot;
use engine::simulation::Simulation;

/// The most agents with views of their own.
const MOST: usize = 12;
/// Another agent of a region is followed when the crowd has become denser by this factor.
const DENSER: f64 = 1.05;

/// The debug agents with views of their own.
pub enum Follow {
    /// These agents, each while it is present.
    Agents(Vec<u32>),
    /// One of many debug agents.
    Densest(Densest),
}

/// The agent that is followed if debug agents are chosen by region, or all are: the densest one at the moment that the
/// recording opens at. That moment is not known in advance. So the densest agent is followed whenever the crowd becomes
/// clearly denser than ever before, or when the previous agent has left.
#[derive(Default)]
pub struct Densest {
    id: Option<u32>,
    /// The largest density in the crowd when it was chosen, P/m².
    density: f64,
    /// Whether the requested moment has passed. Then only a leaving agent is replaced.
    settled: bool,
}

impl Follow {
    pub fn new(debug: &DebugAgents) -> Self {
        match debug {
            DebugAgents::None => Self::Agents(Vec::new()),
            DebugAgents::Ids(ids) => Self::Agents(ids.iter().copied().take(MOST).collect()),
            DebugAgents::Region(_) | DebugAgents::All => Self::Densest(Densest::default()),
        }
    }

    /// The names of the views.
    pub fn names(&self) -> Vec<String> {
        match self {
            Self::Agents(ids) => ids.iter().map(u32::to_string).collect(),
            Self::Densest(_) => vec!["densest".to_owned()],
        }
    }

    /// The followed agent of each view.
    pub fn ids(&self) -> Vec<Option<u32>> {
        match self {
            Self::Agents(ids) => ids.iter().copied().map(Some).collect(),
            Self::Densest(densest) => vec![densest.id],
        }
    }

    /// Looks at a frame; `opens_here`: it is the moment that the recording was asked to open at.
    pub fn update(&mut self, simulation: &Simulation, debug: &DebugAgents, opens_here: bool) {
        if let Self::Densest(densest) = self {
            densest.update(simulation, debug, opens_here);
        }
    }
}

impl Densest {
    fn update(&mut self, simulation: &Simulation, debug: &DebugAgents, opens_here: bool) {
        let frame = simulation.frame();
        let (agents, density) = (frame.agents, &frame.fields.density);
        let present = agents.present().take(density.len());
        let most = present.map(|i| density[i]).fold(0.0, f64::max);
        let is_gone = self.id.is_none_or(|id| agents.index_of(id).is_none());
        let is_denser = !self.settled && most > DENSER * self.density;
        if !(is_gone || is_denser || opens_here) {
            return;
        }
        let own = (0..density.len()).filter(|&i| debug.includes(simulation, i));
        let densest = own.max_by(|&a, &b| density[a].total_cmp(&density[b]));
        if let Some(i) = densest {
            self.id = Some(agents.id[i]);
            self.density = most;
        } else if is_gone {
            self.id = None;
        }
        self.settled |= opens_here;
    }
}

/// The moment that a recording opens at: the time that was asked for, or else that of the highest density.
#[derive(Default)]
pub struct Moment {
    /// The time that was asked for, seconds.
    asked: Option<f64>,
    /// Whether it was reached.
    is_settled: bool,
    /// The frame and its time. Before the requested time: the moment of the highest density so far, in case the run
    /// ends earlier.
    pub at: Option<(i64, f64)>,
    /// The highest density so far, P/m².
    density: f32,
    /// The first view whose agent is present then, or was before.
    pub view: Option<usize>,
}

impl Moment {
    pub fn new(asked: Option<f64>) -> Self {
        Self {
            asked,
            ..Self::default()
        }
    }

    /// Whether this is the first frame at or after the requested time.
    pub fn is_asked(&self, time: f64) -> bool {
        !self.is_settled && self.asked.is_some_and(|asked| time >= asked)
    }

    /// Looks at a frame.
    pub fn update(&mut self, snapshot: &Snapshot) {
        let density = snapshot.densities.iter().copied().fold(0.0, f32::max);
        let is_asked = self.is_asked(snapshot.time);
        let is_denser = !self.is_settled && (self.at.is_none() || density > self.density);
        if is_asked || is_denser {
            self.at = Some((snapshot.frame, snapshot.time));
            self.density = density;
        }
        if is_asked || is_denser || self.view.is_none() {
            let present = snapshot.followed.iter().position(Option::is_some);
            self.view = present.or(self.view);
        }
        self.is_settled |= is_asked;
    }
}
