//! What each skip saves: the time of a scene with and without it.
//!
//! A skip is undone in one of two ways. Either the engine computes more than it needs ([`Simulation::pay_for`]), or the
//! skipped work is done beside the engine, on the frozen frame, through the public API. The engine does not know
//! whether it is being measured.

mod work;

use serde::Serialize;
use serde_json::json;

use self::work::{Course, KeptLists, RvoByBlend, WallsByBlocks, Work};
use super::error::BenchError;
use super::report::{Findings, three};
use super::stages::{Started, Stretch, busiest};
use super::timing::ms_of;
use super::{Benchmark, Plan};
use crate::analysis::statistics::Range;
use crate::engine::pairs::Wanted;
use crate::engine::scene::Needs;
use crate::engine::simulation::{Simulation, Stage};
use crate::output::table::OldTable as Table;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "skips",
    about: "what each skipped computation saves, at the busiest stretch of each shipped scenario",
    run,
};

/// Work that is skipped if it is not needed.
pub struct Skip {
    /// Its name in reports.
    pub name: &'static str,
    /// What is skipped, in one line.
    pub about: &'static str,
    undone: Undone,
}

/// How to do the skipped work.
enum Undone {
    /// The engine computes more than it needs.
    Needs(Needs),
    /// Separate work replaces some stages.
    Work {
        instead_of: &'static [Stage],
        begin: fn() -> Box<dyn Work>,
    },
}

/// No needs at all.
const NOTHING: Needs = Needs {
    density: false,
    pairs: Wanted {
        pressure: false,
        viscosity: false,
        contact: false,
    },
    rvo: false,
    social: false,
    avoidance: None,
    removal: false,
};

/// Every sum over pairs.
const ALL_PAIRS: Wanted = Wanted {
    pressure: true,
    viscosity: true,
    contact: true,
};

/// The radius of the paper's avoidance, meters (§5.5).
const AVOIDANCE: f64 = 5.0;

/// Frames per turn: few enough that other load on the machine affects all contenders alike.
const TURN: u64 = 10;

/// The stages that list neighbors and walls.
const LISTING: &[Stage] = &[Stage::Sort, Stage::Neighbors];

/// All skips that can be undone.
pub const SKIPS: [Skip; 8] = [
    Skip {
        name: "density",
        about: "density and pressure where nothing reads them",
        undone: Undone::Needs(Needs {
            density: true,
            ..NOTHING
        }),
    },
    Skip {
        name: "pair sums",
        about: "sums over pairs (pressure, viscosity, contact) that no profile wants",
        undone: Undone::Needs(Needs {
            pairs: ALL_PAIRS,
            ..NOTHING
        }),
    },
    Skip {
        name: "far walls",
        about: "lists of the walls within 5 m where no agent avoids",
        undone: Undone::Needs(Needs {
            avoidance: Some(AVOIDANCE),
            ..NOTHING
        }),
    },
    Skip {
        name: "arrivals",
        about: "the search for arrivals where no agent leaves",
        undone: Undone::Needs(Needs {
            removal: true,
            ..NOTHING
        }),
    },
    Skip {
        name: "RVO by blend",
        about: "a choice of velocity for those whose density gives RVO no weight",
        undone: Undone::Work {
            instead_of: &[],
            begin: || Box::new(RvoByBlend),
        },
    },
    Skip {
        name: "lists kept",
        about: "sorting and listing in every frame, rather than when an agent has moved half the skin",
        undone: Undone::Work {
            instead_of: LISTING,
            begin: || Box::new(KeptLists::every_frame()),
        },
    },
    Skip {
        name: "lists kept (5)",
        about: "sorting and listing in every coarse frame, as the paper does; then some may be missed",
        undone: Undone::Work {
            instead_of: LISTING,
            begin: || Box::new(KeptLists::every_coarse_frame()),
        },
    },
    Skip {
        name: "walls by blocks",
        about: "looking for walls person by person, rather than by blocks of 128 first",
        undone: Undone::Work {
            instead_of: &[],
            begin: || Box::new(WallsByBlocks::default()),
        },
    },
];

