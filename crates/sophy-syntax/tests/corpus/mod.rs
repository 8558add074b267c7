//! Files without mistakes, of every kind of component and section.

#![allow(dead_code, clippy::panic, reason = "each test uses a part of it, and stops at the first surprise")]

use sophy_syntax::{Parse, SyntaxElement, SyntaxKind, parse_file};

/// Name and text.
pub(crate) const CORPUS: &[(&str, &str)] = &[
    ("comments", include_str!("comments.hsml")),
    ("composite", include_str!("composite.hsml")),
    ("controller", include_str!("controller.hsml")),
    ("events", include_str!("events.hsml")),
    ("functions", include_str!("functions.hsml")),
    ("hopper", include_str!("hopper.hsml")),
    ("hovercraft", include_str!("hovercraft.hsml")),
    ("hybrid", include_str!("hybrid.hsml")),
    ("logic", include_str!("logic.hsml")),
    ("missile", include_str!("missile.hsml")),
    ("names", include_str!("names.hsml")),
    ("nested", include_str!("nested.hsml")),
    ("noise", include_str!("noise.hsml")),
    ("roll", include_str!("roll.hsml")),
    ("sampled", include_str!("sampled.hsml")),
    ("template", include_str!("template.hsml")),
];

/// The messages with what they point at, one on a line.
pub(crate) fn shown(text: &str, parse: &Parse) -> String {
    let line = |at: usize| text[..at].matches('\n').count() + 1;
    parse
        .errors()
        .iter()
        .map(|e| {
            let helps: String = e.helps.iter().map(|help| format!(" | {help}")).collect();
            format!("{}:{} `{}`: {}{helps}\n", e.code, line(e.range.start), &text[e.range.clone()], e.message)
        })
        .collect()
}

/// The tokens of a file.
pub(crate) fn tokens(text: &str) -> Vec<(SyntaxKind, String)> {
    parse_file(text)
        .syntax()
        .descendants_with_tokens()
        .filter_map(SyntaxElement::into_token)
        .map(|token| (token.kind(), token.text().to_owned()))
        .collect()
}

/// The text of a file of the corpus.
pub(crate) fn text(name: &str) -> &'static str {
    CORPUS.iter().find(|(other, _)| *other == name).map_or_else(|| panic!("no file {name}"), |(_, text)| text)
}
