//! The open questions of crowd physics: names and studies.

use experiments::physics::PRODUCTS;

#[test]
fn every_question_has_a_unique_name_and_valid_studies() {
    let mut names = PRODUCTS.map(|product| product.name);
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
    for product in PRODUCTS {
        for study in product.studies(1).unwrap() {
            assert!(!study.cells.is_empty(), "{}", study.name);
        }
    }
}
