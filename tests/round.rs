//! Round numbers for readers.

use sandbox::analysis::round::{brief, end};

#[test]
fn texts_have_three_digits_and_differ_from_the_value_by_less_than_half_a_percent() {
    for (value, expected) in [
        (6.636, "6.64"),
        (3.9816, "3.98"),
        (1.164, "1.16"),
        (0.1 + 0.2, "0.3"),
        (0.0, "0"),
        (1_234.5, "1,235"),
        (-0.25, "\u{2212}0.25"),
        (99.99, "100"),
        (0.000_123, "1.2e\u{2212}4"),
    ] {
        assert_eq!(brief(value), expected, "{value}");
    }
    let mut value = 1e-3;
    while value < 1e9 {
        let plain = brief(value).replace(',', "");
        let digits = plain.trim_start_matches(['0', '.']).replace('.', "");
        assert!(digits.len() <= 3 || value >= 999.5, "{value}: {plain}");
        let read: f64 = plain.parse().unwrap();
        assert!((read / value - 1.0).abs() <= 0.005, "{value}: {plain}");
        value *= 1.0173;
    }
}

#[test]
fn ends_of_ranges_are_round_and_hold_the_value_with_at_most_a_third_above_it() {
    for (value, expected) in [
        (6.636, 7.0),
        (1.94, 2.0),
        (1.4, 1.4),
        (0.55, 0.6),
        (6.0, 6.0),
    ] {
        assert_eq!(end(value), expected);
    }
    let mut value = 1e-3;
    while value < 1e6 {
        let end = end(value);
        assert!(
            end >= value * (1.0 - 1e-9) && end < 1.34 * value,
            "{value}: {end}"
        );
        assert!(
            brief(end)
                .trim_start_matches(['0', '.'])
                .trim_end_matches(['0', ','])
                .len()
                <= 3
        );
        value *= 1.0173;
    }
}
