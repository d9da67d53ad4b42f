//! Generated text in documents.

/// `document` with `text` between the lines `<!-- name -->` and `<!-- /name -->`; `None` if they are missing.
pub fn put_between(document: &str, name: &str, text: &str) -> Option<String> {
    let (open, close) = (format!("<!-- {name} -->\n"), format!("<!-- /{name} -->"));
    let (before, rest) = document.split_once(&open)?;
    let (_, after) = rest.split_once(&close)?;
    let text = text.trim_end();
    Some(format!("{before}{open}\n{text}\n\n{close}{after}"))
}
