//! The whole measurement: every scene under every knob. Errors are stored; costs are measured anew.

use serde_json::Value;

use super::cost;
use super::found::{Found, Measured, Point, Quantity};
use super::knob::{Curve, Detail, Knob, without_defaults};
use super::report::Report;
use super::scenes::{Kind, Scene, continued, simulation};
use super::statistics::{self, Sample, deviations};
use super::trajectory::{SAMPLES, Trajectories, trajectories};
use super::walls;
use crate::engine::simulation::Simulation;
use crate::lab::error::LabError;
use crate::lab::jobs::{read, results};
use crate::runs::identity::Identity;
use crate::runs::job::{Job, Listener, Progress};
use crate::runs::store::Store;

/// What to measure.
#[derive(Clone)]
pub struct Plan {
    /// The scenes.
    pub scenes: Vec<Scene>,
    /// Are the integrals over walls measured, too?
    pub walls: bool,
    /// The knobs whose values are tried.
    pub knobs: Vec<Knob>,
    /// A check that everything works: few values, two seeds, and costs from a single turn.
    pub quick: bool,
}

/// How often each cost is measured.
const TURNS: usize = 5;
/// Costs of Table 1's scenes are measured in a dense crowd: at this time, seconds.
const DENSE_AT: f64 = 15.0;
/// The settings of the reference for statistics.
const FINE: [&str; 3] = [
    "time_step_secs=0.0025",
    "integrator=velocity-verlet",
    "precision=double",
];

/// A scene and the curves to be measured in it.
struct Task {
    scene: Scene,
    document: Value,
    curves: Vec<Curve>,
}

/// Does the jobs of the plan whose results are not in `store`, and writes tables and pictures.
///
/// # Errors
/// A run or a file fails.
pub fn accuracy(plan: &Plan, store: &Store, listener: &dyn Listener) -> Result<Report, LabError> {
    let mut tasks = Vec::new();
    let mut jobs = Vec::new();
    for &scene in &plan.scenes {
        let task = Task::new(scene, plan)?;
        jobs.extend(task.jobs(plan));
        tasks.push(task);
    }
    let results = results(&jobs, store, listener)?;
    let mut results = results.iter();
    let mut found = Vec::new();
    for task in &tasks {
        let own: Vec<&Value> = results.by_ref().take(task.jobs(plan).len()).collect();
        found.push(task.finish(plan, &own, listener)?);
    }
    if plan.walls {
        listener.notes("wall-integrals: measuring errors and costs");
    }
    let report = Report {
        scenes: found,
        walls: plan.walls.then(|| walls::measure(plan.quick)),
        quick: plan.quick,
    };
    report.write(store)?;
    super::pictures::save(&report, store)?;
    Ok(report)
}

impl Task {
    fn new(scene: Scene, plan: &Plan) -> Result<Self, LabError> {
        let document = scene.document()?;
        let first = simulation(&document, &[])?;
        let has_walls = !first.frame().walls.is_empty();
        let detail = match scene.kind {
            _ if plan.quick => Detail::Few,
            Kind::Motion => Detail::All,
            Kind::Evacuation | Kind::Wave => Detail::Coarser,
        };
        let acts = |knob: &&Knob| knob.acts(first.needs(), has_walls);
        let knobs = plan.knobs.iter().filter(acts);
        Ok(Self {
            scene,
            document,
            curves: knobs.flat_map(|knob| knob.curves(detail)).collect(),
        })
    }

    /// All points, curve by curve.
    fn points(&self) -> impl Iterator<Item = (&Curve, &Vec<String>)> {
        let curves = self.curves.iter();
        curves.flat_map(|curve| curve.points.iter().map(move |point| (curve, point)))
    }

    /// All distinct settings.
    fn settings(&self) -> Vec<Vec<String>> {
        let mut once: Vec<Vec<String>> = Vec::new();
        for (_, settings) in self.points() {
            let settings = without_defaults(settings);
            if !once.contains(&settings) {
                once.push(settings);
            }
        }
        once
    }

