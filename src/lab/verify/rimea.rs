//! The cases of RiMEA 4.1.1 that a flat plan allows.

use super::speeds::{DENSITIES, ages, fundamental_diagram, single_file};
use crate::lab::error::LabError;
use crate::lab::suite::{Case, Check, NOTHING_SLOWS, Runs};

/// The reason why people in single file are too slow or too fast with RVO.
pub const RVO_SINGLE_FILE: &str = "in a curved corridor of 0.8 m every velocity leads into a wall within seconds, and \
                                   the penalty for the time to collision slows even four people far apart to 0.4 m/s; \
                                   the more people, the less they avoid and the more they are an SPH fluid, which \
                                   nothing slows";

/// The reason why people jam before a second opening.
const PUSHED_THROUGH: &str = "the pressure of the crowd pushes 10 to 15 % more people per second through the first \
     opening than walk through the second, and the rest gather before it";

/// All cases, by number.
pub const CASES: [Case; 17] = [
    Case {
        id: "1",
        about: "one person of 1.33 m/s walks 40 m along a corridor",
        runs: &["speed"],
        judge: |runs| {
            Ok(vec![Check::between(
                "time [s]",
                runs.last("speed")?,
                26.0,
                34.0,
            )])
        },
        misses: &[],
        picture: ("speed", 10.0),
    },
    Case {
        id: "2",
        about: "10 m of stairs up, as a zone: 1.04 m/s × 0.5",
        runs: &["stairs up"],
        judge: |runs| {
            Ok(vec![Check::between(
                "time [s]",
                inside(runs, "stairs up")?,
                18.8,
                19.6,
            )])
        },
        misses: &[],
        picture: ("stairs up", 10.0),
    },
    Case {
        id: "3",
        about: "10 m of stairs down, as a zone: 1.04 m/s × 0.75",
        runs: &["stairs down"],
        judge: |runs| {
            Ok(vec![Check::between(
                "time [s]",
                inside(runs, "stairs down")?,
                12.6,
                13.1,
            )])
        },
        misses: &[],
        picture: ("stairs down", 10.0),
    },
    Case {
        id: "4",
        about: "fundamental diagram: a corridor of 200 m × 4 m at 0.5 to 6 P/m², 1.2 m/s",
        runs: &DENSITIES,
        judge: fundamental_diagram,
        misses: &[
            ("sph", NOTHING_SLOWS),
            ("sf->sph", NOTHING_SLOWS),
            ("rvo->sph", NOTHING_SLOWS),
        ],
        picture: ("density 4", 20.0),
    },
    Case {
        id: "5",
        about: "ten people in a row, none in the way of another, start after 10 to 100 s",
        runs: &["premovement"],
        judge: |runs| {
            let finished = runs.metric("premovement", "finished")?;
            let walks = runs.walks("premovement")?;
            let off = walks
                .iter()
                .map(|walk| Some((walk.started_secs? - walk.due_secs).abs()));
            let off: Option<Vec<f64>> = off.collect();
            let largest = off.map(|off| off.into_iter().fold(0.0, f64::max));
            Ok(vec![
                Check::at_most("largest deviation of a start [s]", largest, 0.5),
                Check::exactly("people out", finished, 10.0),
            ])
        },
        misses: &[],
        picture: ("premovement", 50.0),
    },
    Case {
        id: "6",
        about: "20 people walk around a corner of a corridor 2 m wide",
        runs: &["corner"],
        judge: |runs| {
            Ok(vec![Check::exactly(
                "people out",
                runs.metric("corner", "finished")?,
                20.0,
            )])
        },
        misses: &[],
        picture: ("corner", 7.0),
    },
    Case {
        id: "7",
        about: "speeds of 50 people by age",
        runs: &["ages"],
        judge: ages,
        misses: &[],
        picture: ("ages", 15.0),
    },
    Case {
        id: "9",
        about: "1,000 people leave a room of 30 m × 20 m by four doors of 1 m, or by two",
        runs: &["four doors", "two doors"],
        judge: |runs| {
            let ratio = runs.ratio("t100_secs", "two doors", "four doors")?;
            Ok(vec![
                Check::reported("time with four doors [s]", runs.last("four doors")?),
                Check::reported("time with two doors [s]", runs.last("two doors")?),
                Check::between("ratio", ratio, 1.5, 2.5),
            ])
        },
        misses: &[],
        picture: ("four doors", 10.0),
    },
    Case {
        id: "10",
        about: "23 people in twelve rooms on a corridor leave by the exits allotted to them",
        runs: &["rooms"],
        judge: |runs| {
            let finished = |journey: &str| -> Result<Option<f64>, LabError> {
                let journeys = &runs.of("rooms")?.journeys;
                let own = journeys.iter().find(|own| own.name == journey);
                Ok(own.map(|own| f64::from(own.left.finished)))
            };
            Ok(vec![
                Check::exactly(
                    "of 16, out by the main exit",
                    runs.passed("rooms", "main exit")?,
                    16.0,
                ),
                Check::exactly("those allotted to it, out", finished("main")?, 16.0),
                Check::exactly(
                    "of 7, out by the other",
                    runs.passed("rooms", "secondary exit")?,
                    7.0,
                ),
            ])
        },
        misses: &[],
        picture: ("rooms", 3.0),
    },
    Case {
        id: "11",
        about: "1,000 people in one part of a room choose between a near and a far door of 1 m (`quickest`)",
        runs: &["exit choice"],
        judge: |runs| {
            let [near, far] = ["near", "far"].map(|door| runs.passed("exit choice", door));
            let (near, far) = (near?, far?);
            let more = near.zip(far).map(|(near, far)| near - far);
            Ok(vec![
                Check::at_least("more by the near door than by the far one", more, 1.0),
                Check::at_least("out by the far door", far, 1.0),
                Check::exactly(
                    "people out",
                    runs.metric("exit choice", "finished")?,
                    1000.0,
                ),
            ])
        },
        misses: &[],
        picture: ("exit choice", 20.0),
    },
    Case {
        id: "12a",
        about: "150 people pass an opening of 1 m: 10 m or 2 m to the goal behind it",
        runs: &["opening", "opening, near goal"],
        judge: |runs| {
            let [far, near] = ["opening", "opening, near goal"].map(|run| runs.flow(run, "end"));
            let (far, near) = (far?, near?);
            let ratio = near.zip(far).map(|(near, far)| near / far);
            Ok(vec![
                Check::reported("flow, far goal [P/s]", far),
                Check::reported("flow, near goal [P/s]", near),
                Check::between("ratio", ratio, 0.85, 1.15),
            ])
        },
        misses: &[],
        picture: ("opening, near goal", 10.0),
    },
    Case {
        id: "12b",
        about: "the opening is 0.2 m or 5 m long",
        runs: &["opening", "opening 5 m long"],
        judge: |runs| {
            let ratio = runs.ratio("t100_secs", "opening 5 m long", "opening")?;
            Ok(vec![
                Check::reported("time, 0.2 m [s]", runs.last("opening")?),
                Check::reported("time, 5 m [s]", runs.last("opening 5 m long")?),
                Check::at_least("ratio", ratio, 1.0),
            ])
        },
        misses: &[],
        picture: ("opening 5 m long", 10.0),
    },
    Case {
        id: "12c",
        about: "a second opening of the same width: no jam forms there",
        runs: &["two openings"],
        judge: |runs| {
            let density = |at: &str| runs.metric("two openings", &format!("{at}_density_per_m2"));
            let (first, second) = (density("before")?, density("behind")?);
            let ratio = second.zip(first).map(|(second, first)| second / first);
            Ok(vec![
                Check::reported("density before the first [P/m²]", first),
                Check::reported("density before the second [P/m²]", second),
                Check::at_most("ratio", ratio, 0.5),
            ])
        },
        misses: &[
            ("sph", PUSHED_THROUGH),
            ("sf->sph", PUSHED_THROUGH),
            ("rvo->sph", PUSHED_THROUGH),
        ],
        picture: ("two openings", 15.0),
    },
    Case {
        id: "12d",
        about: "an opening of 0.8, 1 and 1.2 m",
        runs: &["opening 0.8 m", "opening", "opening 1.2 m"],
        judge: |runs| {
            let [narrow, middle, wide] =
                ["opening 0.8 m", "opening", "opening 1.2 m"].map(|run| runs.flow(run, "end"));
            let (narrow, middle, wide) = (narrow?, middle?, wide?);
            let over = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| a / b);
            Ok(vec![
                Check::reported("flow, 0.8 m [P/s]", narrow),
                Check::at_least("1 m, over 0.8 m", over(middle, narrow), 1.0),
                Check::at_least("1.2 m, over 1 m", over(wide, middle), 1.0),
            ])
        },
        misses: &[],
        picture: ("opening 0.8 m", 15.0),
    },
    Case {
        id: "14",
        about: "a short way by a door of 0.8 m, a long one by a door of 3 m; 100 people",
        runs: &["detour, shortest way", "detour, quickest way"],
        judge: |runs| {
            let by_wide_door = |run: &str| runs.metric(run, "wide_agents");
            Ok(vec![
                Check::reported(
                    "by the long way: shortest way",
                    by_wide_door("detour, shortest way")?,
                ),
                Check::reported(
                    "by the long way: `quickest` door",
                    by_wide_door("detour, quickest way")?,
                ),
                Check::reported("time, shortest way [s]", runs.last("detour, shortest way")?),
                Check::reported(
                    "time, `quickest` door [s]",
                    runs.last("detour, quickest way")?,
                ),
            ])
        },
        misses: &[],
        picture: ("detour, quickest way", 8.0),
    },
    Case {
        id: "15",
        about: "500 people, a corridor 20 m wide with a corner, of 50 m on the inside and 81.4 m on the outside",
        runs: &["straight 50 m", "wide corner", "straight 81.4 m"],
        judge: |runs| {
            let [short, corner, long] =
                ["straight 50 m", "wide corner", "straight 81.4 m"].map(|run| runs.last(run));
            let (short, corner, long) = (short?, corner?, long?);
            let part = short
                .zip(long)
                .zip(corner)
                .map(|((short, long), corner)| (corner - short) / (long - short));
            Ok(vec![
                Check::reported("time, straight 50 m [s]", short),
                Check::reported("time, corner [s]", corner),
                Check::reported("time, straight 81.4 m [s]", long),
                Check::between("place of the corner between them", part, 0.0, 1.0),
            ])
        },
        misses: &[],
        picture: ("wide corner", 25.0),
    },
    Case {
        id: "16",
        about: "single file around an oval of 26.8 m (straights of 4 m, radius 3 m): speed within the 10 to 90 % band",
        runs: &[
            "single file 13",
            "single file 24",
            "single file 30",
            "single file 40",
        ],
        judge: single_file,
        misses: &[
            ("sph", NOTHING_SLOWS),
            ("sf->sph", NOTHING_SLOWS),
            ("rvo->sph", RVO_SINGLE_FILE),
        ],
        picture: ("single file 30", 45.0),
    },
];

/// The time that the only person spends in the measured region, seconds.
fn inside(runs: &Runs, run: &str) -> Result<Option<f64>, LabError> {
    Ok(runs.walks(run)?.first().map(|walk| walk.secs))
}
