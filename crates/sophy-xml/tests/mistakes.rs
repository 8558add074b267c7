//! Every kind of mistake: where it is, what it is called, and that nothing else is said.

use sophy_diagnostics::{Sources, Style, render};
use sophy_xml::{CODES, read, write};
use std::collections::BTreeSet;

/// `line:column code message` of each diagnostic, in the order of places.
fn report(bytes: &[u8]) -> String {
    let mut sources = Sources::default();
    let reading = read(&mut sources, "m.xml", bytes);
    let mut lines = String::new();
    for diagnostic in reading.diagnostics.sorted(&sources) {
        let rendered = render(&diagnostic, &sources, Style::Plain);
        assert!(rendered.contains(diagnostic.code.0), "{rendered}");
        let place = diagnostic.span().map(|span| sources.line_column(span.source, span.start));
        let place = place.map_or_else(String::new, |place| place.to_string());
        lines +=
            &format!("{place} {} {} {}\n", diagnostic.severity.name(), diagnostic.code, diagnostic.message);
        for way_out in &diagnostic.helps {
            lines += &format!("    {way_out}\n");
        }
    }
    lines
}

/// A system of one location on lines 2 to 6, with some parts replaced.
fn system(replacements: &[(&str, &str)]) -> String {
    let mut text = "<?xml version=\"1.0\"?>\n<SophySystem><name>S</name>\n<states><state>x</state></states>\
        <inputs/><outputs/>\n<locations><location><name>A</name>\
        <diffequation state=\"x\">-x</diffequation>\n<transitions><transition><name>T</name>\
        <domain>x &lt; 1</domain>\n<reset><destination>A</destination></reset></transition></transitions>\
        </location></locations></SophySystem>\n"
        .to_owned();
    for (old, new) in replacements {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    text
}

const CASES: &[(&str, &[(&str, &str)])] = &[
    ("none", &[]),
    ("the declaration is misspelled", &[("<?xml", "<?rxml")]),
    ("another instruction", &[("<inputs/>", "<?php echo?><inputs/>")]),
    ("the declaration comes late", &[("<?xml", "\n<?xml")]),
    ("the declaration names another encoding", &[("\"?>", "\" encoding='ISO-8859-1'?>")]),
    ("the closing tag has a typing error", &[("</domain>", "</domian>")]),
    ("the closing tag is of another element", &[("</domain>", "</destination>")]),
    ("the opening tag has a typing error", &[("<domain>", "<domian>")]),
    ("one closing tag is missing", &[("</diffequation>", "")]),
    ("two closing tags are missing", &[("</reset></transition>", "")]),
    ("the file is cut off", &[("</transitions></location></locations></SophySystem>", "")]),
    ("a closing tag too many", &[("</transitions>", "</transitions></transition>")]),
    ("a bare less-than", &[("&lt;", "<")]),
    ("a bare less-than before a name", &[("x &lt; 1", "1 <x")]),
    ("a bare less-or-equal, and an error of syntax after it", &[("x &lt; 1", "x <= 1)")]),
    ("bare ampersands", &[("x &lt; 1", "x > 1 && x > 2")]),
    ("a reference without semicolon", &[("&lt; 1", "&lt 1")]),
    ("a malformed character reference", &[("&lt;", "&#xZ;")]),
    (
        "an unknown entity",
        &[
            ("-x", "-&gama;*x"),
            ("<SophySystem>", "<!DOCTYPE SophySystem [<!ENTITY gamma '2'>]><SophySystem>"),
        ],
    ),
    ("a control character", &[("-x", "-\u{1}x")]),
    ("a reference to a character that XML does not have", &[("-x", "-x&#1;")]),
    ("a tag without end", &[("<domain>", "<domain\n>"), ("<reset>", "<reset ")]),
    ("an attribute without quotes", &[("\"x\"", "x")]),
    ("an attribute without a value", &[("state=\"x\"", "state")]),
    ("an attribute without its closing quote", &[("\"x\">", "\"x>")]),
    ("a less-than in an attribute", &[("<state>", "<state documentation='x < 1'>")]),
    ("an attribute twice", &[("state=\"x\"", "state=\"x\" state=\"y\"")]),
    ("a comment without end", &[("</location>", "<!-- </location>")]),
    ("a line in a comment", &[("<inputs/>", "<!-- ------ --><inputs/>")]),
    ("the end of a section in text", &[("-x", "-x]]>")]),
    ("text after the root", &[("</SophySystem>", "</SophySystem> the end")]),
    ("two systems", &[("</SophySystem>", "</SophySystem><SophySystem/>")]),
    (
        "another document type",
        &[("<SophySystem>", "<!DOCTYPE Sophy SYSTEM 'http://x/other.dtd'><SophySystem>")],
    ),
    (
        "an external entity",
        &[
            ("<SophySystem>", "<!DOCTYPE SophySystem [<!ENTITY e SYSTEM '/etc/passwd'>]><SophySystem>"),
            ("-x", "&e;"),
        ],
    ),
    (
        "declarations that are ignored",
        &[("<SophySystem>", "<!DOCTYPE SophySystem [<!ELEMENT a ANY><!ENTITY % p 'q'>]><SophySystem>")],
    ),
    (
        "an entity that does not close what it opens",
        &[
            ("<SophySystem>", "<!DOCTYPE SophySystem [<!ENTITY e '<inputs>'>]><SophySystem>"),
            ("<inputs/>", "&e;"),
        ],
    ),
    (
        "an entity that contains itself",
        &[
            ("<SophySystem>", "<!DOCTYPE SophySystem [<!ENTITY e 'x&f;'><!ENTITY f '&e;'>]><SophySystem>"),
            ("-x", "&e;"),
        ],
    ),
    ("what only the strict parser sees", &[("<inputs/>", "<inputs\u{A0}/>")]),
    ("an unknown element that is close to one", &[("<inputs/>", "<imputs><inptu>u</inptu></imputs>")]),
    ("an element without its group", &[("<inputs/>", "<input> </input>")]),
    ("an unknown element", &[("<inputs/>", "<inputs/><colour>red</colour>")]),
    (
        "an element in the wrong place, with a mistake inside",
        &[("<diffequation", "<transition><name>U</name></transition><diffequation")],
    ),
    (
        "wrong order",
        &[("<states><state>x</state></states><inputs/>", "<inputs/><states><state>x</state></states>")],
    ),
    ("a name at the end", &[("<name>A</name>", ""), ("</location>", "<name>A</name></location>")]),
    ("a missing element", &[("<destination>A</destination>", "")]),
    ("missing groups", &[("<inputs/><outputs/>", "")]),
    (
        "nothing in a group that wants something",
        &[("<inputs/>", "<inputs/><!-- -->"), ("<name>S</name>", "<name>S</name><constants/>")],
    ),
    ("an element twice", &[("<domain>", "<domain>1</domain><domain>")]),
    ("a missing attribute", &[(" state=\"x\"", "")]),
    ("a misnamed attribute", &[("state=\"x\"", "name=\"x\"")]),
    ("an attribute that is an element", &[("<location><name>A</name>", "<location name='A'>")]),
    ("an attribute for nothing", &[("<domain>", "<domain unit='m'>")]),
    ("text between elements", &[("<inputs/>", "<inputs/> and\n then ")]),
    ("a misprint", &[("</reset>", "</reset><inpuvent>a</inpuvent><outpuvent>b</outpuvent>")]),
    ("an empty name", &[("<name>T</name>", "<name> </name>")]),
    ("an empty expression", &[("x &lt; 1", " ")]),
    (
        "an error of syntax in an attribute's hint",
        &[("<states>", "<hints><hint hintname='initial x'>1 +</hint></hints><states>")],
    ),
    (
        "a hint that is almost one",
        &[(
            "<states>",
            "<hints><hint hintname='inital x'>1</hint><hint hintname='initially'>1</hint></hints><states>",
        )],
    ),
    (
        "hints that are incomplete",
        &[(
            "<states>",
            "<hints><hint hintname='unit'>m</hint><hint hintname='function f'>1</hint><hint hintname='function f(a,)'>1</hint></hints><states>",
        )],
    ),
    (
        "two first locations",
        &[(
            "<states>",
            "<hints><hint hintname='initial location'>A</hint><hint hintname='initial  location'>A</hint></hints><states>",
        )],
    ),
];

#[test]
fn each_mistake_has_its_place_and_its_way_out() {
    let mut all = String::new();
    for (name, replacements) in CASES {
        let text = system(replacements);
        all += &format!("--- {name}\n{}\n", report(text.as_bytes()).trim_end());
    }
    insta::assert_snapshot!(all);
}

#[test]
fn every_code_is_used() {
    let mut used = BTreeSet::new();
    let mut note = |bytes: &[u8]| {
        let reading = read(&mut Sources::default(), "m.xml", bytes);
        used.extend(reading.diagnostics.iter().map(|d| d.code));
    };
    for (_, replacements) in CASES {
        note(system(replacements).as_bytes());
    }
    note(&vec![b' '; (16 << 20) + 1]);
    note(b"\xFF");
    note(b"");
    note("<a>".repeat(1000).as_bytes());
    note(system(&[("<inputs/>", &"<a/>".repeat(1 << 20))]).as_bytes());
    for body in ["declarations flag S; end declarations;", "dynamics der(x) = 1; end dynamics;"] {
        let text = format!("CTC C is body {body} end body;");
        let declarations =
            sophy_analysis::read_hsml(&mut Sources::default(), "m.hsml", text.as_bytes()).declarations;
        let writing = write(&declarations.components[0], &[], &[]);
        used.extend(writing.diagnostics.iter().map(|d| d.code));
    }
    let unused: Vec<_> = CODES.iter().filter(|(code, _)| !used.contains(code)).collect();
    assert!(unused.is_empty(), "{unused:?}");
}
