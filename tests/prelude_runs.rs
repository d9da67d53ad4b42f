//! Every item of `sandbox::prelude` for scenario files and runs in its documented role, as `prelude.rs` does it for the
//! engine.

use std::ops::ControlFlow;
use std::path::Path;

use sandbox::prelude::*;
use serde_json::json;

/// The parts of an error.
fn parts_of(error: &ScenarioError) -> (&str, &str) {
    match error {
        ScenarioError::Unreadable { file, reason } => (file, reason),
        ScenarioError::Syntax {
            file,
            line: _,
            column: _,
            reason,
        } => (file, reason),
        ScenarioError::Invalid { file, problem } => (file, &problem.reason),
        ScenarioError::Setting { setting, problem } => (setting, &problem.path),
        ScenarioError::TooLarge(reason) => ("", reason),
        ScenarioError::UnknownName { name, known } => (name, known),
    }
}

const SCENARIO: &str = r#"{
    "duration_secs": 2, "goal": [9, 0], "measurements": [{"density": {"at_secs": 1}}],
    "grids": [{"min": [0, 0], "max": [2, 2], "columns": 2, "rows": 2}]
}"#;

#[test]
fn a_scenario_is_read_from_text_with_settings() {
    let setting: Setting = "seed=7".parse().unwrap();
    assert_eq!(
        (setting.path(), setting.value()),
        (&["seed".to_owned()][..], &json!(7))
    );
    let Scenario {
        name,
        description,
        scene,
        seed,
        duration_secs,
        stop,
        measurements,
        view: _,
        labels,
        debug_agents,
        entering,
        profile_name,
        document,
        files,
        changes,
        notes: _,
        passage_width: _,
        ..
    } = Scenario::parse(SCENARIO, "four.json", &[setting]).unwrap();
    assert_eq!(
        (&name[..], &description[..], &profile_name[..]),
        ("four", "", "sph")
    );
    assert_eq!((seed, scene.seed, duration_secs), (7, 7, 2.0));
    assert_eq!(
        (scene.agents.len(), entering, debug_agents.len()),
        (4, 4, 4)
    );
    assert_eq!((measurements.len(), labels.len(), files.len()), (1, 0, 0));
    assert!(!stop.when_empty && stop.idle_secs.is_none());
    assert_eq!(
        (document["seed"].clone(), changes),
        (json!(7), vec!["seed=7".to_owned()])
    );

    let unknown = Scenario::shipped("nowhere", &[]).unwrap_err();
    assert_eq!(parts_of(&unknown).0, "nowhere");
    let missing = Scenario::load(Path::new("no/such/file.json"), &[]).unwrap_err();
    assert_eq!(parts_of(&missing).0, "no/such/file.json");
    let wrong = Scenario::parse("{\"seed\": -1}", "f.json", &[]).unwrap_err();
    assert_eq!(parts_of(&wrong).0, "f.json");
}

#[derive(Default)]
struct Counted {
    frames: usize,
    last: Option<End>,
}

impl Observer<Fault> for Counted {
    fn observe(&mut self, run: &Run, ms: f64, then: ControlFlow<End>) -> Result<(), Fault> {
        assert!(ms >= 0.0 && run.simulation.frame().clock.frame() == self.frames as u64);
        self.frames += 1;
        self.last = then.break_value();
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), Fault> {
        Ok(())
    }
}

#[test]
fn a_run_goes_to_its_end_under_observers() {
    let scenario = Scenario::parse(SCENARIO, "four.json", &[]).unwrap();
    let mut run = Run::new(scenario.clone()).unwrap();
    let mut observers = [Box::new(Counted::default())];
    let end = run.drive::<Fault, _>(&mut observers, || false).unwrap();
    let [counted] = observers;
    assert_eq!((counted.frames, counted.last), (101, Some(End::Duration)));
    counted.finish().unwrap();
    match end {
        End::Duration => assert_eq!(run.reason(), "its duration of 2 s is over"),
        End::Empty | End::Idle | End::Interrupted => panic!("{end:?}"),
    }
    let Run {
        scenario: _,
        simulation,
        metrics,
        end,
    } = &run;
    assert_eq!(*end, Some(End::Duration));
    let results = metrics.results(simulation);
    assert_eq!(results[0].name, "density_mean_1s");
    assert!(results[0].value.unwrap() > 0.0);

    let mut again = Run::new(scenario).unwrap();
    let none: &mut [Box<dyn Observer<Fault>>] = &mut [];
    assert_eq!(again.drive(none, || true).unwrap(), End::Interrupted);
}
