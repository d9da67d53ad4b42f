//! Documents as text for a terminal and as Markdown, and texts that are put into Markdown files.

use super::{Block, Document, Figure};
use crate::table::Table;

/// How blocks become lines.
#[derive(Clone, Copy)]
enum Markup<'a> {
    /// Aligned columns; figures are not shown.
    Terminal,
    /// Markdown, with links to the files of figures, if there are any. Headings begin with this many `#`.
    Markdown {
        file_of: Option<&'a dyn Fn(&Figure) -> String>,
        level: usize,
    },
}

impl Document {
    /// Everything below the title, for a terminal.
    pub fn text(&self) -> String {
        lines(&self.blocks, Markup::Terminal)
    }

    /// As Markdown, with the title. `file_of` gives the files of figures.
    pub fn markdown(&self, file_of: &dyn Fn(&Figure) -> String) -> String {
        let is_part = |block: &Block| matches!(block, Block::Part(..));
        let markup = Markup::Markdown {
            file_of: Some(file_of),
            level: 2 + usize::from(self.blocks.iter().any(is_part)),
        };
        let title = format!("# {}\n\n", self.title);
        let subtitle = match self.subtitle.as_str() {
            "" => String::new(),
            subtitle => format!("{subtitle}\n\n"),
        };
        title + &subtitle + &lines(&self.blocks, markup)
    }

    /// The Markdown of each part by its name, without its heading and without figures, for [`put_between`]. A document
    /// without parts is one, which is called `name`.
    pub fn parts(&self, name: &str) -> Vec<(String, String)> {
        let markup = Markup::Markdown {
            file_of: None,
            level: 3,
        };
        let part = |blocks: &[Block]| match blocks {
            [Block::Part(own, _), rest @ ..] => (own.clone(), lines(rest, markup)),
            whole => (name.to_owned(), lines(whole, markup)),
        };
        let parts = self
            .blocks
            .chunk_by(|_, next| !matches!(next, Block::Part(..)));
        parts.map(part).collect()
    }
}

/// The blocks, with an empty line between any two of them.
fn lines(blocks: &[Block], markup: Markup) -> String {
    let filled = blocks.iter().filter(|block| !block.is_empty());
    let shown: Vec<String> = filled.filter_map(|block| markup.shown(block)).collect();
    shown.join("\n\n") + "\n"
}

impl Markup<'_> {
    fn shown(self, block: &Block) -> Option<String> {
        Some(match block {
            Block::Part(_, heading) => self.heading(heading, 2),
            Block::Heading(heading) => match self {
                Self::Terminal => heading.clone(),
                Self::Markdown { level, .. } => self.heading(heading, level),
            },
            Block::Text(text) => text.trim_end().to_owned(),
            Block::List(items) => {
                let items: Vec<String> = items.iter().map(|item| format!("- {item}")).collect();
                items.join("\n")
            }
            Block::Code(lines) => match self {
                Self::Terminal => lines.join("\n"),
                Self::Markdown { .. } => format!("```sh\n{}\n```", lines.join("\n")),
            },
            Block::Table(table, caption) => {
                let rows = self.table(table);
                match caption.as_str() {
                    "" => rows.trim_end().to_owned(),
                    caption => format!("{caption}\n\n{}", rows.trim_end()),
                }
            }
            Block::Figure(figure) => match self {
                Self::Markdown {
                    file_of: Some(file_of),
                    ..
                } => format!("![{}]({})", figure.about(), file_of(figure)),
                _ => return None,
            },
        })
    }

    fn heading(self, text: &str, level: usize) -> String {
        match self {
            Self::Terminal => text.to_owned(),
            Self::Markdown { .. } => format!("{} {text}", "#".repeat(level)),
        }
    }

    fn table(self, table: &Table) -> String {
        match self {
            Self::Terminal => table.text(),
            Self::Markdown { .. } => table.markdown(),
        }
    }
}

/// `document` with `text` between the lines `<!-- name -->` and `<!-- /name -->`; `None` if they are missing.
pub fn put_between(document: &str, name: &str, text: &str) -> Option<String> {
    let (open, close) = (format!("<!-- {name} -->\n"), format!("<!-- /{name} -->"));
    let (before, rest) = document.split_once(&open)?;
    let (_, after) = rest.split_once(&close)?;
    let text = text.trim_end();
    Some(format!("{before}{open}\n{text}\n\n{close}{after}"))
}
