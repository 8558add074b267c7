//! What the codes of messages mean: the pages `docs/book/messages` of the book.

/// The explanation of a code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Page {
    /// The code, such as `HS0101`.
    pub code: &'static str,
    /// The kind of mistake it names, in a few words.
    pub title: &'static str,
    /// What it means, why it matters, an example and the way out, as Markdown.
    pub text: &'static str,
}

const FILES: [&str; 9] = [
    include_str!("../../../docs/book/messages/HS00.md"),
    include_str!("../../../docs/book/messages/HS01.md"),
    include_str!("../../../docs/book/messages/HS02.md"),
    include_str!("../../../docs/book/messages/HS03.md"),
    include_str!("../../../docs/book/messages/HS04.md"),
    include_str!("../../../docs/book/messages/SX.md"),
    include_str!("../../../docs/book/messages/EX.md"),
    include_str!("../../../docs/book/messages/FI.md"),
    include_str!("../../../docs/book/messages/SR.md"),
];

/// Every page, in the order of the book: models, SOPHY XML, experiments, files, runs.
pub fn pages() -> impl Iterator<Item = Page> {
    FILES.iter().flat_map(|file| file.split("\n## ").skip(1)).filter_map(|section| {
        let (code, rest) = section.split_once('\n')?;
        let (title, text) = rest.trim().split_once("\n\n").unwrap_or((rest.trim(), ""));
        Some(Page { code: code.trim(), title: title.trim_matches('*'), text: text.trim() })
    })
}

/// The page of a code, in capital or small letters.
pub fn page(code: &str) -> Option<Page> {
    pages().find(|page| page.code.eq_ignore_ascii_case(code.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_is_found_in_any_letters() {
        let page = page("hs0101").expect("a page");
        assert_eq!((page.code, page.title), ("HS0101", "an expression uses a name that is not declared"));
        assert!(page.text.contains("```hsml"));
        assert_eq!(super::page("HS99"), None);
    }
}
