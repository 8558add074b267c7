//! A view names nothing that could be displayed.

use super::suggestion::suggest;
use crate::declarations::Spanned;
use crate::lower::{SymbolValue, Symbols};
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0124");

pub(crate) fn diagnostic(view: &Spanned<String>, symbols: &Symbols<'_>) -> Diagnostic {
    let names = symbols.names();
    let variables: Vec<&str> = names
        .iter()
        .filter(|(_, symbol)| matches!(symbol.value, SymbolValue::Variable(_)))
        .map(|(name, _)| *name)
        .collect();
    let help = suggest(&view.value, &variables, "variables").help;
    Diagnostic::error(CODE, view.span, format!("`{}` is not declared, so it cannot be viewed", view.value))
        .help(help)
}

pub(crate) fn no_variable(view: &Spanned<String>) -> Diagnostic {
    Diagnostic::error(CODE, view.span, format!("`{}` is no variable, so it cannot be viewed", view.value))
        .help("a view shows a state, mode, local, flag, input, output or parameter")
}
