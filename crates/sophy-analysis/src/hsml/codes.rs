use sophy_diagnostics::Code;

/// Every code of the reader of HSML with the kind of mistake it names.
pub const HSML_CODES: &[(Code, &str)] = &[
    (TOO_LARGE, "the file is larger than a model can be"),
    (NOT_UTF8, "the file is not UTF-8"),
    (NOT_TEXT, "the file is no text"),
    (TWICE, "a part of a component stands twice"),
    (BOUNDS, "a range has not two bounds"),
    (CONDITIONAL_CONSTRAINT, "a constraint stands in an `if` or a loop"),
    (NO_FLAG, "an event section names no flag"),
    (ASSIGNED, "the left side of an assignment is no variable"),
    (ELSE, "an `else` is not the last part of an `if`"),
    (MISPLACED, "a declaration of a body stands in a location"),
];

pub(super) const TOO_LARGE: Code = Code("HS0081");
pub(super) const NOT_UTF8: Code = Code("HS0082");
pub(super) const NOT_TEXT: Code = Code("HS0083");
pub(super) const TWICE: Code = Code("HS0084");
pub(super) const BOUNDS: Code = Code("HS0085");
pub(super) const CONDITIONAL_CONSTRAINT: Code = Code("HS0086");
pub(super) const NO_FLAG: Code = Code("HS0087");
pub(super) const ASSIGNED: Code = Code("HS0088");
pub(super) const ELSE: Code = Code("HS0089");
pub(super) const MISPLACED: Code = Code("HS0090");