/// Everything that can be needed without changing the motion: all that [`Simulation::pay_for`] accepts.
pub fn everything() -> Needs {
    Needs {
        density: true,
        pairs: ALL_PAIRS,
        rvo: true,
        social: true,
        avoidance: Some(AVOIDANCE),
        removal: true,
    }
}

/// The result of one skip in one scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Row {
    scenario: &'static str,
    profile: String,
    skip: &'static str,
    /// With the skip, as shipped.
    with_skip_ms: Range,
    /// With the skip undone; `None` if there is nothing to skip.
    without_skip_ms: Option<Range>,
    /// Frame time without the skip over frame time with it, turn by turn.
    ratio: Option<Range>,
    /// Why there is nothing to skip.
    nothing_to_skip: Option<&'static str>,
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Findings, BenchError> {
    let mut rows = Vec::new();
    for stretch in busiest(plan) {
        for profile in profiles(stretch) {
            let started = stretch.begin(plan, *profile)?;
            say(&format!("{} ({})", started.name, started.profile));
            rows.append(&mut measure(&started, plan)?);
        }
    }
    Ok(Findings {
        table: table(&rows),
        rows: json!(rows),
        notes: notes(),
        sheet: picture::sheet(&rows),
    })
}

/// The profiles of a stretch: the shipped one and, for small scenes, social forces alone, which read no density.
fn profiles(stretch: &Stretch) -> &'static [Option<&'static str>] {
    if matches!(stretch.scenario, "concert" | "plaza") {
        &[None]
    } else {
        &[None, Some("sf")]
    }
}

fn notes() -> Vec<String> {
    let skips = SKIPS.iter();
    let skips: Vec<String> = skips
        .map(|skip| format!("{}: {}", skip.name, skip.about))
        .collect();
    let how = "Both times are of the same frames with the same motion, bit by bit. The first four are undone by telling the \
               engine that more is needed; of the others the work itself is done beside the engine, on the same frames, and \
               takes the place of the engine's own. – : the scene needs it, or has none of it.";
    vec![skips.join("\n"), how.to_owned()]
}

/// Why there is nothing to skip, or `None` if there is something.
fn nothing_to_skip(skip: &Skip, simulation: &Simulation) -> Option<&'static str> {
    match &skip.undone {
        Undone::Needs(more) => {
            let needs = simulation.needs();
            (needs.with(more) == *needs).then_some("the scene needs it")
        }
        Undone::Work { begin, .. } => begin().nothing_to_do(simulation),
    }
}

fn measure(started: &Started, plan: &Plan) -> Result<Vec<Row>, BenchError> {
    let undone = |skip: &&Skip| nothing_to_skip(skip, &started.simulation).is_none();
    let undone: Vec<&Skip> = SKIPS.iter().filter(undone).collect();
    let mut with = Vec::new();
    let mut without = vec![Vec::new(); undone.len()];
    for _ in 0..plan.repeats {
        let (base, others) = repeat(started, &undone)?;
        with.push(base);
        for (times, ms) in without.iter_mut().zip(others) {
            times.push(ms);
        }
    }
    let mut measured = without.into_iter();
    let row = |skip: &Skip| {
        let nothing_to_skip = nothing_to_skip(skip, &started.simulation);
        let known = nothing_to_skip.is_none();
        let without = if known { measured.next() } else { None };
        Row {
            scenario: started.name,
            profile: started.profile.clone(),
            skip: skip.name,
            with_skip_ms: Range::of(&with),
            without_skip_ms: without.as_deref().map(Range::of),
            ratio: without.map(|without| Range::of_ratios(&without, &with)),
            nothing_to_skip,
        }
    };
    Ok(SKIPS.iter().map(row).collect())
}

