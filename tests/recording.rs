//! A small run is recorded, read back and compared with the simulation.

use std::collections::BTreeMap;

use crate::common::recording::Recording;
use crate::common::{polygon, rectangle};
use rerun::components::{ImageBuffer, ImageFormat, Scale3D, Translation3D};
use sandbox::analysis::wall_forces::Outlines;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::breakdown::Breakdown;
use sandbox::engine::geometry::{Area, Polygon, Ring, Walls};
use sandbox::engine::math::Vector;
use sandbox::engine::scene::{Group, Region, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::output::colors::ColorMap;
use sandbox::output::recording::{
    DebugAgents, Marked, MeasuredRecorder, Recorder, RecordingError, RecordingOptions,
    arrow_length, record_moment,
};
use sandbox::scenario::catalog::{self, Parameters};

const CROWD: &str = "/world/agents";

/// 49 agents close together, the first of them at a wall; some reach the goal at once.
fn scene(profile: &str) -> Scene {
    let mut scene = Scene::with_obstacles(vec![rectangle([-1.0, 8.0], [-1.0, 0.0])]);
    let group = scene.add_group(Group {
        removal_radius: Some(0.5),
        ..Group::new(
            "people",
            catalog::named(profile, &Parameters::default())
                .unwrap()
                .unwrap(),
        )
    });
    for k in 0..49 {
        let (column, row) = (f64::from(k % 7), f64::from(k / 7));
        let start = Vector::new(0.3 + 0.5 * column, 0.3 + 0.5 * row);
        let goal = Vector::new(4.0, 1.3);
        scene.agents.push(NewAgent::at(start, goal, group));
    }
    scene
}

fn options(debug: DebugAgents) -> RecordingOptions {
    RecordingOptions {
        id: "a-test".to_owned(),
        application: "test".to_owned(),
        title: "a test".to_owned(),
        description: "Small".to_owned(),
        document: "A test".to_owned(),
        view: Region {
            min: Vector::new(-1.0, -1.0),
            max: Vector::new(8.0, 5.0),
        },
        density_range: [0.0, 8.0],
        speed_range: [0.0, 1.8],
        opens_at: Some(0.1),
        begins_at: 0.0,
        ends_at: 1.0,
        debug,
        body_mass: None,
        measured: Vec::new(),
        entering: 49,
    }
}

/// The position and density of every agent in one frame of the simulation, by id.
type Truth = BTreeMap<u32, (Vector, Option<f64>)>;

/// Records `frames` frames; returns the file as read back, and the truth.
fn record(
    profile: &str,
    debug: DebugAgents,
    density: bool,
    frames: u64,
) -> (Recording, Vec<Truth>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.rrd");
    let mut simulation = Simulation::new(scene(profile)).unwrap();
    if density {
        simulation.request_density_until(u64::MAX);
    }
    let mut recorder = Recorder::create(path.as_path(), &simulation, &options(debug)).unwrap();
    let mut truth = Vec::new();
    for _ in 0..frames {
        simulation.evaluate().unwrap();
        recorder.log(&simulation, 1.0).unwrap();
        let frame = simulation.frame();
        let agents = 0..frame.agents.len();
        truth.push(
            agents
                .map(|i| {
                    let density = frame.fields.density.get(i).copied();
                    (frame.agents.id[i], (frame.agents.position[i], density))
                })
                .collect(),
        );
        simulation.integrate().unwrap();
    }
    recorder.finish().unwrap();
    (Recording::read(&path), truth)
}

#[test]
fn recorded_positions_and_densities_are_those_of_the_simulation() {
    let (recording, truth) = record("sf->sph", DebugAgents::None, true, 60);
    let positions = recording.pairs(CROWD, "Points2D:positions");
    let densities = recording.numbers(CROWD, "agent:density");
    assert_eq!(positions.len(), 60);
    assert_eq!(densities.len(), 60);
    assert!(truth[59].len() < truth[0].len(), "somebody has left");
    for (frame, agents) in truth.iter().enumerate() {
        assert_eq!(positions[frame].0, frame as i64);
        assert_eq!(positions[frame].1.len(), agents.len());
        let rows = positions[frame].1.iter().zip(&densities[frame].1);
        for ((position, density), (truth, true_density)) in rows.zip(agents.values()) {
            assert!((Vector::from(*position) - truth).norm() < 1e-5);
            let true_density = true_density.unwrap();
            assert!((density - true_density).abs() < 1e-3 * true_density);
        }
    }
}

#[test]
fn ids_and_radii_are_logged_whenever_the_crowd_changes() {
    let (recording, truth) = record("sf->sph", DebugAgents::None, true, 60);
    let mut ids = recording.numbers(CROWD, "agent:id").into_iter().peekable();
    let radii = recording.numbers(CROWD, "Points2D:radii");
    let mut known = Vec::new();
    for (frame, agents) in truth.iter().enumerate() {
        if let Some((_, row)) = ids.next_if(|(logged, _)| *logged == frame as i64) {
            known = row;
        }
        let true_ids: Vec<f64> = agents.keys().map(|&id| f64::from(id)).collect();
        assert_eq!(known, true_ids);
    }
    assert!(
        (2..30).contains(&radii.len()),
        "not in every frame: {}",
        radii.len()
    );
}

/// The acceleration whose arrow this is: the inverse of the documented law of lengths.
fn acceleration(arrow: Vector) -> Vector {
    let length = arrow.norm();
    arrow / length * 0.1 * (10_f64.powf(length / 0.6) - 1.0)
}

#[test]
fn arrows_of_small_and_of_large_forces_can_both_be_seen() {
    // The views of followed agents are 6 m wide, and agents have a radius of about 0.2 m.
    assert!(arrow_length(0.2) > 0.25);
    assert!(arrow_length(20.0) < 1.5);
    assert!(arrow_length(1000.0) < 3.0);
    assert_eq!(arrow_length(0.0), 0.0);
    for a in [0.01, 0.2, 3.0, 500.0] {
        let back = acceleration(Vector::new(arrow_length(a), 0.0)).x;
        assert!((back - a).abs() < 1e-12 * a.max(1.0));
    }
}

#[test]
fn the_force_arrows_of_every_debug_agent_sum_to_the_total() {
    for profile in ["sf->sph", "rvo+sph"] {
        let (recording, _) = record(profile, DebugAgents::All, true, 20);
        let folder = "/world/debug/forces/";
        let mut sums: BTreeMap<(i64, [u64; 2]), Vector> = BTreeMap::new();
        let mut totals = sums.clone();
        for entity in recording.entities() {
            let Some(force) = entity.strip_prefix(folder) else {
                continue;
            };
            let origins = recording.pairs(&entity, "Arrows2D:origins");
            let vectors = recording.pairs(&entity, "Arrows2D:vectors");
            let sums = if force == "total" {
                &mut totals
            } else {
                &mut sums
            };
            for ((frame, origins), (_, vectors)) in origins.iter().zip(&vectors) {
                for (origin, vector) in origins.iter().zip(vectors) {
                    let key = (*frame, origin.map(f64::to_bits));
                    let sum = sums.entry(key).or_insert_with(Vector::zeros);
                    *sum += acceleration(Vector::from(*vector));
                }
            }
        }
        assert!(totals.len() > 20 * 40);
        assert_eq!(totals.len(), sums.len());
        for (key, total) in &totals {
            let sum = sums[key];
            assert!(
                (sum - total).norm() < 1e-4 * (1.0 + total.norm()),
                "{profile} {key:?}: {sum} is not {total}"
            );
        }
    }
}

#[test]
fn a_recording_has_two_timelines_and_only_layers_that_can_have_data() {
    let (recording, _) = record("sph", DebugAgents::Ids(vec![0, 7, 9999]), true, 10);
    let timelines: Vec<String> = recording.timelines().into_iter().collect();
    assert_eq!(timelines, ["frame", "sim_time"]);
    let entities = recording.entities();
    assert!(entities.contains("/world/debug/forces/pressure_walls"));
    assert!(entities.contains("/world/debug/walls/representative_points"));
    for never in ["rvo", "social_agents", "viscosity"] {
        assert!(!entities.contains(&format!("/world/debug/forces/{never}")));
    }
    let centers = recording.pairs("/world/debug/kernels", "Ellipses2D:centers");
    assert!(centers.iter().all(|(_, circles)| circles.len() == 2));
}

#[test]
fn a_run_without_densities_is_recorded_without_them() {
    let (recording, truth) = record("sf", DebugAgents::All, false, 10);
    assert!(truth[9].values().all(|(_, density)| density.is_none()));
    assert_eq!(recording.pairs(CROWD, "Points2D:positions").len(), 10);
    assert!(recording.numbers(CROWD, "agent:density").is_empty());
    assert!(
        recording
            .numbers("/stats/density/mean", "Scalars:scalars")
            .is_empty()
    );
    let agents = recording.numbers("/stats/crowd/agents", "Scalars:scalars");
    assert_eq!(agents[0], (0, vec![49.0]));
}

#[test]
fn a_file_that_cannot_be_written_is_an_error() {
    let simulation = Simulation::new(scene("sph")).unwrap();
    let nowhere = std::path::Path::new("/no/such/folder/test.rrd");
    let result = Recorder::create(nowhere, &simulation, &options(DebugAgents::None));
    assert!(matches!(result, Err(RecordingError::Unwritten { .. })));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let mut simulation = Simulation::new(scene("sph")).unwrap();
    let full = std::path::Path::new("/dev/full");
    let result = Recorder::create(full, &simulation, &options(DebugAgents::None)).and_then(
        |mut recorder| {
            simulation.evaluate().unwrap();
            recorder.log(&simulation, 1.0)?;
            recorder.finish()
        },
    );
    assert!(result.is_err());
}

/// The classes of the plane as an image: 0 free, 1 obstacle, 2 outside; rows go up from the lowest y.
struct Raster {
    min: Vector,
    cell: f64,
    columns: usize,
    pixels: Vec<u8>,
}

impl Raster {
    /// The image that is recorded for these obstacles.
    fn of(obstacle: &Polygon) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("test.rrd");
        let (walls, options) = (
            Walls::new(vec![obstacle.clone()]),
            options(DebugAgents::None),
        );
        let marked = Marked::default();
        let recorder = MeasuredRecorder::create(path.as_path(), (&walls, marked), 0.2, &options);
        recorder.unwrap().finish().unwrap();
        let recording = Recording::read(&path);
        let entity = "world/geometry/obstacles";
        let place: Translation3D = recording.of_static(entity, "Transform3D:translation");
        let scale: Scale3D = recording.of_static(entity, "Transform3D:scale");
        let format: ImageFormat = recording.of_static(entity, "SegmentationImage:format");
        let pixels: ImageBuffer = recording.of_static(entity, "SegmentationImage:buffer");
        Self {
            min: Vector::new(f64::from(place.x()), f64::from(place.y())),
            cell: f64::from(scale.x()),
            columns: format.width as usize,
            pixels: pixels.to_vec(),
        }
    }

    fn filled(&self) -> f64 {
        let filled = self.pixels.iter().filter(|&&pixel| pixel > 0).count();
        filled as f64 * self.cell.powi(2)
    }
}

