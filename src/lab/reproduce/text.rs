//! Generated text in documents.

/// `document` with `text` between the lines `<!-- name -->` and `<!-- /name -->`; `None` if they are missing.
pub fn put_between(document: &str, name: &str, text: &str) -> Option<String> {
    let (open, close) = (format!("<!-- {name} -->\n"), format!("<!-- /{name} -->"));
    let (before, rest) = document.split_once(&open)?;
    let (_, after) = rest.split_once(&close)?;
    let text = text.trim_end();
    Some(format!("{before}{open}\n{text}\n\n{close}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_takes_the_place_of_the_one_before_it() {
        let document = "a\n<!-- t -->\nold\n<!-- /t -->\nb\n";
        let once = put_between(document, "t", "new\n").unwrap();
        assert_eq!(once, "a\n<!-- t -->\n\nnew\n\n<!-- /t -->\nb\n");
        assert_eq!(put_between(&once, "t", "new").unwrap(), once);
        assert_eq!(put_between(document, "u", "new"), None);
    }
}
