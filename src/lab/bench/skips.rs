//! The time that each skip saves: the time of a scene with and without it.
//!
//! A skip is undone in one of two ways. Either the engine computes more than it needs ([`Simulation::pay_for`]), or the
//! skipped work is done beside the engine, on the frozen frame, through the public API. The engine does not know
//! whether it is being measured.

mod work;

use serde::Serialize;
use serde_json::json;

use self::work::{Course, Work};
use super::benchmark::Benchmark;
use super::plan::Plan;
use super::report::Timings;
use super::stages::{Started, begin, busiest};
use crate::error::LabError;
use crate::gallery::{color, key, single};
use analysis::statistics::Range;
use engine::forces::near::Wanted;
use engine::scene::Needs;
use engine::simulation::{Simulation, Stage};
use output::plot::{Axis, BLACK, GRAY, Mark, Sheet, Style};
use output::table::Table;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "skips",
    about: "what each skipped computation saves, at the busiest stretch of each shipped scenario",
    run,
};

/// Work that is skipped if it is not needed.
pub struct Skip {
    /// Its name in reports.
    pub name: &'static str,
    /// The skipped work, in one line.
    pub about: &'static str,
    /// How to do the skipped work in a scene, or why there is nothing to skip.
    undo: fn(&Simulation) -> Result<Undone, &'static str>,
}

/// How to do the skipped work.
enum Undone {
    /// The engine computes more than it needs.
    Needs(Needs),
    /// Separate work on every evaluated frame, which replaces some stages.
    Work(Work, &'static [Stage]),
}

/// The radius of the paper's avoidance, meters (§5.5).
const AVOIDANCE: f64 = 5.0;

/// Frames per turn: few enough that other load on the machine affects all contenders alike.
const TURN: u64 = 10;

/// The stages that list neighbors and walls.
const LISTING: &[Stage] = &[Stage::Sort, Stage::Neighbors];

/// All skips that can be undone.
pub const SKIPS: [Skip; 11] = [
    Skip {
        name: "density",
        about: "density and pressure where nothing reads them",
        undo: |simulation| more(simulation, |needs| needs.density = true),
    },
    Skip {
        name: "pair sums",
        about: "sums over pairs (pressure, viscosity, contact) that no profile reads",
        undo: |simulation| more(simulation, |needs| needs.pairs = everything().pairs),
    },
    Skip {
        name: "far walls",
        about: "lists of the walls within 5 m where no agent avoids",
        undo: |simulation| more(simulation, |needs| needs.avoidance = Some(AVOIDANCE)),
    },
    Skip {
        name: "arrivals",
        about: "the search for arrivals where no agent leaves",
        undo: |simulation| more(simulation, |needs| needs.removal = true),
    },
    Skip {
        name: "RVO by blend",
        about: "a choice of velocity for agents whose density gives RVO no weight",
        undo: |simulation| Ok(Undone::Work(work::rvo_by_blend(simulation)?, &[])),
    },
    Skip {
        name: "lists kept",
        about: "sorting and listing in every frame, rather than when an agent has moved half the skin",
        undo: |_| Ok(Undone::Work(work::lists(false), LISTING)),
    },
    Skip {
        name: "lists kept (5)",
        about: "sorting and listing in every coarse frame, as the paper does; then some neighbors may be missed",
        undo: |_| Ok(Undone::Work(work::lists(true), LISTING)),
    },
    Skip {
        name: "walls by blocks",
        about: "looking for walls agent by agent, rather than by blocks of 128 agents first",
        undo: |simulation| Ok(Undone::Work(work::walls_one_by_one(simulation)?, &[])),
    },
    Skip {
        name: "walking law",
        about: "the headway law where no profile has a walking law",
        undo: |simulation| Ok(Undone::Work(work::walking_law(simulation)?, &[])),
    },
    Skip {
        name: "routes",
        about: "looking up routes on path maps where agents walk straight",
        undo: |simulation| Ok(Undone::Work(work::routes(simulation)?, &[])),
    },
    Skip {
        name: "integrity",
        about: "following each agent's path past all walls, as the measurement `integrity` does where it is asked for",
        undo: |_| Ok(Undone::Work(work::integrity(), &[])),
    },
];

/// More needs than a scene has.
fn more(simulation: &Simulation, add: fn(&mut Needs)) -> Result<Undone, &'static str> {
    let mut own = *simulation.needs();
    add(&mut own);
    let needs = simulation.needs().with(&own);
    match needs == *simulation.needs() {
        true => Err("the scene needs it"),
        false => Ok(Undone::Needs(needs)),
    }
}

/// Everything that can be needed without changing the motion: all that [`Simulation::pay_for`] accepts.
pub fn everything() -> Needs {
    Needs {
        density: true,
        pairs: Wanted::ALL,
        rvo: true,
        social: true,
        walking: true,
        headings: true,
        avoidance: Some(AVOIDANCE),
        reach: 0.0, // forces beyond the paper are not skipped
        removal: true,
        paces: true,
        directions: true,
    }
}

