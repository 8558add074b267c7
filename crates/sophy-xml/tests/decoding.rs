//! Text and attributes are decoded as roxmltree does, and every byte knows its place.

use proptest::prelude::*;
use sophy_analysis::TriggerDeclaration;
use sophy_diagnostics::Sources;
use sophy_xml::read;

const ENTITIES: &str =
    "<!DOCTYPE SophySystem [<!ENTITY one 'x &gt; y'><!ENTITY two '&one; + &one;'><!ENTITY é 'abcd'>]>";

fn document(attribute: &str, text: &str) -> String {
    format!(
        "{ENTITIES}<SophySystem><name>S</name><hints><hint hintname='free'>{text}</hint></hints>\
         <states><state documentation='{attribute}'>x</state></states><inputs/><outputs/>\
         <locations><location><name>A</name><transitions><transition><name>T</name><domain>{text}</domain>\
         <reset><destination>A</destination></reset></transition></transitions></location></locations></SophySystem>"
    )
}

/// Pieces of text that decode to something else, and some that do not.
fn pieces(in_text: bool) -> impl Strategy<Value = String> {
    let mut pieces = vec![
        "a", "é", " b ", "&lt;", "&gt;", "&amp;", "&quot;", "&apos;", "&#65;", "&#x3C4;", "&#13;", "&#10;",
        "\r\n", "\n", "\t", "&one;", "&two;", "&é;", ">", "𝄞",
    ];
    if in_text {
        pieces.extend(["<!-- c -->", "<![CDATA[<&>]]>", "<![CDATA[a\r\nb]]>", "<?pi?>", "'", "\""]);
    }
    prop::collection::vec(prop::sample::select(pieces), 0..8).prop_map(|pieces| pieces.concat())
}

/// Where roxmltree is wrong: XML 1.0, section 2.11, makes every line end a newline.
#[test]
fn a_lone_carriage_return_is_a_line_end() {
    let file = document("a\rb", "a\r&lt;\r\n\rb");
    let reading = read(&mut Sources::default(), "m.xml", file.as_bytes());
    let ours = &reading.declarations.expect("a system").components[0];
    assert_eq!(ours.hints[0].1.value, "a\n<\n\nb");
    assert_eq!(ours.variables[0].documentation, "a b");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn text_is_decoded_as_the_standard_says(attribute in pieces(false), text in pieces(true)) {
        let file = document(&attribute, &text);
        let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
        let judge = roxmltree::Document::parse_with_options(&file, options).expect("well-formed");
        let find = |name: &str| judge.descendants().find(|node| node.has_tag_name(name)).expect("it is there");
        let text_of = |name: &str| {
            find(name).children().filter(roxmltree::Node::is_text).filter_map(|child| child.text()).collect::<String>()
        };
        let mut sources = Sources::default();
        let reading = read(&mut sources, "m.xml", file.as_bytes());
        let ours = &reading.declarations.expect("a system").components[0];
        let (hint, domain) = (text_of("hint"), text_of("domain"));
        prop_assert_eq!(&ours.hints[0].1.value, hint.trim());
        let documentation = find("state").attribute("documentation").expect("it is there");
        prop_assert_eq!(&ours.variables[0].documentation, documentation.trim());

        let TriggerDeclaration::When(Some(guard)) = &ours.locations[0].transitions[0].trigger else {
            panic!("a domain")
        };
        prop_assert_eq!(&*guard.text, domain.trim());
        for (at, c) in guard.text.char_indices() {
            let place = sources.excerpt(guard.map.span(at..at + c.len_utf8()));
            let as_is = place == c.encode_utf8(&mut [0; 4]);
            prop_assert!(as_is || place.starts_with('&') || (c == '\n' && place.starts_with('\r')), "{} {:?}", c, place);
        }
    }
}
