//! The time of a frame by stage, the tasks of Fig. 11: for each shipped scenario and for dense crowds.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use serde::Serialize;
use serde_json::json;

use super::benchmark::Benchmark;
use super::crowd::Crowd;
use super::hall;
use super::office;
use super::plan::Plan;
use super::report::Timings;
use super::timing::{failed, ms_of, ms_per_frame, warmed};
use crate::error::LabError;
use crate::gallery::{color, key, single};
use analysis::statistics::Range;
use engine::clock::PAPER_TIME_STEP;
use engine::simulation::{Simulation, Stage, StageTimes};
use output::plot::{Axis, BLACK, Mark, Sheet};
use output::table::Table;
use scenario::catalog::WalkingLawKind;
use scenario::measurements::{Measurement, Metrics};
use scenario::{Scenario, Setting, built_in, floor_plan};

pub const BENCHMARK: Benchmark = Benchmark {
    name: "stages",
    about: "time per stage of a frame, of shipped scenarios, dense crowds that avoid, a dense hall with walking laws, \
            an office floor with quickest routes, and people with legs who sway",
    run,
};

/// A time interval of a scenario: the scenario's name, the start and the length, seconds.
pub type Stretch = (&'static str, f64, f64);

/// The busiest stretches: in the evacuation all agents have gathered at the door; in the crossing the streams meet; in
/// the concert the crowd is pushed; on the platforms and at the festival people go through stages of journeys around
/// obstacles.
const BUSIEST: [Stretch; 6] = [
    ("evacuation", 10.0, 10.0),
    ("crossing", 40.0, 10.0),
    ("concert", 150.0, 10.0),
    ("platforms", 60.0, 10.0),
    ("festival", 60.0, 2.0),
    ("plaza", 10.0, 0.5),
];
/// The profiles of scenes that are shipped with another one: those with which docs/findings/performance.md measures
/// them.
const MEASURED_WITH: [(&str, &str); 2] = [("platforms", "rvo->sph"), ("festival", "sph")];
/// Quick plans measure the first `QUICK` stretches.
const QUICK: usize = 4;
/// The stretch of all scenarios in quick plans: start and length, seconds.
const QUICK_STRETCH: (f64, f64) = (0.1, 0.2);

/// The stretch of people who sway on 50 m × 20 m, and their profiles.
const SWAY: Stretch = ("questions/sway", 60.0, 20.0);
const SWAYING: [&str; 3] = ["sph", "legs", "legs+sph"];

/// The stretches of a plan: all, or the first if the plan is quick.
pub fn busiest(plan: &Plan) -> &'static [Stretch] {
    plan.choose(&BUSIEST, &BUSIEST[..QUICK])
}

/// A crowd at the start of the timed frames.
pub struct Started {
    /// The name of the crowd.
    pub name: &'static str,
    /// The name of its profile.
    pub profile: String,
    /// The crowd.
    pub simulation: Simulation,
    /// The measurements that it asks for.
    pub measurements: Vec<Measurement>,
    /// The number of timed frames.
    pub frames: u64,
}

/// A scenario at the start of a stretch, with a profile or with that of benchmarks; an error if the simulation fails.
pub fn begin(stretch: &Stretch, plan: &Plan, profile: Option<&str>) -> Result<Started, LabError> {
    let &(name, from, lasting) = stretch;
    let usual = MEASURED_WITH.iter().find(|(scene, _)| *scene == name);
    let profile = profile.or(usual.map(|(_, profile)| *profile));
    let typed = profile.map(|profile| format!("profile={profile}").parse::<Setting>());
    let parsed = typed.transpose();
    let setting = parsed.map_err(|error| LabError::Data(error.to_string()))?;
    let scenario = scenario(name, setting)?;
    let mut simulation = Simulation::new(scenario.scene).map_err(failed)?;
    let (from, lasting) = plan.choose((from, lasting), QUICK_STRETCH);
    let clock = *simulation.frame().clock;
    ms_per_frame(&mut simulation, clock.frame_at(from))?;
    Ok(Started {
        name,
        profile: scenario.profile_name,
        simulation,
        measurements: scenario.measurements,
        frames: clock.frame_at(lasting),
    })
}

