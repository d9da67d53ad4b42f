//! Blends (§4.4): weights, continuity, and profiles that are not evaluated.

use crate::common::{
    acceleration, blend, blend_with, breakdown, evaluated, person, scene, state, vector, walker,
};
use sandbox::engine::agents::NewAgent;
use sandbox::engine::density::SphParameters;
use sandbox::engine::math::Vector;
use sandbox::engine::profile::{Blend, BlendError, BlendStep};
use sandbox::engine::scene::Scene;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::{self, ALIASES, NAMES, Parameters};

fn sequence(steps: &[(&str, f64)]) -> Result<Blend, BlendError> {
    let steps = steps.iter().map(|&(name, at_density)| BlendStep {
        at_density,
        profile: catalog::plain(name, &Parameters::default()).unwrap(),
    });
    Blend::new("mine".to_owned(), SphParameters::default(), steps.collect())
}

fn three() -> Blend {
    sequence(&[("rvo", 1.5), ("sf+sph", 2.5), ("sph", 4.0)]).unwrap()
}

/// Agent 0 among eight others; the smaller `scale`, the closer they are.
fn huddle(blend: Blend, scale: f64) -> Scene {
    let mut scene = scene(Vec::new(), blend);
    let own = walker(Vector::zeros(), vector(0.9, 0.2), vector(30.0, 0.0));
    let others = (0..8).map(|k| {
        let angle = 0.8 * f64::from(k);
        let place = vector(angle.cos(), angle.sin()) * (0.6 + 0.05 * f64::from(k));
        walker(
            place * scale,
            vector(0.1 * f64::from(k), 0.3),
            vector(0.0, 30.0),
        )
    });
    scene.agents = std::iter::once(own)
        .chain(others)
        .map(|agent| NewAgent {
            mean_density: Some(1.0),
            ..agent
        })
        .collect();
    scene
}

fn density(simulation: &Simulation) -> f64 {
    breakdown(simulation, 0).density
}

/// The scale at which agent 0 has a given density.
fn scale_for(target: f64) -> f64 {
    let (mut dense, mut sparse) = (0.3, 5.0);
    for _ in 0..200 {
        let middle = 0.5 * (dense + sparse);
        let simulation = evaluated(huddle(blend("sph"), middle));
        if density(&simulation) > target {
            dense = middle;
        } else {
            sparse = middle;
        }
    }
    0.5 * (dense + sparse)
}

#[test]
fn weights_sum_to_one_and_shift_monotonically_to_the_denser_profile() {
    for blend in NAMES.map(blend).into_iter().chain([three()]) {
        let rank = |density: f64| -> f64 {
            let weights: Vec<(usize, f64)> = blend
                .weights(density)
                .map(|(profile, weight)| {
                    let step = blend.steps().iter().position(|s| s.profile == *profile);
                    (step.unwrap(), weight)
                })
                .collect();
            assert!(weights.len() <= 2 && weights.iter().all(|(_, weight)| *weight > 0.0));
            assert!((weights.iter().map(|(_, weight)| weight).sum::<f64>() - 1.0).abs() < 1e-15);
            weights
                .iter()
                .map(|(step, weight)| *step as f64 * weight)
                .sum()
        };
        let ranks: Vec<f64> = (0..1000).map(|k| rank(f64::from(k) * 0.01)).collect();
        assert!(ranks.windows(2).all(|pair| pair[0] <= pair[1] + 1e-15));
        assert_eq!(ranks[0], 0.0);
        assert_eq!(ranks[999], (blend.steps().len() - 1) as f64);
        for (k, step) in blend.steps().iter().enumerate().skip(1) {
            assert_eq!(
                rank(step.at_density),
                k as f64,
                "a profile acts alone at its density"
            );
        }
    }
}

#[test]
fn halfway_between_two_densities_both_profiles_have_the_same_weight() {
    let blend = three();
    let at = |density: f64| -> Vec<(String, f64)> {
        let weights = blend.weights(density);
        weights
            .map(|(profile, weight)| (profile.name.clone(), weight))
            .collect()
    };
    assert_eq!(
        at(2.0),
        [("rvo".to_owned(), 0.5), ("sf+sph".to_owned(), 0.5)]
    );
    assert_eq!(
        at(3.25),
        [("sf+sph".to_owned(), 0.5), ("sph".to_owned(), 0.5)]
    );
    assert_eq!(at(1.0), [("rvo".to_owned(), 1.0)]);
    assert_eq!(at(9.0), [("sph".to_owned(), 1.0)]);
}

