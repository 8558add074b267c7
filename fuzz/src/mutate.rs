//! From corpus, seed and index to an input.

use crate::corpus::{Corpus, Notation, is_space, tokens};
use crate::random::Random;
use std::ops::Range;

/// Longest input, in bytes.
const LONGEST: usize = 100_000;

/// One input in so many is long.
const LONG_ONCE_IN: usize = 2000;

const SPACES: &[&str] =
    &["", " ", "\n", "\r\n", "\n\n\n", "\t", " % c\n", "%% d\n", "\n% c\n\n", "  ", "\r", "\u{feff}"];

/// What opens a level, what may stand inside, what closes it.
const HSML_NESTS: &[[&str; 3]] = &[
    ["(", "a", ")"],
    ["[", "1", "]"],
    ["{", "1", "}"],
    ["f(", "x", ")"],
    ["a[", "1", "]"],
    ["-", "1", ""],
    ["not ", "b", ""],
    ["2^", "x", ""],
    ["1 + ", "x", ""],
    ["a.", "b", ""],
    ["a, ", "b", ""],
    ["if c then ", "a", " else b"],
    ["if c then\n", "x := 1;", "\nend if;\n"],
    ["elsif c then ", "x := 1;", ""],
    ["for i in 1..2 loop\n", "a -> b;", "\nend loop;\n"],
    ["sum(i in 1..2 : ", "i", ")"],
    ["location A\n", "", "end location;\n"],
    ["CTC C is body ", "", " end body;\n"],
    ["dynamics ", "x = 1;", " end dynamics;\n"],
    ["declarations ", "state x;", ""],
    ["event(S) positive-to-negative ", "", " end event;\n"],
    ["when a do ", "x := 1;", " end when;\n"],
    ["end ", "", ""],
    ["%", "", "\n"],
    ["# ", "", ""],
    [")", "", ""],
    ["x = 1\n", "", ""],
    ["'", "a", ""],
    [";", "", ""],
];

const XML_NESTS: &[[&str; 3]] = &[
    ["<location>", "", "</location>"],
    ["<location>", "<name>A</name>", ""],
    ["<state a=\"1\">", "x", "</state>"],
    ["</name>", "", ""],
    ["<!--", "", "-->"],
    ["<![CDATA[", "", "]]>"],
    ["&lt;", "", ""],
    ["&x;", "", ""],
    ["<!ENTITY e \"&f;&f;\">", "", ""],
    ["<", "", ""],
    [">", "", ""],
    ["&", "", ""],
    ["<a b=", "", ">"],
    ["<a b=\"", "", ""],
    ["<?a ", "", "?>"],
    ["<!DOCTYPE a [", "", "]>"],
    ["(", "x", ")"],
    ["-", "1", ""],
    ["not ", "b", ""],
    ["\n", "", ""],
];

const STRANGE: &[&str] =
    &["é", "😀", "\u{feff}", "\u{a0}", "\u{0}", "\u{2028}", "e\u{301}", "\u{10ffff}", "√", "\u{202e}", "ß"];

const INVALID: &[&[u8]] =
    &[b"\xff", b"\xc0\x80", b"\xed\xa0\x80", b"\xe2\x82", b"\xf0\x9f\x98", b"\x80", b"\xfe\xff"];

/// The indices of what once broke something: the last ones.
pub(crate) fn broken(corpus: &Corpus) -> Range<u64> {
    u64::MAX - corpus.broken.len() as u64..u64::MAX
}

/// Input `index` of the campaign `seed`. The first inputs are the files of the corpus as they are.
pub(crate) fn input(corpus: &Corpus, seed: u64, index: u64) -> Vec<u8> {
    let place = |index: u64| usize::try_from(index).unwrap_or(usize::MAX);
    if let Some(file) = corpus.files.get(place(index)) {
        return file.clone();
    }
    if let Some((_, text)) = corpus.broken.get(place(u64::MAX - 1 - index)) {
        return text.clone();
    }
    let mut random = Random::new(seed, index);
    let mut text = if random.once_in(12) { soup(corpus, &mut random) } else { mutant(corpus, &mut random) };
    if random.once_in(LONG_ONCE_IN) {
        text = long(corpus, &mut random, &text);
    }
    if random.once_in(3) {
        for _ in 0..=random.below(3) {
            change_bytes(&mut text, &mut random);
        }
    }
    text.truncate(LONGEST);
    text
}

