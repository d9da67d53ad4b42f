//! Screening by elementary effects, and what slopes tell of parameters.

use sandbox::analysis::identifiability::{Knowledge, Slopes};
use sandbox::analysis::morris::Trajectories;

fn effects(function: impl Fn(&[f64]) -> f64) -> Vec<[f64; 2]> {
    let design = Trajectories::new(3, 12, 7);
    let outputs: Vec<Option<f64>> = design.points.iter().map(|x| Some(function(x))).collect();
    let effects = design.effects(&outputs);
    assert!(effects.iter().all(|effect| effect.count == 12));
    effects
        .iter()
        .map(|of| [of.mean_absolute, of.deviation])
        .collect()
}

#[test]
fn the_effects_of_a_linear_function_are_its_slopes() {
    for (effect, slope) in effects(|x| 3.0 * x[0] - 2.0 * x[1] + 1.0)
        .iter()
        .zip([3.0, 2.0, 0.0])
    {
        assert!((effect[0] - slope).abs() < 1e-12, "{effect:?}");
        assert!(effect[1] < 1e-12, "{effect:?}");
    }
}

#[test]
fn interactions_and_changes_of_sign_show_in_the_deviation() {
    let product = effects(|x| x[0] * x[1]);
    assert!(product[0][1] > 0.1 && product[1][1] > 0.1 && product[2] == [0.0; 2]);
    // Up and down again: the mean effect vanishes, that of the absolute values does not.
    let hill = effects(|x| (x[0] - 0.5).abs());
    assert!(hill[0][0] > 0.2, "{hill:?}");
}

#[test]
fn trajectories_change_one_parameter_at_a_time_by_two_thirds() {
    let design = Trajectories::new(5, 8, 1);
    assert_eq!(design.points.len(), 48);
    for trajectory in design.points.chunks(6) {
        let mut changed: Vec<usize> = Vec::new();
        for pair in trajectory.windows(2) {
            let differs = |&k: &usize| pair[0][k] != pair[1][k];
            let own: Vec<usize> = (0..5).filter(differs).collect();
            assert_eq!(own.len(), 1);
            assert!(((pair[0][own[0]] - pair[1][own[0]]).abs() - 2.0 / 3.0).abs() < 1e-12);
            changed.extend(own);
        }
        changed.sort_unstable();
        assert_eq!(changed, [0, 1, 2, 3, 4]);
    }
}

#[test]
fn steps_without_an_output_are_left_out() {
    let design = Trajectories::new(2, 1, 3);
    let effects = design.effects(&[Some(1.0), None, Some(2.0)]);
    assert!(
        effects
            .iter()
            .all(|effect| effect.count == 0 && effect.mean_absolute == 0.0)
    );
}

fn exact(slopes: &[f64]) -> Slopes {
    Slopes {
        slopes: slopes.to_vec(),
        variances: vec![0.0; slopes.len()],
    }
}

#[test]
fn steep_residuals_give_the_interval_of_least_squares() {
    // Two independent residuals with slopes 40 and 30: the variance is 1/(40² + 30²), with 12 of the prior.
    let known = Knowledge::of(1, &[exact(&[40.0]), exact(&[30.0])]);
    let expected = 1.959_963_984_540_054 / (2500.0_f64 + 12.0).sqrt();
    assert!((known.half_width(0) - expected).abs() < 1e-12);
}

#[test]
fn a_parameter_without_slopes_has_the_whole_range() {
    let known = Knowledge::of(2, &[exact(&[50.0, 0.0])]);
    assert!(known.half_width(0) < 0.05);
    assert!(known.half_width(1) > 0.5);
    assert_eq!(known.correlation(0, 1), 0.0);
    assert!(Knowledge::of(1, &[]).half_width(0) > 0.5);
}

#[test]
fn only_a_sum_is_known_if_parameters_act_alike() {
    let known = Knowledge::of(2, &[exact(&[50.0, 50.0])]);
    assert!(known.correlation(0, 1) < -0.95);
    assert!(known.half_width(0) > 0.3);
    let both = Knowledge::of(2, &[exact(&[50.0, 50.0]), exact(&[50.0, -50.0])]);
    assert!(both.correlation(0, 1).abs() < 1e-9 && both.half_width(0) < 0.05);
}

#[test]
fn slopes_within_their_noise_tell_nothing() {
    let noisy = Slopes {
        slopes: vec![5.0],
        variances: vec![25.0],
    };
    let known = Knowledge::of(1, &[noisy]);
    assert!((known.half_width(0) - Knowledge::of(1, &[]).half_width(0)).abs() < 1e-12);
}
