//! Whatever the bytes: no panic, an end soon, and places that exist.

use proptest::prelude::*;
use sophy_diagnostics::{Sources, Style, render};
use sophy_xml::read;
use std::time::{Duration, Instant};

const FILES: [&str; 4] = [
    include_str!("../../../examples/hopper/hopper.xml"),
    include_str!("../../../examples/battery/battery.xml"),
    include_str!("../../../tests/suite/xml/paper_battery.xml"),
    include_str!("../../../tests/reference/xmllint/base.xml"),
];

fn survives(bytes: &[u8]) {
    survives_and_is_drawn(bytes, 10);
}

/// Draws the first `drawn` messages, which takes long on lines of a megabyte.
fn survives_and_is_drawn(bytes: &[u8], drawn: usize) {
    let mut sources = Sources::default();
    let start = Instant::now();
    let reading = read(&mut sources, "m.xml", bytes);
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
    assert!(reading.declarations.is_some() || reading.diagnostics.has_errors());
    for diagnostic in reading.diagnostics.iter().take(drawn) {
        for label in &diagnostic.labels {
            let text = sources.text(label.span.source);
            assert!(text.get(label.span.range()).is_some(), "{diagnostic:?}");
        }
        assert!(!render(diagnostic, &sources, Style::Plain).is_empty());
    }
}

/// What a mistake may put in.
const SCRAPS: [&str; 28] = [
    "<",
    ">",
    "&",
    "\"",
    "'",
    "/",
    "</",
    "/>",
    "<!--",
    "-->",
    "<![CDATA[",
    "]]>",
    "<?",
    "?>",
    "&#",
    "&#x;",
    "&lt",
    "&e;",
    "<!DOCTYPE SophySystem [<!ENTITY e '<name>é'>]>",
    "<!DOCTYPE",
    "<state>",
    "</location>",
    "<name a=",
    "é",
    "\u{1}",
    "\r\n",
    "]",
    "",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn random_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        survives(&bytes);
    }

    #[test]
    fn random_scraps(scraps in prop::collection::vec(prop::sample::select(SCRAPS.to_vec()), 0..40)) {
        survives(scraps.concat().as_bytes());
    }

    #[test]
    fn changed_files(
        file in prop::sample::select(FILES.to_vec()),
        changes in prop::collection::vec(
            (any::<prop::sample::Index>(), 0_usize..30, prop::sample::select(SCRAPS.to_vec())),
            1..6,
        ),
    ) {
        let mut bytes = file.as_bytes().to_vec();
        for (at, length, scrap) in changes {
            let start = at.index(bytes.len());
            let end = (start + length).min(bytes.len());
            bytes.splice(start..end, scrap.bytes());
        }
        survives(&bytes);
    }
}

/// Patterns that make careless readers slow, or run out of stack or memory.
#[test]
fn large_and_malicious_files() {
    let check = |bytes: &[u8]| survives_and_is_drawn(bytes, 0);
    let many = |pattern: &str| pattern.repeat((1 << 20) / pattern.len());
    for pattern in [
        "<a>",
        "</a>",
        "<a ",
        "<a b=\"",
        "<a b='> ",
        "&",
        "&lt;",
        "&#",
        "<!--",
        "<![CDATA[",
        "<?a ",
        "<!DOCTYPE a [",
        "<",
        "\r",
        "]]>",
        "<!ENTITY a 'a'>",
    ] {
        check(many(pattern).as_bytes());
        check(format!("<SophySystem><name>{}", many(pattern)).as_bytes());
        check(format!("<!DOCTYPE SophySystem [{}", many(pattern)).as_bytes());
    }
    check(format!("<SophySystem{}/>", many(" a='b'")).as_bytes());
    let attributes: String = (0..100_000).map(|n| format!(" a{n}=''")).collect();
    check(format!("<SophySystem{attributes}/>").as_bytes());
    check(format!("<SophySystem>{}</SophySystem>", many("<states/>")).as_bytes());
    check(
        format!("<SophySystem><locations><location>{}</location>", many("<outputmap/><diffequation/>"))
            .as_bytes(),
    );
    check(format!("<SophySystem><name>{}</name></SophySystem>", many("a&lt;")).as_bytes());
    check(format!("<SophySystem><name>{}</name></SophySystem>", many("a<!---->")).as_bytes());
}

#[test]
fn entities_cannot_grow_without_bound() {
    let mut declarations = "<!ENTITY e0 'ha'>".to_owned();
    for n in 1..30 {
        declarations.push_str(&format!("<!ENTITY e{n} '&e{0};&e{0};&e{0};&e{0};'>", n - 1));
    }
    let refused = |text: String| {
        let reading = read(&mut Sources::default(), "m.xml", text.as_bytes());
        assert!(reading.diagnostics.iter().any(|d| d.code.0 == "SX0004"), "{:?}", reading.diagnostics);
    };
    for use_of in
        ["<SophySystem>&e10;</SophySystem>", "<SophySystem>&e29;</SophySystem>", "<SophySystem a='&e29;'/>"]
    {
        refused(format!("<!DOCTYPE SophySystem [{declarations}]>{use_of}"));
    }
    // One large text, many times.
    let (large, often) = ("ha".repeat(10_000), "&e;".repeat(1000));
    refused(format!("<!DOCTYPE SophySystem [<!ENTITY e '{large}'>]><SophySystem>{often}</SophySystem>"));
}
