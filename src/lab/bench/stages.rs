//! The time of a frame by stage, the tasks of Fig. 11: for each shipped scenario and for dense crowds.

use serde_json::{Map, Value, json};

use super::crowd::Crowd;
use super::error::BenchError;
use super::report::{Findings, three};
use super::timing::{ms_of, replay};
use super::{Benchmark, Plan};
use crate::analysis::statistics::Range;
use crate::engine::simulation::{Simulation, Stage, StageTimes};
use crate::output::table::OldTable as Table;
use crate::scenario::{Scenario, Setting};

pub const BENCHMARK: Benchmark = Benchmark {
    name: "stages",
    about: "time per stage of a frame, at the busiest stretch of each shipped scenario and in dense crowds that avoid",
    run,
};

/// A time interval of a scenario.
pub struct Stretch {
    /// The scenario's name.
    pub scenario: &'static str,
    /// Its start, seconds.
    pub from: f64,
    /// Its length, seconds.
    pub lasting: f64,
}

/// The busiest stretches: in the evacuation all agents have gathered at the door; in the crossing the streams meet; in
/// the concert the crowd is pushed.
const BUSIEST: [Stretch; 4] = [
    Stretch {
        scenario: "evacuation",
        from: 10.0,
        lasting: 10.0,
    },
    Stretch {
        scenario: "crossing",
        from: 40.0,
        lasting: 10.0,
    },
    Stretch {
        scenario: "concert",
        from: 150.0,
        lasting: 10.0,
    },
    Stretch {
        scenario: "plaza",
        from: 10.0,
        lasting: 0.5,
    },
];

/// The stretches of a plan: all, or those of the small scenes if the plan is quick.
pub fn busiest(plan: &Plan) -> &'static [Stretch] {
    plan.choose(&BUSIEST, &BUSIEST[..3])
}

impl Stretch {
    /// The scenario at the start of the stretch, as shipped or with another profile, and the number of frames.
    ///
    /// # Errors
    /// The profile is invalid, or the simulation fails.
    pub fn begin(&self, plan: &Plan, profile: Option<&str>) -> Result<Started, BenchError> {
        let setting = profile.map(|name| format!("profile={name}").parse::<Setting>());
        let settings: Vec<Setting> = setting.into_iter().collect::<Result<_, _>>()?;
        let scenario = Scenario::shipped(self.scenario, &settings)?;
        let mut simulation = Simulation::new(scenario.scene)?;
        let (from, lasting) = plan.choose((self.from, self.lasting), (0.1, 0.2));
        let clock = *simulation.frame().clock;
        for _ in 0..clock.frame_at(from) {
            simulation.step()?;
        }
        Ok(Started {
            name: self.scenario,
            profile: scenario.profile_name,
            simulation,
            frames: clock.frame_at(lasting),
        })
    }
}

/// A crowd at the start of the timed frames.
pub struct Started {
    pub name: &'static str,
    pub profile: String,
    pub simulation: Simulation,
    pub frames: u64,
}

/// The results for one crowd.
struct Row {
    name: &'static str,
    profile: String,
    agents: usize,
    frames: u64,
    total: Range,
    /// All stages in order; stages that never run are 0.
    stages: Vec<Range>,
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Findings, BenchError> {
    let mut rows = Vec::new();
    for stretch in busiest(plan) {
        say(stretch.scenario);
        rows.push(measure(&stretch.begin(plan, None)?, plan)?);
    }
    for profile in ["sf", "rvo"] {
        let agents = plan.choose(10_000, 400);
        say(&format!("{agents} agents at 4 P/m², {profile}"));
        let started = Started {
            name: "streams, 4 P/m²",
            profile: profile.to_owned(),
            simulation: Crowd::streams(agents, profile).settled(plan.choose(50, 5))?,
            frames: plan.choose(25, 5),
        };
        rows.push(measure(&started, plan)?);
    }
    Ok(Findings {
        table: table(&rows),
        rows: rows.iter().map(Row::json).collect(),
        notes: vec![note(&rows)],
        sheet: picture::sheet(&rows),
    })
}

fn measure(started: &Started, plan: &Plan) -> Result<Row, BenchError> {
    let times: Result<Vec<StageTimes>, _> = (0..plan.repeats)
        .map(|_| replay(&started.simulation, started.frames))
        .collect();
    let times = times?;
    let spread = |ms: &dyn Fn(&StageTimes) -> f64| {
        let values: Vec<f64> = times.iter().map(ms).collect();
        Range::of(&values)
    };
    let stage = |&stage: &Stage| spread(&|times| ms_of(times, stage));
    Ok(Row {
        name: started.name,
        profile: started.profile.clone(),
        agents: started.simulation.frame().agents.len(),
        frames: started.frames,
        total: spread(&StageTimes::total_ms_per_frame),
        stages: Stage::ALL.iter().map(stage).collect(),
    })
}

impl Row {
    /// The stages that run.
    fn running(&self) -> impl Iterator<Item = (Stage, &Range)> {
        let all = Stage::ALL.into_iter().zip(&self.stages);
        all.filter(|(_, spread)| spread.maximum > 0.0)
    }

