//! Documents as PDF, on A4. All lengths are in points.

use super::{Block, Document, Figure, Piece, pieces, print, unmarked};
use crate::colors::Rgb;
use crate::html::PROGRAM;
use crate::plot::{BLACK, GRAY, LINE, Pages, PlotError, Print, Sheet, text_lines, text_width};
use crate::table::Table;

const SIZE: [f64; 2] = [595.3, 841.9];
const LEFT: f64 = 56.7;
const WIDTH: f64 = SIZE[0] - 2.0 * LEFT;
const TOP: f64 = 56.7;
const FOOT: f64 = SIZE[1] - 56.7;
const TITLE: f64 = 18.0;
const HEADING: f64 = 13.0;
const TEXT: f64 = 9.5;
const CAPTION: f64 = 8.5;
const CELL: f64 = 7.5;
/// Between blocks.
const GAP: f64 = 8.0;
/// Between the columns of a table.
const APART: f64 = 8.0;
/// Between the rows of a table.
const ROW: f64 = 3.0;
/// A heading needs this much of the page below it.
const AFTER_HEADING: f64 = 90.0;
/// Figures are at most this high: two fit on a page.
const HIGHEST: f64 = 0.45 * (FOOT - TOP);
const HEAD: Rgb = [30, 64, 100];
const RULE: Rgb = [205, 210, 216];
const SHADE: Rgb = [238, 241, 244];

type Done = Result<(), PlotError>;

impl Document {
    /// The document as PDF.
    ///
    /// # Errors
    /// A figure cannot be drawn, or the font cannot be embedded.
    pub fn pdf(&self) -> Result<Vec<u8>, PlotError> {
        let pages = Pages::new(SIZE);
        let mut writer = Writer { pages, y: TOP };
        writer.lines(&self.title, TITLE, HEAD)?;
        writer.lines(&self.subtitle, CAPTION, GRAY)?;
        for (k, block) in self.blocks.iter().enumerate() {
            if block.is_empty() {
                continue;
            }
            writer.y += GAP;
            if let (Block::Heading(_), Some(Block::Figure(figure))) =
                (block, self.blocks.get(k + 1))
            {
                let (_, size) = fitted(&figure.sheet);
                let below = caption_height(&figure.caption) + 2.0 * GAP + HEADING * LINE * 1.1;
                writer.make_room(size[1] + below + GAP);
            }
            writer.block(block)?;
        }
        writer.feet()?;
        writer.pages.finish()
    }
}

/// The lines of a table's cell.
struct Cell {
    lines: Vec<String>,
    is_bold: bool,
}

impl Cell {
    fn new(text: &str, width: f64) -> Self {
        Self {
            lines: text_lines(&unmarked(text), CELL, width),
            is_bold: matches!(pieces(text)[..], [Piece::Bold(_)]),
        }
    }
}

/// Pages, and where the next block begins on the last one.
struct Writer {
    pages: Pages,
    y: f64,
}

impl Writer {
    fn block(&mut self, block: &Block) -> Done {
        match block {
            Block::Part(_, text) | Block::Heading(text) => {
                self.y += GAP;
                self.make_room(AFTER_HEADING);
                self.lines(text, HEADING, HEAD)
            }
            Block::Text(text) => {
                let mut lines = text.lines();
                lines.try_for_each(|line| self.lines(line, TEXT, BLACK))
            }
            Block::Code(lines) => {
                let mut lines = lines.iter();
                lines.try_for_each(|line| self.lines(line, CAPTION, HEAD))
            }
            Block::List(items) => items.iter().try_for_each(|item| self.item(item)),
            Block::Table(table, caption) => {
                self.caption(caption)?;
                self.table(table)
            }
            Block::Figure(figure) => {
                self.figure(figure)?;
                self.caption(&figure.caption)
            }
        }
    }

    /// Begins a page if less than `height` is left of this one.
    fn make_room(&mut self, height: f64) {
        if self.y + height > FOOT && self.y > TOP {
            self.pages.begin();
            self.y = TOP;
        }
    }

    fn lines(&mut self, text: &str, size: f64, color: Rgb) -> Done {
        self.beside(text, (size, color), 0.0)
    }

    /// A text that begins `aside` from the left.
    fn beside(&mut self, text: &str, (size, color): (f64, Rgb), aside: f64) -> Done {
        for line in text_lines(&unmarked(text), size, WIDTH - aside) {
            self.make_room(size * LINE);
            self.pages
                .text(&line, [LEFT + aside, self.y], (size, color))?;
            self.y += size * LINE * 1.1;
        }
        Ok(())
    }

    fn item(&mut self, text: &str) -> Done {
        self.make_room(TEXT * LINE);
        let at = [LEFT + 2.0, self.y];
        self.pages.text("•", at, (TEXT, BLACK))?;
        self.beside(text, (TEXT, BLACK), 12.0)?;
        self.y += 2.0;
        Ok(())
    }

    fn caption(&mut self, text: &str) -> Done {
        self.y += 2.0;
        self.lines(text, CAPTION, GRAY)
    }

