//! What `oscillation` says of people with legs, against a recomputation from the trajectories, written from
//! docs/reference/measurements.md alone: sums over a fine grid of frequencies in place of a fast transform.

use std::f64::consts::{E, TAU};

use crate::common::program::run_json;

const FROM_SECS: f64 = 20.0;
const UNTIL_SECS: f64 = 80.0;
const EVERY_SECS: f64 = 0.4;
/// Columns and rows of boxes of 2 m.
const BOXES: [usize; 2] = [4, 2];
/// Points per resolution.
const FINE: f64 = 16.0;

type Velocity = [f64; 2];

/// The mean velocities of each box at all times.
fn boxes(path: &str) -> Vec<Vec<Velocity>> {
    let [columns, rows] = BOXES;
    let samples = ((UNTIL_SECS - FROM_SECS) / EVERY_SECS).round() as usize + 1;
    let mut sums = vec![vec![(0.0, [0.0; 2]); samples]; columns * rows];
    let mut reader = csv::Reader::from_path(path).unwrap();
    let heads = reader.headers().unwrap().clone();
    let column = |name: &str| heads.iter().position(|head| head == name).unwrap();
    let wanted = ["time", "pos_x", "pos_y", "vel_x", "vel_y"].map(column);
    for record in reader.records() {
        let record = record.unwrap();
        let [time, x, y, u, v] = wanted.map(|k| record[k].parse::<f64>().unwrap());
        let sample = (time - FROM_SECS) / EVERY_SECS;
        if sample < -1e-6 || (sample - sample.round()).abs() > 1e-6 {
            continue;
        }
        let place =
            ((y / 2.0) as usize).min(rows - 1) * columns + ((x / 2.0) as usize).min(columns - 1);
        let (count, sum) = &mut sums[place][sample.round() as usize];
        *count += 1.0;
        *sum = [sum[0] + u, sum[1] + v];
    }
    let means = |sums: Vec<(f64, Velocity)>| -> Vec<Velocity> {
        let means = sums
            .into_iter()
            .map(|(count, sum)| sum.map(|of| of / count));
        let means: Vec<Velocity> = means.collect();
        let mean = [0, 1].map(|k| means.iter().map(|v| v[k]).sum::<f64>() / means.len() as f64);
        means
            .iter()
            .map(|v| [v[0] - mean[0], v[1] - mean[1]])
            .collect()
    };
    sums.into_iter().map(means).collect()
}

/// The powers of counterclockwise and clockwise motion at a frequency, with a Hann window.
fn powers(series: &[Velocity], frequency: f64) -> [f64; 2] {
    [1.0, -1.0].map(|sense| {
        let mut sum = [0.0; 2];
        for (n, v) in series.iter().enumerate() {
            let window = (TAU / 2.0 * (n as f64 + 0.5) / series.len() as f64)
                .sin()
                .powi(2);
            let (sin, cos) = (-sense * frequency * EVERY_SECS * n as f64).sin_cos();
            sum[0] += window * (v[0] * cos - v[1] * sin);
            sum[1] += window * (v[0] * sin + v[1] * cos);
        }
        sum[0].powi(2) + sum[1].powi(2)
    })
}

/// The distances at which the correlation of boxes falls below 1/e, along rows and along columns.
fn correlated(boxes: &[Vec<Velocity>]) -> [f64; 2] {
    let [columns, rows] = BOXES;
    let product = |a: usize, b: usize| -> f64 {
        let pairs = boxes[a].iter().zip(&boxes[b]);
        pairs.map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum()
    };
    let power = (0..boxes.len()).map(|k| product(k, k)).sum::<f64>() / boxes.len() as f64;
    let along = |x: usize, y: usize| -> f64 {
        let longest = if x > 0 { columns } else { rows } - 1;
        let mut before = 1.0;
        for distance in 1..=longest {
            let mut all = Vec::new();
            for row in 0..rows - y * distance {
                for column in 0..columns - x * distance {
                    let here = row * columns + column;
                    all.push(product(here, here + distance * (x + columns * y)));
                }
            }
            let now = all.iter().sum::<f64>() / all.len() as f64 / power;
            if now < 1.0 / E {
                return 2.0 * ((distance - 1) as f64 + (before - 1.0 / E) / (before - now));
            }
            before = now;
        }
        2.0 * longest as f64
    };
    [along(1, 0), along(0, 1)]
}

