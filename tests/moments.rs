//! Moments of a run that commands are asked for: the frame that is meant, periods in the wrong order.

use std::fs;

use crate::common::program::{run, stderr, text};

/// One agent, which leaves after about half a second.
const ONE: &str = r#"{"goal": [1, 0], "preferred_speed": 1, "max_speed": 1, "duration_secs": 9, "profile": "sph",
    "agents": [{"position": [0, 0], "velocity": [1, 0], "remove_within": 0.49}]}"#;

#[test]
fn a_moment_whose_nearest_frame_is_empty_is_refused_with_the_last_one_that_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let [one, out] = ["one.json", "one.svg"].map(|name| folder.path().join(name));
    fs::write(&one, ONE).unwrap();
    let draw = |at: f64| {
        let at = format!("{at:.3}");
        let output = run(&["draw", text(&one), "--at", &at, "--force", "-o", text(&out)]);
        (output.status.code(), stderr(&output))
    };
    let (code, later) = draw(5.0);
    assert_eq!(code, Some(2));
    let (about, last) = later
        .split_once("no agents are left at that time: the last one leaves at ")
        .unwrap();
    assert!(about.ends_with("--at 5: "), "{later}");
    let last: f64 = last.split(' ').next().unwrap().parse().unwrap();
    // 50 frames per second: the frame in which the last agent leaves is the nearest one from 0.01 s before.
    for (before, is_empty) in [(0.0, true), (0.005, true), (0.015, false), (0.02, false)] {
        let (code, said) = draw(last - before);
        assert_eq!(code, Some(if is_empty { 2 } else { 0 }), "{before}: {said}");
        let frame = format!(
            "no agents are left in the nearest frame, that of {last:.2} s; give at most {:.2}",
            last - 0.02
        );
        assert_eq!(
            said.contains(&frame),
            is_empty && before > 0.0,
            "{before}: {said}"
        );
    }
}
