//! An argument of a predefined function that it cannot use.

use super::suggestion::suggest;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0220");

/// A text in double quotes is needed.
pub(crate) fn no_string(span: Span, name: &str, what: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{name}` needs a text in double quotes here"))
        .help(format!("write {what}"))
}

/// A word after the arguments is none of those allowed.
pub(crate) fn no_option(span: Span, written: &str, allowed: &[&str]) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{written}` is not a way to read a file"))
        .help(suggest(written, allowed, "words that may stand here").help)
}

/// `what` has an impossible value.
pub(crate) fn out_of_range(span: Span, what: &str, number: f64) -> Diagnostic {
    let range = match what {
        "a probability" => "between 0 and 1",
        "a standard deviation" => "0 or more",
        "the delay of a rule" | "`tdelay`" => "0 s or more",
        "a rate" => "0 or more, in 1/s",
        _ => "more than 0 s",
    };
    Diagnostic::error(CODE, span, format!("{what} cannot be {number}")).help(format!("it must be {range}"))
}

/// `what` must not change during a run.
pub(crate) fn varies(span: Span, what: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("{what} cannot change during a run"))
        .help("use numbers, constants and parameters only; multiply the noise by what changes")
}

/// The table has no value there.
pub(crate) fn outside_table(span: Span, file: &str, x: f64, ends: (Option<f64>, Option<f64>)) -> Diagnostic {
    let error = Diagnostic::error(CODE, span, format!("`{file}` has no value at {x}"));
    match ends {
        (Some(low), Some(high)) => error.help(format!("its range is {low} to {high}")),
        _ => error,
    }
}

/// `data(…)` within an expression.
pub(crate) fn data_inside(span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, "`data` gives a record, which cannot be part of an expression")
        .help("name it, `constant vehicle = data(\"vehicle.toml\");`, and use `vehicle.mass`")
}

/// The matrix has no inverse.
pub(crate) fn singular(span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, "this matrix has no inverse: its determinant is 0")
        .help("check its elements; with other values of its parameters it may have one")
}