#[test]
fn the_acceleration_is_continuous_at_the_profiles_densities() {
    for (blend, densities) in [
        (blend("sf->sph"), vec![2.0, 4.0]),
        (blend("rvo->sph"), vec![2.0, 4.0]),
        (three(), vec![1.5, 2.5, 4.0]),
    ] {
        for at_density in densities {
            let scale = scale_for(at_density);
            let around = |step: f64| evaluated(huddle(blend.clone(), scale + step));
            let [denser, sparser] = [-1e-9, 1e-9].map(around);
            assert!(density(&denser) > at_density && density(&sparser) < at_density);
            let jump = acceleration(&denser, 0) - acceleration(&sparser, 0);
            assert!(
                jump.norm() < 1e-4,
                "{} at {at_density}: {jump:?}",
                blend.name
            );
            let far = acceleration(&around(0.05), 0) - acceleration(&around(-0.05), 0);
            assert!(far.norm() > 1e-2, "the density matters here");
        }
    }
}

#[test]
fn a_blend_is_the_weighted_sum_of_its_profiles_accelerations() {
    for target in [1.0, 2.3, 3.1, 3.9, 5.0] {
        let scale = scale_for(target);
        let of = |name: &str| acceleration(&evaluated(huddle(blend(name), scale)), 0);
        for first in ["sf", "rvo"] {
            let kappa = ((target - 2.0) / 2.0).clamp(0.0, 1.0);
            let expected = of(first) * (1.0 - kappa) + of("sph") * kappa;
            let found = of(&format!("{first}->sph"));
            assert!(
                (found - expected).norm() < 1e-9 * (1.0 + expected.norm()),
                "{first} {target}"
            );
        }
    }
}

#[test]
fn a_profile_without_weight_is_not_evaluated() {
    for (target, names) in [
        (1.5, vec!["rvo"]),
        (3.0, vec!["rvo", "sph"]),
        (4.5, vec!["sph"]),
    ] {
        let simulation = evaluated(huddle(blend("rvo->sph"), scale_for(target)));
        let agent = breakdown(&simulation, 0);
        let found: Vec<&str> = agent.profiles.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(found, names);
        let view = simulation.frame();
        let i = view.agents.index_of(0).unwrap();
        assert_eq!(view.agents.avoidance[i].is_some(), target < 4.0);
    }
}

#[test]
fn terms_that_a_profile_lacks_are_absent() {
    let parameters = Parameters::of([("gas_constant", 0.0)]).unwrap();
    let simulation = evaluated(huddle(blend_with("sph", &parameters), 1.0));
    let terms = breakdown(&simulation, 0).profiles[0].accelerations.clone();
    let present: Vec<&str> = terms.listed().map(|(name, _)| name).collect();
    assert_eq!(present, ["goal", "contact_agents", "contact_walls"]);
}

#[test]
fn invalid_sequences_are_refused() {
    assert_eq!(sequence(&[]), Err(BlendError::Empty));
    assert_eq!(
        sequence(&[("sf", 2.0), ("sph", 2.0)]),
        Err(BlendError::NotRising(2.0, 2.0))
    );
    assert!(sequence(&[("sf", f64::NAN), ("sph", 2.0)]).is_err());
}

#[test]
fn a_blend_of_one_profile_equals_that_profile() {
    let one = sequence(&[("sf+sph", 3.0)]).unwrap();
    let single = blend("sf+sph");
    for scale in [0.5, 1.0, 2.0] {
        let [a, b] = [&one, &single].map(|b| evaluated(huddle(b.clone(), scale)));
        assert_eq!(acceleration(&a, 0), acceleration(&b, 0));
        assert_eq!(state(&a, 0), state(&b, 0));
    }
    let mut alone = scene(Vec::new(), one);
    alone.agents = vec![person(Vector::zeros(), vector(1.0, 0.0))];
    assert!(!alone.needs().rvo && alone.needs().density);
}

#[test]
fn blends_have_names_that_need_no_quotes() {
    for (alias, name) in ALIASES {
        assert_eq!(blend(alias), blend(name));
    }
}
