//! Reads any bytes as trajectories and measures them, for tests and for fuzzing.

use std::path::Path;

use sandbox::analysis::crossing::{Line, Passages};
use sandbox::engine::boundary::WallMethod;
use sandbox::engine::math::Vector;
use sandbox::lab::measure::{
    Behind, CellLimit, Kernel, MeasureError, Options, Site, measure, speed,
};
use sandbox::scenario::trajectories::{FRAME_RATES, ReadError, ReadOptions, Tracks, read_text};

/// Trajectories with more rows than this are not measured.
const MAX_ROWS: usize = 60;
/// The largest number of field cells along each side.
const MAX_CELLS: f64 = 10.0;

/// Reads the contents of a text file called `name`; returns the number of rows.
pub fn read(name: &str, bytes: &[u8]) -> u64 {
    let options = ReadOptions::default();
    judge(name, read_text(Path::new(name), bytes, &options))
}

/// Checks that all numbers in the trajectories and their measurements are finite, or that the error is short, names
/// the file and has no control characters. Returns the number of rows.
pub fn judge(name: &str, read: Result<Tracks, ReadError>) -> u64 {
    match read {
        Err(error) => {
            let said = error.to_string();
            assert!(said.starts_with(name), "{said}");
            assert!(
                said.len() < 1000 && !said.contains(char::is_control),
                "{said:?}"
            );
            0
        }
        Ok(tracks) => {
            check(&tracks);
            if tracks.len() <= MAX_ROWS {
                check_measured(&tracks);
            }
            tracks.len() as u64
        }
    }
}

fn is_finite(v: Vector) -> bool {
    v.x.is_finite() && v.y.is_finite()
}

fn check(tracks: &Tracks) {
    assert!(FRAME_RATES.contains(&tracks.fps) && tracks.step > 0 && !tracks.is_empty());
    assert!(tracks.position.iter().copied().all(is_finite));
    assert!(
        tracks
            .mass
            .iter()
            .all(|&mass| mass.is_finite() && mass >= 0.0)
    );
    assert!(tracks.frames.is_sorted() && tracks.ids.is_sorted());
    assert!(tracks.span() >= tracks.frames.len() as u64);
    assert!(
        tracks
            .frames
            .iter()
            .all(|&frame| tracks.time(frame).is_finite())
    );
    let rows = (0..tracks.frames.len()).map(|k| tracks.rows(k).len());
    assert_eq!(rows.sum::<usize>(), tracks.len());
    for note in &tracks.notes {
        assert!(!note.contains("inf") && !note.contains("NaN"), "{note}");
    }
}

fn check_measured(tracks: &Tracks) {
    let first = [tracks.position[0]; 2];
    let positions = tracks.position.iter();
    let [low, high] = positions.fold(first, |[low, high], p| [low.inf(p), high.sup(p)]);
    let line = Line {
        start: low,
        end: high + Vector::new(0.5, 1.0),
    };
    let options = Options {
        sample_every: 1.0,
        kernel: Kernel {
            support_radius: 1.0,
            walls: WallMethod::Union,
        },
        behind: Behind::Rest(5.0),
        speed_reach: speed::FRAMES,
        times: [f64::NEG_INFINITY, f64::INFINITY],
        cell: ((high - low).amax() / MAX_CELLS).max(1.0),
        cells: CellLimit::default(),
        regions: Vec::new(),
        lines: vec![line],
        flow_of: Passages::Parts([0.1, 0.9]),
    };
    let measured = measure(tracks, &Site::new(Vec::new()), &options, |moments| {
        for person in moments.iter().flat_map(|moment| &moment.people) {
            assert!(person.density.is_finite() && person.velocity.is_none_or(is_finite));
            assert!(person.voronoi.is_some_and(f64::is_finite));
        }
        Ok::<(), MeasureError>(())
    })
    .unwrap();
    assert_eq!(measured.overview.rows, tracks.together().len() as u64);
    for spread in [measured.overview.density, measured.overview.speed] {
        assert!(spread.mean.is_finite() && spread.population_std().is_finite());
    }
    let fields = measured.fields.means(measured.overview.frames);
    assert!(fields.flatten().all(|mean| mean.density.is_finite()));
}