#[test]
fn the_picture_of_an_obstacle_covers_its_area() {
    let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 1.0], [0.0, 3.0]];
    let raster = Raster::of(&polygon(&corners));
    assert!((raster.filled() - 8.0).abs() < 0.1);
    assert_eq!(raster.pixels[0], 1, "the lower left corner is an obstacle");
    let above_the_notch = raster.pixels.len() - raster.columns / 2;
    assert_eq!(raster.pixels[above_the_notch], 0);
}

fn ring(corners: &[[f64; 2]]) -> Ring {
    Ring::new(corners.iter().map(|&p| Vector::from(p)).collect()).unwrap()
}

#[test]
fn the_picture_of_holes_that_touch_the_outline_and_each_other_is_what_the_engine_takes_for_solid() {
    let floor = Area {
        exterior: ring(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]),
        holes: vec![
            ring(&[[10.0, 10.0], [5.0, 8.0], [5.0, 5.0], [8.0, 5.0]]),
            ring(&[[5.0, 5.0], [2.0, 4.0], [4.0, 2.0]]),
            ring(&[[0.0, 6.0], [1.0, 7.0], [0.0, 8.0]]),
        ],
    };
    let walls = Polygon::enclosing(vec![floor]).unwrap();
    let raster = Raster::of(&walls);
    for (k, &pixel) in raster.pixels.iter().enumerate() {
        let place = Vector::new((k % raster.columns) as f64, (k / raster.columns) as f64);
        let p = raster.min + (place + Vector::repeat(0.5)) * raster.cell;
        let nearest = walls.edges().map(|(a, b)| {
            let along = (b - a).dot(&(p - a)) / (b - a).norm_squared();
            (a + (b - a) * along.clamp(0.0, 1.0) - p).norm()
        });
        if nearest.fold(f64::INFINITY, f64::min) > 1e-6 {
            assert_eq!(pixel > 0, walls.contains(p), "{p}");
        }
    }
}

