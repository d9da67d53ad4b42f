//! Tables 1 and 2 as docs/reference/tables/reproduction.md has them: the bands follow from the spread over seeds, and
//! the verdicts from the bands.

use std::fs;

#[test]
fn bands_are_where_one_more_run_lies_with_95_percent_and_counts_are_those_of_the_rows() {
    let text = fs::read_to_string("docs/reference/tables/reproduction.md").unwrap();
    let part = |name: &str| {
        let (_, rest) = text.split_once(&format!("<!-- {name} -->")).unwrap();
        rest.split_once("<!-- /").unwrap().0.to_owned()
    };
    let cells = |line: &str| -> Vec<String> {
        let cells = line.trim_matches('|').split('|');
        cells.map(|cell| cell.trim().to_owned()).collect()
    };
    // Mean and spread of a cell: `4.40 ± 0.02`, `1.60 ± 0.25 (6 of 10)`.
    let pair = |cell: &str| {
        let mut numbers = cell
            .split_whitespace()
            .filter_map(|word| word.parse::<f64>().ok());
        [(); 2].map(|()| numbers.next().unwrap())
    };
    let number = |cell: &str| cell.parse::<f64>().unwrap();
    let rows: Vec<Vec<String>> = part("table1")
        .lines()
        .filter(|line| line.contains("ρ⁰max") || line.contains("K^ag"))
        .map(cells)
        .collect();
    assert_eq!(rows.len(), 30);
    let root_mean =
        |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let pooled = |column: usize, is_relative: bool| {
        let values = rows.iter().map(|row| {
            let [mean, spread] = pair(&row[column]);
            if is_relative { spread / mean } else { spread }
        });
        // The quantile 0.975 of t with 30 × 9 degrees of freedom, for one run beside the mean of ten.
        1.969 * 1.1_f64.sqrt() * root_mean(&values.collect::<Vec<_>>())
    };
    let bands = [pooled(5, true), pooled(8, false), pooled(11, true)];
    assert!((bands[0] - 0.015).abs() < 0.0005, "{bands:?}");
    assert!((bands[1] - 0.04).abs() < 0.0005, "{bands:?}");
    assert!((bands[2] - 0.09).abs() < 0.0015, "{bands:?}");
    // The verdicts, from the printed numbers: half of the last digit may decide either way.
    for (name, first) in [("table1", 4), ("table2", 1)] {
        let table = part(name);
        let rows: Vec<Vec<String>> = table
            .lines()
            .filter(|line| line.contains("kept") || line.contains("**missed**"))
            .map(cells)
            .filter(|row| row.len() > 9)
            .collect();
        assert_eq!(rows.len(), if name == "table1" { 30 } else { 7 });
        let mut counts = [0; 2];
        for row in &rows {
            let verdict = row.last().unwrap();
            for (k, (quantity, most)) in [("density", 0.015), ("deviation", 0.04), ("flow", 0.09)]
                .into_iter()
                .enumerate()
            {
                let paper = number(&row[first + 3 * k]);
                let [ours, _] = pair(&row[first + 3 * k + 1]);
                let most = if k == 1 { most } else { most * paper };
                let off = (ours - paper).abs();
                if (off - most).abs() > 0.0051 && !row[first + 3 * k + 1].contains(" of 10") {
                    assert_eq!(verdict.contains(quantity), off > most, "{row:?}");
                }
            }
            if name == "table1" {
                let off = (number(&row[2]) - number(&row[3])).abs();
                assert_eq!(verdict.contains("evacuated"), off > 1.0, "{row:?}");
            }
            counts[usize::from(verdict == "kept")] += 1;
        }
        let said = format!(
            "Of {} rows, {} are inside of all bands (means over 10 seed(s))",
            rows.len(),
            counts[1]
        );
        assert!(table.contains(&said), "{said}");
    }
}