/// A scenario of the folder `scenarios/`, with the floor plan of the same name if there is one, and a setting.
fn scenario(name: &str, setting: Option<Setting>) -> Result<Scenario, LabError> {
    let [file, plan] = ["json", "geojson"].map(|format| format!("{name}.{format}"));
    let found = built_in(Path::new(&file));
    let text = found.ok_or_else(|| LabError::Data(format!("{file} is not built in")))?;
    let mut settings = Vec::from_iter(setting);
    if let Some(text) = built_in(Path::new(&plan)) {
        let parsed = floor_plan::parse(text);
        let floor = parsed.map_err(|error| LabError::Data(format!("{plan}: {error}")))?;
        settings.extend(Setting::floor_plan(&floor, &plan));
    }
    Scenario::parse(text, &file, &settings).map_err(|error| LabError::of(name, error))
}

/// The results for one crowd.
#[derive(Serialize)]
struct Divided {
    crowd: &'static str,
    profile: String,
    agents: usize,
    frames: u64,
    ms_per_frame: Range,
    /// The stages that run, by name.
    stages_ms: BTreeMap<&'static str, Range>,
    /// The scenario's measurements and those of every run, which are not part of the stages.
    measurements_ms: Range,
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Timings, LabError> {
    let sizes = Sizes::of(plan);
    let mut rows = Vec::new();
    for stretch in busiest(plan) {
        say(stretch.0);
        rows.extend(in_turns([begin(stretch, plan, None)], plan)?);
    }
    rows.extend(in_turns(sizes.streams(say), plan)?);
    rows.extend(in_turns(sizes.halls(say), plan)?);
    rows.extend(in_turns(sizes.offices(say), plan)?);
    let swaying = SWAYING.map(|profile| {
        say(&format!("swaying crowd, {profile}"));
        let started = begin(&SWAY, plan, Some(profile))?;
        Ok(Started {
            name: "swaying crowd",
            ..started
        })
    });
    rows.extend(in_turns(swaying, plan)?);
    Ok(Timings {
        table: table(&rows),
        sheet: picture(&rows),
        rows: json!(rows),
        notes: vec![sizes.note(plan)],
    })
}

/// The sizes of the crowds that no file has, and the numbers of frames before they are timed and while.
struct Sizes {
    /// The agents in streams.
    agents: u32,
    /// The frames in which streams and halls settle.
    before: u64,
    streaming: u64,
    /// The columns and rows of pillars in the hall.
    bays: [u32; 2],
    walking: u64,
    corridors: u32,
    /// The frames in which people leave offices, before and while they are timed.
    leaving: u64,
}

impl Sizes {
    fn of(plan: &Plan) -> Self {
        Self {
            agents: plan.choose(10_000, 400),
            before: plan.choose(50, 5),
            streaming: plan.choose(25, 5),
            bays: plan.choose([13, 5], [2, 1]),
            walking: plan.choose(100, 5),
            corridors: plan.choose(10, 1),
            leaving: plan.choose(250, 5),
        }
    }

    fn streams(&self, say: &dyn Fn(&str)) -> [Result<Started, LabError>; 2] {
        ["sf", "rvo"].map(|profile| {
            say(&format!("{} agents at 4 P/m², {profile}", self.agents));
            let simulation = Crowd::streams(self.agents, profile).settled(self.before)?;
            let name = "streams, 4 P/m²";
            Ok(Started::settled(name, profile, simulation, self.streaming))
        })
    }