#[test]
fn the_picture_of_an_enclosure_leaves_the_floor_free_and_has_a_margin() {
    let square = |low: f64, high: f64| ring(&[[low, low], [high, low], [high, high], [low, high]]);
    let floor = Area {
        exterior: square(0.0, 10.0),
        holes: vec![square(4.0, 6.0)],
    };
    let raster = Raster::of(&Polygon::enclosing(vec![floor]).unwrap());
    assert!((raster.filled() - (144.0 - 96.0)).abs() < 0.5);
    assert_eq!((raster.pixels[0], raster.pixels.last()), (2, Some(&2)));
    let pillar = raster.pixels.iter().filter(|&&pixel| pixel == 1).count();
    assert!((pillar as f64 * raster.cell.powi(2) - 4.0).abs() < 0.5);
}

#[test]
fn walls_are_colored_by_the_force_on_them_where_it_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walls.rrd");
    let mut simulation = Simulation::new(scene("sph")).unwrap();
    let options = RecordingOptions {
        body_mass: Some(60.0),
        ..options(DebugAgents::None)
    };
    let mut recorder = Recorder::create(path.as_path(), &simulation, &options).unwrap();
    let mut expected = Vec::new();
    for _ in 0..40 {
        simulation.evaluate().unwrap();
        recorder.log(&simulation, 1.0).unwrap();
        let outlines = Outlines::new(simulation.frame().walls);
        let forces = outlines.per_meter(&outlines.forces(&simulation, 60.0));
        let pressed = forces.iter().filter(|&&force| force > 0.0).count();
        expected.push((forces.into_iter().fold(0.0, f64::max), pressed));
        simulation.integrate().unwrap();
    }
    recorder.finish().unwrap();
    let recording = Recording::read(&path);
    let largest = recording.numbers("/stats/wall_forces", "Scalars:scalars");
    let colors = recording.numbers("/world/wall_forces", "LineStrips2D:colors");
    assert_eq!((largest.len(), colors.len()), (40, 40));
    for (frame, (force, pressed)) in expected.into_iter().enumerate() {
        assert!((largest[frame].1[0] - force).abs() <= 1e-6 * force);
        assert_eq!(colors[frame].1.len(), pressed);
    }
    assert!(largest.iter().any(|(_, force)| force[0] > 100.0));
    let (plain, _) = record("sph", DebugAgents::None, true, 2);
    assert!(!plain.entities().contains("/world/wall_forces"));
}

