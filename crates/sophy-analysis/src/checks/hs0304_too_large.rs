//! Functions that call one another several times multiply with every level, until the model is too large to be
//! handled.

use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0304");

pub(crate) fn diagnostic(span: Span, name: &str, largest: usize) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("with this call of `{name}` the model becomes too large"))
        .note(format!("functions are put in the place of their calls; a model may have {largest} operations"))
        .help("make an intermediate result an output, and use that")
}

/// Loops and arrays are written out.
pub(crate) fn expression(span: Span, largest: usize) -> Diagnostic {
    Diagnostic::error(CODE, span, "with this the component becomes too large")
        .note(format!(
            "functions, loops and arrays are written out; a component may have {largest} operations"
        ))
        .help("make it smaller, or divide it among several components")
}

#[cfg(test)]
mod tests {
    use crate::testing::errors_of;

    #[test]
    fn functions_that_double_are_stopped() {
        let mut text = "function f0(x) = sin(x) + x\n".to_owned();
        for level in 1..40 {
            let below = level - 1;
            text += &format!("function f{level}(x) = f{below}(x + 1) * f{below}(x*x)\n");
        }
        text += "state x\nlocation A\n der x = f39(x)";
        assert_eq!(errors_of(&text), ["HS0304"]);
    }
}
