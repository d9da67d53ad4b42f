//! Pictures of reports: everybody is drawn where the trajectories have them.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use sandbox::lab::report::Watched;
use sandbox::output::plot::{Mark, Print};
use sandbox::runs::drive::Run;
use sandbox::scenario::Scenario;

use crate::common::program::run_in;
use crate::common::room::{done, scenario};
use crate::common::{pdf, pictures};

/// The agents of each frame of the room's run, by frame: positions and densities. 50 frames per second.
fn tracks(folder: &Path) -> BTreeMap<u64, Vec<([f64; 2], f64)>> {
    let run = [
        "run",
        "room.json",
        "--force",
        "--trajectory",
        "room.csv",
        "--trajectory-fps",
        "50",
    ];
    assert_eq!(run_in(folder, &run).status.code(), Some(0));
    let mut frames: BTreeMap<u64, Vec<([f64; 2], f64)>> = BTreeMap::new();
    let mut reader = csv::Reader::from_path(folder.join("room.csv")).unwrap();
    for row in reader.deserialize() {
        let row: BTreeMap<String, String> = row.unwrap();
        let number = |name: &str| row[name].parse::<f64>().unwrap();
        let agent = ([number("pos_x"), number("pos_y")], number("density"));
        frames
            .entry(row["frame"].parse().unwrap())
            .or_default()
            .push(agent);
    }
    frames
}

fn places(agents: &[([f64; 2], f64)]) -> Vec<[f64; 2]> {
    agents.iter().map(|(place, _)| *place).collect()
}

/// The figures of a report in HTML in which agents are drawn: circles and captions.
fn crowds(folder: &Path, file: &str) -> Vec<(Vec<[f64; 2]>, String)> {
    let html = fs::read_to_string(folder.join(file)).unwrap();
    let figures = pictures::figures(&html).into_iter();
    let figures = figures.map(|(svg, caption)| (pictures::circles(&svg), caption));
    figures.filter(|(circles, _)| !circles.is_empty()).collect()
}

#[test]
fn everybody_is_drawn_where_the_trajectory_has_them() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    let frames = tracks(folder.path());
    for name in ["room.html", "room.pdf"] {
        done(
            folder.path(),
            &["report", "room.json", "--at", "2", "--out", name, "--json"],
        );
    }
    let drawn = crowds(folder.path(), "room.html");
    let captions: Vec<&str> = drawn.iter().map(|(_, caption)| caption.as_str()).collect();
    assert!(
        captions[0].starts_with("The plan: 12 agents at 0.00 s."),
        "{captions:?}"
    );
    let count = frames[&100].len();
    assert!(
        captions[1].starts_with(&format!("{count} agents at 2.00 s.")),
        "{captions:?}"
    );
    assert_eq!(drawn.len(), 2);
    let pdf = pdf::pages(&fs::read(folder.path().join("room.pdf")).unwrap());
    let pages: Vec<&pdf::Page> = pdf.iter().filter(|page| !page.circles.is_empty()).collect();
    assert_eq!(pages.len(), 2);
    for (k, frame) in [0, 100].into_iter().enumerate() {
        let expected = places(&frames[&frame]);
        pictures::assert_drawn(&drawn[k].0, &expected, &format!("HTML, frame {frame}"));
        pictures::assert_drawn(&pages[k].circles, &expected, &format!("PDF, frame {frame}"));
    }
}

#[test]
fn without_times_the_pictures_are_the_start_the_highest_density_and_half_of_the_people_out() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    let frames = tracks(folder.path());
    let report = ["report", "room.json", "--json"];
    done(folder.path(), &report);
    // Densities are observed in every fifth frame; the first of the highest counts.
    let coarse = frames.iter().filter(|(frame, _)| *frame % 5 == 0);
    let highest = coarse.map(|(&frame, agents)| {
        (
            frame,
            agents
                .iter()
                .map(|(_, density)| *density)
                .fold(0.0, f64::max),
        )
    });
    let (densest, most) = highest.fold((0, 0.0), |a: (u64, f64), b| if b.1 > a.1 { b } else { a });
    let half = frames.iter().find(|(_, agents)| agents.len() <= 6);
    let (&half, left) = half.unwrap();
    let drawn = crowds(folder.path(), "room.html");
    let caption = |frame: u64| {
        let (count, time) = (frames[&frame].len(), frame as f64 / 50.0);
        format!("{count} agents at {time:.2} s")
    };
    let mut expected = vec![
        (0, format!("The plan: {}.", caption(0))),
        (
            densest,
            format!(
                "{}, with the highest density, {most:.2} P/m².",
                caption(densest)
            ),
        ),
        (
            half,
            format!(
                "{}, when {} of 12 had left.",
                caption(half),
                12 - left.len()
            ),
        ),
    ];
    expected.sort_by_key(|(frame, _)| *frame);
    assert_eq!(drawn.len(), 3, "{drawn:?}");
    for ((circles, caption), (frame, said)) in drawn.iter().zip(&expected) {
        assert!(caption.starts_with(said.as_str()), "{caption}: {said}");
        pictures::assert_drawn(circles, &places(&frames[frame]), caption);
    }
}

#[test]
fn the_map_has_the_highest_density_of_each_cell() {
    let folder = tempfile::tempdir().unwrap();
    scenario(folder.path());
    let room = Scenario::load(&folder.path().join("room.json"), &[]).unwrap();
    let low = room.view.region.min;
    let mut watched = Watched::new(&room, &[]);
    let mut run = Run::new(room).unwrap();
    Watched::prepare(&mut run.simulation);
    let mut most: BTreeMap<[u32; 2], f64> = BTreeMap::new();
    while run.end.is_none() {
        run.simulation.evaluate().unwrap();
        watched.see(&run.simulation);
        let frame = run.simulation.frame();
        for i in frame
            .agents
            .present()
            .filter(|_| frame.clock.frame().is_multiple_of(5))
        {
            let at = (frame.agents.position[i] - low) * 2.0;
            let cell = most.entry([at.x as u32, at.y as u32]).or_default();
            *cell = cell.max(frame.fields.density[i]);
        }
        run.measure();
        run.simulation.integrate().unwrap();
    }
    let sheet = watched.peaks.sheet(&run.scenario, &Print::of_program());
    let [Mark::Group(below), ..] = &sheet.panels[0].marks[..] else {
        panic!("no floor");
    };
    let cells = below.iter().find_map(|mark| match mark {
        Mark::Overlay(cells) => Some(cells),
        _ => None,
    });
    let cells = cells.unwrap();
    let drawn = cells.values.iter().enumerate().filter_map(|(k, value)| {
        let place = [k % cells.columns, k / cells.columns].map(|k| k as u32);
        Some((place, (*value)?))
    });
    let drawn: BTreeMap<[u32; 2], f64> = drawn.collect();
    assert!(most.len() > 20 && drawn.keys().eq(most.keys()), "{drawn:?}");
    for (place, value) in &drawn {
        assert!((value - most[place]).abs() < 1e-5, "{place:?}");
    }
    let highest = run.metrics.highest_density().unwrap().density_per_m2;
    assert!((watched.peaks.highest().unwrap() - highest).abs() < 1e-5);
}