/// Words without a plan.
fn soup(corpus: &Corpus, random: &mut Random) -> Vec<u8> {
    let mut text = Vec::new();
    for _ in 0..random.length(200) {
        text.extend_from_slice(random.pick(&corpus.words).map_or(b"x", Vec::as_slice));
        if !random.once_in(4) {
            text.push(b' ');
        }
    }
    text
}

/// A piece of the corpus, or some words in a row of it, with a few words changed.
fn mutant(corpus: &Corpus, random: &mut Random) -> Vec<u8> {
    let Some(piece) = random.pick(&corpus.pieces) else { return Vec::new() };
    let mut parts = tokens(piece);
    // Cut it down, mostly: small inputs are many inputs.
    if parts.len() > 80 && !random.once_in(20) {
        let length = 20 + random.below(100);
        let start = random.below(parts.len().saturating_sub(length));
        parts = parts.into_iter().skip(start).take(length).collect();
    }
    for _ in 0..random.length(8) {
        change_words(corpus, &mut parts, random);
    }
    let mut text = parts.concat();
    if random.once_in(6) {
        text = in_a_whole(corpus.notation, &text);
    }
    text
}

/// What surrounds a part of a file.
fn in_a_whole(notation: Notation, part: &[u8]) -> Vec<u8> {
    let (before, after): (&[u8], &[u8]) = match notation {
        Notation::Hsml => (b"CTC C is\nbody\n", b"\nend body;\n"),
        Notation::Xml => (b"<SophySystem>", b"</SophySystem>\n"),
    };
    [before, part, after].concat()
}

fn change_words<'c>(corpus: &'c Corpus, parts: &mut Vec<&'c [u8]>, random: &mut Random) {
    let (at, other) = (random.below(parts.len()), random.below(parts.len()));
    let (start, length) = (at, 1 + random.length(12));
    let end = (start + length).min(parts.len());
    match random.below(12) {
        0 if at < parts.len() => {
            parts.remove(at);
        }
        1 if at < parts.len() => parts.insert(at, parts[at]),
        2 if at + 1 < parts.len() => parts.swap(at, at + 1),
        3 if !parts.is_empty() => parts.swap(at, other),
        4 => {
            parts.drain(start..end);
        }
        5 => {
            let chunk = parts[start..end].repeat(1 + random.length(6));
            parts.splice(other..other, chunk);
        }
        6 => {
            let Some(piece) = random.pick(&corpus.pieces) else { return };
            let words = tokens(piece);
            let from = random.below(words.len());
            let many = random.length(60);
            if random.once_in(2) {
                parts.truncate(at);
            }
            let at = at.min(parts.len());
            parts.splice(at..at, words.into_iter().skip(from).take(many));
        }
        7 | 8 => {
            if let Some(space) = random.pick(SPACES)
                && let Some(place) = (at..parts.len()).find(|&place| is_space(parts[place]))
            {
                parts[place] = space.as_bytes();
            }
        }
        9 => {
            if let (Some(word), Some(part)) = (random.pick(&corpus.words), parts.get_mut(at)) {
                *part = word;
            }
        }
        _ => {
            if let Some(word) = random.pick(&corpus.words) {
                parts.insert(at, word);
            }
        }
    }
}