    /// For each point, the index of its settings in [`settings`](Self::settings).
    fn places(&self) -> Vec<usize> {
        let once = self.settings();
        let place = |settings: &Vec<String>| {
            let settings = without_defaults(settings);
            once.iter().position(|other| *other == settings)
        };
        self.points()
            .filter_map(|(_, settings)| place(settings))
            .collect()
    }

    fn seeds(&self, plan: &Plan) -> u64 {
        if plan.quick { 2 } else { self.scene.seeds }
    }

    fn fine() -> Vec<String> {
        FINE.map(str::to_owned).to_vec()
    }

    fn jobs(&self, plan: &Plan) -> Vec<Job<'static>> {
        match self.scene.kind {
            Kind::Motion => vec![self.motion_job(plan.quick)],
            Kind::Evacuation | Kind::Wave => {
                let reference = (!plan.quick).then(Self::fine);
                let settings = self.settings().into_iter().chain(reference);
                let seeds = 1..=self.seeds(plan);
                settings
                    .flat_map(|settings| {
                        let seeds = seeds.clone();
                        seeds.map(move |seed| self.sample_job(settings.clone(), seed))
                    })
                    .collect()
            }
        }
    }

    fn motion_job(&self, quick: bool) -> Job<'static> {
        let document = self.document.clone();
        let points: Vec<(Knob, Vec<String>)> = self
            .points()
            .map(|(curve, settings)| (curve.knob, settings.clone()))
            .collect();
        let name = format!("motion {}, {} points", self.scene.name, points.len());
        let input = format!("{document} {points:?} {quick}");
        Job::new(name.clone(), Identity::of(&name, input), 10.0, move |_| {
            trajectories(&document, &points, quick)
        })
    }

    fn sample_job(&self, settings: Vec<String>, seed: u64) -> Job<'static> {
        let (kind, document) = (self.scene.kind, self.document.clone());
        let name = format!("{} {} seed {seed}", self.scene.name, settings.join(" "));
        let expected = self.expected_secs(&settings);
        let input = document.to_string();
        let work = move |_: Progress| statistics::sample(kind, &document, &settings, seed);
        Job::new(name.clone(), Identity::of(&name, input), expected, work)
    }

    /// Estimated time of one sample, seconds: for the progress bar, and to start the longest jobs first.
    fn expected_secs(&self, settings: &[String]) -> f64 {
        let one = match self.scene.name {
            "evacuation" => 0.7,
            "wave" => 0.3,
            _ => 3.0,
        };
        let number = |key: &str| {
            let mut values = settings.iter().filter_map(|text| text.strip_prefix(key));
            values.find_map(|value| value.parse::<f64>().ok())
        };
        let steps = number("time_step_secs=").map_or(1.0, |step| 0.02 / step);
        let candidates = number("candidates=").map_or(1.0, |count| (count / 250.0).max(1.0));
        let coarse = number("coarse_every=").map_or(1.0, |frames| (5.0 / frames).max(1.0));
        one * steps * candidates * coarse
    }

    /// Combines the results of the jobs, and measures the costs.
    fn finish(
        &self,
        plan: &Plan,
        results: &[&Value],
        listener: &dyn Listener,
    ) -> Result<Found, LabError> {
        let (quantities, errors, notes) = match self.scene.kind {
            Kind::Motion => self.motion_errors(results)?,
            Kind::Evacuation | Kind::Wave => self.statistics_errors(plan, results)?,
        };
        let settings = self.settings();
        let turns = if plan.quick { 1 } else { TURNS };
        let (count, name) = (settings.len(), self.scene.name);
        listener.notes(&format!("{name}: measuring the cost of {count} settings"));
        let costs = cost::measure(&self.busy()?, &settings, turns)?;
        let mut points = Vec::new();
        for (((curve, own), place), errors) in self.points().zip(self.places()).zip(errors) {
            points.push(Point {
                knob: curve.knob,
                curve: curve.label.clone(),
                settings: own.clone(),
                cost: costs[place],
                errors,
            });
        }
        Ok(Found {
            scene: self.scene,
            quantities,
            points,
            notes,
        })
    }

    /// The document whose cost is measured. Unless a scene is judged by motion, its crowd is first made dense.
    fn busy(&self) -> Result<Value, LabError> {
        let until = match self.scene.kind {
            Kind::Motion => return Ok(self.document.clone()),
            Kind::Evacuation | Kind::Wave => DENSE_AT,
        };
        let mut crowd = simulation(&self.document, &[])?;
        while crowd.frame().clock.time() < until {
            Simulation::step(&mut crowd)
                .map_err(|fault| LabError::of(self.scene.name.to_owned(), fault))?;
        }
        Ok(continued(&self.document, &crowd))
    }

    fn motion_errors(&self, results: &[&Value]) -> Result<Errored, LabError> {
        let found: Trajectories = read(results[0])?;
        let mut quantities = Vec::new();
        for (name, unit) in [("position", "m"), ("velocity", "m/s"), ("density", "P/m²")] {
            let at = |time: f64| Quantity::new(&format!("{name} at {time} s"), unit);
            quantities.extend(SAMPLES.map(at));
        }
        let middle = SAMPLES[1];
        let alone = format!("position at {middle} s by this knob alone");
        quantities.push(Quantity::new(&alone, "m"));
        let errors = found.points.iter().map(|(total, own)| {
            let all = [total.position, total.velocity, total.density].concat();
            let own = own.map(|own| own.position[1]);
            let values = all.into_iter().map(Some).chain([own]);
            values.map(|v| v.map(Measured::exact)).collect()
        });
        let lyapunov = &found.lyapunov;
        let [_, own_error, _] = found.reference.position;
        let notes = format!(
            "Two crowds that began almost alike part by e^({:.1} t), t in seconds ({}); after {} s at most \
             {:.3} times as far as at the start. The reference's own error at {middle} s is some {own_error:.0e} m.",
            lyapunov.rate(),
            lyapunov.time().map_or_else(
                || "they draw together".to_owned(),
                |time| format!("Lyapunov time {time:.2} s")
            ),
            SAMPLES[2],
            lyapunov.growth,
        );
        Ok((quantities, errors.collect(), notes))
    }

    fn statistics_errors(&self, plan: &Plan, results: &[&Value]) -> Result<Errored, LabError> {
        let kind = self.scene.kind;
        let seeds = self.seeds(plan) as usize;
        let samples: Result<Vec<Sample>, _> = results.iter().map(|value| read(value)).collect();
        let samples = samples?;
        let settings = self.settings();
        let of = |k: usize| &samples[k * seeds..(k + 1) * seeds];
        // A quick plan has no reference runs: it uses the first point.
        let reference = if plan.quick {
            of(0)
        } else {
            of(settings.len())
        };
        let mut quantities: Vec<Quantity> = statistics::names(kind)
            .iter()
            .map(|(name, unit)| Quantity::new(name, unit))
            .collect();
        if kind == Kind::Evacuation {
            quantities.push(Quantity::new("speed by density", "m/s"));
        }
        let errors = self.places().into_iter().map(|place| {
            let found = deviations(kind, of(place), reference);
            found.into_iter().map(|d| d.map(Measured::from)).collect()
        });
        let errors = errors.collect();
        let against = if plan.quick {
            format!("the first point, {},", settings[0].join(" "))
        } else {
            FINE.join(" ")
        };
        let notes =
            format!("Over {seeds} seeds, against {against} with as many; intervals are 95 %.");
        Ok((quantities, errors, notes))
    }
}

/// The quantities, the errors of each point, and the notes.
type Errored = (Vec<Quantity>, Vec<Vec<Option<Measured>>>, String);
