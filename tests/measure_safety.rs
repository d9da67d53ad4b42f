//! Exposure, alarms, level of service, crowd pressure and departures in trajectories.

use crate::common::tracks::{self, tracks};
use sandbox::lab::measure::{MeasureError, Measured, Options, Report, Site, measure, pictures};
use sandbox::scenario::trajectories::Tracks;

fn options(sample_every: f64) -> Options {
    Options {
        cell: 1.0,
        sample_every,
        ..tracks::options()
    }
}

fn measured(tracks: &Tracks, sample_every: f64) -> Measured {
    let site = Site::new(Vec::new());
    let taken = measure(tracks, &site, &options(sample_every), |_| {
        Ok::<(), MeasureError>(())
    });
    taken.unwrap()
}

/// A standing block of 12 × 12 people with a spacing of 0.4 m, at 10 frames per second; person k is seen until frame
/// `last(k)`.
fn block(last: impl Fn(i64) -> i64) -> Tracks {
    let people = (0..144).flat_map(|k| (0..=last(k)).map(move |frame| (k, frame)));
    let rows = people.map(|(k, frame)| (k, frame, (k % 12) as f64 * 0.4, (k / 12) as f64 * 0.4));
    tracks(10.0, &rows.collect::<Vec<_>>())
}

#[test]
fn samples_count_for_the_interval_before_them_whatever_it_is() {
    let tracks = block(|_| 40);
    for (every, samples) in [(0.1, 41.0), (0.5, 9.0), (1.0, 5.0)] {
        let safety = measured(&tracks, every).safety;
        let [four, .., slow] = safety.exposure.exposed(safety.secs);
        assert!((slow.person_secs - 144.0 * (samples - 1.0) * every).abs() < 1e-9);
        let above = f64::from(safety.exposure.alarms[0].people);
        assert!(above > 50.0);
        assert!((four.person_secs - above * (samples - 1.0) * every).abs() < 1e-9);
        assert_eq!(safety.samples.len() as f64, samples);
        assert_eq!(safety.pressures.peak.unwrap().0.pressure, Some(0.0));
        let shares = safety.levels.shares().unwrap();
        assert!(
            shares
                .iter()
                .all(|of| (of.iter().sum::<f64>() - 1.0).abs() < 1e-12)
        );
    }
}

#[test]
fn people_leave_after_the_last_frame_with_them_and_those_in_the_last_frame_stay() {
    // Person k leaves after frame 10 + k.
    let all = measured(&block(|k| if k == 143 { 400 } else { 10 + k }), 1.0).departures;
    assert_eq!((all.people, all.left), (144, 143));
    assert_eq!(all.t50_secs, Some((10.0 + 71.0) / 10.0));
    // 95 % of 144 are 137 people.
    assert_eq!(all.t95_secs, Some((10.0 + 136.0) / 10.0));
    assert_eq!(all.t100_secs, None);
}

#[test]
fn the_report_names_the_thresholds_as_what_they_are() {
    let tracks = block(|_| 20);
    let options = options(1.0);
    let report = Report {
        tracks: &tracks,
        options: &options,
        measured: &measured(&tracks, 1.0),
    };
    let findings = report.findings(&Site::new(Vec::new())).unwrap();
    let text = findings.document.text();
    assert!(text.matches("not safety limits").count() >= 2, "{text}");
    let json = &findings.data;
    assert_eq!(json["safety"]["dense"][0]["exposed"]["longest_secs"], 2.0);
    assert_eq!(json["safety"]["dense"].as_array().unwrap().len(), 3);
    assert_eq!(json["safety"]["departures"]["left"], 0);
}

#[test]
fn the_threshold_of_mina_is_named_in_packed_crowds_only() {
    for (spacing, is_packed) in [(0.3, true), (0.6, false)] {
        let rows = (0..144).flat_map(|k| (0..=20).map(move |frame| (k, frame)));
        let place = |k: i64| f64::from(k as i32) * spacing;
        let rows = rows.map(|(k, frame)| (k, frame, place(k % 12), place(k / 12)));
        let tracks = tracks(10.0, &rows.collect::<Vec<_>>());
        let (options, measured) = (options(1.0), measured(&tracks, 1.0));
        let report = Report {
            tracks: &tracks,
            options: &options,
            measured: &measured,
        };
        let site = Site::new(Vec::new());
        let text = report.findings(&site).unwrap().document.text();
        assert_eq!(text.contains("Mina"), is_packed, "{text}");
        let says = "nobody was above 6 P/m²: thresholds of the literature are for packed crowds";
        assert_eq!(text.contains(says), !is_packed, "{text}");
        let sheets: Vec<_> = pictures::sheets(&measured, &site).collect();
        let labels = sheets.iter().flat_map(|(_, sheet)| &sheet.panels);
        let labels = labels.flat_map(|panel| format!("{:?}", panel.marks).into_bytes());
        let labels = String::from_utf8(labels.collect()).unwrap();
        assert_eq!(labels.contains("Mina"), is_packed);
    }
}

#[test]
fn an_alarm_ends_when_nobody_is_there() {
    let frames = (0..=10).chain(31..=40);
    let people = frames.flat_map(|frame| (0..144).map(move |k| (k, frame)));
    let rows = people.map(|(k, frame)| (k, frame, (k % 12) as f64 * 0.4, (k / 12) as f64 * 0.4));
    let tracks = tracks(10.0, &rows.collect::<Vec<_>>());
    let safety = measured(&tracks, 1.0).safety;
    // Samples at 0 s and 1 s, then at 4 s.
    assert_eq!(safety.samples.len(), 3);
    assert_eq!(safety.exposure.alarms[0].spell.longest(), 1.0);
}
