//! Documents as HTML.

use super::{Block, Document, print};
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
        for block in &self.blocks {
            text += &shown(block)?;
        }
        text += &format!("<p class=\"about\">{PROGRAM}</p>\n</main>\n{END}");
        Ok(text)
    }
}

/// A text in which words between backticks are code.
fn marked(text: &str) -> String {
    let parts = text.split('`').enumerate();
    let parts = parts.map(|(k, part)| match k % 2 {
        0 => escape(part),
        _ => format!("<code>{}</code>", escape(part)),
    });
    parts.collect()
}

fn shown(block: &Block) -> Result<String, PlotError> {
    Ok(match block {
        Block::Heading(text) => format!("<h2>{}</h2>\n", escape(text)),
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
            format!("{}{caption}", table.html())
        }
        Block::Figure(sheet, caption) => {
            let svg = sheet.svg(&print())?;
            let image = picture(&String::from_utf8_lossy(&svg), caption);
            format!(
                "<figure>\n{image}<figcaption>{}</figcaption>\n</figure>\n",
                escape(caption)
            )
        }
    })
}
