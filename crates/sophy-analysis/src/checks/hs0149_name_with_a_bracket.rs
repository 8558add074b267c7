//! The name of a variable, port or member contains a bracket or a point. Elements of vectors and arrays are named with
//! brackets and parts of components with a point: `'a[1]'` could not be told from the first element of `a`.

use crate::declarations::Spanned;
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0149");

pub(crate) fn find(name: &Spanned<String>) -> Option<Diagnostic> {
    let found = name.value.chars().find(|c| matches!(c, '[' | ']' | '.'))?;
    let (what, meaning) = match found {
        '.' => ("a point", "a point stands between a component and its part"),
        _ => ("a bracket", "brackets stand around the index of an element"),
    };
    let better: String = name
        .value
        .chars()
        .filter(|c| *c != ']')
        .map(|c| if matches!(c, '[' | '.') { '_' } else { c })
        .collect();
    let error = Diagnostic::error(CODE, name.span, format!("the name `{}` contains {what}", name.value))
        .note(meaning);
    Some(error.help(format!("call it `{better}`, say")))
}