/// Records frames of a dense crowd with these options; the file as read back, and the simulation in its last frame.
fn recorded(options: &RecordingOptions, frames: u64) -> (Recording, Simulation) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.rrd");
    let mut simulation = Simulation::new(scene("sph")).unwrap();
    simulation.request_density_until(u64::MAX);
    let mut recorder = Recorder::create(path.as_path(), &simulation, options).unwrap();
    for frame in 0..frames {
        simulation.evaluate().unwrap();
        recorder.log(&simulation, 1.0).unwrap();
        if frame + 1 < frames {
            simulation.integrate().unwrap();
        }
    }
    recorder.note(simulation.frame().clock, "The end.").unwrap();
    recorder.finish().unwrap();
    (Recording::read(&path), simulation)
}

/// The values of a time series.
fn series(recording: &Recording, entity: &str) -> Vec<f64> {
    let rows = recording.numbers(entity, "Scalars:scalars").into_iter();
    rows.flat_map(|(_, values)| values).collect()
}

#[test]
fn a_followed_agent_is_in_the_middle_of_its_view_with_the_names_of_its_forces() {
    let (recording, truth) = record("sph", DebugAgents::Ids(vec![7, 24, 9999]), true, 30);
    for id in [7, 24] {
        let entity = format!("/focus/{id}");
        let places = recording.coordinates(&entity, "Transform3D:translation");
        assert_eq!(places.len(), 30);
        for ((_, place), agents) in places.iter().zip(&truth) {
            let position = agents[&id].0;
            // A view has y down.
            let place = Vector::new(place[0], -place[1]);
            assert!((place - position).norm() < 1e-5);
        }
    }
    assert!(
        recording
            .coordinates("/focus/9999", "Transform3D:translation")
            .is_empty()
    );
    let forces = "/focus/24/here/forces";
    let names = recording.static_texts(forces, "SeriesLines:names");
    assert_eq!(names[0], "total");
    assert!(names.contains(&"pressure agents".to_owned()), "{names:?}");
    let values = recording.numbers(forces, "Scalars:scalars");
    let arrows = recording.pairs(forces, "Arrows2D:vectors");
    let labels = recording.texts(forces, "Points2D:labels");
    assert_eq!((values.len(), arrows.len(), labels.len()), (30, 30, 30));
    for ((values, arrows), labels) in values.iter().zip(&arrows).zip(&labels) {
        assert_eq!(values.1.len(), names.len(), "a line for each term");
        let known: Vec<f64> = values
            .1
            .iter()
            .copied()
            .filter(|&value| value > 0.0)
            .collect();
        let drawn: Vec<Vector> = arrows
            .1
            .iter()
            .map(|&arrow| acceleration(arrow.into()))
            .collect();
        assert_eq!(known.len(), drawn.len());
        for (value, arrow) in known.iter().zip(&drawn) {
            assert!((value - arrow.norm()).abs() < 1e-4 * (1.0 + value));
        }
        let sum: Vector = drawn[1..].iter().sum();
        assert!((sum - drawn[0]).norm() < 1e-3 * (1.0 + sum.norm()));
        assert!(labels.1.len() <= drawn.len() && labels.1.iter().all(|name| names.contains(name)));
    }
}