/// A long input: a nest, or the same chunk again and again.
fn long(corpus: &Corpus, random: &mut Random, text: &[u8]) -> Vec<u8> {
    let most = 1000 + random.below(LONGEST - 1000);
    let nests = match corpus.notation {
        Notation::Hsml => HSML_NESTS,
        Notation::Xml => XML_NESTS,
    };
    let middle = random.below(text.len() + 1);
    let (before, after) = text.split_at(middle);
    match random.pick(nests) {
        Some([open, inner, close]) if random.once_in(2) => {
            let levels = most / (open.len() + close.len()).max(1);
            let close = if random.once_in(4) { String::new() } else { close.repeat(levels) };
            [before, open.repeat(levels).as_bytes(), inner.as_bytes(), close.as_bytes(), after].concat()
        }
        _ => {
            let start = random.below(text.len());
            let end = start + 1 + random.below(text.len().saturating_sub(start));
            let chunk = text.get(start..end).unwrap_or(b"a");
            let chunk = if chunk.is_empty() { b"a" } else { chunk };
            [before, &chunk.repeat(most / chunk.len()), after].concat()
        }
    }
}

fn change_bytes(text: &mut Vec<u8>, random: &mut Random) {
    let at = random.below(text.len() + 1);
    let end = (at + random.length(16)).min(text.len());
    let insert = |text: &mut Vec<u8>, what: &[u8]| drop(text.splice(at..at, what.iter().copied()));
    match random.below(12) {
        0 | 1 => {
            if let Some(byte) = text.get_mut(at) {
                *byte ^= 1 << random.below(8);
            }
        }
        2 => {
            if let Some(byte) = text.get_mut(at) {
                *byte = random.byte();
            }
        }
        3 => {
            let bytes: Vec<u8> = (0..random.length(8)).map(|_| random.byte()).collect();
            insert(text, &bytes);
        }
        4 => drop(text.drain(at..end)),
        5 | 6 => {
            if let Some(strange) = random.pick(STRANGE) {
                insert(text, strange.as_bytes());
            }
        }
        7 => {
            if let Some(bytes) = random.pick(INVALID) {
                insert(text, bytes);
            }
        }
        8 => text.truncate(at),
        9 => {
            let digit = [b'0' + random.below(10) as u8];
            insert(text, &digit.repeat(random.length(400)));
        }
        10 => {
            // Another line end, or another encoding.
            if random.once_in(2) {
                *text = text.split(|&byte| byte == b'\n').collect::<Vec<_>>().join(&b"\r\n"[..]);
            } else {
                let little = random.once_in(2);
                let units = String::from_utf8_lossy(text).encode_utf16().collect::<Vec<u16>>();
                let units = std::iter::once(0xfeff).chain(units);
                *text = units
                    .flat_map(|unit| if little { unit.to_le_bytes() } else { unit.to_be_bytes() })
                    .collect();
            }
        }
        _ => drop(text.splice(0..0, *b"\xef\xbb\xbf")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corpus() -> Corpus {
        let file = "CTC C is\nbody\n  dynamics\n    der(x) = -x;\n  end dynamics;\nend body;\n";
        Corpus::new(Notation::Hsml, vec![file.into()])
    }

    #[test]
    fn an_input_depends_on_seed_and_index_only() {
        let corpus = corpus();
        for index in 0..200 {
            assert_eq!(input(&corpus, 7, index), input(&corpus, 7, index));
        }
        let differ = (1..200).filter(|&index| input(&corpus, 7, index) != input(&corpus, 8, index)).count();
        assert!(differ > 150, "{differ}");
    }

    #[test]
    fn inputs_are_small_large_and_now_and_then_sound() {
        let corpus = corpus();
        let mut lengths = Vec::new();
        let mut sound = 0;
        for index in 0..20_000 {
            let text = input(&corpus, 1, index);
            lengths.push(text.len());
            if let Ok(text) = std::str::from_utf8(&text) {
                sound += usize::from(text.len() > 20 && sophy_syntax::parse_file(text).errors().is_empty());
            }
        }
        lengths.sort_unstable();
        assert!((40..400).contains(&lengths[10_000]), "median {}", lengths[10_000]);
        assert!(lengths[19_999] > 20_000, "longest {}", lengths[19_999]);
        assert!(lengths[19_999] <= LONGEST);
        assert!(sound > 500, "{sound}");
    }
}
