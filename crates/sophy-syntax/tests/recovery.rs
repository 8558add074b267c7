//! A mistake costs few messages, wherever it is made.

mod corpus;

use corpus::{CORPUS, shown, tokens};
use proptest::prelude::*;
use sophy_syntax::{SyntaxKind, parse_file};

/// Every file that differs from `text` by a token deleted, doubled or swapped with the next.
fn mistaken(text: &str) -> Vec<String> {
    let tokens = tokens(text);
    let written = |tokens: &[(SyntaxKind, String)]| tokens.iter().map(|(_, text)| text.as_str()).collect();
    let meaningful: Vec<usize> = (0..tokens.len()).filter(|&i| !tokens[i].0.is_trivia()).collect();
    let mut texts: Vec<String> = Vec::new();
    for (position, &index) in meaningful.iter().enumerate() {
        let mut deleted = tokens.clone();
        deleted[index].1 = " ".to_owned();
        texts.push(written(&deleted));
        let mut doubled = tokens.clone();
        doubled[index].1 = format!("{0} {0}", tokens[index].1);
        texts.push(written(&doubled));
        if let Some(&next) = meaningful.get(position + 1) {
            let mut swapped = tokens.clone();
            swapped.swap(index, next);
            texts.push(written(&swapped));
        }
    }
    texts
}

#[test]
fn one_wrong_token_costs_few_messages() {
    let mut counts: Vec<(usize, String)> = Vec::new();
    for (name, text) in CORPUS {
        for mistaken in mistaken(text) {
            let parse = parse_file(&mistaken);
            assert_eq!(parse.syntax().to_string(), mistaken, "{name}: the tree keeps every byte");
            let count = parse.errors().len();
            counts.push((count, if count > 4 { shown(&mistaken, &parse) } else { String::new() }));
        }
    }
    counts.sort();
    let number = counts.len();
    let at = |share: f64| counts[((number - 1) as f64 * share) as usize].0;
    assert!(at(0.5) <= 1, "half of the mistakes cost {} messages or more", at(0.5));
    assert!(at(0.95) <= 2, "one mistake in twenty costs {} messages or more", at(0.95));
    let (most, worst) = &counts[number - 1];
    assert!(*most <= 5, "{most} messages for one mistake:\n{worst}");
}

/// Texts that are no files at all. Reading them must take no more than time in proportion to their length: each
/// is read in a fraction of a second, and would take minutes if every line looked at all others.
#[test]
fn garbage_is_read_in_time() {
    let texts = [
        "x\n".repeat(10_000),
        "end dynamics if then ( ] ; := x = 1 \"s\" body $ CTC is\n".repeat(10_000),
        "CTC A is body dynamics x = ".to_owned() + &"(a, ".repeat(50_000),
        "CTC A is body dynamics ".to_owned() + &"der(x[1]\n".repeat(10_000),
        "CTC A is body dynamics ".to_owned() + &"if a then b = 1; end if ".repeat(10_000),
        "CTC A is body ".repeat(10_000),
        "$ \n% comment\n".repeat(50_000) + "CTC A is body end body;",
    ];
    let start = std::time::Instant::now();
    for text in texts {
        assert_eq!(parse_file(&text).syntax().to_string(), text);
    }
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

#[test]
fn nesting_is_limited() {
    let depth = 100_000;
    for (opening, closing) in [("if a then ", "end if; "), ("for i in 1..2 loop ", "end loop; ")] {
        let nested = format!("{}x := 1; {}", opening.repeat(depth), closing.repeat(depth));
        let text = format!("CTC A is body initial {nested} end initial; end body;");
        let parse = parse_file(&text);
        assert_eq!(parse.syntax().to_string(), text);
        assert_eq!(parse.errors()[0].code.0, "HS0011");
    }
    let deepest = format!("{}x := 1; {}", "if a then ".repeat(60), "end if; ".repeat(60));
    assert!(
        parse_file(&format!("CTC A is body initial {deepest} end initial; end body;")).errors().is_empty()
    );
}

/// Every token of the corpus.
static WORDS: std::sync::LazyLock<Vec<String>> = std::sync::LazyLock::new(|| {
    CORPUS.iter().flat_map(|(_, text)| tokens(text)).map(|(_, text)| text).collect()
});

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn any_jumble_of_words_has_a_tree(
        picks in prop::collection::vec(any::<prop::sample::Index>(), 0..80),
    ) {
        let words = picks.iter().map(|pick| pick.get(&WORDS).as_str());
        let text = words.collect::<Vec<_>>().join(" ");
        let parse = parse_file(&text);
        prop_assert_eq!(parse.syntax().to_string(), text.clone());
        for error in parse.errors() {
            prop_assert!(text.get(error.range.clone()).is_some());
        }
        let _ = sophy_syntax::format(&text);
    }

    #[test]
    fn any_text_has_a_tree(text in "\\PC{0,60}") {
        prop_assert_eq!(parse_file(&text).syntax().to_string(), text.clone());
        let in_body = format!("CTC C is body dynamics {text}\nend dynamics; end body;");
        prop_assert_eq!(parse_file(&in_body).syntax().to_string(), in_body.clone());
    }
}
