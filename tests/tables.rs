//! Tables as text, Markdown, HTML and CSV.

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

#[test]
fn text_has_no_line_of_names_if_all_are_empty() {
    let table = Table::of(&[("left", 12.0), ("stuck", 3.0)])
        .column("", |row| row.0)
        .column("", |row| row.1)
        .table();
    assert_eq!(table.text(), "left   12\nstuck   3\n");
}

#[test]
fn html_has_every_cell_escaped_and_numbers_at_the_right() {
    let rows = ["<b>", "a & b"];
    let table = Table::of(&rows)
        .column("name", |name| *name)
        .fixed("length", 1, |name| name.len())
        .table();
    let lines: Vec<String> = table.html().lines().map(str::to_owned).collect();
    let row = |tag: &str, name: &str, length: &str| {
        format!("<tr><{tag}>{name}</{tag}><{tag} class=\"number\">{length}</{tag}></tr>")
    };
    assert_eq!(lines[2], row("th", "name", "length"));
    assert_eq!(lines[5], row("td", "&lt;b&gt;", "3.0"));
    assert_eq!(lines[6], row("td", "a &amp; b", "5.0"));
}