/// Milliseconds per frame as shipped, and with each skip undone. All of them take turns of a few frames.
fn repeat(started: &Started, undone: &[&Skip]) -> Result<(f64, Vec<f64>), BenchError> {
    let mut base = Course::new(&started.simulation, &NOTHING, None)?;
    let mut others = Vec::new();
    for skip in undone {
        others.push(match &skip.undone {
            Undone::Needs(more) => Course::new(&started.simulation, more, None)?,
            Undone::Work { begin, .. } => {
                Course::new(&started.simulation, &NOTHING, Some(begin()))?
            }
        });
    }
    let mut left = started.frames;
    while left > 0 {
        let some = left.min(TURN);
        left -= some;
        base.advance(some)?;
        for course in &mut others {
            course.advance(some)?;
        }
    }
    let times = base.times();
    let total = times.total_ms_per_frame();
    let without = |(skip, course): (&&Skip, &Course)| match &skip.undone {
        Undone::Needs(_) => course.times().total_ms_per_frame(),
        Undone::Work { instead_of, .. } => {
            let saved: f64 = instead_of.iter().map(|&stage| ms_of(times, stage)).sum();
            total - saved + course.work_ms_per_frame()
        }
    };
    Ok((total, undone.iter().zip(&others).map(without).collect()))
}

fn table(rows: &[Row]) -> Table {
    let head = [
        "scenario",
        "profile",
        "skip",
        "ms/frame with",
        "without",
        "ratio min",
        "median",
        "max",
    ];
    let mut table = Table::new(3, &head);
    for row in rows {
        let mut cells = vec![
            row.scenario.to_owned(),
            row.profile.clone(),
            row.skip.to_owned(),
            format!("{:.4}", row.with_skip_ms.median),
        ];
        match (row.without_skip_ms, row.ratio) {
            (Some(without), Some(ratio)) => {
                cells.push(format!("{:.4}", without.median));
                cells.extend(three(&ratio, 2));
            }
            _ => cells.extend(["–", "–", "–", "–"].map(str::to_owned)),
        }
        table.rows.push(cells);
    }
    table
}

mod picture {
    use super::{Row, SKIPS};
    use crate::lab::bench::pictures::{self, bar, color, key};
    use crate::output::plot::{Axis, BLACK, GRAY, Mark, Sheet, Style};

    /// A group of bars for each scene: frame time without each skip over frame time with it.
    pub fn sheet(rows: &[Row]) -> Sheet {
        let scenes: Vec<&[Row]> = rows
            .chunk_by(|a, b| (a.scenario, &a.profile) == (b.scenario, &b.profile))
            .collect();
        let width = 0.9 / SKIPS.len() as f64;
        let ratio = |row: &Row| row.ratio.map(|ratio| ratio.median);
        let most = rows.iter().filter_map(ratio).fold(2.0, f64::max);
        let mut marks = Vec::new();
        for (s, scene) in scenes.iter().enumerate() {
            for (k, row) in scene.iter().enumerate() {
                let left = s as f64 + 0.05 + width * k as f64;
                let Some(ratio) = ratio(row) else {
                    let below = [left + 0.5 * width, 1.0 - 0.03 * most];
                    marks.push(Mark::Text(below, "–".to_owned(), GRAY));
                    continue;
                };
                let ends = [ratio.min(1.0), ratio.max(1.0)];
                marks.push(bar([left, left + 0.9 * width], ends, skip_color(k)));
            }
        }
        let one = vec![[0.0, 1.0], [scenes.len() as f64, 1.0]];
        marks.push(Mark::Line(one, Style::full(BLACK, 0.6, "")));
        let skips = SKIPS.iter().enumerate();
        marks.extend(skips.map(|(k, skip)| key(skip_color(k), skip.name)));
        let names = scenes
            .iter()
            .map(|scene| format!("{} ({})", scene[0].scenario, scene[0].profile));
        pictures::sheet(
            "What each skip saves".to_owned(),
            Axis::names("", names),
            Axis::linear("time without the skip over time with it", [0.0, 1.1 * most]),
            marks,
        )
    }

    fn skip_color(k: usize) -> crate::output::colors::Rgb {
        if k < 7 { color(k) } else { BLACK }
    }
}
