//! Tables as text, Markdown and CSV.

use sandbox::analysis::statistics::Estimate;
use sandbox::output::table::Table;

struct Row {
    name: &'static str,
    speed: Option<Estimate>,
    count: usize,
    energy: f64,
}

fn table() -> Table {
    let speed = |value, error| Some(Estimate { value, error });
    let row = |name, speed, count, energy| Row {
        name,
        speed,
        count,
        energy,
    };
    let rows = [
        row("x, y", speed(1.0, 0.25), 12, 0.00123),
        row("z", None, 3, f64::NAN),
    ];
    Table::of(&rows)
        .column("name", |row| row.name)
        .spread("speed", 2, ["_mean", "_error"], |row| row.speed)
        .column("n", |row| row.count)
        .exponent("energy", 1, |row| row.energy)
        .table()
}

#[test]
fn text_and_markdown_have_formatted_numbers_and_csv_all_digits() {
    let text = "\
name        speed   n  energy
x, y  1.00 ± 0.25  12  1.2e-3
z               –   3       –
";
    let markdown = "\
| name | speed | n | energy |
| --- | --- | --- | --- |
| x, y | 1.00 ± 0.25 | 12 | 1.2e-3 |
| z | – | 3 | – |
";
    let csv = "\
name,speed_mean,speed_error,n,energy
\"x, y\",1,0.25,12,0.00123
z,,,3,
";
    assert_eq!(table().text(), text);
    assert_eq!(table().markdown(), markdown);
    assert_eq!(table().csv().unwrap(), csv.as_bytes());
}