    fn json(&self) -> Value {
        let stages = self.running();
        let stages: Map<String, Value> = stages
            .map(|(stage, spread)| (stage.name().to_owned(), json!(spread)))
            .collect();
        json!({
            "crowd": self.name,
            "profile": self.profile,
            "agents": self.agents,
            "frames": self.frames,
            "ms_per_frame": self.total,
            "stages_ms": stages,
        })
    }
}

fn note(rows: &[Row]) -> String {
    let stretch = |s: &Stretch| format!("{} {}–{} s", s.scenario, s.from, s.from + s.lasting);
    let stretches = BUSIEST.each_ref().map(stretch).join(", ");
    let most = rows.last().map_or(0, |row| row.agents);
    format!(
        "Stages are medians, in ms per frame; every repeat takes the same frames. Scenarios as shipped: {stretches}. Streams: \
         {most} people, half of them on their way to either side, after their first second. A stage that never runs is –."
    )
}

fn table(rows: &[Row]) -> Table {
    let mut head = vec![
        "crowd",
        "profile",
        "agents",
        "ms/frame min",
        "median",
        "max",
    ];
    head.extend([
        "sort",
        "neighbors",
        "density",
        "preferred",
        "rvo",
        "forces",
        "moving",
    ]);
    let mut table = Table::new(2, &head);
    for row in rows {
        let mut cells = vec![
            row.name.to_owned(),
            row.profile.clone(),
            row.agents.to_string(),
        ];
        cells.extend(three(&row.total, 4));
        cells.extend(row.stages.iter().map(|spread| {
            if spread.maximum > 0.0 {
                format!("{:.4}", spread.median)
            } else {
                "–".to_owned()
            }
        }));
        table.rows.push(cells);
    }
    table
}

mod picture {
    use super::Row;
    use crate::engine::simulation::Stage;
    use crate::lab::bench::pictures::{self, bar, color, key};
    use crate::output::plot::{Axis, BLACK, Mark, Sheet};

    /// Bars of equal height, divided by the shares of the stages.
    pub fn sheet(rows: &[Row]) -> Sheet {
        let mut marks: Vec<Mark> = Vec::new();
        for (k, row) in rows.iter().enumerate() {
            let middle = k as f64 + 0.5;
            let all: f64 = row.stages.iter().map(|spread| spread.median).sum();
            let mut foot = 0.0;
            for (k, spread) in row.stages.iter().enumerate() {
                let head = foot + 100.0 * spread.median / all;
                marks.push(bar([middle - 0.35, middle + 0.35], [foot, head], color(k)));
                foot = head;
            }
            let total = short(row.total.median);
            marks.push(Mark::Text([middle, 105.0], total, BLACK));
        }
        let stages = Stage::ALL.iter().enumerate().rev();
        marks.extend(stages.map(|(k, stage)| key(color(k), &stage.name().replace('_', " "))));
        let names = rows
            .iter()
            .map(|row| format!("{} ({})", row.name, row.profile));
        let mut share = Axis::linear("share of the frame [%]", [0.0, 110.0]);
        share.ticks = (0..=5)
            .map(|k| (20.0 * f64::from(k), format!("{}", 20 * k)))
            .collect();
        let title = "Where the time of a frame goes".to_owned();
        pictures::sheet(title, Axis::names("", names), share, marks)
    }

    /// Milliseconds with about three digits.
    fn short(ms: f64) -> String {
        let digits = (2.0 - ms.log10().floor()).clamp(0.0, 3.0) as usize;
        format!("{ms:.digits$} ms")
    }
}