#[test]
fn frequency_sense_and_correlation_are_those_of_the_trajectories() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sway.csv");
    let path = path.to_str().unwrap();
    let settings = [
        "walkable_area=[[[[0,0],[8,0],[8,4],[0,4]]]]",
        "grids.0.max=[7.8,3.8]",
        "grids.0.columns=18",
        "grids.0.rows=9",
        "grids.0.goal=[4,2]",
        "measurements.0.oscillation.region=[[0,0],[8,4]]",
        "measurements.0.oscillation.from_secs=20",
        "measurements.1.unbalanced.from_secs=20",
        "measurements.2.crowd_pressure.from_secs=20",
        "duration_secs=80",
    ];
    let mut arguments = vec!["run", "scenarios/questions/sway.json", "--json"];
    arguments.extend(["--trajectory", path, "--trajectory-fps", "5"]);
    arguments.extend(settings.iter().flat_map(|setting| ["--set", setting]));
    let said = run_json(&arguments);
    let metric = |name: &str| {
        said["metrics"][format!("oscillation_{name}")]
            .as_f64()
            .unwrap()
    };

    let boxes = boxes(path);
    let samples = boxes[0].len() as f64;
    let resolution = TAU / (samples * EVERY_SECS);
    let last = (FINE * TAU / 2.0 / EVERY_SECS / resolution) as usize;
    let frequency = |k: usize| k as f64 * resolution / FINE;
    let spectra: Vec<Vec<[f64; 2]>> = boxes
        .iter()
        .map(|series| (0..=last).map(|k| powers(series, frequency(k))).collect())
        .collect();
    let total = |k: usize| -> f64 { spectra.iter().map(|of| of[k][0] + of[k][1]).sum() };
    let searched = (0..=last).filter(|&k| frequency(k) >= 2.0 * resolution);
    let peak = searched
        .max_by(|&a, &b| total(a).total_cmp(&total(b)))
        .unwrap();
    let off = (frequency(peak) - metric("peak_rad_per_s")) / resolution;
    assert!(off.abs() < 0.1, "the peak is off by {off} resolutions");

    let around = || (0..=last).filter(|k| k.abs_diff(peak) as f64 <= 2.0 * FINE);
    let share = around().map(total).sum::<f64>() / (0..=last).map(total).sum::<f64>();
    let off = share - metric("peak_share");
    assert!(off.abs() < 0.03, "the share of the power is off by {off}");

    let spins = spectra.iter().map(|of| {
        let [left, right] = [0, 1].map(|sense| around().map(|k| of[k][sense]).sum::<f64>());
        (left - right) / (left + right)
    });
    let spins: Vec<f64> = spins.collect();
    let said_of_boxes = said["data"]["oscillation"]["spins"].as_array().unwrap();
    for (k, spin) in spins.iter().enumerate() {
        let off = spin - said_of_boxes[k].as_f64().unwrap();
        assert!(off.abs() < 0.05, "box {k}: of {spin}, {off} is missing");
    }
    let rms = (spins.iter().map(|spin| spin * spin).sum::<f64>() / spins.len() as f64).sqrt();
    let off = rms - metric("spin_rms");
    assert!(rms > 0.3 && off.abs() < 0.02, "of {rms}, {off} is missing");

    let [x, y] = correlated(&boxes);
    for (length, of) in [(x, "x_"), (y, "y_"), (x.max(y), "")] {
        let off = length - metric(&format!("correlation_{of}m"));
        assert!(
            off.abs() < 1e-9,
            "the correlation length {of} is off by {off} m"
        );
    }
    assert_eq!(metric("boxes"), boxes.len() as f64);
}
