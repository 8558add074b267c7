//! A declared name is one that every model knows, such as `time` or `sin`. The declared one is meant from then on,
//! which a reader may overlook.

use crate::declarations::Declarations;
use crate::names::Names;
use crate::predefined::{Predefined, QUANTITIES};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};

pub(crate) const CODE: Code = Code("HS0117");

pub(crate) fn find(declarations: &Declarations, names: &Names<'_>, diagnostics: &mut Diagnostics) {
    for name in QUANTITIES.into_iter().chain(Predefined::names()) {
        if let Some(symbol) = names.symbol(name) {
            diagnostics.push(diagnostic(name, symbol.span, symbol.kind.with_article()));
        }
    }
    for parameter in declarations.functions.iter().flat_map(|function| &function.parameters) {
        if QUANTITIES.contains(&parameter.value.as_str()) || Predefined::named(&parameter.value).is_some() {
            diagnostics.push(diagnostic(&parameter.value, parameter.span, "a parameter"));
        }
    }
}

fn diagnostic(name: &str, span: Span, what: &str) -> Diagnostic {
    Diagnostic::warning(CODE, span, format!("`{name}` hides the predefined `{name}`"))
        .label_main(format!("declared as {what}"))
        .help("rename it, if only for the reader's sake")
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
               transition t when time > 1 goto A",
            "warning[HS0117] line 1 `time`: `time` hides the predefined `time` (declared as a state)
               help: rename it, if only for the reader's sake",
        );
    }
}
