//! Reads any text as a study, for tests and for fuzzing.

use std::path::Path;

use sandbox::lab::sweep::Study;

/// Checks the cells of a valid study, or that the error is short, names the file and has no control characters.
/// Returns the number of cells.
pub fn read(text: &str) -> u64 {
    let study = match Study::parse(text, Path::new("study.json")) {
        Ok(study) => study,
        Err(error) => {
            let said = error.to_string();
            assert!(said.starts_with("study.json: "), "{said}");
            assert!(
                said.len() < 3000 && !said.contains(char::is_control),
                "{said:?}"
            );
            return 0;
        }
    };
    let files = study.names().in_folder();
    assert!(!study.name.is_empty() && files.iter().all(|file| !file.contains('/')));
    assert_eq!(study.cells.len() % study.seeds, 0);
    for (k, cell) in study.cells.iter().enumerate() {
        assert_eq!(cell.number, k + 1);
        assert!(cell.case.expected_secs.is_finite());
        assert!(!cell.to_string().contains(char::is_control));
    }
    study.cells.len() as u64
}
