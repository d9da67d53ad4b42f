//! Numbers and values in messages.

use serde_json::Value;

/// Very large and very small numbers in scientific notation, the largest integers as powers, others in decimal
/// notation.
pub fn brief(value: f64) -> String {
    if value == f64::from(u32::MAX) {
        "2^32 - 1".to_owned()
    } else if value == u64::MAX as f64 {
        "2^64 - 1".to_owned()
    } else if value == 0.0 || (1e-4..1e6).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// A value as `--set` takes it.
pub fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => brief(number.as_f64().unwrap_or(f64::NAN)),
        other => other.to_string(),
    }
}

/// The significant digits that numbers in texts have at most; decimals beyond centimeters are cut to them.
const DIGITS: usize = 6;
/// The decimals that large numbers keep.
const DECIMALS: usize = 2;

/// A text in which numbers have at most six significant digits, or two decimals: 0.42400000000000004 is 0.424. What
/// stands in quotes, after `=` or in a longer word stays as it is.
pub fn tidy(text: &str) -> String {
    let mut tidied = String::with_capacity(text.len());
    let (mut quote, mut before) = (None, ' ');
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.'));
        let (number, after) = rest.split_at(end.unwrap_or(rest.len()));
        let is_alone = !(before.is_alphanumeric() || "_=/.".contains(before));
        let ends =
            !after.starts_with(|c: char| c.is_alphanumeric() && c != 'e' || c == '_' || c == '/');
        match shortened(number).filter(|_| quote.is_none() && is_alone && ends) {
            Some(short) => {
                tidied += &short;
                (before, rest) = ('0', after);
            }
            None => {
                quote = match (quote, c) {
                    (None, '`' | '"') => Some(c),
                    (Some(open), close) if open == close => None,
                    (open, _) => open,
                };
                tidied.push(c);
                (before, rest) = (c, &rest[c.len_utf8()..]);
            }
        }
    }
    tidied
}

/// A decimal number with fewer digits; `None` if it has few.
fn shortened(number: &str) -> Option<String> {
    let (whole, decimals) = number.split_once('.')?;
    let is_number = !whole.is_empty() && !decimals.is_empty() && !decimals.contains('.');
    let value: f64 = number.parse().ok().filter(|_| is_number)?;
    let leading = match whole.trim_start_matches('0').len() {
        // Zeros after the point do not count.
        0 => decimals.len() as i64 - decimals.trim_start_matches('0').len() as i64,
        digits => -(digits as i64),
    };
    let kept = (DIGITS as i64 + leading).max(DECIMALS as i64) as usize;
    (decimals.len() > kept).then(|| {
        let short = format!("{value:.kept$}");
        short.trim_end_matches('0').trim_end_matches('.').to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::tidy;

    #[test]
    fn numbers_of_texts_have_six_digits_and_quoted_ones_all() {
        for (given, said) in [
            ("a passage of 0.42400000000000004 m", "a passage of 0.424 m"),
            (
                "at (5268347.251234, 0.123456789)",
                "at (5268347.25, 0.123457)",
            ),
            ("-12.345678901, 3.0000000001", "-12.3457, 3"),
            ("0.000012345678 s", "0.0000123457 s"),
            ("7.3912345678e-10 s", "7.39123e-10 s"),
            (
                "`door 1.23456789` and \"0.123456789\"",
                "`door 1.23456789` and \"0.123456789\"",
            ),
            ("--set a.b=0.123456789: no", "--set a.b=0.123456789: no"),
            (
                "run_0.123456789.json, 1.2.3.4567890123",
                "run_0.123456789.json, 1.2.3.4567890123",
            ),
            ("123456.5, 1234567, 0.5", "123456.5, 1234567, 0.5"),
        ] {
            assert_eq!(tidy(given), said);
        }
    }
}