    fn figure(&mut self, figure: &Figure) -> Done {
        let (print, size) = fitted(&figure.sheet);
        self.make_room(size[1] + caption_height(&figure.caption));
        let aside = 0.5 * (WIDTH - size[0]).max(0.0);
        let at = [LEFT + aside, self.y];
        self.pages.sheet(&figure.sheet, &print, at)?;
        self.y += size[1];
        Ok(())
    }

    fn table(&mut self, table: &Table) -> Done {
        let rows = table.lines();
        let widths = widths(&rows);
        let by_row = rows.iter().map(|row| {
            let cells = row.iter().zip(&widths);
            cells
                .map(|(cell, width)| Cell::new(cell, *width))
                .collect::<Vec<_>>()
        });
        let wrapped: Vec<Vec<Cell>> = by_row.collect();
        let Some((head, rows)) = wrapped.split_first() else {
            return Ok(());
        };
        let first = rows.first().map_or(0.0, |row| height(row));
        self.make_room(height(head) + first);
        self.head(head, table, &widths)?;
        for row in rows {
            if self.y + height(row) > FOOT {
                self.make_room(FOOT);
                self.head(head, table, &widths)?;
            }
            self.row(row, table, &widths)?;
        }
        Ok(())
    }

    fn head(&mut self, row: &[Cell], table: &Table, widths: &[f64]) -> Done {
        let whole: f64 = widths.iter().map(|width| width + APART).sum();
        let size = [whole - APART, height(row)];
        self.pages.area([LEFT, self.y], size, SHADE)?;
        self.row(row, table, widths)
    }

    fn row(&mut self, row: &[Cell], table: &Table, widths: &[f64]) -> Done {
        let mut x = LEFT;
        for (k, (cell, width)) in row.iter().zip(widths).enumerate() {
            for (line, text) in cell.lines.iter().enumerate() {
                let aside = match table.has_numbers(k) {
                    true => width - text_width(text, CELL),
                    false => 0.0,
                };
                let y = self.y + 0.5 * ROW + line as f64 * CELL * LINE;
                let at = [x + aside, y];
                match cell.is_bold {
                    true => self.pages.bold(text, at, (CELL, BLACK))?,
                    false => self.pages.text(text, at, (CELL, BLACK))?,
                }
            }
            x += width + APART;
        }
        self.y += height(row);
        self.pages
            .area([LEFT, self.y], [x - LEFT - APART, 0.4], RULE)
    }

    /// The program and the numbers of the pages.
    fn feet(&mut self) -> Done {
        let count = self.pages.count();
        for k in 0..count {
            self.pages.go_to(k);
            let left = [LEFT, SIZE[1] - 36.0];
            self.pages.text(PROGRAM, left, (CELL, GRAY))?;
            let number = format!("{} / {count}", k + 1);
            let at = [SIZE[0] - LEFT - text_width(&number, CELL), SIZE[1] - 36.0];
            self.pages.text(&number, at, (CELL, GRAY))?;
        }
        Ok(())
    }
}

/// How a figure is printed, and its size.
fn fitted(sheet: &Sheet) -> (Print, [f64; 2]) {
    let mut print = print();
    let mut size = Pages::size_of(sheet, &print);
    for _ in 0..3 {
        if size[1] > HIGHEST {
            let width = print.width.unwrap_or(WIDTH) * HIGHEST / size[1];
            print = Print {
                width: Some(width),
                ..print
            };
            size = Pages::size_of(sheet, &print);
        }
    }
    (print, size)
}

fn caption_height(caption: &str) -> f64 {
    text_lines(caption, CAPTION, WIDTH).len() as f64 * CAPTION * LINE * 1.2
}

fn height(row: &[Cell]) -> f64 {
    let longest = row.iter().map(|cell| cell.lines.len()).max();
    let most = longest.unwrap_or(0).max(1);
    most as f64 * CELL * LINE + ROW
}

/// The widths of columns: as their texts need, or else at least as their words need; the rest is shared such that the
/// columns that lack the least get all they need.
fn widths(rows: &[Vec<String>]) -> Vec<f64> {
    let columns = rows.first().map_or(0, Vec::len);
    let most = |width: &dyn Fn(&str) -> f64| -> Vec<f64> {
        let of = |k: usize| rows.iter().map(|row| width(&row[k])).fold(0.0, f64::max);
        (0..columns).map(of).collect()
    };
    let text = |text: &str| text_width(&unmarked(text), CELL);
    let wanted = most(&text);
    let least = most(&|cell: &str| cell.split(' ').map(text).fold(0.0, f64::max));
    let room = WIDTH - APART * (columns.max(1) - 1) as f64;
    let lack = |k: &usize| wanted[*k] - least[*k];
    let mut order: Vec<usize> = (0..columns).collect();
    order.sort_by(|one, other| lack(one).total_cmp(&lack(other)));
    let mut widths = least.clone();
    let mut rest = (room - least.iter().sum::<f64>()).max(0.0);
    for (done, k) in order.into_iter().enumerate() {
        let more = lack(&k).min(rest / (columns - done) as f64);
        widths[k] += more;
        rest -= more;
    }
    widths
}
