//! A small run is recorded, read back and compared with the simulation.

use std::collections::BTreeMap;

use crate::common::polygon;
use crate::common::recorded::{acceleration, options, record, scene};
use crate::common::recording::Recording;
use rerun::components::{ImageBuffer, ImageFormat, Scale3D, Translation3D};
use sandbox::analysis::evaluated::Evaluated;
use sandbox::analysis::wall_forces::Outlines;
use sandbox::engine::geometry::{Area, Polygon, Ring, Walls};
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use sandbox::output::recording::{
    DebugAgents, Marked, MeasuredRecorder, Recorder, RecordingError, RecordingOptions, arrow_length,
};

const CROWD: &str = "/world/agents";

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
        let forces = outlines.per_meter(&outlines.forces(&Evaluated::new(&simulation), 60.0));
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