#[test]
fn a_recording_opens_at_the_moment_of_the_highest_density_unless_a_time_is_given() {
    let asked = options(DebugAgents::Ids(vec![9999, 24, 3]));
    let found = RecordingOptions {
        opens_at: None,
        ..asked.clone()
    };
    let first = |recording: &Recording| {
        let lines = recording.texts("/log", "TextLog:text").into_iter();
        let mut lines = lines.filter(|(_, text)| text[0] == "Look here first.");
        lines.next().unwrap().0
    };
    let (recording, _) = recorded(&found, 60);
    let densities = series(&recording, "/stats/density/max");
    let highest = densities.iter().copied().fold(0.0, f64::max);
    let frame = first(&recording);
    assert_eq!(densities[frame as usize], highest);
    assert!(frame > 10, "the crowd gathers first: {frame}");
    let text = &recording.static_texts("/info/scenario", "TextDocument:text")[0];
    let time = (frame as f64 * 0.02 * 100.0).round() / 100.0;
    assert!(text.contains(&format!("t = {time} s")), "{text}");
    let (recording, _) = recorded(&asked, 20);
    assert_eq!(first(&recording), 5, "0.1 s");
}

#[test]
fn of_many_debug_agents_the_densest_one_is_followed() {
    let everywhere = Region {
        min: Vector::repeat(-9.0),
        max: Vector::repeat(9.0),
    };
    for debug in [DebugAgents::All, DebugAgents::Region(everywhere)] {
        let found = RecordingOptions {
            opens_at: None,
            ..options(debug)
        };
        let (recording, _) = recorded(&found, 60);
        let densities = series(&recording, "/stats/density/max");
        let highest = densities.iter().copied().fold(0.0, f64::max);
        let frame = densities
            .iter()
            .position(|&density| density == highest)
            .unwrap();
        let own = recording.coordinates("/focus/densest", "Transform3D:translation");
        let own = &own[frame].1;
        let crowd = &recording.pairs(CROWD, "Points2D:positions")[frame].1;
        let is_it = |[x, y]: &[f64; 2]| (x - own[0]).abs() + (y + own[1]).abs() < 1e-5;
        let followed = crowd.iter().position(is_it).unwrap();
        let density = recording.numbers(CROWD, "agent:density")[frame].1[followed];
        assert!(density > 0.8 * highest, "{density} of {highest}");
    }
}

