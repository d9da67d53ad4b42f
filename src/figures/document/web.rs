//! Documents as HTML.

use super::{Block, Document, Piece, pieces, print};
use crate::html::{END, Head, PROGRAM, escape, picture};
use crate::plot::PlotError;

/// What documents have beside the rules of all files.
const STYLE: &str = "\
main { max-width: 56rem; margin: 0 auto; padding: 1rem; line-height: 1.5 }
figure { margin: 1rem 0 } figure img { max-width: 100%; background: #fff }
figcaption, .about { font-size: .9em; opacity: .8 }
pre { padding: .6rem; overflow-x: auto; border: 1px solid }
td { vertical-align: top }
";

impl Document {
    /// The document as HTML.
    ///
    /// # Errors
    /// A figure cannot be drawn.
    pub fn html(&self) -> Result<String, PlotError> {
        let head = Head {
            title: &self.title,
            style: STYLE,
            ..Head::default()
        };
        let (title, subtitle) = (escape(&self.title), escape(&self.subtitle));
        let mut text = head.text();
        text += &format!("<main>\n<h1>{title}</h1>\n<p class=\"about\">{subtitle}</p>\n");
        let has_parts = self.blocks.iter().any(|one| matches!(one, Block::Part(..)));
        for block in self.blocks.iter().filter(|block| !block.is_empty()) {
            text += &shown(block, if has_parts { 3 } else { 2 })?;
        }
        text += &format!("<p class=\"about\">{PROGRAM}</p>\n</main>\n{END}");
        Ok(text)
    }
}

/// A text with its marked pieces.
fn marked(text: &str) -> String {
    let pieces = pieces(text).into_iter().map(|piece| match piece {
        Piece::Plain(text) => escape(text).replace('\n', "<br>\n"),
        Piece::Code(text) => format!("<code>{}</code>", escape(text)),
        Piece::Bold(text) => format!("<b>{}</b>", escape(text)),
    });
    pieces.collect()
}

/// A block; its headings are of this level.
fn shown(block: &Block, level: u8) -> Result<String, PlotError> {
    Ok(match block {
        Block::Part(_, text) => format!("<h2>{}</h2>\n", escape(text)),
        Block::Heading(text) => format!("<h{level}>{}</h{level}>\n", escape(text)),
        Block::Text(text) => format!("<p>{}</p>\n", marked(text)),
        Block::Code(lines) => format!("<pre>{}</pre>\n", escape(&lines.join("\n"))),
        Block::List(items) => {
            let items = items
                .iter()
                .map(|item| format!("<li>{}</li>\n", marked(item)));
            format!("<ul>\n{}</ul>\n", items.collect::<String>())
        }
        Block::Table(table, caption) => {
            let caption = match caption.as_str() {
                "" => String::new(),
                caption => format!("<p class=\"about\">{}</p>\n", marked(caption)),
            };
            format!("{}{caption}", table.html_of(marked))
        }
        Block::Figure(figure) => {
            let svg = figure.sheet.svg(&print())?;
            let image = picture(&String::from_utf8_lossy(&svg), figure.about());
            let caption = match figure.caption.as_str() {
                "" => String::new(),
                caption => format!("<figcaption>{}</figcaption>\n", escape(caption)),
            };
            format!("<figure>\n{image}{caption}</figure>\n")
        }
    })
}
