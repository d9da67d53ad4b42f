//! All questions in one picture: people and model side by side.

use super::{oscillations, queue_pushes, start_waves, swaying};
use sandbox::lab::error::LabError;
use sandbox::lab::gallery::with_legend;
use sandbox::lab::reproduce::{Needs, Product};
use sandbox::lab::sweep::Gathered;
use sandbox::output::document::Findings;
use sandbox::output::plot::Sheet;

/// The picture. Its panels are those of the single questions.
pub const PRODUCT: Product = Product {
    name: "phenomena",
    about: "the open questions in one picture: people and model side by side",
    in_all: false,
    studies: &["queue_pushes", "start_waves", "oscillations", "sway"],
    needs: Needs::All,
    tables: &[],
    has_figure: true,
    find,
};

fn find(product: &Product, studies: &[Gathered]) -> Result<Findings, LabError> {
    let rows: Vec<_> = studies.iter().map(Gathered::combinations).collect();
    let fronts = [
        queue_pushes::strongest(&rows[0]),
        start_waves::fronts(&rows[1]),
    ];
    let spectra = with_legend(oscillations::spectra(&rows[2]), 1);
    let legs = swaying::frequencies(&rows[3]);
    let panels = fronts.into_iter().chain(spectra).chain([legs]).collect();
    let title = "Waves in crowds: what people did (black and gray) and what the model does";
    Ok(product.figure(Sheet::new(title, 2, [290.0, 220.0], panels)))
}