#[test]
fn colors_and_color_bars_follow_the_ranges_of_the_options() {
    let ranged = RecordingOptions {
        speed_range: [0.2, 0.4],
        density_range: [1.0, 3.0],
        ..options(DebugAgents::None)
    };
    let (recording, _) = recorded(&ranged, 30);
    for (values, colors, map) in [
        (
            "agent:speed",
            "agent:speed_colors",
            ColorMap::bright_inferno([0.2, 0.4]),
        ),
        (
            "agent:density",
            "Points2D:colors",
            ColorMap::viridis([1.0, 3.0]),
        ),
    ] {
        let [first, last] = map.range();
        let mut seen = [0, 0];
        let values = recording.numbers(CROWD, values).into_iter();
        let colors = recording.numbers(CROWD, colors).into_iter();
        for ((_, values), (_, colors)) in values.zip(colors) {
            assert_eq!(values.len(), colors.len());
            for (value, color) in values.into_iter().zip(colors) {
                let [r, g, b] = map.color(value as f32).map(f64::from);
                let expected = ((r * 256.0 + g) * 256.0 + b) * 256.0 + 255.0;
                // Values have three digits.
                let is_below = value < 0.99 * f64::from(first);
                if is_below || value > 1.01 * f64::from(last) {
                    seen[usize::from(is_below)] += 1;
                    assert_eq!(color, expected, "{value}");
                }
            }
        }
        assert!(seen[0] > 10, "{seen:?}");
    }
    let texts = |entity: &str| recording.static_texts(entity, "Points2D:labels");
    assert_eq!(
        texts("/world/legend/density"),
        ["1", "1.5", "2", "2.5", "3", "P/m²"]
    );
    let speeds = texts("/world/legend/speed");
    assert!(
        ["0.2", "0.3", "0.4", "m/s"]
            .iter()
            .all(|text| speeds.contains(&(*text).to_owned()))
    );
}

#[test]
fn the_log_counts_arrivals_by_tens_and_has_the_end_of_the_run() {
    let (recording, simulation) = recorded(&options(DebugAgents::None), 500);
    let arrived = simulation.outcome().arrivals.len();
    assert!(arrived >= 10, "{arrived}");
    let lines: Vec<(i64, String)> = recording
        .texts("/log", "TextLog:text")
        .into_iter()
        .map(|(frame, mut text)| (frame, text.remove(0)))
        .collect();
    let told = lines
        .iter()
        .filter(|(_, text)| text.ends_with("agents have arrived"));
    let told: Vec<_> = told.collect();
    assert_eq!(told.len(), arrived / 10);
    let evacuated = series(&recording, "/stats/crowd/evacuated");
    for (k, (frame, text)) in told.into_iter().enumerate() {
        let count = 10 * (k + 1);
        assert_eq!(*text, format!("{count} agents have arrived"));
        assert!(evacuated[*frame as usize] >= count as f64);
        assert!(evacuated[*frame as usize - 1] < count as f64);
    }
    assert!(lines.contains(&(499, "The end.".to_owned())), "{lines:?}");
}

#[test]
fn what_is_measured_is_outlined_with_its_name() {
    let line = vec![Vector::new(1.0, 0.0), Vector::new(1.0, 3.0)];
    let measured = RecordingOptions {
        measured: vec![("door".to_owned(), line)],
        ..options(DebugAgents::None)
    };
    let (recording, _) = recorded(&measured, 1);
    let names = recording.static_texts("/world/geometry/measured", "Points2D:labels");
    assert_eq!(names, ["measured: door"]);
    assert!(!recording.entities().contains("/world/geometry/sources"));
}

#[test]
fn the_recording_of_a_moment_has_a_table_for_each_agent() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("moment.rrd");
    let mut simulation = Simulation::new(scene("sph")).unwrap();
    simulation.request_density_until(u64::MAX);
    simulation.evaluate().unwrap();
    let options = options(DebugAgents::Ids(vec![24, 3]));
    record_moment(path.as_path(), &simulation, &options).unwrap();
    let recording = Recording::read(&path);
    for id in [24, 3] {
        let i = simulation.frame().agents.index_of(id).unwrap();
        let breakdown = Breakdown::of(&simulation, i).unwrap();
        let entity = format!("/info/agents/{id}");
        let table = &recording.static_texts(&entity, "TextDocument:text")[0];
        let density = format!("| density ρ, P/m² | {:.4} |", breakdown.density);
        let [x, y] = breakdown.acceleration;
        let total = format!("| **total (weighted)** | {x:.4} | {y:.4} |");
        let neighbors = format!("Neighbors within the kernel: {}", breakdown.neighbors.len());
        for words in [density, total, neighbors, "| pressure_agents |".to_owned()] {
            assert!(table.contains(&words), "{words}: {table}");
        }
    }
    let layout = Recording::layout(&path);
    for name in ["Agent 24", "Forces on agent 3", "Numbers"] {
        assert!(layout.contains(name), "{name}: {layout:?}");
    }
    assert!(!layout.contains("Mean speed"));
}
