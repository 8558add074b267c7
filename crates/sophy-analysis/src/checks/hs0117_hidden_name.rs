//! A declared name is one that every model knows, such as `time` or `sin`, or one of the file; or that of a loop
//! variable is a declared one. The inner one is meant from then on, which a reader may overlook.

use crate::predefined::{Predefined, QUANTITIES};
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0117");

/// Whether every model knows the name.
pub(crate) fn is_predefined(name: &str) -> bool {
    QUANTITIES.contains(&name) || Predefined::named(name).is_some()
}

/// `what` is what the name is declared as.
pub(crate) fn diagnostic(name: &str, span: Span, what: &str) -> Diagnostic {
    Diagnostic::warning(CODE, span, format!("`{name}` hides the predefined `{name}`"))
        .label_main(format!("declared as {what}"))
        .help("rename it, if only for the reader's sake")
}

/// A name of a component, or a parameter of a function, is that of a constant or function of the file.
pub(crate) fn of_the_file(name: &str, span: Span, what: &str, hides: &str, hidden: Span) -> Diagnostic {
    Diagnostic::warning(CODE, span, format!("`{name}`, which is {what}, hides {hides} of that name"))
        .label(hidden, "hidden by it")
        .help("rename one of the two")
}

/// A loop variable has the name of something else.
pub(crate) fn declared(name: &str, span: Span, what: &str, hidden: Span) -> Diagnostic {
    Diagnostic::warning(CODE, span, format!("the loop variable `{name}` hides {what} of that name"))
        .label(hidden, "hidden within the loop")
        .help("give the loop variable another name")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn a_state_may_be_called_time_but_should_not() {
        check(
            "state time
             state Time
             location A
               der time = 1
               der Time = time
               transition t when time > 1 goto A
                 reset time = 0",
            "warning[HS0117] line 1 `time`: `time` hides the predefined `time` (declared as a state)
               help: rename it, if only for the reader's sake",
        );
    }
}
