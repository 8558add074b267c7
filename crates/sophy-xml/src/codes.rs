use sophy_diagnostics::Code;

/// Every code of this crate with the kind of mistake it names.
///
/// `SX00` is about the file, `SX01` about XML as such, `SX02` about the document type definition, `SX03`
/// about what the definition cannot say and hints do, `SX04` about what is to be written as SOPHY XML.
pub const CODES: &[(Code, &str)] = &[
    (TOO_LARGE, "the file is larger than a model can be"),
    (NOT_UTF8, "the file is not UTF-8"),
    (TOO_DEEP, "elements are nested too deeply"),
    (EXPANSION, "entities expand without bound"),
    (TOO_MANY_NODES, "the file has too many elements"),
    (MISSPELLED_DECLARATION, "the XML declaration is misspelled"),
    (OTHER_INSTRUCTION, "a processing instruction is ignored"),
    (BAD_DECLARATION, "the XML declaration is not as it should be"),
    (MISMATCHED_TAG, "a closing tag has another name than the opening tag"),
    (UNCLOSED_ELEMENT, "an element is not closed"),
    (STRAY_CLOSING_TAG, "a closing tag closes nothing"),
    (BARE_LESS_THAN, "a `<` is not written `&lt;`"),
    (BARE_AMPERSAND, "a `&` is not written `&amp;`"),
    (UNKNOWN_ENTITY, "an entity is not declared"),
    (BAD_CHARACTER, "a character is not allowed in XML"),
    (MALFORMED_TAG, "a tag is malformed"),
    (DUPLICATE_ATTRIBUTE, "an attribute stands twice"),
    (UNTERMINATED, "a comment, instruction or section does not end"),
    (BAD_COMMENT, "a comment contains `--`"),
    (BARE_SECTION_END, "`]]>` stands in text"),
    (OUTSIDE_ROOT, "something stands outside the root element"),
    (NO_ROOT, "there is no root element"),
    (EXTERNAL_ENTITY, "an entity is in another file"),
    (DOCTYPE, "the document type is not `SophySystem`, or is elsewhere"),
    (INTERNAL_DECLARATION, "a declaration in the document type is ignored"),
    (UNBALANCED_ENTITY, "an entity opens or closes an element it does not contain"),
    (NOT_WELL_FORMED, "the file is not well-formed XML"),
    (UNKNOWN_ELEMENT, "an element is not one of SOPHY XML"),
    (MISPLACED_ELEMENT, "an element stands in the wrong place"),
    (WRONG_ORDER, "elements are in the wrong order"),
    (MISSING_ELEMENT, "an element is missing"),
    (REPEATED_ELEMENT, "an element stands more than once"),
    (MISSING_ATTRIBUTE, "an attribute is missing"),
    (UNKNOWN_ATTRIBUTE, "an element does not have this attribute"),
    (STRAY_TEXT, "text stands between elements"),
    (MISSPELLED_ELEMENT, "a known misprint of an element's name"),
    (EMPTY_NAME, "a name is empty"),
    (NEAR_HINT, "a hint is almost one that has a meaning"),
    (BAD_HINT, "a hint cannot be understood"),
    (SECOND_INITIAL_LOCATION, "the first location is named twice"),
    (UNSAYABLE, "SOPHY XML has no words for a part of the model"),
    (RESTATED, "SOPHY XML says a part of the model in other words"),
];

pub(crate) const TOO_LARGE: Code = Code("SX0001");
pub(crate) const NOT_UTF8: Code = Code("SX0002");
pub(crate) const TOO_DEEP: Code = Code("SX0003");
pub(crate) const EXPANSION: Code = Code("SX0004");
pub(crate) const TOO_MANY_NODES: Code = Code("SX0005");

pub(crate) const MISSPELLED_DECLARATION: Code = Code("SX0101");
pub(crate) const OTHER_INSTRUCTION: Code = Code("SX0102");
pub(crate) const BAD_DECLARATION: Code = Code("SX0103");
pub(crate) const MISMATCHED_TAG: Code = Code("SX0104");
pub(crate) const UNCLOSED_ELEMENT: Code = Code("SX0105");
pub(crate) const STRAY_CLOSING_TAG: Code = Code("SX0106");
pub(crate) const BARE_LESS_THAN: Code = Code("SX0107");
pub(crate) const BARE_AMPERSAND: Code = Code("SX0108");
pub(crate) const UNKNOWN_ENTITY: Code = Code("SX0109");
pub(crate) const BAD_CHARACTER: Code = Code("SX0110");
pub(crate) const MALFORMED_TAG: Code = Code("SX0111");
pub(crate) const DUPLICATE_ATTRIBUTE: Code = Code("SX0112");
pub(crate) const UNTERMINATED: Code = Code("SX0113");
pub(crate) const BAD_COMMENT: Code = Code("SX0114");
pub(crate) const BARE_SECTION_END: Code = Code("SX0115");
pub(crate) const OUTSIDE_ROOT: Code = Code("SX0116");
pub(crate) const NO_ROOT: Code = Code("SX0117");
pub(crate) const EXTERNAL_ENTITY: Code = Code("SX0118");
pub(crate) const DOCTYPE: Code = Code("SX0119");
pub(crate) const INTERNAL_DECLARATION: Code = Code("SX0120");
pub(crate) const UNBALANCED_ENTITY: Code = Code("SX0121");
pub(crate) const NOT_WELL_FORMED: Code = Code("SX0199");

pub(crate) const UNKNOWN_ELEMENT: Code = Code("SX0201");
pub(crate) const MISPLACED_ELEMENT: Code = Code("SX0202");
pub(crate) const WRONG_ORDER: Code = Code("SX0203");
pub(crate) const MISSING_ELEMENT: Code = Code("SX0204");
pub(crate) const REPEATED_ELEMENT: Code = Code("SX0205");
pub(crate) const MISSING_ATTRIBUTE: Code = Code("SX0206");
pub(crate) const UNKNOWN_ATTRIBUTE: Code = Code("SX0207");
pub(crate) const STRAY_TEXT: Code = Code("SX0208");
pub(crate) const MISSPELLED_ELEMENT: Code = Code("SX0209");

pub(crate) const EMPTY_NAME: Code = Code("SX0301");
pub(crate) const NEAR_HINT: Code = Code("SX0302");
pub(crate) const BAD_HINT: Code = Code("SX0303");
pub(crate) const SECOND_INITIAL_LOCATION: Code = Code("SX0304");

pub(crate) const UNSAYABLE: Code = Code("SX0401");
pub(crate) const RESTATED: Code = Code("SX0402");

#[cfg(test)]
mod tests {
    use super::CODES;

    #[test]
    fn codes_are_in_order_and_stand_once() {
        assert!(CODES.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }
}
