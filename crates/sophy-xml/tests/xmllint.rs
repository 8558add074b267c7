//! The content model against xmllint's opinion of several hundred changed documents
//! (`tests/reference/xmllint`, with the script that made them).

use sophy_diagnostics::{Severity, Sources};

const BASE: &str = include_str!("../../../tests/reference/xmllint/base.xml");
const VERDICTS: &str = include_str!("../../../tests/reference/xmllint/verdicts.tsv");

/// Codes of errors against XML and against the definition; those about names and expressions xmllint cannot know.
fn refused(document: &str) -> Vec<&'static str> {
    let reading = sophy_xml::read(&mut Sources::default(), "mutated.xml", document.as_bytes());
    let errors = reading.diagnostics.iter().filter(|d| d.severity == Severity::Error).map(|d| d.code.0);
    errors.filter(|code| code.starts_with("SX01") || code.starts_with("SX02")).collect()
}

#[test]
fn errors_stand_exactly_where_xmllint_finds_one() {
    let mut differences = Vec::new();
    for line in VERDICTS.lines() {
        let mut fields = line.splitn(4, '\t');
        let mut field = || fields.next().expect("four fields");
        let verdict = field();
        let (start, length): (usize, usize) =
            (field().parse().expect("start"), field().parse().expect("length"));
        let replacement = field().replace("\\n", "\n");
        let document = format!("{}{replacement}{}", &BASE[..start], &BASE[start + length..]);
        let codes = refused(&document);
        // The kind of mistake agrees, too.
        let agrees = match verdict {
            "valid" => codes.is_empty(),
            "invalid" => codes.iter().any(|code| code.starts_with("SX02")),
            _ => codes.iter().any(|code| code.starts_with("SX01")),
        };
        if !agrees {
            differences.push(format!("{line}\n    we say {codes:?}"));
        }
    }
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}