/// The result of one skip in one scene.
#[derive(Serialize)]
struct Saving {
    scenario: &'static str,
    profile: String,
    skip: &'static str,
    /// With the skip.
    with_skip_ms: Range,
    /// With the skip undone; `None` if there is nothing to skip.
    without_skip_ms: Option<Range>,
    /// Frame time without the skip over frame time with it, turn by turn.
    ratio: Option<Range>,
    /// Why there is nothing to skip.
    nothing_to_skip: Option<&'static str>,
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Timings, LabError> {
    let mut rows = Vec::new();
    for stretch in busiest(plan) {
        // Small scenes have social forces alone, too, which read no density.
        let is_large = matches!(stretch.0, "concert" | "plaza");
        let profiles: &[_] = if is_large {
            &[None]
        } else {
            &[None, Some("sf")]
        };
        for &profile in profiles {
            let started = begin(stretch, plan, profile)?;
            say(&format!("{} ({})", started.name, started.profile));
            rows.append(&mut measure(&started, plan)?);
        }
    }
    let skips = SKIPS.map(|skip| format!("{}: {}", skip.name, skip.about));
    Ok(Timings {
        table: table(&rows),
        sheet: picture(&rows),
        rows: json!(rows),
        notes: vec![
            skips.join("\n"),
            "Both times are of the same frames with the same motion, bit by bit. The first four skips are undone by \
             telling the engine that more is needed. For the others the skipped work is done beside the engine, on the \
             same frames, in place of the engine's own work. – : the scene needs the work, or has none of it."
                .to_owned(),
        ],
    })
}

/// The times of a scene, and with each skip undone, if there is something to skip.
fn measure(started: &Started, plan: &Plan) -> Result<Vec<Saving>, LabError> {
    let start = &started.simulation;
    let mut with = Vec::new();
    let mut without = [const { Vec::new() }; SKIPS.len()];
    for _ in 0..plan.repeats {
        let mut base = Course::new(start, None)?;
        let undone = SKIPS.iter().map(|skip| match (skip.undo)(start) {
            Ok(undone) => Course::new(start, Some(undone)).map(Some),
            Err(_) => Ok(None),
        });
        let mut others: Vec<Option<Course>> = undone.collect::<Result<_, _>>()?;
        // All of them take turns of a few frames.
        let mut left = started.frames;
        while left > 0 {
            let some = left.min(TURN);
            left -= some;
            base.advance(some)?;
            for course in others.iter_mut().flatten() {
                course.advance(some)?;
            }
        }
        let times = base.times();
        with.push(times.total_ms_per_frame());
        for (ms, course) in without.iter_mut().zip(&others) {
            ms.extend(course.as_ref().map(|course| course.ms_per_frame(times)));
        }
    }
    let row = |(skip, without): (&Skip, &Vec<f64>)| {
        let nothing_to_skip = (skip.undo)(start).err();
        let known = nothing_to_skip.is_none();
        Saving {
            scenario: started.name,
            profile: started.profile.clone(),
            skip: skip.name,
            with_skip_ms: Range::of(&with),
            without_skip_ms: known.then(|| Range::of(without)),
            ratio: known.then(|| Range::of_ratios(without, &with)),
            nothing_to_skip,
        }
    };
    Ok(SKIPS.iter().zip(&without).map(row).collect())
}

fn table(rows: &[Saving]) -> Table {
    Table::of(rows)
        .column("scenario", |row| row.scenario)
        .column("profile", |row| row.profile.as_str())
        .column("skip", |row| row.skip)
        .fixed("ms/frame with", 4, |row| row.with_skip_ms.median)
        .fixed("without", 4, |row| row.without_skip_ms.map(|ms| ms.median))
        .range("ratio", 2, |row| row.ratio)
        .table()
}

/// A group of bars for each scene: frame time without each skip over frame time with it.
fn picture(rows: &[Saving]) -> Sheet {
    let scenes: Vec<&[Saving]> = rows.chunks(SKIPS.len()).collect();
    let width = 0.9 / SKIPS.len() as f64;
    let ratio = |row: &Saving| row.ratio.map(|ratio| ratio.median);
    let most = rows.iter().filter_map(ratio).fold(2.0, f64::max);
    let mut marks = Vec::new();
    for (k, row) in rows.iter().enumerate() {
        let (scene, skip) = (k / SKIPS.len(), k % SKIPS.len());
        let left = scene as f64 + 0.05 + width * skip as f64;
        marks.push(match ratio(row) {
            Some(ratio) => {
                let ends = [ratio.min(1.0), ratio.max(1.0)];
                Mark::rectangle([left, left + 0.9 * width], ends, color(skip))
            }
            None => Mark::Text(
                [left + 0.5 * width, 1.0 - 0.03 * most],
                "–".to_owned(),
                GRAY,
            ),
        });
    }
    let one = [[0.0, 1.0], [scenes.len() as f64, 1.0]];
    marks.push(Mark::line(one, Style::full(BLACK, 0.6, "")));
    let skips = SKIPS.iter().enumerate();
    marks.extend(skips.map(|(k, skip)| key(color(k), skip.name)));
    let names = scenes
        .iter()
        .map(|scene| format!("{} ({})", scene[0].scenario, scene[0].profile));
    let ratios = Axis::linear("time without the skip over time with it", [0.0, 1.1 * most]);
    single(
        "What each skip saves",
        Axis::names("", names),
        ratios,
        marks,
    )
}
