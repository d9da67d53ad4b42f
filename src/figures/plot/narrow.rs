//! Grids of panels on narrow sheets.

use std::borrow::Cow;

use super::layout::{LEAST_CELL, Layout};
use super::{Panel, Print, Sheet};

impl Sheet {
    /// The sheet as it is printed: a grid whose panels would be too small is turned, rows into columns, or else its
    /// panels become a list.
    pub(super) fn for_print(&self, print: &Print) -> Cow<'_, Self> {
        let rows = self.row_titles.len();
        let fits = |sheet: &Self| Layout::new(sheet, print).panel[0] >= LEAST_CELL;
        if rows == 0 || print.width.is_none() || fits(self) {
            return Cow::Borrowed(self);
        }
        let turned = self.turned();
        Cow::Owned(if fits(&turned) { turned } else { self.listed() })
    }

    /// The same panels, rows as columns.
    fn turned(&self) -> Self {
        let (rows, columns) = (self.row_titles.len(), self.columns.max(1));
        let panels = (0..columns).flat_map(|column| {
            (0..rows).filter_map(move |row| {
                let panel = self.panels.get(row * columns + column)?.clone();
                let title = match column {
                    0 => self.row_titles[row].clone(),
                    _ => String::new(),
                };
                Some(Panel { title, ..panel })
            })
        });
        let titles = self.panels.iter().take(columns);
        Self {
            columns: rows,
            row_titles: titles.map(|panel| panel.title.clone()).collect(),
            panels: panels.collect(),
            ..self.clone()
        }
    }

    /// The same panels, each with the titles of its row and its column.
    fn listed(&self) -> Self {
        let columns = self.columns.max(1);
        let title = |k: usize| {
            let row = self.row_titles.get(k / columns);
            let column = self.panels.get(k % columns).map(|panel| &panel.title);
            let both = row.into_iter().chain(column).filter(|one| !one.is_empty());
            both.cloned().collect::<Vec<_>>().join(", ")
        };
        let panels = self.panels.iter().enumerate().map(|(k, panel)| Panel {
            title: title(k),
            ..panel.clone()
        });
        Self {
            row_titles: Vec::new(),
            panels: panels.collect(),
            ..self.clone()
        }
    }
}