    /// Without and with each walking law.
    fn halls(&self, say: &dyn Fn(&str)) -> Vec<Result<Started, LabError>> {
        let kinds = std::iter::once(WalkingLawKind::None).chain(WalkingLawKind::laws());
        let hall = |law: WalkingLawKind| {
            let word = json!(law);
            let name = word.as_str().unwrap_or_default();
            say(&format!("hall with pillars, walking law {name}"));
            let profile = match law {
                WalkingLawKind::None => "sph".to_owned(),
                _ => format!("sph, {name}"),
            };
            let simulation = hall::settled(self.bays, self.before, law)?;
            let crowd = "hall with pillars";
            Ok(Started::settled(crowd, &profile, simulation, self.walking))
        };
        kinds.map(hall).collect()
    }

    fn offices(&self, say: &dyn Fn(&str)) -> [Result<Started, LabError>; 2] {
        ["shortest", "quickest"].map(|choice| {
            say(&format!("office floor, {choice} routes"));
            let profile = format!("walk+sph, {choice}");
            let crowd = office::settled(self.corridors, self.leaving, choice)?;
            Ok(Started::settled(
                "office floor",
                &profile,
                crowd,
                self.leaving,
            ))
        })
    }

    /// What the rows are.
    fn note(&self, plan: &Plan) -> String {
        let named = busiest(plan).iter().map(|&(name, from, lasting)| {
            let (from, lasting) = plan.choose((from, lasting), QUICK_STRETCH);
            format!("{name} {from}–{} s", from + lasting)
        });
        let stretches = named.collect::<Vec<_>>().join(", ");
        let (sway, swaying) = plan.choose((SWAY.1, SWAY.2), QUICK_STRETCH);
        let until = |frames: u64| PAPER_TIME_STEP * (self.before + frames) as f64;
        format!(
            "Stages are medians, in ms per frame; every repeat takes the same frames. Shipped scenarios, \
             with these profiles: {stretches}. Streams: {} agents from {from:.1} to {:.1} s, half of them \
             walking to the right and \
             half to the left. Hall: {} pillars stand between the agents, at 4.7 P/m², and their goal; from {from:.1} \
             to {:.1} s, without and with a walking law. Office floor: {} people leave {} rooms from {:.1} to {:.1} s, \
             by the shortest or by the quickest routes. Swaying crowd: questions/sway.json from {sway} to {} s; with \
             `sph` it is at rest. Rows of one crowd take turns. Measuring: the scenario's measurements and the search \
             for agents that stand, as in every run; it is not part of the frame. – : a stage that never runs.",
            self.agents,
            until(self.streaming),
            self.bays[0] * self.bays[1],
            until(self.walking),
            1000 * self.corridors,
            20 * self.corridors,
            PAPER_TIME_STEP * self.leaving as f64,
            PAPER_TIME_STEP * 2.0 * self.leaving as f64,
            sway + swaying,
            from = until(0),
        )
    }
}

impl Started {
    /// A crowd that has settled, without measurements.
    fn settled(name: &'static str, profile: &str, simulation: Simulation, frames: u64) -> Self {
        Self {
            name,
            profile: profile.to_owned(),
            simulation,
            measurements: Vec::new(),
            frames,
        }
    }
}

/// Measures crowds, which take turns.
fn in_turns(
    started: impl IntoIterator<Item = Result<Started, LabError>>,
    plan: &Plan,
) -> Result<Vec<Divided>, LabError> {
    let started: Vec<Started> = started.into_iter().collect::<Result<_, _>>()?;
    let mut times = vec![Vec::with_capacity(plan.repeats); started.len()];
    for _ in 0..plan.repeats {
        for (started, times) in started.iter().zip(&mut times) {
            times.push(replay(started)?);
        }
    }
    let rows = started.into_iter().zip(&times);
    Ok(rows
        .map(|(started, times)| divided(started, times))
        .collect())
}

/// The results for a crowd, given the times of its stages and of its measurements in each repeat.
fn divided(started: Started, times: &[(StageTimes, f64)]) -> Divided {
    let range = |ms: &dyn Fn(&StageTimes) -> f64| {
        let values: Vec<f64> = times.iter().map(|(times, _)| ms(times)).collect();
        Range::of(&values)
    };
    let measuring: Vec<f64> = times.iter().map(|&(_, ms)| ms).collect();
    let all = Stage::ALL.map(|stage| (stage.name(), range(&|times| ms_of(times, stage))));
    let stages = all.into_iter().filter(|(_, range)| range.maximum > 0.0);
    Divided {
        crowd: started.name,
        agents: started.simulation.frame().agents.len(),
        profile: started.profile,
        frames: started.frames,
        ms_per_frame: range(&StageTimes::total_ms_per_frame),
        stages_ms: stages.collect(),
        measurements_ms: Range::of(&measuring),
    }
}

/// The times of the stages, and the milliseconds per frame of the measurements.
fn replay(started: &Started) -> Result<(StageTimes, f64), LabError> {
    let mut simulation = warmed(&started.simulation)?;
    let mut metrics = Metrics::new(&started.measurements, &mut simulation);
    let seconds = rayon::scope(|_| {
        let mut seconds = 0.0;
        for _ in 0..started.frames {
            simulation.evaluate().map_err(failed)?;
            let start = Instant::now();
            metrics.observe(&simulation);
            seconds += start.elapsed().as_secs_f64();
            simulation.integrate().map_err(failed)?;
        }
        Ok::<_, LabError>(seconds)
    })?;
    let measuring = 1e3 * seconds / started.frames as f64;
    Ok((simulation.stages().clone(), measuring))
}

impl Divided {
    /// The median time of a stage, ms; `None` if it never runs.
    fn median(&self, stage: Stage) -> Option<f64> {
        self.stages_ms.get(stage.name()).map(|range| range.median)
    }
}

fn table(rows: &[Divided]) -> Table {
    let mut table = Table::of(rows)
        .column("crowd", |row| row.crowd)
        .column("profile", |row| row.profile.as_str())
        .column("agents", |row| row.agents)
        .range("ms/frame", 4, |row| row.ms_per_frame);
    for stage in Stage::ALL {
        let name = stage.name().split('_').next().unwrap_or_default();
        table = table.fixed(name, 4, |row| row.median(stage));
    }
    table
        .fixed("measuring", 4, |row| row.measurements_ms.median)
        .table()
}

/// Bars of equal height, divided by the shares of the stages.
fn picture(rows: &[Divided]) -> Sheet {
    let mut marks: Vec<Mark> = Vec::new();
    for (k, row) in rows.iter().enumerate() {
        let middle = k as f64 + 0.5;
        let all: f64 = row.stages_ms.values().map(|range| range.median).sum();
        let mut foot = 0.0;
        for (k, stage) in Stage::ALL.into_iter().enumerate() {
            let head = foot + 100.0 * row.median(stage).unwrap_or(0.0) / all;
            let sides = [middle - 0.35, middle + 0.35];
            marks.push(Mark::rectangle(sides, [foot, head], color(k)));
            foot = head;
        }
        // About three digits.
        let ms = row.ms_per_frame.median;
        let digits = (2.0 - ms.log10().floor()).clamp(0.0, 3.0) as usize;
        marks.push(Mark::Text([middle, 105.0], format!("{ms:.digits$}"), BLACK));
    }
    let stages = Stage::ALL.iter().enumerate().rev();
    marks.extend(stages.map(|(k, stage)| key(color(k), &stage.name().replace('_', " "))));
    let name = |row: &Divided| format!("{} ({})", row.crowd, row.profile);
    let names = Axis::names("", rows.iter().map(name));
    let ticks = [0, 20, 40, 60, 80, 100].map(|k| (f64::from(k), k.to_string()));
    let share = Axis::linear("share of the frame [%]", [0.0, 110.0]).ticked(ticks);
    single(
        "Where the time of a frame goes; above, its length [ms]",
        names,
        share,
        marks,
    )
}
