//! Tables in the HTML of reports.

/// The cells of the first table below a heading.
pub fn rows(html: &str, heading: &str) -> Vec<Vec<String>> {
    let (_, rest) = html.split_once(&format!("<h2>{heading}</h2>")).unwrap();
    let (table, _) = rest.split_once("</table>").unwrap();
    let rows = table.split("<tr").skip(2).map(|row| {
        let cells = row.split("<td").skip(1);
        let cell = |cell: &str| {
            let (_, text) = cell.split_once('>').unwrap();
            text.split("</td>").next().unwrap().replace("&gt;", ">")
        };
        cells.map(cell).collect()
    });
    rows.collect()
}
